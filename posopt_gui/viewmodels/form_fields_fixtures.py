"""Fields of what stands still: the floor, and fixtures of every shape."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from posopt_gui.viewmodels.fixture_edits import (
    CORNERS,
    MIDDLE,
    box_rule_of,
    with_box_rule,
    with_shape,
)
from posopt_gui.viewmodels.form_types import (
    ANGLES,
    AXES,
    Cell,
    Choice,
    Field,
    Kind,
    Section,
    plain,
    point_field,
    rows_of,
)
from solver.catalog.bodies import SHAPES
from solver.io.importers.options import LENGTH_UNITS

MESH_TIP = "A closed triangle mesh: STL, OBJ, PLY, glTF or GLB. It is kept in the project."


def fixtures_section(cell: Cell, chosen: int) -> Section:
    """The floor, the list of fixtures, and the fields of the chosen one."""
    fixtures = rows_of(cell, "fixtures")
    fields = [
        Field("cell.floor", "Floor", Kind.FLAG, "Whether the floor is a fixture: a box of 10 x 10 "
              "m below the robot's mounting face.", default=False),
    ]  # fmt: skip
    if 0 <= chosen < len(fixtures):
        fields += fixture_fields(fixtures[chosen], f"fixtures.{chosen}")
    return Section(
        "fixtures",
        "Fixtures",
        tuple(fields),
        ("fixtures",),
        summary=", ".join(str(one.get("name", "?")) for one in fixtures),
        extra="fixtures",
        before=fields[1].key if len(fields) > 1 else "",
    )


def fixture_fields(fixture: Mapping[str, object], key: str) -> list[Field]:
    """Fields of one fixture, by its shape; coordinates are in floor."""
    fields = [
        Field(f"{key}.name", "Name", Kind.TEXT, "Name in messages.", required=True),
        Field(f"{key}.group", "Group", Kind.TEXT, "Fixtures of one group are named together.",
              default=fixture.get("name"), drop_default=True),
    ]  # fmt: skip
    if "mesh" in fixture:
        return [*fields, *_mesh_fields(key)]
    fields.append(
        Field(f"{key}.shape", "Shape", Kind.CHOICE, "Shape of the fixture.",
              choices=tuple(Choice(one, one) for one in SHAPES), required=True,
              apply=lambda cell, shape: with_shape(cell, key, shape))
    )  # fmt: skip
    shape = fixture.get("shape")
    radius = Field(f"{key}.radius_mm", "Radius", Kind.NUMBER, "Radius.", "mm", 0.0,
                   above=True, step=5.0, required=True)  # fmt: skip
    if shape == "sphere":
        return [*fields, point_field(f"{key}.centre_mm", "Centre", "Centre in floor."), radius]
    if shape in ("cylinder", "capsule"):
        return [
            *fields,
            point_field(f"{key}.from_mm", "One end", "Centre of one end of the axis, in floor."),
            point_field(f"{key}.to_mm", "Other end", "Centre of the other end, in floor."),
            radius,
        ]
    return [*fields, *_box_fields(fixture, key)]


def _box_fields(fixture: Mapping[str, object], key: str) -> list[Field]:
    rule = box_rule_of(fixture)
    fields = [
        Field(f"{key}.stated_by", "Stated by", Kind.CHOICE, "By two corners, or by its centre and "
              "its size.", choices=(Choice(CORNERS, "corners"), Choice(MIDDLE, "centre and size")),
              read=lambda _: rule, apply=partial(_with_rule, key)),
    ]  # fmt: skip
    if rule == MIDDLE:
        fields += [
            point_field(f"{key}.centre_mm", "Centre", "Centre of the box in floor."),
            point_field(f"{key}.size_mm", "Size", "Full extent of the box along its axes.",
                        low=0.0),
        ]  # fmt: skip
    else:
        fields += [
            point_field(f"{key}.min_mm", "Lower corner", "Corner of the box with the least X, Y, "
                        "Z in floor."),
            point_field(f"{key}.max_mm", "Upper corner", "Corner of the box with the greatest X, "
                        "Y, Z in floor."),
        ]  # fmt: skip
    return [*fields, _turned(key, "W, P, R by which the box is turned about its centre.")]


def _with_rule(key: str, cell: Cell, rule: str) -> Cell:
    return with_box_rule(cell, key, rule)


def _mesh_fields(key: str) -> list[Field]:
    return [
        Field(f"{key}.mesh", "Mesh file", Kind.FILE, MESH_TIP, required=True),
        Field(f"{key}.unit", "Unit of the mesh", Kind.CHOICE, "Unit of the mesh file.",
              choices=plain(tuple(LENGTH_UNITS)), default="mm"),
        Field(f"{key}.position_mm", "Position", Kind.NUMBERS, "Where the origin of the mesh "
              "stands in floor.", "mm", step=5.0, default=[0.0, 0.0, 0.0], parts=AXES),
        _turned(key, "W, P, R in floor."),
    ]  # fmt: skip


def _turned(key: str, tip: str) -> Field:
    return Field(f"{key}.wpr_deg", "Orientation", Kind.NUMBERS, tip, "deg",
                 default=[0.0, 0.0, 0.0], parts=ANGLES, drop_default=True)  # fmt: skip
