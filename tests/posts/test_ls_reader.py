"""A corpus of hand-written variants; the expected values were read off with the eye."""

import math

import numpy as np
import pytest
from ls_examples import GOLDEN, POINT, source

from solver.errors import InputError
from solver.io.ls_reader import read_program, read_program_file

CARTESIAN = """P[2:"above hole"]{
   GP1:
\tUF : 2, UT : 3,\t\tCONFIG : 'N U T, 0, -1, 0',
\tX =   900.000  mm,\tY =     -.250  mm,\tZ =   500.000  mm,
\tW =   180.000 deg,\tP =     -.384 deg,\tR =   -90.000 deg
};
"""


def test_the_hand_checked_file_is_read_to_the_values_that_stand_in_it():
    found = read_program_file(GOLDEN)
    assert (found.name, found.kind, found.comment) == ("GROOVE_3", "", "three moves")
    assert found.remarks == ("CELL groove_hw300", "remark of exactly thirty-two cha")
    assert (found.uframe, found.utool) == (0, 1)
    assert found.attributes["LINE_COUNT"] == "16"
    assert found.attributes["TASK_PRIORITY"] == "50"
    assert [one.number for one in found.instructions] == list(range(1, 17))
    assert found.instructions[5].text == "CALL SPINDLE_ON"
    assert found.instructions[11].text == "WAIT  12.35(sec)"
    assert [(m.letter, m.positions, m.speed.value, m.speed.unit) for m in found.moves] == [
        ("J", (1,), 10.0, "%"),
        ("J", (2,), 250.0, "msec"),
        ("J", (3,), 1235.0, "msec"),
        ("J", (4,), 100.0, "%"),
    ]
    assert [(m.termination, m.cnt) for m in found.moves] == [
        ("FINE", None),
        ("CNT", 100),
        ("CNT", 0),
        ("FINE", None),
    ]
    assert [one.joints_deg for one in found.path_positions()] == [
        (0.0, -30.0, 30.0, 0.0, -90.0, 0.0),
        (0.582, -0.398, 0.0, 180.0, -120.25, 360.0),
        (-170.0, -99.999, 10.0, -200.0, 0.001, -0.001),
        (1.0, -1.0, 0.999, -0.999, 9.999, 12.345),
    ]
    assert np.allclose(found.path_joints()[2, 0], -170 / 180 * math.pi, atol=1e-15)
    assert found.moves[2].place.line == 31
    assert found.moves[2].place.column == 6
    assert found.positions[4].place.line == 57
    assert found.frame_conflicts() == ()


def test_text_and_bytes_and_a_byte_order_mark_and_line_ends_make_no_difference():
    data = GOLDEN.read_bytes()
    found = read_program(data, "G.LS")
    for variant in (
        data.decode(),
        data.replace(b"\r\n", b"\n"),
        b"\xef\xbb\xbf" + data,
        "\ufeff" + data.decode(),
        data + b"\r\n \r\n",
        data + b"\x1a",
        data.removesuffix(b"\r\n"),
        data.replace(b"/MN\r\n", b"/MN  \r\n\r\n"),
        data.replace(b"\t", b"  "),
    ):
        again = read_program(variant, "G.LS")
        assert [one.joints_deg for one in again.path_positions()] == [
            one.joints_deg for one in found.path_positions()
        ]
        assert [one.text for one in again.instructions] == [one.text for one in found.instructions]


def test_a_header_with_the_default_group_only_is_enough():
    found = read_program(source(), "S.LS")
    assert dict(found.attributes) == {"DEFAULT_GROUP": "1,*,*,*,*"}
    assert found.comment == ""
    assert (found.uframe, found.utool) == (None, None)


def test_a_header_may_be_missing_altogether():
    text = source().replace("/ATTR\nDEFAULT_GROUP\t= 1,*,*,*,*;\n", "")
    assert read_program(text, "S.LS").attributes == {}


def test_localised_keys_and_latin_1_texts_are_kept_as_written():
    header = (
        'PROPRIÉTAIRE\t= MNEDITOR;\nCOMMENTAIRE\t= "meulage ; été";\n'
        "CRÉATION\t= DATE 26-11-21  TIME 10:00:00;\n"
        "TCD:  TAILLE_PILE\t= 0,\n      PRIORITÉ\t= 50;\n"
    )
    text = source("   1:  !Träger\x85 schleifen ;\n   2:J P[1] 20% FINE    ;\n")
    data = text.replace("DEFAULT", header + "DEFAULT").encode("latin-1")
    found = read_program(data, "S.LS")
    assert found.attributes["COMMENTAIRE"] == "meulage ; été"
    assert found.attributes["CRÉATION"] == "DATE 26-11-21  TIME 10:00:00"
    assert found.attributes["PRIORITÉ"] == "50"
    assert found.remarks == ("Träger\x85 schleifen",)


def test_an_application_section_is_passed_over():
    text = source().replace(
        "/MN\n",
        "/APPL\n\nAUTO_SINGULARITY_HEADER;\n  ENABLE_SINGULARITY_AVOIDANCE   : TRUE;\n/MN\n",
    )
    assert len(read_program(text, "S.LS").moves) == 1


def test_a_macro_says_so_after_its_name():
    found = read_program(source().replace("SMALL", "SMALL\t  Macro"), "S.LS")
    assert (found.name, found.kind) == ("SMALL", "Macro")


@pytest.mark.parametrize(
    "line",
    [
        "   1:J P[1] 20% CNT50    ;",
        "1:J P[1] 20% CNT50;",
        "   1:  J P[1] 20% CNT50" + " " * 18 + ";",
        "    :J P[1] 20% CNT50    ;",
        "J P[1] 20% CNT50 ;",
        ":J P[1]  20 %  CNT 50 ;  ",
        "  17:J @P[1:home] 20.0% CNT50    ;",
        "   1:J P[1] 20%\n    :  CNT50    ;",
    ],
)
def test_numbers_blanks_and_semicolons_of_program_lines_vary(line):
    (motion,) = read_program(source(line + "\n"), "S.LS").moves
    assert (motion.letter, motion.positions) == ("J", (1,))
    assert (motion.speed.value, motion.speed.unit) == (20.0, "%")
    assert (motion.termination, motion.cnt, motion.options) == ("CNT", 50, ())


@pytest.mark.parametrize(
    ("speed", "value", "unit"),
    [
        ("250mm/sec", 250.0, "mm/sec"),
        ("1000cm/min", 1000.0, "cm/min"),
        ("100.5inch/min", 100.5, "inch/min"),
        ("45deg/sec", 45.0, "deg/sec"),
        ("1.5sec", 1.5, "sec"),
        (".5sec", 0.5, "sec"),
        ("800msec", 800.0, "msec"),
        ("max_speed", None, "max_speed"),
        ("R[25:posuw L]mm/sec", None, "mm/sec"),
        ("AR[1]mm/sec", None, "mm/sec"),
    ],
)
def test_a_linear_move_gives_its_speed_in_many_ways(speed, value, unit):
    (motion,) = read_program(source(f"   1:L P[1] {speed} FINE    ;\n"), "S.LS").moves
    assert (motion.letter, motion.speed.value, motion.speed.unit) == ("L", value, unit)


def test_options_follow_the_termination():
    line = (
        "   1:L P[1] 9mm/sec CNT R[4:cnt cache] ACC100 Offset,PR[4:offset cnc] COORD "
        "Skip,LBL[2] ;\n"
    )
    (motion,) = read_program(source(line), "S.LS").moves
    assert (motion.termination, motion.cnt) == ("CNT", None)
    assert motion.options == ("ACC100", "Offset,PR[4:offset cnc]", "COORD", "Skip,LBL[2]")


def test_a_circular_move_goes_on_in_a_second_line():
    lines = "   1:C P[1]    \n    :  P[2:end] 250mm/sec CNT10    ;\n   2:J P[1] 5% FINE    ;\n"
    found = read_program(source(lines, POINT + CARTESIAN), "S.LS")
    circular, joint = found.moves
    assert (circular.letter, circular.positions) == ("C", (1, 2))
    assert circular.targets == ("P[1]", "P[2:end]")
    assert (circular.speed.value, circular.cnt) == (250.0, 10)
    assert joint.place.line == 7
    assert [one.number for one in found.path_positions()] == [1, 2, 1]


def test_cartesian_positions_have_a_configuration_a_label_and_si_values():
    found = read_program(source("   1:L P[2] 9mm/sec FINE ;\n", CARTESIAN), "S.LS")
    position = found.positions[2]
    assert position.label == "above hole"
    assert position.first.config == "N U T, 0, -1, 0"
    assert (position.first.uframe, position.first.utool) == (2, 3)
    place, angles = position.cartesian
    assert place.tolist() == pytest.approx([0.9, -0.00025, 0.5])
    assert np.degrees(angles).tolist() == pytest.approx([180, -0.384, -90])
    with pytest.raises(InputError, match=r"line 7.*P.2. is Cartesian"):
        found.path_joints()


def test_several_motion_groups_are_kept_apart():
    point = POINT.replace(
        "};", "   GP2:\n\tUF : 0, UT : 4,\t\n\tJ1=     6.378 deg,\tJ2=  1290.488  mm\n};"
    )
    first, second = read_program(source(positions=point), "S.LS").positions[1].groups
    assert [axis.value for axis in first.axes] == [0, -30, 30, 0, -90, 0]
    assert (second.group, second.utool) == (2, 4)
    assert [(axis.name, axis.value, axis.unit) for axis in second.axes] == [
        ("J1", 6.378, "deg"),
        ("J2", 1290.488, "mm"),
    ]


def test_external_axes_are_kept_apart_from_the_arm():
    point = POINT.replace(
        "J6=     0.000 deg", "J6=     0.000 deg,\n\tE1= -1290.488  mm,\tE2= .5 deg"
    )
    position = read_program(source(positions=point), "S.LS").positions[1]
    assert position.joints_deg == (0.0, -30.0, 30.0, 0.0, -90.0, 0.0)
    assert [(axis.name, axis.value, axis.unit) for axis in position.first.extra] == [
        ("E1", -1290.488, "mm"),
        ("E2", 0.5, "deg"),
    ]


def test_spaces_may_stand_for_tabs_and_everything_on_one_line():
    point = (
        "P[1] {\n GP1:\n UF : F, UT : F,\n J1 = 38.300 deg,  J2 = -.5 deg, J3 = +1 deg, "
        "J4 = 1. deg, J5 = -0.0 deg, J6 = 0 deg\n} ;\n"
    )
    position = read_program(source(positions=point), "S.LS").positions[1]
    assert position.joints_deg == (38.3, -0.5, 1.0, 1.0, 0.0, 0.0)
    assert (position.first.uframe, position.first.utool) == (None, None)


def test_an_untaught_value_is_kept_and_an_error_only_when_used():
    point = POINT.replace("    30.000", "  ********")
    found = read_program(source(positions=point), "S.LS")
    assert found.positions[1].first.axes[2].value is None
    with pytest.raises(InputError, match=r"S.LS, line 7, .*J3 of P\[1\] was never taught"):
        found.path_joints()


def test_a_move_to_a_register_is_read_and_an_error_only_when_its_place_is_asked():
    lines = "   1:J PR[5:home] 100% FINE    ;\n   2:L P[R[35]] 1msec CNT100 ;\n"
    found = read_program(source(lines), "S.LS")
    assert [one.positions for one in found.moves] == [(), ()]
    assert [one.targets for one in found.moves] == [("PR[5:home]",), ("P[R[35]]",)]
    with pytest.raises(InputError, match=r"line 5, .*PR.5:home. goes to a register"):
        found.path_positions()


def test_other_instructions_are_kept_as_text_and_remarked_motions_are_no_motions():
    lines = (
        "   1:   ;\n   2:  LBL[1:again] ;\n   3:  R[1]=R[1]+1    ;\n   4:  //J P[1] 5% FINE    ;\n"
        "   5:  IF (DI[1]=ON AND R[2]>3) THEN ;\n   6:  $WAITTMOUT=(150) ;\n   7:  !J P[9] 5% ;\n"
        "   8:  CALL PART(1,\n    :  2) ;\n   9:  --eg:note ;\n  10:J P[1] 5% FINE    ;\n"
    )
    found = read_program(source(lines), "S.LS")
    assert [one.motion is not None for one in found.instructions] == [False] * 9 + [True]
    assert found.instructions[7].text == "CALL PART(1, 2)"
    assert found.remarks == ("J P[9] 5%",)


def test_a_change_of_frame_between_moves_belongs_to_the_moves_below_it():
    lines = (
        "   1:  UFRAME_NUM=0 ;\n   2:  UTOOL_NUM[GP1]=1 ;\n   3:J P[1] 5% FINE    ;\n"
        "   4:  UTOOL_NUM=2 ;\n   5:J P[1] 5% FINE    ;\n   6:  UTOOL_NUM=R[1] ;\n"
        "   7:J P[1] 5% FINE    ;\n   8:  UTOOL_NUM[GP2]=4 ;\n   9:J P[1] 5% FINE    ;\n"
    )
    found = read_program(source(lines), "S.LS")
    assert (found.uframe, found.utool) == (0, 1)
    assert [(one.uframe, one.utool) for one in found.moves] == [
        (0, 1),
        (0, 2),
        (0, None),
        (0, None),
    ]
    (sentence,) = found.frame_conflicts()
    assert "line 9" in sentence
    assert "P[1] was taught in UT 1, but 2 is selected" in sentence


def test_a_main_program_of_calls_has_no_positions():
    found = read_program(source("   1:  CALL PART1    ;\n", ""), "S.LS")
    assert found.positions == {}
    assert found.path_joints().shape == (0, 6)
