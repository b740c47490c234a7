"""The command line: thin, in millimetres and degrees, with one sentence per error."""
