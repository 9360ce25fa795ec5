"""``thalweg project``: simulate a dredging project cycle by cycle."""

from __future__ import annotations

import argparse
from typing import Any

from thalweg.cli import option_values, options
from thalweg.cli.exit_codes import NO_ROUTE, SUCCESS
from thalweg.cli.first_run import announce_compilation
from thalweg.cli.operations_tables import print_project
from thalweg.cli.tables import print_written


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "project",
        help="simulate a dredging project: load, sail full, unload, sail empty",
        description="Simulate a dredging project until its volume is moved. Each cycle takes the "
        "load and the routes with the highest production; the result is compared with a base case.",
        epilog="Example: thalweg project example --out results",
    )
    parser.add_argument(
        "file", metavar="FILE", help="project file (YAML); 'example': that of the package"
    )
    options.add_output_options(parser, "project.json, cycles.csv, project.png and routes.png")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Simulate the project, print its table and write its files."""
    announce_compilation(quiet=arguments.quiet)
    from thalweg.operations.dredging import open_project, open_project_inputs, run_project
    from thalweg.operations.result_files import write_project_files

    option_values.prepare_output_folder(arguments)
    arguments.progress(f"reading the project {arguments.file}")
    project = open_project(arguments.file)
    ship, sea, chart = open_project_inputs(project)
    result = run_project(project, ship=ship, sea=sea, chart=chart, progress=arguments.progress)
    files = write_project_files(result, arguments.out) if arguments.out else []
    if arguments.json:
        print(result.to_json())
    else:
        print_project(result)
        print_written(files)
    return SUCCESS if result.optimised.feasible else NO_ROUTE
