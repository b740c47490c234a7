import base64
import datetime
import json
import math
import os
import random
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from posopt_gui.document.project import ProjectState
from posopt_gui.document.project_file import (
    load_project,
    project_bytes,
    read_project,
    save_project,
)
from solver.errors import InputError
from solver.model.wishes import Pin, Region

NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
WHOLE = st.integers(0, 10**9 - 1)
TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
VALUES = st.recursive(
    st.booleans() | st.integers(-(2**63), 2**63 - 1) | NUMBERS | TEXTS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(TEXTS, inner, max_size=4),
    max_leaves=20,
)
STATES = st.builds(
    ProjectState,
    cell=st.dictionaries(TEXTS, VALUES, max_size=5),
    files=st.dictionaries(TEXTS, st.binary(max_size=200), max_size=3),
    pins=st.lists(
        st.builds(Pin, WHOLE, NUMBERS, st.none() | WHOLE, st.none() | WHOLE), max_size=4
    ).map(tuple),
    regions=st.lists(
        st.builds(Region, WHOLE, WHOLE, NUMBERS, NUMBERS, st.none() | WHOLE), max_size=4
    ).map(tuple),
    folder=TEXTS,
)
STATE = ProjectState(
    cell={"cell": {"name": "a"}, "settings": {"lean_deg": [-25.0, 25.0, 1.0]}},
    files={"path.csv": b"x,y,z\n1,2,3\n"},
    pins=(Pin(3, 0.1, 2, None),),
    regions=(Region(1, 5, -0.1, 0.2, None),),
    folder="/cells",
)


@given(STATES)
def test_what_is_saved_is_what_is_loaded(state):
    assert read_project(project_bytes(state), "a.posopt") == state


@given(STATES)
def test_equal_states_give_equal_bytes_that_any_json_reader_takes(state):
    data = project_bytes(state)
    assert data == project_bytes(read_project(data, "a.posopt"))

    def refuse(name):
        raise AssertionError(name)

    document = json.loads(data.decode("utf-8"), parse_constant=refuse)
    found = {name: base64.b64decode(text) for name, text in document["files"].items()}
    assert found == dict(state.files)


@given(STATES)
@settings(max_examples=20)
def test_a_file_on_disk_holds_the_whole_state(tmp_path_factory, state):
    path = tmp_path_factory.mktemp("saved") / "a.posopt"
    save_project(STATE, path)
    save_project(state, path)
    assert load_project(path) == state
    assert [one.name for one in path.parent.iterdir()] == ["a.posopt"]


def test_a_byte_order_mark_does_not_matter():
    assert read_project(b"\xef\xbb\xbf" + project_bytes(STATE), "a.posopt") == STATE


def test_the_plan_of_a_saved_cell_is_that_of_the_cell_itself():
    import numpy as np

    import solver
    from posopt_gui.document.project import state_of_cell

    state = read_project(project_bytes(state_of_cell("groove_hw300")), "a.posopt")
    problem, asked = state.problem(), solver.load_cell("groove_hw300")
    assert np.array_equal(problem.waypoint_poses, asked.waypoint_poses)
    assert problem.settings.lean == asked.settings.lean


def changed(**values):
    document = json.loads(project_bytes(STATE))
    return json.dumps({**document, **values}).encode()


def without(key):
    document = json.loads(project_bytes(STATE))
    del document[key]
    return json.dumps(document).encode()


def row(key):
    return json.loads(project_bytes(STATE))[key][0]


def raw(key, text):
    """The project with a value that is written as it stands."""
    return changed(**{key: "@@"}).replace(b'"@@"', text.encode())


def malformed():
    yield from no_documents()
    yield from wrong_values()
    yield from malformed_pins()


def no_documents():
    whole = project_bytes(STATE)
    yield from ((f"cut {cut}", whole[:cut]) for cut in range(0, len(whole) - 1, len(whole) // 30))
    noise = random.Random(5)
    for number in range(8):
        yield f"noise {number}", bytes(noise.randrange(256) for _ in range(200))
    yield from (
        ("png", b"\x89PNG\r\n\x1a\n" + bytes(50)), ("zip", b"PK\x03\x04" + bytes(50)),
        ("utf-16", whole.decode().encode("utf-16")), ("nuls", bytes(100)), ("bom", b"\xef\xbb\xbf"),
        ("latin", '{"format": "é"}'.encode("latin-1")), ("null", b"null"), ("number", b"1"),
        ("text", b'"posopt-project"'), ("list", b"[]"), ("empty table", b"{}"),
        ("open lists", b"[" * 100_000), ("open tables", b'{"a":' * 100_000),
        ("two documents", whole + whole),
        ("name twice", whole.replace(b'"folder"', b'"cell": {}, "folder"')),
        ("inner name twice", whole.replace(b'"name": "a"', b'"name": "a", "name": "b"')),
        ("toml", b'[cell]\nname = "a"\n'),
    )  # fmt: skip


def wrong_values():
    for value in ("posopt", None, 1, ["posopt-project"], {}):
        yield f"format {value}", changed(format=value)
    for value in (0, 3, -1, "1", None, 10**30, [1], 1.5, True):
        yield f"version {value}", changed(version=value)
    for key in ("format", "version", "cell"):
        yield f"no {key}", without(key)
    for value in (None, 1, "a", [], True):
        yield f"cell {value}", changed(cell=value)
    deep = "[" * 60 + "]" * 60
    for text in ("NaN", "Infinity", "-Infinity", "1e999", "-1e999", "1" + "0" * 5000, deep,
                 '"\\ud800"', "01", "0x1", "1_000", "'a'"):  # fmt: skip
        yield f"value {text[:12]}", raw("cell", f'{{"a": {text}}}')
    for value in ([], "a", 1, {"a": 1}, {"a": None}, {"a": "###"}, {"a": "QQ"}, {"a": ["QQ=="]}):
        yield f"files {value}", changed(files=value)
    for value in (1, None, {}, []):
        yield f"folder {value}", changed(folder=value)
    yield "unknown key", changed(colour="red")
    for key in ("pins", "regions"):
        yield f"{key} unknown key", changed(**{key: [{**row(key), "colour": "red"}]})
        for value in ({}, "a", 1, [1], [None], [[]], [{}], ["a"]):
            yield f"{key} {value}", changed(**{key: value})


def malformed_pins():
    pin = {"waypoint": 1, "lean": 0.1, "branch": None, "turn": None}
    wrong = {
        "waypoint": (-1, 1.0, "1", None, True, 10**12),
        "branch": (-1, "a"),
        "turn": (0.5, []),
        "lean": ("a", None, True, [], 10**400),
    }
    for name, values in wrong.items():
        for value in values:
            yield f"pin {name} {str(value)[:9]}", changed(pins=[{**pin, name: value}])
    for text in ("NaN", "1e999", "-Infinity"):
        yield f"lean {text}", raw("pins", f'[{{"waypoint": 1, "lean": {text}}}]')


CASES = list(malformed())


def test_there_are_a_hundred_malformed_projects_or_more():
    assert len(CASES) >= 100
    assert len({name for name, _ in CASES}) == len(CASES)


@pytest.mark.parametrize(("name", "data"), CASES, ids=[name for name, _ in CASES])
def test_a_malformed_project_is_refused_in_one_sentence(name, data):
    with pytest.raises(InputError) as caught:
        read_project(data, "work.posopt")
    sentence = str(caught.value)
    assert sentence.startswith("work.posopt")
    assert "\n" not in sentence
    assert len(sentence) < 300


PLACED = {
    "cut": (b'{\n "format": "posopt-project",\n "ver', 3, 2),
    "NaN": (raw("cell", '{"a":\n  NaN}').replace(b'"cell"', b'\n"cell"'), 3, 3),
    "latin-1": ('{"format":\n "é"}'.encode("latin-1"), 2, 3),
    "name twice": (b'{"format": 1,\n"format": 2}', 2, 1),
    "pin": (changed(pins=["@@"]).replace(b'"@@"', b'\n  {"lean": 1,\n "waypoint": -1}'), 3, 14),
    "unknown key": (changed(colour="@@").replace(b'"@@"', b'\n   "red"'), 2, 4),
}


@pytest.mark.parametrize(("data", "line", "column"), PLACED.values(), ids=PLACED)
def test_a_refusal_names_line_and_column(data, line, column):
    with pytest.raises(InputError) as caught:
        read_project(data, "work.posopt")
    place = caught.value.place
    assert (place.file, place.line, place.column) == ("work.posopt", line, column)
    assert f"line {line}, column {column}" in str(caught.value)


def test_a_project_of_a_newer_version_says_so_whatever_else_it_holds():
    with pytest.raises(InputError, match="has version '3', this posopt reads 1 and 2"):
        read_project(changed(version=3, shift="red"), "work.posopt")


def test_a_project_of_the_first_version_is_read():
    assert read_project(changed(version=1), "work.posopt") == STATE


@given(st.binary(max_size=300) | st.text(max_size=100).map(lambda text: text.encode("utf-8")))
def test_no_bytes_raise_anything_else(data):
    with pytest.raises(InputError):
        read_project(data, "a.posopt")


@given(st.data())
def test_a_changed_byte_gives_a_sentence_or_a_state_that_can_be_saved_again(data):
    whole = bytearray(project_bytes(STATE))
    place = data.draw(st.integers(0, len(whole) - 1))
    whole[place] = data.draw(st.integers(0, 255))
    try:
        state = read_project(bytes(whole), "a.posopt")
    except InputError:
        return
    assert read_project(project_bytes(state), "a.posopt") == state


@pytest.mark.parametrize(
    "value", [math.inf, math.nan, datetime.date(2026, 1, 1), "\ud800"], ids=repr
)
def test_what_no_project_can_hold_is_refused_when_it_is_saved(tmp_path, value):
    path = tmp_path / "a.posopt"
    save_project(STATE, path)
    with pytest.raises(InputError):
        save_project(STATE.with_value("cell.name", value), path)
    assert load_project(path) == STATE


def test_places_that_hold_no_file_are_refused(tmp_path):
    for path in (tmp_path, tmp_path / "none.posopt", tmp_path / "none" / "a.posopt"):
        with pytest.raises(InputError):
            load_project(path)
    loop, pipe = tmp_path / "loop.posopt", tmp_path / "pipe.posopt"
    loop.symlink_to(loop)
    with pytest.raises(InputError, match="cannot be read"):
        load_project(loop)
    if hasattr(os, "mkfifo"):
        # Reading it would wait for ever.
        os.mkfifo(pipe)
        with pytest.raises(InputError, match="is no file"):
            load_project(pipe)
    for path in (tmp_path, tmp_path / "none" / "a.posopt"):
        with pytest.raises(InputError):
            save_project(STATE, path)


SAVING = """
import sys
from pathlib import Path
from posopt_gui.document.project import ProjectState
from posopt_gui.document.project_file import save_project
states = [ProjectState({"cell": {"name": name}}, {"path.csv": name.encode() * 100_000})
          for name in ("old", "new")]
path = Path(sys.argv[1])
save_project(states[0], path)
print("ready", flush=True)
while True:
    for state in reversed(states):
        save_project(state, path)
"""


def kill_while_saving(folder, kills, seed):
    """Kill a process that saves all the time, at random instants; what is left is whole."""
    whole = {
        project_bytes(
            ProjectState({"cell": {"name": name}}, {"path.csv": name.encode() * 100_000})
        ): name
        for name in ("old", "new")
    }
    instants = random.Random(seed)
    found = []
    for number in range(kills):
        path = folder / f"{number}.posopt"
        command = [sys.executable, "-c", SAVING, str(path)]
        with subprocess.Popen(
            command, stdout=subprocess.PIPE, cwd=Path(__file__).parents[2]
        ) as running:
            assert running.stdout is not None
            assert running.stdout.readline().strip() == b"ready"
            try:
                running.wait(timeout=instants.uniform(0.0, 0.1))
            except subprocess.TimeoutExpired:
                running.kill()
        found.append(whole[path.read_bytes()])
        assert load_project(path).value("cell.name") == found[-1]
    return found


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_project_is_whole_after_a_kill_at_20_instants_of_saving(tmp_path):
    # How far each process came is up to the machine; what it left is the old or the new file.
    assert len(kill_while_saving(tmp_path, 20, seed=1)) == 20


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_project_is_whole_after_a_kill_at_200_instants_of_saving(tmp_path):
    assert set(kill_while_saving(tmp_path, 200, seed=2)) == {"old", "new"}
