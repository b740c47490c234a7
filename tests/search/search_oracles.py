"""Independent twins of the searches, in plain Python and numpy, and graphs to try them on."""

from __future__ import annotations

import itertools
import math

import numpy as np
from hypothesis import strategies as st

from solver.search.graph import LayeredGraph

INF = math.inf


def layers_of(graph):
    return [range(graph.offsets[i], graph.offsets[i + 1]) for i in range(graph.layer_count)]


def edge(graph, gap, source, target):
    """Cost of one edge from the definition, infinite where a limit forbids it."""
    if graph.steps is not None:
        for joint in range(6):
            step = abs(graph.steps[target, joint] - graph.steps[source, joint])
            if step > graph.step_limits[gap, joint] + 1e-12:
                return INF
    if graph.lean is not None:
        tilt = abs(graph.lean[target] - graph.lean[source])
        if tilt > graph.lean_limits[gap] + 1e-12:
            return INF
    total = 0.0
    for joint in range(6):
        change = abs(graph.joints[target, joint] - graph.joints[source, joint])
        share = change / graph.ranges[joint]
        total += share**2 if graph.squared else share
    return graph.gap_weight[gap] * total


def cost_of(graph, path):
    cost = graph.node_cost[path[0]]
    for gap in range(graph.layer_count - 1):
        cost += edge(graph, gap, path[gap], path[gap + 1]) + graph.node_cost[path[gap + 1]]
    return cost


def all_sequences(graph):
    """Every allowed sequence and its cost, in lexicographic order."""
    found = []
    for path in itertools.product(*layers_of(graph)):
        cost = cost_of(graph, path)
        if cost < INF:
            found.append((path, cost))
    return found


def edge_matrix(graph, gap):
    """Costs of all edges of a gap by numpy broadcasting."""
    layers = layers_of(graph)
    a, b = list(layers[gap]), list(layers[gap + 1])
    change = np.abs(graph.joints[a][:, None] - graph.joints[b][None]) / graph.ranges
    cost = graph.gap_weight[gap] * ((change**2) if graph.squared else change).sum(-1)
    if graph.steps is not None:
        step = np.abs(graph.steps[a][:, None] - graph.steps[b][None])
        cost[(step > graph.step_limits[gap] + 1e-12).any(-1)] = INF
    if graph.lean is not None:
        tilt = np.abs(graph.lean[a][:, None] - graph.lean[b][None])
        cost[tilt > graph.lean_limits[gap] + 1e-12] = INF
    return cost


def numpy_values(graph):
    """Cost so far and cost to go of every node by dynamic programming over matrices."""
    layers = layers_of(graph)
    so_far, to_go = np.full(graph.node_count, INF), np.full(graph.node_count, INF)
    so_far[list(layers[0])] = graph.node_cost[list(layers[0])]
    to_go[list(layers[-1])] = 0.0
    for gap in range(graph.layer_count - 1):
        a, b = list(layers[gap]), list(layers[gap + 1])
        if a and b:
            so_far[b] = (so_far[a][:, None] + edge_matrix(graph, gap)).min(0) + graph.node_cost[b]
    for gap in range(graph.layer_count - 2, -1, -1):
        a, b = list(layers[gap]), list(layers[gap + 1])
        if a and b:
            to_go[a] = (edge_matrix(graph, gap) + (graph.node_cost + to_go)[b][None]).min(1)
    return so_far, to_go


def sizes_to_offsets(sizes):
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)


def random_graph(seed, layers=12, widest=14, *, limits=False, squared=False, penalty=False):
    """A graph of random sizes; sequences usually exist, with limits not always."""
    random = np.random.default_rng(seed)
    sizes = random.integers(1, widest + 1, size=layers)
    count = int(sizes.sum())
    joints = random.uniform(-2.0, 2.0, (count, 6))
    bounds = {}
    if limits:
        bounds = {
            "steps": joints @ random.uniform(-1.0, 1.0, (6, 6)),
            "step_limits": random.choice([1.5, 3.0, 6.0, INF], (layers - 1, 6)),
            "lean": random.uniform(-0.5, 0.5, count),
            "lean_limits": random.choice([0.3, 0.6, INF], layers - 1),
        }
    return LayeredGraph(
        offsets=sizes_to_offsets(sizes),
        joints=joints,
        ranges=random.uniform(2.0, 9.0, 6),
        node_cost=random.exponential(0.5, count) if penalty else np.zeros(count),
        gap_weight=np.where(random.random(layers - 1) < 0.8, 1.0, random.uniform(0, 3, layers - 1)),
        squared=squared,
        **bounds,
    )


@st.composite
def small_graphs(draw, *, squared=None):
    """Graphs small enough to enumerate: empty layers, ties, limits, weights, both costs."""
    sizes = draw(st.lists(st.integers(0, 4), min_size=1, max_size=4))
    if draw(st.booleans()):
        sizes = [max(size, 1) for size in sizes]
    count, gaps = sum(sizes), len(sizes) - 1
    # Few distinct values make many equal costs.
    seed = draw(st.integers(0, 2**32 - 1))
    random = np.random.default_rng(seed)
    if draw(st.booleans()):
        joints = random.integers(-1, 2, (count, 6)).astype(float)
        node_cost = random.integers(0, 2, count).astype(float)
    else:
        joints = random.uniform(-2.0, 2.0, (count, 6))
        node_cost = random.uniform(0.0, 1.0, count)
    bounds = {}
    if draw(st.booleans()):
        bounds["steps"] = joints[:, ::-1] * 1.5
        bounds["step_limits"] = random.choice([1.5, 3.0, INF], (gaps, 6))
    if draw(st.booleans()):
        bounds["lean"] = random.integers(-2, 3, count) * 0.1
        bounds["lean_limits"] = random.choice([0.1, 0.2, INF], gaps)
    return LayeredGraph(
        offsets=sizes_to_offsets(sizes),
        joints=joints,
        ranges=random.choice([1.0, 2.0, 4.0], 6),
        node_cost=node_cost,
        gap_weight=random.choice([0.0, 0.5, 1.0, 2.0], gaps),
        squared=draw(st.booleans()) if squared is None else squared,
        **bounds,
    )


class StoppingMonitor:
    """Counts the questions and cancels at a given one."""

    def __init__(self, stop_at=None):
        self.stop_at, self.asked, self.reports = stop_at, 0, []

    def report(self, stage, done, total):
        self.reports.append((stage, done, total))

    def cancelled(self):
        self.asked += 1
        return self.stop_at is not None and self.asked >= self.stop_at
