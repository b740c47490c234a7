"""The layered graph of pose candidates and the searches through it."""
