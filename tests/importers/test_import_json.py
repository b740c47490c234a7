"""JSON toolpaths say the same as tables."""

from __future__ import annotations

import copy
import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from path_examples import FLOOR, as_json, assert_same, changed, document, fuzz, loaded, table
from scipy.spatial.transform import Rotation

from solver.io.importers import ImportOptions
from solver.model.toolpath import Event, EventKind, Frame, Role

NOTHING_STATED = ImportOptions()


def read(value: Any, options: ImportOptions = NOTHING_STATED) -> Any:
    return loaded(as_json(value), "path.json", options)


def test_a_document_says_the_same_as_the_table() -> None:
    value = document()
    for one in value["passes"]:
        one |= {"touches": "web", "lean_deg": 0, "lead_deg": 5}
    value["passes"][0]["waypoints"][0]["role"] = "lead-in"
    value["passes"][0]["waypoints"][1]["events"] = ["dwell:0.5", "do:2=off"]
    from_table = loaded(changed(3, "events", "dwell:0.5|do:2=0"))
    assert_same(read(value), from_table)


def test_what_a_pass_does_not_say_the_import_says() -> None:
    value = document()
    for key in ("name", "feed_mm_s", "touches"):
        del value["passes"][0][key]
    options = ImportOptions(feed=0.02, touches="flange_top", lean=0.1, lead=-0.2)
    one = read(value, options).passes[0]
    assert (one.name, one.feed, one.touches) == ("1", 0.02, "flange_top")
    assert (one.lean, one.lead) == (0.1, -0.2)


def test_roles_events_and_frames_are_read() -> None:
    value = document() | {"frame": "fanuc_world", "unit": "m", "comment": "from a test"}
    value["passes"][0]["waypoints"][0] |= {"role": "approach", "events": ["call:PREPARE"]}
    for one in value["passes"]:
        for waypoint in one["waypoints"]:
            waypoint["position"] = [number / 1000 for number in waypoint["position"]]
    path = read(value)
    assert path.frame is Frame.FANUC_WORLD
    assert path.passes[0].roles == (Role.APPROACH, Role.CONTACT)
    assert path.passes[0].events[0] == (Event(EventKind.CALL, "PREPARE"),)
    np.testing.assert_allclose(path.poses[:, :3, 3], read(document()).poses[:, :3, 3], atol=1e-15)


angles = st.lists(st.floats(-180.0, 180.0), min_size=3, max_size=3)


@given(st.lists(angles, min_size=2, max_size=5))
@settings(max_examples=50, deadline=None)
def test_quaternions_and_w_p_r_agree_with_an_independent_library(wpr: list[list[float]]) -> None:
    expected = Rotation.from_euler("xyz", wpr, degrees=True)
    quaternions = np.roll(expected.as_quat(), 1, axis=1)
    value = document()
    value["passes"] = [
        {
            "waypoints": [
                {"position": [index, 0, 0], "wpr_deg": three}
                | ({"quaternion": list(four)} if use_quaternion else {})
                for index, (three, four) in enumerate(zip(wpr, quaternions, strict=True))
            ]
        }
        for use_quaternion in (True, False)
    ]
    for number, one in enumerate(value["passes"]):
        one["name"] = str(number)
        for waypoint in one["waypoints"]:
            if "quaternion" in waypoint:
                del waypoint["wpr_deg"]
    by_quaternion, by_wpr = read(value).passes
    np.testing.assert_allclose(by_quaternion.poses[:, :3, :3], expected.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(by_wpr.poses[:, :3, :3], expected.as_matrix(), atol=1e-12)


direction = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)


@given(direction, direction, st.floats(0.01, 100.0))
@settings(max_examples=50, deadline=None)
def test_normal_and_travel_agree_with_the_best_rotation_of_an_independent_library(
    normal: tuple[float, ...], travel: tuple[float, ...], length: float
) -> None:
    n, t = np.array(normal) / np.linalg.norm(normal), np.array(travel) / np.linalg.norm(travel)
    if np.linalg.norm(np.cross(n, t)) < 1e-2:
        return
    across = t - (t @ n) * n
    expected, _ = Rotation.align_vectors(
        np.array([-n, across / np.linalg.norm(across)]), [[0, 0, 1], [0, 1, 0]]
    )
    value = document()
    for one in value["passes"]:
        for waypoint in one["waypoints"]:
            waypoint |= {"normal": list(n), "travel": list(length * t)}
    np.testing.assert_allclose(read(value).poses[:, :3, :3], [expected.as_matrix()] * 4, atol=1e-7)


def test_forms_of_orientation_may_differ_between_waypoints() -> None:
    value = document()
    first, second = value["passes"][0]["waypoints"]
    del first["travel"], second["normal"], second["travel"]
    options = ImportOptions(orientation=np.eye(3))
    poses = read(value, options).passes[0].poses
    np.testing.assert_array_equal(poses[1, :3, :3], np.eye(3))
    np.testing.assert_allclose(poses[0, :3, 1], [1, 0, 0], atol=1e-15)


@given(st.recursive(st.none() | st.booleans() | st.floats() | st.text(max_size=5), st.lists))
@settings(max_examples=80, deadline=None)
def test_any_json_ends_with_a_toolpath_or_a_sentence(value: Any) -> None:
    fuzz(json.dumps(value).encode(), "path.json")


members = st.sampled_from(
    ["passes", "waypoints", "position", "normal", "frame", "role", "events", "name", "unit", "x"]
)
small = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(members, inner, max_size=3),
    max_leaves=8,
)


@given(st.lists(st.integers(0, 3), max_size=5), members, small)
@settings(max_examples=120, deadline=None)
def test_a_document_with_any_member_replaced_ends_with_a_toolpath_or_a_sentence(
    way: list[int], name: str, value: Any
) -> None:
    changed_document = copy.deepcopy(document())
    target: Any = changed_document
    for step in way:
        children = list(target.values()) if isinstance(target, dict) else target
        nested = [child for child in children if isinstance(child, dict | list)]
        if not nested:
            break
        target = nested[step % len(nested)]
    if isinstance(target, dict):
        target[name] = value
    else:
        target.append(value)
    fuzz(json.dumps(changed_document).encode(), "path.json")


@given(st.binary(max_size=200))
@settings(max_examples=80, deadline=None)
def test_arbitrary_bytes_end_with_a_sentence(data: bytes) -> None:
    fuzz(data, "path.json")


@given(st.integers(0, len(as_json(document()))), st.integers(0, 20), st.binary(max_size=8))
@settings(max_examples=120, deadline=None)
def test_a_damaged_document_ends_with_a_sentence(start: int, length: int, damage: bytes) -> None:
    data = as_json(document())
    fuzz(data[:start] + damage + data[start + length :], "path.json")


def test_numbers_are_read_as_the_standard_library_reads_them() -> None:
    for text in ("0.1", "-1e-7", "12.3456789012345678", "1E+1", "-0.0"):
        value = document()
        value["passes"][0]["waypoints"][1]["position"][1] = "here"
        data = as_json(value).replace(b'"here"', text.encode())
        value = loaded(data, "path.json", NOTHING_STATED).poses[1, 1, 3]
        assert value == pytest.approx(json.loads(text) / 1000.0, rel=1e-15)


@pytest.mark.parametrize("stated", [None, "gbk"])
def test_bytes_in_gbk_are_read(stated: str | None) -> None:
    value = document()
    value["passes"][0]["name"] = "粗磨"
    data = json.dumps(value, ensure_ascii=False).encode("gbk")
    path = loaded(data, "path.json", replace(NOTHING_STATED, encoding=stated))
    assert path.passes[0].name == "粗磨"


def test_a_table_and_a_document_are_chosen_by_extension() -> None:
    assert_same(loaded(table(), "A.CSV"), loaded(table(), "a.txt"))
    assert len(loaded(as_json(document()), "A.Json", FLOOR)) == 4
