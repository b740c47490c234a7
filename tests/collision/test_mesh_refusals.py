from __future__ import annotations

import json
import logging
import os
import struct

import numpy as np
import pytest
import trimesh
from test_mesh_loading import KINDS, block, written
from trimesh.exchange import stl

from solver.collision import mesh_files
from solver.collision.mesh_topology import MAX_TRIANGLES
from solver.collision.meshes import load_mesh
from solver.errors import InputError

MUTANTS = 25
"""Damaged files of every kind and way of damage."""


def refusal(path, unit="mm"):
    """The one sentence with which a file is refused; it begins with the file."""
    with pytest.raises(InputError) as caught:
        load_mesh(path, unit)
    sentence = str(caught.value)
    assert caught.value.place.file == str(path)
    assert sentence.startswith(str(path))
    assert "\n" not in sentence
    assert len(sentence) < len(str(path)) + 300
    return sentence


def saved(folder, name, data):
    path = folder / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def flipped(data, rng):
    array = bytearray(data)
    for _ in range(rng.integers(1, 6)):
        array[rng.integers(len(array))] = rng.integers(256)
    return bytes(array)


def cut(data, rng):
    return data[: rng.integers(len(data))]


def without_a_piece(data, rng):
    start = rng.integers(len(data))
    return data[:start] + data[start + rng.integers(1, 40) :]


def with_a_number_replaced(data, rng):
    words = [b"nan", b"inf", b"1e999", b"-1", b"0", b"1_000", b"99999999999", b"", b"x", b"0x10"]
    tokens = data.split(b" ")
    tokens[rng.integers(len(tokens))] = words[rng.integers(len(words))]
    return b" ".join(tokens)


def shuffled(data, rng):
    lines = data.split(b"\n")
    i, j = rng.integers(len(lines), size=2)
    lines[i], lines[j] = lines[j], lines[i]
    return b"\n".join(lines)


def with_a_word_replaced(data, rng):
    words = [b"null", b"-1", b"1e99", b"99999999", b'""', b"[]", b"{}", b"true", b"0.5"]
    places = [i for i, byte in enumerate(data) if byte in b"0123456789"]
    start = places[rng.integers(len(places))]
    return data[:start] + words[rng.integers(len(words))] + data[start + 1 :]


DAMAGE = (flipped, cut, without_a_piece, with_a_number_replaced, shuffled, with_a_word_replaced)


@pytest.mark.parametrize("damage", DAMAGE, ids=lambda damage: damage.__name__)
@pytest.mark.parametrize("kind", KINDS)
def test_a_damaged_file_gives_one_sentence_or_a_solid(tmp_path, kind, damage, caplog, capfd):
    rng = np.random.default_rng([KINDS.index(kind), DAMAGE.index(damage)])
    path = written(tmp_path, kind, block())
    whole = path.read_bytes()
    sentences, solids = [], []
    for _ in range(MUTANTS):
        path.write_bytes(damage(whole, rng))
        try:
            solids.append(load_mesh(path))
        except InputError as error:
            sentences.append(str(error))
    assert sentences or damage is shuffled
    for sentence in sentences:
        assert sentence.startswith(str(path))
        assert "\n" not in sentence
    for mesh in solids:
        again = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
        assert again.is_watertight
        assert again.volume > 0.0
        assert np.isfinite(mesh.vertices).all()
    assert not [record for record in caplog.records if record.levelno > logging.DEBUG]
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "obj"])
def test_a_truncated_file_is_refused_wherever_it_ends(tmp_path, kind):
    path = written(tmp_path, kind, block())
    whole = path.read_bytes().rstrip()
    for end in np.linspace(1, len(whole) - 1, 25).astype(int):
        path.write_bytes(whole[:end])
        refusal(path)


def test_a_truncated_binary_stl_is_told_by_its_size(tmp_path):
    data = stl.export_stl(block())
    path = saved(tmp_path, "cut.stl", data[:-50])
    assert "truncated" in refusal(path)
    assert "12 triangles (684 bytes) but has 634 bytes" in refusal(path)
    assert "truncated" in refusal(saved(tmp_path, "short.stl", data[:50]))


def test_a_truncated_ascii_stl_lacks_its_endsolid(tmp_path):
    text = stl.export_stl_ascii(block())
    assert "endsolid" in refusal(saved(tmp_path, "a.stl", text.replace("endsolid", "")))
    bad = text.replace("outer loop", "outer look", 1)
    assert "line 3" in refusal(saved(tmp_path, "b.stl", bad))


@pytest.mark.parametrize("name", ["a.stl", "a.obj", "a.ply", "a.gltf", "a.glb"])
def test_missing_empty_and_blank_files_and_folders_are_refused(tmp_path, name):
    assert "does not exist" in refusal(tmp_path / "absent" / name)
    assert "empty" in refusal(saved(tmp_path, name, b""))
    assert "empty" in refusal(saved(tmp_path, name, b" \n\n"))
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / name).mkdir()
    assert "not a file" in refusal(tmp_path / "folder" / name)
    refusal(tmp_path / f"nul\0{name}")


@pytest.mark.parametrize("name", ["part.step", "part", "part.zip", "part.dae", "part.3mf"])
def test_other_formats_are_refused_with_the_known_ones(tmp_path, name):
    assert ".stl, .obj, .ply, .gltf, .glb" in refusal(saved(tmp_path, name, b"content"))


def test_an_unknown_unit_is_refused(tmp_path):
    assert "inch" in refusal(written(tmp_path, "stl", block()), "inch")


@pytest.mark.parametrize("name", ["a.stl", "a.obj", "a.ply", "a.gltf", "a.glb"])
@pytest.mark.parametrize("data", [b"hello", b"\0" * 200, b"\xff\xfe" * 99, b"{}", b"[" * 100000])
def test_files_of_something_else_are_refused(tmp_path, name, data):
    refusal(saved(tmp_path, name, data))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("kind", KINDS)
def test_a_vertex_that_is_not_finite_is_refused(tmp_path, kind, value):
    broken = block()
    vertices = np.array(broken.vertices)
    vertices[3, 1] = value
    broken = trimesh.Trimesh(vertices, broken.faces, process=False, validate=False)
    with np.errstate(invalid="ignore"):
        path = written(tmp_path, kind, broken)
    sentence = refusal(path)
    assert any(word in sentence for word in ("finite", "plain numbers", "no JSON number"))


@pytest.mark.parametrize("kind", KINDS)
def test_an_open_mesh_is_refused_with_its_number_of_open_edges(tmp_path, kind):
    whole = block()
    opened = trimesh.Trimesh(whole.vertices, whole.faces[2:], process=False)
    sentence = refusal(written(tmp_path, kind, opened))
    assert "not watertight" in sentence
    assert "of its 17 edges are open" in sentence or "of its 18 edges are open" in sentence


@pytest.mark.parametrize("kind", KINDS)
def test_a_mesh_with_one_triangle_turned_is_refused(tmp_path, kind):
    whole = block()
    faces = np.array(whole.faces)
    faces[4] = faces[4][::-1]
    sentence = refusal(written(tmp_path, kind, trimesh.Trimesh(whole.vertices, faces)))
    assert "inconsistently along 3 of the mesh's 18 edges" in sentence


def test_one_body_inside_out_beside_another_is_refused(tmp_path):
    astray = trimesh.creation.box((50.0, 50.0, 50.0))
    astray.invert()
    astray.apply_translation((300.0, 0.0, 0.0))
    path = tmp_path / "two.stl"
    trimesh.util.concatenate([block(), astray]).export(path)
    assert "1 of the mesh's 2 bodies are inside out" in refusal(path)


def test_flat_and_collapsed_meshes_are_refused(tmp_path):
    square = "v 0 0 0\nv 90 0 0\nv 90 90 0\nf 1 2 3\nf 1 3 2\n"
    assert "flat" in refusal(saved(tmp_path, "flat.obj", square))
    point = "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\nf 1 3 2\n"
    assert "no volume" in refusal(saved(tmp_path, "point.obj", point))


@pytest.mark.parametrize(
    ("side", "unit"), [(0.5, "mm"), (60000.0, "mm"), (300.0, "m"), (9e-4, "m")]
)
def test_a_mesh_of_absurd_size_is_refused_with_a_hint_at_the_unit(tmp_path, side, unit):
    path = written(tmp_path, "stl", trimesh.creation.box((side, side, side)))
    sentence = refusal(path, unit)
    assert "is its unit right" in sentence
    assert "expected 1 to 50000 mm" in sentence


def test_too_many_triangles_are_refused(tmp_path):
    stated = MAX_TRIANGLES + 1
    path = tmp_path / "many.stl"
    with path.open("wb") as file:
        file.write(b"\0" * 80 + struct.pack("<I", stated))
        file.truncate(84 + 50 * stated)
    assert "2000001 triangles, expected at most 2000000" in refusal(path)


def test_a_file_over_the_size_limit_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "huge.ply"
    with path.open("wb") as file:
        file.truncate(mesh_files.MAX_BYTES + 1)
    assert "256 MB" in refusal(path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.stl")
    assert "not a file" in refusal(tmp_path / "pipe.stl")


@pytest.mark.parametrize(
    ("line", "number"),
    [
        ("v 1 2", 9),
        ("v 1 2 1_000", 9),
        ("v 1 2 \uff11", 9),
        ("f 1 2", 9),
        ("f 1 2 x", 9),
        ("f 1 2 -99", 9),
        ("f 0 1 2", 9),
    ],
)
def test_a_bad_line_of_an_obj_is_named(tmp_path, line, number):
    cube = "v 0 0 0\nv 90 0 0\nv 0 90 0\nv 0 0 90\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    assert f", line {number}: " in refusal(saved(tmp_path, "cube.obj", cube + line + "\n"))


def test_an_obj_face_beyond_the_last_vertex_is_refused(tmp_path):
    text = "v 0 0 0\nv 90 0 0\nv 0 90 0\nv 0 0 90\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 5\n"
    assert "names vertex 5 but the file has 4" in refusal(saved(tmp_path, "cube.obj", text))


OUTSIDE = ["../secret.bin", "/etc/passwd", "C:\\secret", "http://example.org/a", "a/../../b", "~/a"]


@pytest.mark.parametrize("name", OUTSIDE)
def test_references_outside_the_folder_are_refused(tmp_path, name):
    inner = tmp_path / "inner"
    inner.mkdir()
    path = written(inner, "gltf", block())
    tree = json.loads(path.read_text())
    for key in ("buffers", "images"):
        changed = json.loads(path.read_text())
        changed[key] = [{**tree["buffers"][0], "uri": name}]
        sentence = refusal(saved(inner, f"{key}.gltf", json.dumps(changed)))
        assert "own folder" in sentence
    path = written(inner, "obj", block())
    path.write_text(f"mtllib {name}\n" + path.read_text())
    assert "line 1: it refers to" in refusal(path)


@pytest.mark.skipif(not hasattr(os, "symlink") or os.name == "nt", reason="symbolic links")
def test_a_link_that_leads_outside_the_folder_is_refused(tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    path = written(inner, "gltf", block())
    tree = json.loads(path.read_text())
    buffer = inner / tree["buffers"][0]["uri"]
    buffer.rename(tmp_path / "elsewhere.bin")
    buffer.symlink_to(tmp_path / "elsewhere.bin")
    assert "own folder" in refusal(path)


def changed_gltf(folder, change):
    path = written(folder, "gltf", block())
    tree = json.loads(path.read_text())
    change(tree)
    path.write_text(json.dumps(tree))
    return path


GLTF_CHANGES = {
    "extensions": lambda tree: tree.update(extensionsRequired=["KHR_draco_mesh_compression"]),
    "version": lambda tree: tree["asset"].update(version="1.0"),
    "skinned": lambda tree: tree.update(skins=[{"joints": [0]}]),
    "primitive": lambda tree: tree["meshes"][0]["primitives"][0].update(mode=1),
    "sparse": lambda tree: [part.pop("bufferView") for part in tree["accessors"]],
    "rows": lambda tree: [part.update(count=10**12) for part in tree["accessors"]],
    "two parents": lambda tree: tree["nodes"][0].update(children=[0]),
    "does not exist": lambda tree: tree["buffers"][0].update(uri="absent.bin"),
    "base64": lambda tree: tree["buffers"][0].update(uri="data:a;base64,???"),
    "truncated": lambda tree: tree["buffers"][0].update(byteLength=10**9),
    "no triangles": lambda tree: tree.update(meshes=[]),
    "no valid glTF": lambda tree: tree.update(nodes=None),
}


@pytest.mark.parametrize("word", GLTF_CHANGES)
def test_a_gltf_that_cannot_be_taken_at_its_word_is_refused(tmp_path, word):
    assert word in refusal(changed_gltf(tmp_path, GLTF_CHANGES[word]))


@pytest.mark.parametrize("text", ["vertex 8", "vertex -8", "vertex 999999999", "vertex 9"])
def test_a_ply_that_states_another_number_of_vertices_is_refused(tmp_path, text):
    for kind in ("ply", "ascii.ply"):
        path = written(tmp_path, kind, block())
        data = path.read_bytes()
        changed = data.replace(b"element vertex 8", b"element " + text.encode())
        if changed == data:
            continue
        path.write_bytes(changed)
        refusal(path)


def test_more_bodies_than_a_scene_can_hold_are_refused(tmp_path):
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    shifts = np.stack(np.meshgrid(*[np.arange(11) * 2.0] * 3), axis=-1).reshape(-1, 1, 3)
    many = trimesh.Trimesh(
        (vertices + shifts).reshape(-1, 3),
        (faces + 4 * np.arange(len(shifts))[:, None, None]).reshape(-1, 3),
        process=False,
    )
    assert "1331 bodies, expected at most 1000" in refusal(written(tmp_path, "stl", many))
