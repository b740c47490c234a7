import ast
from pathlib import Path

import numpy as np
import pytest

from posopt_gui.controllers.session import Hover
from posopt_gui.i18n import texts
from posopt_gui.views.inspector_view import InspectorView
from solver.candidates.outcomes import Outcome
from solver.pipeline.replanning import Region

ROOT = Path(__file__).parents[2]

OWN = (
    "viewmodels/curves_model.py", "viewmodels/results_model.py", "viewmodels/inspector_model.py",
    "viewmodels/trouble_model.py", "viewmodels/waypoint_table.py", "viewmodels/number_words.py",
    "views/curves_view.py", "views/curve_legend.py", "views/change_bars.py", "views/feed_plot.py",
    "views/results_view.py", "views/inspector_view.py", "views/timeline_view.py",
)  # fmt: skip


@pytest.fixture
def view(qtbot, planned):
    made = InspectorView(planned)
    qtbot.addWidget(made)
    made.resize(300, 800)
    with qtbot.waitExposed(made):
        made.show()
    return made


def filters_of(view):
    return {row[1]: row for row in view.filters.texts}


def test_it_follows_the_cursor_with_joints_and_every_filter(view, planned, qtbot):
    planned.set_cursor(16)
    assert view.title.text() == "Waypoint 17/50"
    values = [one.value for one in view.bars.bars]
    np.testing.assert_allclose(values, np.rad2deg(planned.sequence.pendant[16]))
    expected = f"{np.floor(1e4 * planned.sequence.clearance[16]) / 10:.1f} mm"
    qtbot.waitUntil(lambda: view.clearance.text() == expected, timeout=30_000)
    names = set(filters_of(view))
    assert {"Reach", "Joint limits", "Elbow", "Manipulability", "Clearance", "Own bodies"} <= names
    assert {row[0] for row in view.filters.texts} == {"✓"}


def test_joints_of_the_filters_stand_beside_their_names_so_that_the_totals_are_seen(
    view, planned, qtbot
):
    planned.set_cursor(16)
    qtbot.waitUntil(lambda: bool(view.filters.texts), timeout=30_000)
    rows = {row[1].words: row[1] for row in view.filters._rows}
    assert rows["Elbow"].beside == "J2+J3"
    assert rows["Joint limits"].below == ""
    # The bodies of the clearance stand above, once.
    assert rows["Clearance"].below == ""
    assert rows["Own bodies"].below != ""
    view.resize(310, 672)
    bottom = view.totals.mapTo(view.viewport(), view.totals.rect().topLeft()).y() + 60
    assert bottom < view.viewport().height()


def test_it_shows_why_the_hovered_candidate_is_rejected(view, planned, qtbot):
    outcome = planned.result.candidates.outcome
    waypoint, orientation, slot = map(int, np.argwhere(outcome == Outcome.COLLISION)[0])
    planned.set_hover(Hover(waypoint, orientation, slot))
    assert view.verdict.text() == "collision"
    assert view.subtitle.text() == "Candidate under the mouse"
    qtbot.waitUntil(
        lambda: "Clearance" in filters_of(view) and filters_of(view)["Clearance"][0] == "✕",
        timeout=30_000,
    )
    planned.set_hover(None)
    assert view.verdict.text() == "feasible"


def test_sweeping_over_the_map_explains_only_where_the_mouse_rests(view, planned, qtbot):
    asked = []
    view._explainer.explained.connect(lambda: asked.append(planned.hover))
    for orientation in range(40):
        planned.set_hover(Hover(3, orientation, 0))
    qtbot.waitUntil(lambda: bool(asked), timeout=30_000)
    assert asked == [Hover(3, 39, 0)]


def test_the_gate_says_whether_the_program_passes(view, planned, qtbot):
    qtbot.waitUntil(lambda: planned.report is not None, timeout=120_000)
    assert view.gate.texts[0][1] == f"All {len(planned.report.checks)} checks passed"


def test_impossible_wishes_are_said_and_lead_to_their_waypoint(view, planned, qtbot):
    planned.forbid(Region(20, 21, -2.0, 2.0))
    qtbot.waitUntil(view.trouble.isVisible, timeout=30_000)
    assert "waypoint 21 is forbidden" in view.trouble.text()
    view.trouble.linkActivated.emit("20")
    assert planned.cursor == 20
    assert view.subtitle.text() == "On the plan without your wishes"
    planned.clear_wishes()
    qtbot.waitUntil(lambda: not view.trouble.isVisible(), timeout=30_000)


def test_without_any_sequence_it_says_which_constraint_where_and_what_to_try(view, planned, qtbot):
    planned.document.set_value("settings.lean_deg", [-60.0, -40.0, 5.0])
    planned.plan()
    qtbot.waitUntil(lambda: planned.plan_error is not None, timeout=60_000)
    words = view.trouble.text()
    assert "50 waypoints have no feasible pose" in words
    assert "spindle against lower flange" in words
    assert "Try a wider lean range" in words
    assert view.title.text() == "No pose"


def test_a_wrong_input_leads_to_its_field(view, planned, qtbot):
    planned.document.set_value("settings.lean_deg", [20.0, -40.0, 1.0])
    qtbot.waitUntil(view.trouble.isVisible, timeout=30_000)
    with qtbot.waitSignal(view.key_wanted) as wanted:
        view.trouble.linkActivated.emit("settings.lean_deg")
    assert wanted.args == ["settings.lean_deg"]


def test_it_speaks_chinese(view, planned):
    planned.look.set_language("zh_CN")
    planned.look.set_theme("dark")
    planned.turns.finish()
    assert view.title.text() == "路径点 1/50"
    assert view.verdict.text() == "可行"


def keys_of(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.Call) or not node.args:
            continue
        name = getattr(node.func, "attr", getattr(node.func, "id", ""))
        first = node.args[0]
        if name in {"tr", "_tr", "translate"} and isinstance(first, ast.Constant):
            yield first.value


def test_every_text_of_these_views_has_its_chinese():
    known = texts("zh_CN")
    used = {key for name in OWN for key in keys_of(ROOT / "posopt_gui" / name)}
    assert len(used) > 80
    assert used <= set(known)
