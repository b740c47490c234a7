"""Every post against files that were checked by hand and by a twin of the kinematics."""

import csv
import io
import json
import re
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from flange_twin import angle_between, flange, wpr
from program_examples import GOLDEN_FOLDER, grind_program, m20ia

from solver.io.posts import POSTS, PostOptions

SCHEMA = Path(__file__).parents[2] / "docs" / "schemas" / "program.schema.json"

FRAME_PLACE, FRAME_TURN = (
    np.array([800, -150, 50]),
    np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]]),
)
TOOL_PLACE, TOOL_TURN = (
    np.array([60, 0, 220]),
    np.array([[0.8, 0, -0.6], [0, 1, 0], [0.6, 0, 0.8]]),
)

CASES = [
    pytest.param("fanuc-joint", grind_program(), PostOptions(), ["GRIND.LS"], id="joint"),
    pytest.param(
        "fanuc-cartesian",
        grind_program(name="GRIND_C", offset=5),
        PostOptions(),
        ["GRIND_C.LS"],
        id="cartesian",
    ),
    pytest.param("csv", grind_program(), PostOptions(), ["GRIND.csv"], id="csv"),
    pytest.param("json", grind_program(offset=5), PostOptions(), ["GRIND.json"], id="json"),
    pytest.param(
        "fanuc-joint",
        grind_program(name="SPLIT"),
        PostOptions(line_limit=16),
        ["SPLIT.LS", "SPLIT1.LS", "SPLIT2.LS", "SPLIT3.LS"],
        id="split",
    ),
]


@pytest.mark.parametrize(("post", "asked", "options", "names"), CASES)
def test_a_program_is_rendered_into_the_golden_files_byte_for_byte(post, asked, options, names):
    files = POSTS[post].render(asked, options, m20ia())
    assert [one.name for one in files] == names
    for one in files:
        assert one.text.encode("utf-8") == (GOLDEN_FOLDER / one.name).read_bytes()


def test_every_post_has_a_golden_file():
    assert {case.values[0] for case in CASES} == set(POSTS)


def test_the_twin_gives_the_published_flange_poses():
    for joints, place, angles in (
        ((0, 0, 0, 0, 0, 0), (1085, 0, 1040), (180, -90, 0)),
        ((30, 20, -10, 15, -60, 45), (1154.9123, 640.9070, 752.4997), (155.7498, -2.8516, 80.8485)),
        (
            (-45, 40, -30, 100, 50, -120),
            (1152.8598, -1046.1706, 360.5220),
            (-122.9172, -36.5431, -56.9336),
        ),
    ):
        found, turned = flange(*joints)
        assert found == pytest.approx(place, abs=5.1e-5)
        assert angle_between(turned, wpr(*angles)) < 1.1e-4


def values(text, names):
    """Numbers behind 'NAME=' in the order of the file, one row of six for every position."""
    pattern = "|".join(rf"{name} ?= *(-?\d*\.\d+) " for name in names)
    found = [float("".join(one)) for one in re.findall(pattern, text)]
    return np.array(found).reshape(-1, 6)


JOINTS = values(
    (GOLDEN_FOLDER / "GRIND.LS").read_text("ascii"), [f"J{joint}" for joint in range(1, 7)]
)


def test_the_cartesian_file_holds_the_twins_poses_of_the_joint_file():
    rows = values((GOLDEN_FOLDER / "GRIND_C.LS").read_text("ascii"), "XYZWPR")
    assert len(rows) == len(JOINTS) == 9
    for row, joints in zip(rows, JOINTS, strict=True):
        place, turned = flange(*joints)
        tcp = place + turned @ TOOL_PLACE
        assert FRAME_TURN.T @ (tcp - FRAME_PLACE) == pytest.approx(row[:3], abs=0.000501)
        wanted = FRAME_TURN.T @ turned @ TOOL_TURN
        assert angle_between(wanted, wpr(*row[3:])) < 0.0009


def test_the_table_holds_what_the_two_fanuc_files_hold():
    text = (GOLDEN_FOLDER / "GRIND.csv").read_bytes().decode("utf-8")
    rows = list(csv.DictReader(io.StringIO(text, newline="")))
    poses = values((GOLDEN_FOLDER / "GRIND_C.LS").read_text("ascii"), "XYZWPR")
    columns = [f"J{joint}_deg" for joint in range(1, 7)]
    assert np.array_equal([[float(row[one]) for one in columns] for row in rows], JOINTS)
    columns = ["X_mm", "Y_mm", "Z_mm", "W_deg", "P_deg", "R_deg"]
    assert np.array_equal([[float(row[one]) for one in columns] for row in rows], poses)
    assert {row["config"] for row in rows} == {"N U T, 0, 0, 0"}


def test_the_json_document_holds_the_joint_file_and_fits_its_schema():
    document = json.loads((GOLDEN_FOLDER / "GRIND.json").read_text("utf-8"))
    schema = json.loads(SCHEMA.read_text("utf-8"))
    jsonschema.validate(document, schema)
    assert np.array_equal([one["joints_deg"] for one in document["moves"]], JOINTS)
    assert document["user_frame"]["position_mm"] == FRAME_PLACE.tolist()
    assert document["user_frame"]["rotation"] == FRAME_TURN.tolist()
    for broken in (
        document | {"version": 2},
        document | {"moves": []},
        document | {"more": 1},
        {key: value for key, value in document.items() if key != "tool"},
    ):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(broken, schema)


def test_the_parts_together_hold_the_moves_of_the_whole_program():
    def moves(name):
        text = (GOLDEN_FOLDER / name).read_text("ascii")
        return [
            re.sub(r"P\[\d+\]", "P", line[5:])
            for line in text.splitlines()
            if re.match(r" +\d+:[JL] ", line)
        ]

    parts = ["SPLIT1.LS", "SPLIT2.LS", "SPLIT3.LS"]
    assert [line for name in parts for line in moves(name)] == moves("GRIND.LS")
    joints = [f"J{joint}" for joint in range(1, 7)]
    split = [values((GOLDEN_FOLDER / name).read_text("ascii"), joints) for name in parts]
    assert np.array_equal(np.concatenate(split), JOINTS)
    assert moves("SPLIT.LS") == []


def test_the_cartesian_position_in_the_documentation_is_that_of_the_golden_file():
    page = SCHEMA.parents[1].joinpath("fanuc_ls.md").read_text("utf-8")
    shown = page.split("## Cartesian positions")[1].split("```text\n")[1].split("```")[0]
    text = (GOLDEN_FOLDER / "GRIND_C.LS").read_bytes().decode("ascii")
    assert shown.replace("→", "\t").replace("\n", "\r\n") in text
