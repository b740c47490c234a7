"""Curves over the waypoints: the plan, what it is compared with, and their measures."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from posopt_gui.viewmodels.number_words import NOTHING, decimal, signed
from solver.analysis.metrics import JointMotion, joint_motion
from solver.transforms import FloatArray, IntArray
from solver.units import DEG_PER_RAD, MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult, Sequence
    from solver.model.problem import PlanningProblem
    from solver.pipeline.program_check import ProgramReport

Translate = Callable[..., str]

PLAN = "PLAN"
"""Name of the plan among the curves; the others are called as their kind of reference."""

LEAST_SPAN = 4.0
"""Least height of a joint's axis [deg]: a joint at rest is drawn as a flat line."""

NEAR_LIMIT = 0.1
"""Share of a joint's range: a curve that comes nearer to a limit has the limit on its axis."""

LIMIT_BAND = 0.05
"""Share of the axis beyond a limit that is on it."""

DWARFING = 3.0
"""A curve this many times as high as the highest of the others is cut."""

_WAYPOINT = re.compile(r"waypoint (\d+)")


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """One sequence as curves over n waypoints.

    Attributes
    ----------
    name : str
        `PLAN` or the name of the kind of reference.
    joints : (n, 6) array
        Pendant joints [deg].
    clearance : (n,) array [mm]
    manipulability : (n,) array [m^3]
    steps : (n, 6) array
        How far each joint moves to the waypoint from the one before [deg]; nan at the first
        waypoint of a pass, which links lead to.
    motion : JointMotion
        Measures of the joints; for the random lean the mean over all draws.
    lean : (n,) array [deg]
    branch : (n,) array of int
        Branch of the inverse kinematics.
    """

    name: str
    joints: FloatArray
    clearance: FloatArray
    manipulability: FloatArray
    steps: FloatArray
    motion: JointMotion
    lean: FloatArray
    branch: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class FeedCurve:
    """Predicted speed of the contact move to each waypoint, beside the asked one.

    All arrays are (m,): `waypoint` counts from 1, speeds in [mm/s]; `held` says whether the
    move keeps the feed within the cell's tolerance, `joint` (1 to 6) limits it.
    """

    waypoint: FloatArray
    slowest: FloatArray
    fastest: FloatArray
    asked: FloatArray
    held: np.ndarray[tuple[int], np.dtype[np.bool_]]
    joint: np.ndarray[tuple[int], np.dtype[np.int64]]


@dataclass(frozen=True, slots=True)
class MeasureRow:
    """A row of the table of measures; a heading has no cells.

    `texts` are shown; `gains` are the relative changes behind them (nan: none), by which they
    are coloured.
    """

    label: str
    texts: tuple[str, ...] = ()
    gains: tuple[float, ...] = ()
    heading: bool = False


def waypoint_axis(count: int) -> FloatArray:
    """(n,) places of the waypoints on the shared axis: their numbers, from 1."""
    return np.arange(1.0, count + 1.0)


def axis_place(place: float) -> float:
    """Where a place in waypoints from 0 stands on the shared axis."""
    return place + 1.0


def place_on_path(axis: float, count: int) -> float:
    """Place in waypoints from 0 of a position on the shared axis, kept within the path."""
    return min(max(axis - 1.0, 0.0), max(count - 1.0, 0.0))


def first_of_passes(problem: PlanningProblem) -> tuple[int, ...]:
    """The first waypoint (from 0) of every pass but the first."""
    starts = np.cumsum([len(one) for one in problem.toolpath.passes])[:-1]
    return tuple(int(start) for start in starts)


def broken(values: FloatArray, starts: Iterable[int]) -> tuple[FloatArray, FloatArray]:
    """A line over the waypoints that is interrupted before each of `starts`."""
    numbers = waypoint_axis(len(values))
    places = list(starts)
    if not places:
        return numbers, values
    return (
        np.insert(numbers, places, [numbers[start] - 0.5 for start in places]),
        np.insert(values, places, np.nan),
    )


def sequence_track(problem: PlanningProblem, sequence: Sequence) -> Track:
    """The curves of the shown sequence."""
    return _track(
        problem, PLAN, sequence.pendant, sequence.clearance, sequence.manipulability, None,
        sequence.angles[:, 0], sequence.branch,
    )  # fmt: skip


def compared_tracks(result: PlanningResult) -> tuple[Track, ...]:
    """Curves of the references that there are; takes as long as `solver.references` twice.

    The curves of the random lean are those of its first draw.
    """
    from posopt_gui.viewmodels.reference_nodes import reference_nodes  # noqa: PLC0415 - numba
    from solver.analysis.references import references  # noqa: PLC0415
    from solver.kinematics.jacobian import posture_manipulability  # noqa: PLC0415

    tracks = []
    table, robot = result.candidates.nodes, result.problem.robot
    branches = result.candidates.branches[table.candidate[:, 2]]
    for one in references(result):
        nodes = reference_nodes(result, one)
        if nodes is None:
            continue
        pendant = table.pendant[nodes]
        dexterity = posture_manipulability(robot, pendant)
        tracks.append(
            _track(
                result.problem, one.kind.name, pendant, table.clearance[nodes], dexterity,
                one.motion, result.candidates.lean[nodes], branches[nodes],
            )
        )  # fmt: skip
    return tuple(tracks)


def _track(
    problem: PlanningProblem,
    name: str,
    pendant: FloatArray,
    clearance: FloatArray,
    manipulability: FloatArray,
    motion: JointMotion | None,
    lean: FloatArray,
    branch: IntArray,
) -> Track:
    steps = np.full_like(pendant, np.nan)
    steps[1:] = np.abs(np.diff(pendant, axis=0)) * DEG_PER_RAD
    steps[list(first_of_passes(problem))] = np.nan
    return Track(
        name,
        pendant * DEG_PER_RAD,
        clearance * MM_PER_M,
        manipulability,
        steps,
        motion or joint_motion(pendant),
        lean * DEG_PER_RAD,
        branch,
    )


def joint_range(
    values: Iterable[FloatArray], limits: FloatArray, *, whole: bool, headroom: float = 0.0
) -> tuple[float, float]:
    """Lower and upper end of a joint's axis [deg]: around the curves, or around the limits.

    Around the curves a limit is on the axis, with a band beyond it, where they come near to it.

    `headroom` is the share of the axis that is kept free at its top, for words.
    """
    low, high = map(float, limits)
    if whole:
        room = 0.06 * (high - low)
        return _with_headroom(low - room, high + room, headroom)
    shown = np.concatenate([np.asarray(one, dtype=np.float64) for one in values] or [limits])
    lower, upper = float(np.nanmin(shown)), float(np.nanmax(shown))
    missing = max(0.0, LEAST_SPAN - (upper - lower)) / 2.0
    lower, upper = lower - missing, upper + missing
    room = 0.12 * (upper - lower)
    bottom, top = lower - room, upper + room
    near = NEAR_LIMIT * (high - low)
    if lower - low < near:
        bottom = min(bottom, low)
    if high - upper < near:
        top = max(top, high)
    band = LIMIT_BAND * (top - bottom)
    bottom -= band if bottom <= low else 0.0
    top += band if top >= high else 0.0
    return _with_headroom(bottom, top, headroom)


def step_range(tracks: Iterable[Track]) -> tuple[float, list[tuple[str, float]]]:
    """Largest step of all joints together that is shown [deg], and who steps farther.

    A reference that steps many times as far as the others does not press them flat.
    """
    highs = [
        (one.name, float(np.nanmax(one.steps.sum(axis=1), initial=0.1)))
        for one in tracks
        if len(one.steps)
    ]
    sizes = sorted(high for _, high in highs)
    top = sizes[-1] if sizes else 1.0
    if len(sizes) > 1 and top > DWARFING * sizes[-2]:
        top = sizes[-2]
    return top, [(name, high) for name, high in highs if high > top]


def _with_headroom(low: float, high: float, share: float) -> tuple[float, float]:
    return low, low + (high - low) / (1.0 - min(share, 0.6))


def free_side(
    values: Iterable[FloatArray], low: float, high: float, *, part: float = 0.2, height: float = 0.5
) -> str:
    """Where words have room in a plot's left part: 'top', 'bottom', or '' for neither.

    `part` is the share of the width and `height` that of the height which the words take.
    """
    ends = [np.asarray(one)[: max(int(part * len(one)) + 1, 2)] for one in values]
    if not ends:
        return "top"
    shown = (np.concatenate(ends) - low) / (high - low)
    if float(np.nanmax(shown)) < 1.0 - height:
        return "top"
    return "bottom" if float(np.nanmin(shown)) > height else ""


def axis_ticks(low: float, high: float, most: int) -> tuple[float, ...]:
    """At most `most` round values within a range, and at least one."""
    finer = np.array([(low + high) / 2.0])
    exponent = np.floor(np.log10(max(high - low, 1e-9))) - 1.0
    for factor in (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0):
        step = factor * 10.0**exponent
        first, last = np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9)
        found = np.arange(first, last + 1.0) * step + 0.0
        if 1 < len(found) <= most:
            return tuple(map(float, found))
        if len(found) <= 1:
            break
        finer = found
    # There is room for one only: of the finer values the one nearest to the middle.
    return (float(finer[np.abs(finer - (low + high) / 2.0).argmin()]),)


def joint_words(joint: int, value: float) -> str:
    """A joint (1 to 6) with its angle [deg], as rich text."""
    return f"<b>J{joint}</b> {decimal(value, 2)}°"


def limit_words(translate: Translate, joint: int, value: float, limits: FloatArray) -> str:
    """A joint's angle [deg] with its limits and what is left to the nearer one."""
    low, high = map(float, limits)
    return translate(
        "J{joint} {value}°, limits {low}° to {high}°, {left}° left",
        joint=joint,
        value=decimal(value, 2),
        low=decimal(low, 2),
        high=decimal(high, 2),
        left=decimal(min(value - low, high - value), 2),
    )


def feed_curve(report: ProgramReport | None) -> FeedCurve | None:
    """Predicted and asked feeds by waypoint; None where the report holds none."""
    if report is None or not report.feeds:
        return None
    numbers = []
    for one in report.feeds:
        found = _WAYPOINT.search(one.place)
        numbers.append(float(found[1]) if found else float(one.move + 2))
    return FeedCurve(
        np.array(numbers),
        np.array([one.prediction.slowest for one in report.feeds]) * MM_PER_M,
        np.array([one.prediction.fastest for one in report.feeds]) * MM_PER_M,
        np.array([one.asked for one in report.feeds]) * MM_PER_M,
        np.array([one.held for one in report.feeds]),
        np.array([one.prediction.joint + 1 for one in report.feeds], dtype=np.int64),
    )


def move_steps(waypoint: FloatArray, value: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A line of one value for the move to each waypoint (m,), interrupted where it changes."""
    x = np.column_stack([waypoint - 1.0, waypoint]).ravel()
    y = np.repeat(value, 2)
    ends = 2 * np.flatnonzero((np.diff(waypoint) != 1.0) | (np.diff(value) != 0.0)) + 2
    return np.insert(x, ends, x[ends - 1]), np.insert(y, ends, np.nan)


def feed_words(translate: Translate, curve: FeedCurve, row: int) -> str:
    """Predicted and asked feed of a move; which joint limits it only where it falls short."""
    figures = {
        "slowest": decimal(curve.slowest[row], 1), "fastest": decimal(curve.fastest[row], 1),
        "asked": decimal(curve.asked[row], 1),
    }  # fmt: skip
    if curve.held[row] and figures["slowest"] == figures["fastest"]:
        return translate("predicted {slowest} mm/s, asked {asked} mm/s", **figures)
    if curve.held[row]:
        return translate("predicted {slowest} to {fastest} mm/s, asked {asked} mm/s", **figures)
    return translate(
        "predicted {slowest} to {fastest} mm/s, asked {asked} mm/s, J{joint} limits",
        **figures, joint=int(curve.joint[row]),
    )  # fmt: skip


def kind_label(translate: Translate, name: str) -> str:
    """What a curve is called in legends and tables."""
    return {
        PLAN: translate("plan"),
        "NOMINAL": translate("nominal lean"),
        "CONSTANT": translate("best constant lean"),
        "RANDOM": translate("random lean"),
    }[name]


def short_label(translate: Translate, name: str) -> str:
    """The same in one word, where there is little room."""
    return {
        PLAN: translate("plan"),
        "NOMINAL": translate("nominal"),
        "CONSTANT": translate("constant"),
        "RANDOM": translate("random"),
    }[name]


def measure_rows(plan: Track, compared: Iterable[Track], translate: Translate) -> list[MeasureRow]:
    """Measures of the plan per joint, each with its gain over the references.

    The columns are J1 to J6; a gain is the relative change of the plan against the reference,
    so that -90 % is nine tenths less.
    """
    references = list(compared)
    rows = []
    for label, name in (
        (translate("Cumulative change, °"), "variation"),
        (translate("Amplitude, °"), "amplitude"),
        (translate("Standard deviation, °"), "deviation"),
        (translate("Largest step, °"), "largest_step"),
    ):
        own: FloatArray = getattr(plan.motion, name) * DEG_PER_RAD
        rows.append(MeasureRow(label, heading=True))
        rows.append(MeasureRow(translate("plan"), tuple(f"{value:.2f}" for value in own)))
        for other in references:
            gain: FloatArray = getattr(plan.motion.gain_over(other.motion), name)
            against = translate("against {name}", name=kind_label(translate, other.name))
            rows.append(
                MeasureRow(against, tuple(map(percent, gain)), tuple(float(one) for one in gain))
            )
    return rows


def percent(share: float) -> str:
    """A relative change in words, without decimals; a dash where there is none."""
    if not np.isfinite(share):
        return NOTHING
    if abs(share) >= 10.0:
        return f"×{share + 1.0:.0f}"
    rounded = round(100.0 * share)
    return f"{signed(rounded, 0)} %"
