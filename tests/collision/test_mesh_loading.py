from __future__ import annotations

import json
import logging
import subprocess
import sys

import numpy as np
import pytest
import trimesh
from trimesh.exchange import gltf, ply, stl

from solver.collision.meshes import load_mesh

PROGRAM_WITHOUT_OTHER_PACKAGES = """
import sys

class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {"scipy", "networkx", "PIL", "lxml", "rtree", "requests", "httpx"}:
            raise ModuleNotFoundError(name, name=name)

sys.meta_path.insert(0, Missing())
from solver.collision.meshes import load_mesh
assert "trimesh" not in sys.modules
for path in sys.argv[1:]:
    print(len(load_mesh(path).faces))
"""


def block():
    """A block of 100 x 200 x 300 mm, off the origin, in millimetres."""
    made = trimesh.creation.box((100.0, 200.0, 300.0))
    made.apply_translation((10.0, 20.0, 30.0))
    return made


def written(folder, kind, mesh):
    """Write a mesh as one of the formats; returns the path."""
    if kind == "ascii.stl":
        data = stl.export_stl_ascii(mesh).encode()
    elif kind == "ascii.ply":
        data = ply.export_ply(mesh, encoding="ascii")
    elif kind == "gltf":
        for name, part in gltf.export_gltf(trimesh.Scene(mesh)).items():
            (folder / name).write_bytes(part)
        return folder / "model.gltf"
    else:
        path = folder / f"part.{kind}"
        mesh.export(path)
        return path
    path = folder / f"part-{kind}"
    path.write_bytes(data)
    return path


KINDS = ("stl", "ascii.stl", "obj", "ply", "ascii.ply", "gltf", "glb")


@pytest.mark.parametrize("kind", KINDS)
def test_every_format_gives_the_same_solid_in_metres(tmp_path, kind):
    mesh = load_mesh(written(tmp_path, kind, block()), "mm")
    assert mesh.vertices.shape == (8, 3)
    assert mesh.faces.shape == (12, 3)
    assert mesh.vertices.min(axis=0) == pytest.approx([-0.04, -0.08, -0.12], abs=1e-8)
    assert mesh.vertices.max(axis=0) == pytest.approx([0.06, 0.12, 0.18], abs=1e-8)
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).volume == pytest.approx(0.006)


def test_the_unit_scales_the_mesh(tmp_path):
    path = written(tmp_path, "stl", trimesh.creation.box((1.0, 2.0, 3.0)))
    in_metres, in_millimetres = load_mesh(path, "m"), load_mesh(str(path), "mm")
    assert np.ptp(in_metres.vertices, axis=0) == pytest.approx([1.0, 2.0, 3.0])
    assert in_millimetres.vertices == pytest.approx(in_metres.vertices / 1000.0)


@pytest.mark.parametrize("kind", KINDS)
def test_a_curved_mesh_keeps_every_triangle(tmp_path, kind):
    ball = trimesh.creation.icosphere(subdivisions=3, radius=80.0)
    mesh = load_mesh(written(tmp_path, kind, ball))
    assert len(mesh.faces) == len(ball.faces)
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).volume == pytest.approx(
        ball.volume * 1e-9, rel=1e-5
    )


@pytest.mark.parametrize("kind", KINDS)
def test_a_mesh_inside_out_is_turned(tmp_path, kind):
    turned = block()
    turned.invert()
    mesh = load_mesh(written(tmp_path, kind, turned))
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).volume == pytest.approx(0.006)


@pytest.mark.parametrize("kind", ["gltf", "glb"])
def test_the_bodies_of_a_scene_become_one_mesh_where_their_nodes_place_them(tmp_path, kind):
    scene = trimesh.Scene(block())
    mirrored = np.diag([-1.0, 1.0, 1.0, 1.0])
    mirrored[0, 3] = 1000.0
    scene.add_geometry(block(), transform=mirrored)
    if kind == "gltf":
        for name, part in gltf.export_gltf(scene).items():
            (tmp_path / name).write_bytes(part)
        path = tmp_path / "model.gltf"
    else:
        path = tmp_path / "two.glb"
        scene.export(path)
    mesh = load_mesh(path)
    assert mesh.faces.shape == (24, 3)
    assert mesh.vertices[:, 0].max() == pytest.approx(1.04)
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).volume == pytest.approx(0.012)


def test_several_solids_in_an_ascii_stl_become_one_mesh(tmp_path):
    first, second = block(), block()
    second.apply_translation((500.0, 0.0, 0.0))
    path = tmp_path / "two.stl"
    text = "".join(stl.export_stl_ascii(part) for part in (first, second))
    path.write_text(text.replace("solid ", "solid vertex of a solid part"))
    assert load_mesh(path).faces.shape == (24, 3)


def test_an_ascii_stl_with_capitals_blank_lines_and_carriage_returns_is_read(tmp_path):
    text = stl.export_stl_ascii(block()).upper().replace("\n", "\r\n\r\n")
    path = tmp_path / "loud.STL"
    path.write_bytes(text.encode())
    assert load_mesh(path).faces.shape == (12, 3)


def test_a_binary_stl_whose_header_begins_with_solid_is_read(tmp_path):
    data = stl.export_stl(block())
    path = tmp_path / "solid.stl"
    path.write_bytes(b"solid made by a CAD system".ljust(80) + data[80:])
    assert load_mesh(path).faces.shape == (12, 3)


def test_an_obj_with_quads_relative_indices_normals_and_continued_lines_is_read(tmp_path):
    path = tmp_path / "cube.obj"
    path.write_text(
        "\ufeff# a cube\nmtllib colours.mtl\no cube\n"
        "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\n"
        "v 0 0 1e2\nv +100 0 100.\nv 100 100 100\nv 0 100 100 1.0\n"
        "vn 0 0 1\nvt 0 0\ns off\nusemtl red\n"
        "f 4/1/1 3/1/1 2/1/1 1/1/1\nf -4//1 -3//1 -2//1 -1//1\n"
        "f 1 2 6 \\\n 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
        encoding="utf-8",
    )
    mesh = load_mesh(path)
    assert mesh.faces.shape == (12, 3)
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).volume == pytest.approx(1e-3)


def test_an_ascii_ply_of_quads_with_comments_is_read(tmp_path):
    path = tmp_path / "cube.ply"
    path.write_text(
        "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 8\nproperty float x\n"
        "property float y\nproperty float z\nelement face 6\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0\n100 0 0\n100 100 0\n0 100 0\n0 0 100\n100 0 100\n100 100 100\n0 100 100\n"
        "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"
    )
    assert load_mesh(path).faces.shape == (12, 3)


def test_triangles_that_are_lines_are_dropped(tmp_path):
    path = tmp_path / "part.obj"
    block().export(path)
    with path.open("a") as file:
        file.write("\nf 1 1 2\nf 3 3 3\n")
    assert load_mesh(path).faces.shape == (12, 3)


def test_bodies_that_touch_along_an_edge_are_one_mesh(tmp_path):
    first, second = trimesh.creation.box((100.0,) * 3), trimesh.creation.box((100.0,) * 3)
    second.apply_translation((100.0, 100.0, 0.0))
    path = tmp_path / "pair.stl"
    trimesh.util.concatenate([first, second]).export(path)
    mesh = load_mesh(path)
    assert mesh.faces.shape == (24, 3)
    assert len(mesh.vertices) == 14


def test_a_hollow_body_keeps_its_cavity(tmp_path):
    inner = trimesh.creation.box((50.0, 50.0, 50.0))
    inner.invert()
    outer = trimesh.creation.box((100.0, 100.0, 100.0))
    path = tmp_path / "hollow.stl"
    trimesh.util.concatenate([outer, inner]).export(path)
    mesh = load_mesh(path)
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).volume == pytest.approx(1e-3 - 1.25e-4)


def test_gltf_materials_images_and_cameras_are_left_aside(tmp_path):
    path = written(tmp_path, "gltf", block())
    tree = json.loads(path.read_text())
    tree["images"] = [{"uri": "missing.png"}]
    tree["textures"] = [{"source": 0}]
    tree["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    tree["cameras"] = [{"type": "perspective"}]
    for node in tree["nodes"]:
        node["camera"] = 0
    for mesh in tree["meshes"]:
        for primitive in mesh["primitives"]:
            primitive["material"] = 0
    path.write_text(json.dumps(tree))
    assert load_mesh(path).faces.shape == (12, 3)


def test_nothing_is_logged_printed_or_left_switched_off(tmp_path, caplog, capfd):
    path = written(tmp_path, "glb", block())
    logger = logging.getLogger("trimesh")
    before = (logger.level, logger.disabled)
    with caplog.at_level(logging.DEBUG):
        load_mesh(path)
    assert not caplog.records
    assert capfd.readouterr() == ("", "")
    assert (logger.level, logger.disabled) == before


def test_loading_is_lazy_and_needs_no_package_beyond_trimesh_and_numpy(tmp_path):
    paths = [str(written(tmp_path, kind, block())) for kind in KINDS]
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", PROGRAM_WITHOUT_OTHER_PACKAGES, *paths],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == ""
    assert done.stdout.split() == ["12"] * len(KINDS)
