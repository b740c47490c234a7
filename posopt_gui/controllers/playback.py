"""Playback of the sequence: the place on the path as it would be reached at the feed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QElapsedTimer, QObject, Qt, QTimer, Signal

from solver.model.problem import PlanningProblem
from solver.transforms import FloatArray
from solver.units import MS_PER_S

if TYPE_CHECKING:
    from posopt_gui.controllers.session import Session

FRAME = 33
"""Time between two frames [ms]."""

LONGEST_FRAME = 0.25
"""A frame that took longer than this counts as this long [s], so that nothing is jumped over."""

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Paces of the playback against the program's."""

LINK_SHARE = 0.2
"""Share of the joint speeds on links where the cell says nothing."""

LEAST_STEP = 1e-3
"""Least time between two waypoints [s]."""


def waypoint_times(problem: PlanningProblem, pendant: FloatArray | None) -> FloatArray:
    """(n,) when each waypoint is reached [s]: path length over feed, links at their joint speed.

    `pendant` (n, 6) are the joints of the sequence [rad]; without them a link takes as long as
    its chord at the feed.
    """
    positions = problem.toolpath.poses[:, :3, 3]
    index = problem.toolpath.pass_index
    feeds = np.array([one.feed for one in problem.toolpath.passes])[index[1:]]
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1) / feeds
    links = index[1:] != index[:-1]
    if pendant is not None and len(pendant) == len(positions):
        settings = problem.program.links
        share = settings.percent / 100.0 if settings is not None else LINK_SHARE
        slowest = (np.abs(np.diff(pendant, axis=0)) / problem.robot.speeds).max(axis=1)
        steps[links] = slowest[links] / share
    return np.concatenate([[0.0], np.cumsum(np.maximum(steps, LEAST_STEP))])


class PlaybackController(QObject):
    """Moves the session's place in time; it knows no widgets.

    Whoever else moves the place moves the playback with it.
    """

    playing_changed = Signal(bool)
    speed_changed = Signal(float)
    loop_changed = Signal(bool)
    times_changed = Signal()

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._times = np.zeros(1)
        self._time = 0.0
        self._speed = 1.0
        self._loop = self._linked = False
        self._moving = False
        self._clock = QElapsedTimer()
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(FRAME)
        self._timer.timeout.connect(self._tick)
        session.place_changed.connect(self._on_place)
        session.result_changed.connect(self._on_result)
        session.problem_changed.connect(self._on_result)
        self._on_result()

    @property
    def playing(self) -> bool:
        """Whether it runs."""
        return self._timer.isActive()

    @property
    def speed(self) -> float:
        """Pace against the program's."""
        return self._speed

    @property
    def loop(self) -> bool:
        """Whether it begins again at the end."""
        return self._loop

    @property
    def time(self) -> float:
        """Time since the first waypoint [s]."""
        return self._time

    @property
    def duration(self) -> float:
        """Time of the whole path [s]."""
        return float(self._times[-1])

    @property
    def linked(self) -> bool:
        """Whether the way leads over links between passes."""
        return self._linked

    @property
    def times(self) -> FloatArray:
        """(n,) when each waypoint is reached [s]."""
        return self._times

    def play(self) -> None:
        """Run from here, or from the beginning when at the end."""
        if self.playing or len(self._times) < 2:
            return
        if self._time >= self.duration:
            self._go(0.0)
        self._clock.start()
        self._timer.start()
        self.playing_changed.emit(True)

    def pause(self) -> None:
        """Stop, at the nearer waypoint: between two there is nothing that the plan states."""
        if self.playing:
            self._timer.stop()
            self.settle()
            self.playing_changed.emit(False)

    def settle(self) -> None:
        """Go to the nearer waypoint, where the place is between two."""
        self._session.set_place(float(round(self._session.place)))

    def toggle(self) -> None:
        """Play or pause."""
        if self.playing:
            self.pause()
        else:
            self.play()

    def step_forward(self) -> None:
        """To the next waypoint."""
        self._step_to(np.floor(self._session.place + 1e-9) + 1.0)

    def step_back(self) -> None:
        """To the waypoint before."""
        self._step_to(np.ceil(self._session.place - 1e-9) - 1.0)

    def to_start(self) -> None:
        """To the first waypoint."""
        self._step_to(0.0)

    def to_end(self) -> None:
        """To the last waypoint."""
        self._step_to(len(self._times) - 1.0)

    def set_speed(self, speed: float) -> None:
        """Change the pace, within those that are offered."""
        speed = min(max(speed, SPEEDS[0]), SPEEDS[-1])
        if speed != self._speed:
            self._speed = speed
            self.speed_changed.emit(speed)

    def set_loop(self, loop: bool) -> None:
        """Begin again at the end, or stop there."""
        if loop != self._loop:
            self._loop = loop
            self.loop_changed.emit(loop)

    def advance(self, seconds: float) -> None:
        """Go on by so much time of the program [s]; at the end stop or begin again."""
        target = self._time + seconds
        if target < self.duration:
            self._go(target)
        elif self._loop and self.duration > 0.0:
            self._go(target % self.duration)
        else:
            self._go(self.duration)
            self.pause()

    def _tick(self) -> None:
        passed = min(self._clock.restart() / MS_PER_S, LONGEST_FRAME)
        self.advance(passed * self._speed)

    def _step_to(self, place: float) -> None:
        self.pause()
        self._session.set_place(float(place))

    def _go(self, time: float) -> None:
        self._time = time
        self._moving = True
        place = np.interp(time, self._times, np.arange(len(self._times)))
        self._session.set_place(float(place))
        self._moving = False

    def _on_place(self, place: float) -> None:
        if not self._moving:
            self._time = float(np.interp(place, np.arange(len(self._times)), self._times))

    def _on_result(self) -> None:
        session = self._session
        result = session.result
        problem = result.problem if result is not None else session.problem
        sequence = session.sequence
        if problem is None:
            self.pause()
            self._times = np.zeros(1)
        else:
            self._times = waypoint_times(problem, sequence.pendant if sequence else None)
            self._linked = len(problem.toolpath.passes) > 1
        self._on_place(session.place)
        self.times_changed.emit()
