"""A mouse over the map, as Qt sends it."""

from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent

from posopt_gui.views.map_interaction import Cell

LEFT, RIGHT, PLAIN = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton, Qt.KeyboardModifier(0)


class Mouse:
    """A mouse over the cells; its events are sent, so that the real pointer has no part in it."""

    def __init__(self, qapp, view):
        self._qapp, self.view = qapp, view
        self.port = view.canvas.viewport()
        self._held = Qt.MouseButton.NoButton

    def place(self, waypoint, lean):
        model = self.view.canvas.model
        return self.view.canvas.place_of(Cell(waypoint, model.row_of(lean)))

    def _send(self, kind, button, waypoint, lean):
        local = QPointF(self.place(waypoint, lean))
        place = QPointF(self.port.mapToGlobal(local))
        event = QMouseEvent(kind, local, place, button, self._held, PLAIN)
        self._qapp.sendEvent(self.port, event)

    def move(self, waypoint, lean):
        self._send(QEvent.Type.MouseMove, Qt.MouseButton.NoButton, waypoint, lean)

    def press(self, waypoint, lean, button=LEFT):
        self._held = button
        self._send(QEvent.Type.MouseButtonPress, button, waypoint, lean)

    def release(self, waypoint, lean, button=LEFT):
        self._held = Qt.MouseButton.NoButton
        self._send(QEvent.Type.MouseButtonRelease, button, waypoint, lean)

    def click(self, waypoint, lean, button=LEFT):
        self.press(waypoint, lean, button)
        self.release(waypoint, lean, button)

    def double_click(self, waypoint, lean):
        self.click(waypoint, lean)
        self._send(QEvent.Type.MouseButtonDblClick, LEFT, waypoint, lean)
        self.release(waypoint, lean)
