"""`posopt`: parse the arguments, run one command, turn errors into a sentence and an exit code."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from importlib import import_module

from solver.cli.arguments import ExactParser
from solver.errors import Cancelled, PosoptError

COMMANDS = ("plan", "check", "fk", "ik", "distance", "list", "bench", "study", "doctor")
"""Every command is the module `solver.cli.command_NAME` with `add_arguments` and `run`."""

INTERRUPTED = 130
"""Exit code after Ctrl-C."""


def build_parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    parser = ExactParser(
        prog="posopt",
        description="Collision-free, provably optimal pose sequences for grinding paths on H-beams."
        " Lengths in mm, angles in degrees, joints as on the pendant.",
        epilog="exit codes: 0 done, 2 bad input, 3 no sequence, 4 refused by a check",
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name in COMMANDS:
        module = import_module(f"solver.cli.command_{name}")
        sub = commands.add_parser(name, help=module.HELP, description=module.HELP)
        sub.add_argument(
            "--json",
            dest="as_json",
            nargs="?",
            const="-",
            default=None,
            metavar="F",
            help="write the result as JSON to the file F, or to the screen",
        )
        module.add_arguments(sub)
        sub.set_defaults(run=module.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    for stream in (sys.stdout, sys.stderr):
        # A name in Chinese must not end a run on a terminal that cannot show it.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        return _run(build_parser().parse_args(arguments))
    except (KeyboardInterrupt, Cancelled):
        print("posopt: stopped; no file was left half written", file=sys.stderr)
        return INTERRUPTED


def _run(options: argparse.Namespace) -> int:
    from solver.cli.output import check_json_target, refused, say

    try:
        if options.as_json not in {None, "-"} and options.command != "distance":
            check_json_target(options.as_json)
        return int(options.run(options))
    except PosoptError as error:
        if options.as_json == "-":
            say(json.dumps({"error": type(error).__name__, "message": str(error)}))
        return refused(options.command, error)


if __name__ == "__main__":
    sys.exit(main())
