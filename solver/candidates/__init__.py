"""TODO candidates."""
