"""Fields of the robot program: its head, its links, and the declared accuracy."""

from __future__ import annotations

from posopt_gui.viewmodels.cell_facts import in_mm
from posopt_gui.viewmodels.form_fields_settings import JOINT_NAMES
from posopt_gui.viewmodels.form_types import (
    Cell,
    Choice,
    Field,
    Kind,
    Section,
    at,
    table_of,
    with_table,
)
from solver.catalog.cell_program import (
    FEWEST_LINES,
    LONGEST_NAME,
    MAXIMUM_PAYLOAD,
    MAXIMUM_REGISTER,
    MAXIMUM_UFRAME,
    MAXIMUM_UTOOL,
    MOST_LINES,
)
from solver.io.posts import POSTS
from solver.model.program_settings import (
    ContactMotion,
    LinkSettings,
    ProgramSettings,
    Withdrawal,
)
from solver.model.robot import JOINTS

NEW_ACCURACY = {"robot_mm": 1.0, "workpiece_mm": 2.0, "tcp_mm": 0.5}
"""What a newly declared accuracy begins with: the assumption of the shipped cells."""


def program_section(cell: Cell) -> Section:
    """Head and form of the robot program."""
    default = ProgramSettings()
    fields = (*_head_fields(default), *_motion_fields(default), *_controller_fields(default))
    return Section(
        "program",
        "Program",
        fields,
        ("program",),
        summary=str(at(cell, "program.name", default.name)),
    )


def _head_fields(default: ProgramSettings) -> tuple[Field, ...]:
    return (
        Field("program.name", "Name", Kind.TEXT, "Name of the program: up to 36 of A-Z, 0-9 and _, "
              "a letter first.", default=default.name),
        Field("program.comment", "Comment", Kind.TEXT, "Comment in the pendant's list: up to 16 "
              "ASCII characters.", default=default.comment),
        Field("program.post", "Post-processor", Kind.CHOICE, "Which form the program is written "
              "in.", default=default.post,
              choices=tuple(Choice(one, one, plain=True) for one in POSTS)),
        Field("program.uframe", "User frame", Kind.INTEGER, "Number of the user frame; 0 is "
              "fanuc_world, any other one is the workpiece's frame.", low=0, high=MAXIMUM_UFRAME,
              default=default.uframe),
        Field("program.utool", "Tool number", Kind.INTEGER, "Number of the tool frame.", low=1,
              high=MAXIMUM_UTOOL, default=default.utool),
        Field("program.payload", "Payload schedule", Kind.INTEGER, "Payload schedule that the "
              "program selects.", low=1, high=MAXIMUM_PAYLOAD, unset="not selected"),
        Field("program.offset_register", "Offset register", Kind.INTEGER, "Position register of "
              "an offset of all positions.", low=1, high=MAXIMUM_REGISTER, unset="no offset"),
        Field("program.frame_measured", "Frame measured", Kind.FLAG, "Whether the placement of "
              "the workpiece was measured at the cell.", default=default.frame_measured),
        Field("program.tool_measured", "TCP measured", Kind.FLAG, "Whether the tool's TCP was "
              "measured at the cell.", default=default.tool_measured),
    )  # fmt: skip


def _motion_fields(default: ProgramSettings) -> tuple[Field, ...]:
    return (
        Field("program.contact", "Contact moves", Kind.CHOICE, "How the tool is moved along the "
              "path: joint moves that take the time of their distance, or linear moves at the "
              "feed.", default=default.contact.value,
              choices=(Choice(ContactMotion.JOINT.value, "joint moves"),
                       Choice(ContactMotion.LINEAR.value, "linear moves"))),
        Field("program.approach_percent", "First move", Kind.INTEGER, "Joint speed of the move to "
              "the first position where there are no links.", "%", 1, 100,
              default=default.approach_percent),
        Field("program.path_tolerance_mm", "Path tolerance", Kind.NUMBER, "How far the moved TCP "
              "may leave the path between positions.", "mm", 0.001, step=0.1,
              default=in_mm(default.path_tolerance)),
        Field("program.feed_tolerance", "Feed tolerance", Kind.NUMBER, "How far the predicted "
              "speed of the TCP may be from the feed, as a share.", "", 0.0, 1.0, step=0.05,
              decimals=2, default=default.feed_tolerance),
    )  # fmt: skip


def _controller_fields(default: ProgramSettings) -> tuple[Field, ...]:
    return (
        Field("program.spindle_on", "Spindle on", Kind.TEXT, "Program on the controller that "
              "switches the spindle on.", default=default.spindle_on),
        Field("program.spindle_off", "Spindle off", Kind.TEXT, "Program on the controller that "
              "switches the spindle off.", default=default.spindle_off),
        Field("program.name_length", "Longest name", Kind.INTEGER, "Longest program name that the "
              "controller takes.", low=1, high=LONGEST_NAME, default=default.name_length),
        Field("program.line_limit", "Most lines", Kind.INTEGER, "Most lines of a program that the "
              "controller takes; longer ones are split.", low=FEWEST_LINES, high=MOST_LINES,
              step=100, default=default.line_limit),
        Field("program.date", "Date", Kind.TEXT, "Date in the file as YY-MM-DD; never the "
              "clock's.", default=default.date),
        Field("program.time", "Time", Kind.TEXT, "Time in the file as HH:MM:SS; never the "
              "clock's.", default=default.time),
    )  # fmt: skip


def links_section(cell: Cell) -> Section:
    """How the tool comes to a pass and leaves it."""
    stated = at(cell, "program.links") is not None
    flag = Field("program.links", "Plan links", Kind.FLAG, "Whether approach, retract and the ways "
                 "between passes are planned and written.", on={}, off=None)  # fmt: skip
    fields = [flag]
    if stated:
        fields += [*_link_fields(LinkSettings()), *_home_fields(cell), *_event_fields()]
    return Section(
        "links",
        "Links between passes",
        tuple(fields),
        ("program.links",),
        summary="" if stated else "–",
    )


def _link_fields(default: LinkSettings) -> list[Field]:
    rows = (
        ("approach_mm", "Approach", "How far the tool is withdrawn before and after a pass.",
         default.approach, 1.0, 5.0),
        ("lead_in_mm", "Lead-in", "How far before the first waypoint the tool comes down, against "
         "the travel; 0 leaves it out.", default.lead_in, 0.0, 1.0),
        ("lead_in_height_mm", "Lead-in height", "Height of the lead-in above the face.",
         default.lead_in_height, 0.0, 1.0),
        ("lead_out_mm", "Lead-out", "How far behind the last waypoint the tool has left; 0 leaves "
         "it out.", default.lead_out, 0.0, 1.0),
        ("lead_out_height_mm", "Lead-out height", "Height of the lead-out above the face.",
         default.lead_out_height, 0.0, 1.0),
        ("height_mm", "Lift of links", "How far the tool is lifted, straight up, where the direct "
         "way is not free.", default.height, 0.0, 10.0),
        ("clearance_mm", "Link clearance", "Least clearance on everything that is no contact "
         "move.", default.clearance, 0.0, 5.0),
    )  # fmt: skip
    fields = [
        Field(f"program.links.{key}", label, Kind.NUMBER, tip, "mm", low, step=step,
              default=in_mm(value))
        for key, label, tip, value, low, step in rows
    ]  # fmt: skip
    return [
        *fields,
        Field("program.links.withdrawal", "Withdrawn along", Kind.CHOICE, "Direction in which the "
              "tool leaves the face.", default=default.withdrawal.value,
              choices=(Choice(Withdrawal.TOOL.value, "the tool's axis"),
                       Choice(Withdrawal.NORMAL.value, "the face's normal"))),
        Field("program.links.speed_mm_s", "Approach speed", Kind.NUMBER, "Speed of approach and "
              "retract.", "mm/s", 1.0, step=10.0, default=in_mm(default.speed)),
        Field("program.links.percent", "Link speed", Kind.INTEGER, "Joint speed of links and of "
              "the moves from and to home.", "%", 1, 100, step=5, default=default.percent),
    ]  # fmt: skip


def _home_fields(cell: Cell) -> list[Field]:
    key = "program.links.home_deg"
    stated = at(cell, key) is not None
    flag = Field("program.links.home", "Home position", Kind.FLAG, "Whether the program begins and "
                 "ends at a home position.", on=[0.0] * JOINTS, off=None,
                 read=lambda one: at(one, key), apply=_with_home)  # fmt: skip
    if not stated:
        return [flag]
    return [
        flag,
        Field(key, "Home joints", Kind.NUMBERS, "Pendant joints of the home position.", "deg",
              parts=JOINT_NAMES),
    ]  # fmt: skip


def _with_home(cell: Cell, value: object) -> Cell:
    links = table_of(cell, "program.links")
    links.pop("home_deg", None)
    if value is not None:
        links["home_deg"] = value
    return with_table(cell, "program", {**table_of(cell, "program"), "links": links})


def _event_fields() -> list[Field]:
    words = "spindle-on, spindle-off, dwell:SECONDS, do:NUMBER=0 or 1, call:PROGRAM"
    return [
        Field("program.links.before", "Before a pass", Kind.WORDS, "What happens above the face "
              "before a pass: " + words + ".", default=[]),
        Field("program.links.after", "After a pass", Kind.WORDS, "What happens above the face "
              "after a pass: " + words + ".", default=[]),
    ]  # fmt: skip


def accuracy_section(cell: Cell) -> Section:
    """How far the real cell may be from the nominal one."""
    stated = at(cell, "accuracy") is not None
    fields = [
        Field("accuracy", "Declare accuracy", Kind.FLAG, "Whether the cell declares how far it may "
              "be from the nominal model; it is taken off every clearance.", on=NEW_ACCURACY,
              off=None),
    ]  # fmt: skip
    if stated:
        fields += [
            Field(f"accuracy.{key}_mm", label, Kind.NUMBER, tip, "mm", 0.0, step=0.1,
                  required=True)
            for key, label, tip in (
                ("robot", "Of the robot", "How far the robot may be from its model."),
                ("workpiece", "Of the workpiece", "How far the workpiece may be from its place."),
                ("tcp", "Of the TCP", "How far the TCP may be from its stated place."),
            )
        ]  # fmt: skip
    parts = [at(cell, f"accuracy.{one}_mm", 0.0) for one in ("robot", "workpiece", "tcp")]
    numbers = stated and all(isinstance(one, int | float) for one in parts)
    return Section(
        "accuracy",
        "Accuracy of the cell",
        tuple(fields),
        ("accuracy",),
        summary=f"Σ {sum(parts):g} mm" if numbers else "–",
    )
