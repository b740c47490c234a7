"""Candidates: generation, filters and the explanation of every verdict."""
