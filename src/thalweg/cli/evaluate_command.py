"""``thalweg evaluate``: evaluate a route from a file."""

from __future__ import annotations

import argparse
import json
from typing import Any

from thalweg.cli import option_values, options
from thalweg.cli.exit_codes import NO_ROUTE, SUCCESS
from thalweg.cli.first_run import announce_compilation
from thalweg.cli.tables import print_route


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "evaluate",
        help="time, fuel and limits of a route from a file",
        description="Sail a given route in small steps with the ship's own models, and report its "
        "time, fuel, under-keel clearance and violated limits.",
        epilog="Example: thalweg evaluate route.gpx --ship handysize-bulker --sea forecast.nc",
    )
    parser.add_argument(
        "route", metavar="ROUTE", help="route file: RTZ, S-421, GPX, GeoJSON, KML or CSV"
    )
    options.add_ship_and_chart_options(parser, default_ukc="that of the ship file")
    options.add_verbose_option(parser)
    parser.add_argument(
        "--depart", metavar="TIME", help="departure (ISO 8601, UTC); default: that of the file"
    )
    parser.add_argument(
        "--speed",
        type=float,
        metavar="KN",
        help="ordered speed through calm water [kn]; default: those of the file, else of the ship",
    )
    parser.add_argument(
        "--member",
        type=int,
        metavar="N",
        help="sail in member N of an ensemble forecast, from 0; several files of --sea without "
        "members are one member each",
    )
    options.add_hold_option(parser)
    options.add_price_options(parser.add_argument_group("fuel, cost"))
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate the route, print it and write its files; exit code 4 if it breaks a limit."""
    announce_compilation(quiet=arguments.quiet)
    from thalweg.planning.plan_data import route_dict
    from thalweg.planning.report.output_files import write_route
    from thalweg.planning.report.provenance import given_route_warnings
    from thalweg.planning.report.route_summary import route_items
    from thalweg.planning.report.squat_report import with_squat_violation
    from thalweg.route import evaluate

    option_values.prepare_output_folder(arguments)
    files_as = option_values.route_file_options(arguments)
    ship = option_values.with_held_order(
        option_values.with_given_prices(option_values.open_ship(arguments), arguments),
        arguments,
    )
    if arguments.ukc is not None:
        ship = ship.with_clearance(arguments.ukc)
    sea, chart = option_values.open_sea(arguments), option_values.open_chart(arguments)
    arguments.progress(f"sailing {arguments.route}")
    route = evaluate(
        arguments.route,
        ship=ship,
        sea=sea,
        chart=chart,
        depart=arguments.depart,
        speed_kn=arguments.speed,
        min_ukc=arguments.ukc,
    )
    route = with_squat_violation(route, ship)
    required = ship.min_under_keel_clearance if arguments.ukc is None else arguments.ukc
    files = []
    if arguments.out:
        files = write_route(route, arguments.out, files_as, min_ukc=required, limits=ship.limits)
    notes = given_route_warnings(route, chart=chart, sea=sea, ship=ship, min_ukc=required)
    notes += route.assumptions
    if arguments.json:
        print(json.dumps({**route_dict(route, "given"), "notes": notes}, indent=2, allow_nan=False))
    else:
        items = route_items(route, sea=sea, chart=chart, ship=ship, notes=notes)
        print_route(route, items, notes, files, verbose=arguments.verbose)
    return SUCCESS if route.feasible else NO_ROUTE
