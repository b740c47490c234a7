"""Every text of the window has its Chinese one, and every Chinese one is of use."""

import ast
import json
import re
import string
import tomllib
from functools import cache
from pathlib import Path

import pytest

from posopt_gui import look as look_module
from posopt_gui.actions import ACTIONS, MENUS
from posopt_gui.i18n import texts, translated
from posopt_gui.screenshot_scenes import SCENES
from posopt_gui.views.hints import HINTS
from posopt_gui.views.status_line import STAGES
from solver.catalog.names import resource_folder

ROOT = Path(__file__).parents[2]
AREAS = {
    path.stem: json.loads(path.read_text("utf-8"))
    for path in sorted((resource_folder() / "translations" / "zh_CN").glob("*.json"))
}
CHINESE = texts("zh_CN")


def nodes_of(folder):
    for path in sorted((ROOT / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            yield path, node


@cache
def shown_literals():
    """Each literal first argument of `tr(...)` in the window, with its places."""
    found = {}
    for path, node in nodes_of("posopt_gui"):
        if not isinstance(node, ast.Call) or not node.args:
            continue
        called = getattr(node.func, "attr", getattr(node.func, "id", ""))
        first = node.args[0]
        if called in {"tr", "_tr", "translate"} and isinstance(first, ast.Constant):
            place = f"{path.relative_to(ROOT)}:{node.lineno}"
            found.setdefault(first.value, []).append((place, node))
    return found


def placeholders(text):
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


def test_every_literal_that_is_shown_has_a_chinese_text():
    found = shown_literals()
    assert len(found) > 300
    missing = {text: places[0][0] for text, places in found.items() if text not in CHINESE}
    assert missing == {}


def test_every_text_of_the_shells_tables_has_a_chinese_text():
    words = {*MENUS, *HINTS.values(), *STAGES.values(), "Setup", "Inspector", "Playback"}
    words |= {text for spec in ACTIONS for text in (spec.text, spec.tip)}
    assert words - set(CHINESE) == set()


@pytest.mark.parametrize("text", CHINESE)
def test_a_translation_holds_the_same_values(text):
    assert placeholders(CHINESE[text]) == placeholders(text)


def test_a_text_gets_the_values_that_it_names():
    for text, uses in shown_literals().items():
        for place, node in uses:
            given = {one.arg for one in node.keywords}
            if None in given:
                continue
            if given:
                assert given == placeholders(text), place


def test_the_same_text_is_translated_alike_everywhere():
    for area, words in AREAS.items():
        for text, shown in words.items():
            assert CHINESE[text] == shown, (area, text)


def test_chinese_texts_are_chinese():
    for text, shown in CHINESE.items():
        assert shown.strip(), text
        if shown == text:
            # Names, signs and formulas stay as they are.
            words = re.findall("[a-z]{4,}", re.sub(r"\{\w+\}", "", text))
            assert len(words) <= 1 or "中文" in text, text


@cache
def sayable():
    """Constants and templates of both packages, and names and sentences of the resources."""
    constants, templates = set(), set()
    for folder in ("posopt_gui", "solver"):
        for _, node in nodes_of(folder):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                constants.add(node.value)
            elif isinstance(node, ast.BinOp) and isinstance(node.left, ast.Constant):
                left = node.left.value
                if isinstance(left, str) and len(left) > 12:
                    templates.add(re.escape(left) + ".+")
            elif isinstance(node, ast.JoinedStr):
                parts = [
                    re.escape(one.value) if isinstance(one, ast.Constant) else r"[\w .+-]+"
                    for one in node.values
                ]
                templates.add("".join(parts))
    for path in sorted(resource_folder().rglob("*.toml")):
        strings(tomllib.loads(path.read_text("utf-8")), constants)
    for path in sorted(resource_folder().rglob("*.csv")):
        constants.update(re.findall(r"[a-z ]{3,}", path.read_text("utf-8")))
    return constants, re.compile("|".join(f"(?:{one})" for one in sorted(templates)))


def strings(value, found):
    if isinstance(value, str):
        found.add(value)
    elif isinstance(value, dict):
        found.update(value)
        for one in value.values():
            strings(one, found)
    elif isinstance(value, list):
        for one in value:
            strings(one, found)


def is_said(text):
    constants, templates = sayable()
    names = {text, text.replace(" ", "_")}
    if names & constants or any(templates.fullmatch(name) for name in names):
        return True
    return len(text) > 12 and any(text in constant for constant in constants)


def test_no_chinese_text_is_left_over():
    assert [text for text in CHINESE if not is_said(text)] == []


@pytest.mark.long
def test_a_whole_session_in_chinese_shows_no_english(qapp, tmp_path, monkeypatch):
    """What is put together while it runs is recorded where it has no Chinese text."""
    from posopt_gui.screenshot_stage import Stage

    unknown = set()

    def recorded(language, text):
        found = translated(language, text)
        if language == "zh_CN" and text not in CHINESE and re.search("[A-Za-z]{2}", text):
            unknown.add(text)
        return found

    monkeypatch.setattr(look_module, "translated", recorded)
    stage = Stage(tmp_path)
    stage.look("light", "zh_CN", (1280, 800))
    wanted = (
        "window", "map_hover", "map_blocked", "map_schemes", "results_schemes", "placement",
        "path_columns", "setup_limits", "export_passed", "window_no_sequence",
    )  # fmt: skip
    for scene in (one for one in SCENES if one.name in wanted):
        scene.begin(stage)
        scene.show(stage)
        scene.hide(stage)
        scene.end(stage)
    stage.close()
    left = sorted(text for text in unknown if not is_a_name(text))
    assert not left, "; ".join(left)


NAMES = "|".join(
    (
        "[0-9a-f]{12}", "die grinder", "[a-z]+[0-9]?", "[A-Z][A-Z0-9_ ,]*", r"[A-Z]+\.LS:\d+",
        r"[\w/-]*[_.][\w./-]*",
    )
)  # fmt: skip


def is_a_name(text):
    """Names of schemes, cells, frames and files are the same in every language."""
    return bool(re.fullmatch(NAMES, text))
