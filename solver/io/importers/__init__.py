"""TODO importers."""
