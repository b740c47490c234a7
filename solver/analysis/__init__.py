"""Analysis: results, metrics, references to compare with, and the diagnosis of failures."""
