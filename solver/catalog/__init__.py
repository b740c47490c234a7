"""The catalogue: robots, tools, beams and cells as data, shipped or in files of the user."""

from solver.catalog.beams import BeamEntry, beam_entries, load_beam
from solver.catalog.cells import load_cell
from solver.catalog.listing import CatalogEntry, describe, list_names
from solver.catalog.robots import load_robot
from solver.catalog.tools import load_tool

__all__ = [
    "BeamEntry",
    "CatalogEntry",
    "beam_entries",
    "describe",
    "list_names",
    "load_beam",
    "load_cell",
    "load_robot",
    "load_tool",
]
