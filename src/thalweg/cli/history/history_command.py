"""``thalweg history``: networks of the routes that ships have taken."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any

from thalweg.cli import option_values, options
from thalweg.cli.exit_codes import SUCCESS
from thalweg.core.units import HOUR, KNOT, MINUTE, NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.network.history.history_network import HistoryNetwork
    from thalweg.network.history.history_route import HistoryRoute


def add_command(commands: Any) -> None:
    """Add the command with its actions to the parser."""
    parser = commands.add_parser(
        "history",
        help="make a network of the routes that ships have taken, and look up routes in it",
        description="Make a network of historic routes from AIS or noon tracks, and look up the "
        "usual route between two of its ports.",
    )
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    _add_build(actions)
    _add_route(actions)
    _add_compare(actions)


def _add_build(actions: Any) -> None:
    build = actions.add_parser(
        "build",
        help="make a network from tracks",
        description="Find port calls and voyages in tracks, cluster their turning points, and "
        "write the network of arcs between them.",
        epilog="Example: thalweg history build ais-2024-*.csv --out history.json",
    )
    build.add_argument(
        "tracks",
        nargs="+",
        metavar="TRACKS",
        help="CSV or Parquet files with columns for time, lat, lon and vessel; optional: draught, "
        "length",
    )
    build.add_argument("--out", required=True, metavar="NET", help="file to write (JSON)")
    build.add_argument(
        "--ports",
        metavar="FILE",
        help="CSV with the ports to use: name, lat, lon, locode, or names of known ports; default: "
        "the ports of the World Port Index where ships stop",
    )
    build.add_argument(
        "--corridors",
        metavar="FILE",
        help="GeoJSON lines across straits or other places that ships pass",
    )
    for name, default, unit, text in (
        ("radius", 10.0, "NM", "radius of a junction [nm]"),
        ("tolerance", 2.0, "NM", "turning points keep tracks within this distance [nm]"),
        ("interval", 5.0, "MIN", "time between positions that are kept [min]; 0 keeps all"),
        ("longest-gap", 6.0, "H", "time between positions that counts as a gap [h]"),
        ("fastest", 40.0, "KN", "highest possible speed between two positions [kn]"),
        ("slow", 1.0, "KN", "mean speed below which a ship stops [kn]"),
        ("shortest-stop", 1.0, "H", "shortest stop [h]"),
        ("reach", 5.0, "NM", "distance from a port within which a stop is a call [nm]"),
    ):
        build.add_argument(
            f"--{name}", type=float, default=default, metavar=unit,
            help=f"{text} (default: {default:g})",
        )  # fmt: skip
    build.add_argument(
        "--least", type=int, default=3, metavar="N",
        help="fewest voyages that make a junction, or an arc beside another one (default: 3)",
    )  # fmt: skip
    build.add_argument(
        "--column", nargs="+", action="extend", default=[], metavar="WHAT=NAME",
        help="column that holds time, lat, lon, draught, length or vessel",
    )  # fmt: skip
    build.add_argument("--time-format", metavar="FORMAT", help="format of the times as in strptime")
    build.add_argument("--json", action="store_true", help="print JSON")
    build.set_defaults(run=_build)


def _add_route(actions: Any) -> None:
    route = actions.add_parser(
        "route",
        help="print the usual route between two ports of a network",
        description="Print the route that ships usually take between two ports: its arcs, how "
        "many voyages were seen on each, and where no ship was seen.",
        epilog="Example: thalweg history route history.json Rotterdam 'New York' --month 1",
    )
    route.add_argument("network", metavar="NET", help="network made by thalweg history build")
    route.add_argument("start", metavar="FROM", help="port or UN/LOCODE")
    route.add_argument("goal", metavar="TO", help="port or UN/LOCODE")
    route.add_argument(
        "--month", type=int, metavar="1-12", help="leave out arcs that are closed in this month"
    )
    route.add_argument(
        "--draught", type=float, metavar="M",
        help="leave out arcs on which only smaller ships were seen [m]",
    )  # fmt: skip
    route.add_argument("--json", action="store_true", help="print JSON")
    route.set_defaults(run=_route)


def _add_compare(actions: Any) -> None:
    compare = actions.add_parser(
        "compare",
        help="the usual route between two ports against the best one",
        description="Sail the usual route of a network and the best route with the same ship, "
        "speed, departure and weather, from sea end to sea end.",
        epilog="Example: thalweg history compare history.json Rotterdam 'New York' --ship "
        "handysize-bulker --sea forecast.nc --depart 2026-01-10",
    )
    compare.add_argument("network", metavar="NET", help="network made by thalweg history build")
    compare.add_argument("start", metavar="FROM", help="port or UN/LOCODE")
    compare.add_argument("goal", metavar="TO", help="port or UN/LOCODE")
    compare.add_argument("--ship", required=True, metavar="NAME|FILE", help="ship or ship file")
    compare.add_argument("--speed", type=float, metavar="KN", help="ordered speed [kn]")
    compare.add_argument("--depart", required=True, metavar="TIME", help="departure (ISO 8601)")
    options.add_sea_options(compare)
    compare.add_argument("--json", action="store_true", help="print JSON")
    compare.set_defaults(run=_compare)


def _build(arguments: argparse.Namespace) -> int:
    from thalweg.chart import Chart
    from thalweg.network.history.history_builder import HistoryRules
    from thalweg.network.history.history_file import write_history
    from thalweg.operations.fleet import PortCallRules, history_from_tracks, read_fleet
    from thalweg.operations.fleet.history_from_tracks import read_corridors, read_history_ports
    from thalweg.operations.tracks import CleaningRules

    option_values.prepare_output_file(arguments.out)
    rules = HistoryRules(
        arguments.radius * NAUTICAL_MILE, arguments.tolerance * NAUTICAL_MILE, arguments.least
    )
    calls = PortCallRules(
        arguments.slow * KNOT, arguments.shortest_stop * HOUR, arguments.reach * NAUTICAL_MILE
    )
    cleaning = CleaningRules(arguments.longest_gap * HOUR, arguments.fastest * KNOT)
    chart = Chart.gshhg("i")
    ports = read_history_ports(arguments.ports, chart) if arguments.ports else None
    corridors = read_corridors(arguments.corridors) if arguments.corridors else ()
    arguments.progress("reading the tracks")
    fleet = read_fleet(
        arguments.tracks,
        columns=option_values.parse_pairs("--column", arguments.column, "WHAT=NAME", "lat=y"),
        time_format=arguments.time_format,
        cleaning=cleaning,
        interval=arguments.interval * MINUTE,
    )
    network = history_from_tracks(
        fleet, chart, ports=ports, corridors=corridors, rules=rules, calls=calls,
        progress=arguments.progress,
    )  # fmt: skip
    write_history(network, arguments.out)
    if arguments.json:
        print(json.dumps(_summary(network, arguments.out), indent=2, allow_nan=False))
    else:
        _print_summary(network, arguments.out)
    return SUCCESS


def _summary(network: HistoryNetwork, path: str) -> dict[str, Any]:
    kinds = network.arcs_by_kind()
    return {**network.summary, "ports": len(network.ports), "arcs": kinds, "file": path}


def _print_summary(network: HistoryNetwork, path: str) -> None:
    made = network.summary
    print(f"{made['voyages']:,} voyages of {made['ships']:,} ships from {made['first']} to "
          f"{made['last']}")  # fmt: skip
    counts = ", ".join(f"{count:,} {kind}" for kind, count in network.arcs_by_kind().items())
    print(f"  {len(network.ports)} ports, {len(network.nodes) - len(network.ports)} junctions; "
          f"arcs: {counts}")  # fmt: skip
    print(f"  {made['arcs_repaired']} arcs repaired over land, {made['outliers']} outliers")
    for note in made["notes"]:
        print(f"  note: {note}")
    print(f"wrote {path}")


def _route(arguments: argparse.Namespace) -> int:
    from thalweg.network.history.history_file import read_history

    network = read_history(arguments.network)
    found = network.route(
        arguments.start, arguments.goal, month=arguments.month, draught=arguments.draught
    )
    if arguments.json:
        print(json.dumps(found.to_dict(), indent=2, allow_nan=False))
    else:
        _print_route(found)
    return SUCCESS


def _print_route(route: HistoryRoute) -> None:
    print(f"{route.start.name} to {route.goal.name}: {route.nm:,.0f} nm")
    p10, p50, p90 = (time / HOUR for time in route.duration)
    if p50 == p50:  # known
        print(
            f"  {p50:.1f} h under way, without the approaches of the ports "
            f"(p10 {p10:.1f}, p90 {p90:.1f})"
        )
    print(f"  confidence {route.confidence}: {route.reason}")
    if route.eca_share == route.eca_share:
        print(f"  {100.0 * route.eca_share:.0f} % of the length in emission control areas")
    if route.passes:
        print(f"  passes: {', '.join(route.passes)}")
    for note in route.notes:
        print(f"  note: {note}")


def _compare(arguments: argparse.Namespace) -> int:
    from thalweg.chart import Chart
    from thalweg.network.history.history_file import read_history
    from thalweg.planning import Voyage, plan
    from thalweg.planning.history_plans import usual_against_optimal
    from thalweg.ship import Ship

    network = read_history(arguments.network)
    ship, sea = Ship.load(arguments.ship), option_values.open_sea(arguments)
    voyage = Voyage(
        start=arguments.start, goal=arguments.goal, depart=arguments.depart,
        speed_kn=arguments.speed,
    )  # fmt: skip
    chart = Chart.gshhg("i")
    comparison = usual_against_optimal(
        voyage, network, ship=ship, sea=sea, chart=chart,
        plan_one=lambda request: plan(
            request, ship=ship, sea=sea, chart=chart, proof=0.0, progress=arguments.progress
        ),
    ).to_dict()  # fmt: skip
    if arguments.json:
        print(json.dumps(comparison, indent=2, allow_nan=False))
        return SUCCESS
    print(f"{comparison['from']} to {comparison['to']}, confidence {comparison['confidence']} "
          f"({comparison['voyages']} voyages)")  # fmt: skip
    for name, title in (("distance_nm", "distance [nm]"), ("time_h", "time [h]"),
                        ("fuel_t", "fuel [t]")):  # fmt: skip
        row = comparison[name]
        if row["usual"] is None:
            print(f"  {title:14} not known")
        else:
            saved = row["saving_percent"]
            print(f"  {title:14} usual {row['usual']:,.1f}, optimal {row['optimal']:,.1f}: "
                  f"{abs(saved):.1f} % {'less' if saved >= 0.0 else 'more'}")  # fmt: skip
    if comparison["usual_passes"] != comparison["optimal_passes"]:
        for name in ("usual", "optimal"):
            print(f"  {name} by: {', '.join(comparison[f'{name}_passes']) or 'open water'}")
    print("  The optimal route keeps to traffic schemes; the usual one is as it was sailed.")
    for note in comparison["notes"]:
        print(f"  usual route: {note}")
    if not comparison["usual_within_limits"]:
        broken = comparison["usual_violations"]
        more = f", and {len(broken) - 1} more" if len(broken) > 1 else ""
        print("  the usual route exceeds a limit of this ship on this day: "
              f"{broken[0] if broken else 'it does not arrive'}{more}")  # fmt: skip
    return SUCCESS
