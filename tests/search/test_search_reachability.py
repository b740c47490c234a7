import numpy as np
import pytest
from hypothesis import given, settings
from search_oracles import all_sequences, layers_of, small_graphs

from solver.search.graph import LayeredGraph
from solver.search.reachability import Cut, GapCut, diagnose_cut


def chain(steps, limits, *, lean=None, lean_limits=None, offsets=None):
    """Nodes whose first pendant joint is given."""
    joints = np.zeros((len(steps), 6))
    joints[:, 0] = steps
    table = np.full((len(limits), 6), np.inf)
    table[:, 0] = limits
    offsets = np.arange(len(steps) + 1) if offsets is None else offsets
    return LayeredGraph(
        offsets,
        joints,
        np.ones(6),
        np.zeros(len(steps)),
        np.ones(len(limits)),
        steps=joints,
        step_limits=table,
        lean=lean,
        lean_limits=lean_limits,
    )


@settings(max_examples=150, deadline=None)
@given(small_graphs())
def test_a_graph_is_cut_exactly_when_it_holds_no_sequence(graph):
    cut = diagnose_cut(graph)
    assert (cut is None) == bool(all_sequences(graph))
    if cut is not None:
        empty = [i for i, layer in enumerate(layers_of(graph)) if len(layer) == 0]
        assert list(cut.empty_layers) == empty
        for gap in cut.gaps:
            assert gap.step > gap.limit


def test_a_step_that_is_too_large_is_named_with_its_joint_and_excess():
    cut = diagnose_cut(chain([0.0, 0.1, 0.5, 0.6], [0.2, 0.3, 0.2]))
    assert cut.empty_layers == ()
    (gap,) = cut.gaps
    assert (gap.gap, gap.source, gap.target, gap.joint) == (1, 1, 2, 1)
    assert gap.excess == pytest.approx(0.1)


def test_the_nearest_pair_is_measured_in_shares_of_the_limit():
    joints = np.zeros((3, 6))
    joints[1, 1] = 0.30  # three times J2's limit
    joints[2, 4] = 0.80  # twice J5's limit: nearer, though the step is larger
    limits = np.full((1, 6), np.inf)
    limits[0, 1], limits[0, 4] = 0.1, 0.4
    graph = LayeredGraph(
        [0, 1, 3], joints, np.ones(6), np.zeros(3), [1.0], steps=joints, step_limits=limits
    )
    (gap,) = diagnose_cut(graph).gaps
    assert (gap.target, gap.joint) == (2, 5)
    assert gap.excess == pytest.approx(0.4)


def test_a_lean_that_turns_too_fast_is_named_as_lean():
    graph = chain([0.0, 0.1], [0.2], lean=np.array([0.0, 0.5]), lean_limits=np.array([0.1]))
    assert diagnose_cut(graph) == Cut((), (GapCut(0, 0, 1, None, 0.5, 0.1),))


def test_only_sources_that_can_be_reached_count():
    # Node 2 is near node 3, but nothing leads to node 2.
    graph = chain([0.0, 0.1, 0.9, 1.0], [0.2, 0.2], offsets=[0, 1, 3, 4])
    (gap,) = diagnose_cut(graph).gaps
    assert (gap.gap, gap.source, gap.target) == (1, 1, 3)


def test_every_cut_is_found_not_only_the_first():
    cut = diagnose_cut(chain([0.0, 1.0, 1.1, 2.1], [0.2, 0.2, 0.2]))
    assert [gap.gap for gap in cut.gaps] == [0, 2]


def test_gaps_beside_an_empty_layer_are_no_cuts_of_their_own():
    cut = diagnose_cut(chain([0.0, 0.1, 0.9], [0.2, 0.2, 0.2], offsets=[0, 1, 1, 2, 3]))
    assert cut.empty_layers == (1,)
    assert [gap.gap for gap in cut.gaps] == [2]


def test_a_path_of_empty_layers_only_is_diagnosed():
    cut = diagnose_cut(chain([], [0.2, 0.2], offsets=[0, 0, 0, 0]))
    assert cut == Cut((0, 1, 2), ())
