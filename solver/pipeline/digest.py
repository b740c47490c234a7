"""A short name for everything of a problem that its program's checks depend on."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np

from solver.model.problem import PlanningProblem

DECIMALS = 9
"""Numbers are rounded to this before they are hashed, so that the platform does not matter."""


def problem_digest(problem: PlanningProblem) -> str:
    """12 hexadecimal digits over robot, tool, workpiece, fixtures, path, windows and limits.

    Of the program's settings those count that its checks compare with; its name and marks, the
    scheme, the weights and the accelerations (an estimate) are left out.
    """
    settings, program = problem.settings, problem.program
    parts = (
        problem.robot,
        problem.bodies,
        problem.tool,
        problem.workpiece,
        problem.fixtures,
        problem.toolpath.frame,
        problem.toolpath.passes,
        problem.joint_windows,
        settings.lean,
        settings.lead,
        settings.spin,
        settings.manipulability,
        settings.safety_distance,
        settings.self_margin,
        settings.steps,
        problem.accuracy,
        problem.user_frame.number,
        problem.user_tool.number,
        program.payload,
        program.spindle_on,
        program.spindle_off,
        program.path_tolerance,
        program.feed_tolerance,
        program.links,
    )
    digest = hashlib.sha256()
    _feed(digest, parts)
    return digest.hexdigest()[:12]


def _feed(digest: Any, value: Any) -> None:
    """Add a value with its kind, so that no two different problems read alike."""
    if isinstance(value, Enum):
        digest.update(f"e{value.value};".encode())
    elif is_dataclass(value):
        digest.update(f"d{type(value).__name__};".encode())
        for field in fields(value):
            if field.name not in {"title", "assumptions", "source", "accelerations"}:
                _feed(digest, getattr(value, field.name))
    elif isinstance(value, Mapping):
        digest.update(f"m{len(value)};".encode())
        for key in sorted(value, key=repr):
            _feed(digest, (key, value[key]))
    elif isinstance(value, frozenset):
        _feed(digest, sorted(sorted(one) if isinstance(one, frozenset) else one for one in value))
    elif isinstance(value, tuple | list):
        digest.update(f"t{len(value)};".encode())
        for one in value:
            _feed(digest, one)
    elif isinstance(value, np.ndarray):
        rounded = np.round(value.astype(np.float64), DECIMALS) + 0.0
        digest.update(f"a{value.shape};".encode() + rounded.astype("<f8").tobytes())
    elif isinstance(value, float):
        digest.update(b"f" + np.array(round(value, DECIMALS) + 0.0, "<f8").tobytes())
    else:
        digest.update(f"{type(value).__name__}{value!r};".encode())
