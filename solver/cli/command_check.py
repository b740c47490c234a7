"""`posopt check`: every check of a program that was read from a file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from solver.cli.arguments import add_resample, resampled
from solver.cli.output import TerminalMonitor, emit_json, refused, say
from solver.errors import InputError, RefusedError, UnknownNameError

if TYPE_CHECKING:
    from solver.io.ls_program import ProgramFile
    from solver.model.problem import PlanningProblem

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
    add_resample(parser)


def run(options: argparse.Namespace) -> int:
    """Check and report; exit code 4 when a check failed."""
    from solver.analysis.report import program_document
    from solver.io.ls_program_set import read_program_set
    from solver.pipeline.program_check import inspect_program
    from solver.pipeline.remarks import required_clearance, stated_override

    programs = read_program_set(Path(options.program))
    problem = _problem(options, programs.main)
    monitor = TerminalMonitor()
    try:
        report = inspect_program(
            problem, programs, required_clearance(problem, programs.main), monitor
        )
    finally:
        monitor.close()
    override = stated_override(programs.main)
    if options.as_json:
        document = {
            "format": "posopt-check",
            "version": 2,
            "program": options.program,
            "cell": problem.name,
            "override": override,
            "passed": not report.failed,
            **program_document(report),
        }
        emit_json(document, options.as_json)
    if options.as_json != "-":
        for check in report.checks:
            say(str(check))
        if override is not None:
            say(f"this program was written in spite of failed checks: {override}")
    if report.failed:
        names = ", ".join(check.name for check in report.failed)
        message = f"{len(report.failed)} of {len(report.checks)} checks failed: {names}"
        message += _hint(options, [check.name for check in report.failed])
        return refused(options.command, RefusedError(message))
    if options.as_json != "-":
        count = len(report.checks)
        say(f"all {count} checks passed on the nominal model of cell {problem.name}")
    return 0


def _hint(options: argparse.Namespace, failed: list[str]) -> str:
    """What may be meant where the program does not follow the path that it is compared with."""
    leaves = any(name.startswith("path") for name in failed)
    if options.path is None:
        if not leaves:
            return ""
        return (
            "; it was compared with the cell's own path: if it was planned from another path, give "
            "that with --path F (and --resample MM as it was planned)"
        )
    if options.resample is None and (leaves or "cell digest" in failed):
        return "; if it was planned with --resample MM, give that too"
    return ""


def _problem(options: argparse.Namespace, main: ProgramFile) -> PlanningProblem:
    """The cell that was given, or the one that the program's remarks name."""
    from solver.catalog import load_cell
    from solver.pipeline.remarks import BEAM_REMARK, CELL_REMARK, remark_value

    cell = options.cell or remark_value(main, CELL_REMARK)
    if not cell:
        raise InputError(f"{options.program}: no remark names its cell; give it with --cell CELL")
    beam = options.beam or (None if options.cell else remark_value(main, BEAM_REMARK))
    try:
        return resampled(load_cell(cell, beam=beam, path=options.path), options.resample)
    except UnknownNameError as error:
        if options.cell:
            raise
        raise InputError(f"{error}; give the file of the program's cell with --cell") from error
