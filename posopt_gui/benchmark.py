"""How fast the window is: start-up, first plan, frames, latency of a drag, gaps of the event loop.

``python -m posopt_gui.benchmark [--json FILE]`` needs a display. Every run is a process of its own,
so that starting is measured as a person meets it; the caches of the kernels should be warm. What
is asked for is stated in docs/window_performance.md; nothing here judges it.
"""

from __future__ import annotations

import argparse
import json
import math
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QSettings, QStandardPaths, Qt, QTimer
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from posopt_gui.event_loop import EventLoopGaps
from solver.units import MS_PER_S

if TYPE_CHECKING:
    from posopt_gui.main_window import MainWindow

PATIENCE: Final = 300.0
"""How long anything may take before the benchmark gives up [s]."""

PLANS, DRAGS, HOVERS, FRAMES, SWITCHES = 7, 14, 40, 120, 6
PLAYED: Final = 3.0
"""How long the playback runs [s]."""

WORDS: Final[Mapping[str, str]] = {
    "median_ms": "median [ms]",
    "longest_ms": "longest [ms]",
    "count": "of",
    "count_from_50_ms": "gaps of 50 ms and more",
    "rate": "[1/s]",
}

Table = dict[str, dict[str, float]]


class _Paints(QObject):
    """Counts the paintings of one widget."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self.count = 0
        widget.installEventFilter(self)

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        """Count, and let the event pass."""
        self.count += event.type() == QEvent.Type.Paint
        return False


def _live_until(condition: Callable[[], object]) -> None:
    """Run the event loop until something holds."""
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError("the window did not get there")
        QApplication.processEvents()
        time.sleep(0.0005)


def _live_for(seconds: float) -> None:
    end = time.monotonic() + seconds
    _live_until(lambda: time.monotonic() >= end)


def _times(seconds: Sequence[float]) -> dict[str, float]:
    """Median and longest [ms]."""
    return {
        "median_ms": statistics.median(seconds) * MS_PER_S,
        "longest_ms": max(seconds) * MS_PER_S,
        "count": float(len(seconds)),
    }


class Measuring:
    """One run: a window is opened, and what a person does most is measured in it."""

    def __init__(self, cell: str | None, began: float, folder: Path) -> None:
        from posopt_gui import start  # noqa: PLC0415 - its time belongs to the start

        self.found: Table = {}
        self._began = began
        self._application = start.application()
        # The own data of whoever measures stays out of it.
        QStandardPaths.setTestModeEnabled(True)
        settings = QSettings(str(folder / "settings.ini"), QSettings.Format.IniFormat)
        self.window: MainWindow = start.make_window(cell, None, None, settings)
        self.session = self.window.session
        self.gaps = EventLoopGaps()

    def _since_start(self, name: str) -> None:
        self.found[name] = _times([time.monotonic() - self._began])

    def _end_gaps(self, name: str) -> None:
        self.gaps.stop()
        self.found[name] = {
            "longest_ms": self.gaps.longest * MS_PER_S,
            "count_from_50_ms": float(self.gaps.count),
        }

    def start(self) -> None:
        """Open the window as the application does."""
        from posopt_gui.start import begin  # noqa: PLC0415 - its time belongs to the start

        window, session = self.window, self.session
        paints = _Paints(window)
        results: list[int] = []
        session.result_changed.connect(lambda: results.append(1))
        window.show()
        _live_until(lambda: paints.count and window.windowHandle().isExposed())
        self._since_start("start: frame of the window shown")
        self.gaps.start()
        window.ready.connect(lambda: self._since_start("start: panels built"))
        QTimer.singleShot(0, lambda: begin(window))
        _live_until(lambda: results)
        self._since_start("start: first plan")
        _live_until(lambda: "start: panels built" in self.found)
        painted = _Paints(window.map.canvas.viewport())
        window.map.canvas.viewport().update()
        _live_until(lambda: painted.count)
        self._since_start("start: first plan painted")
        _live_until(lambda: session.report is not None)
        self._since_start("start: program checked")
        if window.scene.canvas is not None:
            _live_until(lambda: window.scene.drawn)
            self._since_start("start: 3D drawn")
        self._end_gaps("gaps: start")
        window.hints.close_all()
        _live_for(1.0)

    def plan(self) -> None:
        """Plan again, all kernels loaded."""
        results: list[float] = []
        self.session.result_changed.connect(lambda: results.append(time.perf_counter()))
        times = []
        self.gaps.start()
        for _ in range(PLANS):
            results.clear()
            begin = time.perf_counter()
            self.window.actions_table["plan"].trigger()
            _live_until(lambda: results)
            times.append(results[0] - begin)
            _live_until(lambda: self.session.report is not None)
        self._end_gaps("gaps: plan")
        self.found["plan: action to result"] = _times(times)

    def drag(self) -> None:
        """Drag the line; from the mouse to the new line on screen."""
        session, canvas = self.session, self.window.map.canvas
        paints = _Paints(canvas.viewport())
        results: list[int] = []
        session.result_changed.connect(lambda: results.append(1))
        waypoint = session.waypoints // 2
        leans = self._feasible_leans(waypoint)
        here = float(canvas.line[waypoint])
        self._mouse(QEvent.Type.MouseMove, waypoint, here)
        self._mouse(QEvent.Type.MouseButtonPress, waypoint, here)
        far = sorted(leans, key=lambda lean: -abs(lean - here))
        times = []
        self.gaps.start()
        for number in range(DRAGS):
            lean = far[number % len(far)]
            results.clear()
            begin = time.perf_counter()
            self._mouse(QEvent.Type.MouseMove, waypoint, lean)
            _live_until(lambda: results)
            before = paints.count
            canvas.viewport().update()
            _live_until(lambda before=before: paints.count > before)  # type: ignore[misc]
            times.append(time.perf_counter() - begin)
        self._mouse(QEvent.Type.MouseButtonRelease, waypoint, here)
        self._end_gaps("gaps: drag")
        self.found["drag: mouse to new line"] = _times(times)
        session.document.undo()
        _live_for(0.5)

    def _feasible_leans(self, waypoint: int) -> list[float]:
        result = self.session.result
        assert result is not None
        nodes = result.candidates.nodes
        here = (nodes.candidate[:, 0] == waypoint) & (nodes.clearance >= result.hard_minimum)
        leans = result.candidates.orientations[nodes.candidate[here, 1], 0]
        return sorted({round(math.degrees(lean), 6) for lean in leans.tolist()})

    def _mouse(self, kind: QEvent.Type, waypoint: int, lean: float) -> None:
        from posopt_gui.views.map_interaction import Cell  # noqa: PLC0415

        canvas = self.window.map.canvas
        model, port = canvas.model, canvas.viewport()
        assert model is not None
        local = QPointF(canvas.place_of(Cell(waypoint, model.row_of(lean))))
        left, none = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
        button = none if kind == QEvent.Type.MouseMove else left
        held = none if kind == QEvent.Type.MouseButtonRelease else left
        event = QMouseEvent(
            kind, local, QPointF(port.mapToGlobal(local)), button, held,
            Qt.KeyboardModifier.NoModifier,
        )  # fmt: skip
        QApplication.sendEvent(port, event)

    def hover(self) -> None:
        """Point at one pose after the other; from the mouse to the card on screen."""
        canvas = self.window.map.canvas
        _live_until(lambda: self.window.map.pointing.explains)
        paints = _Paints(canvas.viewport())
        times = []
        for number in range(HOVERS):
            before = paints.count
            begin = time.perf_counter()
            place = QPoint(60 + 9 * number, canvas.height() // 3 + number % 7)
            local = QPointF(place)
            none = Qt.MouseButton.NoButton
            event = QMouseEvent(
                QEvent.Type.MouseMove, local, QPointF(canvas.viewport().mapToGlobal(local)),
                none, none, Qt.KeyboardModifier.NoModifier,
            )  # fmt: skip
            QApplication.sendEvent(canvas.viewport(), event)
            canvas.viewport().update()
            _live_until(lambda before=before: paints.count > before)  # type: ignore[misc]
            times.append(time.perf_counter() - begin)
        self.window.map.pointing.point(None, QPoint())
        self.found["hover: mouse to card"] = _times(times)

    def frames(self) -> None:
        """Move the cursor along the path, a frame of everything for each place."""
        canvas = self.window.scene.canvas
        watched: QWidget = canvas if canvas is not None else self.window.map.canvas.viewport()
        paints = _Paints(watched)
        times = []
        last = self.session.waypoints - 1
        for number in range(FRAMES):
            before = paints.count
            begin = time.perf_counter()
            self.session.set_place(last * (number + 0.5) / FRAMES)
            _live_until(lambda before=before: paints.count > before)  # type: ignore[misc]
            times.append(time.perf_counter() - begin)
        self.found["frame: place to map, curves and 3D"] = _times(times)

    def playback(self) -> None:
        """Play at the pace of the program."""
        self.session.set_cursor(0)
        places: list[float] = []
        self.session.place_changed.connect(places.append)
        self.gaps.start()
        self.window.timeline.playback.play()
        _live_for(PLAYED)
        self.window.timeline.playback.pause()
        self._end_gaps("gaps: playback")
        self.found["playback: frames a second"] = {"rate": len(places) / PLAYED}

    def pan(self) -> None:
        """Pan and zoom the map; the curves follow."""
        from posopt_gui.benchmark_panning import pan_and_zoom  # noqa: PLC0415

        paints = _Paints(self.window.map.canvas.viewport())

        def frame(step: Callable[[], object]) -> float:
            before, begin = paints.count, time.perf_counter()
            step()
            _live_until(lambda: paints.count > before)
            return time.perf_counter() - begin

        self.gaps.start()
        found = pan_and_zoom(self.window, frame, lambda: _live_for(0.5))
        self._end_gaps("gaps: panning and zooming")
        self.found |= {name: _times(times) for name, times in found.items()}

    def look(self) -> None:
        """Switch theme and language; from the choice to all of it painted."""
        window, look = self.window, self.session.look
        paints = [_Paints(one) for one in (window, window.scene.canvas) if one is not None]
        switches: tuple[tuple[str, Callable[[bool], None]], ...] = (
            ("theme", lambda dark: look.set_theme("dark" if dark else "light")),
            ("language", lambda other: look.set_language("zh_CN" if other else "en")),
        )
        for name, switch in switches:
            times = []
            self.gaps.start()
            for number in range(SWITCHES):
                begin = time.perf_counter()
                switch(number % 2 == 0)
                _live_until(lambda: not window.look_switch.going_on)
                before = [one.count for one in paints]
                _live_until(
                    lambda before=before: all(  # type: ignore[misc]
                        one.count > old for one, old in zip(paints, before, strict=True)
                    )
                )
                times.append(time.perf_counter() - begin)
            self._end_gaps(f"gaps: {name}")
            self.found[f"switch: {name}"] = _times(times)

    def close(self) -> None:
        """Close the window; nothing is asked, since nothing was changed."""
        self.session.document.mark_saved()
        self.window.close()


def _child(options: argparse.Namespace) -> int:
    with tempfile.TemporaryDirectory() as folder:
        run = Measuring(options.cell, options.began, Path(folder))
        run.start()
        if options.whole:
            for part in (
                run.plan, run.drag, run.hover, run.frames, run.playback, run.pan, run.look
            ):  # fmt: skip
                part()
        run.close()
    from posopt_gui.views.opengl import renderer  # noqa: PLC0415 - after all that is measured

    sys.stdout.write(json.dumps({"renderer": renderer(), "found": run.found}) + "\n")
    return 0


def _run(cell: str | None, *, whole: bool) -> dict[str, Any]:
    arguments = ["--child", "--began", repr(time.monotonic()), *(["--whole"] if whole else [])]
    command = [sys.executable, "-m", "posopt_gui.benchmark", *arguments]
    if cell is not None:
        command += ["--cell", cell]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().rpartition("\n")[2] or "the window did not start")
    answer: dict[str, Any] = json.loads(done.stdout.strip().rpartition("\n")[2])
    return answer


def measure(cell: str | None, repeats: int) -> dict[str, Any]:
    """Start `repeats` times, the last time with everything else; starts are merged."""
    runs = [_run(cell, whole=number == repeats - 1) for number in range(repeats)]
    found: Table = runs[-1]["found"]
    for name in [name for name in found if name.startswith("start:")]:
        times = [run["found"][name]["median_ms"] / MS_PER_S for run in runs]
        found[name] = _times(times)
    return {
        "cell": cell or "groove_hw300",
        "system": f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
        "renderer": runs[-1]["renderer"],
        "measures": found,
    }


def lines(report: Mapping[str, Any]) -> list[str]:
    """The report as a table in words."""
    shown = [f"{report['cell']} on {report['system']}, {report['renderer'] or 'no OpenGL'}"]
    for name, values in report["measures"].items():
        words = ", ".join(f"{WORDS[key]} {one:.1f}" for key, one in values.items())
        shown.append(f"{name:42s} {words}")
    return shown


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser("posopt_gui.benchmark", description="speed of the window")
    parser.add_argument("--json", metavar="FILE", help="write the figures to a file as well")
    parser.add_argument("--cell", help="the cell that is opened; by default the window's own")
    parser.add_argument("--repeats", type=int, default=3, help="how often the start is measured")
    for hidden in ("--child", "--whole"):
        parser.add_argument(hidden, action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--began", type=float, default=0.0, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.child:
        return _child(options)
    try:
        report = measure(options.cell, max(options.repeats, 1))
    except RuntimeError as error:
        sys.stderr.write(f"posopt_gui.benchmark: {error}\n")
        return 1
    sys.stdout.write("\n".join(lines(report)) + "\n")
    if options.json:
        text = json.dumps(report, indent=1) + "\n"
        Path(options.json).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
