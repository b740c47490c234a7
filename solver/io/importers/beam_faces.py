"""The faces of an H beam as strips along its axis, in the beam frame.

Every face is ``(along, across) -> point and outward normal``: `along` is x from the middle of
the beam, `across` is measured on the face from its origin [m]. The faces and their origins:

================================  =======================================================
web_left, web_right               across = z, from the web's centre line towards the top
flange_top_inner_left, ...        across from the web's face outward to the flange's edge
flange_top_outer, ..._bottom_..   across = y, from the beam's plane of symmetry to the left
flange_top_edge_left, ...         across from the inner towards the outer face of the flange
fillet_top_left, ...              across = arc length from the web towards the flange
================================  =======================================================

Left is +y, top is +z.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from solver.errors import InputError
from solver.io.importers.naming import listed, shown, suggestion
from solver.model.workpiece import BeamSection, Workpiece
from solver.transforms import FloatArray

_SIDES: Final = {"left": 1.0, "right": -1.0}
_ENDS: Final = {"top": 1.0, "bottom": -1.0}


@dataclass(frozen=True, slots=True)
class Face:
    """One face of a placed section.

    Attributes
    ----------
    touches : str
        Workpiece group that the face belongs to.
    edges : mapping
        Name of an edge -> its across coordinate, and the sign in which offsets run [m].
    unit : float
        The across coordinate that a relative offset of 1 means [m].
    lower, upper : float
        Across coordinates between which the face is flat steel, or the arc [m].
    """

    name: str
    touches: str
    edges: Mapping[str, tuple[float, float]]
    unit: float
    lower: float
    upper: float
    corner: tuple[float, float]
    direction: tuple[float, float]
    normal: tuple[float, float]
    radius: float = 0.0

    def points(self, across: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return (n, 2) points and (n, 2) outward normals in y, z at (n,) across coordinates."""
        if not self.radius:
            points = np.array(self.corner) + across[:, None] * np.array(self.direction)
            return points, np.tile(self.normal, (len(across), 1))
        angle = (across / self.radius)[:, None]
        inward = -np.cos(angle) * np.array(self.normal) + np.sin(angle) * np.array(self.direction)
        # `corner` is the centre of the arc, which lies in the air: the normal points to it.
        return np.array(self.corner) + self.radius * inward, -inward


def faces_of(section: BeamSection, root: float) -> Mapping[str, Face]:
    """Return every face of a section with root fillets of radius `root` [m] (0: none)."""
    faces = [
        *_webs(section, root),
        *_flanges(section, root),
        *(_fillets(section, root) if root else ()),
    ]
    return MappingProxyType({face.name: face for face in faces})


def face_of(workpiece: Workpiece, name: str) -> Face:
    """Return the named face of a beam.

    Raises
    ------
    InputError
        When the workpiece is no beam or has no such face; the sentence lists those it has.
    """
    section = workpiece.section
    if section is None:
        raise InputError(
            f"workpiece {workpiece.name} has no section, expected a beam for a path on its faces"
        )
    filleted = any(group.startswith("fillet") for group in workpiece.groups)
    faces = faces_of(section, section.root if filleted else 0.0)
    face = faces.get(name)
    if face is None:
        raise InputError(
            f"beam {workpiece.name} has no face {shown(name)}{suggestion(name, faces)}, "
            f"expected {listed(faces, 'or')}"
        )
    return face


def _webs(section: BeamSection, root: float) -> list[Face]:
    inner = section.height / 2.0 - section.flange
    return [
        Face(
            name=f"web_{side}",
            touches="web",
            edges={"top": (inner, -1.0), "bottom": (-inner, 1.0)},
            unit=inner,
            lower=root - inner,
            upper=inner - root,
            corner=(sign * section.web / 2.0, 0.0),
            direction=(0.0, 1.0),
            normal=(sign, 0.0),
        )
        for side, sign in _SIDES.items()
    ]


def _flanges(section: BeamSection, root: float) -> list[Face]:
    half, depth = section.width / 2.0, (section.width - section.web) / 2.0
    outer = section.height / 2.0
    inner = outer - section.flange
    faces = []
    for end, up in _ENDS.items():
        group = f"flange_{end}"
        for side, sign in _SIDES.items():
            faces += [
                Face(
                    name=f"{group}_inner_{side}",
                    touches=group,
                    edges={"web": (0.0, 1.0), "edge": (depth, -1.0)},
                    unit=depth,
                    lower=root,
                    upper=depth,
                    corner=(sign * section.web / 2.0, up * inner),
                    direction=(sign, 0.0),
                    normal=(0.0, -up),
                ),
                Face(
                    name=f"{group}_edge_{side}",
                    touches=group,
                    edges={"inner": (0.0, 1.0), "outer": (section.flange, -1.0)},
                    unit=section.flange,
                    lower=0.0,
                    upper=section.flange,
                    corner=(sign * half, up * inner),
                    direction=(0.0, up),
                    normal=(sign, 0.0),
                ),
            ]
        faces.append(
            Face(
                name=f"{group}_outer",
                touches=group,
                edges={"left": (half, -1.0), "right": (-half, 1.0)},
                unit=half,
                lower=-half,
                upper=half,
                corner=(0.0, up * outer),
                direction=(1.0, 0.0),
                normal=(0.0, up),
            )
        )
    return faces


def _fillets(section: BeamSection, root: float) -> list[Face]:
    inner = section.height / 2.0 - section.flange
    arc = root * math.pi / 2.0
    return [
        Face(
            name=f"fillet_{end}_{side}",
            touches=f"fillet_{end}_{side}",
            edges={"web": (0.0, 1.0), "flange": (arc, -1.0)},
            unit=arc,
            lower=0.0,
            upper=arc,
            corner=(sign * (section.web / 2.0 + root), up * (inner - root)),
            direction=(0.0, up),
            normal=(sign, 0.0),
            radius=root,
        )
        for end, up in _ENDS.items()
        for side, sign in _SIDES.items()
    ]
