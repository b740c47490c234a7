"""Placement error: the planned joints against a workpiece that lies a little off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from solver.analysis.result import Sequence
from solver.candidates.generate import touch_numbers
from solver.candidates.postures import check_exact_postures
from solver.collision.kernels_scene import FREE, HIT
from solver.collision.scene import build_scene
from solver.model.problem import PlanningProblem
from solver.model.settings import Scheme
from solver.study.context import Study
from solver.study.sections import Column, Section, StudyTable, Value
from solver.transforms import FloatArray, rigid, rotation_from_wpr
from solver.units import DEG_PER_RAD, MM_PER_M


def displaced(problem: PlanningProblem, shift: FloatArray, turn: FloatArray) -> PlanningProblem:
    """The problem with its workpiece moved by `shift` [m] and turned about itself by W, P, R.

    The robot's joints are not planned anew; the path is left where it was.
    """
    piece = problem.workpiece
    moved = rigid(
        piece.placement[:3, :3] @ rotation_from_wpr(*turn), piece.placement[:3, 3] + shift
    )
    return replace(problem, workpiece=replace(piece, placement=moved))


def clearances(
    problem: PlanningProblem, sequence: Sequence, shifts: FloatArray, turns: FloatArray
) -> tuple[FloatArray, np.ndarray]:
    """(draws,) least clearance [m] of the planned joints and whether the draw collides.

    A pose whose tool comes closer than its own margin counts with no clearance of its own, as
    the cell's contact bodies necessarily do when the face moves towards them.
    """
    least, hit = np.empty(len(shifts)), np.zeros(len(shifts), np.bool_)
    for draw, (shift, turn) in enumerate(zip(shifts, turns, strict=True)):
        scene = build_scene(displaced(problem, shift, turn))
        touch = touch_numbers(problem, scene)
        found = check_exact_postures(problem.robot, scene, sequence.pendant, touch)
        hit[draw] = bool(np.any(found.status == HIT))
        kept = found.clearance[(found.status == FREE) & np.isfinite(found.clearance)]
        least[draw] = 0.0 if hit[draw] else float(kept.min(initial=np.inf))
    return least, hit


def placement(study: Study) -> Section:
    """Seeded draws of a displaced workpiece under f and f2, and the exact scheme."""
    parameters, problem = study.parameters, study.problem
    random = np.random.default_rng(parameters.placement_seed)
    draws = parameters.placement_draws
    if study.result.candidates.scene.meshes:
        return Section("placement", TITLE, reason="the workpiece is a mesh: draws take too long")
    shifts = random.uniform(-1.0, 1.0, (draws, 3)) * parameters.placement_shift
    turns = random.uniform(-1.0, 1.0, (draws, 3)) * parameters.placement_turn
    rows: list[tuple[Value, ...]] = []
    found: dict[str, FloatArray] = {}
    for scheme in (Scheme.F, Scheme.F2, Scheme.EXACT):
        sequence = study.sequence(scheme)
        least, hit = clearances(problem, sequence, shifts, turns)
        found[scheme.value] = least
        rows.append(
            (
                scheme.value,
                sequence.least_clearance * MM_PER_M,
                float(np.median(least)) * MM_PER_M,
                float(np.quantile(least, parameters.placement_quantile)) * MM_PER_M,
                float(least.min()) * MM_PER_M,
                100.0 * float(hit.mean()),
            )
        )
    table = StudyTable(
        "placement",
        f"{draws:,} draws of a displaced workpiece",
        (
            Column("scheme"),
            Column("planned least clearance", "mm"),
            Column("median", "mm"),
            Column(f"{100.0 * parameters.placement_quantile:g} % quantile", "mm"),
            Column("worst", "mm"),
            Column("draws that collide", "%"),
        ),
        tuple(rows),
    )
    f, f2 = rows[0], rows[1]
    text = (
        f"With the workpiece off by up to ±{parameters.placement_shift * MM_PER_M:g} mm along and "
        f"±{parameters.placement_turn * DEG_PER_RAD:g} deg about each axis (uniform, about the "
        f"origin of its frame, {draws:,} draws), the least clearance of f2 falls from {f2[1]:.1f} "
        f"to {f2[4]:.1f} mm, that of f from {f[1]:.1f} to {f[4]:.1f} mm; f collides in {f[5]:.2f} "
        f"%, f2 in {f2[5]:.2f} % of the draws.",
        "Only the collision bodies are judged, not whether the tool still meets the face.",
    )
    numbers = {str(row[0]): {"worst_mm": row[4], "collides_percent": row[5]} for row in rows}
    return Section("placement", TITLE, text, (table,), numbers=numbers)


TITLE = "Placement error"
