"""``thalweg alternatives``: routes of a voyage that differ, each the best in something."""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING, Any, Final

from thalweg.cli import option_values
from thalweg.cli.exit_codes import INTERRUPTED, SUCCESS
from thalweg.cli.plan_command import add_voyage_options, requested_plan
from thalweg.cli.tables import new_table, print_notes, print_written
from thalweg.core.errors import InputError

if TYPE_CHECKING:
    from thalweg.planning.indicators.alternative_plans import AlternativePlans
    from thalweg.planning.pareto.indicator_front import IndicatorFront

#: Figures that a row of the table shows; the files hold all.
_IN_TABLE: Final = (
    "time", "distance", "fuel", "cost", "sick_percent", "max_acceleration", "encounters",
    "inshore_percent", "land_distance_nm", "contour_distance_nm", "near_ground_h",
    "workable_percent",
)  # fmt: skip
#: What their names in the table mean.
_MEANINGS: Final = {
    "sick_percent": "sick: share of people seasick after the whole voyage at the first place of "
    "the ship file",
    "max_acceleration": "acceleration: greatest root mean square there, vertical",
    "encounters": "encounters: ships expected to be met",
    "inshore_percent": "inshore: share of the whole length within 3 nm of land",
    "land_distance_nm": "off land at sea: least distance from land, without approaches of "
    "ports and canals",
    "contour_distance_nm": "off shoals: least distance from charted water that is too shallow",
    "near_ground_h": "near ground: time within 1 nm of land or of water that is too shallow, "
    "approaches of ports included",
    "workable_percent": "workable: share of the time in which the first task can be done",
}


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "alternatives",
        help="compare routes of a voyage that differ",
        description="Plan a voyage for several objectives and by several ways, and print 2 to 5 "
        "routes that differ in their way, or in time on one way, with their key performance "
        "indicators and the difference in words. "
        "With --front, print the front of two key figures instead. Places and options are those "
        "of 'thalweg plan'.",
        epilog="Example: thalweg alternatives 63.67,9.30 66.57,11.67 --ship gunnerus-2019 "
        "--sea waves.nc --speed 9 --out results",
    )
    add_voyage_options(parser)
    parser.add_argument(
        "--most", type=int, default=5, metavar="N", help="greatest number of routes (default: 5)"
    )
    parser.add_argument(
        "--front",
        metavar="NAME,NAME",
        help="two key figures: their front on the network, with bounds, such as fuel,comfort",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Plan the alternatives, print them and write their files."""
    option_values.prepare_output_folder(arguments)
    files_as = option_values.route_file_options(arguments)
    voyage, given = requested_plan(arguments)
    try:
        if arguments.front:
            return _run_front(arguments, voyage, given)
        from thalweg.planning import alternative_plans

        found = alternative_plans(voyage, **given, most=arguments.most)
    except KeyboardInterrupt:
        print("stopped before the routes were found: there is no result", file=sys.stderr)
        return INTERRUPTED
    files = found.write(arguments.out, files_as) if arguments.out else []
    if arguments.json:
        print(json.dumps(found.to_dict(), indent=2, allow_nan=False))
    else:
        _print_alternatives(found)
        print_written(files)
    return SUCCESS


def _run_front(arguments: argparse.Namespace, voyage: Any, given: dict[str, Any]) -> int:
    """Print the front of two key figures."""
    from thalweg.core.file_writing import make_folder, write_text
    from thalweg.planning import indicator_front

    names = tuple(name.strip() for name in arguments.front.split(","))
    if len(names) != 2:
        raise InputError(
            f"--front {arguments.front} names {len(names)} key figures.",
            "A front has two, with a comma between them.",
            "Give two, such as --front fuel,comfort.",
        )
    found = indicator_front(voyage, (names[0], names[1]), **given)
    text = json.dumps(found.to_dict(), indent=2, allow_nan=False)
    if arguments.out:
        path = make_folder(arguments.out) / "indicator_front.json"
        write_text(path, text + "\n")
        print_written([path])
    if arguments.json:
        print(text)
    else:
        _print_indicator_front(found)
    return SUCCESS


def _print_indicator_front(found: IndicatorFront) -> None:
    from rich.console import Console

    from thalweg.core.objective import KEY_FIGURES

    heads = [f"{name} {KEY_FIGURES[name].unit}".rstrip() for name in found.names]
    columns = ("h", *heads, "gap %", "nm")
    table = new_table(f"front of {found.names[0]} and {found.names[1]}", columns, left=())
    for point in found.to_dict()["points"]:
        figures = (point[name] for name in found.names)
        cells = ("" if value is None else f"{value:,.4g}" for value in figures)
        length = point["waypoints"][-1]["distance_nm"]
        table.add_row(
            f"{point['time_h']:.2f}", *cells, f"{100 * point['gap']:.2f}", f"{length:.1f}"
        )
    console = Console()
    console.print(table)
    console.print(
        "The gap is how far a route may be above the true front of the network without waits.",
        soft_wrap=True,
    )


def _print_alternatives(found: AlternativePlans) -> None:
    """Print the routes in words, and a table of their figures."""
    from rich.console import Console

    from thalweg.planning.indicators.route_figures import (
        COMPARED_FIGURES,
        compared_values,
        figure_digits,
    )
    from thalweg.route.indicator_columns import INDICATORS
    from thalweg.route.number_texts import amount_column

    print(found)
    values = [compared_values(one.route) for one in found.choices]
    numbers = tuple(str(k) for k in range(1, len(values) + 1))
    table = new_table("", ("", *numbers), left=("",))
    shown: list[str] = []
    for name in _IN_TABLE:
        row = [one.get(name, float("nan")) for one in values]
        if name not in COMPARED_FIGURES or all(value != value for value in row):
            continue
        figure = COMPARED_FIGURES[name]
        unit = INDICATORS[name][0] or (found.choices[0].route.currency if name == "cost" else "")
        shown.append(name)
        digits = figure_digits(name, row)
        cells = ["-" if v != v else f"{v:,.{digits}f}" for v in row]
        if name == "fuel":
            cells, unit = amount_column(row, unit)
        table.add_row(f"{figure.short} {unit}".rstrip(), *cells)
    if any(one.canals for one in found.choices):
        table.add_row("canal dues USD", *(f"{one.canal_dues_usd:,.0f}" for one in found.choices))
    if any(slack is not None for slack in found.slack_h):
        table.add_row("slack h", *("-" if s is None else f"{s:.1f}" for s in found.slack_h))
    console = Console()
    console.print(table)
    explained = [_MEANINGS[name] for name in _IN_TABLE if name in shown and name in _MEANINGS]
    console.print("; ".join(explained) + ("." if explained else ""), soft_wrap=True)
    print_notes(console, found.notes)
