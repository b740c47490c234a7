"""A short name for everything that a set of program files makes the robot do."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

from solver.io.ls_program import ProgramFile

HASH_REMARK = "HASH "


def content_hash(files: Iterable[ProgramFile]) -> str:
    """12 hexadecimal digits over names, instructions and positions, the hash remark left out.

    Layout does not count: blanks, line numbers and attributes.
    """
    digest = hashlib.sha256()
    for file in files:
        groups = file.attributes.get("DEFAULT_GROUP", "")
        digest.update(f"program {file.name} {file.kind} {groups}\n".encode())
        for line in file.application:
            digest.update(f"application {line}\n".encode())
        for one in file.instructions:
            if not one.text.startswith(f"!{HASH_REMARK}"):
                digest.update(f"{' '.join(one.text.split())}\n".encode())
        for number, position in file.positions.items():
            digest.update(f"P[{number}] {position.label}\n".encode())
            for group in position.groups:
                digest.update(
                    f"{group.group} {group.uframe} {group.utool} {group.config}\n".encode()
                )
                for axis in (*group.axes, *group.extra):
                    digest.update(f"{axis.name} {axis.value!r} {axis.unit}\n".encode())
    return digest.hexdigest()[:12]


def stated_hash(file: ProgramFile) -> str | None:
    """The hash that a program's remark states, None where it states none."""
    for remark in file.remarks:
        if remark.startswith(HASH_REMARK):
            return remark.removeprefix(HASH_REMARK).strip()
    return None
