"""The tables of docs/study.md are what the experiments compute."""

import re
from pathlib import Path

import pytest
from study_cells import markdown

from solver.study.context import Study
from solver.study.published import load_study
from solver.study.report import run_experiment

PAGE = (Path(__file__).parents[2] / "docs" / "study.md").read_text("utf-8")
SHOWN = dict(re.findall(r"<!-- table (\w+) -->\n\n((?:\|.*\n)+)", PAGE))
EXPERIMENT = {"joint_changes": "joints"}
SLOW = {"beating"}


@pytest.fixture(scope="module")
def study():
    return Study(load_study("paper"))


TABLES = [
    pytest.param(key, marks=[pytest.mark.long] if key in SLOW else []) for key in sorted(SHOWN)
]


@pytest.mark.parametrize("key", TABLES)
def test_a_table_of_the_page_is_the_computed_one(key, study):
    section = run_experiment(study, EXPERIMENT.get(key, key))
    assert SHOWN[key].strip() == markdown(section.table(key))


def test_the_page_shows_the_main_tables():
    assert len(SHOWN) == PAGE.count("<!-- table")
    assert {"schemes", "beams", "penalty", "heuristic", "beating"} <= set(SHOWN)
