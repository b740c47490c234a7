"""The line about a path names the feeds that count, which may be the file's and not the field's."""

from dataclasses import replace

import pytest

from posopt_gui.viewmodels.path_words import path_words
from solver.catalog import load_cell


def said(text, **values):
    return text.format(**values)


@pytest.mark.parametrize(("feeds", "words"), [((0.025,), "25"), ((0.02, 0.05), "20 … 50")])
def test_the_feeds_of_the_passes_are_said(feeds, words):
    toolpath = load_cell("groove_hw300").toolpath
    passes = tuple(replace(toolpath.passes[0], feed=feed) for feed in feeds)
    line = path_words(toolpath.with_passes(passes), said)
    assert line.endswith(f"frame: beam · feed: {words} mm/s")
    assert line.startswith(f"Waypoints: {50 * len(feeds)} · passes: {len(feeds)}")
