"""The explicit list of stages: from a problem to its sequence, and on to a checked program."""
