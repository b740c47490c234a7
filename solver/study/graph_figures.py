"""Drawings of the graph and of how the schemes search it: waypoints across, lean up."""

from __future__ import annotations

from typing import Any

import numpy as np

from solver.analysis.result import Sequence
from solver.candidates.outcomes import Outcome
from solver.costs.penalty import safety_penalty
from solver.model.settings import Scheme
from solver.search import paper
from solver.study.context import Study, plain_graph
from solver.study.sections import Drawing, Section
from solver.transforms import FloatArray, IntArray
from solver.units import DEG_PER_RAD, MM_PER_M

COLOURS = ("#B4CBE0", "#999999", "#E69F00", "#CC79A7", "#D55E00", "#882255", "#0072B2")
"""One for each outcome, in its order, told apart by the colour-blind too (Okabe and Ito)."""


def graph_figures(study: Study) -> Section:
    """Candidates, filtered graph and search regions, on the branch that f2 mostly takes."""
    slot, layer = _shown_part(study)
    candidates = study.result.candidates
    branch = int(candidates.branches[slot])
    lean = candidates.orientations[layer, 0] * DEG_PER_RAD
    outcome = candidates.outcome[:, layer, slot]
    regions = _regions(study)
    drawings = (
        Drawing("candidates", "Candidates and what rejects them", _candidates(lean, outcome)),
        Drawing("filtered", "The filtered graph with its clearance", _filtered(study, slot, layer)),
        Drawing("regions", "Expanded nodes and lines of f and f2", _search(study, regions)),
    )
    text = (
        f"The pictures show branch {branch}, with every other angle next to its nominal value; "
        "nodes of other branches are counted in the tables. Later expansions are brighter.",
    )
    numbers = {name: len(order) for name, (order, _) in regions.items()}
    return Section("graph", "Graph and search", text, (), drawings, numbers)


def _shown_part(study: Study) -> tuple[int, IntArray]:
    """The branch slot that f2 mostly takes, and the orientations of nominal lead and spin."""
    candidates, f2 = study.result.candidates, study.sequence(Scheme.F2)
    slots = candidates.nodes.candidate[f2.nodes, 2]
    angles = candidates.orientations
    nominal = study.problem.toolpath.passes[0].lead
    away = np.abs(angles[:, 1] - nominal) + np.abs(angles[:, 2])
    layer = np.flatnonzero(away <= away.min() + 1e-9)
    return int(np.bincount(slots).argmax()), layer.astype(np.int64)


def _regions(study: Study) -> dict[str, tuple[IntArray, Sequence]]:
    """Closed nodes of f and f2 in their order, with the sequence found."""
    graph, settings = plain_graph(study.result.graph), study.problem.settings
    clearance = study.result.candidates.nodes.clearance
    f = paper.f(graph, settings.heuristic_weight)
    f2 = paper.f2(
        graph, safety_penalty(clearance, settings.safety_distance), settings.heuristic_weight
    )
    return {
        "f": (f.order, study.sequence(Scheme.F)),
        "f2": (f2.order, study.sequence(Scheme.F2)),
    }


def _candidates(lean: FloatArray, outcome: np.ndarray) -> Any:
    def draw(figure: Any) -> None:
        from matplotlib.colors import ListedColormap  # noqa: PLC0415 - optional dependency

        axes = figure.add_subplot()
        number = np.arange(1, len(outcome) + 1)
        axes.pcolormesh(
            number, lean, outcome.T, cmap=ListedColormap(COLOURS), vmin=-0.5,
            vmax=len(COLOURS) - 0.5, shading="nearest", rasterized=True,
        )  # fmt: skip
        present = np.unique(outcome)
        for kind in present:
            axes.plot([], [], "s", color=COLOURS[kind], label=Outcome(int(kind)).label)
        _label(axes)
        figure.legend(loc="outside upper center", ncols=3, fontsize="small", frameon=False)

    return draw


def _filtered(study: Study, slot: int, layer: IntArray) -> Any:
    candidates = study.result.candidates
    lean = candidates.orientations[layer, 0] * DEG_PER_RAD
    feasible = candidates.outcome[:, layer, slot] == Outcome.FEASIBLE
    clearance = np.where(feasible, candidates.clearance[:, layer, slot], np.nan) * MM_PER_M
    safe = study.problem.settings.safety_distance * MM_PER_M

    def draw(figure: Any) -> None:
        axes = figure.add_subplot()
        number = np.arange(1, len(clearance) + 1)
        image = axes.pcolormesh(
            number, lean, np.ma.masked_invalid(clearance.T), cmap="viridis", shading="nearest",
            rasterized=True,
        )  # fmt: skip
        finite = clearance[np.isfinite(clearance)]
        if len(finite) and finite.min() < safe < finite.max() and min(clearance.shape) > 1:
            border = axes.contour(
                number, lean, clearance.T, levels=[safe], colors="white", linewidths=1.0
            )
            axes.clabel(border, fmt=lambda value: f"{value:g} mm", fontsize="small")
        # Where both are the same, the dashes of f let f2 be seen.
        for scheme, style in ((Scheme.F2, "r-"), (Scheme.F, "k--")):
            _line(axes, study.sequence(scheme), style, scheme.value)
        figure.colorbar(image, label="clearance [mm]")
        _label(axes)
        axes.legend(fontsize="small", loc="lower left")

    return draw


def _search(study: Study, regions: dict[str, tuple[IntArray, Sequence]]) -> Any:
    nodes = study.result.candidates.nodes
    waypoint = nodes.candidate[:, 0] + 1
    lean = study.result.candidates.lean * DEG_PER_RAD

    def draw(figure: Any) -> None:
        both = figure.subplots(1, 2, sharex=True, sharey=True)
        for axes, (name, (order, sequence)) in zip(both, regions.items(), strict=True):
            axes.plot(waypoint, lean, ".", ms=1.5, color="0.85", rasterized=True)
            image = axes.scatter(
                waypoint[order], lean[order], c=np.linspace(0.0, 1.0, len(order)), s=5,
                vmin=0.0, vmax=1.0, cmap="plasma", rasterized=True,
            )  # fmt: skip
            _line(axes, sequence, "k-", name)
            axes.set_title(f"{name}: {len(order):,} expanded", fontsize="medium")
            _label(axes)
        both[1].set_ylabel("")
        bar = figure.colorbar(image, ax=both, label="order of expansion", ticks=[0.0, 1.0])
        bar.ax.set_yticklabels(["first", "last"])

    return draw


def _line(axes: Any, sequence: Sequence, style: str, name: str) -> None:
    lean = sequence.angles[:, 0] * DEG_PER_RAD
    axes.plot(np.arange(1, len(lean) + 1), lean, style, lw=1.4, label=name)


def _label(axes: Any) -> None:
    axes.set_xlabel("waypoint")
    axes.set_ylabel("lean [deg]")
