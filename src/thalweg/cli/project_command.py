"""``thalweg project``: a dredging project, cycle by cycle."""

from __future__ import annotations

import argparse
from typing import Any

from thalweg.cli import options
from thalweg.cli.exit_codes import NO_ROUTE, SUCCESS


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "project",
        help="sail a dredging project: load, sail full, unload, sail empty",
        description="Sail a dredging project to its end, in every cycle with the load and the ways "
        "that produce most, beside a base case.",
    )
    parser.add_argument("file", metavar="FILE", help="project file (YAML), or 'example'")
    parser.add_argument("--out", metavar="DIR", help="folder for files and pictures")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Sail, print and write."""
    from thalweg.operations.dredging.project_inputs import open_project, open_project_inputs
    from thalweg.operations.dredging.run_project import run_project
    from thalweg.planning.report.output_files import make_folder

    if arguments.out:
        make_folder(arguments.out)
    project = open_project(arguments.file)
    ship, sea, chart = open_project_inputs(project)
    tell = options.progress_callback(arguments)
    result = run_project(project, ship=ship, sea=sea, chart=chart, progress=tell)
    files = result.write(arguments.out) if arguments.out else []
    if arguments.json:
        print(result.to_json())
    else:
        print_project(result)
        for path in files:
            print(f"wrote {path}")
    return SUCCESS if result.optimised.feasible else NO_ROUTE


def print_project(result: Any) -> None:
    """Print a project's table for a person."""
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    console = Console()
    head, *rows = result.table()
    table = Table(title=escape(result.project.name), title_justify="left", box=box.SIMPLE_HEAD)
    table.add_column(head[0])
    for name in head[1:]:
        table.add_column(name, justify="right")
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    console.print(table)
    notes = [note for run in result.runs for note in run.notes]
    for note in dict.fromkeys(notes + list(result.provenance["assumptions"])):
        console.print(f"[yellow]note:[/yellow] {escape(note)}", soft_wrap=True)
