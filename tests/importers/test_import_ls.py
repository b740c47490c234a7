"""An existing robot program as a path."""

from __future__ import annotations

import numpy as np
import pytest
from path_examples import FLOOR, loaded, refused
from scipy.spatial.transform import Rotation

from solver.catalog.robots import load_robot
from solver.catalog.tools import load_tool
from solver.errors import InputError
from solver.io.importers import ImportOptions
from solver.model.toolpath import Event, EventKind, Frame, Role, Toolpath

WORLD = ImportOptions()


def cartesian(
    number: int, x: float, *, frame: str = "0", wpr: tuple[float, ...] = (180, 0, 90)
) -> str:
    w, p, r = wpr
    return (
        f"P[{number}]{{\n   GP1:\n\tUF : {frame}, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        f"\tX = {x:9.3f}  mm,\tY = {-50.0:9.3f}  mm,\tZ = {500.0:9.3f}  mm,\n"
        f"\tW = {w:9.3f} deg,\tP = {p:9.3f} deg,\tR = {r:9.3f} deg\n}};\n"
    )


def joint(number: int, *joints: float) -> str:
    one, two = (
        ",\t".join(f"J{index}= {joints[index - 1]:9.3f} deg" for index in group)
        for group in ((1, 2, 3), (4, 5, 6))
    )
    return f"P[{number}]{{\n   GP1:\n\tUF : 0, UT : 1,\t\n\t{one},\n\t{two}\n}};\n"


def program(lines: list[str], positions: str) -> bytes:
    body = "".join(f"{index:4d}:{line} ;\n" for index, line in enumerate(lines, start=1))
    return f"/PROG  PATH\n/ATTR\n/MN\n{body}/POS\n{positions}/END\n".encode()


def read(data: bytes, options: ImportOptions = WORLD) -> Toolpath:
    return loaded(data, "path.ls", options)


THREE = "".join(cartesian(number, 900.0 + 10.0 * number) for number in (1, 2, 3, 4))
LINES = [
    "  UFRAME_NUM=0",
    "J P[1] 20% FINE   ",
    "L P[2] 250mm/sec FINE   ",
    "  DO[3]=ON",
    "  WAIT    .50(sec)",
    "L P[3] 30mm/sec CNT100   ",
    "  CALL CLEAN   ",
    "L P[4] 180cm/min FINE   ",
]


def test_cartesian_positions_become_poses_in_fanuc_world_and_speeds_make_passes() -> None:
    path = read(program(LINES, THREE))
    assert path.frame is Frame.FANUC_WORLD
    assert [one.feed for one in path.passes] == pytest.approx([0.25, 0.03])
    assert [len(one) for one in path.passes] == [2, 2]
    np.testing.assert_allclose(path.poses[:, 0, 3], [0.91, 0.92, 0.93, 0.94], atol=1e-12)
    expected = Rotation.from_euler("xyz", [180, 0, 90], degrees=True).as_matrix()
    np.testing.assert_allclose(path.poses[:, :3, :3], [expected] * 4, atol=1e-12)
    assert path.passes[0].roles == (Role.APPROACH, Role.CONTACT)


def test_instructions_become_events_of_the_waypoint_before_them() -> None:
    path = read(program(LINES, THREE))
    output = Event(EventKind.DIGITAL_OUTPUT, "3", 1.0)
    assert dict(path.passes[0].events) == {1: (output, Event(EventKind.DWELL, value=0.5))}
    assert dict(path.passes[1].events) == {0: (Event(EventKind.CALL, "CLEAN"),)}


def test_instructions_above_the_first_move_become_events_of_its_waypoint() -> None:
    path = read(program(["  CALL SPINDLE_ON   ", *LINES], THREE))
    assert path.passes[0].events[0] == (Event(EventKind.SPINDLE_ON),)


def test_joints_become_tcp_poses_of_the_stated_robot_and_tool() -> None:
    robot, tool = load_robot("fanuc_m20ia"), load_tool("paper_tool")
    joints = [(0.0, 0.0, 0.0, 0.0, -90.0, 0.0), (30.0, 0.0, 0.0, 0.0, -90.0, 0.0)]
    positions = "".join(joint(index + 1, *row) for index, row in enumerate(joints))
    data = program(["J P[1] 20% FINE   ", "J P[2] 20% CNT100   "], positions)
    path = read(data, ImportOptions(robot=robot, tool=tool, feed=0.04))
    assert path.frame is Frame.FANUC_WORLD
    assert path.passes[0].feed == 0.04
    assert path.passes[0].roles == (Role.CONTACT, Role.CONTACT)
    # Turning J1 turns the whole arm about the vertical axis of fanuc_world.
    turn = Rotation.from_euler("z", 30, degrees=True).as_matrix()
    np.testing.assert_allclose(path.poses[1, :3, 3], turn @ path.poses[0, :3, 3], atol=1e-9)
    np.testing.assert_allclose(path.poses[1, :3, :3], turn @ path.poses[0, :3, :3], atol=1e-9)
    assert "robot and the tool" in refused(data, "path.ls", WORLD).message


def test_a_user_frame_needs_the_word_of_the_import() -> None:
    positions = "".join(cartesian(number, 10.0 * number, frame="2") for number in (1, 2))
    data = program(["L P[1] 30mm/sec FINE   ", "L P[2] 30mm/sec FINE   "], positions)
    assert "user frame" in refused(data, "path.ls", WORLD).message
    assert read(data, ImportOptions(frame=Frame.BEAM)).frame is Frame.BEAM


def test_world_positions_are_refused_where_the_import_expects_another_frame() -> None:
    assert "floor" in refused(program(LINES, THREE), "path.ls", FLOOR).message


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("C P[2] P[3] 30mm/sec FINE   ", "curve"),
        ("L PR[2] 30mm/sec FINE   ", "position of the file"),
        ("L P[2] 30mm/sec FINE Offset,PR[1]   ", "elsewhere"),
        ("L P[2] 30mm/sec FINE INC   ", "elsewhere"),
        ("L P[2] 30mm/sec FINE Skip,LBL[1]   ", "elsewhere"),
        ("L P[2] 2.0sec FINE   ", "mm/sec"),
        ("L P[1] 30mm/sec FINE   ", "repeats"),
        ("L P[9] 30mm/sec FINE   ", "P[9]"),
        ("  JMP LBL[1]", "jumps"),
        ("  IF R[1]=1,JMP LBL[1]", "jumps"),
        ("  FOR R[1]=1 TO 3", "jumps"),
        ("  DO[3]=PULSE,0.5sec", ""),
    ],
)
def test_what_leaves_the_path_uncertain_is_refused_at_its_line(line: str, says: str) -> None:
    data = program([LINES[0], LINES[1], line, *LINES[5:]], THREE)
    if not says:
        assert len(read(data)) == 3
        return
    with pytest.raises(InputError) as caught:
        read(data)
    error = caught.value
    assert error.place.line == 6
    assert says in error.message


def test_a_program_without_moves_is_refused() -> None:
    assert "no moves" in refused(program(["  !nothing"], THREE), "path.ls", WORLD).message


def test_a_damaged_program_ends_with_a_sentence() -> None:
    whole = program(LINES, THREE)
    sentences = []
    for end in range(0, len(whole), 7):
        try:
            read(whole[:end] + whole[end + 3 :])
        except InputError as error:
            sentences.append(str(error))
    assert len(sentences) > 20
    assert not any("\n" in sentence for sentence in sentences)
