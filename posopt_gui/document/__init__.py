"""The project: its inputs as plain data, with undo, and its file."""
