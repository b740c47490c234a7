"""Sentences of the checks and refusals in the window's language.

They speak English, with names and numbers inside; a sentence is recognised by its pattern,
so that its words are translated and what it holds stays.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Final

from posopt_gui.viewmodels.number_words import body_words, group_words, typeset
from posopt_gui.viewmodels.sentences_cells import CELL_SENTENCES
from posopt_gui.viewmodels.sentences_general import GENERAL_SENTENCES
from posopt_gui.viewmodels.sentences_json import JSON_SENTENCES
from posopt_gui.viewmodels.sentences_meshes import MESH_SENTENCES
from posopt_gui.viewmodels.sentences_paths import PATH_SENTENCES
from posopt_gui.viewmodels.sentences_programs import PROGRAM_SENTENCES

Translate = Callable[..., str]

CHECK_SENTENCES: Final[tuple[str, ...]] = (
    "J and L moves in order",
    "every margin kept",
    "as in the cell",
    "no line",
    "the way to the first position is not checked",
    "'{remark}' is not the cell's",
    "Offset,PR[{number}] on contact moves alone",
    "Offset,PR[{number}] missing or misplaced at {place}",
    "{clearance} stands in a remark without a matching hash",
    "{clearance} stands in a remark",
    "a motion comes too close, see the checks above",
    "it stops {count} times on the way, first at {place}",
    "{place}: what happens there needs FINE, not CNT{cnt}",
    "{place}: so close together, roundings change it",
    "fewer positions help (--simplify TOL, or a coarser path)",
    "no pair counts",
    "no corner is rounded",
    "no L moves",
    "no contact moves",
    "no move leads onto a face",
    "no position",
    "one CONFIG along each pass",
    "one pass, the cell asks for no links",
    "not above what was found",
    "spindle, outputs, dwells and calls as the cell asks",
    "NOT CHECKED, the cell leaves these pairs out",
    "NO ACCURACY DECLARED by the cell, so nothing is taken off",
    "programs that are not beside it are assumed not to move: {programs}",
    "written for {digest}, this cell is {own}",
    "states {digest}, its content is {own}",
    "{count} positions solved",
    "{count} moves, each with a position of its own",
    "no motion goes to P[{number}] of {file}",
    "several motions go to P[{number}] of {file}",
    "{least} mm less robot {robot}, workpiece {workpiece} and TCP {tcp} mm as declared",
    "predicted {low} to {high} mm/s, asked {asked} mm/s",
    "{count} lines cannot hold it, first {place}",
    "{count} contact moves in % of the joint speed, first {place}",
    "{place}: J{joint} allows at most {speed} mm/s",
    "not known where other pairs are too close, first at {place}",
    "manipulability at {place}",
    "forward and back at {place}",
    "first at {place}",
    "CONFIG {one} before {other} at {place}",
    "from {one} to {other} at {place}",
    "{where}, gap {number}, beside {passes}",
    "an end of the joint move to {place}",
    "highest at {place}",
    "J{joint} or lean to {place}",
    "J{joint} over the link to {place}",
    "{one} against {other} at {place}",
    "{one} against {other} on the way to {place}",
    "lean {angle} deg on the way to {place}",
    "lead {angle} deg on the way to {place}",
    "spin {angle} deg on the way to {place}",
    "{angle} deg at {place}",
    "on the way to {place}",
    "{what} on the way to {place}",
    "a waypoint after {place}",
    "the move to {place}",
    "waypoint {number} ({line})",
    "pass {one} and pass {other}",
    "pass {number}",
    "before pass {number}: {found} instead of {asked}",
    "after the last pass: {found} instead of {asked}",
    "tool {name}, PAYLOAD[{number}] instead of [{asked}]",
    "tool {name}, PAYLOAD[{number}]",
    "tool {name}",
    "UF {frame}, UT {tool}",
    "{file}: a file of {title} ends in {suffix}",
    "{file}: there is no folder {folder}",
    "{file}: it exists and is no regular file",
    "{file}: cannot be read ({reason})",
    "{file}: cannot be written ({reason})",
    "{file}: is no whole posopt project ({reason})",
    "{file}: is no posopt project: its 'format' is missing",
    "{file}: is no file, expected a posopt project",
    "{file}: is no cell: its table [cell] is missing",
    "{file}: has {size} MB, expected a project of at most {most} MB",
    "{file}: unknown key, expected one of {names}",
    "the project cannot be saved: with its files it has {size} MB, at most {most} MB are read",
    "use smaller meshes",
    "the project cannot be saved ({reason})",
    "{file}: has version {version}, this posopt reads {known}",
    "{file}: there is no such file, expected a path file",
    "a program name has upper-case letters A-Z, digits and _, and begins with a letter, got {name}",
    "a program name is no device of Windows (CON, PRN, AUX, NUL, COM1, LPT1 ...), where no "
    "file can be called so, got {name}",
    "the program name {name} has {count} characters, the controller takes {longest}",
    "a remark cannot hold Chinese characters, since the controller reads printable ASCII alone",
    "write it in Latin letters (pinyin), got {character} at character {number} of {reason}",
    "an override needs a reason of at least {count} characters and at most {most}, got {reason}",
    "no program was written, since a check failed: {checks}",
    "no allowed step leads from waypoint {one} to waypoint {other}",
    "waypoint {number} has no feasible pose at all",
    "every feasible pose of waypoint {number} is forbidden",
    "make the region smaller",
    "pin another lean",
)
"""Sentences of the checks and of files, the more special ones first; {names} are what differs."""

PLACES: Final = ("at {place}", "{what} at {place}", "{name} in {file}")
"""Where something is; tried last of all, since they fit much."""

PATTERNS: Final[tuple[str, ...]] = (
    *JSON_SENTENCES,
    *PROGRAM_SENTENCES,
    *CELL_SENTENCES,
    *MESH_SENTENCES,
    *PATH_SENTENCES,
    *CHECK_SENTENCES,
    *GENERAL_SENTENCES,
    *PLACES,
)
"""English sentences, in the order in which they are tried."""

LISTS: Final = tuple(pattern for pattern in PATTERNS if "; " in pattern)
"""Sentences in which a semicolon does not part two of them."""

CHECK_NAMES: Final[tuple[str, ...]] = (
    "program name", "cell digest", "hash", "reach", "motion", "program flow",
    "frame and tool numbers", "position count", "path position", "lean range", "lead range",
    "spin range", "joint limits", "elbow bound", "singularity", "round trip", "clearance",
    "near and contact bodies", "robot against itself", "path between positions (sampled)",
    "path at rounded corners (estimated)", "tool angles between positions (sampled)",
    "between positions (sampled)", "links (sampled)", "linear moves", "branch along passes",
    "lifts", "net margin", "feed", "joint speed", "steps", "events", "payload",
    "stated clearance",
    "links at rounded corners (estimated)", "lead speed", "link speed", "offset",
    "stated frames", "accepted clearance",
)  # fmt: skip
"""All checks by their names."""

UNITS: Final[tuple[str, ...]] = (
    "differing", "unreachable", "positions", "moves", "unknown", "other", "unused", "deg outside",
    "deg inside", "positions too close", "deg of J4 or J6", "changes", "mm off the line of travel",
    "% beside the asked feed", "% of its limit", "% of the bound", "places",
    "% of the feed", "% of the cell's", "unproven",
)  # fmt: skip
"""Units of the checks that are words; mm, deg, m^3 and kg are the same in every language."""

_PLACE_AFTER_CHINESE = re.compile(r"(?<=[\u4e00-\u9fff])(?=[A-Za-z0-9_.-]+\.\w+:\d)")
"""Before 'GROOVE.LS:39' behind a Chinese character, where a blank belongs."""

_CHINESE_AFTER_PLACE = re.compile(r"(?<=[A-Za-z0-9])(:\d+)(?=[\u4e00-\u9fff])")
"""The line of 'GROOVE.LS:39' before a Chinese character, where a blank belongs too."""

_FIGURE_AFTER_CHINESE = re.compile(r"(?<=应为|际为)(?=[A-Za-z0-9'.-])")
"""Before what was expected or found, where a blank belongs if it is no Chinese word."""

_PLACEHOLDER = re.compile(r"\{(\w+)\}")


def sentence(text: str, tr: Translate) -> str:
    """A sentence of a check as `tr` says it; as it is where its pattern is not known."""
    if any(_expression(pattern).fullmatch(text) for pattern in LISTS):
        return typeset(_part(text, tr))
    said = tr("; ").join(_part(part, tr) for part in text.split("; "))
    said = _CHINESE_AFTER_PLACE.sub(r"\1 ", _PLACE_AFTER_CHINESE.sub(" ", said))
    return typeset(_FIGURE_AFTER_CHINESE.sub(" ", said))


def _part(text: str, tr: Translate) -> str:
    for pattern in PATTERNS:
        found = _expression(pattern).fullmatch(text)
        if found is not None:
            bodies = "{one} against {other}" in pattern
            inside = {
                name: body_words(value, tr)
                if bodies and name in ("one", "other")
                else _part(value, tr)
                for name, value in found.groupdict().items()
            }
            return tr(pattern, **inside) if inside else tr(pattern)
    shown = tr(group_words(text))
    # Names of bodies have words of their own; all other names stay as they are.
    return text if shown == text.replace("_", " ") else shown


def _held(name: str) -> str:
    """What a placeholder holds: the bounds of a range are one word each."""
    return r"\S+" if name in {"low", "high"} else ".+?"


@cache
def _expression(pattern: str) -> re.Pattern[str]:
    pieces = _PLACEHOLDER.split(pattern)
    # Every second piece is the name of a placeholder.
    return re.compile(
        "".join(
            f"(?P<{piece}>{_held(piece)})" if index % 2 else re.escape(piece)
            for index, piece in enumerate(pieces)
        )
    )
