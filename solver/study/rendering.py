"""Figures as SVG and PNG through matplotlib, which is optional."""

from __future__ import annotations

import importlib.util
import io
from dataclasses import dataclass
from html import escape
from typing import Any

from solver.study.sections import Drawing

HOW_TO_INSTALL = 'no figures were drawn: install matplotlib with pip install "posopt[study]"'

STYLE: Any = {
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "axes.spines.top": False,
    "axes.spines.right": False,
    # Okabe and Ito, without the yellow that white paper swallows.
    "axes.prop_cycle": "cycler('color', ['0072B2', 'D55E00', '009E73', 'CC79A7', '56B4E9'])",
}
DOTS_PER_INCH = 120


@dataclass(frozen=True, slots=True)
class Figure:
    """A drawn figure: the same picture twice."""

    key: str
    title: str
    svg: bytes
    png: bytes


def can_draw() -> bool:
    """Whether the plotting library is installed."""
    return importlib.util.find_spec("matplotlib") is not None


def render(drawing: Drawing) -> Figure:
    """Draw without a window; the same values give the same bytes."""
    from matplotlib import rc_context  # noqa: PLC0415 - optional dependency
    from matplotlib.figure import Figure as Canvas  # noqa: PLC0415

    with rc_context({**STYLE, "svg.hashsalt": drawing.key}):
        figure = Canvas(figsize=drawing.size, layout="constrained")
        drawing.draw(figure)
        vector, pixels = io.BytesIO(), io.BytesIO()
        metadata = {"Date": None, "Creator": None, "Title": drawing.title}
        figure.savefig(vector, format="svg", dpi=DOTS_PER_INCH, metadata=metadata)
        figure.savefig(pixels, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    title = f"<title>{escape(drawing.title)}</title>"
    text = vector.getvalue().decode("utf-8")
    described = text.replace(title, f"{title}\n <desc>{escape(drawing.title)}</desc>", 1)
    return Figure(drawing.key, drawing.title, described.encode("utf-8"), pixels.getvalue())
