"""Variations that exports of controllers in use show, beyond the plain format."""

from __future__ import annotations

import numpy as np
import pytest
from ls_examples import POINT, source

from solver.errors import InputError
from solver.io.ls_instructions import called_programs, meaning
from solver.io.ls_reader import read_program

GERMAN = """/PROG  NAHT7
/ATTR
EIGN.\t\t= WERK;
KOMMENTAR\t= "Träger";
PROG_GRÖßE\t= 5120;
ERSTELL\t\t= TAG 25-05-06  ZEIT 07:08:09;
TCD:  STACK_GRÖßE\t= 500,
      ZEITSCHEIBE\t= 0;
DEFAULT_GRUP\t= 1,1,*,*,*;
KONTROLLCODE\t= 00000001 00000000;
/APPL
/MN
   1:  BENUTZER_NUM=1 ;
   2:  TRAGLST[1] ;
   3:J P[1] 100% CNT0 ACC100 ZEIT VOR    .10sek,SPS-A    ;
      1:  SPS-FLANKE (AN) ;
      2:  A[4]=AUS ;
      3:  WENN (!E[17] [&] A[5]),AUFRUF LUFT_AN ;
       ------ ;
   4:L P[1] 200mm/sek CNT0 ACC100    ;
   5:L P[1] max_Geschw. FINE    ;
   6:J P[1] 1.5sek FINE    ;
/POS
P[1]{
   GP1:
\tUF : 1, UT : 2,\t\tKONFIG : 'N U T, 0, 0, 1',
\tRX =   412.250  mm,\tRY =  -130.500  mm,\tRZ =   -88.125  mm,
\tRW =    12.500 deg,\tRP =   -20.250 deg,\tRR =   170.750 deg
   GP2:
\tUF : 1, UT : 2,\t
\tJ1=   100.000  mm
};
/END
"""


def test_a_german_export_is_read_with_its_sub_lines():
    found = read_program(GERMAN.replace("\n", "\r\n").encode("latin-1"), "NAHT7.LS")
    assert found.attributes["KOMMENTAR"] == "Träger"
    assert [(one.letter, one.speed.value, one.speed.unit) for one in found.moves] == [
        ("J", 100.0, "%"),
        ("L", 200.0, "mm/sec"),
        ("L", None, "max_Geschw."),
        ("J", 1.5, "sec"),
    ]
    assert found.moves[0].options == ("ACC100", "ZEIT", "VOR", ".10sek,SPS-A")
    assert [one.number for one in found.instructions] == [1, 2, 3, 1, 2, 3, None, 4, 5, 6]
    position = found.positions[1]
    assert position.arm.config == "N U T, 0, 0, 1"
    place, angles = position.cartesian
    assert place.tolist() == pytest.approx([0.41225, -0.1305, -0.088125])
    assert np.degrees(angles).tolist() == pytest.approx([12.5, -20.25, 170.75])


def test_the_application_section_may_come_several_times():
    sections = (
        "/APPL\n  SPOT : TRUE ; \n  CYCLE_TARGET =   0.00 ;\n"
        "/APPL\n\nAUTO_SINGULARITY_HEADER;\n  ENABLE_SINGULARITY_AVOIDANCE   : TRUE;\n/MN\n"
    )
    assert len(read_program(source().replace("/MN\n", sections), "S.LS").moves) == 1


def test_the_cases_of_a_selection_have_lines_of_their_own():
    lines = (
        "   1:  SELECT R[1]=1,JMP LBL[1] ;\n   2:         =2,CALL A2 ;\n"
        "   3:         ELSE,JMP LBL[9] ;\n   4:J P[1] 5% FINE    ;\n"
    )
    found = read_program(source(lines), "S.LS")
    assert found.instructions[1].text == "=2,CALL A2"


def test_remarks_of_editors_go_on_in_a_second_line():
    lines = "   1:  --eg:Grinds the upper side of\n    :  the web ;\n   2:J P[1] 5% FINE    ;\n"
    assert len(read_program(source(lines), "S.LS").moves) == 1


@pytest.mark.parametrize(
    ("termination", "kept"),
    [("CR10", "CR10"), ("CR5,10", "CR5,10"), ("CD50", "CD50"), ("CD R[1]", "CD R[1]")],
)
def test_corner_regions_and_distances_are_kept_as_written(termination, kept):
    lines = f"   1:L P[1] 50mm/sec {termination} ACC100    ;\n"
    (motion,) = read_program(source(lines), "S.LS").moves
    assert (motion.termination, motion.cnt, motion.options) == (kept, None, ("ACC100",))


@pytest.mark.parametrize("termination", ["CR", "CD", "CR10,", "CRx", "CR10.5", "CR10000"])
def test_a_corner_region_without_a_sound_number_is_refused(termination):
    with pytest.raises(InputError, match=r"line 5, .*FINE or CNT0"):
        read_program(source(f"   1:L P[1] 50mm/sec {termination} ;\n"), "S.LS")


def test_an_untaught_position_may_have_an_empty_configuration():
    point = (
        "P[1]{\n   GP1:\n\tUF : F, UT : F,\t\tCONFIG : '',\n"
        "\tX = ********  mm,\tY = ********  mm,\tZ = ********  mm,\n"
        "\tW = ******** deg,\tP = ******** deg,\tR = ******** deg\n};\n"
    )
    position = read_program(source(positions=point), "S.LS").positions[1]
    assert position.arm.config == ""
    assert [axis.value for axis in position.arm.axes] == [None] * 6


def test_rail_and_turntable_stand_behind_the_arm():
    point = (
        "P[1:\"top\"]{\n   GP1:\n\tUF : 1, UT : 1,\t\tCONFIG : 'F U T, 0, 0, 0',\n"
        "\tX =   316.754  mm,\tY =  8812.643  mm,\tZ =  1365.421  mm,\n"
        "\tW =    85.998 deg,\tP =    35.273 deg,\tR =    89.898 deg,\n"
        "\tE1=  7926.581  mm\n   GP2:\n\tUF : 0, UT : 1,\t\n"
        "\tJ1=   833.743  mm,\tJ2=     -.500 deg\n};\n"
    )
    position = read_program(source(positions=point), "S.LS").positions[1]
    assert position.label == "top"
    assert [(axis.name, axis.value) for axis in position.arm.extra] == [("E1", 7926.581)]
    assert [axis.value for axis in position.groups[1].axes] == [833.743, -0.5]


def test_values_of_six_decimals_between_tabs_and_units_without_a_blank_are_read():
    point = (
        "P[1]{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'F U T, 0, 0, 0',\n"
        "\tX =\t2160.710996\tmm,\tY =\t676.778384\tmm,\tZ =\t866.104966mm,\n"
        "\tW =\t99.473804\tdeg,\tP =\t164.499492\tdeg,\tR =74.103204deg\n};\n"
    )
    position = read_program(source(positions=point), "S.LS").positions[1]
    assert position.cartesian[0].tolist() == pytest.approx([2.160710996, 0.676778384, 0.866104966])


def test_line_numbers_may_stand_behind_a_tab():
    (motion,) = read_program(source("\t147:L P[1] R[10]mm/sec CNT60 \t;\n"), "S.LS").moves
    assert motion.positions == (1,)


def test_the_tool_of_several_groups_at_once_counts_for_the_arm():
    lines = "   1:  UTOOL_NUM[GP2,GP1]=3 ;\n   2:  UFRAME_NUM[GP1,GP2]=2 ;\n   3:J P[1] 5% FINE ;\n"
    found = read_program(source(lines), "S.LS")
    assert (found.uframe, found.utool) == (2, 3)


def test_a_position_without_the_arms_group_has_no_joints():
    position = read_program(source(positions=POINT.replace("GP1", "GP2")), "S.LS").positions[1]
    assert position.arm is None
    with pytest.raises(InputError, match=r"line 7, .*P\[1\] holds GP2 but not GP1"):
        position.joints_deg  # noqa: B018 - asked for its error


@pytest.mark.parametrize(
    ("line", "taken"),
    [
        ("GP2" + "," * 3000, True),
        ("UTOOL_NUM[" + "GP2," * 900 + "]=1", True),
        ("UTOOL_NUM" + " " * 3000 + "[" + " " * 900 + "x", True),
        ("WAIT " + "1" * 3000, True),
        ("CALL " + "A" * 3000 + "-", True),
        ("TIMER[" + "]" * 3000, True),
        ("L P[1] 50mm/sec CR" + "1" * 3000, False),
    ],
    ids=range(7),
)
def test_long_lines_are_kept_as_text_or_refused_without_searching_for_hours(line, taken):
    lines = source((line + " ;\n") * 300)
    if taken:
        found = read_program(lines, "S.LS")
        assert {one.text for one in found.instructions} == {line}
        assert [meaning(one.text) is None for one in found.instructions] == [False] * 300
        assert not called_programs(line)
    else:
        with pytest.raises(InputError, match=r"S.LS, line 5, "):
            read_program(lines, "S.LS")
