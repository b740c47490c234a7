"""The table of waypoints: numbers to sort by, and the texts that are shown."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence as Rows
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from posopt_gui.viewmodels.number_words import NOTHING, clearance_mm, decimal, pair_words
from solver.kinematics.configuration import config_string
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD, MM, MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult, Sequence

Translate = Callable[..., str]


@dataclass(frozen=True, slots=True)
class Column:
    """A column: its key, and how many decimals its numbers have (None: text)."""

    key: str
    decimals: int | None = 2


COLUMNS = (
    Column("number", 0),
    Column("pass", None),
    Column("lean"),
    Column("lead"),
    Column("spin"),
    Column("branch", 0),
    Column("config", None),
    *(Column(f"J{joint}") for joint in range(1, 7)),
    Column("clearance", 1),
    Column("bodies", None),
    Column("limit"),
    Column("manipulability", 4),
    Column("step"),
)
"""All columns in their order."""


class WaypointTable:
    """Rows of one sequence; texts are made when they are asked for.

    `bodies` are the names of the nearest pairs, empty while they are not known.
    """

    def __init__(
        self,
        result: PlanningResult,
        sequence: Sequence,
        bodies: Rows[tuple[str, str]],
        translate: Translate,
    ) -> None:
        problem = result.problem
        self._robot = problem.robot
        self._sequence = sequence
        self._bodies = bodies
        self._translate = translate
        index = problem.toolpath.pass_index
        self._passes = [
            translate((one.name or str(number)).replace("_", " "))
            for number, one in enumerate(problem.toolpath.passes, start=1)
        ]
        limits = problem.joint_limits
        pendant = sequence.pendant
        slack = np.minimum(pendant - limits[:, 0], limits[:, 1] - pendant).min(axis=1)
        step = np.full(len(pendant), np.nan)
        step[1:] = np.abs(np.diff(pendant, axis=0)).max(axis=1)
        step[1:][index[1:] != index[:-1]] = np.nan
        self._values: dict[str, FloatArray] = {
            "number": np.arange(1.0, len(pendant) + 1.0),
            "pass": index.astype(np.float64),
            "branch": sequence.branch.astype(np.float64),
            "clearance": sequence.clearance * MM_PER_M,
            "limit": slack * DEG_PER_RAD,
            "manipulability": sequence.manipulability,
            "step": step * DEG_PER_RAD,
        }
        for column, name in enumerate(("lean", "lead", "spin")):
            self._values[name] = sequence.angles[:, column] * DEG_PER_RAD
        for joint in range(6):
            self._values[f"J{joint + 1}"] = pendant[:, joint] * DEG_PER_RAD
        swept = ((problem.settings.lead, "lead"), (problem.settings.spin, "spin"))
        still = {name for sweep, name in swept if len(sweep.angles()) == 1}
        self.columns = tuple(one for one in COLUMNS if one.key not in still)

    def __len__(self) -> int:
        return len(self._sequence.pendant)

    def key(self, row: int, column: int) -> float | str:
        """What a column is sorted by."""
        name = self.columns[column].key
        if name in self._values:
            value = float(self._values[name][row])
            return value if np.isfinite(value) else -1.0
        return self.text(row, column)

    def text(self, row: int, column: int) -> str:
        """What is shown."""
        one = self.columns[column]
        if one.key == "pass":
            return self._passes[int(self._values["pass"][row])]
        if one.key == "config":
            return config_string(self._robot, self._sequence.pendant[row])
        if one.key == "bodies":
            return self._pair(row)
        value = float(self._values[one.key][row])
        if one.key == "clearance":
            return clearance_mm(value * MM)
        return decimal(value, one.decimals or 0)

    def _pair(self, row: int) -> str:
        if row >= len(self._bodies) or not self._bodies[row][0]:
            return NOTHING
        return pair_words(*self._bodies[row], self._translate)

    def title(self, column: int) -> str:
        """Head of a column, with its unit."""
        translate = self._translate
        titles = {
            "number": translate("No."),
            "pass": translate("Pass"),
            "lean": translate("Lean °"),
            "lead": translate("Lead °"),
            "spin": translate("Spin °"),
            "branch": translate("Branch"),
            "config": translate("CONFIG"),
            "clearance": translate("Clearance mm"),
            "bodies": translate("Nearest bodies"),
            "limit": translate("To limit °"),
            "manipulability": translate("Manipulability m³"),
            "step": translate("Step °"),
        }
        key = self.columns[column].key
        return titles.get(key, f"{key} °")
