"""`posopt list`: what is shipped."""

from __future__ import annotations

import argparse

from solver.cli.output import emit_json, say

HELP = "list the shipped robots, beams, tools or cells"
KINDS = ("robots", "beams", "tools", "cells")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command."""
    parser.add_argument("kind", choices=KINDS, help="what to list")


def run(options: argparse.Namespace) -> int:
    """Print one entry a line."""
    from solver.catalog import describe

    entries = describe(options.kind)
    if options.as_json:
        rows = [{"name": entry.name, "title": entry.title} for entry in entries]
        emit_json(
            {"format": "posopt-list", "version": 1, "kind": options.kind, "entries": rows},
            options.as_json,
        )
    if options.as_json != "-":
        width = max(len(entry.name) for entry in entries)
        for entry in entries:
            say(f"{entry.name:<{width}}  {entry.title}")
    return 0
