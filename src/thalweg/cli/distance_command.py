"""``thalweg distance``: the distance by sea between ports or positions."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any

from thalweg.cli.exit_codes import SUCCESS
from thalweg.core.time import duration_text
from thalweg.core.units import DAY, NAUTICAL_MILE

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
    parser.add_argument("start", metavar="FROM", help="port, UN/LOCODE or LAT,LON [deg]")
    parser.add_argument("goal", metavar="TO", help="port, UN/LOCODE or LAT,LON [deg]")
    parser.add_argument(
        "--via", action="append", default=[], metavar="PLACE", help="place to pass; may be repeated"
    )
    parser.add_argument(
        "--speed", type=float, metavar="KN", help="print the days at this speed [kn] as well"
    )
    parser.add_argument(
        "--avoid",
        action="append",
        default=None,
        metavar="NAME",
        help="canal or passage that is not used, for example suez,panama or 'Pentland Firth'; all: "
        "all canals; none uses every canal (default: corinth, which is too small for most ships); "
        "a list is separated by semicolons where a name has a comma; may be repeated",
    )
    parser.add_argument(
        "--open",
        action="append",
        default=[],
        metavar="NAME",
        help="passage for small or local ships that may be used, for example Canso; all: all of "
        "them, for a ship shorter than 120 m; another passage is used in spite of --draught and "
        "the size of --ship; may be repeated",
    )
    parser.add_argument(
        "--offing",
        type=float,
        default=2.0,
        metavar="NM",
        help="distance from land that is kept outside passages, where there is so much water [nm] "
        "(default: 2)",
    )
    parser.add_argument(
        "--draught",
        type=float,
        metavar="M",
        help="keep out of water shallower than the next depth contour (5, 10, 20, 30, 40, 50 m) "
        "beyond one and a half draughts [m] where it can, as plans do; default: shoals do not "
        "count",
    )
    parser.add_argument(
        "--ship",
        metavar="FILE|NAME",
        help="ship file or name: her draught, the canals and passages that are too small for her, "
        "and passages for small ships where she is shorter than 120 m, as plans have them; "
        "--draught, --avoid and --open come first",
    )
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Print the distance."""
    from thalweg.chart.ports import place_positions

    place_positions([arguments.start, arguments.goal, *arguments.via])  # refuses unknown ports
    from thalweg.planning.network_selection.sea_distance_data import USUAL_DEPTH
    from thalweg.planning.sea_distance import sea_distance, small_ship_distance

    ship = None
    if arguments.ship is not None:
        from thalweg.ship import Ship

        ship = Ship.load(arguments.ship)
    arguments.progress("finding the shortest way")
    ends = arguments.start, arguments.goal
    draught = arguments.draught or (ship.draught if ship else None) or None
    options: dict[str, Any] = {"offing_nm": arguments.offing, "draught_m": arguments.draught}
    if arguments.avoid is not None:
        names = [name for text in arguments.avoid for name in names_in_list(text)]
        options["avoid"] = tuple(name for name in names if name != "none")
    way = sea_distance(*ends, via=arguments.via, open=arguments.open, ship=ship, **options)
    days = None if arguments.speed is None else way.days(arguments.speed)
    if arguments.json:
        more = {} if days is None else {"speed_kn": arguments.speed, "days": days}
        print(json.dumps(way.to_dict() | more, indent=2, allow_nan=False))
    else:
        _print_distance(way, arguments.speed, days)
        if draught is None:
            print(
                f"  keeps off water shallower than {USUAL_DEPTH:g} m; draught was not considered: "
                "give --draught for a ship"
            )
        if not (arguments.open or arguments.via or arguments.ship):
            small = small_ship_distance(way, *ends, **options)
            if small is not None:
                _print_small_ships(way, small)
    return SUCCESS


def names_in_list(text: str) -> list[str]:
    """Return the names of canals and passages in a list: one name, or several by ; or else by ,."""
    from thalweg.chart.passages import PASSAGES

    whole = text.strip().casefold()
    if any(passage.name.casefold() == whole for passage in PASSAGES):
        return [text.strip()]
    mark = ";" if ";" in text else ","
    return [name for part in text.split(mark) if (name := part.strip())]


def _print_small_ships(way: SeaDistance, small: SeaDistance) -> None:
    """Print the way by passages for small ships."""
    by = [name for name in small.straits if name not in way.straits]
    through = f" by {', '.join(by)}" if by else ""
    print(f"  ships shorter than 120 m: {_miles(small)} nm{through} (--open all)")


def _miles(way: SeaDistance) -> str:
    from thalweg.route.number_texts import decimals

    return f"{way.nm:,.{decimals([way.nm], most=1)}f}"


def _print_distance(way: SeaDistance, speed: float | None, days: float | None) -> None:
    print(f"{way.start} to {way.goal}: {_miles(way)} nm")
    if days is not None:
        in_days = f"{days:.{1 if days >= 1.0 else 2}f} days"
        print(f"  {duration_text(days * DAY)} ({in_days}) at {speed:g} kn, canals at that speed")
    if way.canals:
        print(f"  canals: {', '.join(way.canals)}")
    if way.straits:
        print(f"  passes: {', '.join(way.straits)}")
    for name, length in way.approaches:
        print(f"  approach of {name}: {length / NAUTICAL_MILE:.1f} nm, part of the distance")
    for note in way.notes:
        print(f"  note: {note}")
