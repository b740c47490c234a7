"""A program and the files beside it that it calls."""

from __future__ import annotations

import numpy as np
import pytest
from ls_oracle import HOME, joint_point, text

from solver.catalog.robots import load_robot
from solver.errors import InputError
from solver.io.ls_findings import FindingKind
from solver.io.ls_interpreter import interpret
from solver.io.ls_program_set import DEPTH_LIMIT, program_set, read_program_set
from solver.io.ls_reader import read_program
from solver.model.program import NumberedPose

MOVE = "J P[1] 20% FINE"
POINT = joint_point(1, HOME)


def write(folder, name, lines, points="", held=None):
    path = folder / name
    path.write_text(text(lines, points, held or path.stem.upper()), newline="\r\n")
    return path


def test_called_programs_beside_the_file_are_read_and_others_are_listed(tmp_path):
    main = write(tmp_path, "MAIN.LS", "CALL PART1\nCALL SPINDLE_ON\nCALL PART2\nCALL PART1")
    write(tmp_path, "PART1.LS", "CALL DEEPER\n" + MOVE, POINT)
    write(tmp_path, "PART2.LS", MOVE, POINT)
    write(tmp_path, "DEEPER.LS", "CALL GLUE(1)\nCALL SPINDLE_ON")
    write(tmp_path, "NOT_CALLED.LS", MOVE, POINT)
    (tmp_path / "SPINDLE_ON.TP").write_bytes(b"binary")
    found = read_program_set(main)
    assert found.main.name == "MAIN"
    assert set(found.programs) == {"MAIN", "PART1", "PART2", "DEEPER"}
    assert found.unresolved == ("GLUE", "SPINDLE_ON")
    assert found.programs["PART2"].file == str(tmp_path / "PART2.LS")


def test_file_names_are_compared_without_case(tmp_path):
    main = write(tmp_path, "main.ls", "CALL PART1")
    write(tmp_path, "Part1.Ls", MOVE, POINT)
    assert set(read_program_set(main).programs) == {"MAIN", "PART1"}


def test_two_files_of_one_name_are_refused_at_the_call(tmp_path):
    main = write(tmp_path, "MAIN.LS", "CALL PART1")
    write(tmp_path, "PART1.LS", MOVE, POINT)
    write(tmp_path, "part1.ls", MOVE, POINT)
    if len(list(tmp_path.iterdir())) < 3:
        pytest.skip("the file system does not tell the two names apart")
    with pytest.raises(InputError, match=r"MAIN.LS, line 7, .*PART1.LS or part1.ls"):
        read_program_set(main)


def test_remarked_calls_do_not_count_and_conditional_ones_do(tmp_path):
    lines = "!CALL A1\n//CALL A2\n--eg:CALL A3\nIF R[1]=1,CALL A4\n       =2,CALL A5\nRECALL A6"
    found = read_program_set(write(tmp_path, "MAIN.LS", lines))
    assert found.unresolved == ("A4", "A5")


def test_a_called_file_that_is_no_program_is_refused_by_its_name(tmp_path):
    main = write(tmp_path, "MAIN.LS", "CALL PART1")
    (tmp_path / "PART1.LS").write_text("ERRALL.LS  Robot Name\n")
    with pytest.raises(InputError, match=r"PART1.LS, line 1"):
        read_program_set(main)
    (tmp_path / "PART1.LS").unlink()
    (tmp_path / "PART1.LS").mkdir()
    with pytest.raises(InputError, match=r"PART1.LS: cannot be read"):
        read_program_set(main)


@pytest.mark.parametrize("length", [1, 2, 5])
def test_programs_that_call_each_other_in_a_circle_are_refused(tmp_path, length):
    names = [f"P{number}" for number in range(length)]
    for name, callee in zip(names, [*names[1:], names[0]], strict=True):
        write(tmp_path, f"{name}.LS", f"CALL {callee}")
    with pytest.raises(InputError, match=r"LS, line 7, .*in a circle: P") as caught:
        read_program_set(tmp_path / "P0.LS")
    assert " > ".join([*names, "P0"]) in str(caught.value)


def test_a_circle_beside_the_main_program_is_refused_too(tmp_path):
    main = write(tmp_path, "MAIN.LS", "CALL A1")
    write(tmp_path, "A1.LS", "CALL A2")
    write(tmp_path, "A2.LS", "CALL A1")
    with pytest.raises(InputError, match=r"A2.LS, line 7, .*A1 > A2 > A1"):
        read_program_set(main)


def chain(folder, length):
    for number in range(1, length):
        write(folder, f"P{number}.LS", f"CALL P{number + 1}")
    write(folder, f"P{length}.LS", MOVE, POINT)
    return folder / "P1.LS"


def test_calls_may_be_nested_to_the_limit_and_no_deeper(tmp_path):
    assert len(read_program_set(chain(tmp_path, DEPTH_LIMIT)).programs) == DEPTH_LIMIT
    with pytest.raises(InputError, match=f"nested deeper than {DEPTH_LIMIT}"):
        read_program_set(chain(tmp_path, DEPTH_LIMIT + 1))


def test_depth_is_counted_along_the_longest_way_and_not_the_first(tmp_path):
    # The short way visits the chain first, so that its depth is known when the long way comes.
    chain(tmp_path, DEPTH_LIMIT - 1)
    main = write(tmp_path, "MAIN.LS", "CALL P1\nCALL B1")
    write(tmp_path, "B1.LS", "CALL P1")
    with pytest.raises(InputError, match=r"B1.LS, line 7, .*nested deeper"):
        read_program_set(main)


def test_names_that_could_leave_the_folder_are_never_files(tmp_path):
    write(tmp_path, "SECRET.LS", MOVE, POINT)
    inner = tmp_path / "inner"
    inner.mkdir()
    main = write(inner, "MAIN.LS", "CALL ../SECRET\nCALL SECRET-1")
    assert read_program_set(main).unresolved == ()


def test_a_missing_main_file_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"NONE.LS: cannot be read"):
        read_program_set(tmp_path / "NONE.LS")


def in_memory(name, lines, points=""):
    return read_program(text(lines, points, name), f"{name}.LS")


def test_programs_in_memory_make_a_set_without_a_folder():
    found = program_set(
        [in_memory("MAIN", "CALL PART1\nCALL AIR"), in_memory("PART1", MOVE, POINT)]
    )
    assert found.main.name == "MAIN"
    assert set(found.programs) == {"MAIN", "PART1"}
    assert found.unresolved == ("AIR",)


def test_programs_in_memory_need_one_main_program_and_different_names():
    with pytest.raises(InputError, match="needs a main program"):
        program_set([])
    with pytest.raises(InputError, match=r"A1.LS: program A1 is given twice"):
        program_set([in_memory("MAIN", "CALL A1"), *[in_memory("A1", MOVE, POINT)] * 2])


def test_a_program_in_memory_that_calls_itself_is_refused():
    with pytest.raises(InputError, match="circle: MAIN > MAIN"):
        program_set([in_memory("MAIN", "CALL MAIN")])


def test_a_file_that_holds_a_program_of_another_name_is_a_finding(tmp_path):
    main = write(tmp_path, "MAIN.LS", "UFRAME_NUM=0\nUTOOL_NUM=1\nCALL PART1")
    write(tmp_path, "PART1.LS", MOVE, POINT, held="PART9")
    found = interpret(
        load_robot("fanuc_m20ia"),
        NumberedPose(0, np.eye(4)),
        NumberedPose(1, np.eye(4)),
        read_program_set(main),
    )
    (finding,) = found.findings
    assert finding.kind is FindingKind.NAME
    assert "called as PART1, but it holds program PART9" in str(finding)
