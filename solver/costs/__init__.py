"""Costs of nodes and edges of the layered graph."""
