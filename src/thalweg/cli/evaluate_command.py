"""``thalweg evaluate``: the referee scores a route from a file."""

from __future__ import annotations

import argparse
import json
from typing import Any

from thalweg.cli import options
from thalweg.cli.plan_command import print_waypoints


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "evaluate",
        help="score a route from a CSV, GeoJSON or GPX file",
        description="Re-sail a route in small steps with the ship's own physics.",
    )
    parser.add_argument("route", metavar="ROUTE")
    options.add_ship_and_chart_options(parser)
    parser.add_argument("--depart", metavar="T", help="departure; the file's own time when absent")
    parser.add_argument("--speed", type=float, metavar="KN", help="ordered speed through water")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate, print and write."""
    from thalweg.planning.plan_data import route_dict
    from thalweg.planning.report.output_files import make_folder, write_route
    from thalweg.route import evaluate as score

    if arguments.out:
        make_folder(arguments.out)
    route = score(
        arguments.route,
        ship=options.open_ship(arguments),
        sea=options.open_sea(arguments),
        chart=options.open_chart(arguments),
        depart=arguments.depart,
        speed_kn=arguments.speed,
        min_ukc=arguments.ukc or 0.0,
    )
    files = write_route(route, arguments.out) if arguments.out else []
    if arguments.json:
        found = {**route_dict(route, "given"), "notes": list(route.assumptions)}
        print(json.dumps(found, indent=2, allow_nan=False))
        return 0
    _print_route(route)
    for path in files:
        print(f"wrote {path}")
    return 0


def _print_route(route: Any) -> None:
    from rich.console import Console
    from rich.markup import escape

    console = Console()
    print_waypoints(console, route.waypoints(), "the route as given")
    waits = f" with {route.waiting_h:.2f} h waiting" if route.waiting_h > 0.0 else ""
    fuel = "" if route.fuel_t is None else f", {route.fuel_t:.1f} t fuel"
    console.print(f"[bold]{route.time_h:.2f} h{waits}, {route.distance_nm:.1f} nm{fuel}[/bold]")
    for violation in route.violations:
        console.print(f"[red]violation:[/red] {escape(str(violation))}", soft_wrap=True)
    if route.feasible:
        console.print("Every limit is kept.")
    for note in route.assumptions:
        console.print(f"[yellow]note:[/yellow] {escape(note)}", soft_wrap=True)
