"""A cell whose workpiece is a mesh: it plans like a box, and what needs a beam is refused."""

import numpy as np
import pytest
import trimesh
from catalog_mutations import changed, document, refusal, shipped

from solver.candidates.generate import generate
from solver.candidates.outcomes import Outcome
from solver.catalog import load_cell
from solver.errors import InputError
from solver.model.toolpath import Frame
from solver.pipeline.planning import plan
from solver.units import MM

SIZE = (1000.0, 10.0, 270.0)  # the web of an HW300 without its flanges [mm]
WORKPIECE = {
    "name": "plate", "group": "upper_face", "mesh": "slab.stl", "unit": "mm",
    "position_mm": [900, -200, 600], "wpr_deg": [90, 0, 90], "frame": "floor",
}  # fmt: skip
PATH = {
    "file": "path.csv", "frame": "floor", "orientation_wpr_deg": [0, 150, 0],
    "orientation_frame": "floor", "touches": "upper_face", "feed_mm_s": 20,
}  # fmt: skip
SETTINGS = {"lean_deg": [8, 16, 2], "branches": [0], "safety_distance_mm": 20}
SURFACE, BALL = 605.0, 8.0  # height of the slab's upper face in floor, radius of the ball [mm]


class Cell:
    """Writes a cell with the slab, its mesh and a path of four points, changed as asked."""

    def __init__(self, folder):
        self.folder = folder
        trimesh.creation.box(SIZE).export(folder / "slab.stl")
        trimesh.creation.box(np.array(SIZE) / 1000).export(folder / "slab_in_metres.stl")
        trimesh.creation.box((20.0, 20.0, 20.0)).export(folder / "cube.stl")
        self.tree = shipped("cells", "groove_hw300")
        del self.tree["beam"]
        self.tree |= {"workpiece": WORKPIECE, "path": PATH, "settings": SETTINGS}

    def write(self, changes=(), lift=0.0):
        rows = [f"950,{y},{SURFACE + BALL + lift}\n" for y in (-300, -290, -280, -270)]
        (self.folder / "path.csv").write_text("x_mm,y_mm,z_mm\n" + "".join(rows))
        tree = self.tree
        for path, value in changes:
            tree = changed(tree, path, value)
        file = self.folder / "cell.toml"
        file.write_text(document(tree), encoding="utf-8")
        return file


@pytest.fixture
def cell(tmp_path):
    return Cell(tmp_path)


def test_a_mesh_is_one_placed_body_in_its_group(cell):
    piece = load_cell(cell.write()).workpiece
    assert (piece.name, piece.groups, piece.section) == ("plate", ("upper_face",), None)
    assert piece.length == 0.0
    floor = piece.bodies[0].shape.vertices @ piece.placement[:3, :3].T + piece.placement[:3, 3]
    np.testing.assert_allclose(floor.min(axis=0), (0.765, -0.7, 0.595), atol=1e-7)
    np.testing.assert_allclose(floor.max(axis=0), (1.035, 0.3, 0.605), atol=1e-7)


def test_group_unit_frame_and_orientation_have_defaults(cell):
    bare = {"name": "plate", "mesh": "slab.stl", "position_mm": [1, 2, 3]}
    piece = load_cell(cell.write([(("workpiece",), bare), (("path", "touches"), None)])).workpiece
    assert piece.groups == ("plate",)
    np.testing.assert_allclose(piece.placement[:3, 3], (0.001, 0.002, 0.003), atol=1e-15)
    np.testing.assert_array_equal(piece.placement[:3, :3], np.eye(3))


@pytest.mark.parametrize(
    "changes",
    [
        {"mesh": "slab_in_metres.stl", "unit": "m"},
        {"frame": "fanuc_world", "position_mm": [900, -200, 75]},
    ],
)
def test_unit_and_frame_are_those_that_the_cell_states(cell, changes):
    expected = load_cell(cell.write()).workpiece
    piece = load_cell(cell.write([(("workpiece",), WORKPIECE | changes)])).workpiece
    np.testing.assert_allclose(piece.placement, expected.placement, atol=1e-12)
    vertices = [np.sort(one.bodies[0].shape.vertices, axis=0) for one in (piece, expected)]
    np.testing.assert_allclose(*vertices, atol=1e-7)


def test_a_file_in_the_frame_of_the_workpiece_is_placed_with_it(cell):
    file = cell.write([(("path", "frame"), "beam")])
    # Workpiece x, y, z along floor y, z, x.
    (cell.folder / "path.csv").write_text("x_mm,y_mm,z_mm\n-100,13,50\n-70,13,50\n")
    problem = load_cell(file)
    assert problem.toolpath.frame is Frame.BEAM
    np.testing.assert_allclose(
        problem.waypoint_poses[:, :3, 3] + (0, 0, 0.525),
        [(0.95, -0.3, 0.613), (0.95, -0.27, 0.613)],
        atol=1e-12,
    )
    in_floor = load_cell(cell.write())
    np.testing.assert_allclose(problem.waypoint_poses[0], in_floor.waypoint_poses[0], atol=1e-12)


def test_a_cell_with_a_mesh_plans_and_its_ball_touches_what_the_pass_names(cell):
    result = plan(load_cell(cell.write()))
    assert result.clearance_met
    assert len(result.sequences[result.scheme].nodes) == 4


def test_the_ball_may_neither_touch_an_unnamed_mesh_nor_enter_it_deeply(cell):
    for changes, lift in (([(("path", "touches"), None)], 0.0), ([], -0.6), ([], -30.0)):
        counts = generate(load_cell(cell.write(changes, lift))).counts()
        assert counts[Outcome.FEASIBLE] == 0
    assert generate(load_cell(cell.write(lift=-0.4))).counts()[Outcome.FEASIBLE] > 0


def test_a_mesh_gives_the_clearance_of_the_box_that_it_is(cell):
    """The ball passes 3 mm above the slab, so that a fixture need not be touched either."""
    meshed = generate(load_cell(cell.write(lift=3.0)))
    elsewhere = WORKPIECE | {"mesh": "cube.stl", "position_mm": [-3000, 3000, 3000]}
    box = {"name": "slab", "shape": "box", "min_mm": [765, -700, 595], "max_mm": [1035, 300, 605]}
    fixtures = [*cell.tree["fixtures"], box]
    changes = [(("workpiece",), elsewhere), (("fixtures",), fixtures)]
    boxed = generate(load_cell(cell.write(changes, lift=3.0)))
    assert np.array_equal(meshed.outcome, boxed.outcome)
    kept = boxed.outcome == Outcome.FEASIBLE
    assert kept.sum() >= 10
    np.testing.assert_allclose(meshed.clearance[kept], boxed.clearance[kept], atol=0.2 * MM)
    without = generate(load_cell(cell.write(changes[:1], lift=3.0)))
    assert np.nanmin(without.clearance[kept] - boxed.clearance[kept]) > 1.0 * MM


FACE = {"face": "web_left", "from_along_mm": -100, "to_along_mm": 100, "points": 5}
REFUSED = {
    "beam beside it": (("beam",), {"section": "HW300"}, "workpiece: expected no second workpiece"),
    "no table": (("workpiece",), 3, "workpiece: expected a table"),
    "no name": (("workpiece", "name"), None, "workpiece.name: the key is missing"),
    "no mesh": (("workpiece", "mesh"), None, "workpiece.mesh: the key is missing"),
    "no position": (("workpiece", "position_mm"), None, "position_mm: the key is missing"),
    "mesh is a number": (("workpiece", "mesh"), 7, "workpiece.mesh: expected a text"),
    "unit": (("workpiece", "unit"), "inch", "workpiece.unit: expected one of 'mm', 'm'"),
    "frame": (("workpiece", "frame"), "beam", "workpiece.frame: expected one of 'floor'"),
    "two numbers": (("workpiece", "position_mm"), [1, 2], "workpiece.position_mm: expected"),
    "not finite": (("workpiece", "wpr_deg"), [0, 0, float("inf")], "workpiece.wpr_deg"),
    "group": (("workpiece", "group"), "a b", "workpiece.group: expected a name"),
    "named floor": (("workpiece", "name"), "floor", "workpiece.name: the name 'floor' is kept"),
    "in floor": (("workpiece", "group"), "floor", "workpiece.group: the name 'floor' is kept"),
    "key of a beam": (("workpiece", "length_mm"), 1000, "workpiece.length_mm: unknown key"),
    "other group": (("path", "touches"), "web", "path.touches: expected one of 'upper_face'"),
    "line": (
        ("path",),
        {"line": FACE | {"from_share": 0, "to_share": 0}},
        "path.line: workpiece plate is a mesh",
    ),
    "passes": (
        ("path",),
        {"parametric": FACE | {"offset_mm": 30}},
        "path.parametric: workpiece plate is a mesh",
    ),
}


@pytest.mark.parametrize(("path", "value", "said"), REFUSED.values(), ids=REFUSED)
def test_a_malformed_workpiece_is_refused_with_its_key(cell, path, value, said):
    error = refusal(load_cell, cell.write([(path, value)]))
    assert said in str(error)
    assert error.place.key


@pytest.mark.parametrize("name", ["none.stl", "open.stl", "cell.toml", "empty.stl"])
def test_an_unusable_mesh_is_refused_with_its_file(cell, name):
    solid = trimesh.creation.box(SIZE)
    solid.update_faces(np.arange(12) > 0)
    solid.export(cell.folder / "open.stl")
    (cell.folder / "empty.stl").touch()
    with pytest.raises(InputError) as caught:
        load_cell(cell.write([(("workpiece", "mesh"), name)]))
    assert caught.value.place.file == str(cell.folder / name)


def test_another_beam_cannot_replace_a_mesh(cell):
    with pytest.raises(InputError, match=r"cell\.toml, key workpiece: the workpiece is a mesh"):
        load_cell(cell.write(), beam="HW250")
