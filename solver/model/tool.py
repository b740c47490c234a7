"""A tool: where its TCP is, what it weighs, and what of it may touch what."""

from __future__ import annotations

from dataclasses import dataclass

from solver.errors import ModelError
from solver.model.shapes import Body, ToolRole
from solver.transforms import FloatArray, frozen
from solver.units import MM


@dataclass(frozen=True, slots=True, eq=False)
class ToolBody:
    """A body of the tool in a role; `body.pose` is flange_from_body.

    `margin` [m] is the distance that a near or contact body keeps from everything that it
    must not touch; `depth` [m] is how far a contact body may enter its pass's workpiece body.
    """

    body: Body
    role: ToolRole
    margin: float = 2.0 * MM
    depth: float = 0.5 * MM

    def __post_init__(self) -> None:
        if self.margin < 0.0 or self.depth < 0.0:
            raise ModelError(f"tool body {self.body.name!r}: margin and depth cannot be negative")


@dataclass(frozen=True, slots=True, eq=False)
class Tool:
    """A tool on the flange; `tcp` is flange_from_tcp (4, 4), `mass` in [kg]."""

    name: str
    title: str
    tcp: FloatArray
    mass: float
    bodies: tuple[ToolBody, ...]
    assumptions: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "tcp", frozen(self.tcp, (4, 4)))
        if self.mass < 0.0:
            raise ModelError(f"tool {self.name}: mass cannot be negative, got {self.mass:g} kg")
