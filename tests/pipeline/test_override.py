"""A failing check writes nothing; a typed reason writes NAME_OVR, which says so for good."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from written_programs import planned

from solver.cli.main import main
from solver.errors import InputError, PosoptError, RefusedError
from solver.io.ls_program_set import read_program_set
from solver.io.ls_reader import read_program_file
from solver.pipeline import programming
from solver.pipeline.program_check import check_program
from solver.pipeline.programming import ProgramOrder, check_order, write_program
from solver.pipeline.remarks import OVERRIDE_REMARK, required_clearance, stated_override
from solver.units import MM

REASON = "trial piece of plastic, no robot near it"
ORDER = ProgramOrder(override=REASON)


def failing(post="fanuc-joint"):
    """A result whose program breaks one check: it may not leave its path by 0.03 mm."""
    result = planned("groove_hw300")
    settings = replace(result.problem.program, path_tolerance=0.03 * MM, post=post)
    return replace(result, problem=replace(result.problem, program=settings))


def names(folder):
    return sorted(one.name for one in folder.iterdir())


@pytest.mark.parametrize("post", ["fanuc-joint", "csv", "json"])
def test_a_failing_check_writes_nothing(post, tmp_path):
    suffix = {"fanuc-joint": ".LS", "csv": ".csv", "json": ".json"}[post]
    with pytest.raises(RefusedError, match="path between positions") as refused:
        write_program(failing(post), tmp_path / f"GROOVE{suffix}")
    assert refused.value.exit_code == 4
    assert names(tmp_path) == []


def test_a_program_that_stood_there_keeps_its_bytes(tmp_path):
    path = tmp_path / "GROOVE.LS"
    write_program(planned("groove_hw300"), path)
    before = path.read_bytes()
    with pytest.raises(RefusedError):
        write_program(failing(), path)
    assert path.read_bytes() == before
    write_program(failing(), path, ORDER)
    assert path.read_bytes() == before
    assert names(tmp_path) == ["GROOVE.LS", "GROOVE_OVR.LS"]


def test_nothing_is_written_when_a_check_fails_only_after_reading_back(tmp_path, monkeypatch):
    from solver.analysis.check import Check
    from solver.pipeline.program_check import ProgramReport

    sound = programming.inspect_program
    calls = []

    def fails_the_second_time(*arguments):
        calls.append(arguments)
        if len(calls) == 1:
            return sound(*arguments)
        return ProgramReport((Check("clearance", False, 49.9, 50.0, "mm"),))

    monkeypatch.setattr(programming, "inspect_program", fails_the_second_time)
    with pytest.raises(RefusedError, match="clearance"):
        write_program(planned("groove_hw300"), tmp_path / "GROOVE.LS")
    assert len(calls) == 2
    assert names(tmp_path) == []


def test_an_override_writes_another_name_with_the_reason_in_its_remarks(tmp_path):
    written = write_program(failing(), tmp_path / "GROOVE.LS", ORDER)
    assert names(tmp_path) == ["GROOVE_OVR.LS"]
    assert written.override == REASON
    assert written.path.name == "GROOVE_OVR.LS"
    found = read_program_file(written.path)
    assert found.name == "GROOVE_OVR"
    parts = [one.removeprefix(OVERRIDE_REMARK) for one in found.remarks if OVERRIDE_REMARK in one]
    assert "".join(parts) == REASON
    assert "CHECKS FAILED, see the report" in found.remarks
    assert "checked on the nominal model" not in found.remarks
    assert all(len(one) <= 32 for one in found.remarks)


def test_the_check_of_an_overridden_program_still_fails(tmp_path):
    result = failing()
    written = write_program(result, tmp_path / "GROOVE.LS", ORDER)
    programs = read_program_set(written.path)
    checks = check_program(
        result.problem, programs, required_clearance(result.problem, programs.main)
    )
    failed = [one.name for one in checks if not one.passed]
    assert "path between positions (sampled)" in failed
    assert [one.name for one in written.report.failed] == failed
    assert "hash" not in failed
    assert "program name" not in failed
    assert stated_override(programs.main) == REASON


def test_an_override_that_is_not_needed_leaves_no_trace(tmp_path):
    written = write_program(planned("groove_hw300"), tmp_path / "GROOVE.LS", ORDER)
    assert names(tmp_path) == ["GROOVE.LS"]
    assert written.override is None
    assert OVERRIDE_REMARK not in (tmp_path / "GROOVE.LS").read_text("ascii")


@pytest.mark.parametrize("post", ["csv", "json"])
def test_an_override_of_other_posts_ends_in_ovr_too(post, tmp_path):
    write_program(failing(post), tmp_path / f"GROOVE.{post}", ORDER)
    assert names(tmp_path) == [f"GROOVE_OVR.{post}"]


BAD_REASONS = {
    "too short": ("no time", "at least 10 characters"),
    "blanks alone": (" " * 40, "at least 10 characters"),
    "short but for blanks": (" " * 20 + "because" + " " * 20, "at least 10 characters"),
    "Chinese": ("客户要求今天必须完成这个试件", "Chinese"),
    "a semicolon": ("first; DO[1]=ON ; then", "printable ASCII"),
    "a quote": ('the "customer" wants it so', "printable ASCII"),
    "a line break": ("the customer\nwants it so", "printable ASCII"),
    "a control character": ("the customer\x1b[0m wants it so", "printable ASCII"),
    "an umlaut": ("der Kunde wünscht es so", "printable ASCII"),
    "a hole": ("the customer" + " " * 40 + "wants it so", "spaces in a row"),
    "too long": ("because " * 40_000, "lines|characters"),
}


@pytest.mark.parametrize("name", BAD_REASONS)
def test_a_reason_that_cannot_be_stamped_is_refused_with_a_sentence(name, tmp_path):
    reason, words = BAD_REASONS[name]
    problem = planned("groove_hw300").problem
    with pytest.raises(PosoptError, match=words) as refused:
        check_order(problem, tmp_path / "GROOVE.LS", ProgramOrder(override=reason))
    assert refused.value.exit_code == 2
    assert len(str(refused.value)) < 400
    assert names(tmp_path) == []


@pytest.mark.parametrize("name", ["too short", "Chinese", "a semicolon"])
def test_a_bad_reason_is_refused_before_anything_is_planned(name, tmp_path, monkeypatch, capsys):
    from solver.pipeline import planning

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(planning, "plan", lambda *_, **__: pytest.fail("it was planned"))
    reason, words = BAD_REASONS[name]
    assert main(["plan", "groove_hw300", "--override", reason]) == 2
    error = capsys.readouterr().err
    assert re.search(words, error)
    assert len(error.splitlines()) == 1
    assert names(tmp_path) == []


def test_a_name_that_leaves_no_room_for_ovr_is_refused_before_planning(tmp_path):
    problem = planned("groove_hw300").problem
    short = replace(problem, program=replace(problem.program, name_length=8))
    check_order(short, tmp_path / "GROOVE.LS", ProgramOrder())
    with pytest.raises(PosoptError, match="GROOVE_OVR"):
        check_order(short, tmp_path / "GROOVE.LS", ORDER)


def test_less_clearance_than_asked_needs_an_override_or_an_acceptance(tmp_path):
    result = planned("groove_hw300")
    settings = replace(result.problem.settings, safety_distance=60.0 * MM)
    near = replace(result, problem=replace(result.problem, settings=settings))
    with pytest.raises(RefusedError, match="--accept-clearance 50"):
        write_program(near, tmp_path / "GROOVE.LS")
    assert names(tmp_path) == []
    written = write_program(near, tmp_path / "GROOVE.LS", ORDER)
    assert [one.name for one in written.report.failed] == ["clearance"]
    accepted = write_program(near, tmp_path / "GROOVE.LS", ProgramOrder(accepted_clearance=0.05))
    assert not accepted.report.failed
    assert names(tmp_path) == ["GROOVE.LS", "GROOVE_OVR.LS"]


def test_an_accepted_clearance_is_stamped_only_where_it_is_needed(tmp_path):
    order = ProgramOrder(accepted_clearance=10.0 * MM)
    write_program(planned("groove_hw300"), tmp_path / "GROOVE.LS", order)
    assert "ACCEPTED" not in (tmp_path / "GROOVE.LS").read_text("ascii")


def test_a_clearance_that_is_accepted_is_checked_as_it_is_stamped(tmp_path):
    result = planned("groove_hw300")
    settings = replace(result.problem.settings, safety_distance=60.0 * MM)
    near = replace(result, problem=replace(result.problem, settings=settings))
    path = tmp_path / "GROOVE.LS"
    with pytest.raises(InputError, match="at least"):
        write_program(near, path, ProgramOrder(accepted_clearance=1e-7))
    write_program(near, path, ProgramOrder(accepted_clearance=0.0300004))
    assert "ACCEPTED CLEARANCE 30.000 MM" in path.read_text("ascii")
    found = read_program_file(path)
    assert required_clearance(near.problem, found) == pytest.approx(0.03, abs=1e-12)


@pytest.fixture
def tight_cell(tmp_path):
    """A copy of the shipped cell that no program of it can satisfy."""
    shipped = Path(__file__).parents[2] / "resources"
    text = (shipped / "cells" / "groove_hw300.toml").read_text("utf-8")
    text = text.replace("path_tolerance_mm = 0.5", "path_tolerance_mm = 0.03")
    for folder, name in (("cells", "tight.toml"), ("examples", "groove_hw300.csv")):
        (tmp_path / folder).mkdir()
        content = text.encode() if folder == "cells" else (shipped / folder / name).read_bytes()
        (tmp_path / folder / name).write_bytes(content)
    (tmp_path / "out").mkdir()
    return tmp_path / "cells" / "tight.toml"


def test_the_command_exits_4_then_writes_with_a_reason_and_check_exits_4(
    tight_cell, monkeypatch, capsys
):
    out = tight_cell.parents[1] / "out"
    monkeypatch.chdir(out)
    assert main(["plan", str(tight_cell)]) == 4
    error = capsys.readouterr().err
    assert "no program was written" in error
    assert "path between positions" in error
    assert names(out) == []
    assert main(["plan", str(tight_cell), "--override", REASON]) == 0
    assert REASON in capsys.readouterr().out
    assert names(out) == ["GROOVE_OVR.LS"]
    assert main(["check", "GROOVE_OVR.LS", "--cell", str(tight_cell)]) == 4
    shown = capsys.readouterr()
    assert f"written in spite of failed checks: {REASON}" in shown.out
    assert "path between positions" in shown.err
