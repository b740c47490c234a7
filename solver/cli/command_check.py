"""`posopt check`: every check of a program that was read from a file."""

from __future__ import annotations

import argparse
from pathlib import Path

from solver.cli.output import emit_json, refused, say
from solver.errors import InputError, RefusedError, UnknownNameError

HELP = "check a program against its cell, on the nominal model"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command."""
    parser.add_argument("program", metavar="PROGRAM.LS", help="the program to check")
    parser.add_argument(
        "--cell",
        metavar="CELL",
        help="name or TOML file of the cell (default: the one in its remarks)",
    )
    parser.add_argument("--beam", metavar="NAME", help="the beam, where it is not the cell's")
    parser.add_argument("--path", metavar="F", help="the path file, where it is not the cell's")


def run(options: argparse.Namespace) -> int:
    """Check and report; exit code 4 when a check failed."""
    from solver.analysis.report import check_document
    from solver.catalog import load_cell
    from solver.io.ls_reader import read_program_file
    from solver.pipeline.programming import (
        BEAM_REMARK,
        CELL_REMARK,
        check_program,
        required_clearance,
    )

    written = read_program_file(Path(options.program))
    stated = {
        prefix: remark.removeprefix(prefix).strip()
        for remark in written.remarks
        for prefix in (CELL_REMARK, BEAM_REMARK)
        if remark.startswith(prefix)
    }
    cell = options.cell or stated.get(CELL_REMARK)
    if not cell:
        raise InputError(f"{options.program}: no remark names its cell; give it with --cell CELL")
    beam = options.beam or (None if options.cell else stated.get(BEAM_REMARK))
    try:
        problem = load_cell(cell, beam=beam, path=options.path)
    except UnknownNameError as error:
        if options.cell:
            raise
        raise InputError(f"{error}; give the file of the program's cell with --cell") from error
    checks = check_program(problem, written, required_clearance(problem, written))
    failed = [check for check in checks if not check.passed]
    if options.as_json:
        document = {
            "format": "posopt-check",
            "version": 1,
            "program": options.program,
            "cell": problem.name,
            "passed": not failed,
            "checks": [check_document(check) for check in checks],
        }
        emit_json(document, options.as_json)
    if options.as_json != "-":
        for check in checks:
            say(str(check))
    if failed:
        names = ", ".join(check.name for check in failed)
        message = f"{len(failed)} of {len(checks)} checks failed: {names}"
        return refused(options.command, RefusedError(message))
    if options.as_json != "-":
        say(f"all {len(checks)} checks passed on the nominal model of cell {problem.name}")
    return 0
