"""Fields of cell, robot, tool, beam and placement."""

from __future__ import annotations

from posopt_gui.viewmodels.cell_edits import (
    CENTRE,
    LOWER_EDGE,
    rule_of,
    standard_of,
    with_frame,
    with_rule,
    with_section,
    with_standard,
)
from posopt_gui.viewmodels.cell_facts import FREE, Catalogue, Facts, in_mm
from posopt_gui.viewmodels.form_fields_fixtures import MESH_TIP
from posopt_gui.viewmodels.form_types import (
    ANGLES,
    AXES,
    Cell,
    Choice,
    Field,
    Kind,
    Note,
    Section,
    at,
    plain,
    point_field,
)
from posopt_gui.viewmodels.number_words import decimal
from solver.catalog.cell_workpiece import PLACEMENT_FRAMES
from solver.io.importers.options import LENGTH_UNITS
from solver.model.robot import JOINTS
from solver.model.toolpath import Frame
from solver.units import DEG_PER_RAD

FRAME_TIP = (
    "fanuc_world lies at the height of the J2 axis and is what the pendant shows; floor is the "
    "robot's mounting face. Their axes are parallel."
)


def cell_section(cell: Cell) -> Section:
    """Name and title of the cell."""
    fields = (
        Field("cell.name", "Name", Kind.TEXT, "The cell's name; it is stamped into the robot "
              "program, where up to 27 characters fit.", required=True),
        Field("cell.title", "Title", Kind.TEXT, "First line of the summary.", required=True),
    )  # fmt: skip
    return Section("cell", "Cell", fields, ("cell",), summary=str(at(cell, "cell.name", "")))


def robot_section(cell: Cell, catalogue: Catalogue, facts: Facts) -> Section:
    """Robot, its body set and narrower windows of its joints."""
    robot = facts.robot
    sets = plain(tuple(robot.body_sets) if robot is not None else ())
    fields = [
        Field("robot.model", "Robot", Kind.CHOICE, "The robot: a shipped one, or a robot file.",
              choices=catalogue.robots, searchable=True, required=True),
        Field("robot.bodies", "Bodies", Kind.CHOICE, "Which of the robot's body sets is checked: "
              "full is the whole arm; paper are three capsules, not for a real cell.",
              choices=sets, required=True),
    ]  # fmt: skip
    for joint in range(JOINTS):
        limits = None
        if robot is not None:
            limits = [round(float(one) * DEG_PER_RAD, 6) for one in robot.limits[joint]]
        low, high = limits or (None, None)
        fields.append(
            Field(f"robot.windows_deg.J{joint + 1}", f"J{joint + 1} window", Kind.NUMBERS,
                  "Window of the pendant's joint, such as what a dress pack allows. It can only "
                  "narrow the robot's limits.", "deg", low, high, default=limits,
                  parts=("from", "to"), drop_default=True)
        )  # fmt: skip
    return Section(
        "robot",
        "Robot",
        tuple(fields),
        ("robot",),
        summary=f"{at(cell, 'robot.model', '')} · {at(cell, 'robot.bodies', '')}",
    )


def tool_section(cell: Cell, catalogue: Catalogue, facts: Facts) -> Section:
    """The tool."""
    fields = (
        Field("tool.model", "Tool", Kind.CHOICE, "The tool: a shipped one, or a tool file.",
              choices=catalogue.tools, searchable=True, required=True),
    )  # fmt: skip
    notes: tuple[Note, ...] = ()
    if facts.tool is not None:
        tool = facts.tool
        x, y, z = (decimal(in_mm(float(one)), 1) for one in tool.tcp[:3, 3])
        notes = (
            Note("TCP at {x}, {y}, {z} mm of the flange", (("x", x), ("y", y), ("z", z))),
            Note("{mass} kg, {count} bodies", (("mass", f"{tool.mass:g}"),
                 ("count", str(len(tool.bodies))))),
        )  # fmt: skip
    return Section("tool", "Tool", fields, ("tool",), str(at(cell, "tool.model", "")), notes=notes)


def beam_section(cell: Cell, catalogue: Catalogue, facts: Facts) -> Section:
    """Section, length and fillets of the beam; a mesh has a section of its own."""
    standard = standard_of(cell, catalogue)
    series = [_series(one, catalogue) for one in catalogue.series]
    if not standard:
        series.append(Choice("", "from a file"))
    fields = [
        Field("beam.standard", "Standard", Kind.CHOICE, "Series of sections, or free dimensions. "
              "A change takes the section of the series that is nearest in height and width.",
              choices=(*series, Choice(FREE, "Free dimensions")),
              read=lambda one: standard_of(one, catalogue),
              apply=lambda one, value: with_standard(one, value, catalogue, facts)),
    ]  # fmt: skip
    if standard == FREE:
        fields += _dimensions()
    else:
        fields.append(_section_field(standard, catalogue))
    fields += [
        Field("beam.root_mm", "Root radius r", Kind.NUMBER, "Radius of the root fillets; later "
              "editions of a standard may state a smaller one.", "mm", 0.0, step=0.5,
              default=_root(facts), drop_default=standard != FREE),
        Field("beam.length_mm", "Length", Kind.NUMBER, "Length of the beam.", "mm", 0.0,
              above=True, step=50.0, required=True),
        Field("beam.fillets", "Root fillets", Kind.FLAG, "Whether the root fillets are modelled. "
              "Without them their steel is in no check.", default=True),
    ]  # fmt: skip
    length = at(cell, "beam.length_mm")
    name = at(cell, "beam.section") or "H"
    return Section(
        "beam",
        "Beam",
        tuple(fields),
        ("beam",),
        summary=f"{name} · {length:g} mm" if isinstance(length, int | float) else str(name),
        extra="drawing",
        before="beam.length_mm",
        open=True,
    )


def _series(title: str, catalogue: Catalogue) -> Choice:
    """A series by its short name and its standard; the whole title is its tool tip."""
    standard = next((one.section.source for one in catalogue.sections(title)), "")
    name = title.partition(",")[0]
    return Choice(title, f"{name} · {standard}" if standard else name, title, plain=True)


def _root(facts: Facts) -> float | None:
    return in_mm(facts.catalogue_section.root) if facts.catalogue_section is not None else 0.0


def _section_field(standard: str, catalogue: Catalogue) -> Field:
    choices = []
    for entry in catalogue.sections(standard):
        one = entry.section
        detail = " × ".join(f"{in_mm(v):g}" for v in (one.height, one.width, one.web, one.flange))
        choices.append(Choice(one.name, one.name, detail, plain=True))
    return Field(
        "beam.section", "Section", Kind.CHOICE, "The section by its name, such as HW300; type to "
        "search. A file with one section can stand here too.",
        choices=tuple(choices), searchable=True, required=True,
        read=lambda cell: _shipped_name(cell, catalogue), apply=with_section,
    )  # fmt: skip


def _shipped_name(cell: Cell, catalogue: Catalogue) -> str | None:
    name = at(cell, "beam.section")
    entry = catalogue.entry(name)
    return entry.section.name if entry is not None else name


def _dimensions() -> list[Field]:
    rows = (
        ("height_mm", "Height H", "Height of the section.", 1.0),
        ("width_mm", "Flange width B", "Width of the flanges.", 1.0),
        ("web_mm", "Web tw", "Thickness of the web.", 0.5),
        ("flange_mm", "Flange tf", "Thickness of the flanges.", 0.5),
    )
    return [
        Field(f"beam.{key}", label, Kind.NUMBER, tip, "mm", 0.0, above=True, step=step,
              required=True)
        for key, label, tip, step in rows
    ]  # fmt: skip


def placement_section(cell: Cell, facts: Facts) -> Section:
    """Where the workpiece stands, in the frame of the cell, and in both frames as a note."""
    table = "workpiece" if "workpiece" in cell else "beam"
    frame = Field(
        f"{table}.frame", "Stated in", Kind.CHOICE, FRAME_TIP,
        choices=tuple(Choice(one, one, plain=True) for one in reversed(PLACEMENT_FRAMES)),
        default=Frame.FLOOR.value,
        apply=lambda one, value: with_frame(one, value, facts, table),
    )  # fmt: skip
    fields = [frame]
    if table == "beam":
        fields.append(
            Field("placement.rule", "Stated by", Kind.CHOICE, "By its "
                  "lower edge the beam stays on its supports when another section is chosen.",
                  choices=(Choice(LOWER_EDGE, "lower edge"),
                           Choice(CENTRE, "centre")),
                  read=rule_of, apply=lambda one, value: with_rule(one, value, facts))
        )  # fmt: skip
    if table == "beam" and rule_of(cell) == LOWER_EDGE:
        fields += [
            point_field("beam.position_xy_mm", "Point in plan view (X, Y)",
                        "Centre of the beam seen from above.", AXES[:2]),
            Field("beam.lower_edge_mm", "Lower edge", Kind.NUMBER, "Height of the lowest edge of "
                  "the beam.", "mm", step=5.0, required=True),
        ]  # fmt: skip
    else:
        tip = "Centre of the beam." if table == "beam" else "Where the origin of the mesh stands."
        fields.append(point_field(f"{table}.position_mm", "Position", tip))
    fields.append(
        Field(f"{table}.wpr_deg", "Orientation", Kind.NUMBERS, "FANUC's W, P, R of the beam's "
              "axes: x along the beam, y across the flanges, z along the height. 90, 0, 90 lays "
              "the web flat.", "deg", default=[0.0, 0.0, 0.0],
              parts=ANGLES)
    )  # fmt: skip
    return Section(
        "placement",
        "Placement",
        tuple(fields),
        (f"{table}.position_mm",),
        summary=_placed(cell, table),
        extra="touched_points" if table == "beam" else "",
        notes=_places(facts),
    )


def _placed(cell: Cell, table: str) -> str:
    return str(at(cell, f"{table}.frame", Frame.FLOOR.value))


def _places(facts: Facts) -> tuple[Note, ...]:
    if facts.workpiece is None:
        return ()
    x, y, z = (float(one) for one in facts.workpiece.placement[:3, 3])
    height = facts.world_height
    notes = []
    for text, shift in (
        ("Centre in fanuc_world: {x}, {y}, {z} mm", height),
        ("Centre in floor: {x}, {y}, {z} mm", 0.0),
    ):
        values = zip("xyz", (x, y, z - shift), strict=True)
        notes.append(Note(text, tuple((axis, decimal(in_mm(one), 1)) for axis, one in values)))
    return tuple(notes)


def workpiece_section(cell: Cell) -> Section:
    """A workpiece that is a mesh."""
    fields = (
        Field("workpiece.name", "Name", Kind.TEXT, "Name of the workpiece.", required=True),
        Field("workpiece.group", "Group", Kind.TEXT, "What 'touches' of a pass names.",
              default=at(cell, "workpiece.name")),
        Field("workpiece.mesh", "Mesh file", Kind.FILE, MESH_TIP, required=True),
        Field("workpiece.unit", "Unit of the mesh", Kind.CHOICE, "Unit of the mesh file.",
              choices=plain(tuple(LENGTH_UNITS)), default="mm"),
    )  # fmt: skip
    return Section(
        "beam", "Workpiece", fields, ("workpiece",), str(at(cell, "workpiece.name", "")), open=True
    )
