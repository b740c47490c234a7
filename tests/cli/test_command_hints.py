"""What the commands say beyond the result, where a person would not know how to go on."""

import pytest

from solver.cli.main import main
from solver.errors import UnknownNameError

SEAM = """# frame: beam
x_mm, y_mm, z_mm, nx, ny, nz, feed
-300, 12.5, -40, 0, 1, 0, 25
-150, 12.5, -40, 0, 1, 0, 25
0, 12.5, -40, 0, 1, 0, 25
150, 12.5, -40, 0, 1, 0, 25
300, 12.5, -40, 0, 1, 0, 25
"""


@pytest.fixture
def seam(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "seam.csv").write_text(SEAM)
    return ["--path", "seam.csv"]


def test_points_far_apart_are_answered_with_resample(seam, capsys):
    assert main(["plan", *seam, "--beam", "HW250", "--out", "S.LS"]) == 4
    assert "--resample 10" in capsys.readouterr().err


def test_resample_plans_and_checks_the_path_of_the_guide(seam, capsys):
    resample = ["--resample", "10"]
    order = ["--beam", "HW250", "--simplify", "0.0001", "--out", "S.LS"]
    assert main(["plan", *seam, *resample, *order]) == 0
    out = capsys.readouterr().out
    assert "; here with beam HW250 and path seam.csv" in out.splitlines()[0]
    assert "path 61 waypoints" in out
    assert "--simplify dropped" in out
    assert main(["check", "S.LS", *seam, *resample]) == 0
    capsys.readouterr()
    assert main(["check", "S.LS"]) == 4
    assert "give that with --path" in capsys.readouterr().err
    assert main(["check", "S.LS", *seam]) == 4
    assert "--resample MM" in capsys.readouterr().err


def test_a_fault_that_is_not_relied_on_is_no_alarm_of_the_doctor(capsys):
    assert main(["doctor"]) == 0
    out = capsys.readouterr().out
    assert "WRONG" not in out
    assert "known fault of python-fcl, not relied on" in out
    assert "this installation is sound" in out.splitlines()[-1]


def test_of_many_names_three_are_listed():
    few = UnknownNameError("beam", "x", ("a", "b"))
    many = UnknownNameError("beam", "x", tuple("abcdefgh"))
    assert "(known: a, b)" in str(few)
    assert "(known: a, b, c, ...)" in str(many)
