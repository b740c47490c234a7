"""Fields of the path: a file, a line on a face, or parallel passes along a face."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from posopt_gui.viewmodels.cell_edits import (
    OFFSETS,
    POINTS,
    SHARES,
    STEP,
    measure_of,
    path_kind_of,
    spacing_of,
    with_face,
    with_measure,
    with_path_kind,
    with_spacing,
)
from posopt_gui.viewmodels.cell_facts import Facts, in_mm
from posopt_gui.viewmodels.form_types import (
    ANGLES,
    Cell,
    Choice,
    Field,
    Kind,
    Section,
    at,
    plain,
    table_of,
)
from posopt_gui.viewmodels.number_words import group_words
from posopt_gui.viewmodels.project_files import path_file
from solver.catalog.cell_path import FRAMES
from solver.io.importers.beam_faces import Face
from solver.io.importers.options import CONVENTIONS, LENGTH_UNITS, MAX_FEED, ImportOptions
from solver.io.importers.parametric import MAX_POINTS
from solver.units import DEG_PER_RAD

AS_THE_FILE = "as the file states"


def path_section(cell: Cell, facts: Facts, files: Mapping[str, bytes]) -> Section:
    """The path; which fields there are follows its kind."""
    kind = path_kind_of(cell)
    name = path_file(files)
    kinds = [Choice("file", "a file")]
    if "workpiece" not in cell:
        kinds += [Choice("line", "a line on a face"), Choice("parametric", "passes along a face")]
    fields = [
        Field("path.kind", "Path from", Kind.CHOICE, "Where the waypoints come from.",
              choices=tuple(kinds), read=path_kind_of,
              apply=lambda one, value: with_path_kind(one, value, name)),
    ]  # fmt: skip
    if kind == "line":
        fields += _line_fields(cell, facts)
    elif kind == "parametric":
        fields += _passes_fields(cell, facts)
    else:
        fields += source_fields(cell, facts)
    if kind != "parametric":
        fields += orientation_fields(cell)
    fields += common_fields()
    return Section(
        "path",
        "Path",
        tuple(fields),
        ("path",),
        summary=_summary(cell, kind),
        extra="path_file" if kind == "file" else "",
        before=fields[1].key,
        open=True,
    )


def _summary(cell: Cell, kind: str) -> str:
    if kind == "file":
        return Path(str(at(cell, "path.file"))).name
    return str(at(cell, f"path.{kind}.face", "")) if kind else ""


def source_fields(cell: Cell, facts: Facts) -> list[Field]:
    """What a path file may leave unsaid."""
    groups = facts.workpiece.groups if facts.workpiece is not None else ()
    # Parts of a beam have names in every language; a mesh has the name that it was given.
    parts = tuple(Choice(one, group_words(one)) for one in groups)
    if "workpiece" in cell:
        groups = (str(at(cell, "workpiece.group") or at(cell, "workpiece.name", "")),)
        parts = plain(groups)
    return [
        Field("path.frame", "Frame", Kind.CHOICE, "Frame of the file's positions. A file that "
              "states another is refused.",
              choices=(Choice(None, AS_THE_FILE), *plain(FRAMES))),
        Field("path.unit", "Unit", Kind.CHOICE, "Unit of the file's positions; mm where neither "
              "says it.", choices=(Choice(None, AS_THE_FILE), *plain(tuple(LENGTH_UNITS)))),
        Field("path.touches", "Touches", Kind.CHOICE, "Which part of the workpiece the tool may "
              "enter, for passes of a file that state nothing.",
              choices=(Choice(None, AS_THE_FILE), *parts)),
        Field("path.resample_mm", "Resample", Kind.NUMBER, "Largest distance between the waypoints "
              "of the file; more are put between.", "mm", 0.0, above=True, step=5.0,
              unset="the file's points"),
    ]  # fmt: skip


def orientation_fields(cell: Cell) -> list[Field]:
    """The orientation of points that have none of their own."""
    stated = at(cell, "path.orientation_wpr_deg") is not None
    flag = Field(
        "path.orientation", "State orientation", Kind.FLAG, "One orientation for points that "
        "have none of their own.", default=False,
        read=lambda one: at(one, "path.orientation_wpr_deg") is not None,
        apply=_with_orientation,
    )  # fmt: skip
    if not stated:
        return [flag]
    return [
        flag,
        Field("path.orientation_wpr_deg", "Orientation", Kind.NUMBERS, "W, P, R of points that "
              "have no orientation of their own.", "deg", parts=ANGLES),
        Field("path.orientation_frame", "Its frame", Kind.CHOICE, "Frame of that orientation.",
              choices=(Choice(None, "frame of the path"), *plain(FRAMES))),
    ]  # fmt: skip


def _with_orientation(cell: Cell, stated: object) -> Cell:
    path = table_of(cell, "path")
    path.pop("orientation_wpr_deg", None)
    path.pop("orientation_frame", None)
    if stated:
        path |= {"orientation_wpr_deg": [0.0, 150.0, 0.0], "orientation_frame": "floor"}
    return {**cell, "path": path}


def common_fields() -> list[Field]:
    """What passes of any kind may leave unsaid."""
    default = ImportOptions()
    return [
        Field("path.feed_mm_s", "Feed unless stated", Kind.NUMBER,
              "Feed of passes that state none; a feed in the path file comes first.", "mm/s",
              0.0, in_mm(MAX_FEED), above=True, step=5.0, default=in_mm(default.feed)),
        Field("path.convention", "Tool y axis", Kind.CHOICE, "How a normal and a travel direction "
              "become an orientation: z points into the surface, and the travel is along y or "
              "along x.", default=default.convention,
              choices=(Choice(CONVENTIONS[0], "along the travel"),
                       Choice(CONVENTIONS[1], "across the travel"))),
        Field("path.lean_deg", "Nominal lean", Kind.NUMBER, "Lean that the weight of the lean "
              "refers to, of passes that state none.", "deg", -90.0, 90.0,
              default=round(default.lean * DEG_PER_RAD, 6)),
        Field("path.lead_deg", "Nominal lead", Kind.NUMBER, "Lead that the weight of the lead "
              "refers to, of passes that state none.", "deg", -90.0, 90.0,
              default=round(default.lead * DEG_PER_RAD, 6)),
    ]  # fmt: skip


def _face(kind: str, facts: Facts) -> Field:
    return Field(f"path.{kind}.face", "Face", Kind.CHOICE, "Face of the beam; left is +y, top is "
                 "+z of the beam.", choices=plain(tuple(facts.faces)), searchable=True,
                 required=True,
                 apply=lambda cell, value: with_face(cell, kind, value, facts))  # fmt: skip


def _edge(kind: str, face: Face | None) -> Field:
    edges = tuple(face.edges) if face is not None else ()
    return Field(f"path.{kind}.edge", "Measured from", Kind.CHOICE, "Edge of the face that "
                 "offsets are measured from.", default=edges[0] if edges else None,
                 choices=tuple(Choice(one, one) for one in edges))  # fmt: skip


def _along(kind: str, end: str, facts: Facts) -> Field:
    half = in_mm(facts.workpiece.length / 2.0) if facts.workpiece is not None else None
    label = "From, along" if end == "from" else "To, along"
    return Field(f"path.{kind}.{end}_along_mm", label, Kind.NUMBER, "Place along the beam, x from "
                 "its middle.", "mm", None if half is None else -half, half, step=10.0,
                 required=True)  # fmt: skip


def _lift(kind: str) -> Field:
    return Field(f"path.{kind}.lift_mm", "Lift", Kind.NUMBER, "Distance of the TCP from the face, "
                 "such as the radius of a ball.", "mm", 0.0, default=0.0)  # fmt: skip


def _name(kind: str, default: str) -> Field:
    return Field(f"path.{kind}.name", "Pass name", Kind.TEXT, "Name of the passes; several are "
                 "numbered.", default=default)  # fmt: skip


def _points(kind: str) -> Field:
    return Field(f"path.{kind}.points", "Waypoints", Kind.INTEGER, "Number of waypoints of a "
                 "pass.", low=2, high=MAX_POINTS, required=True)  # fmt: skip


def _face_of(cell: Cell, kind: str, facts: Facts) -> Face | None:
    return facts.faces.get(str(at(cell, f"path.{kind}.face", "")))


def _line_fields(cell: Cell, facts: Facts) -> list[Field]:
    shares = measure_of(cell) == SHARES
    face = _face_of(cell, "line", facts)
    fields = [
        _face("line", facts),
        Field("path.line.measure", "Across by", Kind.CHOICE, "With shares the line follows the "
              "section: another beam has it in proportion.",
              choices=(Choice(SHARES, "shares of the face"), Choice(OFFSETS, "distances")),
              read=measure_of, apply=lambda one, value: with_measure(one, value, facts)),
    ]  # fmt: skip
    if not shares:
        fields.append(_edge("line", face))
    for end in ("from", "to"):
        fields += [_along("line", end, facts), _across(end, shares, face)]
    return [*fields, _points("line"), _lift("line"), _name("line", "line")]


def _across(end: str, shares: bool, face: Face | None) -> Field:
    label = "From, across" if end == "from" else "To, across"
    if shares:
        low, high = (round(one / face.unit, 3) for one in (face.lower, face.upper)) if face else (
            None, None)  # fmt: skip
        return Field(f"path.line.{end}_share", label, Kind.NUMBER, "Share of the face: on the web "
                     "0 is its centre line, 1 the inside of the upper flange, -1 that of the "
                     "lower one.", "", low, high, step=0.05, decimals=2, required=True)  # fmt: skip
    return Field(f"path.line.{end}_offset_mm", label, Kind.NUMBER, "Distance from the edge.", "mm",
                 0.0, None if face is None else in_mm(face.upper - face.lower),
                 required=True)  # fmt: skip


def _passes_fields(cell: Cell, facts: Facts) -> list[Field]:
    kind = "parametric"
    passes = at(cell, "path.parametric.passes", 1)
    fields = [
        _face(kind, facts),
        _edge(kind, _face_of(cell, kind, facts)),
        _along(kind, "from", facts),
        _along(kind, "to", facts),
        Field("path.parametric.offset_mm", "First offset", Kind.NUMBER, "Distance of the first "
              "pass from the edge.", "mm", 0.0, step=5.0, required=True),
        Field("path.parametric.passes", "Passes", Kind.INTEGER, "Number of passes.", low=1,
              high=MAX_POINTS, default=1),
    ]  # fmt: skip
    if passes != 1:
        fields += [
            Field("path.parametric.spacing_mm", "Spacing", Kind.NUMBER, "How much farther from the "
                  "edge each pass lies; not 0.", "mm", default=0.0),
            Field("path.parametric.zigzag", "Zig-zag", Kind.FLAG, "Whether every second pass runs "
                  "back.", default=True),
            Field("path.parametric.turn_with_travel", "Turn the tool", Kind.FLAG, "Whether the "
                  "tool turns by 180° for the way back; a ball cuts both ways and need not.",
                  default=True),
        ]  # fmt: skip
    fields.append(
        Field("path.parametric.spacing", "Waypoints by", Kind.CHOICE, "Whether passes state how "
              "many waypoints they have, or how far these are apart.",
              choices=(Choice(STEP, "largest distance"), Choice(POINTS, "number")),
              read=spacing_of, apply=with_spacing)
    )  # fmt: skip
    if spacing_of(cell) == POINTS:
        fields.append(_points(kind))
    else:
        fields.append(
            Field("path.parametric.step_mm", "Distance", Kind.NUMBER, "Largest distance between "
                  "waypoints.", "mm", 0.001, required=True)
        )  # fmt: skip
    return [*fields, _lift(kind), _name(kind, "pass")]
