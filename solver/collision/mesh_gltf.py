"""Strict reading of glTF 2.0: keeps the triangles' skeleton of a file, refuses the rest."""

from __future__ import annotations

import base64
import binascii
import json
import re
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote

from solver.collision.mesh_topology import MAX_TRIANGLES
from solver.errors import InputError, Place

GLB_MAGIC: Final = 0x46546C67
GLB_JSON: Final = 0x4E4F534A
GLB_BINARY: Final = 0x004E4942
MAX_PART_BYTES: Final = 512 * 1024 * 1024
TRIANGLES, STRIP = 4, 5
TRANSFORM_KEYS: Final = ("matrix", "translation", "rotation", "scale")
VIEW_KEYS: Final = ("buffer", "byteOffset", "byteLength", "byteStride")
EMBEDDED: Final = re.compile(r"data:[^,]*;base64,")


def folder_file(name: str, path: Path, place: Place) -> Path:
    """Return the file that `path` refers to as `name`, refused outside the folder of `path`."""
    folder = path.resolve().parent
    odd = re.match(r"[A-Za-z][A-Za-z0-9+.-]*:|[\\/~]", name) or ".." in re.split(r"[\\/]", name)
    try:
        target = (folder / name).resolve()
        inside = not odd and target.is_relative_to(folder)
    except (OSError, ValueError, RuntimeError):
        inside = False
    if not inside:
        raise InputError(
            f"it refers to {name[:80]!r}, expected only files in its own folder", place
        )
    return target


def checked_gltf(
    data: bytes, binary: bool, path: Path, place: Place
) -> tuple[bytes, Mapping[str, bytes]]:
    """Reduce a glTF file to its triangles.

    Returns
    -------
    bytes, mapping
        A glTF document (JSON) without materials, cameras, skins and extensions, and its
        buffers by name.

    Raises
    ------
    InputError
        Truncated, no valid glTF, other primitives than triangles, compressed, or referring to
        files outside its folder.
    """
    text, chunk = _glb_chunks(data, place) if binary else (data, None)
    try:
        tree = json.loads(text.decode("utf-8-sig"), parse_constant=_refuse_constant)
        return _reduced(tree, chunk, path, place)
    except InputError:
        raise
    except RecursionError:
        raise InputError("the glTF document is nested too deeply", place) from None
    except (ValueError, TypeError, KeyError, IndexError, AttributeError, OverflowError) as error:
        raise InputError(
            f"this is no valid glTF 2.0 ({type(error).__name__}: {str(error)[:80]})", place
        ) from error


def refers_to_files(data: bytes, binary: bool, path: Path) -> bool:
    """Whether a glTF file keeps buffers in files of their own; False where it is no glTF."""
    try:
        text, _ = _glb_chunks(data, Place(str(path))) if binary else (data, None)
        buffers = json.loads(text.decode("utf-8-sig"))["buffers"]
        return any("uri" in one and not EMBEDDED.match(one["uri"]) for one in buffers)
    except (InputError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return False


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")


def _glb_chunks(data: bytes, place: Place) -> tuple[bytes, bytes | None]:
    """JSON and binary chunk of a GLB container."""
    if len(data) < 20 or struct.unpack_from("<I", data)[0] != GLB_MAGIC:
        raise InputError("this is no GLB file: its first four bytes are not 'glTF'", place)
    _, version, length = struct.unpack_from("<III", data)
    if version != 2:
        raise InputError(f"the GLB container has version {version}, expected 2", place)
    if length != len(data):
        raise InputError(
            f"the GLB is truncated or damaged: it states {length} bytes but has {len(data)}", place
        )
    chunks: dict[int, bytes] = {}
    start = 12
    while start + 8 <= length:
        size, kind = struct.unpack_from("<II", data, start)
        if start + 8 + size > length:
            raise InputError(
                f"the GLB is truncated or damaged: a chunk of {size} bytes passes its end", place
            )
        chunks.setdefault(kind, data[start + 8 : start + 8 + size])
        start += 8 + size
    if GLB_JSON not in chunks:
        raise InputError("the GLB holds no JSON chunk", place)
    return chunks[GLB_JSON], chunks.get(GLB_BINARY)


def _reduced(
    tree: Any, chunk: bytes | None, path: Path, place: Place
) -> tuple[bytes, Mapping[str, bytes]]:
    if not isinstance(tree, dict) or not str(tree["asset"]["version"]).startswith("2."):
        raise InputError("expected a glTF document of version 2", place)
    required = [str(name) for name in tree.get("extensionsRequired", [])]
    geometric = [name for name in required if not name.startswith("KHR_materials")]
    if geometric:
        raise InputError(
            f"it requires the glTF extensions {', '.join(geometric)[:80]}, expected none", place
        )
    if tree.get("skins"):
        raise InputError("it holds a skinned mesh, expected rigid meshes", place)
    for image in tree.get("images", []):
        if "uri" in image and not image["uri"].startswith("data:"):
            folder_file(unquote(image["uri"]), path, place)
    meshes, accessor_rows = _reduced_meshes(tree, place)
    accessors, view_rows = _reduced_accessors(tree, accessor_rows, place)
    stored = [tree["bufferViews"][row] for row in view_rows]
    views = [{key: view[key] for key in VIEW_KEYS if key in view} for view in stored]
    if sum(_whole(view["byteLength"]) for view in views) > MAX_PART_BYTES:
        raise InputError("its buffer views hold more than 512 MB", place)
    parts = _buffers(tree, chunk, path, place)
    for view in views:
        end = _whole(view.get("byteOffset", 0)) + view["byteLength"]
        stated = len(parts[f"buffer{_whole(view['buffer'])}"])
        if end > stated:
            raise InputError(
                f"the glTF is truncated or damaged: a view ends at byte {end} of a buffer of "
                f"{stated}",
                place,
            )
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": name, "byteLength": len(parts[name])} for name in parts],
        "bufferViews": views,
        "accessors": accessors,
        "meshes": meshes,
        **_reduced_nodes(tree, place),
    }
    return json.dumps(document, allow_nan=False).encode(), parts


def _whole(value: Any) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise ValueError(f"{value!r} where a whole number is due")
    return value


def _reduced_meshes(tree: dict[str, Any], place: Place) -> tuple[list[Any], dict[int, int]]:
    """Meshes of triangles alone, and new numbers of the accessors that they use."""
    rows: dict[int, int] = {}
    meshes: list[Any] = []
    for mesh in tree.get("meshes", []):
        primitives = []
        for primitive in mesh["primitives"]:
            mode = primitive.get("mode", TRIANGLES)
            if mode not in (TRIANGLES, STRIP):
                raise InputError(
                    f"it holds a primitive of mode {mode!r}, expected triangles (4) or a strip (5)",
                    place,
                )
            position = _whole(primitive["attributes"]["POSITION"])
            kept = {"attributes": {"POSITION": rows.setdefault(position, len(rows))}, "mode": mode}
            if "indices" in primitive:
                kept["indices"] = rows.setdefault(_whole(primitive["indices"]), len(rows))
            primitives.append(kept)
        meshes.append({"primitives": primitives})
    if not rows:
        raise InputError("the mesh holds no triangles", place)
    return meshes, rows


def _reduced_accessors(
    tree: dict[str, Any], rows: dict[int, int], place: Place
) -> tuple[list[Any], dict[int, int]]:
    """Keep the used accessors in their new order, and new numbers of their buffer views."""
    views: dict[int, int] = {}
    accessors: list[Any] = []
    for row in rows:
        accessor = tree["accessors"][row]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise InputError("it holds a sparse or empty accessor, expected stored numbers", place)
        view = _whole(accessor["bufferView"])
        accessors.append(
            {
                "bufferView": views.setdefault(view, len(views)),
                "byteOffset": _whole(accessor.get("byteOffset", 0)),
                "componentType": _whole(accessor["componentType"]),
                "count": _whole(accessor["count"]),
                "type": str(accessor["type"]),
            }
        )
    counts = [accessor["count"] for accessor in accessors]
    if min(counts) < 1 or sum(counts) > 6 * MAX_TRIANGLES:
        raise InputError(
            f"its accessors hold {sum(counts)} rows, expected 1 to {6 * MAX_TRIANGLES}", place
        )
    return accessors, views


def _buffers(
    tree: dict[str, Any], chunk: bytes | None, path: Path, place: Place
) -> dict[str, bytes]:
    parts: dict[str, bytes] = {}
    for row, buffer in enumerate(tree.get("buffers", [])):
        data = _buffer(buffer.get("uri"), chunk if row == 0 else None, path, place)
        stated = _whole(buffer["byteLength"])
        if len(data) < stated:
            raise InputError(
                f"the glTF is truncated or damaged: buffer {row} states {stated} bytes but has "
                f"{len(data)}",
                place,
            )
        parts[f"buffer{row}"] = data[:stated]
        if sum(len(part) for part in parts.values()) > MAX_PART_BYTES:
            raise InputError("its buffers hold more than 512 MB", place)
    return parts


def _buffer(uri: str | None, chunk: bytes | None, path: Path, place: Place) -> bytes:
    if uri is None:
        if chunk is None:
            raise InputError("the glTF is truncated or damaged: a buffer has no data", place)
        return chunk
    embedded = EMBEDDED.match(uri)
    if embedded:
        try:
            return base64.b64decode(uri[embedded.end() :], validate=True)
        except binascii.Error as error:
            raise InputError(f"an embedded buffer is no base64 ({error})", place) from error
    target = folder_file(unquote(uri), path, place)
    try:
        if not target.is_file():
            raise InputError(f"its buffer {uri[:80]!r} does not exist", place)
        if target.stat().st_size > MAX_PART_BYTES:
            raise InputError(f"its buffer {uri[:80]!r} has more than 512 MB", place)
        return target.read_bytes()
    except OSError as error:
        raise InputError(f"its buffer {uri[:80]!r} cannot be read ({error})", place) from error


def _reduced_nodes(tree: dict[str, Any], place: Place) -> dict[str, Any]:
    """Nodes with transforms only, of the scene that is shown; every node has one parent."""
    nodes = []
    parents: set[int] = set()
    for node in tree["nodes"]:
        children = [_whole(child) for child in node.get("children", [])]
        kept = {key: node[key] for key in TRANSFORM_KEYS if key in node}
        if children:
            kept["children"] = children
        if "mesh" in node:
            kept["mesh"] = _whole(node["mesh"])
        nodes.append(kept)
        if parents.intersection(children) or len(set(children)) < len(children):
            raise InputError("a glTF node has two parents, expected a tree", place)
        parents.update(children)
    roots = [_whole(root) for root in tree["scenes"][_whole(tree.get("scene", 0))]["nodes"]]
    if parents.intersection(roots) or len(set(roots)) < len(roots):
        raise InputError("a glTF node has two parents, expected a tree", place)
    return {"nodes": nodes, "scenes": [{"nodes": roots}], "scene": 0}
