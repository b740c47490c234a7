import numpy as np
import pytest
from PySide6.QtCore import Qt

import solver
from posopt_gui.controllers.playback import PlaybackController, waypoint_times
from posopt_gui.views.timeline_view import STEPS, TimelineView


@pytest.fixture
def view(qtbot, planned):
    made = TimelineView(planned)
    qtbot.addWidget(made)
    with qtbot.waitExposed(made):
        made.show()
    return made


def test_times_are_path_length_over_feed():
    problem = solver.load_cell("groove_hw300")
    times = waypoint_times(problem, None)
    positions = problem.toolpath.passes[0].positions
    length = np.linalg.norm(np.diff(positions, axis=0), axis=1).sum()
    assert times[0] == 0.0
    assert times[-1] == pytest.approx(length / problem.toolpath.passes[0].feed)


def test_links_take_the_time_of_the_slowest_joint():
    problem = solver.load_cell("zigzag_hw250")
    count = len(problem.toolpath)
    joints = np.zeros((count, 6))
    start = len(problem.toolpath.passes[0])
    joints[start:, 3] = 1.0
    times = waypoint_times(problem, joints)
    share = problem.program.links.percent / 100.0
    expected = 1.0 / (problem.robot.speeds[3] * share)
    assert times[start] - times[start - 1] == pytest.approx(expected)


def test_playing_reaches_every_waypoint_at_its_time(planned):
    playback = PlaybackController(planned)
    seen = []
    planned.cursor_changed.connect(seen.append)
    for step in np.diff(playback.times):
        playback.advance(float(step))
    assert seen == list(range(1, 50))
    assert planned.place == 49.0
    playback.to_start()
    playback.advance(playback.duration / 2.0)
    assert planned.place == pytest.approx(np.interp(playback.time, playback.times, range(50)))


def test_it_stops_at_the_end_or_begins_again(planned):
    playback = PlaybackController(planned)
    playback.play()
    playback.advance(playback.duration + 5.0)
    assert not playback.playing
    assert planned.cursor == 49
    playback.play()
    assert planned.cursor == 0
    playback.set_loop(True)
    playback.advance(playback.duration + 1.0)
    assert playback.playing
    assert playback.time == pytest.approx(1.0)
    playback.pause()


def test_the_timer_moves_the_place_while_it_plays(planned, qtbot):
    playback = PlaybackController(planned)
    playback.set_speed(4.0)
    playback.play()
    qtbot.waitUntil(lambda: planned.place > 0.5, timeout=10_000)
    playback.pause()
    assert not playback.playing


def test_whoever_moves_the_place_moves_the_playback(planned):
    playback = PlaybackController(planned)
    planned.set_place(10.5)
    assert playback.time == pytest.approx((playback.times[10] + playback.times[11]) / 2.0)
    playback.step_forward()
    assert planned.place == 11.0
    playback.step_back()
    playback.step_back()
    assert planned.place == 9.0
    playback.to_end()
    playback.step_forward()
    assert planned.place == 49.0
    playback.to_start()
    playback.step_back()
    assert planned.place == 0.0


def test_the_slider_and_the_session_follow_each_other(view, planned):
    view._slider.setValue(16 * STEPS)
    assert planned.cursor == 16
    assert view._count.text() == "17/50"
    planned.set_cursor(4)
    assert view._slider.value() == 4 * STEPS
    assert view._count.text() == "5/50"
    assert view._slider.maximum() == 49 * STEPS


def test_keys_play_and_step(view, planned, qtbot):
    view.activateWindow()
    qtbot.waitUntil(view.isActiveWindow, timeout=5_000)
    qtbot.keyClick(view, Qt.Key.Key_Right)
    assert planned.cursor == 1
    qtbot.keyClick(view, Qt.Key.Key_End)
    assert planned.cursor == 49
    qtbot.keyClick(view, Qt.Key.Key_Left)
    assert planned.cursor == 48
    qtbot.keyClick(view, Qt.Key.Key_Home)
    assert planned.cursor == 0
    qtbot.keyClick(view, Qt.Key.Key_Space)
    assert view.playback.playing
    assert view._play.text() == "Pause"
    qtbot.keyClick(view, Qt.Key.Key_Space)
    assert not view.playback.playing
    assert view._play.text() == "Play"


def test_pace_and_loop_are_chosen_in_the_bar(view):
    view._speed.setCurrentIndex(0)
    assert view.playback.speed == 0.25
    view.playback.set_speed(4.0)
    assert view._speed.currentText() == "4×"
    view._loop.trigger()
    assert view.playback.loop


def test_without_a_path_nothing_can_be_played(qtbot, session):
    made = TimelineView(session)
    qtbot.addWidget(made)
    assert not made._play.isEnabled()
    assert made._count.text() == "0/0"
    made.playback.play()
    assert not made.playback.playing
