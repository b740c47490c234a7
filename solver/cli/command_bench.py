"""`posopt bench`: how fast this machine plans, as medians and ratios within one run."""

from __future__ import annotations

import argparse
from dataclasses import asdict

from solver.cli.output import emit_json, say
from solver.errors import InputError

HELP = "measure planning on the shipped cells, and the search against a plain Python A*"


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


def run(options: argparse.Namespace) -> int:
    """Measure and print."""
    from solver.benchmarks.measure import all_branches, lengthened, time_peer, time_plan
    from solver.catalog import load_cell

    if not 1 <= options.repeats <= 1000:
        raise InputError(f"--repeats lies in 1..1000, got {options.repeats}")
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
