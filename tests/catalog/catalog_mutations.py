"""Helpers of the catalogue's tests: TOML written from a tree, and the sentence of a refusal."""

import copy
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from solver.catalog.names import resource_folder
from solver.errors import InputError

Tree = dict[str, Any]
KeyPath = tuple[str | int, ...]


def shipped(kind: str, name: str) -> Tree:
    """The tree of a shipped file, its references turned into ones that work from anywhere."""
    path = resource_folder() / kind / f"{name}.toml"
    tree = tomllib.loads(path.read_text(encoding="utf-8"))
    if "file" in tree.get("path", {}):
        tree["path"]["file"] = str((path.parent / tree["path"]["file"]).resolve())
    return tree


def to_toml(value: Any) -> str:
    """A TOML value; tables are inline."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"'
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{key}" = {to_toml(one)}' for key, one in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(to_toml, value)) + "]"
    return str(value)


def document(tree: Tree) -> str:
    """A TOML document with one line for each top-level key."""
    return "".join(f"{to_toml(key)} = {to_toml(value)}\n" for key, value in tree.items())


def leaves(value: Any, path: KeyPath = ()) -> Iterator[KeyPath]:
    """Key paths of every value below the tables."""
    if isinstance(value, dict):
        for key, one in value.items():
            yield from leaves(one, (*path, key))
    elif isinstance(value, list) and any(isinstance(one, dict) for one in value):
        for index, one in enumerate(value):
            yield from leaves(one, (*path, index))
    else:
        yield path


def at(tree: Tree, path: KeyPath) -> Any:
    """The value at a key path."""
    for key in path:
        tree = tree[key]
    return tree


def changed(tree: Tree, path: KeyPath, value: Any) -> Tree:
    """A copy with another value at a key path (None: without the key)."""
    tree = copy.deepcopy(tree)
    parent = at(tree, path[:-1])
    if value is None:
        del parent[path[-1]]
    else:
        parent[path[-1]] = value
    return tree


def key_text(path: KeyPath) -> str:
    """A key path as errors print it: bodies.full[3].radius_mm."""
    text = ""
    for key in path:
        text += f"[{key}]" if isinstance(key, int) else f".{key}" if text else key
    return text


def refusal(load: Callable[[Path], object], path: Path) -> InputError:
    """The error of loading a bad file, checked to be one sentence that names the file."""
    with pytest.raises(InputError) as caught:
        load(path)
    sentence = str(caught.value)
    assert path.name in sentence
    assert sentence.isprintable(), sentence
    assert len(sentence) < 900, sentence
    assert "Traceback" not in sentence
    assert ". " not in sentence.replace(str(path), ""), sentence
    return caught.value
