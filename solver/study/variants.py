"""The cell under study with other settings or bodies, and plans of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from solver.analysis.result import PlanningResult
from solver.errors import PosoptError
from solver.model.problem import PlanningProblem
from solver.model.robot import LinkBody
from solver.model.settings import Scheme, Sweep
from solver.model.shapes import Body, Capsule, Cylinder, Shape
from solver.pipeline.planning import plan
from solver.progress import Monitor
from solver.study.context import sentence


def with_settings(problem: PlanningProblem, **changes: object) -> PlanningProblem:
    """The problem with some settings replaced."""
    return replace(problem, settings=replace(problem.settings, **changes))  # type: ignore[arg-type]


def symmetric(limit: float, step: float) -> Sweep:
    """Angles from -limit to limit [rad] that include zero."""
    count = int(limit / step + 1e-9)
    return Sweep(-count * step, count * step, step) if count else Sweep.fixed()


def planned(
    problem: PlanningProblem, monitor: Monitor, compare: Iterable[Scheme] = ()
) -> PlanningResult | str:
    """A plan, or the sentence that says why there is none."""
    try:
        return plan(problem, monitor, compare=compare)
    except PosoptError as error:
        return sentence(error)


def with_cylinders(problem: PlanningProblem) -> tuple[PlanningProblem, int]:
    """The problem with every capsule of robot and tool cut flat, and how many there were.

    A cylinder has the capsule's axis and radius and ends where the axis ends, as the paper
    describes its bodies; it lies inside the capsule.
    """
    robot, tool = problem.robot, problem.tool
    links = [LinkBody(one.link, _flat(one.body)) for one in problem.robot_bodies]
    sets = dict(robot.body_sets) | {problem.bodies: tuple(links)}
    bodies = tuple(replace(one, body=_flat(one.body)) for one in tool.bodies)
    shapes = [one.body.shape for one in problem.robot_bodies]
    shapes += [one.body.shape for one in tool.bodies]
    count = sum(isinstance(shape, Capsule) for shape in shapes)
    flat = replace(problem, robot=replace(robot, body_sets=sets), tool=replace(tool, bodies=bodies))
    return flat, count


def _flat(body: Body) -> Body:
    shape: Shape = body.shape
    if not isinstance(shape, Capsule):
        return body
    return replace(body, shape=Cylinder(shape.radius, shape.length))
