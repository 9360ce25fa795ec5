"""``thalweg plan``: from two places to a refereed route."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from thalweg.cli import options
from thalweg.cli.exit_codes import INTERRUPTED, NO_ROUTE, SUCCESS
from thalweg.kernels.compilation import warm_up

if TYPE_CHECKING:
    from thalweg.planning import Plan, Voyage

_MAX_ROWS = 30


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "plan",
        help="plan a voyage",
        description="Plan a voyage between two places: positions (52.0N 4.1E as one argument, "
        "or 52.0,4.1), port names or UN/LOCODEs.",
    )
    parser.add_argument("start", metavar="FROM")
    parser.add_argument("goal", metavar="TO")
    parser.add_argument("--via", action="append", default=[], metavar="P", help="pass this place")
    options.add_ship_and_chart_options(parser)
    when = parser.add_mutually_exclusive_group()
    when.add_argument("--depart", metavar="T", help="departure, ISO 8601 UTC")
    when.add_argument("--depart-window", nargs=2, metavar=("T1", "T2"), help="best departure in it")
    parser.add_argument("--arrive-by", metavar="T", help="latest arrival")
    parser.add_argument(
        "--objective",
        default="time",
        metavar="time|distance|fuel|energy|cost|co2|front",
        help="what to make least; energy: propulsion and hotel load; cost: fuel, time and dues, or "
        "time and cubed speed by the ship file's costs where fuel has no price; front: the whole "
        "trade of time against fuel or cost",
    )
    parser.add_argument("--speed", type=float, metavar="KN", help="ordered speed through water")
    parser.add_argument(
        "--wait", action=argparse.BooleanOptionalAction, default=True, help="may stop and wait"
    )
    parser.add_argument("--network", default="auto", metavar="auto|lattice|mesh|globe")
    parser.add_argument("--resolution", type=float, metavar="NM", help="spacing of the network")
    parser.add_argument("--seed", type=int, default=0)
    _add_trade_options(parser.add_argument_group("fuel, cost, canals"))
    parser.set_defaults(run=run)


def _add_trade_options(group: Any) -> None:
    group.add_argument("--fuel-price", type=float, metavar="USD", help="price of a tonne of fuel")
    group.add_argument(
        "--eca-price-factor",
        type=float,
        metavar="F",
        help="price of fuel inside emission control areas over the price outside",
    )
    group.add_argument("--time-price", type=float, metavar="USD", help="what an hour costs besides")
    group.add_argument(
        "--forbid",
        action="append",
        default=[],
        metavar="CANAL",
        help="a canal, several with commas, or all; may be given again",
    )
    group.add_argument("--method", default="default", metavar="default|exact|nsga2|spea2|mpaes")
    group.add_argument(
        "--ensemble",
        nargs="?",
        const="mean",
        metavar="mean|cvar",
        help="choose over all members of a forecast by the mean or the mean of the worst tenth",
    )


def run(arguments: argparse.Namespace) -> int:
    """Plan, print and write."""
    warm_up.start_compiling("thalweg.planning.compile_kernels")
    from thalweg.planning import plan
    from thalweg.planning.report.output_files import make_folder

    if arguments.out:
        make_folder(arguments.out)
    ship, sea = options.open_ship(arguments), options.open_sea(arguments)
    try:
        found = plan(
            _voyage(arguments, sea),
            ship=ship,
            sea=sea,
            chart=options.open_chart(arguments),
            network=arguments.network,
            resolution=options.resolution_m(arguments.resolution),
            progress=options.progress_callback(arguments),
        )
    except KeyboardInterrupt:
        print("stopped: there was no plan yet, nothing is kept", file=sys.stderr)
        return INTERRUPTED
    files = found.write(arguments.out) if arguments.out else []
    if arguments.json:
        print(found.to_json())
    else:
        print_plan(found)
        each = [path for path in files if path.parent.name == "routes"]
        for path in files:
            if path not in each:
                print(f"wrote {path}")
        if each:
            print(f"wrote {each[0].parent} ({len(each)} files)")
    return SUCCESS if found.best.feasible else NO_ROUTE


def _voyage(arguments: argparse.Namespace, sea: Any) -> Voyage:
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


def _first_time(sea: Any) -> float:
    """Without --depart: the first moment of the data, or now where the sea has no period."""
    import time

    starts = [row.start for row in sea.coverage() if row.start is not None]
    return max(starts) if starts else float(round(time.time()))


def print_plan(plan: Plan) -> None:
    """Print a plan for a person."""
    from rich.console import Console

    console = Console()
    best = plan.best
    print_waypoints(console, best.waypoints(), _title(plan))
    parts = [f"{best.time_h:.2f} h", f"{best.distance_nm:.1f} nm"]
    if best.fuel_t is not None:
        parts.append(f"{best.fuel_t:.1f} t fuel")
    if best.cost is not None:
        parts.append(f"{best.cost:,.0f} {best.currency}")
    if best.energy_mwh is not None and plan.voyage.objective == "energy":
        parts.append(f"{best.energy_mwh:.2f} MWh")
    if best.co2_t is not None and plan.voyage.objective == "co2":
        parts.append(f"{best.co2_t:.1f} t CO2")
    if best.waiting_h > 0:
        parts.append(f"{best.waiting_h:.2f} h waiting")
    console.print("[bold]" + ", ".join(parts) + "[/bold]")
    console.print(
        f"Lower bound {plan.lower_bound:.2f} {plan.unit}, gap {100 * plan.gap:.1f} % "
        f"[dim]({plan.proof.kind})[/dim]; no route at all is better than "
        f"{plan.proof.certain:.2f} {plan.unit}.",
        soft_wrap=True,
    )
    if plan.front is not None:
        print_front(console, plan)
    for note in plan.notes:
        console.print(f"[yellow]note:[/yellow] {note}", soft_wrap=True)


def print_front(console: Any, plan: Plan) -> None:
    """Print the routes of a front, and what they save over the weather-blind route."""
    import numpy as np
    from rich import box
    from rich.table import Table

    from thalweg.planning.pareto.front_points import evenly_spaced_subset

    front = plan.front
    assert front is not None  # checked by the caller
    title = f"{front.criterion} against time ({front.unit})"
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD, padding=(0, 0, 0, 1))
    for name in ("h", front.criterion, "nm", "wait h", "gap %", "from", "way"):
        justify = "left" if name in ("from", "way") else "right"
        table.add_column(name, justify=justify, no_wrap=name != "way")  # type: ignore[arg-type]
    rows = sorted(front.rows(plan.routes), key=lambda row: float(row["time_h"]))
    shown = evenly_spaced_subset(
        np.array([row["time_h"] for row in rows]),
        np.array([row[front.column] for row in rows]),
        _MAX_ROWS,
    )
    for row in (rows[index] for index in shown):
        gap = "" if row["gap"] is None else f"{100 * row['gap']:.1f}"
        value = f"{row[front.column]:,.2f}"
        table.add_row(
            f"{row['time_h']:.2f}", value, f"{row['distance_nm']:.0f}", f"{row['waiting_h']:.1f}",
            gap, row["stage"], row["way"],
        )  # fmt: skip
    console.print(table)
    if len(rows) > len(shown):
        console.print(f"{len(shown)} of {len(rows)} routes; all are in front.csv with --out DIR.")
    for line in _savings(plan):
        console.print(line, soft_wrap=True)


def _savings(plan: Plan) -> list[str]:
    """Say what the front saves over the weather-blind route at its highest and lowest speed."""
    comparison = plan.front.comparison if plan.front is not None else None
    if comparison is None or plan.front is None:
        return []
    lines = []
    for row in {id(row): row for row in (comparison.rows[0], comparison.rows[-1])}.values():
        saved = []
        if row["saved"] is not None and row["saved"] > 0.0:
            saved.append(
                f"{row['saved']:,.2f} {plan.front.unit} ({row['saved_percent']:.1f} %) in its time"
            )
        if row["saved_h"] is not None and row["saved_h"] > 0.0:
            saved.append(f"{row['saved_h']:.2f} h for what it burns")
        lines.append(
            f"Weather-blind at {row['speed_kn']:.1f} kn: {row['time_h']:.2f} h, "
            f"{row['value']:,.2f} {plan.front.unit}"
            + ("" if row["feasible"] else " (breaks a limit)")
            + (f"; the front saves {', or '.join(saved)}." if saved else ".")
        )
    return lines


def print_waypoints(console: Any, waypoints: list[dict[str, Any]], title: str) -> None:
    """Print the table of a route's waypoints, narrow enough for any terminal."""
    from rich import box
    from rich.table import Table

    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD, padding=(0, 0, 0, 1))
    table.add_column("waypoint", no_wrap=True)
    table.add_column("UTC", no_wrap=True)
    for name in ("course", "nm", "stw", "sog", "wait", "ukc"):
        table.add_column(name, justify="right", no_wrap=True)
    for row in _shortened([_cells(row) for row in waypoints]):
        table.add_row(*row)
    console.print(table)


def _title(plan: Plan) -> str:
    return f"{plan.provenance['from']} to {plan.provenance['to']}, least {plan.voyage.objective}"


def _cells(row: dict[str, Any]) -> list[str]:
    def number(key: str, digits: int) -> str:
        value = row.get(key)
        return "" if value is None else f"{value:.{digits}f}"

    lat, lon = row["lat"], row["lon"]
    course = number("course_deg", 0)
    return [
        f"{abs(lat):6.3f}{'N' if lat >= 0 else 'S'} {abs(lon):7.3f}{'E' if lon >= 0 else 'W'}",
        str(row["time"] or "")[5:16].replace("T", " "),
        f"{int(course) % 360:03d}" if course else "",
        number("distance_nm", 1),
        number("speed_through_water_kn", 1),
        number("speed_over_ground_kn", 1),
        number("waiting_h", 2) if row.get("waiting_h") else "",
        number("ukc_m", 1),
    ]


def _shortened(rows: list[list[str]]) -> list[list[str]]:
    """Leave out the middle of a long table; the files hold all of it."""
    if len(rows) <= _MAX_ROWS:
        return rows
    half = _MAX_ROWS // 2
    dots = [f"... {len(rows) - 2 * half} more", *[""] * (len(rows[0]) - 1)]
    return [*rows[:half], dots, *rows[-half:]]
