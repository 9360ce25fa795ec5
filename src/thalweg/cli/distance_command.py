"""``thalweg distance``: the distance by sea between ports or positions."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any

from thalweg.cli import options
from thalweg.cli.exit_codes import SUCCESS
from thalweg.core.units import NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.planning.sea_distance import SeaDistance


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "distance",
        help="distance by sea between ports or positions",
        description="Print the shortest distance by sea, with the approaches of ports from the "
        "berth, the canals used and the straits passed. The first call builds a graph of all seas "
        "(10 to 20 s), which is kept.",
        epilog="Example: thalweg distance Rotterdam Singapore --avoid suez --speed 13.5",
    )
    options.add_table(parser, (
        ("start", "FROM", {}, "port, UN/LOCODE or LAT,LON [deg]"),
        ("goal", "TO", {}, "port, UN/LOCODE or LAT,LON [deg]"),
        ("--via", "PLACE", options.REPEATED, "place to pass; may be repeated"),
        ("--speed", "KN", options.NUMBER, "print the days at this speed [kn] as well"),
        ("--avoid", "NAME", {"action": "append", "default": None},
         "canal or passage that is not used, for example suez,panama or 'Pentland Firth'; all: "
         "all canals; none uses every canal (default: corinth, which is too small for most "
         "ships); may be repeated"),
        ("--open", "NAME", options.REPEATED,
         "passage for small or local ships that may be used, for example Canso; may be repeated"),
        ("--offing", "NM", options.NUMBER | {"default": 2.0},
         "distance from land that is kept outside passages, where there is so much water [nm] "
         "(default: 2)"),
        ("--draught", "M", options.NUMBER,
         "keep out of water shallower than the next depth contour (5, 10, 20, 30, 40, 50 m) "
         "beyond one and a half draughts [m] where it can, as plans do; default: shoals do not "
         "count"),
        ("--json", "", options.FLAG, "print JSON"),
    ))  # fmt: skip
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Print the distance."""
    from thalweg.chart.ports import place_positions

    place_positions([arguments.start, arguments.goal, *arguments.via])  # refuses unknown ports
    from thalweg.planning.sea_distance import SMALL_CANALS, sea_distance

    avoid: tuple[str, ...] = SMALL_CANALS
    if arguments.avoid is not None:
        names = [name.strip() for text in arguments.avoid for name in text.split(",")]
        avoid = tuple(name for name in names if name and name != "none")
    arguments.progress("finding the shortest way")
    way = sea_distance(
        arguments.start,
        arguments.goal,
        via=arguments.via,
        avoid=avoid,
        open=tuple(arguments.open),
        offing_nm=arguments.offing,
        draught_m=arguments.draught,
    )
    days = None if arguments.speed is None else way.days(arguments.speed)
    if arguments.json:
        more = {} if days is None else {"speed_kn": arguments.speed, "days": days}
        print(json.dumps(way.to_dict() | more, indent=2, allow_nan=False))
    else:
        _print_distance(way, arguments.speed, days)
        if arguments.draught is None:
            print("  shoals and draught were not considered: give --draught for a ship")
    return SUCCESS


def _print_distance(way: SeaDistance, speed: float | None, days: float | None) -> None:
    print(f"{way.start} to {way.goal}: {way.nm:,.0f} nm")
    if days is not None:
        print(f"  {days:.1f} days ({24.0 * days:.1f} h) at {speed:g} kn, canals at that speed")
    if way.canals:
        print(f"  canals: {', '.join(way.canals)}")
    if way.straits:
        print(f"  passes: {', '.join(way.straits)}")
    for name, length in way.approaches:
        print(f"  approach of {name}: {length / NAUTICAL_MILE:.1f} nm, part of the distance")
    for note in way.notes:
        print(f"  note: {note}")
