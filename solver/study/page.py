"""One self-contained HTML page: text, tables and figures of a study."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from html import escape

from solver.study.rendering import Figure
from solver.study.report import StudyReport
from solver.study.sections import Section, StudyTable, shown

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 78rem; margin: 2rem auto; padding: 0 1rem;
  color: #1c1f24; background: #fff; }
h1, h2, h3 { line-height: 1.2; } h2 { margin-top: 2.4rem; border-bottom: 1px solid #ccd; }
h1, p, ul { max-width: 52rem; }
table { border-collapse: collapse; font-size: .8rem; font-variant-numeric: tabular-nums; }
.wide { overflow-x: auto; margin: .6rem 0 1rem; }
caption { text-align: left; font-weight: 600; padding: .3rem 0; }
th, td { padding: .18rem .45rem; text-align: right; border-bottom: 1px solid #e4e6ea; }
th { vertical-align: bottom; }
th:first-child, td:first-child, .text { text-align: left; } td.text { white-space: nowrap; }
.note, .time { color: #5b6470; } .absent { background: #fff6e0; padding: .4rem .8rem; }
figure { margin: 1rem 0; } figure img { max-width: 100%; height: auto; }
figcaption { color: #5b6470; font-size: .85rem; } nav a { margin-right: 1rem; }
"""


def page(report: StudyReport, figures: Mapping[str, Figure], missing: str = "") -> str:
    """The page; `missing` is the sentence that stands where no figures could be drawn."""
    head = f"{report.title}: {report.cell_title}"
    links = "".join(
        f'<a href="#{escape(one.key)}">{escape(one.title)}</a>' for one in report.sections
    )
    parts = [
        "<!DOCTYPE html>",
        '<html lang="en" xmlns="http://www.w3.org/1999/xhtml">',
        f'<head><meta charset="utf-8"/><title>{escape(head)}</title>',
        f"<style>{STYLE}</style></head>",
        f"<body><h1>{escape(head)}</h1>",
        *(f"<p>{escape(one)}</p>" for one in report.introduction),
        _list("Assumptions", report.assumptions),
        f"<p class='absent'>{escape(missing)}</p>" if missing else "",
        f"<nav>{links}</nav>",
        *(_section(one, figures) for one in report.sections),
        _parameters(report),
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def _section(section: Section, figures: Mapping[str, Figure]) -> str:
    parts = [f'<h2 id="{escape(section.key)}">{escape(section.title)}</h2>']
    if section.reason:
        parts.append(f"<p class='absent'>Does not apply: {escape(section.reason)}.</p>")
    parts += [f"<p>{escape(one)}</p>" for one in section.text]
    parts += [_table(one) for one in section.tables]
    parts += [_figure(figures[one.key]) for one in section.drawings if one.key in figures]
    return "\n".join(parts)


def _table(table: StudyTable) -> str:
    head = "".join(
        f"<th{_class(column.timing, _is_text(table, at))}>{escape(column.head)}</th>"
        for at, column in enumerate(table.columns)
    )
    rows = []
    for row in table.rows:
        cells = []
        for value, column in zip(row, table.columns, strict=True):
            kind = _class(column.timing, isinstance(value, str))
            cells.append(f"<td{kind}>{escape(shown(value, column))}</td>")
        rows.append(f"<tr>{''.join(cells)}</tr>")
    note = f"<p class='note'>{escape(table.note)}</p>" if table.note else ""
    return (
        f"<div class='wide'><table><caption>{escape(table.title)}</caption>"
        f"<thead><tr>{head}</tr></thead>\n<tbody>\n"
        + "\n".join(rows)
        + f"\n</tbody></table></div>{note}"
    )


def _is_text(table: StudyTable, at: int) -> bool:
    """Whether a column holds words, which begin at its left as its head does."""
    return any(isinstance(row[at], str) for row in table.rows)


def _class(timing: bool, text: bool) -> str:
    if text:
        return ' class="text"'
    return ' class="time"' if timing else ""


def _figure(figure: Figure) -> str:
    data = base64.b64encode(figure.svg).decode("ascii")
    title = escape(figure.title)
    return (
        f'<figure><img alt="{title}" src="data:image/svg+xml;base64,{data}"/>'
        f"<figcaption>{title}</figcaption></figure>"
    )


def _list(title: str, items: tuple[str, ...]) -> str:
    if not items:
        return ""
    rows = "".join(f"<li>{escape(one)}</li>" for one in items)
    return f"<h2>{escape(title)}</h2><ul>{rows}</ul>"


def _parameters(report: StudyReport) -> str:
    rows = "".join(
        f"<tr><td>{escape(name)}</td><td>{escape(str(value))}</td></tr>"
        for name, value in report.parameters.items()
    )
    return (
        "<h2>Parameters of the experiments</h2><p>Lengths in metres, angles in radians; they stand "
        f"in the shipped data of the study.</p><table><tbody>{rows}</tbody></table>"
    )
