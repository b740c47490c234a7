"""A study as files: tables, figures and the page, on the paper's cell and on another."""

import ast
import csv
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest
from study_cells import LEANS, POINTS, SAFETY, SEED, other_cell, quick_study

import solver.study
from solver.cli.main import main
from solver.errors import InputError, UnknownNameError
from solver.study import output
from solver.study.context import Study
from solver.study.output import plain, write_report
from solver.study.published import load_study, study_names
from solver.study.report import EXPERIMENTS, run_experiment, run_study

REPOSITORY = Path(__file__).parents[2]
SCHEMA = json.loads((REPOSITORY / "docs" / "schemas" / "study.schema.json").read_text("utf-8"))


@pytest.fixture(scope="module")
def cell(tmp_path_factory):
    return other_cell(tmp_path_factory.mktemp("cell"))


@pytest.fixture(scope="module")
def report(cell):
    return run_study(quick_study(cell))


@pytest.fixture(scope="module")
def folder(report, tmp_path_factory):
    pytest.importorskip("matplotlib")
    target = tmp_path_factory.mktemp("study") / "made" / "here"
    write_report(report, target)
    return target


def without_times(document):
    for section in document["sections"]:
        for table in section["tables"]:
            kept = [not column["timing"] for column in table["columns"]]
            table["rows"] = [
                [value for value, keep in zip(row, kept, strict=True) if keep]
                for row in table["rows"]
            ]
    return plain(document)


def test_another_cell_goes_through_every_experiment(report):
    assert [one.key for one in report.sections] == list(EXPERIMENTS)
    for one in report.sections:
        # What cannot be made says why, what can has sentences.
        assert one.reason or one.text
    done = {one.key for one in report.sections if not one.reason}
    assert {"schemes", "beams", "joints", "heuristic", "refined", "beating", "front"} <= done


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param({POINTS: "points = 2"}, id="two waypoints"),
        pytest.param(
            {POINTS: "points = 6", LEANS: "lean_deg = [25.0, 25.0, 1.0]"}, id="a fixed lean"
        ),
        pytest.param(
            {POINTS: "points = 6", SAFETY: "safety_distance_mm = 500.0"},
            id="a safety distance that nothing keeps",
        ),
        pytest.param(
            {
                POINTS: "points = 6",
                LEANS: "lean_deg = [-25.0, 25.0, 5.0]",
                SEED: "seed = 1\nlead_deg = [-5.0, 5.0, 5.0]",
            },
            id="two angles",
        ),
    ],
)
def test_odd_cells_go_through_too(changes, tmp_path):
    found = run_study(quick_study(other_cell(tmp_path, changes)))
    write_report(found, tmp_path / "out", figures=False)
    refused = {one.key for one in found.sections if one.reason}
    assert refused <= {"lean_step"}
    costs = found.section("refined").table("refined").column("joint cost")
    assert all(after <= before + 1e-12 for before, after in pairwise(costs))


def test_published_values_stay_with_their_own_cell(report):
    table = report.section("schemes").table("schemes")
    assert set(table.column("published expanded")) == {None}
    assert "not the paper's cell" in report.introduction[0]


def test_every_experiment_says_what_its_title_promises(report):
    for one in report.sections:
        assert one.title == EXPERIMENTS[one.key][0]


def test_two_runs_give_the_same_tables_apart_from_times(report, cell):
    again = run_study(quick_study(cell))
    assert without_times(again.document()) == without_times(report.document())


def test_the_document_fits_its_schema(report, folder):
    found = json.loads((folder / "study.json").read_text("utf-8"))
    jsonschema.validate(found, SCHEMA)
    assert found == plain(report.document())


def test_tables_are_written_as_csv_with_all_their_rows(report, folder):
    tables = [table for section in report.sections for table in section.tables]
    assert len({one.key for one in tables}) == len(tables)
    for table in tables:
        with (folder / "tables" / f"{table.key}.csv").open(encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        assert rows[0] == [one.head for one in table.columns]
        assert len(rows) == 1 + len(table.rows)


def test_figures_are_drawn_twice_and_say_what_they_show(report, folder):
    drawings = [one for section in report.sections for one in section.drawings]
    assert len(drawings) >= 9
    for one in drawings:
        root = ElementTree.parse(folder / "figures" / f"{one.key}.svg").getroot()
        assert root.findtext("{http://www.w3.org/2000/svg}title") == one.title
        assert root.findtext("{http://www.w3.org/2000/svg}desc")
        png = (folder / "figures" / f"{one.key}.png").read_bytes()
        assert png.startswith(b"\x89PNG\r\n\x1a\n")


def test_the_same_drawing_gives_the_same_bytes(report, folder, tmp_path):
    write_report(replace(report, sections=(report.section("front"),)), tmp_path)
    for name in ("front.svg", "front.png"):
        assert (tmp_path / "figures" / name).read_bytes() == (
            folder / "figures" / name
        ).read_bytes()


class References(HTMLParser):
    """Collects everything that a page would load, and the tags that it opens."""

    def __init__(self):
        super().__init__()
        self.loaded, self.tags = [], []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.loaded += [value for name, value in attrs if name in {"src", "href", "data"}]


def test_the_page_is_self_contained_and_well_formed(report, folder):
    text = (folder / "index.html").read_text("utf-8")
    ElementTree.fromstring(text)
    found = References()
    found.feed(text)
    assert all(one.startswith(("#", "data:")) for one in found.loaded)
    assert not {"script", "link", "iframe", "object"} & set(found.tags)
    assert "@import" not in text
    assert "url(" not in text.split("</style>")[0]
    assert found.tags.count("img") == sum(len(one.drawings) for one in report.sections)
    assert found.tags.count("caption") == sum(len(one.tables) for one in report.sections)
    text = "".join(ElementTree.fromstring(text).itertext())
    assert all(one in text for one in report.assumptions)


def test_without_the_plotting_library_tables_are_written_and_one_sentence_helps(
    report, tmp_path, monkeypatch
):
    monkeypatch.setattr(output, "can_draw", lambda: False)
    write_report(report, tmp_path)
    assert not (tmp_path / "figures").exists()
    assert list((tmp_path / "tables").glob("*.csv"))
    assert "posopt[study]" in (tmp_path / "index.html").read_text("utf-8")


DRAWING = {"graph_figures.py", "motion_figures.py", "scene_figure.py", "page.py", "rendering.py"}
NAMES = re.compile(r"\b(?:f[12]?|L[12]|J[1-6]|θ[1-6]|utf-8)\b")


def sentences(module):
    """Pieces of text of a module, without docstrings and format specifications."""
    tree = ast.parse(module.read_text("utf-8"))
    left_out = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            left_out.add(id(node.value))
        if isinstance(node, ast.FormattedValue) and node.format_spec is not None:
            left_out |= {id(one) for one in ast.walk(node.format_spec)}
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Constant)
            and isinstance(node.value, str)
            and id(node) not in left_out
        ):
            yield node.value


def test_no_sentence_of_the_study_holds_a_number():
    folder = Path(solver.study.__file__).parent
    found = [
        f"{module.name}: {text}"
        for module in sorted(folder.glob("*.py"))
        if module.name not in DRAWING
        for text in sentences(module)
        if " " in text and re.search(r"\d", NAMES.sub("", text))
    ]
    assert found == []


def test_the_shipped_study_is_read_completely():
    assert study_names() == ("paper",)
    data = load_study("paper")
    assert data.published.beam_names == (
        "HW125", "HW150", "HW175", "HW200", "HW250", "HW350", "HW300",
    )  # fmt: skip
    assert data.published.variation == pytest.approx({"J4": -0.925, "J6": -0.791})
    with pytest.raises(UnknownNameError, match="paper"):
        load_study("papers")


def test_an_experiment_that_fails_is_a_section_that_says_why(cell, monkeypatch):
    def refuse(study):
        raise InputError("the bodies are missing.")

    table = dict(EXPERIMENTS) | {"bodies": ("Bodies", refuse)}
    monkeypatch.setattr("solver.study.report.EXPERIMENTS", table)
    section = run_experiment(quick_study(cell), "bodies")
    assert section.reason == "the bodies are missing"
    assert not section.document()["applies"]


def run(capsys, *arguments):
    code = main([str(one) for one in arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_the_command_runs_single_experiments_and_writes_them(tmp_path, capsys):
    code, out, _ = run(
        capsys, "study", "paper", "--only", "constant", "--no-figures", "--out", tmp_path / "s"
    )
    assert code == 0
    assert "Constant lean" in out
    names = sorted(one.name for one in (tmp_path / "s").rglob("*") if one.is_file())
    assert names == ["constant.csv", "index.html", "study.json"]


def test_the_command_prints_a_document(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, _ = run(capsys, "study", "paper", "--only", "penalty", "--no-figures", "--json")
    assert code == 0
    jsonschema.validate(json.loads(out), SCHEMA)
    assert (tmp_path / "study_paper" / "index.html").is_file()


@pytest.mark.parametrize(
    "arguments",
    [
        ("no_such_study",),
        ("paper", "--cell", "no_such_cell"),
        ("paper", "--only", "nothing"),
        ("paper", "--out", "taken.txt"),
    ],
    ids=" ".join,
)
def test_bad_input_is_one_sentence_and_exit_2(tmp_path, capsys, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken.txt").write_text("kept", "utf-8")
    code, out, err = run(capsys, "study", *arguments)
    assert code == 2
    assert len(err.strip().splitlines()) == 1
    assert "Traceback" not in out + err
    assert [one.name for one in tmp_path.iterdir()] == ["taken.txt"]


@pytest.mark.long
def test_two_full_studies_of_the_paper_give_the_same_tables(tmp_path):
    documents = [without_times(run_study(Study(load_study("paper"))).document()) for _ in range(2)]
    assert documents[0] == documents[1]
    assert all(one["applies"] for one in documents[0]["sections"])


@pytest.mark.long
@pytest.mark.parametrize("name", ["groove_hw300", "zigzag_hw250"])
def test_the_shipped_cells_go_through_the_full_study(name, tmp_path):
    report = run_study(Study(load_study("paper"), name))
    write_report(report, tmp_path)
    ElementTree.parse(tmp_path / "index.html")
    numbers = report.section("refined").numbers
    assert numbers["joint_cost"] < numbers["f2_joint_cost"]
