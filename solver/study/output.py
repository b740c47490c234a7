"""A study on disk: tables as CSV and JSON, figures as SVG and PNG, and the page."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from solver.errors import InputError, Place
from solver.io.atomic import write_atomically
from solver.study.page import page
from solver.study.rendering import HOW_TO_INSTALL, Figure, can_draw, render
from solver.study.report import StudyReport
from solver.study.sections import StudyTable


def write_report(report: StudyReport, folder: Path, *, figures: bool | None = None) -> list[Path]:
    """Write all files of a study into a folder, which is made if it is not there.

    `figures` False draws none; None draws them where the plotting library is installed.

    Raises
    ------
    InputError
        The folder cannot be made or written.
    """
    drawn = _drawn(report) if figures or (figures is None and can_draw()) else {}
    files: dict[str, bytes] = {}
    for section in report.sections:
        for table in section.tables:
            files[f"tables/{table.key}.csv"] = _csv(table).encode("utf-8")
    for one in drawn.values():
        files[f"figures/{one.key}.svg"] = one.svg
        files[f"figures/{one.key}.png"] = one.png
    text = json.dumps(plain(report.document()), indent=1, ensure_ascii=False, allow_nan=False)
    files["study.json"] = f"{text}\n".encode()
    files["index.html"] = page(report, drawn, "" if drawn else HOW_TO_INSTALL).encode("utf-8")
    written = []
    for name, data in files.items():
        path = folder / name
        _make_folder(path.parent)
        write_atomically(path, data)
        written.append(path)
    return written


def _drawn(report: StudyReport) -> dict[str, Figure]:
    drawings = [one for section in report.sections for one in section.drawings]
    return {one.key: render(one) for one in drawings}


def _make_folder(path: Path) -> None:
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"the folder cannot be made ({reason})", Place(str(path))) from error


def _csv(table: StudyTable) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([one.head for one in table.columns])
    for row in table.document()["rows"]:
        writer.writerow(["" if value is None else value for value in row])
    return text.getvalue()


def plain(value: Any) -> Any:
    """Values as JSON knows them; what is not finite becomes null."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
