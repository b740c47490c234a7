"""The catalogue: robots, tools, beams and cells as data, shipped or in files of the user.

Loaded when it is first used: who only asks where the data lie needs no numpy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from solver.lazy_names import lazy_names

if TYPE_CHECKING:
    from solver.catalog.beams import BeamEntry as BeamEntry
    from solver.catalog.beams import beam_entries as beam_entries
    from solver.catalog.beams import load_beam as load_beam
    from solver.catalog.cells import load_cell as load_cell
    from solver.catalog.listing import CatalogEntry as CatalogEntry
    from solver.catalog.listing import describe as describe
    from solver.catalog.listing import list_names as list_names
    from solver.catalog.robots import load_robot as load_robot
    from solver.catalog.tools import load_tool as load_tool

_HOME: Final = {
    "BeamEntry": ".beams",
    "CatalogEntry": ".listing",
    "beam_entries": ".beams",
    "describe": ".listing",
    "list_names": ".listing",
    "load_beam": ".beams",
    "load_cell": ".cells",
    "load_robot": ".robots",
    "load_tool": ".tools",
}

__all__ = sorted(_HOME)  # noqa: PLE0605 - a list of strings, kept in one place

__getattr__, __dir__ = lazy_names(__name__, _HOME)
