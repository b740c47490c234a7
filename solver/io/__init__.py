"""Files: importers of paths, post-processors, readers and safe writing."""
