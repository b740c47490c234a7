"""What every post writes passes its checks and says the same moves; split programs too."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from written_programs import ANY_CHANGE, CARTESIAN, JOINT, planned

from solver.catalog import load_cell
from solver.io.csv_moves_reader import read_csv_moves
from solver.io.json_program_reader import read_json_program
from solver.io.ls_interpreter import interpret
from solver.io.ls_program_set import read_program_set
from solver.io.posts import POSTS
from solver.kinematics.arm import forward
from solver.kinematics.configuration import configuration
from solver.model.program import SpeedUnit
from solver.model.program_settings import ContactMotion
from solver.model.toolpath import Role
from solver.pipeline.planning import plan
from solver.pipeline.program_check import check_program, inspect_moves
from solver.pipeline.programming import ProgramOrder, write_program
from solver.transforms import rigid
from solver.units import DEG_PER_RAD, MM, MM_PER_M

CELLS = ("groove_hw300", "zigzag_hw250")


@cache
def linear(cell):
    """The plan of a cell whose contact moves are linear, as Cartesian positions need them."""
    result = planned(cell)
    program = replace(result.problem.program, contact=ContactMotion.LINEAR)
    return replace(result, problem=replace(result.problem, program=program))


def read_back(result, path, post):
    """The moves that a written file says, by the reader of its kind."""
    problem = result.problem
    if post == "csv":
        return tuple(row.move for row in read_csv_moves(path.read_bytes(), path.name))
    if post == "json":
        return read_json_program(path.read_bytes(), path.name).moves
    found = interpret(problem.robot, problem.user_frame, problem.user_tool, read_program_set(path))
    assert not found.findings
    return found.program.moves


def write(result, folder, post, **order):
    path = folder / f"{result.problem.program.name}{POSTS[post].suffix}"
    return write_program(result, path, ProgramOrder(post=post, **order))


@pytest.fixture(scope="module")
def moves_of(tmp_path_factory):
    """Moves of each cell by each post, written once and read back."""

    @cache
    def moves(cell, post):
        result = linear(cell)
        folder = tmp_path_factory.mktemp(post)
        written = write(result, folder, post)
        assert written.checks
        assert all(one.passed for one in written.checks)
        return read_back(result, written.path, post)

    return moves


def spoken(event):
    """An event as program files say it: the spindle's programs are calls."""
    names = {"spindle-on": ("call", "SPINDLE_ON"), "spindle-off": ("call", "SPINDLE_OFF")}
    return names.get(event.kind.value, (event.kind.value, event.target)), event.value


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("post", POSTS)
def test_every_post_says_the_same_moves(cell, post, moves_of):
    found, expected = moves_of(cell, post), moves_of(cell, "json")
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        assert one.kind is other.kind
        assert one.cnt == other.cnt
        assert one.speed.unit is other.speed.unit
        assert one.speed.value == pytest.approx(other.speed.value, rel=1e-12)
        assert [spoken(event) for event in one.events] == [spoken(event) for event in other.events]


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("post", ["fanuc-joint", "csv"])
def test_posts_of_joints_keep_every_decimal(cell, post, moves_of):
    found, expected = moves_of(cell, post), moves_of(cell, "json")
    for one, other in zip(found, expected, strict=True):
        assert np.abs(one.joints - other.joints).max() * DEG_PER_RAD < 1e-9


@pytest.mark.parametrize("cell", CELLS)
def test_cartesian_and_joint_program_give_the_same_poses(cell, moves_of):
    problem = linear(cell).problem
    one, other = (
        np.array([move.joints for move in moves_of(cell, post)]) for post in (JOINT, CARTESIAN)
    )
    poses, others = (forward(problem.robot, rows, problem.tool.tcp) for rows in (one, other))
    away = np.linalg.norm(poses[:, :3, 3] - others[:, :3, 3], axis=1) * MM_PER_M
    relative = np.swapaxes(poses[:, :3, :3], 1, 2) @ others[:, :3, :3]
    turned = Rotation.from_matrix(relative).magnitude() * DEG_PER_RAD
    assert away.max() <= 0.002
    assert turned.max() <= 0.002
    for row, same in zip(one, other, strict=True):
        assert str(configuration(problem.robot, row)) == str(configuration(problem.robot, same))
    assert np.abs(one - other).max() * DEG_PER_RAD < 0.01


@pytest.mark.parametrize("cell", CELLS)
def test_the_cell_s_own_contact_motion_holds_the_feed_by_its_time(cell, tmp_path):
    result = planned(cell)
    written = write(result, tmp_path, JOINT)
    assert all(one.passed for one in written.checks)
    positions = result.problem.waypoint_poses[:, :3, 3]
    for before, move in zip(written.program.moves[:-1], written.program.moves[1:], strict=True):
        if move.waypoint is None or before.waypoint is None:
            continue
        assert move.speed.unit is SpeedUnit.DURATION
        chord = np.linalg.norm(positions[move.waypoint] - positions[before.waypoint])
        assert -1e-9 <= move.speed.value - chord / 0.02 < 0.001 + 1e-9


@pytest.mark.parametrize("post", [CARTESIAN, "json"])
def test_two_runs_write_the_same_bytes(post, tmp_path):
    texts = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        texts.append(write(linear(CELLS[0]), tmp_path / name, post).path.read_bytes())
    assert texts[0] == texts[1]


@pytest.mark.parametrize("post", ["csv", "json"])
def test_moves_of_other_posts_are_checked_after_reading_back(post, tmp_path):
    result = linear("zigzag_hw250")
    written = write(result, tmp_path, post)
    program = replace(written.program, moves=read_back(result, written.path, post))
    again = inspect_moves(result.problem, program, result.problem.settings.safety_distance)
    assert again.checks == written.report.checks
    assert not again.failed


@pytest.fixture(scope="module")
def parts_of(tmp_path_factory):
    """The files of a program of 40 lines a file at most, by each post, written once."""

    @cache
    def parts(post):
        result = planned("zigzag_hw250")
        program = replace(result.problem.program, line_limit=40)
        short = replace(result, problem=replace(result.problem, program=program))
        written = write(short, tmp_path_factory.mktemp("split"), post)
        return short, written, {one.name: one.read_bytes() for one in written.paths}

    return parts


@pytest.fixture
def split(parts_of, tmp_path):
    """Lays a split program into a folder of its own."""

    def laid(post):
        result, written, files = parts_of(post)
        for name, content in files.items():
            (tmp_path / name).write_bytes(content)
        return result, replace(written, paths=tuple(tmp_path / name for name in files))

    return laid


def failed(result, path):
    problem = result.problem
    checks = check_program(problem, read_program_set(path), problem.settings.safety_distance)
    return {one.name for one in checks if not one.passed}


@pytest.mark.parametrize("post", [JOINT, CARTESIAN])
def test_a_split_program_passes_with_its_parts(post, split, tmp_path):
    result, written = split(post)
    names = [one.name for one in written.paths]
    assert names == ["ZIGZAG.LS", *(f"ZIGZAG{number}.LS" for number in range(1, len(names)))]
    assert sorted(names) == sorted(one.name for one in tmp_path.iterdir())
    assert failed(result, written.path) == set()
    moves = read_back(result, written.path, post)
    assert len(moves) == len(written.program.moves)
    for one in written.paths:
        lines = one.read_text("ascii").split("/MN\n")[1].split("/POS")[0].splitlines()
        assert len(lines) <= 40


@pytest.mark.parametrize("post", [JOINT, CARTESIAN])
def test_a_split_program_fails_without_any_one_of_its_parts(post, split):
    result, written = split(post)
    for part in written.paths[1 :: 1 if post == JOINT else 3]:
        content = part.read_bytes()
        part.unlink()
        assert failed(result, written.path) >= {"events", "path position", "hash"}
        part.write_bytes(content)
    assert failed(result, written.path) == set()


def test_an_altered_part_is_noticed_in_the_main_program(split):
    result, written = split(JOINT)
    for part in written.paths[1::2]:
        content = part.read_bytes()
        part.write_bytes(content.replace(b"750msec", b"500msec"))
        assert failed(result, written.path) == {"feed", "hash"}
        part.write_bytes(content)


def test_parts_that_changed_places_are_noticed(split):
    result, written = split(JOINT)
    one, other = written.paths[1:3]
    first, second = one.read_bytes(), other.read_bytes()
    one.write_bytes(second)
    other.write_bytes(first)
    assert failed(result, written.path) >= {"program name", "program flow", "hash"}


@pytest.mark.parametrize("how", ["left out", "made twice", "in another order"])
def test_calls_that_changed_are_noticed_by_where_the_tcp_goes(how, split):
    result, written = split(JOINT)
    text = written.path.read_bytes()
    lines = text.split(b"\r\n")
    calls = [number for number, line in enumerate(lines) if b"CALL ZIGZAG" in line]
    first, second = calls[2:4]
    if how == "left out":
        del lines[first]
    elif how == "made twice":
        lines.insert(first, lines[first])
    else:
        lines[first], lines[second] = lines[second], lines[first]
    written.path.write_bytes(b"\r\n".join(lines))
    assert failed(result, written.path) - ANY_CHANGE >= {"path position"}


def with_own_ends(problem):
    """The path brings its own way onto the face and off it: 60 mm along the tool."""
    passes = []
    for one in problem.toolpath.passes:
        up = rigid(position=(0.0, 0.0, -60.0 * MM))
        poses = np.concatenate([one.poses[:1] @ up, one.poses, one.poses[-1:] @ up])
        roles = (Role.APPROACH, *one.roles, Role.LEAD_OUT)
        passes.append(replace(one, poses=poses, roles=roles))
    program = replace(problem.program, contact=ContactMotion.LINEAR)
    toolpath = problem.toolpath.with_passes(tuple(passes))
    return replace(problem, toolpath=toolpath, program=program)


def test_a_path_with_its_own_approach_and_retract_passes(tmp_path):
    """The spindle's events belong to its own ends, and the lift is measured from the face."""
    result = plan(with_own_ends(load_cell("zigzag_hw250")))
    written = write(result, tmp_path, JOINT)
    assert all(one.passed for one in written.checks)
    (lifts,) = [one for one in written.checks if one.name == "lifts"]
    assert lifts.value == pytest.approx(60.0, abs=0.1)
