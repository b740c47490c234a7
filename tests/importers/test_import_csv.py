"""Tables of waypoints: every dialect says the same."""

from __future__ import annotations

import codecs
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from path_examples import FLOOR, HEADER, assert_same, changed, fuzz, loaded, table
from scipy.spatial.transform import Rotation

from solver.io.importers import ImportOptions
from solver.model.toolpath import Event, EventKind, Frame, Role
from solver.transforms import rotation_x

CHINESE = dict(
    zip(
        HEADER,
        (
            "X坐标", "Y坐标", "Z坐标", "法向x", "法向y", "法向z", "切向x", "切向y", "切向z",
            "工序", "进给", "接触面", "角色", "事件", "侧倾", "前倾",
        ),
        strict=True,
    )
)  # fmt: skip


def test_a_table_becomes_passes_with_feed_in_metres_a_second_and_angles_in_radians() -> None:
    path = loaded(changed(4, "events", "spindle-on|dwell:0.5|do:3=1|call:CLEAN"))
    assert [one.name for one in path.passes] == ["a", "b"]
    assert [one.feed for one in path.passes] == [0.05, 0.06]
    assert path.frame is Frame.FLOOR
    assert path.source == "path.csv"
    assert path.passes[0].roles == (Role.LEAD_IN, Role.CONTACT)
    assert path.passes[0].touches == "web"
    assert path.passes[0].lead == pytest.approx(np.radians(5.0), abs=1e-15)
    np.testing.assert_allclose(path.poses[:, :3, 3] * 1000.0, [[x, 0, 5] for x in (0, 10, 20, 30)])
    assert dict(path.passes[0].events) == {}
    assert path.passes[1].events[0] == (
        Event(EventKind.SPINDLE_ON),
        Event(EventKind.DWELL, value=0.5),
        Event(EventKind.DIGITAL_OUTPUT, "3", 1.0),
        Event(EventKind.CALL, "CLEAN"),
    )


def test_z_points_into_the_surface_and_y_along_the_travel() -> None:
    rotation = loaded(table()).poses[0, :3, :3]
    np.testing.assert_allclose(rotation[:, 2], [0, 0, -1], atol=1e-15)
    np.testing.assert_allclose(rotation[:, 1], [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(rotation[:, 0], np.cross(rotation[:, 1], rotation[:, 2]), atol=1e-15)


def test_the_other_convention_has_x_along_the_travel() -> None:
    options = replace(FLOOR, convention="normal_travel_x")
    rotation = loaded(table(), options=options).poses[0, :3, :3]
    np.testing.assert_allclose(rotation[:, 2], [0, 0, -1], atol=1e-15)
    np.testing.assert_allclose(rotation[:, 0], [1, 0, 0], atol=1e-15)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


def test_without_travel_columns_the_travel_is_taken_from_the_neighbouring_points() -> None:
    data = b"x,y,z,nx,ny,nz\n0,0,0,0,0,1\n10,0,0,0,0,1\n10,10,0,0,0,1\n"
    y = loaded(data).poses[:, :3, 1]
    np.testing.assert_allclose(y, [[1, 0, 0], [2**-0.5, 2**-0.5, 0], [0, 1, 0]], atol=1e-15)


def test_positions_alone_take_the_stated_orientation() -> None:
    options = ImportOptions(frame=Frame.BEAM, orientation=rotation_x(0.3))
    path = loaded(b"x,y,z\n0,0,0\n1,0,0\n", options=options)
    np.testing.assert_array_equal(path.poses[:, :3, :3], [rotation_x(0.3)] * 2)


@pytest.mark.parametrize(
    ("titles", "factor"),
    [
        (("x", "y", "z"), 1e-3),
        (("X", "Y", "Z"), 1e-3),
        (("x_mm", "y_mm", "z_mm"), 1e-3),
        (("x[mm]", "y [mm]", "z[ mm ]"), 1e-3),
        (("X(mm)", "Y (mm)", "Z（mm）"), 1e-3),
        (("x_m", "y_m", "z_m"), 1.0),
        (("X [m]", "Y [m]", "Z [m]"), 1.0),
        (("坐标x", "坐标y", "坐标z"), 1e-3),
    ],
)
def test_titles_state_the_unit_of_positions(titles: tuple[str, ...], factor: float) -> None:
    path = loaded(table([("1", "2", "3"), ("4", "5", "6")], titles))
    np.testing.assert_array_equal(path.poses[1, :3, 3], np.array([4.0, 5.0, 6.0]) * factor)


def test_comments_above_the_header_state_frame_and_unit() -> None:
    data = b"# frame: fanuc_world\n// unit = m\nx,y,z\n1,2,3\n4,5,6\n"
    path = loaded(data, options=ImportOptions(orientation=np.eye(3)))
    assert path.frame is Frame.FANUC_WORLD
    np.testing.assert_array_equal(path.poses[1, :3, 3], [4, 5, 6])


def test_a_mapping_by_title_ignores_the_other_columns() -> None:
    data = b"id,Pos X [m],Pos Y [m],Height [m],note\n1,1,2,3,first\n2,4,5,6,\n"
    mapping = {"x": "Pos X [m]", "y": "Pos Y [m]", "z": "Height [m]"}
    path = loaded(data, options=replace(FLOOR, columns=mapping))
    np.testing.assert_array_equal(path.poses[1, :3, 3], [4, 5, 6])


def test_a_mapping_by_number_reads_a_table_without_header() -> None:
    data = b"7 ; 1;2;3\n8;4;5;6\n"
    options = replace(FLOOR, columns={"x": 2, "y": 3, "z": 4}, unit="m")
    np.testing.assert_array_equal(
        loaded(data, options=options).poses[:, :3, 3], [[1, 2, 3], [4, 5, 6]]
    )


def test_a_tiny_step_of_import_resamples() -> None:
    path = loaded(table(), options=replace(FLOOR, resample=0.004))
    assert [len(one) for one in path.passes] == [4, 4]


finite = st.floats(-1e4, 1e4).map(lambda value: float(f"{value:.6g}"))
number_form = st.sampled_from(["{!r}", "{:+.9g}", "{:.10e}", "{:.12f}"])


@st.composite
def tables(draw: st.DrawFn) -> tuple[list[dict[str, str]], np.ndarray, np.ndarray]:
    """Rows of a table with distinct points, their positions [mm] and quaternions (w, x, y, z)."""
    count = draw(st.integers(2, 6))
    form = draw(number_form)
    positions, quaternions, rows = [], [], []
    for index in range(count):
        position = [10.0 * index + draw(st.floats(0.0, 5.0)), draw(finite), draw(finite)]
        parts = np.array([draw(st.floats(-1.0, 1.0)) for _ in range(4)])
        parts[0] += 1.5
        quaternion = parts / np.linalg.norm(parts)
        written = [form.format(float(value)) for value in (*position, *quaternion)]
        positions.append([float(text) for text in written[:3]])
        quaternions.append([float(text) for text in written[3:]])
        names = ("x", "y", "z", "qw", "qx", "qy", "qz")
        rows.append(
            dict(zip(names, written, strict=True))
            | {"pass": "粗磨" if 2 * index < count else "finish", "role": draw(roles)}
        )
    return rows, np.array(positions), np.array(quaternions)


roles = st.sampled_from([role.value for role in Role])
dialects = st.fixed_dictionaries(
    {
        "delimiter": st.sampled_from([",", ";", "\t"]),
        "encoding": st.sampled_from(["utf-8", "utf-8-sig", "gbk"]),
        "newline": st.sampled_from(["\n", "\r\n", "\r"]),
        "chinese": st.booleans(),
        "quoted": st.booleans(),
        "comment": st.sampled_from(["", "# 注释", "// x,y,z", "   # 1;2;3"]),
        "blank": st.booleans(),
        "pad": st.sampled_from(["", " "]),
        "last": st.booleans(),
        "order": st.randoms(use_true_random=False),
    }
)


def written(rows: list[dict[str, str]], dialect: dict[str, Any]) -> bytes:
    names = list(rows[0])
    dialect["order"].shuffle(names)
    titles = [CHINESE.get(name, name) if dialect["chinese"] else name for name in names]
    quote = '"' if dialect["quoted"] else ""
    pad = dialect["pad"]
    lines = []
    for cells in [titles, *([row[name] for name in names] for row in rows)]:
        lines.append(dialect["delimiter"].join(f"{pad}{quote}{cell}{quote}{pad}" for cell in cells))
        lines += [dialect["comment"]] if dialect["comment"] else []
        lines += [""] if dialect["blank"] else []
    text = dialect["newline"].join(lines) + (dialect["newline"] if dialect["last"] else "")
    return text.encode(dialect["encoding"])


@given(tables(), dialects)
@settings(max_examples=80, deadline=None)
def test_a_valid_table_gives_the_same_toolpath_in_every_dialect(
    example: tuple[list[dict[str, str]], np.ndarray, np.ndarray], dialect: dict[str, Any]
) -> None:
    rows, positions, quaternions = example
    names = list(rows[0])
    plain = loaded(table([[row[name] for name in names] for row in rows], names))
    path = loaded(written(rows, dialect))
    assert_same(path, plain)
    np.testing.assert_allclose(path.poses[:, :3, 3] * 1000.0, positions, atol=1e-9)
    expected = Rotation.from_quat(np.roll(quaternions, -1, axis=1)).as_matrix()
    np.testing.assert_allclose(path.poses[:, :3, :3], expected, atol=1e-12)
    assert [role.value for one in path.passes for role in one.roles] == [r["role"] for r in rows]
    assert [one.name for one in path.passes] == ["粗磨", "finish"]


@given(st.binary(max_size=300))
@settings(max_examples=80, deadline=None)
def test_arbitrary_bytes_end_with_a_sentence(data: bytes) -> None:
    fuzz(data, "path.csv")


@given(st.text(max_size=300))
@settings(max_examples=80, deadline=None)
def test_arbitrary_text_below_a_header_ends_with_a_sentence(text: str) -> None:
    fuzz(b"x,y,z\n0,0,0\n" + text.encode("utf-8", "surrogatepass"), "path.csv")


@given(st.integers(0, len(table())), st.integers(0, 20), st.binary(max_size=8))
@settings(max_examples=120, deadline=None)
def test_a_damaged_table_ends_with_a_sentence(start: int, length: int, damage: bytes) -> None:
    data = table()
    fuzz(data[:start] + damage + data[start + length :], "path.csv")


def test_a_byte_order_mark_does_not_shift_columns() -> None:
    assert_same(loaded(codecs.BOM_UTF8 + table()), loaded(table()))


def test_a_stated_encoding_is_used() -> None:
    data = "x,y,z,pass\n0,0,0,粗磨\n1,0,0,粗磨\n".encode("gb18030")
    for encoding in ("gbk", "gb18030"):
        path = loaded(data, options=replace(FLOOR, encoding=encoding))
        assert path.passes[0].name == "粗磨"


def test_an_orientation_of_the_file_goes_before_the_stated_one() -> None:
    stated = replace(FLOOR, orientation=rotation_x(1.0))
    assert_same(loaded(table(), options=stated), loaded(table()))
