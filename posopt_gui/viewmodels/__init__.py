"""From results to arrays, colours and rows; no Qt, so that tests need no screen."""
