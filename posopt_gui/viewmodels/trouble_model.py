"""When there is no sequence: which constraint, where, by how much, and what to try."""

from __future__ import annotations

import re
from collections.abc import Callable
from collections.abc import Sequence as Rows
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.number_words import decimal, subject_words
from solver.errors import PosoptError
from solver.units import DEG_PER_RAD

if TYPE_CHECKING:
    from posopt_gui.viewmodels.form_types import Cell
    from solver.pipeline.replanning import Replanned

_IN_ALL = re.compile(r"; (\d+) waypoints in all have none")

Translate = Callable[..., str]


@dataclass(frozen=True, slots=True)
class Cause:
    """A sentence, and the waypoint (from 0) where it happens."""

    text: str
    waypoint: int | None = None


@dataclass(frozen=True, slots=True)
class Trouble:
    """Why there is nothing to show: headline, causes and advice; `key` is the input's."""

    headline: str
    causes: tuple[Cause, ...] = ()
    advice: str = ""
    key: str | None = None


def trouble_of(
    problem_error: PosoptError | None,
    plan_error: PosoptError | None,
    answer: Replanned | None,
    translate: Translate,
    cell: Cell | None = None,
) -> Trouble | None:
    """What keeps the session from a sequence; None where nothing does.

    With a `cell`, a wrong input is called by the name of its field.
    """
    if problem_error is not None:
        return _input_trouble(problem_error, translate, cell or {})
    if plan_error is not None:
        return _plan_trouble(plan_error, translate)
    if answer is not None and answer.sequence is None:
        headline = translate("Your pins and forbidden regions leave no sequence.")
        advice = translate("Take a pin or a region away, or undo the last one.")
        cause = Cause(reason_words(answer.reason, translate), answer.layer)
        return Trouble(headline, (cause,), advice)
    return None


def plan_words(error: PosoptError, translate: Translate) -> str:
    """Why there is no plan, in one or two sentences."""
    trouble = _plan_trouble(error, translate)
    return " ".join([trouble.headline, *(one.text for one in trouble.causes[:1])])


def _input_trouble(error: PosoptError, translate: Translate, cell: Cell) -> Trouble:
    # The form takes a moment to load, which only a wrong input costs.
    from posopt_gui.viewmodels.input_words import input_key, input_words  # noqa: PLC0415

    cause = Cause(input_words(error, cell, translate))
    key = input_key(error, cell)
    return Trouble(translate("The inputs cannot be used."), (cause,), "", key)


def _plan_trouble(error: PosoptError, translate: Translate) -> Trouble:
    headline = translate("No sequence exists.")
    empty: Rows[Any] = getattr(error, "empty", ())
    cut: Any = getattr(error, "cut", None)
    advice = _capital(translate(str(error).rsplit("; ", 1)[-1])) + translate(".")
    if empty:
        several = _IN_ALL.search(str(error))
        if several is not None:
            headline = translate(
                "No sequence exists: {count} waypoints have no feasible pose.", count=several[1]
            )
        return Trouble(headline, tuple(_layer_cause(one, translate) for one in empty), advice)
    if cut is not None:
        return Trouble(headline, tuple(_gap_cause(one, translate) for one in cut.gaps), advice)
    return Trouble(headline, (Cause(error_words(error, translate)),))


def _layer_cause(layer: Any, translate: Translate) -> Cause:
    worst, nearest = layer.missed, layer.nearest
    counts = translate(", ").join(
        translate("{count} {outcome}", count=count, outcome=translate(kind.label))
        for kind, count in layer.rejected.items()
    )
    text = translate(
        "Waypoint {number}: every candidate is rejected ({counts}). The nearest, lean {lean}° on "
        "branch {branch}, misses {missing} {unit}: {subject} ({filter}).",
        number=layer.waypoint + 1,
        counts=counts,
        lean=decimal(nearest.lean * DEG_PER_RAD, 2),
        branch=nearest.branch,
        missing=decimal(-worst.margin, 1 if worst.unit == "mm" else 2),
        unit=worst.unit,
        subject=subject_words(worst.subject, translate),
        filter=translate(worst.filter.label),
    )
    return Cause(text, layer.waypoint)


def _gap_cause(gap: Any, translate: Translate) -> Cause:
    what = translate("the lean") if gap.joint is None else f"J{gap.joint}"
    text = translate(
        "From waypoint {number} to {next} {what} would have to step by {step}° or more, where "
        "{limit}° are allowed.",
        number=gap.gap + 1,
        next=gap.gap + 2,
        what=what,
        step=decimal(gap.step * DEG_PER_RAD, 2),
        limit=decimal(gap.limit * DEG_PER_RAD, 2),
    )
    return Cause(text, gap.gap)


def reason_words(reason: str, translate: Translate) -> str:
    """A sentence of re-planning in the window's language."""
    return _capital(sentence(reason, translate)) + translate(".")


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
