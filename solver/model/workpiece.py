"""Workpieces and fixtures: named groups of bodies, placed in the floor frame."""

from __future__ import annotations

from dataclasses import dataclass

from solver.errors import ModelError
from solver.model.shapes import Body
from solver.transforms import FloatArray, frozen


@dataclass(frozen=True, slots=True)
class BeamSection:
    """An H section [m]: height H, flange width B, web t1, flange t2, root radius r (0: none)."""

    name: str
    height: float
    width: float
    web: float
    flange: float
    root: float = 0.0
    source: str = ""

    def __post_init__(self) -> None:
        if min(self.height, self.width, self.web, self.flange) <= 0.0 or self.root < 0.0:
            raise ModelError(f"beam {self.name}: every dimension must be positive")
        if 2.0 * (self.flange + self.root) >= self.height:
            raise ModelError(f"beam {self.name}: flanges and root radii exceed the height")
        if self.web + 2.0 * self.root >= self.width:
            raise ModelError(f"beam {self.name}: web and root radii exceed the flange width")


@dataclass(frozen=True, slots=True, eq=False)
class Workpiece:
    """A placed workpiece; `placement` is floor_from_beam, bodies are in the beam frame.

    For a beam the frame's origin is the section's centre at half the length, x along the
    beam, y across the flanges, z along the height. Its groups are 'web', 'flange_top' (+z),
    'flange_bottom' (-z) and 'fillet_top_left' (+z, +y), 'fillet_top_right' (+z, -y),
    'fillet_bottom_left', 'fillet_bottom_right'.
    """

    name: str
    bodies: tuple[Body, ...]
    placement: FloatArray
    section: BeamSection | None = None
    length: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "placement", frozen(self.placement, (4, 4)))
        object.__setattr__(self, "bodies", tuple(self.bodies))
        if not self.bodies:
            raise ModelError(f"workpiece {self.name}: it has no bodies")

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the groups of bodies, in order of appearance."""
        return tuple(dict.fromkeys(body.group for body in self.bodies))
