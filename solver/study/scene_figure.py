"""Drawing of the scene where a sequence comes nearest: outlines of all bodies, from two sides."""

from __future__ import annotations

from typing import Any

import numpy as np

from solver.analysis.result import Sequence
from solver.candidates.generate import touch_numbers
from solver.candidates.postures import check_exact_postures
from solver.kinematics.arm import forward, forward_links
from solver.model.problem import PlanningProblem
from solver.model.robot import FLOOR_GROUP
from solver.model.settings import Scheme
from solver.model.shapes import Box, Capsule, Cylinder, Shape, Sphere
from solver.study.context import Study
from solver.study.sections import Drawing, Section
from solver.transforms import FloatArray
from solver.units import MM_PER_M

ROUND = 32
"""Corners that stand for a circle."""

VIEWS = ((0, 2, "x [mm]", "z [mm]"), (1, 2, "y [mm]", "z [mm]"))


def scene_figure(study: Study) -> Section:
    """The scene at the nearest waypoint of f and of f2."""
    drawings, text = [], []
    for scheme in (Scheme.F, Scheme.F2):
        sequence = study.sequence(scheme)
        at = int(np.argmin(sequence.clearance))
        names, points = _nearest(study, sequence, at)
        text.append(
            f"{scheme.value} comes nearest at waypoint {at + 1}: "
            f"{sequence.clearance[at] * MM_PER_M:.2f} mm"
            + (f" between {names[0]} and {names[1]}." if names[0] else ".")
        )
        outlines = scene_points(study.problem, sequence.pendant[at])
        title = f"The scene at the minimum of {scheme.value}"
        draw = _draw(outlines, points, _window(study.problem, outlines))
        drawings.append(Drawing(f"scene_{scheme.value}", title, draw, (9.0, 3.8)))
    text.append("Coordinates are those of the robot's world frame, at the height of the J2 axis.")
    return Section("scene", "The scene at the minimum", tuple(text), (), tuple(drawings))


def _nearest(study: Study, sequence: Sequence, at: int) -> tuple[tuple[str, str], FloatArray]:
    scene, problem = study.result.candidates.scene, study.problem
    touch = touch_numbers(problem, scene)[at : at + 1]
    found = check_exact_postures(problem.robot, scene, sequence.pendant[at : at + 1], touch)
    return found.bodies[0], found.points[0]


def scene_points(problem: PlanningProblem, pendant: FloatArray) -> list[tuple[str, FloatArray]]:
    """(owner, (k, 3) points whose hull is the body) of all bodies, in fanuc_world [m]."""
    links = forward_links(problem.robot, pendant)
    flange = forward(problem.robot, pendant)
    world = problem.fanuc_world_from_floor
    piece = world @ problem.workpiece.placement
    shapes: list[tuple[str, Shape, FloatArray]] = [
        *(("robot", x.body.shape, links[x.link] @ x.body.pose) for x in problem.robot_bodies),
        *(("tool", x.body.shape, flange @ x.body.pose) for x in problem.tool.bodies),
        *(("workpiece", x.shape, piece @ x.pose) for x in problem.workpiece.bodies),
        *(("fixture", x.shape, world @ x.pose) for x in problem.fixtures if x.group != FLOOR_GROUP),
    ]
    return [(owner, _placed(shape, pose)) for owner, shape, pose in shapes]


def _placed(shape: Shape, pose: FloatArray) -> FloatArray:
    placed: FloatArray = surface_points(shape) @ pose[:3, :3].T + pose[:3, 3]
    return placed


def surface_points(shape: Shape) -> FloatArray:
    """(k, 3) points whose convex hull is, or for round shapes nearly is, the shape."""
    if isinstance(shape, Box):
        signs = np.stack(np.meshgrid(*[(-0.5, 0.5)] * 3), axis=-1).reshape(-1, 3)
        corners: FloatArray = signs * shape.size
        return corners
    if isinstance(shape, Sphere | Capsule):
        half = shape.length / 2.0 if isinstance(shape, Capsule) else 0.0
        ball = _ball() * shape.radius
        return np.concatenate([ball + np.array([0, 0, half]), ball - np.array([0, 0, half])])
    if isinstance(shape, Cylinder):
        angle = np.linspace(0.0, 2.0 * np.pi, ROUND, endpoint=False)
        rim = shape.radius * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(ROUND)])
        up = np.array([0.0, 0.0, shape.length / 2.0])
        return np.concatenate([rim + up, rim - up])
    vertices: FloatArray = shape.vertices
    return vertices


def _ball() -> FloatArray:
    height = np.linspace(-1.0, 1.0, ROUND // 2 + 1)
    angle = np.linspace(0.0, 2.0 * np.pi, ROUND, endpoint=False)
    radius = np.sqrt(1.0 - height**2)
    x, y = np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle))
    z = np.broadcast_to(height[:, None], x.shape)
    return np.stack([x, y, z], axis=-1).reshape(-1, 3)


def outline(points: FloatArray) -> FloatArray:
    """(m, 2) corners of the convex hull of points (k, 2), anticlockwise (monotone chain)."""
    ordered = sorted(set(map(tuple, points.tolist())))

    def half(rows: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
        chain: list[tuple[float, ...]] = []
        for p in rows:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2], chain[-1]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0.0:
                    break
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return np.array(half(ordered) + half(ordered[::-1]))


def _window(
    problem: PlanningProblem, outlines: list[tuple[str, FloatArray]]
) -> tuple[FloatArray, FloatArray]:
    """Corners of what is worth showing: robot, tool and the neighbourhood of the path."""
    moving = [points for owner, points in outlines if owner in {"robot", "tool"}]
    path = problem.waypoint_poses[:, :3, 3]
    margin = np.ptp(path, axis=0).max() / 2.0
    near = np.concatenate([*moving, path - margin, path + margin])
    return near.min(axis=0) * MM_PER_M, near.max(axis=0) * MM_PER_M


ZOOM = 10.0
"""The view near the gap shows this part of the scene either way."""

COLOURS = {"robot": "#f2c500", "tool": "#3b7dd8", "workpiece": "#8a8f98", "fixture": "#c9b79c"}


def _draw(
    outlines: list[tuple[str, FloatArray]],
    points: FloatArray,
    window: tuple[FloatArray, FloatArray],
) -> Any:
    low, high = window
    zoom = (high - low).max() / ZOOM

    def draw(figure: Any) -> None:
        near = bool(np.isfinite(points).all())
        panels = figure.subplots(1, 2 + near)
        views = [*VIEWS, VIEWS[0]][: len(panels)]
        for number, (axes, (across, up, x_name, z_name)) in enumerate(
            zip(panels, views, strict=True)
        ):
            for owner, body in outlines:
                corners = outline(body[:, [across, up]]) * MM_PER_M
                axes.fill(*corners.T, fc=COLOURS[owner], ec="black", lw=0.5, alpha=0.55)
            if near:
                axes.plot(*(points[:, [across, up]] * MM_PER_M).T, "r.-", ms=4, lw=1.2)
            if number < len(VIEWS):
                axes.set_xlim(low[across], high[across])
                axes.set_ylim(low[up], high[up])
            else:
                middle = points.mean(axis=0)[[across, up]] * MM_PER_M
                axes.set_xlim(middle[0] - zoom, middle[0] + zoom)
                axes.set_ylim(middle[1] - zoom, middle[1] + zoom)
                axes.set_title("near the gap", fontsize="small")
            axes.set_aspect("equal", adjustable="box")
            axes.set_xlabel(x_name)
            axes.set_ylabel(z_name)
        for owner in dict.fromkeys(owner for owner, _ in outlines):
            panels[0].fill([], [], fc=COLOURS[owner], ec="black", lw=0.5, alpha=0.55, label=owner)
        figure.legend(loc="outside lower center", ncols=4, fontsize="small", frameon=False)

    return draw
