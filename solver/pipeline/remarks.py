"""The remarks at the head of a program: what it was made for, and what it was checked against.

A remark holds 32 characters. What is stated here is compared again when the program is checked.
"""

from __future__ import annotations

import re

import numpy as np

from solver.errors import InputError
from solver.io.ls_hash import HASH_REMARK
from solver.io.ls_program import ProgramFile
from solver.io.posts.fanuc_text import stamped
from solver.model.problem import PlanningProblem
from solver.model.program import NumberedPose
from solver.pipeline.digest import problem_digest
from solver.transforms import wpr_from_rotation
from solver.units import DEG_PER_RAD, MM, MM_PER_M

CELL_REMARK = "CELL "
BEAM_REMARK = "BEAM "
DIGEST_REMARK = "DIGEST "
CLEARANCE_REMARK = "MIN CLEARANCE "
ACCEPTED_REMARK = "ACCEPTED CLEARANCE "
OVERRIDE_REMARK = "OVERRIDE "
NO_HASH = "0" * 12

POSE_REMARK = re.compile(r"U[FT][0-9]+ ([XZP] |measured|nominal)")
"""Begins a remark on a frame or tool."""

_CLEARANCE = re.compile(r"[0-9]{1,4}[.][0-9]{1,3}")


def head_remarks(
    problem: PlanningProblem,
    clearance: float | None,
    *,
    accepted: float | None = None,
    override: str | None = None,
    content: str = NO_HASH,
) -> tuple[str, ...]:
    """All remarks; `clearance` [m] is the least of the contact positions, `content` the hash.

    A clearance that is not known, or that no pair of bodies has, is left out.
    """
    section = problem.workpiece.section
    lines = [f"{CELL_REMARK}{problem.name}"]
    if section is not None:
        lines.append(f"{BEAM_REMARK}{section.name}")
    lines += pose_remarks(problem)
    lines.append(f"{DIGEST_REMARK}{problem_digest(problem)}")
    lines.append(f"{HASH_REMARK}{content}")
    if clearance is not None and np.isfinite(clearance):
        lines.append(f"{CLEARANCE_REMARK}{clearance * MM_PER_M:.1f} MM")
    if accepted is not None:
        lines.append(f"{ACCEPTED_REMARK}{accepted * MM_PER_M:.3f} MM")
    if override is None:
        return (*lines, "checked on the nominal model", "verify in T1")
    reason = stamped(OVERRIDE_REMARK, override)
    return (*lines, *reason, "CHECKS FAILED, see the report", "verify in T1")


def pose_remarks(problem: PlanningProblem) -> list[str]:
    """The remarks on user frame and tool: their values, measured or nominal."""
    frame, tool = problem.user_frame, problem.user_tool
    return [*_pose_remarks("UF", frame), *_pose_remarks("UT", tool)]


def _pose_remarks(letter: str, numbered: NumberedPose) -> list[str]:
    """X to R of a frame or tool, two to a line, and whether they were measured."""
    x, y, z = (value * MM_PER_M for value in numbered.pose[:3, 3])
    w, p, r = (value * DEG_PER_RAD for value in wpr_from_rotation(numbered.pose[:3, :3]))
    key = f"{letter}{numbered.number}"
    return [
        f"{key} X {x + 0.0:.3f} Y {y + 0.0:.3f}",
        f"{key} Z {z + 0.0:.3f} W {w + 0.0:.3f}",
        f"{key} P {p + 0.0:.3f} R {r + 0.0:.3f}",
        f"{key} {'measured' if numbered.measured else 'nominal'}",
    ]


def remark_value(written: ProgramFile, prefix: str) -> str | None:
    """What follows a prefix in the first remark that has it, None where none has."""
    for remark in written.remarks:
        if remark.startswith(prefix):
            return remark.removeprefix(prefix).strip()
    return None


def stated_clearance(written: ProgramFile, prefix: str) -> float | None:
    """The clearance [m] that a remark states, None where none does."""
    text = remark_value(written, prefix)
    if text is None:
        return None
    number = text.removesuffix("MM").strip()
    if not _CLEARANCE.fullmatch(number) or (prefix == ACCEPTED_REMARK and float(number) <= 0.0):
        raise InputError(f"{written.file}: remark {prefix + text!r} names no clearance above 0")
    return float(number) * MM


def stated_override(written: ProgramFile) -> str | None:
    """The reason for which a program was written although checks failed, None without one."""
    parts = [
        remark.removeprefix(OVERRIDE_REMARK)
        for remark in written.remarks
        if remark.startswith(OVERRIDE_REMARK)
    ]
    return "".join(parts) if parts else None


def required_clearance(problem: PlanningProblem, written: ProgramFile) -> float:
    """What the program has to keep [m]: the safety distance, or less where it says so."""
    accepted = stated_clearance(written, ACCEPTED_REMARK)
    asked = problem.settings.safety_distance
    return asked if accepted is None else min(accepted, asked)
