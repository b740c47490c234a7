"""Collision: shapes packed for kernels, certified distances, and the scene of a problem."""
