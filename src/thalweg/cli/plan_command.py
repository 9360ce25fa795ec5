"""``thalweg plan``: plan a voyage between two places."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thalweg.cli import option_values, options
from thalweg.cli.exit_codes import INTERRUPTED, NO_ROUTE, SUCCESS
from thalweg.cli.first_run import announce_compilation
from thalweg.cli.tables import print_plan, print_written
from thalweg.kernels.compilation import warm_up

if TYPE_CHECKING:
    from thalweg.planning import Voyage
    from thalweg.sea import Sea


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "plan",
        help="plan a voyage",
        description="Plan a voyage between two places. A place is a position (52.0,4.1, or "
        "'52.0N 4.1E' as one argument), a port name ('Rotterdam', 'Newcastle, AU', "
        "'Tripoli, Libya') or a UN/LOCODE (NLRTM).",
        epilog="Example: thalweg plan NLRTM GBSOU --ship handysize-bulker --sea forecast.nc "
        "--depart 2026-01-01T06:00Z --objective fuel --out results",
    )
    parser.add_argument("start", metavar="FROM", help="place of departure")
    parser.add_argument("goal", metavar="TO", help="destination")
    parser.add_argument(
        "--via",
        action="append",
        default=[],
        metavar="PLACE",
        help="place to pass; repeat it for several, in their order",
    )
    options.add_ship_and_chart_options(parser, default_ukc="that of the ship file")
    _add_time_options(parser)
    _add_objective_options(parser)
    _add_network_options(parser)
    _add_price_options(parser.add_argument_group("fuel, cost, canals"))
    parser.set_defaults(run=run)


def _add_time_options(parser: argparse.ArgumentParser) -> None:
    departure = parser.add_mutually_exclusive_group()
    departure.add_argument(
        "--depart",
        metavar="TIME",
        help="departure (ISO 8601, UTC), for example 2026-01-01T06:00Z; default: the first time "
        "in the sea data, or now for a sea without times",
    )
    departure.add_argument(
        "--depart-window",
        nargs=2,
        metavar=("FIRST", "LAST"),
        help="find the best departure between two times (ISO 8601, UTC)",
    )
    parser.add_argument("--arrive-by", metavar="TIME", help="latest arrival (ISO 8601, UTC)")
    parser.add_argument(
        "--speed",
        type=float,
        metavar="KN",
        help="ordered speed through calm water [kn]; default: the speeds of the ship file",
    )
    parser.add_argument(
        "--wait",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="whether the ship may stop and wait (default: it may)",
    )


def _add_objective_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--objective",
        default="time",
        metavar="time|distance|fuel|energy|cost|co2|front",
        help="quantity to minimise (default: time). energy: propulsion and hotel load. cost: fuel, "
        "time and dues; where fuel has no price, time and cubed speed at the costs of the ship "
        "file. front: all trade-offs of time against fuel or cost (the Pareto front)",
    )
    parser.add_argument(
        "--method",
        default="default",
        metavar="default|exact|nsga2|spea2|mpaes",
        help="how a front is found: exact: the front on the network alone; nsga2, spea2, mpaes: "
        "evolutionary methods, for comparison",
    )
    parser.add_argument(
        "--ensemble",
        nargs="?",
        const="mean",
        metavar="mean|cvar",
        help="choose the route over all members of an ensemble forecast, by the mean (default) or "
        "by the mean of the worst tenth (cvar)",
    )
    parser.add_argument(
        "--seed", type=int, default=0, metavar="N", help="seed of random numbers (default: 0)"
    )


def _add_network_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--network",
        default="auto",
        metavar="auto|lattice|mesh|globe",
        help="network to search: a regular grid around the route (lattice), the mesh of the sea "
        "data (mesh), or a global grid (globe); default: auto",
    )
    parser.add_argument(
        "--resolution",
        type=float,
        metavar="NM",
        help="spacing of the network [nm], 0.001 to 300; default: from the length of the voyage",
    )


def _add_price_options(group: Any) -> None:
    group.add_argument(
        "--fuel-price", type=float, metavar="USD", help="price of fuel [USD per tonne]"
    )
    group.add_argument(
        "--eca-price-factor",
        type=float,
        metavar="F",
        help="price of fuel inside emission control areas divided by the price outside",
    )
    group.add_argument(
        "--time-price",
        type=float,
        metavar="USD",
        help="cost of time in addition to fuel [USD per hour]",
    )
    group.add_argument(
        "--forbid",
        action="append",
        default=[],
        metavar="CANAL",
        help="canal that the ship may not use, for example suez,panama, or all; may be repeated",
    )


def run(arguments: argparse.Namespace) -> int:
    """Plan the voyage, print it and write its files."""
    announce_compilation(search=True)
    warm_up.start_compiling("thalweg.planning.compile_kernels")
    from thalweg.planning import plan

    option_values.prepare_output_folder(arguments)
    ship, sea = option_values.open_ship(arguments), option_values.open_sea(arguments)
    try:
        found = plan(
            _voyage(arguments, sea),
            ship=ship,
            sea=sea,
            chart=option_values.open_chart(arguments),
            network=arguments.network,
            resolution=option_values.resolution_m(arguments.resolution),
            progress=option_values.progress_callback(arguments),
        )
    except KeyboardInterrupt:
        print("stopped before a plan was found: there is no result", file=sys.stderr)
        return INTERRUPTED
    files = found.write(arguments.out) if arguments.out else []
    if arguments.json:
        print(found.to_json())
    else:
        print_plan(found)
        _print_files(files)
    return SUCCESS if found.best.feasible else NO_ROUTE


def _print_files(files: list[Path]) -> None:
    """Print the files written; the folder alone for those of the single routes of a front."""
    routes = [path for path in files if path.parent.name == "routes"]
    print_written(path for path in files if path not in routes)
    if routes:
        print(f"wrote {routes[0].parent} ({len(routes)} files)")


def _voyage(arguments: argparse.Namespace, sea: Sea) -> Voyage:
    from thalweg.planning import Voyage

    depart = arguments.depart
    if depart is None and arguments.depart_window is None:
        depart = _first_time(sea)
    return Voyage(
        start=arguments.start,
        goal=arguments.goal,
        via=tuple(arguments.via),
        depart=depart,
        depart_window=tuple(arguments.depart_window) if arguments.depart_window else None,
        arrive_by=arguments.arrive_by,
        objective=arguments.objective,
        wait=arguments.wait,
        speed_kn=arguments.speed,
        min_ukc_m=arguments.ukc,
        seed=arguments.seed,
        fuel_price_usd=arguments.fuel_price,
        eca_price_factor=arguments.eca_price_factor,
        time_price_usd_per_h=arguments.time_price,
        forbid=tuple(name for given in arguments.forbid for name in given.split(",") if name),
        method=arguments.method,
        ensemble=arguments.ensemble,
    )


def _first_time(sea: Sea) -> float:
    """Return the first time of the sea data, or now for a sea without times."""
    import time

    starts = [row.start for row in sea.coverage() if row.start is not None]
    return max(starts) if starts else float(round(time.time()))
