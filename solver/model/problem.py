"""A planning problem: robot, tool, workpiece, fixtures, toolpath and settings in one cell."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from solver.errors import ModelError
from solver.model.program import NumberedPose
from solver.model.program_settings import Accuracy, ProgramSettings
from solver.model.robot import LinkBody, Robot
from solver.model.settings import PlanningSettings
from solver.model.shapes import Body
from solver.model.tool import Tool
from solver.model.toolpath import Frame, Toolpath
from solver.model.workpiece import Workpiece
from solver.transforms import FloatArray, frozen, rigid


@dataclass(frozen=True, slots=True, eq=False)
class PlanningProblem:
    """Everything that planning needs; what is computed from it depends on nothing else.

    `fixtures` are bodies in the floor frame. `joint_windows` (6, 2) [rad] narrows the robot's
    pendant limits (a dress pack); `bodies` names the robot's body set; `accuracy` is what the
    cell declares, None where it declares nothing.
    """

    name: str
    robot: Robot
    bodies: str
    tool: Tool
    workpiece: Workpiece
    fixtures: tuple[Body, ...]
    toolpath: Toolpath
    settings: PlanningSettings
    program: ProgramSettings = field(default_factory=ProgramSettings)
    joint_windows: FloatArray | None = None
    accuracy: Accuracy | None = None
    title: str = ""
    assumptions: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "fixtures", tuple(self.fixtures))
        if self.bodies not in self.robot.body_sets:
            known = ", ".join(self.robot.body_sets)
            raise ModelError(
                f"cell {self.name}: robot {self.robot.name} has no body set {self.bodies!r} "
                f"(known: {known})"
            )
        if self.joint_windows is not None:
            object.__setattr__(self, "joint_windows", frozen(self.joint_windows, (6, 2)))
        for joint, (low, high) in enumerate(self.joint_limits, start=1):
            if not low < high:
                raise ModelError(f"cell {self.name}: the window of J{joint} leaves no angle")
        for one in self.toolpath.passes:
            if one.touches and one.touches not in self.workpiece.groups:
                raise ModelError(
                    f"pass {one.name!r} touches {one.touches!r}, but the workpiece has only "
                    f"{', '.join(self.workpiece.groups)}"
                )

    @property
    def joint_limits(self) -> FloatArray:
        """(6, 2) limits of the pendant's joints, narrowed by the cell's windows [rad]."""
        if self.joint_windows is None:
            return self.robot.limits
        low = np.maximum(self.robot.limits[:, 0], self.joint_windows[:, 0])
        high = np.minimum(self.robot.limits[:, 1], self.joint_windows[:, 1])
        return np.column_stack([low, high])

    @property
    def robot_bodies(self) -> tuple[LinkBody, ...]:
        """The bodies of the chosen body set."""
        return self.robot.body_sets[self.bodies]

    @property
    def fanuc_world_from_floor(self) -> FloatArray:
        """(4, 4) shift from the mounting face to the height of the J2 axis."""
        return rigid(position=(0.0, 0.0, -self.robot.world_height))

    @property
    def user_frame(self) -> NumberedPose:
        """The program's user frame: number 0 is fanuc_world, any other the workpiece's frame."""
        number = self.program.uframe
        if number == 0:
            return NumberedPose(0, rigid())
        pose = self.fanuc_world_from_floor @ self.workpiece.placement
        return NumberedPose(number, pose, self.program.frame_measured)

    @property
    def user_tool(self) -> NumberedPose:
        """The program's tool: flange_from_tcp under its number."""
        return NumberedPose(self.program.utool, self.tool.tcp, self.program.tool_measured)

    @property
    def waypoint_poses(self) -> FloatArray:
        """(n, 4, 4) fanuc_world_from_reference of all waypoints."""
        poses = self.toolpath.poses
        if self.toolpath.frame is Frame.FANUC_WORLD:
            return poses
        if self.toolpath.frame is Frame.FLOOR:
            return self.fanuc_world_from_floor @ poses
        return self.fanuc_world_from_floor @ self.workpiece.placement @ poses
