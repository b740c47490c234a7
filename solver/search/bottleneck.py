"""The best clearance that a whole sequence can keep."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from solver.errors import ModelError
from solver.progress import Monitor, SilentMonitor
from solver.search.graph import LayeredGraph
from solver.search.sweeps import Progress, carry, total_work


def best_minimum_clearance(
    graph: LayeredGraph, clearance: ArrayLike, monitor: Monitor | None = None
) -> float:
    """Largest clearance c such that a sequence exists whose nodes all have clearance >= c.

    Parameters
    ----------
    graph : LayeredGraph
        Its edges and limits count, its costs do not.
    clearance : (K,) array
        Clearance of each node [m]; infinite where nothing is near.
    monitor : Monitor, optional
        Told about progress and asked about cancelling; silent by default.

    Returns
    -------
    float
        Minus infinity when no sequence exists at all. It is one of the given values, so that
        ``clearance >= c`` selects at least one whole sequence.
    """
    given = np.asarray(clearance, dtype=np.float64)
    if given.shape != (graph.node_count,) or np.any(np.isnan(given)):
        raise ModelError("the clearances of a graph are one number for each of its nodes")
    last = graph.layer_count - 1
    progress = Progress(monitor or SilentMonitor(), total_work(graph, 0, last))
    # The least over sequences of the largest danger, which is the negative clearance.
    danger = -given
    values = np.full(graph.node_count, np.inf)
    values[graph.layer(0)] = danger[graph.layer(0)]
    carry(graph, values, progress, node_cost=danger, gap_weight=np.zeros(last), widest=True)
    return float(-np.min(values[graph.layer(last)], initial=np.inf))
