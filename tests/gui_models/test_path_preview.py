import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.path_preview import (
    examine,
    guessed_mapping,
    remapped,
    taken_source,
)
from solver.catalog.names import resource_folder
from solver.io.importers import ImportOptions, Source, import_source
from solver.model.toolpath import Frame

FOLDER = resource_folder()
CELL = tomllib.loads((FOLDER / "cells" / "groove_hw300.toml").read_text(encoding="utf-8"))


def look(text, **options):
    data = text if isinstance(text, bytes) else text.encode()
    name = options.pop("name", "path.csv")
    return examine(Source(name, data), CELL, folder=str(FOLDER / "cells"), **options)


def table(header, rows=5, tail="0,1,0"):
    lines = [header] + [f"{10 * n},13,{40 + n},{tail}" for n in range(rows)]
    return "\n".join(line for line in lines if line) + "\n"


def test_a_file_that_is_understood_is_taken_as_it_is():
    data = (FOLDER / "examples" / "groove_hw300.csv").read_bytes()
    preview = look(data)
    assert preview.understood
    assert not preview.askable
    assert len(preview.toolpath) == 50
    assert taken_source(preview).data == data
    assert preview.titles[0] == "x_mm"
    assert len(preview.rows) == 12


def test_titles_that_are_not_understood_are_guessed_and_asked():
    preview = look(table("Pos X [mm],Pos Y [mm],Pos Z [mm],Normal I,Normal J,Normal K"))
    assert not preview.understood
    assert preview.askable
    assert dict(preview.mapping) == {"x": 0, "y": 1, "z": 2, "nx": 3, "ny": 4, "nz": 5}
    assert len(preview.toolpath) == 5


def test_a_table_without_header_offers_its_columns_by_number():
    preview = look(table(""))
    assert not preview.header
    assert preview.titles == ("1", "2", "3", "4", "5", "6")
    assert dict(preview.mapping) == {"x": 0, "y": 1, "z": 2}
    mapping = {"x": 0, "y": 1, "z": 2, "nx": 3, "ny": 4, "nz": 5}
    answered = look(table(""), mapping=mapping, header=False)
    assert len(answered.toolpath) == 5


@pytest.mark.parametrize(
    ("header", "unit"),
    [("Pos X [mm],Pos Y [mm],Pos Z [mm],u,v,w2", 1.0), ("A (m),B (m),C (m),u,v,w2", 1000.0)],
)
def test_a_mapped_table_is_the_path_that_the_importer_reads_with_the_mapping(header, unit):
    source = Source("path.csv", ("# frame: beam\n" + table(header)).encode())
    mapping = {"x": 0, "y": 1, "z": 2, "nx": 3, "ny": 4, "nz": 5}
    titles = header.split(",")
    columns = {name: titles[column] for name, column in mapping.items()}
    if unit > 1.0:
        source = Source("path.csv", source.data.replace(b"13", b"0.013").replace(b"40", b"0.04"))
    expected = import_source(source, ImportOptions(columns=columns))
    found = import_source(Source("path.csv", remapped(source, mapping, True)))
    assert found.frame is Frame.BEAM
    np.testing.assert_array_equal(found.poses, expected.poses)


names = st.text(st.characters(codec="utf-8", exclude_categories=("Cc", "Cs")), max_size=8)


@settings(max_examples=40)
@given(st.lists(st.tuples(names, names), min_size=2, max_size=5), st.sampled_from(",;\t"))
def test_cells_come_through_a_mapping_as_they_are(words, delimiter):
    def cell(text):
        return '"' + text.replace('"', '""') + '"'

    lines = [delimiter.join(["a", "b", "c", "nimi", "other"])]
    for number, (one, other) in enumerate(words):
        lines.append(delimiter.join([f"{number}", "0", "1", cell(one), cell(other)]))
    source = Source("path.csv", "\n".join(lines).encode())
    mapping = {"x": 0, "y": 1, "z": 2, "pass": 3, "events": 4}
    data = remapped(source, mapping, True)
    rows = examine(Source("path.csv", data), CELL, folder=str(FOLDER / "cells")).rows
    blanks = " \t"
    assert [row[3:] for row in rows] == [
        (one.strip(blanks), other.strip(blanks)) for one, other in words
    ]


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("cut.csv", b"x,y,z\n1,2\n"),
        ("words.csv", b"x,y,z,w,p,r\n1,2,three,0,0,0\n2,2,3,0,0,0\n"),
        ("binary.csv", b"\x00\x01\x02"),
        ("wide.csv", "x,y,z\n".encode("utf-16")),
        ("empty.csv", b""),
        ("cut.json", b'{"format": "posopt-toolpath", '),
        ("no.ls", b"/PROG  X\n/MN\n 1: JMP LBL[1];\n"),
        ("path.step", b"ISO-10303-21;"),
    ],
)
def test_a_malformed_file_ends_with_the_sentence_of_the_importer(name, data):
    preview = look(data, name=name)
    assert preview.toolpath is None
    sentence = error_words(preview.error, str.format)
    assert sentence
    assert "\n" not in sentence
    assert name in sentence or preview.error.place is not None
    assert not preview.askable


def test_a_missing_frame_is_asked_and_the_answer_suffices():
    text = table("x,y,z,nx,ny,nz")
    path = {"touches": "web", "file": "path.csv"}
    preview = look(text, path=path)
    assert preview.understood
    assert preview.askable
    assert "frame" in preview.error.message
    assert len(look(text, path={**path, "frame": "beam"}).toolpath) == 5


def test_a_missing_orientation_is_asked_and_the_answer_suffices():
    text = "x,y,z\n0,13,40\n10,13,41\n20,13,42\n"
    preview = look(text)
    assert preview.askable
    path = {"file": "path.csv", "frame": "beam", "orientation_wpr_deg": [0.0, 60.0, -90.0]}
    assert len(look(text, path=path).toolpath) == 3


@pytest.mark.parametrize(
    ("titles", "expected"),
    [
        (("X", "Y", "Z"), {"x": 0, "y": 1, "z": 2}),
        (("i", "j", "k", "x_mm"), {"nx": 0, "ny": 1, "nz": 2, "x": 3}),
        (("i", "j", "x"), {"x": 2}),
        (("w", "p", "r", "nx", "ny", "nz"), {"w": 0, "p": 1, "r": 2}),
        (("tangent x", "tangent y", "tangent z", "x"), {"x": 3}),
        (("x", "x"), {"x": 0}),
        (("roll", "pitch", "yaw"), {"w": 0, "p": 1, "r": 2}),
        (("hour", "minute"), {}),
    ],
)
def test_guesses_hold_whole_groups_and_one_orientation(titles, expected):
    assert guessed_mapping(titles) == expected
