"""What is no readable path file is refused by one sentence, before anything is read into memory."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from path_examples import FLOOR, assert_same, loaded, table

from solver.errors import InputError
from solver.io.importers import load_toolpath
from solver.io.importers.source import MAX_BYTES


def sentence(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        load_toolpath(path, FLOOR)
    error = caught.value
    assert error.place is not None
    assert error.place.file == str(path)
    assert "\n" not in str(error)
    assert "expected" in error.message
    return error.message


def test_a_file_is_read_like_its_bytes(tmp_path: Path) -> None:
    path = tmp_path / "path.csv"
    path.write_bytes(table())
    assert_same(load_toolpath(path, FLOOR), loaded(table()))
    assert load_toolpath(str(path), FLOOR).source == "path.csv"


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    assert "no such file" in sentence(tmp_path / "path.csv")
    assert "no such file" in sentence(tmp_path / "nowhere" / "path.json")


def test_a_directory_is_refused(tmp_path: Path) -> None:
    (tmp_path / "path.csv").mkdir()
    assert "directory" in sentence(tmp_path / "path.csv")


@pytest.mark.parametrize("name", ["path", "path.xlsx", ".csv", "path.csv.bak", "path.LSX"])
def test_an_unknown_extension_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(table())
    assert ".csv" in sentence(tmp_path / name)


def test_a_file_above_the_limit_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "path.csv"
    with path.open("wb") as file:
        file.truncate(MAX_BYTES + 1)
    assert f"{MAX_BYTES:,}" in sentence(path)


def test_names_that_no_system_allows_are_refused(tmp_path: Path) -> None:
    assert "cannot be read" in sentence(tmp_path / "a\0b.csv")
    assert "expected" in sentence(tmp_path / f"{'a' * 5000}.csv")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such files")
def test_a_pipe_is_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "path.csv")
    assert "no regular file" in sentence(tmp_path / "path.csv")
