"""A plan and its program as one HTML page that needs nothing else and prints well."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from posopt_gui.viewmodels.export_model import check_rows
from posopt_gui.viewmodels.report_rows import (
    Table,
    down,
    feed_rows,
    figures,
    motion_rows,
    reference_rows,
    scheme_rows,
    setting_rows,
    waypoint_rows,
)
from solver.errors import InputError
from solver.units import MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult
    from solver.pipeline.programming import ProgramDraft

Translate = Callable[..., str]

PNG_SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"

CAPTIONS: Final[Mapping[str, str]] = {
    "scene": "The cell with the robot at the shown waypoint",
    "map": "Map of all candidates, waypoint against lean, with the chosen sequence",
    "curves": "Joints, clearance and speed along the path",
}
"""Pictures in their order; their names are the keys of `ReportContent.pictures`."""

STYLE: Final = """
@page { size: A4; margin: 14mm 12mm; }
* { box-sizing: border-box; }
body { font: 10.5pt/1.45 "Segoe UI", "Noto Sans", "Noto Sans CJK SC", "Microsoft YaHei",
  "PingFang SC", sans-serif; color: #1b232c; background: #ffffff; margin: 0 auto;
  max-width: 190mm; padding: 10mm 6mm; }
h1 { font-size: 20pt; margin: 0 0 2mm; line-height: 1.2; }
h2 { font-size: 13pt; margin: 9mm 0 3mm; padding-bottom: 1mm; border-bottom: 1px solid #cbd3dc;
  break-after: avoid; }
p { margin: 0 0 2mm; }
.muted { color: #586574; }
.verdict { border: 1px solid #cbd3dc; border-left: 5px solid #1e6b3a; padding: 3mm 4mm;
  margin: 5mm 0; font-weight: 600; color: #1e6b3a; border-radius: 3px; }
.verdict.failed { border-left-color: #b3261e; color: #b3261e; }
.override { border: 2px solid #b3261e; padding: 3mm 4mm; margin: 5mm 0; border-radius: 3px; }
.figures { display: grid; grid-template-columns: repeat(3, 1fr); gap: 3mm; margin: 4mm 0; }
.figures div { border: 1px solid #cbd3dc; border-radius: 3px; padding: 2.5mm 3mm;
  break-inside: avoid; }
.figures span { display: block; color: #586574; font-size: 9pt; }
.figures strong { font-size: 15pt; font-variant-numeric: tabular-nums; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: 1.1mm 2mm;
  border-bottom: 1px solid #dce2e9; overflow-wrap: anywhere; }
th { color: #586574; font-weight: 600; border-bottom-color: #cbd3dc; overflow-wrap: normal; }
thead { display: table-header-group; }
tr { break-inside: avoid; }
.number { text-align: right; white-space: nowrap; }
.passed { color: #1e6b3a; font-weight: 600; }
.failed { color: #b3261e; font-weight: 600; }
.wide { font-size: 6.6pt; line-height: 1.3; }
.wide th, .wide td { padding: 0.6mm 0.7mm; white-space: nowrap; }
.wide td:last-child { white-space: normal; }
figure { margin: 0 0 5mm; break-inside: avoid; }
figure img { width: 100%; height: auto; border: 1px solid #cbd3dc; border-radius: 3px;
  display: block; }
figcaption { color: #586574; font-size: 9pt; margin-top: 1mm; }
code { font-family: "DejaVu Sans Mono", Consolas, monospace; }
footer { margin-top: 10mm; border-top: 1px solid #cbd3dc; padding-top: 2mm; font-size: 9pt; }
@media print { body { padding: 0; max-width: none; } }
"""


@dataclass(frozen=True, slots=True, eq=False)
class ReportContent:
    """What a report is made of.

    Attributes
    ----------
    result, draft
        The plan, and its program with the checks.
    pictures : mapping of 'scene', 'map', 'curves' to the bytes of a PNG
        What is missing or empty is left out.
    override : str or None
        The reason for which the program was written although checks failed.
    """

    result: PlanningResult
    draft: ProgramDraft
    pictures: Mapping[str, bytes]
    override: str | None = None


def report_page(content: ReportContent, tr: Translate, language: str = "en") -> str:
    """The whole page; the same content gives the same text.

    Raises
    ------
    InputError
        When a picture is no PNG.
    """
    from solver.analysis.report import result_document  # noqa: PLC0415 - loads the kernels

    result, draft = content.result, content.draft
    problem, report = result.problem, draft.report
    document = result_document(result)
    waypoints = waypoint_rows(document, result.sequence.clearance, tr)
    title = tr(problem.title) if problem.title else problem.name
    body = [
        _head(content, title, tr),
        _override(content.override, tr),
        _figures(figures(result, report, tr)),
        _pictures(content.pictures, tr),
        _section(tr("Checks of the program"), _checks(content, tr)),
        _section(tr("Schemes"), _table(scheme_rows(document, tr)) + _clearance_note(result, tr)),
        _section(tr("Motion of the joints"), _table(motion_rows(document, tr))),
        _section(tr("Compared with"), _table(reference_rows(document, tr))),
        _section(tr("Settings"), _table(setting_rows(problem, tr))),
        _section(tr("Predicted feed"), _table(feed_rows(report, tr))) if report.feeds else "",
        _section(tr("Waypoints"), _table(waypoints, "wide")),
        _section(tr("Assumptions"), _assumptions(result, tr)),
        _foot(content, tr),
    ]
    return (
        f'<!DOCTYPE html>\n<html lang="{html.escape(language.replace("_", "-"))}">\n<head>\n'
        f'<meta charset="utf-8">\n<title>{_text(f"{draft.program.name} - {title}")}</title>\n'
        f"<style>{STYLE}</style>\n</head>\n<body>\n"
        + "\n".join(part for part in body if part)
        + "\n</body>\n</html>\n"
    )


def _text(value: str) -> str:
    return html.escape(value, quote=True)


def _head(content: ReportContent, title: str, tr: Translate) -> str:
    problem, report = content.result.problem, content.draft.report
    failed, count = len(report.failed), len(report.checks)
    if failed:
        words = tr("{failed} of {count} checks failed.", failed=failed, count=count)
    else:
        words = tr("All {count} checks passed on the nominal model.", count=count)
    files = ", ".join(name for name, _ in content.draft.files)
    cell = tr("Cell {cell}, program {files}", cell=problem.name, files=files)
    mark = " failed" if failed else ""
    return (
        f"<header><h1>{_text(title)}</h1>\n"
        f'<p class="muted">{_text(cell)}</p></header>\n'
        f'<p class="verdict{mark}">{_text(words)}</p>'
    )


def _override(reason: str | None, tr: Translate) -> str:
    if reason is None:
        return ""
    words = tr("Written although checks failed, for this reason:")
    return f'<p class="override">{_text(words)} <strong>{_text(reason)}</strong></p>'


def _figures(shown: Iterable[tuple[str, str]]) -> str:
    cards = "".join(
        f"<div><span>{_text(name)}</span><strong>{_text(value)}</strong></div>"
        for name, value in shown
    )
    return f'<section class="figures">{cards}</section>'


def _pictures(pictures: Mapping[str, bytes], tr: Translate) -> str:
    figures = []
    for name, words in CAPTIONS.items():
        data = pictures.get(name)
        if not data:
            continue
        if not data.startswith(PNG_SIGNATURE):
            raise InputError(f"the picture of the {name} is no PNG")
        source = "data:image/png;base64," + base64.b64encode(data).decode("ascii")
        caption = _text(tr(words))
        figures.append(
            f'<figure><img src="{source}" alt="{caption}">'
            f"<figcaption>{caption}</figcaption></figure>"
        )
    return _section(tr("Pictures"), "\n".join(figures)) if figures else ""


def _section(title: str, body: str) -> str:
    return f"<section><h2>{_text(title)}</h2>\n{body}</section>"


def _table(table: Table, mark: str = "") -> str:
    def row(tag: str, cells: Iterable[str]) -> str:
        inside = "".join(
            f'<{tag} class="number">{_text(cell)}</{tag}>'
            if column >= table.numbers and _is_number(cell, tag)
            else f"<{tag}>{_text(cell)}</{tag}>"
            for column, cell in enumerate(cells)
        )
        return f"<tr>{inside}</tr>"

    head = row("th", table.head)
    body = "\n".join(row("td", one) for one in table.rows)
    kind = f' class="{mark}"' if mark else ""
    return f"<table{kind}><thead>{head}</thead>\n<tbody>{body}</tbody></table>"


def _is_number(cell: str, tag: str) -> bool:
    return tag == "th" or cell[:1] in "+-0123456789\N{EN DASH}"


def _checks(content: ReportContent, tr: Translate) -> str:
    rows = []
    for one in check_rows(content.draft.report.checks, tr):
        mark = "passed" if one.passed else "failed"
        cells = "".join(
            f"<td>{_text(cell)}</td>" for cell in (one.name, one.value, one.limit, one.detail)
        )
        rows.append(f'<tr><td class="{mark}">{_text(one.word)}</td>{cells}</tr>')
    names = ("Verdict", "Check", "Value", "Limit", "Detail")
    head = "".join(f"<th>{_text(tr(one))}</th>" for one in names)
    body = "\n".join(rows)
    return f"<table><thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table>"


def _clearance_note(result: PlanningResult, tr: Translate) -> str:
    asked = result.problem.settings.safety_distance * MM_PER_M
    if result.sequence.least_clearance >= result.problem.settings.safety_distance:
        return ""
    words = "The safety distance of {asked} mm is not kept; the least clearance is {least} mm."
    least = down(result.sequence.least_clearance * MM_PER_M)
    return f'<p class="failed">{_text(tr(words, asked=f"{asked:g}", least=least))}</p>'


def _assumptions(result: PlanningResult, tr: Translate) -> str:
    problem = result.problem
    assumed = dict.fromkeys(
        (
            *problem.assumptions,
            *problem.robot.assumptions,
            *problem.tool.assumptions,
        )
    )
    verify = tr("Checked on the nominal model alone; verify the program on the robot in T1.")
    items = "\n".join(f"<li>{_text(tr(one))}</li>" for one in (verify, *assumed))
    return f"<ul>{items}</ul>"


def _foot(content: ReportContent, tr: Translate) -> str:
    from solver.io.ls_hash import HASH_REMARK  # noqa: PLC0415
    from solver.pipeline.digest import problem_digest  # noqa: PLC0415

    lines = [(tr("Digest of the cell"), problem_digest(content.result.problem))]
    remarks = content.draft.program.remarks
    stated = [one.removeprefix(HASH_REMARK) for one in remarks if one.startswith(HASH_REMARK)]
    if stated and set(stated[0]) != {"0"}:
        lines.insert(0, (tr("Hash of the program"), stated[0]))
    shown = "<br>\n".join(f"{_text(name)}: <code>{_text(value)}</code>" for name, value in lines)
    return f'<footer class="muted">{shown}</footer>'
