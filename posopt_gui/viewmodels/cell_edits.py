"""Edits of a cell that change several keys at once; each returns another cell."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from posopt_gui.viewmodels.cell_facts import (
    FREE,
    Catalogue,
    Facts,
    dimensions_mm,
    has_free_dimensions,
    in_mm,
)
from posopt_gui.viewmodels.form_types import Cell, at, table_of, with_table
from solver.catalog.cell_path import FILE_KEYS, KINDS
from solver.catalog.cell_workpiece import DIMENSIONS
from solver.model.toolpath import Frame
from solver.model.workpiece import BeamSection
from solver.transforms import FloatArray, wpr_from_rotation
from solver.units import DEG_PER_RAD, MM

CENTRE, LOWER_EDGE = "centre", "lower_edge"
"""Rules of a beam's placement: by its centre, or by a point of the plan and its lowest edge."""

SHARES, OFFSETS = "shares", "offsets"
POINTS, STEP = "points", "step"

_NEW_LINE: Mapping[str, Any] = {
    "face": "web_left",
    "from_along_mm": -300.0,
    "from_share": 0.0,
    "to_along_mm": 300.0,
    "to_share": 0.5,
    "points": 50,
    "lift_mm": 0.0,
}
_NEW_PASSES: Mapping[str, Any] = {
    "face": "web_left",
    "edge": "bottom",
    "from_along_mm": -300.0,
    "to_along_mm": 300.0,
    "offset_mm": 100.0,
    "passes": 2,
    "spacing_mm": 20.0,
    "step_mm": 20.0,
    "turn_with_travel": False,
    "lift_mm": 0.0,
}


def standard_of(cell: Cell, catalogue: Catalogue) -> str:
    """The series that a cell's section is of; FREE for stated dimensions, '' for another file."""
    if has_free_dimensions(cell):
        return FREE
    entry = catalogue.entry(at(cell, "beam.section"))
    return entry.series if entry is not None else ""


def with_standard(cell: Cell, standard: str, catalogue: Catalogue, facts: Facts) -> Cell:
    """The cell with the section of a series that is nearest to its own, or with free dimensions."""
    if standard == FREE:
        section = facts.section or catalogue.beams[0].section
        beam = table_of(cell, "beam")
        beam.pop("section", None)
        return with_table(cell, "beam", {**beam, **dimensions_mm(section)})
    entries = catalogue.sections(standard)
    if not entries:
        return cell
    wanted = facts.section or entries[0].section
    nearest = min(entries, key=lambda one: _difference(one.section, wanted))
    return with_section(cell, nearest.section.name)


def with_section(cell: Cell, name: str) -> Cell:
    """The cell with a section by its name; stated dimensions and the root radius go."""
    kept = {
        key: value
        for key, value in table_of(cell, "beam").items()
        if key not in {*DIMENSIONS, "root_mm"}
    }
    return with_table(cell, "beam", {**kept, "section": name})


def _difference(one: BeamSection, other: BeamSection) -> float:
    return abs(one.height - other.height) + abs(one.width - other.width)


def rule_of(cell: Cell) -> str:
    """The rule by which a cell places its beam."""
    lower = at(cell, "beam.lower_edge_mm") is not None
    return LOWER_EDGE if lower or at(cell, "beam.position_xy_mm") is not None else CENTRE


def with_rule(cell: Cell, rule: str, facts: Facts) -> Cell:
    """The cell with the same placement, stated by the other rule."""
    beam = table_of(cell, "beam")
    centre, lower = _centre_and_lower_edge(cell, facts)
    for key in ("position_mm", "position_xy_mm", "lower_edge_mm"):
        beam.pop(key, None)
    if rule == LOWER_EDGE:
        beam |= {"position_xy_mm": centre[:2], "lower_edge_mm": lower}
    else:
        beam["position_mm"] = centre
    return with_table(cell, "beam", beam)


def _centre_and_lower_edge(cell: Cell, facts: Facts) -> tuple[list[float], float]:
    """Centre and height of the lowest edge in the frame of the placement [mm]."""
    workpiece = facts.workpiece
    if workpiece is None or workpiece.section is None:
        position = [900.0, 0.0, 500.0]
        return position, position[2]
    shift = facts.world_height if at(cell, "beam.frame") == Frame.FANUC_WORLD.value else 0.0
    centre = workpiece.placement[:3, 3] - (0.0, 0.0, shift)
    section = workpiece.section
    half = np.array([workpiece.length, section.width, section.height]) / 2.0
    reach = float(np.abs(workpiece.placement[2, :3]) @ half)
    return [in_mm(float(one)) for one in centre], in_mm(float(centre[2]) - reach)


def with_frame(cell: Cell, frame: str, facts: Facts, table: str = "beam") -> Cell:
    """The cell with its workpiece where it is, stated in the other frame."""
    placed = table_of(cell, table)
    if placed.get("frame", Frame.FLOOR.value) == frame:
        return cell
    shift = in_mm(facts.world_height) * (-1.0 if frame == Frame.FANUC_WORLD.value else 1.0)
    if _is_number(placed.get("lower_edge_mm")):
        placed["lower_edge_mm"] = round(placed["lower_edge_mm"] + shift, 9)
    position = placed.get("position_mm")
    if isinstance(position, list) and len(position) == 3 and _is_number(position[2]):
        placed["position_mm"] = [*position[:2], round(position[2] + shift, 9)]
    return with_table(cell, table, {**placed, "frame": frame})


def with_placement(cell: Cell, fanuc_world_from_beam: FloatArray) -> Cell:
    """The cell with its beam at a pose (4, 4) in fanuc_world, stated by its centre."""
    beam = table_of(cell, "beam")
    for key in ("position_xy_mm", "lower_edge_mm"):
        beam.pop(key, None)
    angles = wpr_from_rotation(fanuc_world_from_beam[:3, :3])
    placed = {
        "position_mm": [round(in_mm(float(one)), 3) for one in fanuc_world_from_beam[:3, 3]],
        "wpr_deg": [round(angle * DEG_PER_RAD, 4) for angle in angles],
        "frame": Frame.FANUC_WORLD.value,
    }
    return with_table(cell, "beam", {**beam, **placed})


def path_kind_of(cell: Cell) -> str:
    """How a cell states its path: one of `solver.catalog.cell_path.KINDS`, or ''."""
    return next((kind for kind in KINDS if at(cell, f"path.{kind}") is not None), "")


def with_path_kind(cell: Cell, kind: str, file: str = "") -> Cell:
    """The cell with a path of another kind; keys that the kind does not take go."""
    path = {key: value for key, value in table_of(cell, "path").items() if key not in KINDS}
    if kind == "file":
        return with_table(cell, "path", {**path, "file": file})
    path = {key: value for key, value in path.items() if key not in FILE_KEYS}
    if kind == "parametric":
        path.pop("orientation_wpr_deg", None)
        path.pop("orientation_frame", None)
    new = _NEW_LINE if kind == "line" else _NEW_PASSES
    return with_table(cell, "path", {**path, kind: dict(new)})


def measure_of(cell: Cell) -> str:
    """Whether a line on a face is stated by shares of the face or by distances from an edge."""
    line = table_of(cell, "path.line")
    return SHARES if "from_share" in line or "to_share" in line else OFFSETS


def with_measure(cell: Cell, measure: str, facts: Facts) -> Cell:
    """The cell with the same line on the face, stated by the other measure."""
    if measure_of(cell) == measure:
        return cell
    path = table_of(cell, "path")
    line = table_of(cell, "path.line")
    face = facts.faces.get(line.get("face", ""))
    edge = line.pop("edge", None)
    for end in ("from", "to"):
        share = line.pop(f"{end}_share", None)
        offset = line.pop(f"{end}_offset_mm", None)
        if face is None:
            value = 0.0
        elif measure == OFFSETS:
            start, sign = next(iter(face.edges.values()))
            value = in_mm(((share or 0.0) * face.unit - start) * sign)
        else:
            start, sign = face.edges.get(edge or "", next(iter(face.edges.values())))
            value = round((start + sign * (offset or 0.0) * MM) / face.unit, 9)
        line[f"{end}_share" if measure == SHARES else f"{end}_offset_mm"] = value
    return with_table(cell, "path", {**path, "line": line})


def spacing_of(cell: Cell) -> str:
    """Whether passes state how many points they have, or how far these are apart."""
    return POINTS if at(cell, "path.parametric.points") is not None else STEP


def with_spacing(cell: Cell, spacing: str) -> Cell:
    """The cell with about as many points on its passes, stated the other way."""
    if spacing_of(cell) == spacing:
        return cell
    path = table_of(cell, "path")
    passes = table_of(cell, "path.parametric")
    length = abs(_number(passes.get("to_along_mm")) - _number(passes.get("from_along_mm")))
    if spacing == POINTS:
        step = _number(passes.pop("step_mm", 20.0)) or 20.0
        passes["points"] = max(2, round(length / step) + 1)
    else:
        points = int(_number(passes.pop("points", 2)))
        passes["step_mm"] = round(length / max(1, points - 1), 3) or 20.0
    return with_table(cell, "path", {**path, "parametric": passes})


def with_face(cell: Cell, kind: str, face: str, facts: Facts) -> Cell:
    """The cell with its path on another face; an edge that the face does not have goes."""
    path = table_of(cell, "path")
    table = {**table_of(cell, f"path.{kind}"), "face": face}
    known = facts.faces.get(face)
    if known is not None and table.get("edge") not in known.edges:
        table.pop("edge", None)
    return with_table(cell, "path", {**path, kind: table})


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _number(value: object) -> float:
    return float(value) if isinstance(value, int | float) else 0.0
