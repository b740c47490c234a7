"""Ways of searching the graph."""

from __future__ import annotations

from enum import Enum


class Scheme(Enum):
    """A way of searching the graph."""

    EXACT = "exact"
    F = "f"
    F1 = "f1"
    F2 = "f2"
