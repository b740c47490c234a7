"""Tools as TOML: TCP, mass, and bodies in three roles."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from solver.catalog.bodies import read_body, read_rotation
from solver.catalog.names import entry_source
from solver.catalog.robots import read_sources
from solver.catalog.toml_reader import Table, read_toml
from solver.model.shapes import ToolRole
from solver.model.tool import Tool, ToolBody
from solver.transforms import rigid
from solver.units import MM, MM_PER_M

ROLES = tuple(role.value for role in ToolRole)

MAX_MARGIN: Final = 1000.0 * MM
"""Largest margin of a near or contact body [m]; more is taken for a mistake of unit."""

MAX_DEPTH: Final = 20.0 * MM
"""Deepest that a contact body may enter what its pass touches [m]; no tool removes more."""


def load_tool(
    name_or_path: str | Path,
    *,
    relative_to: Path | None = None,
    files: Mapping[str, bytes] | None = None,
) -> Tool:
    """Load a shipped tool by name, or one of a TOML file.

    `files` holds TOML files in memory by the references under which they are asked for.

    Raises
    ------
    UnknownNameError
        If no shipped tool has this name.
    InputError
        If the file is unusable or contradicts itself; the sentence names file and key.
    """
    document = read_toml(*entry_source("tools", name_or_path, relative_to, files))
    head = document.table("tool")
    name, title = head.name("name"), head.text("title")
    mass = head.number("mass_kg", low=0.0)
    tcp = rigid(read_rotation(head, "tcp_wpr_deg"), head.numbers("tcp_mm", 3))
    bodies = tuple(_tool_body(one) for one in document.tables("bodies"))
    names = [one.body.name for one in bodies]
    for index, one in enumerate(names):
        if one in names[:index]:
            raise document.error(f"bodies[{index}].name", f"two bodies are called {one!r}")
    assumptions = document.texts("assumptions", default=())
    read_sources(document)
    document.finish()
    with document.located():
        return Tool(name, title, tcp, mass, bodies, assumptions)


def _tool_body(table: Table) -> ToolBody:
    role = ToolRole(table.choice("role", ROLES, "clearance"))
    body = read_body(table)
    with table.located():
        if role is ToolRole.CLEARANCE:
            return ToolBody(body, role)
        margin = table.number("margin_mm", 2.0 * MM, low=0.0, high=MAX_MARGIN * MM_PER_M)
        if role is ToolRole.NEAR:
            return ToolBody(body, role, margin=margin)
        depth = table.number("depth_mm", 0.5 * MM, low=0.0, high=MAX_DEPTH * MM_PER_M)
        return ToolBody(body, role, margin=margin, depth=depth)
