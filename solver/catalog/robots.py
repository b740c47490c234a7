"""Robots as TOML: D-H table, limits, pendant convention and bodies."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from solver.catalog.bodies import read_body, read_rotation
from solver.catalog.names import entry_source
from solver.catalog.toml_reader import Table, read_toml
from solver.model.robot import JOINTS, LinkBody, Robot
from solver.transforms import FloatArray, rigid

OUTSIDERS = ("tool", "floor")
"""Groups that neighbours may name besides the robot's own: all of the tool, and the floor."""

ACCELERATION_TIME = 0.3
"""Time in which a joint whose acceleration is not stated reaches its full speed [s]."""


def load_robot(
    name_or_path: str | Path,
    *,
    relative_to: Path | None = None,
    files: Mapping[str, bytes] | None = None,
) -> Robot:
    """Load a shipped robot by name, or one of a TOML file.

    `files` holds TOML files in memory by the references under which they are asked for.

    Raises
    ------
    UnknownNameError
        If no shipped robot has this name.
    InputError
        If the file is unusable or contradicts itself; the sentence names file and key.
    """
    document = read_toml(*entry_source("robots", name_or_path, relative_to, files))
    head = document.table("robot")
    name, title = head.name("name"), head.text("title")
    payload = head.number("payload_kg", low=0.0)
    world_height = head.number("world_height_mm")
    dh = _denavit_hartenberg(document.table("dh"))
    flange = _flange(document.table("flange"))
    pendant = document.table("pendant").matrix("model_from_pendant", JOINTS, JOINTS, 1000)
    motion = document.table("limits")
    limits, speeds, elbow = _limits(motion)
    accelerations = _accelerations(motion, speeds)
    ranges = document.table("cost").numbers("ranges_deg", JOINTS)
    body_sets = _body_sets(document)
    neighbours = _neighbours(document, body_sets)
    assumptions = document.texts("assumptions", default=())
    read_sources(document)
    document.finish()
    with document.located():
        return Robot(
            name=name,
            title=title,
            dh=dh,
            flange=flange,
            world_height=world_height,
            model_from_pendant=np.array(pendant, dtype=np.float64),
            limits=limits,
            speeds=speeds,
            accelerations=accelerations,
            elbow_limits=elbow,
            cost_ranges=np.array(ranges),
            payload=payload,
            body_sets=body_sets,
            neighbours=neighbours,
            assumptions=assumptions,
        )


def read_sources(document: Table) -> dict[str, str]:
    """Read the optional table `sources`: where the numbers come from, under keys of any name."""
    sources = document.optional_table("sources")
    return {} if sources is None else {key: sources.text(key) for key in sources.keys}


def _denavit_hartenberg(table: Table) -> FloatArray:
    columns = ("alpha_deg", "a_mm", "d_mm", "offset_deg")
    return np.column_stack([table.numbers(column, JOINTS) for column in columns])


def _flange(table: Table) -> FloatArray:
    return rigid(read_rotation(table), table.numbers("position_mm", 3))


def _limits(table: Table) -> tuple[FloatArray, FloatArray, FloatArray]:
    lower = table.numbers("lower_deg", JOINTS)
    upper = table.numbers("upper_deg", JOINTS)
    for joint in range(JOINTS):
        if not lower[joint] < upper[joint]:
            raise table.error(
                f"upper_deg[{joint}]", f"expected more than the lower limit of J{joint + 1}"
            )
    speeds = np.array(table.numbers("speed_deg_s", JOINTS))
    return np.column_stack([lower, upper]), speeds, np.array(table.numbers("elbow_deg", 2))


def _accelerations(table: Table, speeds: FloatArray) -> FloatArray:
    default = tuple(speeds / ACCELERATION_TIME)
    return np.array(table.numbers("acceleration_deg_s2", JOINTS, default))


def _body_sets(document: Table) -> dict[str, tuple[LinkBody, ...]]:
    table = document.table("bodies")
    inflation = document.optional_table("inflation")
    sets = {}
    for name in table.keys:
        extra = 0.0 if inflation is None else inflation.number(f"{name}_mm", 0.0, low=0.0)
        sets[name] = tuple(_link_body(one, extra) for one in table.tables(name))
        if not sets[name]:
            raise table.error(name, "expected one body or more, found an empty list")
    if not sets:
        raise document.error("bodies", "expected one list of bodies or more, found none")
    return sets


def _link_body(table: Table, inflation: float) -> LinkBody:
    link = table.integer("link", 0, JOINTS)
    return LinkBody(link, read_body(table, inflation))


def _neighbours(
    document: Table, body_sets: dict[str, tuple[LinkBody, ...]]
) -> frozenset[frozenset[str]]:
    groups = {one.body.group for bodies in body_sets.values() for one in bodies}
    known = (*sorted(groups), *OUTSIDERS)
    pairs = set()
    for index, pair in enumerate(document.text_pairs("neighbours")):
        key = f"neighbours[{index}]"
        for group in pair:
            if group not in known:
                raise document.error(
                    key, f"no body is called {group!r} (known: {', '.join(known)})"
                )
        if pair[0] == pair[1]:
            raise document.error(key, "expected two different groups")
        pairs.add(frozenset(pair))
    return frozenset(pairs)
