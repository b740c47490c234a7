"""The 3D panel as a person meets it: what is seen, clicked, switched and saved."""

import os
import subprocess
import sys
import time

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QImage

from posopt_gui.controllers.session import Hover, Session
from posopt_gui.document.document import Document
from posopt_gui.viewmodels.scene_model import joints_at
from posopt_gui.views.scene_view import NO_OPENGL, SceneView
from solver.analysis.check import down_mm
from solver.candidates.outcomes import Outcome


@pytest.fixture(scope="module")
def planned(qapp, planned_state):
    """One planned session for all tests here, left as it was by each."""
    made = Session(Document(planned_state))
    made.start()
    wait(qapp, lambda: made.result is not None and made.report is not None)
    yield made
    assert made.close()


@pytest.fixture(scope="module")
def panel(qapp, planned):
    made = SceneView(planned)
    made.resize(800, 520)
    made.show()
    wait(qapp, lambda: made.drawn and made.report is not None)
    yield made
    made.close()
    made.deleteLater()
    qapp.processEvents()


@pytest.fixture
def view(panel, planned):
    panel.resize(800, 520)
    planned.set_place(0.0)
    panel.look_from("Overview")
    return panel


def wait(qapp, until, seconds=120.0):
    end = time.monotonic() + seconds
    while not until():
        qapp.processEvents()
        assert time.monotonic() < end, "waited in vain"


def pixels(image: QImage) -> np.ndarray:
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    raw = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1, 4)
    return raw[:, : image.width(), 2::-1].astype(int)


def yellow(image: QImage) -> np.ndarray:
    red, green, blue = np.moveaxis(pixels(image), 2, 0)
    return (red > 120) & (green > 90) & (blue < 60) & (red - blue > 90)


def place_of(view: SceneView, point) -> QPoint:
    """Pixel of a point by the matrices that it is drawn with."""
    canvas = view.canvas
    size = canvas.size()
    matrix = canvas.projectionMatrix(canvas.getViewport(), canvas.getViewport())
    matrix = np.array((matrix * canvas.viewMatrix()).data()).reshape(4, 4).T
    x, y, _, w = matrix @ np.append(point, 1.0)
    return QPoint(
        round((x / w + 1.0) / 2.0 * size.width()), round((1.0 - y / w) / 2.0 * size.height())
    )


def test_a_yellow_robot_stands_in_the_middle_of_the_picture(view):
    found = yellow(view.grab_image())
    rows, columns = np.nonzero(found)
    assert found.mean() > 0.01
    assert found.shape[1] * 0.1 < columns.mean() < found.shape[1] * 0.9
    assert np.ptp(rows) > found.shape[0] * 0.3


def test_the_pose_follows_the_place_and_no_mesh_is_made_anew(qtbot, view, planned):
    before = list(view.canvas.items)
    first = view.grab_image()
    for place in (0.5, 12.25, 30.0):
        planned.set_place(place)
    picture = view.grab_image()
    assert list(view.canvas.items) == before
    assert np.count_nonzero(pixels(first) != pixels(picture)) > 1000
    expected = joints_at(planned.sequence.pendant, 30.0)
    assert view.canvas._joints == pytest.approx(expected)


def test_the_number_at_the_line_is_the_clearance_of_the_plan_rounded_down(view, planned):
    planned.set_cursor(7)
    expected = down_mm(float(planned.sequence.clearance[7]))
    assert float(view.canvas._distance.text.removesuffix(" mm")) == pytest.approx(expected, abs=0.1)
    assert f"{view.report.millimetres}" in view._note.text()
    assert "not checked" in view._note.text()


def test_of_a_stale_plan_no_clearance_is_shown(qtbot, view, planned):
    planned.document.set_value("settings.safety_distance_mm", 40.0, "Safety distance")
    assert planned.stale
    planned.turns.finish()
    assert view.report is None
    assert view.canvas._distance.text == ""
    planned.document.undo()
    planned.turns.finish()
    assert view.report is not None


def test_a_click_on_a_waypoint_selects_it(qtbot, view, planned):
    view.look_from("Top view")
    point = view._cell.path.points[33]
    where = place_of(view, point)
    qtbot.mouseClick(view.canvas, Qt.MouseButton.LeftButton, pos=where)
    assert abs(planned.cursor - 33) <= 1


def test_dragging_turns_the_camera_and_selects_nothing(qtbot, view, planned):
    planned.set_cursor(5)
    view.look_from("Top view")
    before = view.canvas.camera.azimuth
    where = place_of(view, view._cell.path.points[33])
    qtbot.mousePress(view.canvas, Qt.MouseButton.LeftButton, pos=where)
    qtbot.mouseMove(view.canvas, where + QPoint(40, 0))
    qtbot.mouseRelease(view.canvas, Qt.MouseButton.LeftButton, pos=where + QPoint(40, 0))
    assert planned.cursor == 5
    assert view.canvas.camera.azimuth != before


@pytest.mark.parametrize("outcome", [Outcome.FEASIBLE, Outcome.COLLISION])
def test_the_hovered_candidate_appears_as_a_ghost_and_goes_again(view, planned, outcome):
    plain = pixels(view.grab_image())
    found = np.argwhere(planned.result.candidates.outcome == outcome)
    waypoint, orientation, branch = map(int, found[len(found) // 2])
    planned.set_hover(Hover(waypoint, orientation, branch))
    ghostly = pixels(view.grab_image())
    assert np.count_nonzero(np.abs(ghostly - plain).max(axis=2) > 8) > 500
    planned.set_hover(None)
    assert np.array_equal(pixels(view.grab_image()), plain)


@pytest.mark.parametrize("part", ["path", "trail", "clearance", "bodies", "frames"])
def test_every_part_can_be_switched(view, part):
    view.look_from("Close-up" if part in ("path", "trail") else "Overview")
    before = pixels(view.grab_image())
    view.tools.show_part(part, not view.tools.shown[part])
    after = pixels(view.grab_image())
    assert np.count_nonzero(before != after) > 20
    view.tools.show_part(part, not view.tools.shown[part])
    assert np.array_equal(pixels(view.grab_image()), before)


def test_the_keys_one_to_six_choose_the_camera_and_f_fits(qtbot, view):
    view.activateWindow()
    view.setFocus()
    qtbot.waitUntil(view.isActiveWindow)
    seen = set()
    for key in range(Qt.Key.Key_1, Qt.Key.Key_6 + 1):
        qtbot.keyClick(view, Qt.Key(key))
        camera = view.canvas.camera
        seen.add((round(camera.azimuth, 3), round(camera.elevation, 3)))
    assert len(seen) == 6
    view.canvas.opts["distance"] = 30.0
    qtbot.keyClick(view, Qt.Key.Key_F)
    assert view.canvas.camera.distance < 10.0


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_background_is_that_of_the_theme(view, planned, theme):
    planned.look.set_theme(theme)
    planned.turns.finish()
    corner = pixels(view.grab_image())[5, 5]
    assert list(corner) == list(QColor(planned.look.theme.scene).getRgb()[:3])
    planned.look.set_theme("light")
    planned.turns.finish()


def test_the_picture_is_written_to_a_file_and_a_failure_is_said(qtbot, view, planned, tmp_path):
    file = tmp_path / "cell.png"
    assert view.save_picture(file)
    assert QImage(str(file)).size() == view.grab_image().size()
    with qtbot.waitSignal(planned.message) as said:
        assert not view.save_picture(tmp_path / "missing" / "cell.png")
    assert said.args[0].severity == "error"


def test_another_beam_is_drawn_while_the_old_plan_stays(qtbot, view, planned):
    corners = view._cell.fixed.bounds
    planned.document.set_value("beam.length_mm", 1400.0, "Length")
    qtbot.waitUntil(lambda: view.drawn and not np.allclose(view._cell.fixed.bounds, corners))
    assert np.ptp(view._cell.fixed.bounds[:, 1]) == pytest.approx(1.4)
    planned.document.undo()
    qtbot.waitUntil(lambda: view.drawn and np.allclose(view._cell.fixed.bounds, corners))


def test_all_texts_change_with_the_language(view, planned):
    english = view._note.text(), [one.text() for one in view.tools.actions()]
    planned.look.set_language("zh_CN")
    planned.turns.finish()
    chinese = view._note.text(), [one.text() for one in view.tools.actions()]
    planned.look.set_language("en")
    planned.turns.finish()
    assert (view._note.text(), [one.text() for one in view.tools.actions()]) == english
    assert all(one != other for one, other in zip(english[1], chinese[1], strict=True))
    assert not any(word in chinese[0] for word in ("Clearance", "spindle", "flange", "Cable"))


def test_a_narrow_panel_has_one_menu_for_all_parts(view):
    for width in (800, 340, 800):
        view.resize(width, 400)
        bar = view.tools
        assert bar.geometry().left() >= 0
        assert bar.geometry().right() < width


def test_without_opengl_a_sentence_stands_in_its_place(qtbot, planned, monkeypatch):
    monkeypatch.setattr("posopt_gui.views.scene_view.is_available", lambda: False)
    view = SceneView(planned)
    qtbot.addWidget(view)
    view.resize(600, 400)
    view.show()
    qtbot.waitExposed(view)
    planned.set_place(3.5)
    planned.set_hover(Hover(3, 0, 0))
    planned.set_hover(None)
    view.look_from("Front view")
    view.fit()
    assert view.canvas is None
    assert view._sentence.text() == NO_OPENGL
    assert view._sentence.isVisible()
    assert not view.tools.isVisible()
    assert view.grab_image().width() >= 600


OFFSCREEN = """
from PySide6.QtWidgets import QApplication
app = QApplication(["offscreen"])
from posopt_gui.controllers.session import Session
from posopt_gui.document.document import Document
from posopt_gui.document.project import state_of_cell
from posopt_gui.views.scene_view import NO_OPENGL, SceneView
session = Session(Document(state_of_cell("groove_hw300")))
view = SceneView(session)
view.show()
for _ in range(20):
    app.processEvents()
assert view.canvas is None and view._sentence.text() == NO_OPENGL
assert session.close()
print("shown without OpenGL")
"""


def test_a_screenless_platform_gets_the_sentence_and_no_crash():
    done = subprocess.run(
        [sys.executable, "-c", OFFSCREEN],
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen", "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "shown without OpenGL" in done.stdout


def test_closing_while_the_cell_is_being_built_is_quiet(qtbot, planned):
    for _ in range(5):
        view = SceneView(planned)
        view.show()
        qtbot.waitExposed(view)
        qtbot.wait(1)
        view.close()
        view.deleteLater()
        planned.set_place(planned.place + 0.5)
    assert planned.sequence is not None
