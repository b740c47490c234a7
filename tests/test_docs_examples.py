"""The Python blocks of the documentation run, page by page, as one script each."""

import re
from pathlib import Path

import pytest

import solver

DOCS = Path(__file__).parents[1] / "docs"
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
PAGES = sorted(page for page in DOCS.glob("*.md") if BLOCK.search(page.read_text("utf-8")))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_examples_of_a_page_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    script = "\n".join(BLOCK.findall(page.read_text("utf-8")))
    exec(compile(script, str(page), "exec"), {"__name__": "example"})


def test_every_public_name_has_an_example():
    text = (DOCS / "api.md").read_text("utf-8")
    missing = [name for name in solver.__all__ if f"solver.{name}" not in text]
    assert not missing


def test_every_public_name_can_be_loaded():
    for name in solver.__all__:
        assert getattr(solver, name) is not None
