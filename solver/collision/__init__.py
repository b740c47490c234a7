"""TODO collision."""
