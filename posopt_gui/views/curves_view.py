"""Curves of the plan and its references over the waypoints, with one cursor through all."""

from __future__ import annotations

import math

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QScrollArea,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.controllers.comparison import Comparison
from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.curves_model import (
    PLAN,
    Track,
    first_of_passes,
    joint_words,
    kind_label,
    limit_words,
    measure_rows,
    place_on_path,
    sequence_track,
    step_range,
)
from posopt_gui.viewmodels.number_words import decimal
from posopt_gui.views.change_bars import ChangeBars
from posopt_gui.views.curve_legend import CurveLegend
from posopt_gui.views.curve_plots import (
    BOTTOM_AXIS,
    JOINT_COLOURS,
    LIMIT_COLOUR,
    PlotStock,
    WaypointPlot,
    fit_joint,
    step_words,
)
from posopt_gui.views.feed_plot import FeedPanel
from posopt_gui.views.limit_gauge import LimitGauge
from posopt_gui.views.measures_table import MeasuresTable
from posopt_gui.views.refresh import Refresh
from solver.units import DEG_PER_RAD, MM_PER_M

ROW = 16
"""Least height of a joint's row [px]."""

GAUGED, PLAIN = 6, 4
"""Plots with a gauge, of the joints, and without."""


class CurvesView(QWidget):
    """Tabs of curves; `x_range_changed` and `set_x_range` link them with the map."""

    x_range_changed = Signal(float, float)

    def __init__(
        self,
        session: Session,
        comparison: Comparison | None = None,
        parent: QWidget | None = None,
        *,
        stock: PlotStock | None = None,
    ) -> None:
        super().__init__(parent)
        self._session = session
        self._tr = session.look.tr
        self.comparison = comparison or Comparison(session, self)
        self._plan: Track | None = None
        self._starts: tuple[int, ...] = ()
        self._opacity = 1.0
        self._count = 0
        stock = stock or PlotStock(session.look.theme)
        self.joint_plots = tuple(stock.take(gauged=True) for _ in range(GAUGED))
        self.gauges = tuple(LimitGauge() for _ in range(GAUGED))
        self.clearance_plot, self.manipulability_plot, self.step_plot, feed_plot = (
            stock.take(gauged=False) for _ in range(PLAIN)
        )
        self.feed = FeedPanel(session, feed_plot)
        self.bars = ChangeBars()
        self.table = MeasuresTable()
        self.legend = CurveLegend(self._tr)
        self._drawing = Refresh(session, self._draw, self)
        self._results = Refresh(session, self._on_result, self)
        self._checks = Refresh(session, self.feed.update_report, self)
        self._lay_out()
        self._connect()
        self.retheme()
        self.retranslate()

    @property
    def plots(self) -> tuple[WaypointPlot, ...]:
        """All plots over the waypoints."""
        return (
            *self.joint_plots,
            self.clearance_plot,
            self.manipulability_plot,
            self.step_plot,
            self.feed.plot,
        )

    @property
    def plot_items(self) -> tuple[pg.PlotItem, ...]:
        """The plots whose x axis is the waypoint, for linking."""
        return tuple(plot.getPlotItem() for plot in self.plots)

    def _lay_out(self) -> None:
        self._rows = QWidget()
        self._rows.setObjectName("joint_rows")
        column = QVBoxLayout(self._rows)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(1)
        for plot, gauge in zip(self.joint_plots, self.gauges, strict=True):
            line = QHBoxLayout()
            line.setSpacing(0)
            line.addWidget(plot, 1)
            line.addWidget(gauge)
            column.addLayout(line, 1)
        self._scroll = QScrollArea()
        self._scroll.setWidget(self._rows)
        self._scroll.setWidgetResizable(True)
        self._scroll.setFrameShape(QFrame.Shape.NoFrame)
        self._scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._scroll.viewport().installEventFilter(self)
        self.tabs = QTabWidget()
        self.tabs.setDocumentMode(True)
        self.tabs.tabBar().setDrawBase(False)
        # All seven names beside the legend in the smallest window.
        self.tabs.setStyleSheet("QTabBar::tab { padding: 6px 4px; }")
        for page in (
            self._scroll, self.clearance_plot, self.manipulability_plot, self.step_plot,
            self.feed, self.bars, self.table,
        ):  # fmt: skip
            self.tabs.addTab(page, "")
        self.tabs.setCornerWidget(self.legend)
        self.tabs.setUsesScrollButtons(True)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.tabs)

    def _connect(self) -> None:
        session = self._session
        for plot in self.plots:
            plot.place_wanted.connect(self._on_place_wanted)
            plot.x_range_changed.connect(self._on_x_range)
        for plot in self.joint_plots:
            # Rows take other heights only after their least heights; the curves have to fit them.
            plot.getPlotItem().getViewBox().sigResized.connect(self._drawing.soon)
        self.legend.changed.connect(self._draw)
        self.tabs.currentChanged.connect(self._on_tab)
        self.comparison.changed.connect(self._drawing.soon)
        session.result_changed.connect(self._results.soon)
        session.place_changed.connect(self._on_place)
        session.check_changed.connect(self._checks.soon)
        session.stale_changed.connect(self._on_stale)
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)

    def retranslate(self) -> None:
        """Set all texts again."""
        tr = self._tr
        titles = (
            tr("Joints"), tr("Clearance"), tr("Manipulability"), tr("Step"), tr("Feed"),
            tr("Change"), tr("Measures"),
        )  # fmt: skip
        tips = (
            tr("Pendant joints J1 to J6 with their limits"),
            tr("Distance of robot and tool to workpiece and fixtures"),
            tr("How far the posture is from a singularity"),
            tr("How far each joint moves from waypoint to waypoint"),
            tr("Speed of the TCP that the joints allow, against the asked feed"),
            tr("Cumulative change of each joint"),
            tr("Amplitude, standard deviation and gains over the references"),
        )
        self.tabs.tabBar().setAccessibleName(tr("Curves"))
        for joint, plot in enumerate(self.joint_plots, start=1):
            plot.setAccessibleName(f"J{joint}")
        named = (self.clearance_plot, self.manipulability_plot, self.step_plot, self.feed.plot)
        for plot, title in zip(named, titles[1:], strict=False):
            plot.setAccessibleName(title)
        for index, (title, tip) in enumerate(zip(titles, tips, strict=True)):
            self.tabs.setTabText(index, title)
            self.tabs.setTabToolTip(index, tip)
        self.clearance_plot.setLabel("left", tr("clearance, mm"))
        self.manipulability_plot.setLabel("left", tr("manipulability, m³"))
        self.step_plot.setLabel("left", tr("step, °"))
        for plot in (self.clearance_plot, self.manipulability_plot, self.step_plot):
            plot.setLabel("bottom", tr("Waypoint"))
        self.legend.retranslate()
        self._fit_legend()
        self.feed.retranslate()
        self._on_result()

    def retheme(self) -> None:
        """Set all colours again."""
        theme = self._session.look.theme
        for plot in self.plots:
            plot.set_theme(theme)
        self.bars.set_theme(theme)
        self._rows.setStyleSheet(f"#joint_rows {{ background: {theme.border}; }}")
        for gauge in self.gauges:
            gauge.set_theme(theme)
        self.legend.set_theme(theme)
        self.table.set_theme(theme)
        self._on_result()

    def set_x_range(self, low: float, high: float) -> None:
        """Show these waypoints (numbers from 1) in all plots."""
        for plot in self.plots:
            plot.set_x_range(low, high)

    def _on_x_range(self, low: float, high: float) -> None:
        self.set_x_range(low, high)
        self.x_range_changed.emit(low, high)

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        """Draw what came while this was hidden."""
        super().showEvent(event)
        self._drawing.soon()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Keep the room for the words when the plots change their height."""
        super().resizeEvent(event)
        self._fit_legend()
        self._drawing.soon()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        """Share the height among the joints anew once they are laid out."""
        if (
            isinstance(event, QResizeEvent)
            and event.type() is QEvent.Type.Resize
            and event.size().height() != event.oldSize().height()
        ):
            self._drawing.soon()
        return super().eventFilter(watched, event)

    def _fit_legend(self) -> None:
        self.legend.fit(self.width() - self.tabs.tabBar().sizeHint().width() - 8)

    def _on_tab(self, index: int) -> None:
        self.legend.show_joints(self.tabs.currentWidget() is self._scroll)
        self.legend.setVisible(self.tabs.currentWidget() not in (self.feed, self.table))
        self._fit_legend()
        self._draw()

    def _on_place_wanted(self, axis: float) -> None:
        self._session.set_place(place_on_path(axis, self._session.waypoints))

    def _on_result(self) -> None:
        result, sequence = self._session.result, self._session.sequence
        theme = self._session.look.theme
        if result is None or sequence is None:
            self._plan, self._starts = None, ()
        else:
            self._plan = sequence_track(result.problem, sequence)
            self._starts = first_of_passes(result.problem)
        count = self._session.waypoints
        for plot in self.plots:
            plot.set_borders(self._starts, theme)
            plot.set_count(count)
        if count and count != self._count:
            self.set_x_range(0.5, count + 0.5)
        self._count = count
        self.feed.update_report()
        self._drawing.soon()
        self._on_stale()

    def _on_stale(self, *_: object) -> None:
        opacity = 0.45 if self._session.stale else 1.0
        if opacity == self._opacity:
            return
        self._opacity = opacity
        for plot in self.plots:
            plot.getPlotItem().setOpacity(opacity)

    def _tracks(self) -> list[Track]:
        shown = self.legend.shown
        references = [one for one in self.comparison.tracks if one.name in shown]
        return [*([self._plan] if self._plan is not None else []), *references]

    def _draw(self) -> None:
        """Draw the tab that is looked at; the others are drawn when they are opened."""
        self.legend.set_known([one.name for one in self.comparison.tracks])
        if not self.isVisible():
            return
        page = self.tabs.currentWidget()
        if page is self._scroll:
            self._draw_joints()
        elif page is self.clearance_plot:
            self._draw_clearance()
        elif page is self.manipulability_plot:
            self._draw_manipulability()
        elif page is self.step_plot:
            self._draw_steps()
        elif page is self.bars:
            self.bars.set_tracks(self._tracks(), self._session.look.theme, self._tr)
        elif page is self.table:
            everything = self.comparison.tracks
            rows = measure_rows(self._plan, everything, self._tr) if self._plan else []
            self.table.set_rows(rows)
        self._on_place(self._session.place)

    def _draw_joints(self) -> None:
        theme, tracks = self._session.look.theme, self._tracks()
        result = self._session.result
        for joint, plot in enumerate(self.joint_plots):
            plot.setVisible(joint in self.legend.joints)
            self.gauges[joint].setVisible(joint in self.legend.joints)
            curves = {one.name: one.joints[:, joint] for one in tracks}
            plot.set_curves(curves, self._starts, theme)
            if result is None or self._plan is None:
                # The gauge stays, empty: without its width the plots would leave the map's axis.
                plot.set_ticks(())
                self.gauges[joint].clear()
                continue
            limits = result.problem.joint_limits[joint] * DEG_PER_RAD
            plot.set_bands((float(limits[0]), float(limits[1])), LIMIT_COLOUR)
            fit_joint(plot, list(curves.values()), limits, whole=self.legend.whole_limits)
            self.gauges[joint].set_used(limits, self._plan.joints[:, joint])
        shown = [plot for joint, plot in enumerate(self.joint_plots) if joint in self.legend.joints]
        room = self._scroll.viewport().height() - BOTTOM_AXIS
        # All curves are equally high; the last one has the numbers below it besides.
        row = max(ROW, room // max(len(shown), 1) - 1)
        for plot, gauge in zip(self.joint_plots, self.gauges, strict=True):
            last = bool(shown) and plot is shown[-1]
            plot.getPlotItem().showAxis("bottom", last)
            plot.setMinimumHeight(row + (BOTTOM_AXIS if last else 0))
            gauge.set_below(float(BOTTOM_AXIS if last else 0))

    def _draw_clearance(self) -> None:
        result = self._session.result
        curves = {one.name: one.clearance for one in self._tracks()}
        level = result.problem.settings.safety_distance * MM_PER_M if result else None
        words = self._tr("safety distance {value} mm", value=f"{level or 0.0:.1f}")
        self._draw_level(self.clearance_plot, curves, level, words)

    def _draw_manipulability(self) -> None:
        result = self._session.result
        curves = {one.name: one.manipulability for one in self._tracks()}
        level = result.problem.settings.manipulability if result else None
        words = self._tr("least allowed {value} m³", value=f"{level or 0.0:g}")
        self._draw_level(self.manipulability_plot, curves, level, words)

    def _draw_level(
        self, plot: WaypointPlot, curves: dict[str, np.ndarray], level: float | None, words: str
    ) -> None:
        theme = self._session.look.theme
        plot.set_curves(curves, self._starts, theme)
        plot.set_level(level, theme.error, words)
        plot.fit_from_zero(curves.values(), level)

    def _draw_steps(self) -> None:
        theme, plot = self._session.look.theme, self.step_plot
        tracks = self._tracks()
        totals = {one.name: one.steps.sum(axis=1) for one in tracks if one.name != PLAN}
        plot.set_stack(self._plan.steps if self._plan else np.zeros((0, 6)), JOINT_COLOURS)
        plot.set_curves(totals, self._starts, theme)
        top, beyond = step_range(tracks)
        plot.setYRange(0.0, 1.25 * top, padding=0.0)
        words = ", ".join(f"{kind_label(self._tr, name)} ↑ {high:.1f}°" for name, high in beyond)
        plot.set_beyond(words, theme.muted)

    def _on_place(self, place: float) -> None:
        """Follow the place; words that are hidden do so when their tab is opened."""
        for plot in self.plots:
            plot.set_place(place)
        self.feed.show_readout(self._session.cursor)
        plan, result = self._plan, self._session.result
        if plan is None or result is None or self._session.cursor >= len(plan.joints):
            planning = self._session.planning
            words = self._tr("Planning…") if planning else self._tr("There is no plan.")
            for plot in self.plots:
                plot.set_readout("" if plot in self.joint_plots[1:] else words)
            return
        at = self._session.cursor
        if self.tabs.currentWidget() is self._scroll:
            self._show_joints(plan, at, result.problem.joint_limits * DEG_PER_RAD)
            return
        number = self._tr("waypoint {number}", number=at + 1)
        clearance = decimal(math.floor(float(plan.clearance[at]) * 10.0 + 1e-7) / 10.0, 1)
        self.clearance_plot.set_readout(f"{number} · {clearance} mm")
        self.manipulability_plot.set_readout(f"{number} · {plan.manipulability[at]:.4f} m³")
        self.step_plot.set_readout(f"{number} · {step_words(plan.steps[at])}")

    def _show_joints(self, plan: Track, at: int, limits: np.ndarray) -> None:
        for joint, (plot, gauge) in enumerate(zip(self.joint_plots, self.gauges, strict=True)):
            value = float(plan.joints[at, joint])
            plot.set_readout(joint_words(joint + 1, value))
            gauge.setToolTip(limit_words(self._tr, joint + 1, value, limits[joint]))
            gauge.set_value(plan.joints[at, joint])
