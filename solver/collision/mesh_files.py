"""Strict reading of mesh files before a lenient library sees them.

The library that builds the triangles drops what it does not understand and gives an empty
scene for a truncated file. So each format is first held against its own rules; what is handed
on is text or bytes without names, materials and outside references.
"""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from solver.collision.mesh_gltf import checked_gltf, folder_file, refers_to_files
from solver.collision.mesh_topology import MAX_TRIANGLES
from solver.errors import InputError, Place

MAX_BYTES: Final = 256 * 1024 * 1024
FORMATS: Final = (".stl", ".obj", ".ply", ".gltf", ".glb")

NUMBER: Final = rb"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
IS_NUMBER: Final = re.compile(NUMBER)
IS_INDEX: Final = re.compile(rb"[+-]?[0-9]{1,10}")
STL_HEADER: Final = 84
STL_TRIANGLE: Final = 50


@dataclass(frozen=True, slots=True)
class CheckedFile:
    """What the mesh library may read: `kind` of format, `data`, named `parts` of glTF.

    `triangles` is the number that the file itself states, None where it states none.
    """

    kind: str
    data: bytes
    triangles: int | None = None
    parts: Mapping[str, bytes] = field(default_factory=dict)


def read_bytes(path: Path, place: Place) -> bytes:
    """Return the whole file, or an InputError when it is missing, empty or too large."""
    try:
        if not path.exists():
            raise InputError("the file does not exist", place)
        if not path.is_file():
            raise InputError("this is not a file", place)
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise InputError(
                f"the file has {size / 2**20:.0f} MB, expected at most {MAX_BYTES >> 20} MB", place
            )
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        raise InputError(f"the file cannot be read ({error})", place) from error
    return _checked_bytes(data, place)


def _checked_bytes(data: bytes, place: Place) -> bytes:
    if not data.strip():
        raise InputError("the file is empty", place)
    return data


def checked_file(path: Path, data: bytes | None = None) -> CheckedFile:
    """Read a mesh file and check it against the rules of its format (by extension).

    `data` are its bytes where they are in memory already; `path` then only names it.
    """
    place = Place(str(path))
    kind = path.suffix.lower()
    if kind not in FORMATS:
        raise InputError(
            f"unknown mesh format {path.suffix!r}, expected one of {', '.join(FORMATS)}", place
        )
    data = read_bytes(path, place) if data is None else _checked_bytes(data, place)
    if kind == ".stl":
        return _checked_stl(data, place)
    if kind == ".obj":
        return _checked_obj(data, path, place)
    if kind == ".ply":
        return _checked_ply(data, place)
    text, parts = checked_gltf(data, kind == ".glb", path, place)
    return CheckedFile("gltf", text, None, parts)


def whole_file(path: Path) -> tuple[str, bytes]:
    """Read a mesh file as one that refers to no others: its name and its bytes.

    A glTF whose buffers are files of their own becomes one with all of them inside, reduced to
    its triangles; every other file stays as it is.

    Raises
    ------
    InputError
        Missing, empty, too large, of unknown format, or a glTF whose buffers cannot be read.
    """
    place, kind = Place(str(path)), path.suffix.lower()
    if kind not in FORMATS:
        raise InputError(
            f"unknown mesh format {path.suffix!r}, expected one of {', '.join(FORMATS)}", place
        )
    data = read_bytes(path, place)
    if kind not in {".gltf", ".glb"} or not refers_to_files(data, kind == ".glb", path):
        return path.name, data
    text, parts = checked_gltf(data, kind == ".glb", path, place)
    document = json.loads(text)
    for buffer in document["buffers"]:
        content = base64.b64encode(parts[buffer["uri"]]).decode("ascii")
        buffer["uri"] = f"data:application/octet-stream;base64,{content}"
    return f"{path.stem}.gltf", json.dumps(document).encode()


def _checked_stl(data: bytes, place: Place) -> CheckedFile:
    stated = int.from_bytes(data[80:84], "little")
    if len(data) >= STL_HEADER and len(data) == STL_HEADER + STL_TRIANGLE * stated:
        _check_count(stated, place)
        return CheckedFile("stl", data, stated)
    if data.lstrip()[:5].lower() == b"solid" and b"\0" not in data:
        return _checked_ascii_stl(data, place)
    if len(data) < STL_HEADER:
        raise InputError(
            f"the binary STL is truncated: {len(data)} bytes, but its header alone takes "
            f"{STL_HEADER}",
            place,
        )
    raise InputError(
        f"the binary STL is truncated or damaged: it states {stated} triangles "
        f"({STL_HEADER + STL_TRIANGLE * stated} bytes) but has {len(data)} bytes",
        place,
    )


ASCII_STL: Final = {
    "solid": (re.compile(rb"solid\b.*", re.I), ("facet", "endsolid")),
    "facet": (re.compile(rb"facet\s+normal(?:\s+\S+){3}", re.I), ("outer loop",)),
    "outer loop": (re.compile(rb"outer\s+loop", re.I), ("vertex 1",)),
    "vertex 1": (re.compile(rb"vertex((?:\s+" + NUMBER + rb"){3})", re.I), ("vertex 2",)),
    "vertex 2": (re.compile(rb"vertex((?:\s+" + NUMBER + rb"){3})", re.I), ("vertex 3",)),
    "vertex 3": (re.compile(rb"vertex((?:\s+" + NUMBER + rb"){3})", re.I), ("endloop",)),
    "endloop": (re.compile(rb"endloop", re.I), ("endfacet",)),
    "endfacet": (re.compile(rb"endfacet", re.I), ("facet", "endsolid")),
    "endsolid": (re.compile(rb"endsolid\b.*", re.I), ("solid",)),
}
"""Line of an ASCII STL: its pattern and the lines that may follow it."""


def _checked_ascii_stl(data: bytes, place: Place) -> CheckedFile:
    expected: tuple[str, ...] = ("solid",)
    vertices: list[bytes] = []
    for number, raw in enumerate(data.splitlines(), start=1):
        line = raw.strip()
        if not line:
            continue
        for name in expected:
            match = ASCII_STL[name][0].fullmatch(line)
            if match:
                break
        else:
            raise InputError(
                f"expected {' or '.join(expected)!r} with plain numbers, found {_shown(line)}",
                Place(place.file, number),
            )
        expected = ASCII_STL[name][1]
        if name.startswith("vertex"):
            vertices.append(match[1])
    if expected != ("solid",):
        raise InputError("the ASCII STL is truncated: it does not end with 'endsolid'", place)
    _check_count(len(vertices) // 3, place)
    lines = [b"solid\n"]
    for row in range(0, len(vertices), 3):
        lines.append(b"facet normal 0 0 0\nouter loop\n")
        lines += [b"vertex%s\n" % vertex for vertex in vertices[row : row + 3]]
        lines.append(b"endloop\nendfacet\n")
    lines.append(b"endsolid\n")
    return CheckedFile("stl", b"".join(lines), len(vertices) // 3)


def _checked_obj(data: bytes, path: Path, place: Place) -> CheckedFile:
    """Keep vertices and triangles only: polygons fanned, relative indices made absolute."""
    if b"\0" in data:
        raise InputError("this is not an OBJ file: it holds binary data", place)
    vertices: list[bytes] = []
    faces: list[bytes] = []
    highest = 0
    text = data.removeprefix(b"\xef\xbb\xbf").replace(b"\\\r\n", b" ").replace(b"\\\n", b" ")
    for number, raw in enumerate(text.splitlines(), start=1):
        tokens = raw.split(b"#", 1)[0].split()
        if not tokens:
            continue
        if tokens[0] == b"v":
            if len(tokens) < 4 or not all(IS_NUMBER.fullmatch(token) for token in tokens[1:]):
                raise InputError(
                    f"expected a vertex of three or more plain numbers, found {_shown(raw)}",
                    Place(place.file, number),
                )
            vertices.append(b"v %s %s %s\n" % tuple(tokens[1:4]))
        elif tokens[0] == b"f":
            corners = _obj_corners(tokens[1:], len(vertices), raw, Place(place.file, number))
            highest = max(highest, *corners)
            faces += [
                b"f %d %d %d\n" % (corners[0], corners[i], corners[i + 1])
                for i in range(1, len(corners) - 1)
            ]
            _check_count(len(faces), place)
        elif tokens[0] == b"mtllib":
            name = raw.split(None, 1)[1].strip().decode("utf-8", "replace")
            folder_file(name, path, Place(place.file, number))
    _check_count(len(faces), place)
    if highest > len(vertices):
        raise InputError(
            f"a face names vertex {highest} but the file has {len(vertices)} vertices", place
        )
    return CheckedFile("obj", b"".join(vertices + faces), len(faces))


def _obj_corners(tokens: list[bytes], vertices: int, raw: bytes, place: Place) -> list[int]:
    rows = [token.split(b"/", 1)[0] for token in tokens]
    if len(rows) < 3 or not all(IS_INDEX.fullmatch(row) for row in rows):
        raise InputError(f"expected a face of three or more vertices, found {_shown(raw)}", place)
    corners = [int(row) if int(row) >= 0 else vertices + 1 + int(row) for row in rows]
    if min(corners) < 1:
        raise InputError(f"the face names a vertex before the first, in {_shown(raw)}", place)
    return corners


def _checked_ply(data: bytes, place: Place) -> CheckedFile:
    header, end, body = data.partition(b"end_header")
    lines = header.split(b"\n")
    if lines[0].strip() != b"ply" or not end:
        raise InputError("this is no PLY file: it lacks 'ply' or 'end_header'", place)
    elements: list[tuple[bytes, int, list[list[bytes]]]] = []
    encoding = b""
    for number, raw in enumerate(lines[1:], start=2):
        tokens = raw.split()
        if not tokens or tokens[0] in (b"comment", b"obj_info"):
            continue
        if tokens[0] == b"format" and len(tokens) == 3:
            encoding = tokens[1]
        elif tokens[0] == b"element" and len(tokens) == 3 and IS_INDEX.fullmatch(tokens[2]):
            elements.append((tokens[1], int(tokens[2]), []))
        elif tokens[0] == b"property" and len(tokens) in (3, 5) and elements:
            elements[-1][2].append(tokens[1:])
        else:
            raise InputError(f"unexpected header line {_shown(raw)}", Place(place.file, number))
    named = {name: (count, rows) for name, count, rows in elements}
    if [name for name, _, _ in elements] != [b"vertex", b"face"]:
        raise InputError("expected the PLY elements 'vertex' and 'face', in this order", place)
    count = named[b"face"][0]
    _check_count(count, place)
    if not 3 <= named[b"vertex"][0] <= 3 * MAX_TRIANGLES:
        raise InputError(f"the PLY states {named[b'vertex'][0]} vertices", place)
    first_line = len(lines)
    kept = b"\n".join(
        line.strip() for line in lines if line.split()[:1] not in ([b"comment"], [b"obj_info"])
    )
    if encoding != b"ascii":
        # the library holds the size that the header states against the size of the file
        return CheckedFile("ply", kept + end + body)
    rows = _checked_ply_rows(body, elements, first_line, place)
    return CheckedFile("ply", kept + b"end_header\n" + b"\n".join(rows) + b"\n")


def _checked_ply_rows(
    body: bytes, elements: list[tuple[bytes, int, list[list[bytes]]]], first_line: int, place: Place
) -> list[bytes]:
    rows: list[bytes] = []
    (_, vertices, scalars), (_, faces, lists) = elements
    plain_list = bool(lists) and lists[0][0] == b"list"
    for number, raw in enumerate(body.splitlines(), start=first_line):
        tokens = raw.split()
        if not tokens:
            continue
        here = Place(place.file, number)
        if not all(IS_NUMBER.fullmatch(token) for token in tokens):
            raise InputError(f"expected plain numbers, found {_shown(raw)}", here)
        if len(rows) < vertices:
            if len(tokens) != len(scalars):
                raise InputError(
                    f"expected {len(scalars)} numbers of a vertex, found {len(tokens)}", here
                )
        elif plain_list and (tokens[0] not in (b"3", b"4") or len(tokens) < 1 + int(tokens[0])):
            raise InputError(f"expected a triangle or quad, found {_shown(raw)}", here)
        rows.append(b" ".join(tokens))
    if len(rows) != vertices + faces:
        raise InputError(
            f"the PLY is truncated or damaged: it states {vertices + faces} rows of vertices and "
            f"faces but has {len(rows)}",
            place,
        )
    return rows


def _check_count(triangles: int, place: Place) -> None:
    if triangles < 1:
        raise InputError("the mesh holds no triangles", place)
    if triangles > MAX_TRIANGLES:
        raise InputError(
            f"the mesh has {triangles} triangles, expected at most {MAX_TRIANGLES}", place
        )


def _shown(raw: bytes) -> str:
    """Return the start of a line as a person may see it."""
    return repr(raw.strip()[:60].decode("utf-8", "replace"))
