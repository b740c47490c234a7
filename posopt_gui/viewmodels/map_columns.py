"""Several waypoints of the map in one column, where there are more of them than pixels."""

from __future__ import annotations

import numpy as np

from posopt_gui.viewmodels.map_colours import CLASS_RANK, ByteArray


def worst_of_columns(indices: ByteArray, each: int, *, outcome: bool) -> ByteArray:
    """The worst of every `each` neighbouring waypoints (n, m), lean by lean.

    A single waypoint that is cut off, or that costs much, is seen on the whole map as well.

    Parameters
    ----------
    indices : (n, m) array
        Classes of cells with `outcome`, else indices into the table of a scale, which rise from
        cells without a node over the worst value to the best.
    each : int
        How many waypoints stand in one column.
    outcome : bool
        Whether the indices are classes.
    """
    starts = np.arange(0, len(indices), each)
    if not outcome:
        least: ByteArray = np.minimum.reduceat(indices, starts, axis=0)
        return least
    rank = np.minimum.reduceat(CLASS_RANK[indices], starts, axis=0)
    kinds = np.argsort(CLASS_RANK).astype(np.uint8)
    worst: ByteArray = kinds[rank - CLASS_RANK.min()]
    return worst
