"""Every sentence of the solver that a person of the window can meet is said in Chinese too."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

import solver
from posopt_gui.document.project_file import read_project
from posopt_gui.i18n import translated
from posopt_gui.viewmodels.check_sentences import sentence
from solver.candidates.outcomes import Outcome
from solver.errors import InputError

ROOT = Path(solver.__file__).parent

NO_SENTENCES_OF_THE_WINDOW = {
    "cli": "the command line speaks English",
    "study": "the study is a command",
    "benchmarks": "measurements are commands",
    "kinematics": "arguments of code",
    "costs": "arguments of code",
    "transforms.py": "arguments of code",
    "lazy_names.py": "arguments of code",
    "search/graph.py": "arguments of code",
    "search/bottleneck.py": "arguments of code",
    "search/heuristic_weight.py": "a command of the study",
    "collision/fcl_checks.py": "the self-test of a library",
    "collision/distance.py": "arguments of code",
    "collision/scene.py": "arguments of code",
    "collision/mesh_proxy.py": "arguments of code",
    "candidates/explain.py": "arguments of code",
    "io/csv_moves_reader.py": "reads back what was written: a difference is a defect",
    "io/json_program_reader.py": "reads back what was written: a difference is a defect",
}

RAISES = re.compile(r"(?:Error|error|refused|expected)$")

# What stands in a sentence where a value is no name or number but words of its own.
INSERTED = {
    "words": (" in mm", ""),
    "links.py words": ("from the retract position of pass 1 to home",),
    "hint": (" (did you mean 'web'?)", ""),
    "toml_reader.py hint": (" (did you mean 'web'?)", ""),
    "assembly.py hint": (" (travel taken from the neighbouring points)", ""),
    "suggestion": (" (did you mean web?)", ""),
    "expected": ("a whole number 1 to 7", "a list of 3 numbers in mm", "one of 'mm', 'm'"),
    "limits": ("at least 3", "1 to 2"),
    "error": ("is empty, expected a name", "is 'x', which overflows; expected a finite number"),
    "verified_program.py error": ("P[7] is given twice, first in line 7", "cannot be read (7)"),
    "error.message": ("holds a joint that is not finite",),
    "message": ("is empty, expected a name",),
    "fault": ("the travel direction is zero, expected a direction along the path",),
    "frame_poses.py fault": ("J5 exceeds its limit by 7.00 deg",),
    "reason": ("its points lie in the frame of the beam", "its lengths are in mm"),
    "toml_reader.py reason": ("Permission denied", "its name is not usable"),
    "source.py reason": ("Permission denied",),
    "state": ("is missing", "appears 2 times"),
    "what": ("the normal", "a remark"),
    "columns.py what": ("column", "columns"),
    "pass_ends.py what": ("approach position, withdrawn by 60 mm,", "lead-in start"),
    "link_checks.py what": ("the approach position of pass 1", "the home position"),
    "shapes.py what": ("radius", "length"),
    "where": ("'x' at character 3 of 'abc'",),
    "others": ("", ", and 3 more of its points"),
    "shown(value)": ("'x'", "a table", "a list of 2", "7"),
    "count": ("one waypoint", "7"),
    "words_of_cells": ("7 cells",),
    "direct.reason": ("forearm and web collide",),
    "beyond": ("J5 exceeds its limit by 7.00 deg",),
    "beyond_limit": (
        "J5 exceeds its limit by 7.00 deg",
        "J2+J3 (elbow) exceeds its limit by 7 deg",
    ),
    "found.reason": ("forearm and web collide", "forearm and web lack 3.0 mm of their margin"),
    "ends": (
        "between the lead-in start and the first waypoint",
        "between the retract position, withdrawn by 60 mm, and the last waypoint",
        "between the approach position, withdrawn by 60 mm, and the lead-in start",
    ),
    "replanning.py reason": ("every feasible pose of waypoint 7 is forbidden",),
    "furthest.label": tuple(one.label for one in Outcome),
    "_pin_reason": ("the pinned pose of waypoint 7 lies in a forbidden region",),
    "first": ("the retract position cannot be reached",),
    "advice": ('set withdrawal = "tool"',),
    "home": ("a home position", "another home position"),
    "difference": ("line 7 has number 8 instead of 9",),
    "turned": ("turns the tool by 7.00 deg",),
}

NAMES = {
    "Windows",
    # files, formats and words of files
    "ASCII", "STL", "OBJ", "PLY", "GLB", "JSON", "CSV", "TOML", "UTF", "GBK", "NUL", "glTF", "XML",
    "PROG", "POS", "END", "APPL", "KEY", "value", "WAIT", "CALL", "FINE", "CNT", "CONFIG", "ASBN",
    "INTP", "PAYLOAD", "PART", "Offset", "DEFAULT_GROUP", "LBL", "JMP", "base64", "fanuc_world",
    "floor", "beam", "true", "false", "mm", "min", "sec", "inch", "deg", "rad", "alpha", "lambda",
    "posopt", "format", "spindle", "off", "dwell", "call", "withdrawal", "tool", "offset", "TCP",
    "orientation_wpr_deg", "from_mm", "min_mm", "spindle_on", "path_tolerance_mm", "workpiece",
    "exact", "nx", "ny", "nz", "cm", "ms", "kg", "on", "do",
}  # fmt: skip


def chinese(text, **values):
    found = translated("zh_CN", text)
    return found.format(**values) if values else found


def sources():
    for path in sorted(ROOT.rglob("*.py")):
        place = path.relative_to(ROOT)
        if place.as_posix() in NO_SENTENCES_OF_THE_WINDOW:
            continue
        if (
            place.name == "__init__.py"
            or place.parts[0] in NO_SENTENCES_OF_THE_WINDOW
            or place.name.startswith("kernels")
        ):
            continue
        yield place, ast.parse(path.read_text(encoding="utf-8"))


def messages(node, file):
    """Each text that an expression of a message can become."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return [node.value]
    if isinstance(node, ast.IfExp):
        return messages(node.body, file) + messages(node.orelse, file)
    if isinstance(node, ast.JoinedStr):
        found = [""]
        for part in node.values:
            literal = isinstance(part, ast.Constant)
            found = [
                one + piece
                for one in found
                for piece in ([part.value] if literal else inserted(part, file, one))
            ]
        return found
    return []


def inserted(part, file, before):
    """Samples of what a value becomes, after the words before it."""
    written = ast.unparse(part.value)
    if written == "hint" and before.endswith("; "):
        return ["did you mean 'web'?", "known here: floor, tool"]
    if written == "error" and before.endswith("("):
        return ["[Errno 13] Permission denied: 'part.stl'"]
    for name in (written, written.split("(")[0]):
        for key in (f"{file} {name}", name):
            if key in INSERTED:
                return INSERTED[key]
    return ["7"]


def reasons():
    """Texts of re-planning, which are told and not raised."""
    place = Path("pipeline/replanning.py")
    for node in ast.walk(ast.parse((ROOT / place).read_text(encoding="utf-8"))):
        if isinstance(node, ast.JoinedStr):
            for text in messages(node, place.name):
                if " " in text:
                    yield text, f"{place}:{node.lineno}"


@cache
def sentences():
    """Texts of all errors that are raised, with the places that raise them."""
    found = dict(reasons())
    for place, tree in sources():
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call) or not RAISES.search(ast.unparse(node.func)):
                continue
            # A move that cannot be made is named before the words for it.
            move = (
                "the move to waypoint 7 (A.LS:9) "
                if "MotionError" in ast.unparse(node.func)
                else ""
            )
            for argument in node.args:
                for text in messages(argument, place.name):
                    if " " in text:
                        found.setdefault(move + text, f"{place}:{node.lineno}")
    return found


def left_over(text):
    """English words in a Chinese sentence: not quoted, and no name or unit."""
    unquoted = re.sub(r"'[^']*'|\"[^\"]*\"", "", text)
    words = re.findall(r"[A-Za-z_]*[a-z]{2,}[A-Za-z_0-9]*", unquoted)
    return [word for word in words if word not in NAMES]


def test_there_are_sentences_to_look_at():
    assert len(sentences()) > 330


def test_every_error_of_the_solver_is_said_in_chinese():
    left = {}
    for text, place in sentences().items():
        shown = sentence(text, chinese)
        if left_over(shown) or not re.search("[\u4e00-\u9fff]", shown):
            left[f"{place} {text}"] = shown
    assert not left, "\n".join(f"{key}\n   {value}" for key, value in left.items())


def test_the_numbers_of_a_sentence_stay_in_it():
    for text in sentences():
        shown = sentence(text, chinese)
        digits = sorted(re.findall(r"\d+\.?\d*", text))
        kept = re.findall(r"\d+\.?\d*", shown)
        assert all(one in kept for one in digits), (text, shown)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("expected at least 10 in mm, found 5.0", "应为不小于 10（mm），实际为 5.0"),
        (
            "the file holds no rows, expected a header and two or more points",
            "文件没有数据行，应有标题行和至少两个点",
        ),
        (
            "unknown key; did you mean 'web_mm'?",
            "未知的项；是否指 'web_mm'？",
        ),
        ("two fixtures are called 'wall'", "有两个夹具名为 'wall'"),
    ],
)
def test_sentences_are_said_as_a_person_would(text, shown):
    assert sentence(text, chinese) == shown


def test_a_blank_stands_between_chinese_and_the_place_in_a_program():
    said = sentence(
        "at MY_GROOVE.LS:39", lambda text, **inside: translated("zh_CN", text).format(**inside)
    )
    assert said == "位于 MY_GROOVE.LS:39"


def test_a_blank_stands_between_the_place_in_a_program_and_chinese():
    assert sentence("on the way to GROOVE.LS:94", chinese) == "前往 GROOVE.LS:94 途中"


@pytest.mark.parametrize(
    ("data", "shown"),
    [
        (b"", "文件到此结束，此处还应有值，可能不完整"),
        (b"{a: 1}", "此处为 'a'，应为双引号中的名称 或 }"),
        (b'{"a": 1, "a": 2}', "成员 'a' 重复，只应出现一次"),
        (b'{"a": tru}', "此处为 'tru'，应为 -12.5 之类的数或其他 JSON 值"),
        (b'{"a": [1, 2}', "此处为 '}'，应先结束 '['"),
        (b'{"a": 1e999}', "数 '1e999' 过大，应为有限数"),
        (b'{"a": "b', "文本不完整或含控制字符，应有右引号"),
        (b"{} x", "此处为 'x'，应为文件末尾"),
        (b"[" * 50, "数组与对象嵌套过深，最多 32 层"),
        (b"{}\0", "含 NUL 字节，是二进制数据，应为文本"),
    ],
)
def test_what_is_wrong_with_a_project_file_is_said_in_chinese(data, shown):
    with pytest.raises(InputError) as refused:
        read_project(data, "work.posopt")
    said = sentence(refused.value.message, chinese).replace("\N{MINUS SIGN}", "-")
    assert said == f"不是完整的 posopt 项目文件（{shown}）"
