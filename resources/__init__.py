"""Data of posopt: robots, tools, beams, cells and example paths (no code)."""
