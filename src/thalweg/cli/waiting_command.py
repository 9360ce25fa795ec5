"""``thalweg waiting``: what it saves to wait for a better current before each trip."""

from __future__ import annotations

import argparse
import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.cli import options
from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, inverse
from thalweg.core.time import format_time, parse_time
from thalweg.core.units import HOUR

if TYPE_CHECKING:
    from thalweg.operations.waiting.trip_table import TripTable
    from thalweg.operations.waiting.waiting_study import WaitingStudy
    from thalweg.sea import Sea
    from thalweg.ship import Ship

SCENARIOS = ("neap", "neap-to-mean", "mean-to-spring", "spring")
TABLE_REFINEMENT = 30  #: departures that are planned for each that is sailed
_SLOW = 1.5  # how much longer than in still water a trip may take, for the length of the tables


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "waiting",
        help="what waiting for a better current saves on repeated trips",
        description="Sail to and fro between two positions, with and without waiting for the tide.",
    )
    parser.add_argument("start", metavar="FROM", help="LAT,LON where the ship loads")
    parser.add_argument("goal", metavar="TO", help="LAT,LON where it unloads")
    options.add_ship_and_chart_options(parser)
    parser.add_argument(
        "--north-sea",
        choices=SCENARIOS,
        metavar="|".join(SCENARIOS),
        help="instead of --sea: the analytic tide along a straight coast at TO, 25 m deep",
    )
    parser.add_argument("--depart", required=True, metavar="T", help="ready for the first trip")
    parser.add_argument("--cycles", type=int, default=5, metavar="N", help="0: one way only")
    parser.add_argument("--most-wait", type=float, default=12.4, metavar="H", help="before a trip")
    parser.add_argument("--starts", type=int, metavar="N", help="spread over one tide of 12.42 h")
    parser.add_argument("--hotel-kw", type=float, metavar="KW", help="by default that of the ship")
    parser.add_argument("--ship-back", metavar="NAME|FILE", help="the ship as it sails back")
    parser.add_argument(
        "--step", type=float, default=5.0, metavar="MIN", help="of the departures sailed"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Study, print and write."""
    from thalweg.operations.waiting.waiting_study import break_even_power, waiting_study
    from thalweg.sea.models.stratified_coast import M2_PERIOD

    _check(arguments)
    if arguments.out:
        from thalweg.planning.report.output_files import make_folder

        make_folder(arguments.out)
    trips = _trips(arguments)
    count = arguments.starts or (4 if arguments.north_sea else 1)
    starts = parse_time(arguments.depart) + np.arange(count) * M2_PERIOD / count
    waits = np.linspace(0.0, arguments.most_wait * HOUR, 13)
    hotel = _hotel_power(arguments)
    study = waiting_study(trips, starts=starts.tolist(), max_waits=waits, hotel_power=hotel)
    even = {
        rule: [
            break_even_power(trips, start=float(s), max_wait=float(waits[-1]), rule=rule)
            for s in starts
        ]
        for rule in ("current", "optimum")
    }
    files = _write(study, arguments) if arguments.out else []
    if arguments.json:
        kilowatts = {r: [_kilowatts(p) for p in powers] for r, powers in even.items()}
        found = {**study.as_dict(), "break_even_kw": kilowatts, "files": files}
        print(json.dumps(found, indent=2, allow_nan=False))
        return 0
    _print_study(study, even)
    for path in files:
        print(f"wrote {path}")
    return 0


def _check(arguments: argparse.Namespace) -> None:
    for name, value, least in (
        ("--cycles", arguments.cycles, 0),
        ("--starts", 1 if arguments.starts is None else arguments.starts, 1),
        ("--most-wait", arguments.most_wait, 0.0),
        ("--hotel-kw", arguments.hotel_kw or 0.0, 0.0),
    ):
        if not (math.isfinite(value) and value >= least):
            raise InputError(
                f"{name} {value:g} cannot be.", f"It is at least {least:g}.", "Correct it."
            )
    if arguments.north_sea and (arguments.sea or arguments.calm):
        raise InputError("Both --north-sea and --sea or --calm are given.", "", "Choose one.")
    for name in ("fill", "map", "average_over"):
        if arguments.north_sea and getattr(arguments, name):
            raise InputError(
                f"--{name.replace('_', '-')} is given with --north-sea.",
                "The analytic tide has no wind and no waves, and is averaged over the draught.",
                "Leave it out, or give a sea of your own (--sea).",
            )


def _place(text: str) -> Position:
    from thalweg.core.geodesy import parse_position

    position = parse_position(text)
    if position is None:
        raise InputError(
            f"{text!r} is not a position.",
            "A position is LAT,LON in degrees, such as 52.1,3.97.",
            "Write it that way.",
            value=text,
        )
    return position


def _ships(arguments: argparse.Namespace) -> tuple[Ship, Ship]:
    """Return the ship as it sails there (full) and back (empty)."""
    from thalweg.ship import Ship

    there = options.open_ship(arguments)
    if arguments.load_factor is None:
        there = there.with_load_factor(1.0)
    back = Ship.load(arguments.ship_back or arguments.ship)
    return there, back.with_load_factor(0.0)


def _trips(arguments: argparse.Namespace) -> list[TripTable]:
    from thalweg.operations.waiting.trip_durations import trip_table
    from thalweg.sea.models.stratified_coast import M2_PERIOD

    ends = _place(arguments.start), _place(arguments.goal)
    start = parse_time(arguments.depart)
    chart = options.open_chart(arguments)
    one_way = arguments.cycles == 0
    period = M2_PERIOD if arguments.north_sea else None
    legs = zip(("there", "back"), _ships(arguments), (ends, ends[::-1]))
    tables = []
    for name, ship, track in list(legs)[: 1 if one_way else 2]:
        way = [value for place in track for value in place]
        if bool(chart.legs_blocked(*way).any()):
            raise InputError(
                f"The straight way between {arguments.start} and {arguments.goal} is blocked.",
                "Land or a closed zone lies on it.",
                "Choose positions with open water between them, or --coast none.",
            )
        tables.append(
            trip_table(
                track,
                ship=ship,
                sea=_sea(arguments, ends, ship.draught),
                start=start,
                end=None if period else start + _window(arguments, way, ship),
                period=period,
                step=60.0 * arguments.step,
                chart=chart,
                min_ukc=arguments.ukc,
                name=name,
            ).refined(TABLE_REFINEMENT)
        )
    return tables if one_way else tables * arguments.cycles


def _window(arguments: argparse.Namespace, way: list[float], ship: Ship) -> float:
    """Return how long departures are needed [s]."""
    longest = _SLOW * float(inverse(*way)[0]) / float(ship.speeds[-1])
    trips = max(1, 2 * arguments.cycles)
    return trips * (longest + arguments.most_wait * HOUR)


def _sea(arguments: argparse.Namespace, ends: tuple[Position, Position], draught: float) -> Sea:
    if not arguments.north_sea:
        return options.open_sea(arguments)
    from thalweg.sea import Sea
    from thalweg.sea.models.current_profiles import WaterColumn
    from thalweg.sea.models.stratified_coast import stratified_coast_current

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
    if arguments.hotel_kw is not None:
        return 1000.0 * float(arguments.hotel_kw)
    return options.open_ship(arguments).hotel_power


def _kilowatts(power: float) -> float | None:
    return round(power / 1000.0, 3) if math.isfinite(power) else None


def _write(study: WaitingStudy, arguments: argparse.Namespace) -> list[str]:
    from pathlib import Path

    from thalweg.operations.plots.waiting_plot import draw_waiting

    folder = Path(arguments.out)
    folder.mkdir(parents=True, exist_ok=True)
    study.to_frame().to_csv(folder / "waiting.csv", index=False)
    text = json.dumps(study.as_dict(), indent=2, allow_nan=False)
    (folder / "waiting.json").write_text(text, encoding="utf-8")
    draw_waiting(study, folder / "waiting.png", title=f"{arguments.start} to {arguments.goal}")
    return [str(folder / name) for name in ("waiting.csv", "waiting.json", "waiting.png")]


def _print_study(study: WaitingStudy, even: dict[str, list[float]]) -> None:
    from rich.console import Console
    from rich.table import Table

    hotel = study.hotel_power / 1000.0
    table = Table(title=f"energy against not waiting [%], hotel power {hotel:g} kW")
    for name in ("ready", "rule"):
        table.add_column(name, no_wrap=True)
    shown = range(3, len(study.max_waits), 3)
    for j in shown:
        table.add_column(f"{study.max_waits[j] / HOUR:.1f} h", justify="right")
    table.add_column("all [h]", justify="right", no_wrap=True)
    table.add_column("even [kW]", justify="right", no_wrap=True)
    for i, start in enumerate(study.starts):
        for rule in ("none", "current", "next trip", "optimum"):
            change = 100.0 * (0.0 - study.saving(rule)[i])
            power = even[rule][i] if rule in even else math.nan
            table.add_row(
                format_time(float(start))[5:16] if rule == "none" else "",
                rule,
                *("" if rule == "none" else f"{change[j]:+.2f}" for j in shown),
                f"{study.plans[rule][i][-1].duration / HOUR:.1f}",
                "" if math.isnan(power) else f"{power / 1000.0:.1f}",
            )
    console = Console()
    console.print(table)
    console.print(
        f"{len(study.trips)} trips. Columns: longest wait before each trip. all: from ready to the "
        "last arrival, longest wait allowed. even: hotel power above which that saves nothing."
    )
