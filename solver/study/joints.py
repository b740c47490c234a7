"""Joint statistics against nominal, constant and random lean, as the paper compares them."""

from __future__ import annotations

import numpy as np

from solver.analysis.metrics import JointMotion, joint_motion, mean_motion
from solver.model.settings import Scheme
from solver.study.constant import best_constant, nominal_sequence
from solver.study.context import Study
from solver.study.published import JOINT_NAMES, MODEL_NAMES
from solver.study.sections import Column, Section, StudyTable, Value, percent
from solver.units import DEG_PER_RAD

MEASURES = (
    ("cumulative change", "variation"),
    ("amplitude", "amplitude"),
    ("standard deviation", "deviation"),
    ("largest step", "largest_step"),
)


def joints(study: Study) -> Section:
    """Measures of f2's model angles, and their changes against the three references."""
    result = study.result
    motion = joint_motion(study.sequence(Scheme.F2).model)
    known: dict[str, JointMotion] = {}
    for kind, one in (
        ("nominal lean", nominal_sequence(result)),
        ("best constant lean", best_constant(result)),
    ):
        if one is not None:
            known[kind] = joint_motion(one.model)
    known["random lean"] = random_motion(study)
    changes = {kind: motion.gain_over(one) for kind, one in known.items()}
    text = [_words(kind, change) for kind, change in changes.items()]
    if "nominal lean" not in known:
        text.append("The nominal lean is not feasible along the whole path.")
    published = study.published
    if study.is_published_cell:
        single = " and ".join(
            f"{joint} {percent(value)}" for joint, value in published.variation.items()
        )
        text.append(
            f"Published against an unoptimised sequence: {single} cumulative change, amplitude "
            f"{percent(published.changes['amplitude_change'])} and standard deviation "
            f"{percent(published.changes['deviation_change'])} on average over the joints. The "
            "reference that comes close to these is the random lean, which nobody would program; "
            "the other two are the fair ones."
        )
    numbers = {
        kind: {
            "variation": dict(zip(MODEL_NAMES, map(_number, change.variation), strict=True)),
            "mean_amplitude": _mean(change.amplitude),
            "mean_standard_deviation": _mean(change.deviation),
        }
        for kind, change in changes.items()
    }
    tables = (_absolute(motion, known), _relative(study, changes))
    return Section("joints", "Joint statistics", tuple(text), tables, numbers=numbers)


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _mean(values: np.ndarray) -> float | None:
    moving = values[np.isfinite(values)]
    return float(moving.mean()) if len(moving) else None


def random_motion(study: Study) -> JointMotion:
    """Mean measures of seeded draws of a random feasible orientation at each waypoint.

    Drawn are nodes of the branch that f2 takes there; of the turns of an orientation, the one
    nearest to f2.
    """
    result, sequence = study.result, study.sequence(Scheme.F2)
    nodes = result.candidates.nodes
    layers = []
    for waypoint, planned in enumerate(sequence.nodes):
        rows = np.arange(nodes.offsets[waypoint], nodes.offsets[waypoint + 1])
        rows = rows[nodes.candidate[rows, 2] == nodes.candidate[planned, 2]]
        away = np.abs(nodes.model[rows] - nodes.model[planned]).sum(axis=1)
        rows = rows[np.lexsort((away, nodes.candidate[rows, 1]))]
        _, first = np.unique(nodes.candidate[rows, 1], return_index=True)
        layers.append(rows[first])
    motions = []
    for draw in range(study.parameters.random_draws):
        source = np.random.default_rng([result.problem.settings.seed, draw])
        chosen = np.array([layer[source.integers(len(layer))] for layer in layers])
        motions.append(joint_motion(nodes.model[chosen]))
    return mean_motion(motions)


def _words(kind: str, change: JointMotion) -> str:
    means = [_mean(getattr(change, name)) for _, name in MEASURES[1:3]]
    amplitude, deviation = ("–" if one is None else percent(one) for one in means)
    cells = [
        f"{joint} {percent(float(value))}"
        for joint, value in zip(MODEL_NAMES, change.variation, strict=True)
        if np.isfinite(value)
    ]
    return (
        f"f2 against {kind}: cumulative change {', '.join(cells)}; on average over "
        f"the joints amplitude {amplitude}, standard deviation {deviation}."
    )


def _absolute(motion: JointMotion, references: dict[str, JointMotion]) -> StudyTable:
    rows: list[tuple[Value, ...]] = []
    for title, name in MEASURES:
        rows.append((title, "f2", *_degrees(getattr(motion, name))))
        for kind, one in references.items():
            rows.append((title, kind, *_degrees(getattr(one, name))))
    columns = (Column("measure"), Column("sequence"), *(Column(j, "deg") for j in MODEL_NAMES))
    return StudyTable(
        "joints", "Measures of the model angles, as in the paper", columns, tuple(rows)
    )


def _degrees(values: np.ndarray) -> list[float]:
    return [float(value) * DEG_PER_RAD for value in values]


def _relative(study: Study, changes: dict[str, JointMotion]) -> StudyTable:
    rows: list[tuple[Value, ...]] = []
    for kind, change in changes.items():
        for title, name in MEASURES[:3]:
            values = getattr(change, name)
            mean = _mean(values)
            cells = [_hundredfold(_number(value)) for value in values]
            rows.append((title, f"f2 against {kind}", *cells, _hundredfold(mean)))
    if study.is_published_cell:
        known = study.published
        single = [_hundredfold(known.variation.get(joint)) for joint in JOINT_NAMES]
        rows.append((MEASURES[0][0], "published", *single, None))
        for (title, _), key in zip(
            MEASURES[1:3], ("amplitude_change", "deviation_change"), strict=True
        ):
            rows.append((title, "published", *[None] * 6, _hundredfold(known.changes[key])))
    columns = (
        Column("measure"),
        Column("comparison"),
        *(Column(joint, "%", 1) for joint in MODEL_NAMES),
        Column("mean", "%", 1),
    )
    return StudyTable("joint_changes", "Changes of the joints' measures", columns, tuple(rows))


def _hundredfold(share: float | None) -> float | None:
    return None if share is None else 100.0 * share
