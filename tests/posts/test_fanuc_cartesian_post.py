import re
from dataclasses import replace

import numpy as np
import pytest
from ls_examples import move, program
from program_examples import FRAME, TOOL, grind_program, m20ia

from solver.errors import ModelError, RefusedError
from solver.io.ls_reader import read_program
from solver.io.posts import POSTS, FileForm, PostOptions
from solver.io.verified_program import differences, write_verified
from solver.model.program import NumberedPose
from solver.model.toolpath import Role
from solver.transforms import rigid

CARTESIAN = POSTS["fanuc-cartesian"]


def render(asked):
    (file,) = CARTESIAN.render(asked, PostOptions(), m20ia())
    return file.text


def faults(asked, text):
    found = (read_program(text, f"{asked.name}.LS"),)
    form = FileForm.FANUC_CARTESIAN
    return list(differences(asked, found, PostOptions(), m20ia(), form))


def test_what_the_post_writes_never_differs_from_the_program():
    for asked in (grind_program(), grind_program(offset=3), grind_program(payload=None)):
        assert faults(asked, render(asked)) == []


def test_only_contact_moves_add_the_offset():
    lines = re.findall(r"\d+:[JL] .*;", render(grind_program(offset=12)))
    roles = [one.role for one in grind_program().moves]
    assert ["Offset,PR[12]" in line for line in lines] == [one is Role.CONTACT for one in roles]


@pytest.mark.parametrize("register", [0, 101, -1])
def test_a_register_that_the_controller_has_not_is_refused(register):
    with pytest.raises(ModelError, match="position register must be a whole number"):
        render(grind_program(offset=register))


@pytest.mark.parametrize(
    ("joints", "says"),
    [
        ([10, 20, -10, 30, 0.0, 40], "singularity"),
        ([10, 20, -10, 30, -0.05, 40], "J[46] is .* deg away.*singularity is near"),
        ([10, 20, 53.325, 30, -40, 40], "singularity"),
        ([10, 20, -10, -180, -40, 40], "edge of a turn"),
        ([10, 20, -10, 20, -40, -180], "edge of a turn"),
    ],
)
def test_a_position_that_does_not_lead_back_to_its_joints_is_refused(joints, says):
    posture = program(move([0, 0, 0, 0, -90, 0]), move(joints), frame=FRAME, tool=TOOL)
    with pytest.raises(ModelError, match="PROGRAM: position 2: ") as caught:
        render(posture)
    assert re.search(says, str(caught.value))
    assert "\n" not in str(caught.value)


def test_joints_beyond_the_limits_are_refused():
    with pytest.raises(ModelError, match="do not lead back"):
        render(program(move([0, 0, 0, 0, -90, 280])))


def test_turn_numbers_tell_two_postures_of_one_pose_apart():
    near, far = [10, 20, -10, -170, -40, 100], [10, 20, -10, 190, -40, -260]
    text = render(program(move(near), move(far)))
    assert re.findall(r"CONFIG : '(.*)'", text) == ["N U T, 0, 0, 0", "N U T, 0, 1, -1"]
    first, second = text.split("/POS")[1].split("P[2]{")
    assert first.split("\tX")[1].split("}")[0] == second.split("\tX")[1].split("}")[0]


def test_a_measured_frame_moves_the_positions_and_not_the_robot():
    moved = NumberedPose(1, FRAME.pose @ rigid(position=(0.003, -0.002, 0.001)), measured=True)
    one, other = render(grind_program()), render(grind_program(frame=moved))
    assert one != other
    assert faults(grind_program(frame=moved), other) == []
    assert any("from where the TCP should be" in fault for fault in faults(grind_program(), other))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("X =    41.843", "X =    41.848", r"P\[1\] is 0.00[45]"),
        ("W =   168.541", "W =   168.545", r"P\[2\] is 0.000\d mm and 0.00[345]"),
        ("'N U T, 0, 0, 0'", "'F U T, 0, 0, 0'", r"P\[1\] has CONFIG 'F U T"),
        ("'N U T, 0, 0, 0'", "'N U T, 0, 1, 0'", r"P\[1\] has no joints .*no solution has CONFIG"),
        ("'N U T, 0, 0, 0'", "'N U X, 0, 0, 0'", r"P\[1\] has no joints .*is not a CONFIG"),
        ("X =    41.843", "X =  4100.000", r"P\[1\] has no joints"),
        ("X =    41.843", "X =  ********", r"P\[1\] has no joints .*never taught"),
        (" Offset,PR[5]", "", r"has the options \(\) instead of \('Offset,PR\[5\]',\)"),
        ("Offset,PR[5]", "Offset,PR[6]", "has the options"),
        ("12.5mm/sec", "12.6mm/sec", "has the speed 12.6mm/sec instead of 12.5 mm/s"),
        ("12.5mm/sec", "12.4mm/sec", "has the speed 12.4mm/sec"),
        ("PAYLOAD[3]", "PAYLOAD[2]", r"line 28 reads 'PAYLOAD\[2\]' instead of payload 3"),
        ("L P[4]", "J P[4]", "takes no speed in mm/sec"),
    ],
)
def test_an_injected_fault_is_found_out_and_nothing_is_written(tmp_path, old, new, says):
    def render_wrong(asked, options, robot):
        (file,) = CARTESIAN.render(asked, options, robot)
        assert old in file.text
        return (file._replace(text=file.text.replace(old, new, 1)),)

    wrong = replace(CARTESIAN, render=render_wrong)
    asked = grind_program(offset=5)
    with pytest.raises(RefusedError, match=says):
        write_verified(asked, tmp_path / "GRIND.LS", lambda _: None, PostOptions(), wrong, m20ia())
    assert list(tmp_path.iterdir()) == []


def test_joint_positions_are_no_cartesian_file():
    (file,) = POSTS["fanuc-joint"].render(grind_program(), PostOptions(), m20ia())
    assert any("X Y Z W P R was expected" in fault for fault in faults(grind_program(), file.text))


def test_the_columns_are_those_that_controllers_write():
    text = render(program(move([0, 0, 0, 0, -90, 0])))
    assert text.split("/POS\r\n")[1] == (
        "P[1]{\r\n"
        "   GP1:\r\n"
        "\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\r\n"
        "\tX =   985.000  mm,\tY =     0.000  mm,\tZ =   940.000  mm,\r\n"
        "\tW =   180.000 deg,\tP =     0.000 deg,\tR =     0.000 deg\r\n"
        "};\r\n"
        "/END\r\n"
    )


def test_joints_are_rounded_before_the_pose_is_computed():
    sharp = replace(move([0] * 6), joints=np.radians([0.0, 10.0004, 0, 0, -50, 0]))
    with pytest.raises(ModelError, match=r"position 1: J2 is 10\.0004"):
        render(program(sharp))
