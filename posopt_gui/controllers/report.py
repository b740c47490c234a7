"""The HTML report: collects what it says off the window's thread, and writes it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QBuffer, QByteArray, QIODevice
from PySide6.QtGui import QImage, QImageWriter

from posopt_gui.i18n import translated
from posopt_gui.viewmodels.export_model import ExportForm
from posopt_gui.viewmodels.report_page import ReportContent, report_page

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult
    from solver.pipeline.programming import ProgramDraft
    from solver.progress import Monitor


def picture_bytes(image: QImage | bytes) -> bytes:
    """A picture as the bytes of a PNG; what is one already stays; b'' for an empty one."""
    if isinstance(image, bytes):
        return image
    if image.isNull():
        return b""
    data = QByteArray()
    buffer = QBuffer(data)
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    writer = QImageWriter(buffer, QByteArray(b"png"))
    writer.write(image)
    buffer.close()
    return bytes(data.data())


def write_report(
    result: PlanningResult,
    draft: ProgramDraft,
    pictures: Mapping[str, bytes],
    language: str = "en",
    override: str | None = None,
) -> str:
    """The report of a plan and its program as one HTML page.

    Parameters
    ----------
    result, draft
        The plan, and its program with the checks.
    pictures : mapping of 'map', 'curves', 'scene' to the bytes of a PNG
        What is missing is left out.
    language : str
        Code of the language.
    override : str, optional
        The reason for which the program was written although checks failed.
    """

    def tr(text: str, **values: object) -> str:
        found = translated(language, text)
        return found.format(**values) if values else found

    return report_page(ReportContent(result, draft, dict(pictures), override), tr, language)


def report_of(
    result: PlanningResult,
    path: Path,
    pictures: Mapping[str, bytes],
    language: str,
    form: ExportForm | None,
    monitor: Monitor,
) -> Path:
    """Draft the program as a form asks, write the report of it, and return its path.

    Raises
    ------
    PosoptError
        When there is no program, or when the file cannot be written.
    """
    # What is loaded here takes a moment, and is loaded on the worker's thread.
    from solver.io.atomic import write_atomically  # noqa: PLC0415
    from solver.pipeline.programming import draft_program  # noqa: PLC0415

    chosen = form or ExportForm(post=result.problem.program.post)
    name = Path(chosen.path).stem or None
    order = chosen.order(override=chosen.reason_given)
    draft = draft_program(result, order, name, monitor)
    page = write_report(result, draft, pictures, language, draft.override)
    write_atomically(path, page.encode("utf-8"))
    return path
