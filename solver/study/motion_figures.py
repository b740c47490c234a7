"""Drawings along the path: joint curves, cumulative change and clearance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from solver.analysis.result import Sequence
from solver.model.settings import Scheme
from solver.study.constant import best_constant
from solver.study.context import Study
from solver.study.published import MODEL_NAMES
from solver.study.sections import Drawing, Section
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD, MM_PER_M

STYLES = ("-", "--", "-", ":", "-.")


def motion_figures(study: Study) -> Section:
    """Joint curves, their cumulative change, and the clearance along the path."""
    shown = {
        "f": study.sequence(Scheme.F),
        "f2": study.sequence(Scheme.F2),
        "refined": study.refined.sequence,
    }
    constant = best_constant(study.result)
    if constant is not None:
        shown["best constant lean"] = constant
    curves = {name: one.model * DEG_PER_RAD for name, one in shown.items()}
    summed = {name: _cumulative(one) for name, one in curves.items()}
    drawings = (
        Drawing("joints", "Model angles along the path", _panels(curves, "[deg]"), (7.2, 4.4)),
        Drawing("cumulative", "Cumulative change", _panels(summed, "sum [deg]"), (7.2, 4.4)),
        Drawing("clearance", "Clearance along the path", _clearance(study, shown)),
    )
    text = (
        "Where two lines coincide the later one covers the other; the angles are those of the "
        "model, in which the cost is counted.",
    )
    return Section("motion", "Along the path", text, (), drawings)


def _cumulative(angles: FloatArray) -> FloatArray:
    steps = np.abs(np.diff(angles, axis=0))
    summed: FloatArray = np.vstack([np.zeros((1, angles.shape[1])), np.cumsum(steps, axis=0)])
    return summed


def _panels(curves: Mapping[str, FloatArray], unit: str) -> Any:
    def draw(figure: Any) -> None:
        panels = figure.subplots(2, 3, sharex=True)
        for joint, axes in enumerate(panels.flat):
            for (name, values), style in zip(curves.items(), STYLES, strict=False):
                number = np.arange(1, len(values) + 1)
                axes.plot(number, values[:, joint], style, lw=1.2, label=name)
            axes.set_title(f"{MODEL_NAMES[joint]} {unit}", fontsize="small")
            axes.tick_params(labelsize="small")
        for axes in panels[-1]:
            axes.set_xlabel("waypoint", fontsize="small")
        handles, labels = panels.flat[0].get_legend_handles_labels()
        figure.legend(
            handles, labels, loc="outside lower center", ncols=len(labels), fontsize="small"
        )

    return draw


def _clearance(study: Study, shown: Mapping[str, Sequence]) -> Any:
    safe = study.problem.settings.safety_distance * MM_PER_M

    def draw(figure: Any) -> None:
        axes = figure.add_subplot()
        for (name, one), style in zip(shown.items(), STYLES, strict=False):
            number = np.arange(1, len(one.clearance) + 1)
            axes.plot(number, one.clearance * MM_PER_M, style, lw=1.4, label=name)
        axes.axhline(safe, color="0.4", lw=0.8, zorder=1, label="safety distance")
        axes.set_xlabel("waypoint")
        axes.set_ylabel("clearance [mm]")
        axes.legend(fontsize="small")
        axes.grid(alpha=0.3)

    return draw
