"""Files, commands and keys of the documentation: what a page shows loads, runs and exists."""

import dataclasses
import itertools
import re
import shlex
import tomllib
from enum import Enum
from pathlib import Path

import numpy as np
import pytest
import trimesh

from solver.catalog import list_names, load_beam, load_cell, load_robot, load_tool
from solver.catalog.cell_program import read_program
from solver.catalog.cell_settings import read_settings
from solver.catalog.toml_reader import Table
from solver.cli.main import main
from solver.model.settings import Sweep

DOCS = Path(__file__).parents[1] / "docs"
BLOCK = re.compile(r"^( *)```(\w+)\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"# ([\w.]+\.(?:toml|csv))\n")
CHANGE = re.compile(r"# in ([\w.]+\.toml)(?:, as ([\w.]+\.toml))?\n")
EXIT_CODE = re.compile(r"# exit code (\d+)$")
STAMP = re.compile(r"\b[0-9a-f]{12}\b")
TOP = re.compile(r"^\[+([\w]+)", re.MULTILINE)


def blocks(page, *languages):
    found = BLOCK.findall((DOCS / page).read_text("utf-8"))
    return [
        (language, re.sub(rf"^{indent}", "", text, flags=re.MULTILINE))
        for indent, language, text in found
        if language in languages
    ]


def pages_with(*languages):
    return sorted(page.name for page in DOCS.glob("*.md") if blocks(page.name, *languages))


def changed(base, fragment):
    """The text of a TOML file with the top-level tables of a fragment in place of its own."""
    starts = [*(found.start() for found in TOP.finditer(base)), len(base)]
    pieces = [base[: starts[0]]]
    pieces += [base[a:b] for a, b in itertools.pairwise(starts)]
    replaced = set(TOP.findall(fragment))
    kept = [piece for piece in pieces if not set(TOP.findall(piece)) & replaced]
    return "".join(kept) + fragment


def write_files(page, folder):
    """Write every file that a page shows; returns the TOML files in the page's order."""
    trimesh.creation.box((60.0, 40.0, 80.0)).export(folder / "clamp.stl")
    trimesh.creation.box((400.0, 120.0, 20.0)).export(folder / "part.stl")
    written = []
    for number, (_, shown) in enumerate(blocks(page, "toml", "csv")):
        if change := CHANGE.match(shown):
            name = change[2] or f"variant_{number}.toml"
            text = changed((folder / change[1]).read_text("utf-8"), shown)
        else:
            name, text = FILE.match(shown)[1], shown
        (folder / name).write_text(text, encoding="utf-8")
        written.append(folder / name)
    return [path for path in written if path.suffix == ".toml"]


def load(path):
    """Load a TOML file as what its tables make of it."""
    tables = tomllib.loads(path.read_text("utf-8"))
    kinds = {"cell": load_cell, "dh": load_robot, "tool": load_tool, "sections": load_beam}
    kind = next(key for key in kinds if key in tables)
    return kinds[kind](path)


@pytest.mark.parametrize("page", pages_with("toml"))
def test_every_toml_file_of_a_page_loads(page, tmp_path):
    for path in write_files(page, tmp_path):
        assert load(path) is not None


def commands(page):
    """(arguments, exit code, lines that the page shows) of every posopt line of a page."""
    found = []
    for language, text in blocks(page, "bash", "text"):
        if language == "text":
            shown = [line.rstrip() for line in text.splitlines() if line.strip()]
            found[-1][2].extend(shown)
            continue
        for line in text.splitlines():
            code = EXIT_CODE.search(line)
            words = shlex.split(line, comments=True)
            if words and words[0] == "posopt":
                found.append((words[1:], int(code[1]) if code else 0, []))
    return found


def unstamped(text):
    """A text without the digits of digests and hashes, which any change of a cell changes."""
    return STAMP.sub("#" * 12, text)


def excerpts(page):
    """The parts of robot programs that a page shows; a tab stands there as an arrow."""
    return [unstamped(text.replace("→", "\t")) for _, text in blocks(page, "ls")]


def written_programs(folder):
    for path in sorted(folder.glob("*.LS")):
        yield unstamped(path.read_bytes().decode("ascii").replace("\r\n", "\n"))


@pytest.mark.parametrize("page", ["quickstart.md", "extending.md", "robot_program.md"])
def test_the_commands_of_a_page_give_what_it_shows(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_files(page, tmp_path)
    assert commands(page)
    for arguments, code, shown in commands(page):
        assert main(arguments) == code, f"posopt {shlex.join(arguments)}: {capsys.readouterr().err}"
        output = capsys.readouterr()
        printed = [unstamped(line.rstrip()) for line in (output.out + output.err).splitlines()]
        missing = [line for line in shown if unstamped(line) not in printed]
        assert not missing, f"posopt {shlex.join(arguments)} no longer prints this"
    for excerpt in excerpts(page):
        assert any(excerpt in program for program in written_programs(tmp_path)), excerpt


KINDS = {"cells": "cell", "robots": "robot", "tools": "tool", "beams": "beam"}
ANY_KEY = {"sources"}
HEADINGS = {
    "[cell]": ("cell", "cell"),
    "[robot]": ("cell", "robot"),
    "[robot.windows_deg]": ("cell", "robot.windows_deg"),
    "[tool]": ("cell", "tool"),
    "[beam]": ("cell", "beam"),
    "[workpiece]": ("cell", "workpiece"),
    "[[fixtures]]": ("cell", "fixtures"),
    "[path]": ("cell", "path"),
    "[path.line]": ("cell", "path.line"),
    "[path.parametric]": ("cell", "path.parametric"),
    "[settings]": ("cell", "settings"),
    "[settings.weights]": ("cell", "settings.weights"),
    "[settings.steps]": ("cell", "settings.steps"),
    "[program]": ("cell", "program"),
    "[program.links]": ("cell", "program.links"),
    "[accuracy]": ("cell", "accuracy"),
    "[robot] of a robot": ("robot", "robot"),
    "At the head of a robot file": ("robot", ""),
    "[dh]": ("robot", "dh"),
    "[flange]": ("robot", "flange"),
    "[pendant]": ("robot", "pendant"),
    "[limits]": ("robot", "limits"),
    "[cost]": ("robot", "cost"),
    "[bodies]": ("robot", "bodies"),
    "Bodies of a set": ("robot", "bodies.SET"),
    "[inflation]": ("robot", "inflation"),
    "[tool] of a tool": ("tool", "tool"),
    "bodies of a tool": ("tool", "bodies"),
    "Shapes": ("shape", ""),
    "[series]": ("beam", "series"),
    "sections": ("beam", "sections"),
}
SHAPED = {("cell", "fixtures"), ("robot", "bodies.SET"), ("tool", "bodies")}


def documented_rows():
    """(table, keys, default) of every row of the tables of docs/cells.md."""
    heading, rows = None, []
    for line in (DOCS / "cells.md").read_text("utf-8").splitlines():
        if line.startswith("#"):
            heading = line.lstrip("# ").replace("`", "")
        elif line.startswith("| `"):
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            rows.append((HEADINGS[heading], re.findall(r"`(\w+)`", cells[0]), cells[1]))
    return rows


def documented_keys():
    found = {}
    for table, keys, _ in documented_rows():
        found.setdefault(table, set()).update(keys)
    return found


def asked_keys(folder, monkeypatch):
    """What the readers ask for in all shipped files and in those that the pages show."""
    asked = {}
    plain_has, kind_of = Table.has, {}

    def has(table, key):
        kind = kind_of.get(table.file) or KINDS[Path(table.file).parent.name]
        path = re.sub(r"\[\d+\]", "", table.key)
        if kind == "robot" and path.startswith("bodies."):
            path = "bodies.SET"
        inner = "[" in key or re.fullmatch(r"J\d_deg", key)
        if not inner and path not in ANY_KEY:
            asked.setdefault((kind, path), set()).add(key)
        return plain_has(table, key)

    monkeypatch.setattr(Table, "has", has)
    for page in ("cells.md", "extending.md"):
        (folder / page).mkdir()
        for path in write_files(page, folder / page):
            tables = tomllib.loads(path.read_text("utf-8"))
            kinds = {"cell": "cell", "dh": "robot", "tool": "tool", "sections": "beam"}
            kind_of[str(path)] = next(kinds[key] for key in kinds if key in tables)
            load(path)
    for name in list_names("cells"):
        load_cell(name)
    return asked


def test_documented_keys_are_those_that_the_readers_know(tmp_path, monkeypatch):
    documented, asked = documented_keys(), asked_keys(tmp_path, monkeypatch)
    shapes = documented.pop(("shape", ""))
    assert shapes <= set().union(*(asked[table] for table in SHAPED))
    for table in SHAPED:
        # Each owner has shapes of some kinds only, in the files that are shown or shipped.
        asked[table] -= shapes
        documented[table] -= shapes
    sets = asked["robot", "bodies"]
    asked["robot", "bodies"] = {"SET"}
    assert asked["robot", "inflation"] == {f"{name}_mm" for name in sets}
    asked["robot", "inflation"] = {"SET_mm"}
    for kind in ("cell", "robot", "tool", "beam"):
        head = asked.pop((kind, "")) - documented.pop((kind, ""), set())
        tables = {path.split(".")[0] for one, path in documented if one == kind}
        assert head == tables | {"assumptions", "sources"}
    assert asked == documented


def settings_of(text, read):
    return plain(read(Table(tomllib.loads(text), "defaults.toml")))


def plain(value):
    """A setting as nested plain values; sweeps as their angles."""
    if isinstance(value, Sweep):
        return value.angles().tolist()
    if dataclasses.is_dataclass(value):
        return {one.name: plain(getattr(value, one.name)) for one in dataclasses.fields(value)}
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.value if isinstance(value, Enum) else value


def stated_defaults(table):
    """The documented defaults of a table as TOML lines; defaults in words are left out."""
    lines = []
    for where, keys, default in documented_rows():
        value = re.fullmatch(r"`(.*)`", default)
        if where == ("cell", table) and value:
            lines += [f"{key} = {value[1]}" for key in keys]
    return "\n".join(lines)


def test_documented_defaults_of_settings_are_those_of_the_reader():
    stated = stated_defaults("settings")
    for table in ("weights", "steps"):
        stated += f"\n[{table}]\n{stated_defaults(f'settings.{table}')}"
    assert stated.count("=") > 15
    assert settings_of(stated, read_settings) == settings_of("", read_settings)


def test_documented_defaults_of_the_program_are_those_of_the_reader():
    stated = stated_defaults("program")
    assert stated.count("=") == 17
    assert settings_of(stated, read_program) == plain(read_program(None))


def test_documented_defaults_of_links_are_those_of_the_reader():
    stated = stated_defaults("program.links")
    assert stated.count("=") == 10
    without = settings_of("[links]", read_program)
    assert settings_of(f"[links]\n{stated}", read_program) == without
    assert without["links"] is not None
