"""FANUC .LS with Cartesian positions: X Y Z W P R with CONFIG, in the user frame.

With the workpiece as user frame a frame that is measured again carries the whole program.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from solver.io.posts.fanuc_file import SUFFIX, render_files
from solver.io.posts.fanuc_text import whole_number
from solver.io.posts.post import FileForm, Post, PostOptions, Rendered
from solver.model.program import JointProgram, Move
from solver.model.robot import Robot
from solver.model.toolpath import Role

if TYPE_CHECKING:
    from solver.io.posts.frame_poses import FramePose


def render_fanuc_cartesian(program: JointProgram, options: PostOptions, robot: Robot) -> Rendered:
    """Return the texts of FANUC .LS files with Cartesian positions.

    Every position is solved again from the decimals of its text, with its CONFIG, and must lead
    back to the joints that were chosen. Where the program names a position register, contact
    moves add its offset.

    Raises
    ------
    ModelError
        When the program does not fit the format, or a position does not lead back to its
        joints: near a singularity, or where a joint stands at the edge of a turn.
    """
    from solver.io.posts import frame_poses  # noqa: PLC0415 - kinematics compile on first use

    if program.offset is not None:
        whole_number("the position register", program.offset, 1, options.register_limit)

    def positions(part: JointProgram) -> Iterator[tuple[str, ...]]:
        for pose in frame_poses.proven_poses(part, robot):
            yield _position(part, pose)

    return render_files(program, options, positions, _offset)


def _offset(program: JointProgram, move: Move) -> str:
    if program.offset is None or move.role is not Role.CONTACT:
        return ""
    return f" Offset,PR[{program.offset:d}]"


def _position(program: JointProgram, pose: FramePose) -> tuple[str, ...]:
    uframe, utool = program.frame.number, program.tool.number
    place = ",".join(
        f"\t{name} ={text:>10}  mm" for name, text in zip("XYZ", pose.texts[:3], strict=True)
    )
    angles = ",".join(
        f"\t{name} ={text:>10} deg" for name, text in zip("WPR", pose.texts[3:], strict=True)
    )
    return f"\tUF : {uframe:d}, UT : {utool:d},\t\tCONFIG : '{pose.config}',", f"{place},", angles


FANUC_CARTESIAN: Final = Post(
    name="fanuc-cartesian",
    title="FANUC .LS, Cartesian positions in the user frame",
    suffix=SUFFIX,
    form=FileForm.FANUC_CARTESIAN,
    render=render_fanuc_cartesian,
)
