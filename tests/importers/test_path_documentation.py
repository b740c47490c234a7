"""The examples of docs/paths.md are read as they stand there."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from path_examples import loaded

from solver.io.importers import ImportOptions
from solver.io.importers.columns import FIELDS
from solver.model.toolpath import Frame

TEXT = (Path(__file__).parents[2] / "docs" / "paths.md").read_text(encoding="utf-8")


def block(language: str) -> bytes:
    found = re.findall(r"^```(\w*)\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE)
    return next(text for name, text in found if name == language).encode()


def test_the_table_and_the_document_say_the_same() -> None:
    table = loaded(block(""), "groove.csv", ImportOptions())
    document = loaded(block("json"), "groove.json", ImportOptions())
    for path in (table, document):
        assert path.frame is Frame.BEAM
        assert [one.name for one in path.passes] == ["groove"]
    # Normal with travel, quaternion and W P R in turn.
    np.testing.assert_allclose(document.poses, table.poses, atol=1e-15)


def test_every_field_of_a_table_is_documented() -> None:
    for field in FIELDS:
        assert f"`{field}`" in TEXT, field
