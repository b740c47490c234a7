"""The repository keeps its promises: sizes, links, names, and commands that exist."""

from __future__ import annotations

import re
import shutil
import subprocess
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
GENERATED = re.compile(
    r"\.git|\.venv.*|\..*_cache|\.hypothesis|__pycache__|build|dist|.*\.egg-info"
)
TEXT = {".py", ".md", ".toml", ".sh", ".ps1", ".csv", ".json", ".svg", ".txt", ".yml", ".ini", ""}
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


def product_files() -> list[Path]:
    found = []
    for path in sorted(REPOSITORY.rglob("*")):
        parts = path.relative_to(REPOSITORY).parts
        if path.is_file() and not any(map(GENERATED.fullmatch, parts)):
            found.append(path)
    return found


FILES = product_files()
PAGES = [path for path in FILES if path.suffix == ".md"]


def name_of(path: Path) -> str:
    return path.relative_to(REPOSITORY).as_posix()


def commands(page: str, language: str) -> list[str]:
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    blocks = re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    return [block.strip() for block in blocks]


@pytest.mark.parametrize(
    "pattern",
    [
        pytest.param(
            r"(?:py"
            r"pi|npm"
            r"js|anaconda)\.(?:org|com)|python"
            r"hosted|deb\.deb"
            r"ian|"
            r"archive\.ub"
            r"untu|--(?:extra-)?index-url",
            id="no host of a package registry",
        ),
        pytest.param(
            r"(?<![\w.*])/(?:work|opt|root|home|Users)/[\w.]|[A-Z]:\\(?!\\?n)\w+\\",
            id="no path of one machine",
        ),
    ],
)
def test_product_text_has(pattern):
    found = []
    for path in FILES:
        if path.suffix in TEXT:
            for number, line in enumerate(path.read_text("utf-8").splitlines(), start=1):
                if re.search(pattern, line):
                    found.append(f"{name_of(path)}:{number}: {line.strip()}")
    assert found == []


def test_there_is_no_lock_file():
    locks = re.compile(r".*\.lock|.*-lock\..*|requirements.*\.txt|constraints.*\.txt")
    assert [name_of(path) for path in FILES if locks.fullmatch(path.name)] == []


def test_source_files_have_at_most_450_lines():
    sizes = {
        name_of(path): len(path.read_text("utf-8").splitlines())
        for path in FILES
        if path.suffix in {".py", ".sh", ".ps1"}
    }
    assert {name: size for name, size in sizes.items() if size > 450} == {}


def test_no_pattern_repeats_a_group_possessively():
    # Before 3.11.5 (Debian 12 has 3.11.2) `re` keeps what a failed repetition of `(...)*+` took.
    found = [
        f"{name_of(path)}: {pattern}"
        for path in FILES
        if path.suffix == ".py" and path.is_relative_to(REPOSITORY / "solver")
        for pattern in re.findall(r"\)(?:[*+?]|\{\d*,?\d*\})\+|\(\?>", path.read_text("utf-8"))
    ]
    assert found == []


def test_test_files_have_unique_names_and_no_package():
    names = [path.name for path in FILES if path.is_relative_to(REPOSITORY / "tests")]
    modules = [name for name in names if name.startswith("test_")]
    assert len(modules) == len(set(modules))
    assert "__init__.py" not in names


def test_every_package_is_listed_for_the_wheel():
    listed = set(PROJECT["tool"]["setuptools"]["packages"])
    present = {
        name_of(path.parent).replace("/", ".")
        for path in FILES
        if path.name == "__init__.py" and path.parent.name != "resources"
    }
    assert listed == present | {"posopt_resources", "posopt_docs"}


def test_only_kernels_are_loosely_typed():
    overrides = PROJECT["tool"]["mypy"]["overrides"]
    loose = [name for one in overrides if "disallow_untyped_defs" in one for name in one["module"]]
    others = [name for name in loose if not name.rpartition(".")[2].startswith("kernels")]
    assert loose
    assert others == []


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_link_of_a_page_resolves(page):
    broken = []
    for target in LINK.findall(page.read_text("utf-8")):
        if target.startswith(("https://", "mailto:")):
            continue
        location, _, anchor = target.partition("#")
        goal = (page.parent / location).resolve() if location else page
        if not goal.exists() or (anchor and anchor not in anchors_of(goal)):
            broken.append(target)
    assert broken == []


def anchors_of(page: Path) -> set[str]:
    headings = re.findall(r"^#+ (.+)$", page.read_text("utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_index_links_every_page_of_the_documentation():
    docs = REPOSITORY / "docs"
    linked = {
        (docs / target.partition("#")[0]).resolve()
        for target in LINK.findall((docs / "index.md").read_text("utf-8"))
    }
    pages = {page for page in PAGES if page.is_relative_to(docs) and page.name != "index.md"}
    assert {name_of(page) for page in pages - linked} == set()


@pytest.mark.parametrize("image", sorted((REPOSITORY / "docs").rglob("*.svg")), ids=name_of)
def test_drawings_are_well_formed_and_say_what_they_show(image):
    root = ElementTree.parse(image).getroot()
    space = "{http://www.w3.org/2000/svg}"
    assert root.tag == f"{space}svg"
    assert root.findtext(f"{space}title")
    assert root.findtext(f"{space}desc")


@pytest.mark.parametrize("group", ["dependencies", "test"])
def test_every_dependency_has_a_line_of_reason(group):
    project = PROJECT["project"]
    wanted = project[group] if group in project else project["optional-dependencies"][group]
    names = {re.split(r"[\s<>=!;\[]", requirement)[0] for requirement in wanted}
    page = (REPOSITORY / "docs" / "dependencies.md").read_text("utf-8")
    explained = set(re.findall(r"^\| ([\w-]+) \| \w", page, re.MULTILINE))
    assert names - explained == set()


def test_readme_has_one_command_line_to_plan_and_one_to_test():
    linux = commands("README.md", "bash")
    windows = commands("README.md", "powershell")
    assert linux[:2] == [
        "bash scripts/setup.sh && .venv/bin/posopt plan --out GROOVE.LS",
        "bash scripts/run_tests.sh",
    ]
    assert [line.count("\n") for line in windows] == [0, 0]
    for command in (*linux[:2], *windows):
        for script in re.findall(r"scripts[/\\][\w.]+", command):
            assert (REPOSITORY / script.replace("\\", "/")).is_file()


def test_continuous_integration_ends_with_the_test_command_of_the_readme():
    script = (REPOSITORY / ".ci" / "run").read_text("utf-8")
    lines = [line for line in script.splitlines() if line and not line.startswith("#")]
    assert lines[0] == "set -euo pipefail"
    assert lines[-1].startswith(commands("README.md", "bash")[1])


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash here")
@pytest.mark.parametrize("script", [".ci/run", *map(name_of, REPOSITORY.glob("scripts/*.sh"))])
def test_shell_scripts_parse(script):
    done = subprocess.run(
        ["bash", "-n", script], cwd=REPOSITORY, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
