"""Fields of planning: lean, branches, limits, clearance, weights and the search."""

from __future__ import annotations

from functools import partial

from posopt_gui.viewmodels.cell_facts import in_mm
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
from solver.catalog.cell_settings import MAXIMUM_SEED
from solver.model.robot import JOINTS
from solver.model.settings import EdgeCost, PlanningSettings, Scheme, Sweep, Turns
from solver.units import DEG_PER_RAD

JOINT_NAMES = tuple(f"J{joint + 1}" for joint in range(JOINTS))
SWEEP = ("from", "to", "step")

BRANCH_LETTERS = ("NUT", "FUT", "NDT", "FDT", "NUB", "FUB", "NDB", "FDB")
"""Letters of the controller's CONFIG of branch 0 to 7."""

_NEW_STEPS = [20.0] * JOINTS
_NEW_LEAN_STEP = 5.0


def lean_section(cell: Cell) -> Section:
    """Which orientations and postures are tried."""
    default = PlanningSettings()
    fields = (
        _sweep("settings.lean_deg", "Lean", "Leans that are tried at every waypoint, about the "
               "tool's y axis.", default.lean),
        _sweep("settings.lead_deg", "Lead", "Leads that are tried, about the tool's x axis; from "
               "and to alike is the one angle.", default.lead),
        _sweep("settings.spin_deg", "Spin", "Spins that are tried, about the tool's z axis; from "
               "and to alike is the one angle.", default.spin),
        Field("settings.branches", "Branches", Kind.SUBSET, "Branches of the inverse kinematics "
              "that are tried, by the letters of the controller: N or F wrist, U or D elbow, T or "
              "B (front or back).", default=list(default.branches),
              choices=tuple(
                  Choice(number, letters, plain=True)
                  for number, letters in enumerate(BRANCH_LETTERS)
              )),
        Field("settings.turns", "Turns", Kind.CHOICE, "Every full turn of a joint inside its "
              "limits, or only the one within 180°.", default=default.turns.value,
              choices=(Choice(Turns.ALL.value, "all within the limits"),
                       Choice(Turns.PRINCIPAL.value, "within 180°"))),
    )  # fmt: skip
    sweep = at(cell, "settings.lean_deg")
    summary = ""
    if isinstance(sweep, list) and all(isinstance(one, int | float) for one in sweep[:3]):
        summary = " … ".join(f"{one:g}".replace("-", "−") for one in sweep[:2]) + "°"
    return Section(
        "lean",
        "Lean and branches",
        fields,
        ("settings.lean_deg",),
        summary=summary,
    )


def _sweep(key: str, label: str, tip: str, default: Sweep) -> Field:
    values = [default.lower, default.upper, default.step]
    degrees = [round(one * DEG_PER_RAD, 6) for one in values]
    if default == Sweep.fixed():
        degrees = [0.0, 0.0, 1.0]
    return Field(key, label, Kind.NUMBERS, tip, "deg", default=degrees,
                 parts=SWEEP)  # fmt: skip


def limits_section(cell: Cell) -> Section:
    """What a pose and a step must keep."""
    default = PlanningSettings()
    margin = in_mm(default.self_margin or 0.0)
    fields = [
        Field("settings.safety_distance_mm", "Safety distance", Kind.NUMBER, "Least clearance of "
              "every pose of the program against workpiece and fixtures.", "mm", 0.0,
              step=5.0, default=in_mm(default.safety_distance)),
        Field("settings.self_check", "Check against itself", Kind.FLAG, "Whether bodies of the "
              "robot and its tool are checked against the robot; without it every check says so.",
              default=True,
              read=lambda one: at(one, "settings.self_margin_mm") is not False,
              apply=lambda one, value: _with_self_margin(one, margin if value else False)),
    ]  # fmt: skip
    if at(cell, "settings.self_margin_mm") is not False:
        fields.append(
            Field("settings.self_margin_mm", "Self margin", Kind.NUMBER, "Least distance between "
                  "bodies of the robot, and of the tool to them.", "mm", 0.0,
                  default=margin)
        )  # fmt: skip
    fields.append(
        Field("settings.manipulability_m3", "Manipulability", Kind.NUMBER, "A pose must have more "
              "than this, which keeps it away from singular postures.", "m³", 0.0, step=0.001,
              decimals=3, default=default.manipulability)
    )  # fmt: skip
    fields += _step_fields(cell)
    distance = at(cell, "settings.safety_distance_mm", in_mm(default.safety_distance))
    return Section(
        "limits",
        "Limits and clearance",
        tuple(fields),
        ("settings.steps",),
        summary=f"{distance:g} mm" if isinstance(distance, int | float) else "",
    )


def _with_self_margin(cell: Cell, value: object) -> Cell:
    return with_table(cell, "settings", {**table_of(cell, "settings"), "self_margin_mm": value})


def _step_fields(cell: Cell) -> list[Field]:
    fields = []
    for key, flag, label, tip in (
        ("joints_deg", "Limit joint steps", "Joint steps",
         "Largest step of each pendant joint between waypoints of a pass."),
        ("link_joints_deg", "Limit link steps", "Link steps",
         "Largest step of each pendant joint between passes."),
    ):  # fmt: skip
        whole = f"settings.steps.{key}"
        stated = at(cell, whole) is not None
        # A flag without limits bears the key of the limits, so that their error is shown there.
        fields.append(
            Field(whole if not stated else f"{whole}_stated", flag, Kind.FLAG, tip, on=_NEW_STEPS,
                  off=None, default=None,
                  read=partial(at, key=whole), apply=partial(_with_steps, key))
        )  # fmt: skip
        if stated:
            fields.append(
                Field(whole, label, Kind.NUMBERS, tip, "deg", 0.0, above=True,
                      parts=JOINT_NAMES)
            )  # fmt: skip
    fields += [
        Field("settings.steps.lean_deg", "Lean step", Kind.NUMBER, "Largest step of the lean "
              "between waypoints of a pass.", "deg", 0.0, above=True, unset="no limit"),
        Field("settings.steps.at_feed", "Hold the feed", Kind.FLAG, "Whether no joint may need "
              "more than its speed at the asked feed.",
              default=PlanningSettings().steps.at_feed),
    ]  # fmt: skip
    return fields


def _with_steps(key: str, cell: Cell, value: object) -> Cell:
    steps = table_of(cell, "settings.steps")
    steps.pop(key, None)
    if value is not None:
        steps[key] = value
    return with_table(cell, "settings", {**table_of(cell, "settings"), "steps": steps})


def cost_section(cell: Cell) -> Section:
    """What is cheap, and how the graph is searched."""
    default = PlanningSettings()
    weights = default.weights
    fields = (
        Field("settings.scheme", "Scheme", Kind.CHOICE, "The search: exact is proven optimal on "
              "the graph; f, f1 and f2 are the heuristic searches that it is compared with.",
              default=default.scheme.value,
              choices=tuple(
                  Choice(one.value, one.value, plain=one is not Scheme.EXACT) for one in Scheme
              )),
        Field("settings.edge_cost", "Joint changes", Kind.CHOICE, "How a change of joints between "
              "neighbouring waypoints is counted.", default=default.edge_cost.value,
              choices=(Choice(EdgeCost.ABSOLUTE.value, "absolute"),
                       Choice(EdgeCost.SQUARED.value, "squared"))),
        _weight("clearance", "Weight of clearance", "Weight of (1 - d / comfort)², d being the "
                "clearance below the comfort.", weights.clearance),
        Field("settings.weights.comfort_mm", "Comfort", Kind.NUMBER, "Clearance from which on "
              "that term is zero.", "mm", 0.0, above=True, step=10.0,
              default=in_mm(weights.comfort)),
        _weight("lean", "Weight of lean", "Weight of the squared deviation from the nominal lean, "
                "in units of 45°.", weights.lean),
        _weight("lead", "Weight of lead", "Weight of the squared deviation from the nominal lead, "
                "in units of 45°.", weights.lead),
        _weight("link", "Weight of links", "Factor of the joint cost between passes.",
                weights.link),
        Field("settings.heuristic_weight", "Heuristic weight", Kind.NUMBER, "Weight of the "
              "heuristic of f, f1 and f2.", "", 0.0, 1.0, step=0.05, decimals=2,
              default=default.heuristic_weight),
        Field("settings.seed", "Seed", Kind.INTEGER, "Seed of the reference with random lean.",
              low=0, high=MAXIMUM_SEED, default=default.seed),
    )  # fmt: skip
    return Section(
        "cost",
        "Cost and search",
        fields,
        ("settings.weights", "settings"),
        summary=str(at(cell, "settings.scheme", default.scheme.value)),
        said=True,
    )


def _weight(name: str, label: str, tip: str, default: float) -> Field:
    return Field(f"settings.weights.{name}", label, Kind.NUMBER, tip, "", 0.0, step=0.05,
                 decimals=2, default=default)  # fmt: skip
