"""The command line as a person or a script uses it, in process."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from solver.cli.main import main
from solver.io.ls_reader import read_program_file

SCHEMAS = Path(__file__).parents[2] / "docs" / "schemas"


def run(capsys, *arguments):
    code = main([str(one) for one in arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def document(capsys, *arguments, schema=None):
    code, out, _ = run(capsys, *arguments)
    found = json.loads(out)
    name = schema or arguments[0]
    jsonschema.validate(found, json.loads((SCHEMAS / f"{name}.schema.json").read_text("utf-8")))
    return code, found


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_plan_writes_a_checked_program_and_check_passes(here, capsys):
    code, out, err = run(capsys, "plan", "--out", "GROOVE.LS")
    assert code == 0
    assert "Traceback" not in err
    assert "exact" in out
    assert "f2" in out
    assert "wrote GROOVE.LS" in out
    assert [one.name for one in here.iterdir()] == ["GROOVE.LS"]
    code, found = document(capsys, "check", "GROOVE.LS", "--json")
    assert code == 0
    assert found["passed"]
    assert found["cell"] == "groove_hw300"


def test_two_runs_write_the_same_bytes(here, capsys):
    run(capsys, "plan", "--out", "A.LS")
    first = (here / "A.LS").read_bytes()
    (here / "A.LS").unlink()
    run(capsys, "plan", "--out", "A.LS")
    assert (here / "A.LS").read_bytes() == first


def test_plan_prints_a_document(here, capsys):
    code, found = document(
        capsys, "plan", "groove_paper", "--scheme", "f1", "--no-program", "--json"
    )
    assert code == 0
    assert found["scheme"] == "f1"
    assert set(found["schemes"]) == {"f1", "exact", "f2"}
    assert found["schemes"]["f1"]["expanded"] == 559
    assert len(found["waypoints"]) == 50
    assert not list(here.iterdir())


def test_plan_writes_its_document_to_a_file(here, capsys):
    code, out, _ = run(capsys, "plan", "groove_paper", "--no-program", "--json", "plan.json")
    assert code == 0
    assert "Schemes" in out
    assert json.loads((here / "plan.json").read_text("utf-8"))["cell"] == "groove_paper"


def test_a_scheme_that_breaks_the_safety_distance_is_refused(here, capsys):
    code, _, err = run(capsys, "plan", "groove_paper", "--scheme", "f1", "--out", "F1.LS")
    assert code == 4
    assert "10.6 mm" in err
    assert not list(here.iterdir())


def test_less_clearance_must_be_accepted_in_words(here, capsys):
    arguments = ("plan", "groove_paper", "--beam", "HW125", "--out", "SMALL.LS")
    code, out, err = run(capsys, *arguments)
    assert code == 4
    assert "best reachable minimum" in out
    assert "--accept-clearance" in err
    assert not list(here.iterdir())
    code, _, _ = run(capsys, *arguments, "--accept-clearance", "30")
    assert code == 0
    assert "ACCEPTED CLEARANCE 30.000 MM" in (here / "SMALL.LS").read_text("ascii")
    code, out, _ = run(capsys, "check", "SMALL.LS")
    assert code == 0


def test_accepting_more_than_can_be_reached_is_refused(here, capsys):
    code, _, _ = run(
        capsys,
        "plan",
        "groove_paper",
        "--beam",
        "HW125",
        "--out",
        "S.LS",
        "--accept-clearance",
        "49",
    )
    assert code == 4
    assert not list(here.iterdir())


def test_a_changed_position_is_caught(here, capsys):
    run(capsys, "plan", "--out", "G.LS")
    text = (here / "G.LS").read_bytes().decode("ascii")
    start = text.index("P[20]{")
    at = text.index("J2=", start) + 3
    changed = text[:at] + f"{float(text[at : at + 10]) + 0.05:>10.3f}" + text[at + 10 :]
    (here / "G.LS").write_bytes(changed.encode("ascii"))
    code, found = document(capsys, "check", "G.LS", "--json")
    assert code == 4
    failed = {one["name"]: one for one in found["checks"] if not one["passed"]}
    assert failed["path position"]["waypoint"] == 17


def test_a_cell_is_never_assumed(here, capsys):
    run(capsys, "plan", "--out", "G.LS")
    text = (here / "G.LS").read_bytes().replace(b"!CELL groove_hw300", b"!sell groove_hw300")
    (here / "G.LS").write_bytes(text)
    code, _, err = run(capsys, "check", "G.LS")
    assert code == 2
    assert "--cell" in err


def test_fk_gives_the_measured_pose(capsys):
    code, found = document(capsys, "fk", "fanuc_m20ia", "--joints", "30,20,-10,15,-60,45", "--json")
    expected = [1154.9123, 640.9070, 752.4997, 155.7498, -2.8516, 80.8485]
    assert code == 0
    assert np.allclose(found["results"][0]["pose"], expected, atol=6e-5)


def test_negative_first_numbers_are_no_options(capsys):
    code, out, _ = run(capsys, "fk", "fanuc_m20ia", "--joints=-45,40,-30,100,50,-120")
    assert code == 0
    assert "1152.8598" in out
    code, out, _ = run(capsys, "fk", "fanuc_m20ia", "--joints", "-45,40,-30,100,50,-120")
    assert code == 0
    assert "1152.8598" in out


def test_ik_finds_the_joints_again(capsys):
    code, found = document(capsys, "ik", "fanuc_m20ia", "--pose", "985,0,940,180,0,0", "--json")
    assert code == 0
    joints = [one["joints_deg"] for one in found["results"][0]["solutions"]]
    assert np.abs(np.array(joints) - [0, 0, 0, 0, -90, 0]).max(axis=1).min() < 1e-9


def test_ik_out_of_reach_exits_3(capsys):
    code, found = document(capsys, "ik", "fanuc_m20ia", "--pose", "9000,0,0,0,0,0", "--json")
    assert code == 3
    assert found["results"][0]["solutions"] == []


def test_fk_and_ik_read_csv_files(here, capsys):
    (here / "j.csv").write_text("# joints\n0,0,0,0,-90,0\n30,20,-10,15,-60,45\n", "utf-8")
    code, found = document(capsys, "fk", "fanuc_m20ia", "--csv", "j.csv", "--json")
    assert code == 0
    poses = [one["pose"] for one in found["results"]]
    lines = [",".join(map(str, pose)) for pose in poses]
    (here / "p.csv").write_text("\n".join(lines), "utf-8")
    code, found = document(capsys, "ik", "fanuc_m20ia", "--csv", "p.csv", "--json")
    assert code == 0
    assert len(found["results"]) == 2


def test_distance_of_the_known_bad_case(here, capsys):
    box = {"shape": "box", "size_mm": [1000, 1000, 1000]}
    (here / "d.json").write_text(json.dumps({"a": box, "b": box | {"pose": [0, 4000, 0, 0, 0, 0]}}))
    code, found = document(capsys, "distance", "--json", "d.json")
    assert code == 0
    assert found["distance_mm"] == pytest.approx(3000.0, abs=1e-3)
    assert found["distance_mm"] <= 3000.0 + 1e-6


@pytest.mark.parametrize("kind", ["robots", "beams", "tools", "cells"])
def test_list_shows_what_is_shipped(capsys, kind):
    code, found = document(capsys, "list", kind, "--json")
    assert code == 0
    assert found["entries"]


def test_doctor_passes_its_self_test(capsys):
    code, found = document(capsys, "doctor", "--json")
    assert code == 0
    assert found["passed"]


def test_bench_reports_ratios_and_the_same_cost(capsys):
    code, found = document(capsys, "bench", "--repeats", "1", "--json")
    assert code == 0
    assert all(one["same_costs"] for one in found["peers"])


@pytest.mark.parametrize(
    "arguments",
    [
        ("plan", "no_such_cell"),
        ("plan", "missing.toml"),
        ("plan", "--path", "missing.csv"),
        ("plan", "--beam", "HW301"),
        ("plan", "--out", "NAME.TXT"),
        ("plan", "--out", "1ST.LS"),
        ("plan", "--out", "no/folder/A.LS"),
        ("plan", "--accept-clearance", "much"),
        ("plan", "--accept-clearance", "nan"),
        ("plan", "--accept-clearance", "-5"),
        ("check", "missing.LS"),
        ("fk", "no_robot", "--joints", "0,0,0,0,0,0"),
        ("fk", "fanuc_m20ia", "--joints", "0,0,0,0,0"),
        ("fk", "fanuc_m20ia", "--joints", "0,0,0,0,0,1_000"),
        ("fk", "fanuc_m20ia", "--joints", "0,0,0,0,0,１"),
        ("fk", "fanuc_m20ia", "--joints", "0,0,0,0,0,inf"),
        ("fk", "fanuc_m20ia", "--csv", "missing.csv"),
        ("ik", "fanuc_m20ia", "--pose", "0,0,0,0,0,1e999"),
        ("distance", "--json", "missing.json"),
        ("bench", "--repeats", "0"),
    ],
    ids=" ".join,
)
def test_bad_input_is_one_sentence_and_exit_2(here, capsys, arguments):
    code, out, err = run(capsys, *arguments)
    assert code == 2
    assert len(err.strip().splitlines()) == 1
    assert "Traceback" not in out + err
    assert not list(here.iterdir())


@pytest.mark.parametrize(
    "arguments",
    [
        ("plan", "--scheme", "best"),
        (),
        ("fly",),
        ("list", "ships"),
        ("fk", "fanuc_m20ia"),
        ("bench", "--repeats", "many"),
    ],
    ids=" ".join,
)
def test_bad_arguments_are_one_line_and_exit_2(here, capsys, arguments):
    with pytest.raises(SystemExit) as stop:
        main(list(arguments))
    assert stop.value.code == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1


DISTANCE_FAULTS = {
    "no object": "[]",
    "cut": '{"a": {"shape": "box"',
    "nan": '{"a": {"shape": "sphere", "radius_mm": NaN}, "b": {}}',
    "deep": "[" * 100_000,
    "word": '{"a": {"shape": "sphere", "radius_mm": "5"}, "b": {}}',
    "bool": '{"a": {"shape": "sphere", "radius_mm": true}, "b": {}}',
    "negative": '{"a": {"shape": "sphere", "radius_mm": -5}, "b": {}}',
    "ragged": '{"a": {"shape": "box", "size_mm": [1, [2], 3]}, "b": {}}',
    "flat hull": '{"a": {"shape": "hull", "vertices_mm": [[0,0,0],[1,0,0],[0,1,0]]}, "b": {}}',
    "huge": '{"a": {"shape": "sphere", "radius_mm": 1e300}, "b": {}}',
    "huge integer": '{"a": {"shape": "sphere", "radius_mm": 1' + "0" * 400 + '}, "b": {}}',
    "unknown": '{"a": {"shape": "cone"}, "b": {}}',
    "binary": "\0\1\2",
}


@pytest.mark.parametrize("name", DISTANCE_FAULTS)
def test_malformed_bodies_are_one_sentence(here, capsys, name):
    (here / "d.json").write_text(DISTANCE_FAULTS[name], "utf-8")
    code, _, err = run(capsys, "distance", "--json", "d.json")
    assert code == 2
    assert "d.json" in err
    assert len(err.strip().splitlines()) == 1


def test_the_first_run_says_that_kernels_are_compiled(capsys):
    from solver.cli.output import TerminalMonitor
    from solver.progress import COMPILING

    TerminalMonitor().report(COMPILING, 0, 1)
    assert "compiling the kernels" in capsys.readouterr().err


def test_what_no_program_could_carry_is_refused_before_planning(here, capsys, monkeypatch):
    from solver.pipeline import planning

    def unreachable(*_, **__):
        raise AssertionError("planned although nothing could be written")

    monkeypatch.setattr(planning, "plan", unreachable)
    cells = Path(__file__).parents[2] / "resources" / "cells"
    text = (cells / "groove_paper.toml").read_text("utf-8")
    name = "a_name_that_does_not_fit_a_remark"
    (here / "long.toml").write_text(text.replace('name = "groove_paper"', f'name = "{name}"'))
    code, _, err = run(capsys, "plan", "long.toml", "--out", "A.LS")
    assert code == 2
    assert name in err


def test_check_of_a_cell_that_is_not_shipped_asks_for_its_file(here, capsys):
    run(capsys, "plan", "--out", "G.LS")
    text = (here / "G.LS").read_bytes().replace(b"!CELL groove_hw300", b"!CELL my_own_cell")
    (here / "G.LS").write_bytes(text)
    code, _, err = run(capsys, "check", "G.LS")
    assert code == 2
    assert "--cell" in err


@pytest.mark.parametrize("name", ["GROOVE.LS", "path.csv", "cell.toml", "no/such/folder.json", "x"])
def test_a_document_never_replaces_what_is_no_document(here, capsys, name):
    """`--json J.LS --out J.LS` once left JSON in the program, and `--json path.csv` the input."""
    (here / "path.csv").write_text("kept", "utf-8")
    code, _, err = run(capsys, "plan", "groove_paper", "--out", "GROOVE.LS", "--json", name)
    assert code == 2
    assert "--json" in err
    assert [one.name for one in here.iterdir()] == ["path.csv"]
    assert (here / "path.csv").read_text("utf-8") == "kept"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes are of POSIX systems")
@pytest.mark.parametrize("option", ["--json", "--out"])
def test_a_pipe_is_never_replaced_by_a_file(here, capsys, option):
    """As root, a device given as the output was once replaced."""
    name = "pipe.json" if option == "--json" else "PIPE.LS"
    os.mkfifo(here / name)
    code, _, _ = run(capsys, "plan", "groove_paper", option, name)
    assert code == 2
    assert (here / name).is_fifo()


def test_a_reader_that_leaves_early_changes_nothing(here):
    """`posopt plan | head -1` once ended with exit code 0 and no program."""
    command = [sys.executable, "-m", "solver.cli.main", "plan", "groove_paper", "--out", "P.LS"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
    ) as process:
        process.stdout.close()
        errors = process.stderr.read().decode()
    assert process.returncode == 0, errors
    assert "Traceback" not in errors
    assert (here / "P.LS").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="SIGINT is sent differently there")
@pytest.mark.parametrize("seconds", [0.1, 0.6, 1.2])
def test_an_interrupt_leaves_either_nothing_or_the_whole_program(here, seconds):
    command = [sys.executable, "-m", "solver.cli.main", "plan", "--out", "P.LS"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
    ) as process:
        time.sleep(seconds)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=120)
    # Before Python has reached our code the interpreter itself answers.
    assert process.returncode in {0, 130, 1, -signal.SIGINT}
    # The signal may also come after the checked file has its name: then it stays, whole.
    left = list(here.iterdir())
    assert [file.name for file in left] in ([], ["P.LS"])
    assert all(read_program_file(file).positions for file in left)


PATH_FAULTS = {
    "a word": "x,y,z,w,p,r\n0,13,0,0,60,-90\nmany,13,0,0,60,-90\n",
    "underscores": "x,y,z,w,p,r\n0,13,0,0,60,-90\n1_000,13,0,0,60,-90\n",
    "full-width digits": "x,y,z,w,p,r\n0,13,0,0,60,-90\n５,13,0,0,60,-90\n",
    "nan": "x,y,z,w,p,r\n0,13,0,0,60,-90\nnan,13,0,0,60,-90\n",
    "ragged": "x,y,z,w,p,r\n0,13,0,0,60,-90\n5,13,0\n",
    "repeated point": "x,y,z,w,p,r\n0,13,0,0,60,-90\n0,13,0,0,60,-90\n",
    "one point": "x,y,z,w,p,r\n0,13,0,0,60,-90\n",
    "binary": "\0\1\2\3",
}


@pytest.mark.parametrize("name", PATH_FAULTS)
def test_a_malformed_path_is_one_sentence_and_nothing_is_written(here, capsys, name):
    (here / "path.csv").write_text("# frame: beam\n" + PATH_FAULTS[name], "utf-8")
    code, _, err = run(capsys, "plan", "--path", "path.csv", "--out", "P.LS")
    assert code == 2
    assert "path.csv" in err
    assert len(err.strip().splitlines()) == 1
    assert [one.name for one in here.iterdir()] == ["path.csv"]
