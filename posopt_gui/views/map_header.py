"""The row over the map: what it is coloured by, which page, which lines, and its tools."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QAction, QStandardItemModel
from PySide6.QtWidgets import QHBoxLayout, QLabel, QMenu, QSizePolicy, QToolButton, QWidget

from posopt_gui.look import Look
from posopt_gui.viewmodels.map_colours import LAYER_CHOICES, LAYER_LABELS, Layer
from posopt_gui.viewmodels.map_lines import CONSTANT, LINE_NAMES
from posopt_gui.viewmodels.map_model import BEST_OF_ALL, Choice, MapModel, Page
from posopt_gui.viewmodels.map_readings import degrees
from posopt_gui.views.quiet_editors import QuietCombo
from solver.model.settings import Scheme
from solver.transforms import FloatArray

COMPARABLE = (Scheme.EXACT.value, Scheme.F.value, Scheme.F1.value, Scheme.F2.value, CONSTANT)

LAYER_WIDTH, PAGE_WIDTH = 230, 290
"""Widths of the choices where there is room [px]."""

LEAST_LENGTH, PAGE_LENGTH = 8, 15
"""Widest characters that are seen of a choice where there is none: of a page, its whole name."""

SAME_ANGLE = 1e-6
"""Angles of two sweeps that differ by less are the same [deg]."""


class MapHeader(QWidget):
    """Choices about the map; it knows no session."""

    layer_changed = Signal()
    choice_changed = Signal()
    lines_changed = Signal()
    forbid_toggled = Signal(bool)
    fit_wanted = Signal()

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._pages: tuple[Page, ...] = ()
        self._plan_page: tuple[int, int] | None = None
        self._model: MapModel | None = None
        self.layer_box, self.page_box = QuietCombo(self), QuietCombo(self)
        self.lead_box, self.spin_box = QuietCombo(self), QuietCombo(self)
        self._labels = {box: QLabel(self) for box in self._boxes()}
        self._lines_button, self.fit_button = QToolButton(self), QToolButton(self)
        self.forbid_button = QToolButton(self)
        self.forbid_button.setCheckable(True)
        self._menu = QMenu(self)
        self.line_actions: dict[str, QAction] = {}
        self.edges_action = QAction(self)
        self._fill_menu()
        self._lay_out()
        for box, width in ((self.layer_box, LAYER_WIDTH), (self.page_box, PAGE_WIDTH)):
            box.setSizeAdjustPolicy(
                QuietCombo.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
            )
            box.setMinimumContentsLength(PAGE_LENGTH if box is self.page_box else LEAST_LENGTH)
            box.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
            box.setMaximumWidth(width)
            box.view().setMinimumWidth(width)
        for layer in Layer:
            self.layer_box.addItem("", layer)
        self.layer_box.currentIndexChanged.connect(self.layer_changed)
        for box in (self.page_box, self.lead_box, self.spin_box):
            box.currentIndexChanged.connect(self.choice_changed)
        self.forbid_button.toggled.connect(self.forbid_toggled)
        self.fit_button.clicked.connect(self.fit_wanted)
        self.retranslate()

    def _boxes(self) -> tuple[QuietCombo, ...]:
        return self.layer_box, self.page_box, self.lead_box, self.spin_box

    def _fill_menu(self) -> None:
        for key in COMPARABLE:
            action = QAction(self)
            action.setCheckable(True)
            action.toggled.connect(self.lines_changed)
            self._menu.addAction(action)
            self.line_actions[key] = action
        self._menu.addSeparator()
        self.edges_action.setCheckable(True)
        self.edges_action.toggled.connect(self.lines_changed)
        self._menu.addAction(self.edges_action)
        self._lines_button.setMenu(self._menu)
        self._lines_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)

    def _lay_out(self) -> None:
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 4, 8, 2)
        layout.setSpacing(6)
        for box in self._boxes():
            label = self._labels[box]
            label.setBuddy(box)
            layout.addWidget(label)
            # The page has the longest names.
            layout.addWidget(box, {self.layer_box: 3, self.page_box: 4}.get(box, 0))
            layout.addSpacing(6)
        layout.addStretch(0)
        for button in (self._lines_button, self.forbid_button, self.fit_button):
            button.setAutoRaise(True)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            layout.addWidget(button)

    @property
    def layer(self) -> Layer:
        """What the cells are coloured by."""
        found = self.layer_box.currentData()
        return found if isinstance(found, Layer) else Layer.OUTCOME

    @property
    def choice(self) -> Choice:
        """The page, lead and spin that are shown."""
        place = self.page_box.currentIndex()
        if not 0 <= place < len(self._pages):
            return BEST_OF_ALL
        page = self._pages[place]
        return Choice(page.slot, page.turn, self.lead_box.currentData(),
                      self.spin_box.currentData())  # fmt: skip

    @property
    def page(self) -> Page | None:
        """The shown page, None for the best of all."""
        place = self.page_box.currentIndex()
        found = self._pages[place] if 0 <= place < len(self._pages) else None
        return found if found is not None and found.slot is not None else None

    @property
    def lines(self) -> tuple[str, ...]:
        """The lines that are to be compared."""
        return tuple(key for key, action in self.line_actions.items() if action.isChecked())

    def set_layer(self, layer: Layer) -> None:
        """Colour the cells by something else."""
        self.layer_box.setCurrentIndex(self.layer_box.findData(layer))

    def set_page(self, slot: int | None, turn: int | None) -> None:
        """Show another page; None and None is the best of all."""
        for place, page in enumerate(self._pages):
            if (page.slot, page.turn) == (slot, turn):
                self.page_box.setCurrentIndex(place)

    def set_lines(self, keys: Sequence[str]) -> None:
        """Choose the lines to compare."""
        for key, action in self.line_actions.items():
            with QSignalBlocker(action):
                action.setChecked(key in keys)
        self.lines_changed.emit()

    def set_model(self, model: MapModel | None) -> None:
        """Offer the pages of other candidates; what was chosen stays where it can."""
        chosen, page, before = self.choice, self.page, self._model
        self._model = model
        self._pages = model.pages if model is not None else ()
        if before is not None and model is not None:
            chosen = carried(chosen, page, before, model)
        self._fill_boxes(chosen)

    def set_plan_page(self, slot: int, turn: int) -> None:
        """Mark the page on which the chosen line runs."""
        if self._plan_page != (slot, turn):
            self._plan_page = (slot, turn)
            for place, page in enumerate(self._pages):
                self.page_box.setItemText(place, self._page_text(page))

    def set_plan_known(self, has_plan: bool, has_exact: bool) -> None:
        """Switch off what needs a plan."""
        model = self.layer_box.model()
        if not isinstance(model, QStandardItemModel):
            return
        for place in range(self.layer_box.count()):
            layer = self.layer_box.itemData(place)
            needs = has_exact if layer is Layer.EXTRA_COST else has_plan
            free = layer in {Layer.OUTCOME, Layer.CLEARANCE, Layer.MANIPULABILITY}
            free |= layer is Layer.LIMIT_MARGIN
            model.item(place).setEnabled(bool(free or needs))
        self.line_actions[Scheme.EXACT.value].setEnabled(has_exact)

    def _fill_boxes(self, chosen: Choice) -> None:
        for box in self._boxes()[1:]:
            with QSignalBlocker(box):
                box.clear()
        model = self._model
        with QSignalBlocker(self.page_box):
            for place, page in enumerate(self._pages):
                self.page_box.addItem(self._page_text(page))
                if (page.slot, page.turn) == (chosen.slot, chosen.turn):
                    self.page_box.setCurrentIndex(place)
        for box, angles, wanted in (
            (self.lead_box, model.leads if model is not None else (), chosen.lead),
            (self.spin_box, model.spins if model is not None else (), chosen.spin),
        ):
            several = len(angles) > 1
            self._labels[box].setVisible(several)
            box.setVisible(several)
            if not several:
                continue
            with QSignalBlocker(box):
                box.addItem(self._look.tr("best"), None)
                for place, angle in enumerate(angles):
                    box.addItem(degrees(float(angle), 1), place)
                box.setCurrentIndex(
                    wanted + 1 if wanted is not None and wanted < len(angles) else 0
                )

    def _page_text(self, page: Page) -> str:
        tr = self._look.tr
        if page.slot is None:
            return tr("Best of all branches")
        text = tr("Branch {number} ({letters})", number=page.branch, letters=page.letters)
        turns = {one.turn for one in self._pages if one.slot == page.slot}
        if len(turns) > 1:
            text += " · " + tr("turn {number}", number=(page.turn or 0) + 1)
        if self._plan_page == (page.slot, page.turn):
            text += " · " + tr("the plan")
        return text + " · " + tr("{count} poses", count=f"{page.nodes:,}")

    def retranslate(self) -> None:
        """Set all texts again."""
        tr = self._look.tr
        for place in range(self.layer_box.count()):
            layer = self.layer_box.itemData(place)
            self.layer_box.setItemText(place, tr(LAYER_CHOICES[layer]))
            self.layer_box.setItemData(place, tr(LAYER_LABELS[layer]), Qt.ItemDataRole.ToolTipRole)
        titles = {
            self.layer_box: (tr("Colour"), tr("What the cells are coloured by")),
            self.page_box: (tr("Page"), tr("Branch and turn of the arm that the map shows")),
            self.lead_box: (tr("Lead"), tr("Lead angle that the map shows")),
            self.spin_box: (tr("Spin"), tr("Spin angle that the map shows")),
        }
        for box, (title, tip) in titles.items():
            self._labels[box].setText(title)
            box.setToolTip(tip)
            box.setAccessibleName(tip)
        for key, action in self.line_actions.items():
            action.setText(tr(LINE_NAMES[key]))
        self.edges_action.setText(tr("edges at the cursor"))
        self._lines_button.setText(tr("Lines"))
        self._lines_button.setToolTip(tr("Sequences to compare with the plan"))
        self.forbid_button.setText(tr("Forbid"))
        self.forbid_button.setToolTip(
            tr("Draw a rectangle that no sequence may pass (X, or drag with the right button)")
        )
        self.fit_button.setText(tr("Show all"))
        wheel = tr("The wheel zooms the waypoints, with Shift the leans, with Ctrl both.")
        self.fit_button.setToolTip(tr("Show all waypoints and leans") + "\n" + wheel)
        self._fill_boxes(self.choice)


def carried(chosen: Choice, page: Page | None, before: MapModel, model: MapModel) -> Choice:
    """What was chosen among other candidates: the same branch and angles, wherever they stand."""
    same = [
        one for one in model.pages
        if page is not None and (one.branch, one.turn) == (page.branch, page.turn)
    ]  # fmt: skip
    slot, turn = (same[0].slot, same[0].turn) if same else (None, None)
    lead = _place_of_same(before.leads, chosen.lead, model.leads)
    return Choice(slot, turn, lead, _place_of_same(before.spins, chosen.spin, model.spins))


def _place_of_same(before: FloatArray, place: int | None, now: FloatArray) -> int | None:
    """Where an angle of one sweep stands in another, None where it does not."""
    if place is None or place >= len(before):
        return None
    found = np.flatnonzero(np.isclose(now, before[place], rtol=0.0, atol=SAME_ANGLE))
    return int(found[0]) if len(found) else None
