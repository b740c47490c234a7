"""What the export dialog shows: a frozen snapshot made from the plan's state, form and answers."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path
from typing import TYPE_CHECKING, Final

from posopt_gui.viewmodels.check_figures import check_figure, check_rank, figures
from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.viewmodels.number_words import clearance_mm
from solver.units import MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.check import Check
    from solver.pipeline.programming import ProgramDraft, ProgramOrder, WrittenProgram

Translate = Callable[..., str]

LEAST_REASON: Final = 10
"""Fewest characters of a reason for an override; the same as the program writer's."""

ROUNDING: Final = 0.2
"""Less than this [mm] the rounding of positions and figures changes a clearance."""

OVERRIDDEN: Final = "_OVR"
"""Ends the name of a program that is written although a check failed; the writer's too."""

_WAYPOINT = re.compile(r"waypoint (\d+)")
_LINE = re.compile(r"(?P<file>[\w.\-]+\.\w+):(?P<line>\d+)")


@dataclass(frozen=True, slots=True)
class Format:
    """A kind of file that a program is written as."""

    post: str
    label: str
    suffix: str


FORMATS: Final[tuple[Format, ...]] = (
    Format("fanuc-joint", "FANUC .LS, joint positions", ".LS"),
    Format("fanuc-cartesian", "FANUC .LS, Cartesian positions", ".LS"),
    Format("csv", "Table of moves, .csv", ".csv"),
    Format("json", "Neutral program, .json", ".json"),
)


def format_of(post: str) -> Format:
    """The kind of file of a post-processor; the first one where it is not known."""
    return next((one for one in FORMATS if one.post == post), FORMATS[0])


@dataclass(frozen=True, slots=True)
class ExportForm:
    """What a person chose: lengths in [m]; None leaves simplifying or accepting out."""

    post: str = FORMATS[0].post
    path: str = ""
    simplify: float | None = None
    accepted: float | None = None
    reason: str = ""

    @property
    def reason_given(self) -> bool:
        """Whether the reason is long enough for an override."""
        return len(self.reason.strip()) >= LEAST_REASON

    def order(self, *, override: bool = False) -> ProgramOrder:
        """The same as an order to the program writer."""
        # The writer loads the kernels, which the window must not wait for.
        from solver.pipeline.programming import ProgramOrder  # noqa: PLC0415

        reason = self.reason.strip() if override else None
        return ProgramOrder(self.accepted, self.post, self.simplify, reason)


class ExportStage(Enum):
    """Where the export stands; each has its own headline."""

    EMPTY = auto()
    PLANNING = auto()
    STALE = auto()
    ANSWERING = auto()
    BLOCKED = auto()
    CHECKING = auto()
    FAULT = auto()
    REFUSED = auto()
    PASSED = auto()
    WRITING = auto()


@dataclass(frozen=True, slots=True, eq=False)
class Situation:
    """Everything that the dialog's state follows from; least and required clearance in [m].

    `current` says whether the draft belongs to the plan and the form as they are now; `fault` is
    why there is no draft, `order_fault` why the file cannot be written ('' where it can, None
    while that is not known), `reason_fault` why the reason cannot be stamped, and `write_fault`
    why the last writing failed. `answering` says that the shown sequence is not (yet) that of the
    pins and regions, and `outdated` that the shown program is another one than the written one.
    """

    form: ExportForm = ExportForm()
    planned: bool = False
    planning: bool = False
    stale: bool = False
    answering: bool = False
    blocked: str = ""
    current: bool = False
    draft: ProgramDraft | None = None
    fault: str = ""
    order_fault: str | None = None
    reason_fault: str = ""
    writing: bool = False
    write_fault: str = ""
    written: WrittenProgram | None = None
    outdated: bool = False
    least: float = math.inf
    required: float = 0.0
    tolerance: float = 0.0

    @property
    def stage(self) -> ExportStage:
        """What comes first decides."""
        conditions = (
            (self.writing, ExportStage.WRITING),
            (self.planning, ExportStage.PLANNING),
            (not self.planned, ExportStage.EMPTY),
            (self.stale, ExportStage.STALE),
            (self.answering, ExportStage.ANSWERING),
            (bool(self.blocked), ExportStage.BLOCKED),
            (bool(self.fault), ExportStage.FAULT),
            (not self.current or self.draft is None, ExportStage.CHECKING),
            (self.draft is not None and bool(self.draft.report.failed), ExportStage.REFUSED),
        )
        return next((stage for holds, stage in conditions if holds), ExportStage.PASSED)


@dataclass(frozen=True, slots=True)
class CheckRow:
    """A check as a line for people; `waypoint` counts from 0, the `line` of a `file` from 1."""

    passed: bool
    word: str
    name: str
    value: str
    limit: str
    detail: str
    waypoint: int | None
    file: str = ""
    line: int | None = None


@dataclass(frozen=True, slots=True)
class ExportView:
    """What the dialog shows: `tone` is 'good', 'error', 'warning' or 'muted'."""

    stage: ExportStage
    tone: str
    headline: str
    explanation: str
    note: str
    note_tone: str
    rows: tuple[CheckRow, ...]
    files: tuple[tuple[str, str], ...]
    old: bool
    path_fault: str
    reason_hint: str
    reason_wrong: bool
    can_export: bool
    can_override: bool
    offers_plan: bool
    asks_clearance: bool
    asks_reason: bool


def export_view(now: Situation, tr: Translate) -> ExportView:
    """The dialog's content for a situation."""
    stage = now.stage
    settled = stage in {ExportStage.REFUSED, ExportStage.PASSED}
    draft = now.draft
    fits = now.order_fault == ""
    stamped = now.form.reason_given and not now.reason_fault
    tone, headline = _headline(now, tr)
    note_tone, note = _note(now, tr)
    return ExportView(
        stage=stage,
        tone=tone,
        headline=headline,
        explanation=_explanation(now, tr) if settled else "",
        note=note,
        note_tone=note_tone,
        rows=check_rows(draft.report.checks, tr) if draft is not None else (),
        files=draft.files if draft is not None else (),
        old=draft is not None and not settled,
        path_fault=sentence(now.order_fault or "", tr),
        reason_hint=sentence(now.reason_fault, tr) or _reason_hint(now.form, tr),
        reason_wrong=bool(now.reason_fault),
        can_export=stage is ExportStage.PASSED and fits,
        can_override=stage is ExportStage.REFUSED and fits and stamped,
        offers_plan=stage in {ExportStage.EMPTY, ExportStage.STALE},
        asks_clearance=now.planned and now.least < now.required,
        asks_reason=stage is ExportStage.REFUSED,
    )


_HEADLINES: Final[Mapping[ExportStage, tuple[str, str]]] = {
    ExportStage.EMPTY: ("muted", "There is no plan to export yet."),
    ExportStage.PLANNING: ("muted", "A plan is being made."),
    ExportStage.STALE: ("warning", "The inputs changed since this plan: plan again to export."),
    ExportStage.ANSWERING: (
        "muted",
        "The sequence for the pins and forbidden regions is being worked out.",
    ),
    ExportStage.BLOCKED: ("error", "No sequence keeps to the pins and forbidden regions: {reason}"),
    ExportStage.FAULT: ("error", "{reason}"),
    ExportStage.CHECKING: ("muted", "The program is being checked."),
    ExportStage.WRITING: ("muted", "The program is being written, read back and checked."),
}


def _headline(now: Situation, tr: Translate) -> tuple[str, str]:
    if now.stage not in _HEADLINES:
        return _verdict(now, tr)
    tone, words = _HEADLINES[now.stage]
    if "{reason}" not in words:
        return tone, tr(words)
    return tone, tr(words, reason=sentence(now.blocked or now.fault, tr))


def _verdict(now: Situation, tr: Translate) -> tuple[str, str]:
    checks = now.draft.report.checks if now.draft is not None else ()
    failed = sum(not check.passed for check in checks)
    if failed:
        first = next(row for row in check_rows(checks, tr) if not row.passed)
        words = "{failed} of {count} checks failed, first '{name}': no program is written."
        if failed == 1:
            words = "1 of {count} checks failed, '{name}': no program is written."
        return "error", tr(words, failed=failed, count=len(checks), name=first.name)
    clearance = _clearance_found(now)
    if not math.isfinite(clearance):
        return "good", tr("All {count} checks passed on the nominal model.", count=len(checks))
    words = "All {count} checks passed: clearance at least {clearance} mm on the nominal model."
    return "good", tr(words, count=len(checks), clearance=f"{clearance:.1f}")


def _clearance_found(now: Situation) -> float:
    """Clearance that the checks found [mm]; nan where there is none."""
    checks = now.draft.report.checks if now.draft is not None else ()
    return next((check.value for check in checks if check.name == "clearance"), math.nan)


def _explanation(now: Situation, tr: Translate) -> str:
    """Why the program's clearance is another number than the plan's, where it is."""
    found, planned = _clearance_found(now), now.least * MM_PER_M
    # Rounded positions move by hundredths of a millimetre: more than a figure is something else.
    if not abs(planned - found) < ROUNDING or f"{found:.1f}" == clearance_mm(now.least):
        return ""
    words = (
        "The plan's clearance is {clearance} mm. The program's positions are rounded to the "
        "file's decimals; its clearance is stated from these."
    )
    return tr(words, clearance=clearance_mm(now.least))


def _note(now: Situation, tr: Translate) -> tuple[str, str]:
    """What became of the last writing."""
    if now.write_fault:
        return "error", sentence(now.write_fault, tr)
    written = now.written
    if written is None:
        return "muted", ""
    names = ", ".join(path.name for path in written.paths)
    if written.override is not None:
        words = "{names} was written although checks failed, with your reason in it."
    else:
        words = "{names} was written, read back and checked."
    parts = [tr(words, names=names)]
    if written.stale:
        words = "Nothing calls these older parts any more: {names}"
        parts.append(tr(words, names=", ".join(path.name for path in written.stale)))
    if now.outdated:
        parts.append(tr("What is shown now is another program."))
    careful = written.override is not None or now.outdated
    return ("warning" if careful else "good"), " ".join(parts)


def _reason_hint(form: ExportForm, tr: Translate) -> str:
    missing = LEAST_REASON - len(form.reason.strip())
    if missing > 0:
        words = "A reason of at least {count} characters is stamped into the program."
        return tr(words, count=LEAST_REASON)
    name = override_target(form.path).name
    return tr("The program is written as {name}, with the reason in it.", name=name)


def override_target(path: str) -> Path:
    """Where a program goes that is written although checks failed."""
    target = Path(path)
    return target.with_stem(target.stem + OVERRIDDEN) if target.name else target


def check_rows(checks: Sequence[Check], tr: Translate) -> tuple[CheckRow, ...]:
    """All checks as lines: what failed first, then what matters most."""
    order = sorted(checks, key=lambda one: (one.passed, check_rank(one.name)))
    return tuple(_row(check, tr) for check in order)


def _row(check: Check, tr: Translate) -> CheckRow:
    file, line = line_of(check)
    shown, bound = figures(check.value, check.limit)
    return CheckRow(
        passed=check.passed,
        word=tr("passed") if check.passed else tr("FAILED"),
        name=tr(check.name),
        value=check_figure(shown, check.unit, tr),
        limit=check_figure(bound, check.unit, tr),
        detail=_detail(check, tr),
        waypoint=waypoint_of(check),
        file=file,
        line=line,
    )


def _detail(check: Check, tr: Translate) -> str:
    """The sentence of a check, and that it rests on an assumption where nothing else says so."""
    detail = sentence(check.detail, tr)
    said = (check.name + check.detail).lower()
    if not check.assumed or any(word in said for word in ("estimated", "assumed", "declared")):
        return detail
    words = tr("rests on an assumption")
    return f"{detail} ({words})" if detail else words


def waypoint_of(check: Check) -> int | None:
    """The waypoint (from 0) that a check is about, also where only its sentence names it."""
    if check.waypoint is not None:
        return check.waypoint
    found = _WAYPOINT.search(check.detail)
    return int(found.group(1)) - 1 if found is not None else None


def line_of(check: Check) -> tuple[str, int | None]:
    """File and line (from 1) of the program that a check's sentence names."""
    found = _LINE.search(check.detail)
    return (found["file"], int(found["line"])) if found is not None else ("", None)


def with_suffix(path: str, post: str) -> str:
    """A path with the suffix of another kind of file."""
    target = Path(path)
    return str(target.with_suffix(format_of(post).suffix)) if target.name else path
