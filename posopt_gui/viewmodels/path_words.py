"""What a path file holds, in a line."""

from __future__ import annotations

from collections.abc import Callable

from solver.model.toolpath import Toolpath
from solver.units import MM_PER_M


def path_words(path: Toolpath, translate: Callable[..., str]) -> str:
    """Waypoints, passes, frame and feeds of a path."""
    feeds = sorted({round(one.feed * MM_PER_M, 3) for one in path.passes})
    feed = f"{feeds[0]:g}" if len(feeds) == 1 else f"{feeds[0]:g} … {feeds[-1]:g}"
    return translate(
        "Waypoints: {count} · passes: {passes} · frame: {frame} · feed: {feed} mm/s",
        count=len(path), passes=len(path.passes), frame=path.frame.value, feed=feed,
    )  # fmt: skip
