"""The panels of the window; each talks to the session alone."""
