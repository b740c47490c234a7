"""Beside the tabs of the curves: what is drawn, with a sample of each line, and what is hidden."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from PySide6.QtCore import QPointF, QSize, Qt, Signal
from PySide6.QtGui import QAction, QIcon, QPainter, QPixmap
from PySide6.QtWidgets import QHBoxLayout, QLabel, QMenu, QToolButton, QWidget

from posopt_gui.theme import LIGHT, Theme
from posopt_gui.viewmodels.curves_model import PLAN, kind_label, short_label
from posopt_gui.views.curve_plots import line_pen

SAMPLE = QSize(24, 12)
"""Size of the sample of a line [px]."""

LOW_SAMPLE = QSize(24, 4)
"""The same above its name."""

BESIDE = 10
"""Room beside a name below its sample: border and padding [px]."""

UNBOUND = 16_777_215
"""Qt's largest width of a widget [px]."""

ALL_JOINTS = "J1–J6"

REFERENCES = ("NOMINAL", "CONSTANT", "RANDOM")


def line_sample(name: str, theme: Theme, size: QSize = SAMPLE) -> QPixmap:
    """A short piece of a curve's line."""
    scale = 3
    pixmap = QPixmap(size * scale)
    pixmap.fill(Qt.GlobalColor.transparent)
    painter = QPainter(pixmap)
    painter.scale(scale, scale)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    pen = line_pen(name, theme)
    pen.setCosmetic(False)
    painter.setPen(pen)
    middle = size.height() / 2.0
    painter.drawLine(QPointF(1.0, middle), QPointF(size.width() - 1.0, middle))
    painter.end()
    pixmap.setDevicePixelRatio(scale)
    return pixmap


class CurveLegend(QWidget):
    """Toggles of references and joints, and whether axes show the whole limits."""

    changed = Signal()

    def __init__(self, translate: Callable[..., str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._tr = translate
        self._theme: Theme = LIGHT
        self._sample = SAMPLE
        self._plan, self._plan_sample = QLabel(), QLabel()
        self._references = {name: QToolButton() for name in REFERENCES}
        self._menu_button = QToolButton()
        self._menu = QMenu(self)
        self._joints = tuple(QAction(f"J{joint}", self) for joint in range(1, 7))
        self._all = QAction(self)
        self._whole = QAction(self)
        self._fill_menu()
        self._row = row = QHBoxLayout(self)
        row.setContentsMargins(4, 0, 6, 0)
        row.setSpacing(3)
        row.addWidget(self._plan_sample)
        row.addWidget(self._plan)
        for button in self._references.values():
            button.setCheckable(True)
            button.setIconSize(SAMPLE)
            button.toggled.connect(self.changed)
            row.addWidget(button)
        self._references["NOMINAL"].setChecked(True)
        row.addWidget(self._menu_button)

    def _fill_menu(self) -> None:
        for action in self._joints:
            action.setCheckable(True)
            action.setChecked(True)
            action.triggered.connect(self._on_joint)
            self._menu.addAction(action)
        self._all.triggered.connect(self._on_all)
        self._whole.setCheckable(True)
        self._whole.toggled.connect(self.changed)
        self._menu.addSeparator()
        self._menu.addAction(self._all)
        self._menu.addAction(self._whole)
        self._menu_button.setMenu(self._menu)
        self._menu_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)

    @property
    def shown(self) -> frozenset[str]:
        """References that are drawn."""
        return frozenset(name for name, box in self._references.items() if box.isChecked())

    @property
    def joints(self) -> frozenset[int]:
        """Joints (from 0) that are drawn."""
        return frozenset(j for j, action in enumerate(self._joints) if action.isChecked())

    @property
    def whole_limits(self) -> bool:
        """Whether the axes reach from limit to limit."""
        return self._whole.isChecked()

    def set_shown(self, names: Iterable[str]) -> None:
        """Draw these references."""
        wanted = set(names)
        for name, button in self._references.items():
            button.setChecked(name in wanted)

    def set_joints(self, joints: Iterable[int]) -> None:
        """Draw these joints (from 0)."""
        wanted = set(joints)
        for joint, action in enumerate(self._joints):
            action.setChecked(joint in wanted)
        self.changed.emit()

    def set_whole_limits(self, whole: bool) -> None:
        """Let the axes reach from limit to limit, or fit the curves."""
        self._whole.setChecked(whole)

    def set_known(self, names: Iterable[str]) -> None:
        """Only these references exist; the others cannot be chosen."""
        known = set(names)
        for name, button in self._references.items():
            button.setEnabled(name in known)

    def show_joints(self, shown: bool) -> None:
        """Offer the choice of joints."""
        self._menu_button.setVisible(shown)

    def fit(self, room: int) -> None:
        """Name the lines beside their samples where there is room [px], else below them."""
        styles = Qt.ToolButtonStyle
        beside, under = styles.ToolButtonTextBesideIcon, styles.ToolButtonTextUnderIcon
        for plan, style, joints in (
            (True, beside, ALL_JOINTS), (False, beside, ALL_JOINTS), (False, under, ALL_JOINTS),
            (False, under, "J"), (False, styles.ToolButtonIconOnly, "J"),
        ):  # fmt: skip
            self._plan.setVisible(plan)
            self._plan_sample.setVisible(plan)
            for button in self._references.values():
                button.setToolButtonStyle(style)
                words = button.fontMetrics().horizontalAdvance(button.text())
                # Qt keeps more room around a name than it needs.
                button.setMaximumWidth(words + BESIDE if style is under else UNBOUND)
            self._menu_button.setText(joints)
            size = LOW_SAMPLE if style is under else SAMPLE
            if size != self._sample:
                self._sample = size
                self._show_samples()
            if self._row.sizeHint().width() <= room:
                break

    def _show_samples(self) -> None:
        for name, button in self._references.items():
            button.setIconSize(self._sample)
            button.setIcon(QIcon(line_sample(name, self._theme, self._sample)))

    def _on_joint(self) -> None:
        if not self.joints:
            self.sender().setChecked(True)  # type: ignore[attr-defined]
        self.changed.emit()

    def _on_all(self) -> None:
        self.set_joints(range(6))

    def retranslate(self) -> None:
        """Set all texts again."""
        tr = self._tr
        self._plan.setText(kind_label(tr, PLAN))
        tips = {
            "NOMINAL": tr("Every waypoint at the nominal lean of its pass"),
            "CONSTANT": tr("The best sequence with one lean at every waypoint"),
            "RANDOM": tr(
                "One draw of a random lean at every waypoint; measures are means of 100 draws"
            ),
        }
        for name, button in self._references.items():
            label = kind_label(tr, name)
            button.setText(short_label(tr, name))
            button.setToolTip(f"{tr('Compare with')}: {label}\n{tips[name]}")
            button.setAccessibleName(f"{tr('Compare with')}: {label}")
        self._menu_button.setText(ALL_JOINTS)
        self._menu_button.setToolTip(tr("Choose joints and axes"))
        self._menu_button.setAccessibleName(tr("Choose joints and axes"))
        self._all.setText(tr("All joints"))
        self._whole.setText(tr("Whole limits"))
        self._whole.setToolTip(tr("Axes from limit to limit instead of around the curves"))

    def set_theme(self, theme: Theme) -> None:
        """Set all colours again."""
        self._theme = theme
        self._plan_sample.setPixmap(line_sample(PLAN, theme))
        self._show_samples()
        self.setStyleSheet(
            'QToolButton { padding: 2px 3px; } QToolButton[popupMode="2"] { padding-right: 14px; }'
        )
