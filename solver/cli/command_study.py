"""`posopt study`: a publication's results computed again, examined and improved on."""

from __future__ import annotations

import argparse
from pathlib import Path

from solver.cli.output import TerminalMonitor, emit_json, say
from solver.errors import InputError, Place

HELP = "compute the results of a paper again on open data, examine them and improve on them"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command."""
    parser.add_argument("study", metavar="STUDY", help="name of a shipped study, such as paper")
    parser.add_argument("--cell", default="", metavar="CELL", help="another cell than the study's")
    parser.add_argument(
        "--out", metavar="DIR", help="folder for tables, figures and the page (default: study_NAME)"
    )
    parser.add_argument(
        "--only", action="append", default=[], metavar="KEY", help="one experiment (repeatable)"
    )
    parser.add_argument("--no-figures", action="store_true", help="draw no figures")


def run(options: argparse.Namespace) -> int:
    """Run the experiments and write what they found."""
    from solver.study.context import Study
    from solver.study.output import write_report
    from solver.study.published import load_study
    from solver.study.rendering import HOW_TO_INSTALL, can_draw
    from solver.study.report import run_study

    data = load_study(options.study)
    folder = Path(options.out or f"study_{data.name}")
    if folder.exists() and not folder.is_dir():
        raise InputError("a folder was expected", Place(str(folder)))
    monitor = TerminalMonitor()
    try:
        report = run_study(Study(data, options.cell, monitor), options.only)
        files = write_report(report, folder, figures=False if options.no_figures else None)
    finally:
        monitor.close()
    if options.as_json:
        emit_json(report.document(), options.as_json)
    if options.as_json != "-":
        for section in report.sections:
            say(f"{section.title}")
            for text in (f"does not apply: {section.reason}",) if section.reason else section.text:
                say(f"  {text}")
        say(f"wrote {len(files)} files to {folder}; open {folder / 'index.html'}")
        if not can_draw() and not options.no_figures:
            say(HOW_TO_INSTALL)
    return 0
