"""`posopt bench`: how fast this machine plans, as medians and ratios within one run."""

from __future__ import annotations

import argparse
import sys
from dataclasses import asdict

from solver.cli.arguments import positive_number
from solver.cli.output import emit_json, say
from solver.errors import InputError

HELP = "measure planning on the shipped cells, and the search against its peers"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command."""
    parser.add_argument(
        "--repeats",
        type=int,
        default=9,
        metavar="N",
        help="runs of each measurement; the median counts (default 9)",
    )
    parser.add_argument(
        "--long", action="store_true", help="also plan both cells with 5,000 waypoints"
    )
    parser.add_argument(
        "--peers",
        action="store_true",
        help="instead: searches, inverse kinematics and distances beside networkx, scipy, "
        "py-opw-kinematics, python-fcl and coal (Linux)",
    )
    sizes = parser.add_mutually_exclusive_group()
    sizes.add_argument(
        "--small", action="store_true", help="with --peers: two tiny graphs, to see that all runs"
    )
    sizes.add_argument(
        "--sizes",
        nargs="+",
        metavar="NxLxB",
        help="with --peers: graphs of N waypoints, L leans and B branches, or NxLxMxB with M leads "
        "(default 50x51x1 50x51x8 500x51x8 5000x51x8 200x51x21x8)",
    )
    parser.add_argument(
        "--cell",
        metavar="CELL",
        help="with --peers: a shipped cell, or a cell's TOML file (default groove_hw300)",
    )
    parser.add_argument(
        "--time-limit",
        default="120",
        metavar="S",
        help="with --peers: processor time of one search [s] (default 120)",
    )
    parser.add_argument(
        "--memory-limit",
        default="8",
        metavar="GB",
        help="with --peers: memory of one search [GB] (default 8)",
    )


def run(options: argparse.Namespace) -> int:
    """Measure and print."""
    if not 1 <= options.repeats <= 1000:
        raise InputError(f"--repeats lies in 1..1000, got {options.repeats}")
    if options.peers:
        return _run_peers(options)
    if options.small or options.sizes or options.cell is not None:
        raise InputError("--small, --sizes and --cell belong to --peers")
    return _run_plans(options)


def _run_peers(options: argparse.Namespace) -> int:
    """Measure beside others' packages."""
    if sys.platform != "linux":
        raise InputError("--peers bounds the memory of its processes as only Linux can")
    if options.long:
        raise InputError("--long and --peers do not go together; use --sizes")
    from solver.benchmarks.peers import measure_peers
    from solver.benchmarks.peers_graphs import CELL, SMALL_SIZES, STANDARD_SIZES, parse_size
    from solver.benchmarks.peers_process import GIGABYTE, Bounds
    from solver.benchmarks.peers_report import peers_document, peers_lines

    standard = SMALL_SIZES if options.small else STANDARD_SIZES
    asked = tuple(parse_size(text) for text in options.sizes or ())
    bounds = Bounds(
        positive_number(options.time_limit, "--time-limit"),
        positive_number(options.memory_limit, "--memory-limit") * GIGABYTE,
        options.repeats,
    )
    tables = measure_peers(
        asked or standard,
        bounds,
        small=options.small,
        cell=CELL if options.cell is None else options.cell,
        tell=lambda text: print(text, file=sys.stderr),
    )
    if options.as_json:
        emit_json(peers_document(tables), options.as_json)
    if options.as_json != "-":
        for line in peers_lines(tables):
            say(line)
    return 0


def _run_plans(options: argparse.Namespace) -> int:
    """Measure planning, and the search against a plain Python A*."""
    from solver.benchmarks.measure import all_branches, lengthened, time_peer, time_plan
    from solver.catalog import load_cell

    cells = [all_branches(load_cell(name)) for name in ("groove_paper", "groove_hw300")]
    timings = [time_plan(problem, options.repeats) for problem in cells]
    if options.long:
        timings += [time_plan(lengthened(problem, 5000), 1) for problem in cells]
    peers = [time_peer(problem, options.repeats) for problem in cells]
    if options.as_json:
        document = {
            "format": "posopt-bench",
            "version": 1,
            "plans": [asdict(one) for one in timings],
            "peers": [asdict(one) for one in peers],
        }
        emit_json(document, options.as_json)
    if options.as_json != "-":
        for plan in timings:
            say(
                f"{plan.cell}: {plan.waypoints} waypoints, {plan.candidates:,} candidates, "
                f"{100 * plan.feasible_share:.1f} % feasible, {plan.nodes:,} nodes, "
                f"{plan.body_pairs} body pairs\n"
                f"  path to sequence {1e3 * plan.total:.1f} ms "
                f"(candidates {1e3 * plan.candidate_stage:.1f}, exact search "
                f"{1e3 * plan.exact_search:.1f}; f2 search {1e3 * plan.f2_search:.1f})"
            )
        for peer in peers:
            agreement = "the same costs" if peer.same_costs else "DIFFERENT costs"
            say(
                f"{peer.cell}: plain Python A* ({agreement}, {peer.nodes:,} nodes)\n"
                f"  scheme f takes {peer.plain_f / peer.exact:,.0f} times the exact search and "
                f"{peer.plain_f / peer.f:,.0f} times ours\n"
                f"  scheme f2 takes {peer.plain_f2 / peer.exact:,.0f} times the exact search and "
                f"{peer.plain_f2 / peer.f2:,.0f} times ours"
            )
    return 0
