"""FANUC .LS with joint positions: the pendant's J1 to J6, exactly the numbers that were checked."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from solver.errors import ModelError
from solver.io.posts.fanuc_file import SUFFIX, render_files
from solver.io.posts.fanuc_text import angle_text
from solver.io.posts.joint_values import joint_degrees
from solver.io.posts.post import FileForm, Post, PostOptions, Rendered
from solver.model.program import JointProgram, Move
from solver.model.robot import Robot


def render_fanuc_joint(program: JointProgram, options: PostOptions, robot: Robot) -> Rendered:
    """Return the texts of FANUC .LS files: ASCII, CRLF line ends, joint positions.

    The joints must already be rounded to the file's decimals of a degree: what was checked is
    then exactly what stands in the file.

    Raises
    ------
    ModelError
        When the program does not fit the format, or asks for an offset: an offset moves poses
        and would have no meaning for joints.
    """
    del robot  # joints are written as they are
    if program.offset is not None:
        raise ModelError(
            f"program {program.name[:50]!r} asks for the offset PR[{program.offset}], which joint "
            "positions cannot take; choose the post 'fanuc-cartesian'"
        )
    return render_files(program, options, _positions, _no_options)


def _no_options(_program: JointProgram, _move: Move) -> str:
    return ""


def _positions(program: JointProgram) -> Iterator[tuple[str, ...]]:
    for number, move in enumerate(program.moves, start=1):
        try:
            values = [angle_text(value) for value in joint_degrees(move)]
        except ModelError as error:
            raise ModelError(f"{program.name}: position {number}: {error.message}") from error
        first, second = (
            ",".join(f"\tJ{joint}={values[joint - 1]:>10} deg" for joint in row)
            for row in ((1, 2, 3), (4, 5, 6))
        )
        head = f"\tUF : {program.frame.number:d}, UT : {program.tool.number:d},\t"
        yield head, f"{first},", second


FANUC_JOINT: Final = Post(
    name="fanuc-joint",
    title="FANUC .LS, joint positions",
    suffix=SUFFIX,
    form=FileForm.FANUC_JOINT,
    render=render_fanuc_joint,
)
