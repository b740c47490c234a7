"""Tables of the report: settings, schemes, motion, feeds and waypoints, in mm and degrees."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.viewmodels.number_words import copied_decimal, signed
from solver.units import DEG_PER_RAD, MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult
    from solver.model.problem import PlanningProblem
    from solver.model.settings import Sweep
    from solver.pipeline.program_check import ProgramReport
    from solver.transforms import FloatArray

Translate = Callable[..., str]


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of texts; the columns from `numbers` on hold numbers."""

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: int = 1


def down(value_mm: float) -> str:
    """A clearance in mm, rounded down to 0.1 mm; a dash where it is not known."""
    if not math.isfinite(value_mm):
        return "\N{EN DASH}"
    return f"{math.floor(value_mm * 10.0 + 1e-7) / 10.0:.1f}"


def setting_rows(problem: PlanningProblem, tr: Translate) -> Table:
    """Inputs of the plan that a person would ask for."""
    settings, program = problem.settings, problem.program
    length = f"{problem.workpiece.length * MM_PER_M:g} mm"
    position = problem.fanuc_world_from_floor @ problem.workpiece.placement
    place = ", ".join(copied_decimal(value * MM_PER_M, 1) for value in position[:3, 3])
    margin = settings.self_margin
    fixtures = ", ".join(sentence(one.name, tr) for one in problem.fixtures)
    rows = [
        (tr("Robot"), tr(problem.robot.title)),
        (tr("Bodies"), tr(problem.bodies)),
        (tr("Tool"), tr(problem.tool.title)),
        (tr("Workpiece"), f"{problem.workpiece.name}, {length}"),
        (tr("Position in fanuc_world"), f"{place} mm"),
        (tr("Fixtures"), fixtures or tr("none")),
        (tr("Path"), _path_words(problem, tr)),
        (tr("Lean"), _sweep(settings.lean)),
        (tr("Lead"), _sweep(settings.lead)),
        (tr("Spin"), _sweep(settings.spin)),
        (tr("Safety distance"), f"{settings.safety_distance * MM_PER_M:g} mm"),
        (
            tr("Robot against itself"),
            tr("not checked") if margin is None else f"{margin * MM_PER_M:g} mm",
        ),
        (tr("Least manipulability"), f"{settings.manipulability:g} m\N{SUPERSCRIPT THREE}"),
        (tr("Joint limits"), _limits(problem)),
        (tr("Edge cost"), tr(settings.edge_cost.value)),
        (tr("Scheme"), settings.scheme.value),
        (tr("Program"), f"{program.name}, UF {problem.user_frame.number}, UT {program.utool}"),
        (tr("Path tolerance"), f"{program.path_tolerance * MM_PER_M:g} mm"),
        (tr("Feed tolerance"), f"{program.feed_tolerance * 100.0:g} %"),
    ]
    return Table((tr("Setting"), tr("Value")), tuple(rows), numbers=2)


def _path_words(problem: PlanningProblem, tr: Translate) -> str:
    feeds = sorted({one.feed * MM_PER_M for one in problem.toolpath.passes})
    shown = " .. ".join(f"{feed:g}" for feed in dict.fromkeys((feeds[0], feeds[-1])))
    words = "{waypoints} waypoints in {passes} passes, {feed} mm/s"
    count = len(problem.toolpath.passes)
    return tr(words, waypoints=len(problem.toolpath), passes=count, feed=shown)


def _sweep(sweep: Sweep) -> str:
    low, high = sweep.lower * DEG_PER_RAD, sweep.upper * DEG_PER_RAD
    if low == high:
        return f"{low:g}\N{DEGREE SIGN}"
    step = sweep.step * DEG_PER_RAD
    return f"{low:g}\N{DEGREE SIGN} .. {high:g}\N{DEGREE SIGN} / {step:g}\N{DEGREE SIGN}"


def _limits(problem: PlanningProblem) -> str:
    limits = problem.joint_limits * DEG_PER_RAD
    return ", ".join(
        f"J{joint} {low:g}..{high:g}\N{DEGREE SIGN}"
        for joint, (low, high) in enumerate(limits, start=1)
    )


def scheme_rows(document: Mapping[str, Any], tr: Translate) -> Table:
    """Schemes side by side; `document` is the result as `result_document` gives it."""
    rows = [
        (
            name,
            f"{one['joint_cost']:.5f}",
            f"{one['cost']:.5f}",
            down(one["least_clearance_mm"]),
            down(one["mean_clearance_mm"]),
            str(one["expanded"]) if one["expanded"] else "\N{EN DASH}",
        )
        for name, one in document["schemes"].items()
    ]
    head = ("Scheme", "Joint cost", "Objective", "Least mm", "Mean mm", "Expanded")
    return Table(tuple(map(tr, head)), tuple(rows))


def motion_rows(document: Mapping[str, Any], tr: Translate) -> Table:
    """How far and how unevenly each joint moves, and what that gains over the references."""
    rows = []
    for key, name in (
        ("variation_deg", "Cumulative variation"),
        ("amplitude_deg", "Amplitude"),
        ("standard_deviation_deg", "Standard deviation"),
        ("largest_step_deg", "Largest step"),
    ):
        rows.append((tr(name), *(f"{value:.2f}" for value in document["motion"][key])))
    for one in document["references"]:
        if "gain" in one:
            name = tr("Variation against {reference}", reference=tr(one["kind"]))
            rows.append((name, *(_gain(value) for value in one["gain"]["variation"])))
    joints = tuple(f"J{joint}" for joint in range(1, 7))
    return Table((tr("Pendant joints, deg"), *joints), tuple(rows))


def _gain(value: float) -> str:
    return f"{signed(100.0 * value, 0)} %" if math.isfinite(value) else "\N{EN DASH}"


def reference_rows(document: Mapping[str, Any], tr: Translate) -> Table:
    """What the plan is compared with."""
    rows = []
    for one in document["references"]:
        name = tr(one["kind"])
        if "motion" not in one:
            rows.append((name, tr("none is feasible"), *["\N{EN DASH}"] * 3))
            continue
        rows.append(
            (
                name,
                f"{one['joint_cost']:.5f}",
                down(one["least_clearance_mm"]),
                down(one["mean_clearance_mm"]),
                tr("kept") if one["keeps_safety_distance"] else tr("not kept"),
            )
        )
    head = ("Reference", "Joint cost", "Least mm", "Mean mm", "Safety distance")
    return Table(tuple(map(tr, head)), tuple(rows))


def feed_rows(report: ProgramReport, tr: Translate) -> Table:
    """Predicted against asked feed of every contact move."""
    rows = tuple(
        (
            sentence(one.place, tr),
            f"{one.asked * MM_PER_M:g}",
            f"{one.prediction.slowest * MM_PER_M:.2f}",
            f"{one.prediction.fastest * MM_PER_M:.2f}",
            f"{math.floor(one.prediction.best * MM_PER_M * 10.0) / 10.0:.1f}"
            if math.isfinite(one.prediction.best)
            else "\N{EN DASH}",
            f"J{one.prediction.joint + 1}",
            tr("held") if one.held else tr("NOT HELD"),
        )
        for one in report.feeds
    )
    head = ("Line", "Asked mm/s", "Slowest", "Fastest", "Best", "Limiting joint", "Feed")
    return Table(tuple(map(tr, head)), rows)


def waypoint_rows(document: Mapping[str, Any], bounds: FloatArray, tr: Translate) -> Table:
    """Every waypoint with its joints, angles, clearance and nearest bodies.

    `bounds` (n,) are the clearances that the plan counted on [m]; the lower value is shown.
    """
    rows = []
    for one, bound in zip(document["waypoints"], bounds, strict=True):
        names = [sentence(name, tr) for name in one["bodies"] if name]
        pair = " / ".join(names) or "\N{EN DASH}"
        rows.append(
            (
                str(one["waypoint"]),
                *(copied_decimal(value, 1) for value in one["position_mm"]),
                *(copied_decimal(value, 3) for value in one["joints_deg"]),
                copied_decimal(one["lean_deg"], 2),
                one["config"],
                down(min(one["clearance_mm"], float(bound) * MM_PER_M)),
                f"{one['manipulability_m3']:.3f}",
                f"{one['limit_margin_deg']:.1f}",
                pair,
            )
        )
    joints = tuple(f"J{joint}" for joint in range(1, 7))
    head = (
        "#", "X mm", "Y mm", "Z mm", *joints, tr("Lean"), "CONFIG", tr("Clearance mm"),
        tr("Manipulability"), tr("To limits"), tr("Nearest bodies"),
    )  # fmt: skip
    return Table(head, tuple(rows), numbers=0)


def figures(
    result: PlanningResult, report: ProgramReport, tr: Translate
) -> tuple[tuple[str, str], ...]:
    """The summary: a name and a value with its unit each."""
    sequence = result.sequence
    found = next((one.value for one in report.checks if one.name == "clearance"), math.nan)
    least = min(found, sequence.least_clearance * MM_PER_M) if math.isfinite(found) else found
    shown = [
        (tr("Least clearance"), f"{down(least)} mm"),
        (tr("Mean clearance"), f"{down(sequence.mean_clearance * MM_PER_M)} mm"),
        (tr("Joint cost"), f"{sequence.joint_cost:.5f}"),
        (tr("Positions"), str(report.positions)),
    ]
    if report.cycle is not None:
        shown.append((tr("Cycle time, estimated"), f"{report.cycle.total:.1f} s"))
    if report.feeds:
        slowest = min(one.prediction.slowest for one in report.feeds) * MM_PER_M
        shown.append((tr("Slowest feed, predicted"), f"{slowest:.1f} mm/s"))
    return tuple(shown)
