import numpy as np
import pytest
from PySide6.QtCore import Qt

from posopt_gui.dialogs.path_dialog import PathDialog
from posopt_gui.dialogs.placement_dialog import PlacementDialog
from posopt_gui.dialogs.setup_dialogs import SetupDialogs
from posopt_gui.viewmodels.path_preview import examine
from posopt_gui.viewmodels.touched_points import TouchedCorner, points_on_beam
from posopt_gui.views.setup_view import SetupView
from solver.io.importers import Source
from solver.transforms import rigid, rotation_from_wpr
from solver.units import MM_PER_M

TABLE = "A,B,C,D,E,F,note\n" + "".join(f"{10 * n},13,{40 + n},0,1,0,n{n}\n" for n in range(6))


def dialog_for(qtbot, session, text, name="other.csv"):
    state = session.document.state
    preview = examine(Source(name, text.encode()), state.cell, folder=state.folder)
    dialog = PathDialog(session, preview)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(dialog)
    dialog.show()
    return dialog


def test_columns_are_told_and_the_path_is_taken_in_one_step(qtbot, session):
    dialog = dialog_for(qtbot, session, TABLE)
    assert not dialog.accept_button.isEnabled()
    assert [dialog.column(n).value for n in range(7)] == [""] * 7
    for column, field in enumerate(("x", "y", "z", "nx", "ny", "nz")):
        dialog.set_column(column, field)
    qtbot.waitUntil(dialog.accept_button.isEnabled, timeout=60_000)
    assert len(dialog.preview.toolpath) == 6
    qtbot.mouseClick(dialog.accept_button, Qt.MouseButton.LeftButton)
    document = session.document
    assert document.value("path.file") == "other.csv"
    assert document.state.files["other.csv"].startswith(b"x,y,z,nx,ny,nz\n0,13,40,0,1,0\n")
    expected = dialog.preview.toolpath.poses
    np.testing.assert_array_equal(document.state.problem().toolpath.poses, expected)
    document.undo()
    assert not document.can_undo


def test_a_field_is_one_column_only(qtbot, session):
    dialog = dialog_for(qtbot, session, TABLE)
    dialog.set_column(0, "x")
    dialog.set_column(2, "x")
    assert dict(dialog.mapping) == {"x": 2}
    assert dialog.column(0).value == ""
    dialog.close()


def test_cancelling_changes_nothing(qtbot, session):
    dialog = dialog_for(qtbot, session, TABLE)
    dialog.set_column(0, "x")
    qtbot.mouseClick(dialog.cancel_button, Qt.MouseButton.LeftButton)
    assert not session.document.can_undo


def test_a_missing_orientation_is_stated_in_the_dialog(qtbot, session):
    dialog = dialog_for(qtbot, session, "x,y,z\n0,13,40\n10,13,41\n")
    assert "orientation" in dialog.preview.error.message
    flag = dialog.row("path.orientation").editors[0]
    qtbot.mouseClick(flag, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(dialog.accept_button.isEnabled, timeout=60_000)
    dialog.accept()
    assert session.document.value("path.orientation_wpr_deg") == [0.0, 150.0, 0.0]


def test_a_first_row_of_numbers_can_be_a_point(qtbot, session):
    dialog = dialog_for(qtbot, session, "0,13,40,0,1,0\n10,13,41,0,1,0\n20,13,42,0,1,0\n")
    assert not dialog.preview.header
    for column, field in enumerate(("x", "y", "z", "nx", "ny", "nz")):
        dialog.set_column(column, field)
    qtbot.waitUntil(dialog.accept_button.isEnabled, timeout=60_000)
    assert len(dialog.preview.toolpath) == 3
    dialog.close()


def placement_dialog(qtbot, session):
    dialog = PlacementDialog(session)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(dialog)
    dialog.show()
    return dialog


@pytest.mark.parametrize("side", ["left", "right"])
def test_three_points_place_the_beam_in_one_step(qtbot, session, side):
    dialog = placement_dialog(qtbot, session)
    assert not dialog.apply_button.isEnabled()
    section = session.document.state.problem().workpiece.section
    placement = rigid(rotation_from_wpr(1.5, 0.1, 1.6), (0.9, -0.2, 0.075))
    corner = TouchedCorner("+x", "bottom", side)
    points = points_on_beam(corner, section, 1.0) @ placement[:3, :3].T + placement[:3, 3]
    dialog.set_corner(corner)
    dialog.set_points(points * MM_PER_M)
    assert dialog.apply_button.isEnabled()
    dialog.apply()
    document = session.document
    assert document.value("beam.frame") == "fanuc_world"
    assert document.value("beam.lower_edge_mm") is None
    floor = document.state.problem().workpiece.placement
    floor_expected = placement + np.array([[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0.525], [0] * 4])
    np.testing.assert_allclose(floor, floor_expected, atol=5e-6)
    document.undo()
    assert not document.can_undo


def test_points_that_cannot_be_are_answered_by_a_sentence(qtbot, session):
    dialog = placement_dialog(qtbot, session)
    dialog.set_points(np.array([[900, -700, 75], [900, 700, 75], [700, -700, 75]]))
    assert dialog.placement is None
    assert "only 1000 mm long" in dialog.sentence
    assert not dialog.apply_button.isEnabled()


def test_points_are_typed_one_after_another(qtbot, session):
    dialog = placement_dialog(qtbot, session)
    values = ((900, -700, 75), (900, 100, 75), (700, -700, 75))
    for row, point in zip(dialog._numbers, values, strict=True):
        for editor, value in zip(row, point, strict=True):
            editor.setFocus()
            editor.selectAll()
            qtbot.keyClicks(editor, str(value))
            qtbot.keyClick(editor, Qt.Key.Key_Return)
    assert dialog.placement is not None


def test_the_panel_opens_its_dialogs(qtbot, session, tmp_path):
    view = SetupView(session)
    qtbot.addWidget(view)
    view.refresh()
    dialogs = SetupDialogs(session, view)
    view.placement_wanted.emit()
    assert dialogs.placement.isVisible()
    dialogs.placement.close()
    qtbot.waitUntil(lambda: dialogs.placement is None)
    file = tmp_path / "other.csv"
    file.write_text(TABLE)
    view.load_path(str(file))
    qtbot.waitUntil(lambda: dialogs.path is not None, timeout=60_000)
    dialogs.path.close()
    qtbot.waitUntil(lambda: dialogs.path is None)
    view.path.loader.close()
