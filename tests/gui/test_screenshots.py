"""Pictures of the window come out in the size and look that were asked for."""

import itertools
from statistics import mean

import pytest
from PySide6.QtGui import QImage

from posopt_gui import screenshots
from posopt_gui.screenshot_scenes import SCENES
from posopt_gui.screenshot_stage import Stage


@pytest.fixture(scope="module")
def taken(qapp, tmp_path_factory):
    """Two cheap pictures, each light and dark."""
    folder = tmp_path_factory.mktemp("pictures")
    names = ["map_outcome", "setup_beam"]
    arguments = [str(folder), "--only", *names, "--sizes", "1280x800", "--languages", "zh_CN"]
    assert screenshots.main(arguments) == 0
    return folder


def colours(image, step=7):
    places = itertools.product(range(0, image.width(), step), range(0, image.height(), step))
    return [image.pixelColor(x, y).lightness() for x, y in places]


def test_each_look_has_its_picture_and_the_manifest_names_it(taken):
    found = sorted(str(path.relative_to(taken)) for path in taken.rglob("*.png"))
    assert found == [
        "1280x800_dark_zh_CN/map_outcome.png", "1280x800_dark_zh_CN/setup_beam.png",
        "1280x800_light_zh_CN/map_outcome.png", "1280x800_light_zh_CN/setup_beam.png",
    ]  # fmt: skip
    words = (taken / "MANIFEST.md").read_text("utf-8")
    assert "map_outcome.png" in words
    assert "1280x800_dark_zh_CN" in words


def test_a_picture_shows_something_and_dark_is_darker(taken):
    light = QImage(str(taken / "1280x800_light_zh_CN" / "map_outcome.png"))
    dark = QImage(str(taken / "1280x800_dark_zh_CN" / "map_outcome.png"))
    assert light.width() == dark.width() > 400
    assert len(set(colours(light))) > 10
    assert mean(colours(dark)) < 0.8 * mean(colours(light))


def test_an_unknown_picture_is_refused_with_the_known_ones(tmp_path, capsys):
    assert screenshots.main([str(tmp_path), "--only", "nothing"]) == 2
    assert "map_outcome" in capsys.readouterr().err


def test_scenes_have_names_of_their_own_and_say_what_they_show():
    names = [scene.name for scene in SCENES]
    assert len(names) == len(set(names))
    assert all(scene.tells for scene in SCENES)


def test_hints_come_one_after_the_other_and_close_for_good(qapp, tmp_path):
    stage = Stage(tmp_path)
    hints = stage.window.hints
    assert hints.shown == ""
    hints.open_only("line")
    stage.run_for(0.2)
    assert hints.shown == "line"
    assert hints.bubble.isVisible()
    assert stage.window.rect().contains(hints.bubble.geometry())
    hints.bubble.next_button.click()
    assert not hints.bubble.isVisible()
    stage.settings.sync()
    text = (tmp_path / "settings.ini").read_text("utf-8")
    assert "closed_line=true" in text
    stage.close()


def test_pinning_closes_the_hint_about_the_line(qapp, tmp_path):
    stage = Stage(tmp_path)
    hints = stage.window.hints
    hints.open_only("line")
    stage.session.pin(10, 0.1)
    assert hints.is_closed("line")
    assert hints.shown == ""
    stage.wait(lambda: stage.session.answer is not None, "the answer")
    stage.close()


def test_no_picture_is_taken_before_another_look_is_on_screen(qapp, tmp_path, monkeypatch):
    stage = Stage(tmp_path)
    # A slow machine: nothing comes in the time for which nothing may happen.
    monkeypatch.setattr("posopt_gui.screenshot_stage.QUIET", 0.0)
    for theme in ("dark", "light"):
        stage.look(theme, "zh_CN", stage.window.size().toTuple())
        assert not stage.window.look_switch.going_on
        assert not stage.session.turns.waiting
        assert stage.window.updatesEnabled()
    stage.close()
