"""Every malformed robot, tool, series or cell ends in one sentence with its file and key."""

import datetime
import re
from pathlib import Path

import pytest
from catalog_mutations import at, changed, document, key_text, leaves, refusal, shipped

from solver.catalog import load_beam, load_cell, load_robot, load_tool
from solver.catalog.beams import read_series
from solver.catalog.toml_reader import MAXIMUM_BYTES, read_toml
from solver.errors import InputError

KINDS = {
    "robot": ("robots", "fanuc_m20ia", load_robot),
    "tool": ("tools", "die_grinder", load_tool),
    "series": ("beams", "hw", read_series),
    "paper cell": ("cells", "groove_paper", load_cell),
    "full cell": ("cells", "groove_hw300", load_cell),
}

# Keys that may be left out because they have a default.
OPTIONAL = re.compile(
    r"assumptions|sources\..*|inflation\..*|.*\.group|.*wpr_deg|.*margin_mm|.*depth_mm|.*\.role"
    r"|.*later_root_mm|.*root_mm|cell\.floor|beam\.(fillets|frame)|path\.(feed_mm_s|touches)"
    r"|path\.line\.name|path\.(frame|orientation_wpr_deg|orientation_frame)|settings\..*|program\..*"
    r"|limits\.acceleration_deg_s2"
)


def is_number(value):
    return isinstance(value, int | float) and not isinstance(value, bool)


def wrong_values(value):
    """Values that are wrong wherever a file has this one."""
    yield {}
    yield datetime.date(2026, 1, 1)
    if isinstance(value, list):
        yield 7
        if value and is_number(value[0]):
            yield [*value[:-1], "x"]
            yield [*value[:-1], float("nan")]
            yield [True, *value[1:]]
            yield [value]
        return
    if isinstance(value, str):
        yield 7
        yield "two\nlines"
        return
    yield "ten"
    yield []
    if is_number(value):
        yield from (float("nan"), float("-inf"), True, 1e12, 10**400, -(10**30))


@pytest.mark.parametrize("kind", KINDS)
def test_a_wrong_value_is_refused_at_its_key(kind, tmp_path):
    folder, name, load = KINDS[kind]
    tree = shipped(folder, name)
    file = tmp_path / "mutant.toml"
    count = 0
    for number, path in enumerate(leaves(tree)):
        values = list(wrong_values(at(tree, path)))
        # Two of the values at each key; all of them meet every kind of key many times.
        for value in {number % len(values): None, (number * 3 + 1) % len(values): None}:
            file.write_text(document(changed(tree, path, values[value])), encoding="utf-8")
            error = refusal(load, file)
            assert error.place.key.startswith(key_text(path)), (path, values[value], str(error))
            count += 1
    assert count >= 40


@pytest.mark.parametrize("kind", KINDS)
def test_a_missing_key_is_named_unless_it_has_a_default(kind, tmp_path):
    folder, name, load = KINDS[kind]
    tree = shipped(folder, name)
    file = tmp_path / "mutant.toml"
    required = [path for path in leaves(tree) if not OPTIONAL.fullmatch(key_text(path))]
    for path in required:
        file.write_text(document(changed(tree, path, None)), encoding="utf-8")
        error = refusal(load, file)
        parent = key_text(path[:-1])
        assert error.place.key.startswith((key_text(path), parent)), (path, str(error))
    assert len(required) >= 8


@pytest.mark.parametrize("kind", KINDS)
def test_a_misspelt_key_is_refused_with_the_right_one(kind, tmp_path):
    folder, name, load = KINDS[kind]
    tree = shipped(folder, name)
    file = tmp_path / "mutant.toml"
    for path in leaves(tree):
        if path[0] == "sources" or not isinstance(path[-1], str):
            continue
        misspelt = f"{path[-1]}x"
        mutant = changed(tree, path, None)
        at(mutant, path[:-1])[misspelt] = at(tree, path)
        file.write_text(document(mutant), encoding="utf-8")
        error = refusal(load, file)
        parent = key_text(path[:-1])
        assert error.place.key.startswith(parent), (path, str(error))
        if not OPTIONAL.fullmatch(key_text(path)) and path[0] != "beam":
            assert misspelt in str(error), (path, str(error))
            assert path[-1] in str(error), (path, str(error))


@pytest.mark.parametrize("kind", KINDS)
def test_a_table_that_is_a_number_or_a_list_is_refused(kind, tmp_path):
    folder, name, load = KINDS[kind]
    tree = shipped(folder, name)
    file = tmp_path / "mutant.toml"
    for key in tree:
        for value in (3, [[[]]], "text"):
            file.write_text(document({**tree, key: value}), encoding="utf-8")
            assert refusal(load, file).place.key.startswith(key)


@pytest.mark.parametrize("kind", KINDS)
def test_a_truncated_file_is_refused(kind, tmp_path):
    folder, name, load = KINDS[kind]
    text = document(shipped(folder, name))
    file = tmp_path / "truncated.toml"
    for share in range(25):
        file.write_text(text[: len(text) * share // 25], encoding="utf-8")
        error = refusal(load, file)
        assert error.place.line is not None or error.place.key is not None


NOT_TOML = {
    "empty assignment": b"[robot]\nname = \n",
    "unclosed text": b'[robot]\nname = "x\n',
    "unclosed list": b"a = [1, 2\n",
    "key twice": b"a = 1\na = 2\n",
    "table twice": b"[a]\n[a]\n",
    "bare words": b"this is no toml\n",
    "JSON": b'{"robot": {"name": "x"}}',
    "XML": b"<robot/>",
    "INI comment": b"; comment\n[robot]\n",
    "full-width digit": "a = １\n".encode(),
    "double underscore": b"a = 1__0\n",
    "control character": b'a = "\x01"\n',
    "bad escape": b'a = "\\q"\n',
    "surrogate escape": b'a = "\\ud800"\n',
    "bad date": b"a = 2026-13-40\n",
    "lone carriage return": b"a = 1\rb = 2\r",
}


@pytest.mark.parametrize("content", NOT_TOML.values(), ids=NOT_TOML)
def test_what_is_not_toml_is_refused_with_line_and_column(content, tmp_path):
    file = tmp_path / "bad.toml"
    file.write_bytes(content)
    place = refusal(load_robot, file).place
    assert place.line >= 1
    assert place.column >= 1


def test_a_syntax_error_is_located_where_it_is(tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text("[robot]\nname = 'x'\ntitle = = 'y'\n", encoding="utf-8")
    place = refusal(load_robot, file).place
    assert (place.line, place.column) == (3, 9)


UNREADABLE = {
    "zip": b"PK\x03\x04\x14\x00\x00\x00" * 20,
    "png": b"\x89PNG\r\n\x1a\n\x00\x00",
    "utf-16": "name = 'x'".encode("utf-16"),
    "latin-1": "# Müller\n".encode("latin-1"),
    "gbk": "# 机器人\n".encode("gbk"),
    "deep lists": b"a = " + b"[" * 100_000,
    "deep tables": b"a = " + b"{b = " * 20_000,
    "many digits": b"a = " + b"9" * 10_000,
    "dotted key": b"a" + b".a" * 200_000 + b" = 1",
    "dotted table": b"[" + b"a ." * 200_000 + b"a]",
    "dotted inline": b"a = {" + b"'a'." * 200_000 + b"a = 1}",
    "many keys": b"".join(b"k%d = 1\n" % i for i in range(20_000)),
    "too large": b"#" + b" " * MAXIMUM_BYTES,
}


@pytest.mark.parametrize("content", UNREADABLE.values(), ids=UNREADABLE)
def test_what_is_no_text_or_beyond_every_bound_is_refused(content, tmp_path):
    file = tmp_path / "bad.toml"
    file.write_bytes(content)
    for load in (load_robot, load_tool, load_cell, load_beam):
        refusal(load, file)


def test_a_file_that_is_not_there_or_a_folder_is_refused(tmp_path):
    assert "does not exist" in str(refusal(load_cell, tmp_path / "nothing.toml"))
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    assert "is a folder" in str(refusal(load_cell, folder))
    with pytest.raises(InputError, match="cannot be read"):
        load_cell(Path("nul\0character.toml"))
    with pytest.raises(InputError, match="cannot be read"):
        load_cell("n" * 5000 + ".toml")


def test_a_byte_order_mark_and_windows_line_ends_are_read(tmp_path):
    text = document(shipped("tools", "die_grinder")).replace("\n", "\r\n")
    file = tmp_path / "windows.toml"
    file.write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert load_tool(file).name == "die_grinder"


def test_units_are_taken_from_the_key_names(tmp_path):
    file = tmp_path / "units.toml"
    file.write_text("a_mm = 1500\nb_deg = 180\nc_deg_s = 90.0\nd_kg = 2\ne_mm_s = 20\n")
    table = read_toml(file)
    read = [table.number(key) for key in ("a_mm", "b_deg", "c_deg_s", "d_kg", "e_mm_s")]
    assert read == pytest.approx([1.5, 3.141592653589793, 1.5707963267948966, 2.0, 0.020])


@pytest.mark.parametrize("length", [100_000.1, -100_000.1, 1e300, 10**40])
def test_lengths_above_a_hundred_metres_are_refused(length, tmp_path):
    file = tmp_path / "long.toml"
    file.write_text(f"a_mm = {length}\n")
    with pytest.raises(InputError, match=r"key a_mm: expected at most 100000 in mm"):
        read_toml(file).number("a_mm")
    file.write_text("a_mm = -100000.0\n")
    assert read_toml(file).number("a_mm") == pytest.approx(-100.0)
