"""The window of posopt."""
