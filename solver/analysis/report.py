"""A planning result as text for people and as a JSON document, in mm and degrees."""

from __future__ import annotations

from collections.abc import Sequence as Rows
from typing import Any

import numpy as np

from solver.analysis.check import Check, down_mm
from solver.analysis.metrics import JointMotion, joint_motion, lean_edge_share
from solver.analysis.references import Reference, ReferenceKind, references
from solver.analysis.result import PlanningResult, Sequence
from solver.candidates.generate import touch_numbers
from solver.candidates.outcomes import Outcome
from solver.candidates.postures import check_postures
from solver.kinematics.configuration import config_string
from solver.model.settings import Scheme
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD, MM_PER_M

DOCUMENT_VERSION = 2


def table(rows: Rows[Rows[str]]) -> str:
    """Rows as aligned columns: the first to the left, the others to the right."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = []
    for row in rows:
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append("  " + "  ".join(cells).rstrip())
    return "\n".join(lines)


def summary(result: PlanningResult) -> str:
    """The summary of a plan, for a terminal of 100 columns."""
    compared = references(result)
    parts = [
        _heading(result),
        _candidates(result),
        _schemes(result),
        _nearest(result),
        _motion(result, compared),
        _references(result, compared),
    ]
    return "\n\n".join(part for part in parts if part)


def _heading(result: PlanningResult) -> str:
    problem = result.problem
    beam = problem.workpiece.name
    passes = len(problem.toolpath.passes)
    word = "pass" if passes == 1 else "passes"
    lines = [
        f"{problem.title or problem.name}",
        f"  robot {problem.robot.title}, tool {problem.tool.title}, workpiece {beam}",
        f"  path {len(problem.toolpath)} waypoints in {passes} {word}",
    ]
    return "\n".join(lines)


def _candidates(result: PlanningResult) -> str:
    found = result.candidates
    waypoints, orientations, branches = found.outcome.shape
    counts = ", ".join(f"{count:,} {kind.label}" for kind, count in found.counts().items() if count)
    feasible = found.counts()[Outcome.FEASIBLE]
    return (
        f"Candidates: {waypoints} waypoints x {orientations} orientations x {branches} branches: "
        f"{counts}\n"
        f"  {feasible:,} feasible with their turns are {len(found.nodes):,} nodes; "
        f"{found.scene.pair_count} body pairs are checked"
    )


def _schemes(result: PlanningResult) -> str:
    chosen = list(result.sequences.values())
    rows = [["", *(one.scheme.value for one in chosen)]]
    rows.append(["joint cost", *(f"{one.joint_cost:.5f}" for one in chosen)])
    rows.append(["objective", *(f"{one.cost:.5f}" for one in chosen)])
    rows.append(["least clearance, mm", *(_shown(one.least_clearance) for one in chosen)])
    rows.append(["mean clearance, mm", *(_shown(one.mean_clearance) for one in chosen)])
    rows.append(["lean, deg", *(_range(one.angles[:, 0]) for one in chosen)])
    rows.append(
        ["branches", *(",".join(map(str, sorted(set(one.branch.tolist())))) for one in chosen)]
    )
    rows.append(["expanded nodes", *(f"{one.expanded}" if one.expanded else "-" for one in chosen)])
    text = "Schemes\n" + table(rows)
    if not result.clearance_met:
        asked = result.problem.settings.safety_distance * MM_PER_M
        text += (
            f"\n  The safety distance of {asked:g} mm cannot be kept; the best reachable minimum "
            f"is {down_mm(result.hard_minimum):.1f} mm"
            if Scheme.EXACT in result.sequences
            else f"\n  The safety distance of {asked:g} mm is not kept by {result.scheme.value}"
        )
    return text


def _shown(clearance: float) -> str:
    return f"{down_mm(clearance):.1f}"


def _branches(sequence: Sequence) -> str:
    return ",".join(map(str, sorted(set(sequence.branch.tolist()))))


def _range(angles: FloatArray) -> str:
    low, high = angles.min() * DEG_PER_RAD, angles.max() * DEG_PER_RAD
    return f"{low:.4g} .. {high:.4g}"


def _nearest(result: PlanningResult) -> str:
    sequence = result.sequence
    at = int(np.argmin(sequence.clearance))
    problem, scene = result.problem, result.candidates.scene
    touch = touch_numbers(problem, scene)[at : at + 1]
    found = check_postures(problem.robot, scene, sequence.pendant[at : at + 1], touch)
    one, other = found.bodies[0]
    lean = problem.settings.lean
    share = lean_edge_share(sequence.angles[:, 0], lean.lower, lean.upper)
    lines = [f"Nearest: {one} against {other} at waypoint {at + 1}"] if one else []
    if share > 0.0:
        lines.append(
            f"{100 * share:.0f} % of the waypoints lie at the edge of the lean range; "
            "a wider range may give a better plan"
        )
    return "\n".join(lines)


def _motion(result: PlanningResult, compared: tuple[Reference, ...]) -> str:
    motion = joint_motion(result.sequence.pendant)
    rows = [[f"{result.scheme.value}, pendant joints, deg", *(f"J{j}" for j in range(1, 7))]]
    for name, values in (
        ("cumulative variation", motion.variation),
        ("amplitude", motion.amplitude),
        ("standard deviation", motion.deviation),
        ("largest step", motion.largest_step),
    ):
        rows.append([name, *(f"{value * DEG_PER_RAD:.2f}" for value in values)])
    for one in compared:
        if one.motion is not None:
            gain = motion.gain_over(one.motion).variation
            cells = [f"{100 * value:+.0f} %" if np.isfinite(value) else "-" for value in gain]
            rows.append([f"variation against {one.kind.value}", *cells])
    return "Motion\n" + table(rows)


def _references(result: PlanningResult, compared: tuple[Reference, ...]) -> str:
    rows = [["", "joint cost", "least mm", "mean mm", "safety distance"]]
    for one in compared:
        name = one.kind.value
        if not one.found:
            rows.append([name, "none is feasible", "-", "-", "-"])
            continue
        if one.kind is not ReferenceKind.RANDOM:
            name += f" ({one.lean * DEG_PER_RAD:g} deg)"
        rows.append(
            [
                name,
                f"{one.joint_cost:.5f}",
                _shown(one.least_clearance),
                _shown(one.mean_clearance),
                "kept" if one.keeps_clearance else "not kept",
            ]
        )
    return "References\n" + table(rows) + f"\n  {verdict(result.sequence, compared[1])}"


def verdict(sequence: Sequence, constant: Reference) -> str:
    """Whether the plan beats the best constant lean, in plain words."""
    if not constant.found:
        return "No constant lean is feasible along this path."
    angle = constant.lean * DEG_PER_RAD
    saving = 1.0 - sequence.joint_cost / constant.joint_cost if constant.joint_cost else 0.0
    if not constant.keeps_clearance:
        return "No constant lean keeps the safety distance."
    if saving <= 1e-9:
        return f"The plan does not beat the constant lean of {angle:g} deg, which is as good."
    return f"The plan moves the joints {100 * saving:.1f} % less than the constant {angle:g} deg."


def result_document(
    result: PlanningResult,
    written: Any | None = None,
    refusal: Exception | None = None,
) -> dict[str, Any]:
    """The result as a JSON document (docs/json.md): mm, degrees, pendant joints."""
    compared = references(result)
    return {
        "format": "posopt-plan",
        "version": DOCUMENT_VERSION,
        "cell": result.problem.name,
        "workpiece": result.problem.workpiece.name,
        "scheme": result.scheme.value,
        "safety_distance_mm": result.problem.settings.safety_distance * MM_PER_M,
        "safety_distance_met": result.clearance_met,
        "hard_minimum_mm": result.hard_minimum * MM_PER_M,
        "candidates": {
            kind.name.lower(): count for kind, count in result.candidates.counts().items()
        },
        "nodes": len(result.candidates.nodes),
        "schemes": {
            scheme.value: _scheme_document(sequence)
            for scheme, sequence in result.sequences.items()
        },
        "motion": _motion_document(joint_motion(result.sequence.pendant)),
        "references": [_reference_document(result, one) for one in compared],
        "waypoints": _waypoints_document(result),
        "program": None if written is None else str(written.path),
        "files": [] if written is None else [str(one) for one in written.paths],
        "override": None if written is None else written.override,
        **program_document(None if written is None else written.report),
        "refused": None if refusal is None else str(refusal),
    }


def _scheme_document(sequence: Sequence) -> dict[str, Any]:
    return {
        "cost": sequence.cost,
        "joint_cost": sequence.joint_cost,
        "expanded": sequence.expanded,
        "least_clearance_mm": sequence.least_clearance * MM_PER_M,
        "mean_clearance_mm": sequence.mean_clearance * MM_PER_M,
    }


def _motion_document(motion: JointMotion) -> dict[str, Any]:
    return {
        "variation_deg": motion.variation * DEG_PER_RAD,
        "amplitude_deg": motion.amplitude * DEG_PER_RAD,
        "standard_deviation_deg": motion.deviation * DEG_PER_RAD,
        "largest_step_deg": motion.largest_step * DEG_PER_RAD,
    }


def _reference_document(result: PlanningResult, one: Reference) -> dict[str, Any]:
    document: dict[str, Any] = {"kind": one.kind.value, "found": one.found}
    if one.motion is not None:
        gain = joint_motion(result.sequence.pendant).gain_over(one.motion)
        document |= {
            "lean_deg": one.lean * DEG_PER_RAD,
            "joint_cost": one.joint_cost,
            "least_clearance_mm": one.least_clearance * MM_PER_M,
            "mean_clearance_mm": one.mean_clearance * MM_PER_M,
            "keeps_safety_distance": one.keeps_clearance,
            "motion": _motion_document(one.motion),
            "gain": {
                "variation": gain.variation,
                "amplitude": gain.amplitude,
                "standard_deviation": gain.deviation,
                "largest_step": gain.largest_step,
            },
        }
    return document


def _waypoints_document(result: PlanningResult) -> list[dict[str, Any]]:
    problem, sequence, scene = result.problem, result.sequence, result.candidates.scene
    found = check_postures(problem.robot, scene, sequence.pendant, touch_numbers(problem, scene))
    limits = problem.joint_limits
    slack = np.minimum(sequence.pendant - limits[:, 0], limits[:, 1] - sequence.pendant)
    world = problem.waypoint_poses
    return [
        {
            "waypoint": index + 1,
            "position_mm": world[index, :3, 3] * MM_PER_M,
            "joints_deg": sequence.pendant[index] * DEG_PER_RAD,
            "config": config_string(problem.robot, sequence.pendant[index]),
            "lean_deg": sequence.angles[index, 0] * DEG_PER_RAD,
            "lead_deg": sequence.angles[index, 1] * DEG_PER_RAD,
            "spin_deg": sequence.angles[index, 2] * DEG_PER_RAD,
            "branch": int(sequence.branch[index]),
            "turn": int(sequence.turn[index]),
            "clearance_mm": found.clearance[index] * MM_PER_M,
            "bodies": list(found.bodies[index]),
            "points_mm": found.points[index] * MM_PER_M,
            "manipulability_m3": sequence.manipulability[index],
            "limit_margin_deg": float(slack[index].min()) * DEG_PER_RAD,
        }
        for index in range(len(sequence.nodes))
    ]


def program_document(report: Any | None) -> dict[str, Any]:
    """Checks, predicted feeds and cycle time of a program as JSON."""
    if report is None:
        return {"checks": [], "positions": 0, "feeds": [], "cycle_s": None}
    return {
        "checks": [check_document(one) for one in report.checks],
        "positions": report.positions,
        "feeds": [
            {
                "line": one.place,
                "asked_mm_s": one.asked * MM_PER_M,
                "slowest_mm_s": one.prediction.slowest * MM_PER_M,
                "fastest_mm_s": one.prediction.fastest * MM_PER_M,
                "best_mm_s": one.prediction.best * MM_PER_M,
                "limiting_joint": f"J{one.prediction.joint + 1}",
                "held": one.held,
            }
            for one in report.feeds
        ],
        "cycle_s": None
        if report.cycle is None
        else {
            "total": report.cycle.total,
            "grinding": report.cycle.grinding,
            "linking": report.cycle.linking,
            "waiting": report.cycle.waiting,
            "assumed": "joint accelerations",
        },
    }


def check_document(check: Check) -> dict[str, Any]:
    """One check as JSON."""
    return {
        "name": check.name,
        "passed": check.passed,
        "value": check.value,
        "limit": check.limit,
        "unit": check.unit,
        "detail": check.detail,
        "waypoint": None if check.waypoint is None else check.waypoint + 1,
        "assumed": check.assumed,
    }
