"""``thalweg plan``: plan a voyage between two places."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from thalweg.cli import option_values, options
from thalweg.cli.exit_codes import INTERRUPTED, NO_ROUTE, SUCCESS
from thalweg.cli.first_run import announce_compilation
from thalweg.cli.network_options import add_network_options, layered_request, requested_network
from thalweg.cli.tables import print_plan
from thalweg.core.errors import InputError
from thalweg.kernels.compilation import warm_up

if TYPE_CHECKING:
    from thalweg.planning import Voyage
    from thalweg.sea import Sea
    from thalweg.ship import Ship


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "plan",
        help="plan a voyage",
        description="Plan a voyage between two places. A place is a position (52.0,4.1, or "
        "'52.0N 4.1E' or '51 57.3N 004 02.1E' as one argument), a port name ('Rotterdam', "
        "'Newcastle, AU', 'Tripoli, Libya') or a UN/LOCODE (NLRTM).",
        epilog="Example: thalweg plan NLRTM GBSOU --ship handysize-bulker --sea forecast.nc "
        "--depart 2026-01-01T06:00Z --objective fuel --out results",
    )
    add_voyage_options(parser)
    options.add_verbose_option(parser)
    parser.set_defaults(run=run)


def add_voyage_options(parser: argparse.ArgumentParser) -> None:
    """Add the places of a voyage and the options of a request for a plan."""
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
    add_network_options(parser)
    _add_cost_options(parser.add_argument_group("fuel, cost, canals"))
    _add_passage_options(parser.add_argument_group("distance from land, passages"))
    _add_indicator_options(parser.add_argument_group("key performance indicators"))


def _add_indicator_options(group: Any) -> None:
    for name, pair, text in (
        ("weight", "NAME=WEIGHT", "count a key figure (time, distance, fuel, energy, cost, co2, "
         "comfort, encounters, inshore) with a weight, over its range from the best to the worst "
         "of the routes that are best in one of them; the objective is their sum"),
        ("at-most", "NAME=VALUE", "greatest value of an indicator of the whole route, such as "
         "sick_percent=20 or sick_percent:bridge=20, fuel=3, encounters=5"),
        ("at-least", "NAME=VALUE", "least value of one, such as workable_percent=80"),
    ):  # fmt: skip
        group.add_argument(
            f"--{name}",
            action="append",
            default=[],
            metavar=pair,
            help=f"{text}; may be repeated",
        )


def _add_time_options(parser: argparse.ArgumentParser) -> None:
    departure = parser.add_mutually_exclusive_group()
    departure.add_argument(
        "--depart",
        metavar="TIME",
        help="departure (ISO 8601, UTC), for example 2026-01-01T06:00Z; default: with the "
        "storm of the package the time when the ship meets it, else the first time in the sea "
        "data, or now for a sea without times",
    )
    departure.add_argument(
        "--depart-window",
        nargs=2,
        metavar=("FIRST", "LAST"),
        help="find the departure of the shortest passage between two times (ISO 8601, UTC); "
        "for the objectives time and distance",
    )
    parser.add_argument("--arrive-by", metavar="TIME", help="latest arrival (ISO 8601, UTC)")
    parser.add_argument(
        "--arrive",
        metavar="TIME",
        help="arrival (ISO 8601, UTC): with --depart the one speed that arrives then (see --hold), "
        "without it the latest departure at --speed or the highest speed; with --objective fuel, "
        "energy, cost, co2 or front the same as --arrive-by",
    )
    parser.add_argument(
        "--speed",
        type=float,
        metavar="KN",
        help="ordered speed through calm water [kn], also between the settings of the ship file, "
        "and below them unless its power is a table (a note says so); default: its highest (for "
        "time and distance), or a choice leg by leg",
    )
    options.add_hold_option(parser, with_arrival=True)
    parser.add_argument(
        "--speed-step",
        type=float,
        metavar="KN",
        help="where speeds are chosen leg by leg: speeds between the settings of the ship file "
        "count too, none farther from the next than this [kn] (default: the settings alone)",
    )
    parser.add_argument(
        "--speed-block",
        type=float,
        metavar="H",
        help="least time that a speed is held where speeds are chosen leg by leg [h], or a quarter "
        "of the voyage where that is less; 0: none (default: 6; 0 with --method exact)",
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
        metavar="time|distance|fuel|energy|cost|co2|comfort|encounters|inshore|front",
        help="quantity to minimise (default: time). energy: propulsion and hotel load. cost: fuel, "
        "time and dues; where fuel has no price, time and cubed speed at the costs of the ship "
        "file. comfort: motion sickness at the first place of the ship file. encounters: with "
        "other ships (--traffic). inshore: length within 3 nm of land. front: all trade-offs of "
        "time against fuel or cost (the Pareto front)",
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


def _add_cost_options(group: Any) -> None:
    options.add_price_options(group)
    group.add_argument(
        "--forbid",
        action="append",
        default=[],
        metavar="CANAL",
        help="canal that the ship may not use, for example suez,panama, or all; may be repeated",
    )


def _add_passage_options(group: Any) -> None:
    group.add_argument(
        "--offing",
        type=float,
        metavar="NM",
        help="least distance from land [nm] outside named passages and near the ends; 0: none, "
        "and passages too small for the ship stay open; "
        "default: by the size of the ship (0.5, 1 or 2)",
    )
    group.add_argument(
        "--ignore-shoals",
        action="store_true",
        help="count miles in shallow water like others, but keep out of named areas that dry "
        "(reefs, wind farms, oil fields); default: without depth data the ship keeps "
        "out of water shallower than the next depth contour beyond one and a half draughts where "
        "it can",
    )
    group.add_argument(
        "--ignore-lanes",
        action="store_true",
        help="do not count the approximate traffic separation schemes of the package; default: a "
        "mile against their traffic counts ten",
    )
    group.add_argument(
        "--open",
        action="append",
        default=[],
        metavar="NAME",
        help="passage that the ship may use though it is closed to ships of her size; all: all for "
        "small or local ships that her draught, beam and air draught allow; may be repeated",
    )
    group.add_argument(
        "--avoid",
        action="append",
        default=[],
        metavar="NAME",
        help="passage or canal that the ship may not use, for example 'Pentland Firth'; may be "
        "repeated",
    )


def run(arguments: argparse.Namespace) -> int:
    """Plan the voyage, print it and write its files."""
    option_values.prepare_output_folder(arguments)
    files_as = option_values.route_file_options(arguments)
    voyage, given = requested_plan(arguments)
    from thalweg.planning import plan

    try:
        made = plan(voyage, **given, proof=arguments.proof)
    except KeyboardInterrupt:
        print("stopped before a plan was found: there is no result", file=sys.stderr)
        return INTERRUPTED
    if arguments.verbose or arguments.json:
        arguments.progress("finding other ways")
        made = made.with_alternatives()
    if arguments.out:
        arguments.progress("writing the files and drawing the plots")
    files = made.write(arguments.out, files_as) if arguments.out else []
    if arguments.json:
        print(made.to_json())
    else:
        print_plan(made, files, verbose=arguments.verbose)
    return SUCCESS if made.best.feasible else NO_ROUTE


def requested_plan(arguments: argparse.Namespace) -> tuple[Voyage, dict[str, Any]]:
    """Return the voyage that the options request, and the other arguments of `plan`."""
    from thalweg.chart.ports import place_positions

    place_positions([arguments.start, arguments.goal, *arguments.via])  # refuses unknown ports
    resolution = option_values.resolution_m(arguments.resolution)
    option_values.check_chart_files(arguments)
    ship = option_values.with_given_prices(option_values.open_ship(arguments), arguments)
    # the packages of planning are imported after what can be refused without them
    from thalweg.planning.request.early_checks import check_request
    from thalweg.planning.request.ordered_speed import with_exact_speed, with_ordered_speed
    from thalweg.route import with_wind_speed

    if arguments.speed is not None:  # a speed is refused before data are opened
        if arguments.hold is None:
            with_ordered_speed(ship, arguments.speed)
        else:
            with_exact_speed(ship, arguments.speed, arguments.hold)
    sea = option_values.open_sea(arguments)
    voyage = _voyage(arguments, sea, ship)
    if not sea.members:
        check_request(voyage, ship, with_wind_speed(ship, sea))
    announce_compilation(search=True, quiet=arguments.quiet)
    warm_up.start_compiling("thalweg.planning.compile_kernels")
    return voyage, {
        "ship": ship,
        "sea": sea,
        "chart": option_values.open_chart(arguments),
        "network": requested_network(arguments),
        "resolution": resolution,
        "progress": arguments.progress,
    }


def _voyage(arguments: argparse.Namespace, sea: Sea, ship: Ship) -> Voyage:
    from thalweg.planning import Voyage

    depart = arguments.depart
    if depart is None and arguments.depart_window is None and arguments.arrive is None:
        depart = _default_departure(arguments, sea, ship)
    return Voyage(
        start=arguments.start,
        goal=arguments.goal,
        via=tuple(arguments.via),
        depart=depart,
        depart_window=tuple(arguments.depart_window) if arguments.depart_window else None,
        arrive_by=arguments.arrive_by,
        arrive=arguments.arrive,
        objective=_objective(arguments),
        weights=_numbers("--weight", arguments.weight, "fuel=0.5"),
        at_most=_numbers("--at-most", arguments.at_most, "sick_percent=20"),
        at_least=_numbers("--at-least", arguments.at_least, "workable_percent=80"),
        wait=arguments.wait,
        speed_kn=arguments.speed,
        hold=arguments.hold,
        speed_step_kn=arguments.speed_step,
        speed_block_h=arguments.speed_block,
        min_ukc_m=arguments.ukc,
        seed=arguments.seed,
        fuel_price_usd=arguments.fuel_price,
        eca_price_factor=arguments.eca_price_factor,
        time_price_usd_per_h=arguments.time_price,
        forbid=tuple(name for given in arguments.forbid for name in given.split(",") if name),
        open=tuple(arguments.open),
        avoid=tuple(arguments.avoid),
        offing_nm=arguments.offing,
        layered=layered_request(arguments),  # type: ignore[arg-type]
        ignore_shoals=arguments.ignore_shoals,
        ignore_lanes=arguments.ignore_lanes,
        method=arguments.method,
        ensemble=arguments.ensemble,
    )


def _objective(arguments: argparse.Namespace) -> Any:
    if arguments.weight and arguments.objective in ("time", "weighted"):
        return "weighted"
    return arguments.objective


def _numbers(option: str, texts: Sequence[str], example: str) -> dict[str, float]:
    """Return the numbers of an option that is written NAME=NUMBER, several times.

    Raises
    ------
    InputError
        If one is not a number.
    """
    pairs = option_values.parse_pairs(option, texts, "NAME=NUMBER", example)
    try:
        return {name: float(text) for name, text in pairs.items()}
    except ValueError as error:
        raise InputError(
            f"{option} is not understood: {error}.",
            f"It is written NAME=NUMBER, such as {example}.",
            "Give the number in this form.",
        ) from None


def _default_departure(arguments: argparse.Namespace, sea: Sea, ship: Ship) -> float:
    """Return the departure of a command that states none, and print why."""
    from thalweg.chart.ports import place_positions
    from thalweg.core.units import KNOT
    from thalweg.planning.request.default_departure import default_departure

    places = place_positions([arguments.start, arguments.goal])
    speed = None if arguments.speed is None else arguments.speed * KNOT
    departure, reason = default_departure(sea, places[0], places[1], ship, speed)
    if not arguments.quiet:
        print(f"note: {reason}", file=sys.stderr)
    return departure
