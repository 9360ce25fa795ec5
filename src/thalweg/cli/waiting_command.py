"""``thalweg waiting``: savings of waiting for a better current before each trip."""

from __future__ import annotations

import argparse
import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.cli import option_values, options
from thalweg.cli.first_run import announce_compilation
from thalweg.cli.operations_tables import print_waiting_study
from thalweg.cli.tables import print_written
from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, inverse
from thalweg.core.time import parse_time
from thalweg.core.units import HOUR

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.operations.waiting import Departures
    from thalweg.operations.waiting.trip_table import TripTable
    from thalweg.sea import Sea
    from thalweg.ship import Ship

SCENARIOS = ("neap", "neap-to-mean", "mean-to-spring", "spring")
TABLE_REFINEMENT = 30  #: departures of the plan for each departure that is simulated
_MAX_DURATION_RATIO = 1.5  # trip duration over that in still water, for the length of the tables
_WAITS = 13  # longest waits that are compared


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "waiting",
        help="energy saved by waiting for a better current on repeated trips",
        description="Sail to and fro between two positions, with and without waiting for the tide, "
        "and compare the energy.",
        epilog="Example: thalweg waiting 52.1,3.97 52.1,4.26 --ship vox-olympia --north-sea neap "
        "--depart 2026-01-01 --hotel-kw 0",
    )
    parser.add_argument("start", metavar="FROM", help="LAT,LON [deg] where the ship loads")
    parser.add_argument("goal", metavar="TO", help="LAT,LON [deg] where the ship unloads")
    options.add_ship_and_chart_options(parser, default_ukc="that of the ship file, or 0")
    parser.add_argument(
        "--ship-back",
        metavar="NAME|FILE",
        help="ship for the return trip (empty); default: that of --ship",
    )
    parser.add_argument(
        "--north-sea",
        choices=SCENARIOS,
        metavar="|".join(SCENARIOS),
        help="instead of --sea: the analytic tide along a straight coast at TO, 25 m deep",
    )
    _add_study_options(parser)
    parser.set_defaults(run=run)


def _add_study_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--depart",
        required=True,
        metavar="TIME",
        help="time at which the ship is ready for the first trip (ISO 8601, UTC)",
    )
    parser.add_argument(
        "--cycles",
        type=int,
        default=5,
        metavar="N",
        help="number of cycles of two trips (default: 5); 0: a single trip from FROM to TO",
    )
    parser.add_argument(
        "--max-wait",
        "--most-wait",  # the earlier name
        dest="max_wait",
        type=float,
        default=12.4,
        metavar="H",
        help="longest wait before each trip [h] (default: 12.4)",
    )
    parser.add_argument(
        "--starts",
        type=int,
        metavar="N",
        help="number of starts, evenly spread over one tide of 12.42 h; default: 1, or 4 with "
        "--north-sea",
    )
    parser.add_argument(
        "--hotel-kw",
        type=float,
        metavar="KW",
        help="hotel power, used all the time [kW]; default: that of the ship file",
    )
    parser.add_argument(
        "--step",
        type=float,
        default=5.0,
        metavar="MIN",
        help="time between the departures that are simulated [min] (default: 5)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Compare the departure rules, print the savings and write the files."""
    _check(arguments)
    announce_compilation(quiet=arguments.quiet)
    from thalweg.operations.waiting import break_even_power, waiting_study
    from thalweg.sea.models.stratified_coast import M2_PERIOD

    option_values.prepare_output_folder(arguments)
    trips = _trips(arguments)
    count = arguments.starts or (4 if arguments.north_sea else 1)
    starts = (parse_time(arguments.depart) + np.arange(count) * M2_PERIOD / count).tolist()
    waits = np.linspace(0.0, arguments.max_wait * HOUR, _WAITS)
    hotel, notes = _hotel_power(arguments), _ship_notes(arguments)
    arguments.progress("simulating the departures")
    study = waiting_study(trips, starts=starts, max_waits=waits, hotel_power=hotel)
    break_even = {
        rule: [
            break_even_power(trips, start=start, max_wait=float(waits[-1]), rule=rule)
            for start in starts
        ]
        for rule in ("current", "optimum")
    }
    files: list[str] = []
    if arguments.out:
        from thalweg.operations.result_files import write_waiting_files

        title = f"{arguments.start} to {arguments.goal}"
        files = [str(path) for path in write_waiting_files(study, arguments.out, title=title)]
    if arguments.json:
        kilowatts = {r: [_kilowatts(p) for p in powers] for r, powers in break_even.items()}
        found = {**study.as_dict(), "break_even_kw": kilowatts, "notes": notes, "files": files}
        print(json.dumps(found, indent=2, allow_nan=False))
        return 0
    print_waiting_study(study, break_even, notes)
    print_written(files)
    return 0


def _check(arguments: argparse.Namespace) -> None:
    """Raise `InputError` for numbers out of range and for options that contradict each other."""
    for name, value, least in (
        ("--cycles", arguments.cycles, 0),
        ("--starts", 1 if arguments.starts is None else arguments.starts, 1),
        ("--max-wait", arguments.max_wait, 0.0),
        ("--hotel-kw", arguments.hotel_kw or 0.0, 0.0),
    ):
        if not (math.isfinite(value) and value >= least):
            raise InputError(
                f"{name} is {value:g}.", f"It is at least {least:g}.", f"Correct {name}."
            )
    if arguments.north_sea and (arguments.sea or arguments.calm):
        raise InputError(
            f"Both --north-sea and {'--sea' if arguments.sea else '--calm'} are given.",
            "Each of them defines the whole sea.",
            "Choose one.",
        )
    for name in ("fill", "map", "average_over"):
        if arguments.north_sea and getattr(arguments, name):
            option = f"--{name.replace('_', '-')}"
            raise InputError(
                f"{option} is given with --north-sea.",
                "The analytic tide has no wind and no waves, and is averaged over the draught.",
                f"Omit {option}, or give your own sea (--sea).",
            )


def _trips(arguments: argparse.Namespace) -> list[TripTable]:
    """Return the tables of all trips, in the order in which they are sailed."""
    there, back = _ships(arguments)
    ends, chart = _ends(arguments), option_values.open_chart(arguments)
    slowest = min(
        float(ship.speeds[-1]) for ship in ((there, back) if arguments.cycles else (there,))
    )
    departures = _departures(arguments, ends, slowest)  # the same for both trips
    outward = _trip(arguments, "there", there, ends, chart, departures)
    if arguments.cycles == 0:
        return [outward]
    back_trip = _trip(arguments, "back", back, ends[::-1], chart, departures)
    return [outward, back_trip] * arguments.cycles


def _ends(arguments: argparse.Namespace) -> tuple[Position, Position]:
    return option_values.position_from_text(arguments.start), option_values.position_from_text(
        arguments.goal
    )


def _ship_notes(arguments: argparse.Namespace) -> list[str]:
    """Return what results of the ships must state, such as a load factor without effect."""
    from thalweg.ship.ship_assumptions import stated_assumptions

    there, back = _ships(arguments)
    ships = {"there": there} if arguments.cycles == 0 else {"there": there, "back": back}
    return [f"{name}: {text}" for name, ship in ships.items() for text in stated_assumptions(ship)]


def _ships(arguments: argparse.Namespace) -> tuple[Ship, Ship]:
    """Return the ship for the outward trip (full) and for the return trip (empty)."""
    from thalweg.ship import Ship

    there = option_values.open_ship(arguments)
    if arguments.load_factor is None:
        there = there.with_load_factor(1.0)
    back = Ship.load(arguments.ship_back or arguments.ship)
    return there, back.with_load_factor(0.0)


def _trip(
    arguments: argparse.Namespace,
    name: str,
    ship: Ship,
    track: tuple[Position, Position],
    chart: Chart,
    departures: Departures,
) -> TripTable:
    """Return the table of one trip along a straight leg."""
    from thalweg.operations.waiting import trip_table

    if bool(chart.legs_blocked(*track[0], *track[1]).any()):
        raise InputError(
            f"The straight leg between {arguments.start} and {arguments.goal} is blocked.",
            "It crosses land or a closed zone.",
            "Choose positions with open water between them, or --coast none.",
        )
    return trip_table(
        track,
        ship=ship,
        sea=_sea(arguments, ship.draught),
        departures=departures,
        chart=chart,
        min_ukc=arguments.ukc,
        name=name,
    ).refined(TABLE_REFINEMENT)


def _departures(
    arguments: argparse.Namespace, ends: tuple[Position, Position], speed: float
) -> Departures:
    """Return the departures of all trips; the highest speed [m/s] is that of the slower ship."""
    from thalweg.operations.waiting import Departures
    from thalweg.sea.models.stratified_coast import M2_PERIOD

    start, step = parse_time(arguments.depart), 60.0 * arguments.step
    if arguments.north_sea:
        return Departures(start, period=M2_PERIOD, step=step)
    longest = _MAX_DURATION_RATIO * float(inverse(*ends[0], *ends[1])[0]) / speed
    trips = max(1, 2 * arguments.cycles)
    return Departures(start, end=start + trips * (longest + arguments.max_wait * HOUR), step=step)


def _sea(arguments: argparse.Namespace, draught: float) -> Sea:
    """Return the sea of the files, or the analytic tide averaged over a draught [m]."""
    if not arguments.north_sea:
        return option_values.open_sea(arguments)
    from thalweg.sea import Sea
    from thalweg.sea.models.current_profiles import WaterColumn
    from thalweg.sea.models.stratified_coast import stratified_coast_current

    ends = _ends(arguments)
    onshore = float(np.degrees(inverse(*ends[0], *ends[1])[2]))
    current = stratified_coast_current(
        arguments.north_sea,
        coast=ends[1],
        onshore_deg=onshore,
        flood=arguments.depart,
        draught=draught,
    )
    bed = {"sea_floor_depth_below_geoid": lambda time, lat, lon: WaterColumn.depth + 0.0 * lat}
    return Sea.from_functions({**current, **bed}).filled(wind=0.0, waves=0.0)


def _hotel_power(arguments: argparse.Namespace) -> float:
    """Return the hotel power [W]."""
    if arguments.hotel_kw is not None:
        return 1000.0 * float(arguments.hotel_kw)
    return option_values.open_ship(arguments).hotel_power


def _kilowatts(power: float) -> float | None:
    return round(power / 1000.0, 3) if math.isfinite(power) else None
