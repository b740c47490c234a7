"""Path files and checks that the tests of the importers share."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from solver.errors import InputError
from solver.io.importers import ImportOptions, Source, import_source
from solver.model.toolpath import Frame, Toolpath

FLOOR = ImportOptions(frame=Frame.FLOOR, orientation=np.eye(3))

HEADER = (
    "x", "y", "z", "nx", "ny", "nz", "tx", "ty", "tz",
    "pass", "feed", "touches", "role", "events", "lean", "lead",
)  # fmt: skip

ROWS = (
    ("0", "0", "5", "0", "0", "1", "1", "0", "0", "a", "50", "web", "lead-in", "", "0", "5"),
    ("10", "0", "5", "0", "0", "1", "1", "0", "0", "a", "50", "web", "contact", "", "0", "5"),
    ("20", "0", "5", "0", "0", "1", "1", "0", "0", "b", "60", "web", "contact", "", "0", "5"),
    ("30", "0", "5", "0", "0", "1", "1", "0", "0", "b", "60", "web", "contact", "", "0", "5"),
)


def table(rows: Any = ROWS, header: Any = HEADER, delimiter: str = ",") -> bytes:
    lines = [delimiter.join(cells) for cells in (header, *rows)]
    return ("\n".join(lines) + "\n").encode()


def changed(line: int, field: str, text: str) -> bytes:
    """The example table with one cell replaced, in a file line (the header is line 1)."""
    rows = [list(row) for row in ROWS]
    rows[line - 2][HEADER.index(field)] = text
    return table(rows)


def document() -> dict[str, Any]:
    waypoints = [
        {"position": [10.0 * index, 0.0, 5.0], "normal": [0.0, 0.0, 1.0], "travel": [1.0, 0.0, 0.0]}
        for index in range(4)
    ]
    return {
        "format": "posopt-toolpath",
        "version": 1,
        "frame": "floor",
        "unit": "mm",
        "passes": [
            {"name": "a", "feed_mm_s": 50, "touches": "web", "waypoints": waypoints[:2]},
            {"name": "b", "feed_mm_s": 60, "lean_deg": 5, "waypoints": waypoints[2:]},
        ],
    }


def loaded(data: bytes, file: str = "path.csv", options: ImportOptions = FLOOR) -> Toolpath:
    return import_source(Source(file, data), options)


def refused(data: bytes, file: str = "path.csv", options: ImportOptions = FLOOR) -> InputError:
    """The error of a file that must be refused, checked to be one sentence that says enough."""
    with pytest.raises(InputError) as caught:
        loaded(data, file, options)
    error = caught.value
    assert str(error).startswith(file)
    assert "\n" not in str(error)
    assert len(str(error)) < 500
    assert "expected" in error.message
    assert error.place is not None
    return error


def assert_same(one: Toolpath, other: Toolpath) -> None:
    assert one.frame is other.frame
    assert len(one.passes) == len(other.passes)
    for first, second in zip(one.passes, other.passes, strict=True):
        np.testing.assert_array_equal(first.poses, second.poses)
        for field in ("roles", "feed", "lean", "lead", "touches", "name"):
            assert getattr(first, field) == getattr(second, field), field
        assert dict(first.events) == dict(second.events)


def as_json(value: Any) -> bytes:
    return json.dumps(value, indent=1).encode()


def fuzz(data: bytes, file: str, options: ImportOptions = FLOOR) -> None:
    """Whatever the bytes are: a toolpath of finite poses, or an InputError of one sentence."""
    try:
        poses = loaded(data, file, options).poses
    except InputError:
        refused(data, file, options)
    else:
        assert np.isfinite(poses).all()
