"""TODO posts."""
