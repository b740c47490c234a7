"""The headless solver of posopt: from a grinding path and an H-beam to a checked robot program."""
