"""``thalweg inspect``: what was recognised in a met-ocean file, and what not."""

from __future__ import annotations

import argparse
import json
from typing import Any

from thalweg.cli import options
from thalweg.core.errors import InputError


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "inspect",
        help="say what a met-ocean file holds",
        description="Print what was recognised in a file, its coverage, steps and gaps.",
    )
    parser.add_argument("file", nargs="+", metavar="FILE")
    options.add_mapping_option(parser)
    parser.add_argument("--time", metavar="T", help="time of the map; the most eventful by default")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--out", metavar="DIR", help="folder for the map")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Inspect, print and draw."""
    from thalweg.planning.report.output_files import draw_sea, make_folder
    from thalweg.sea import Sea

    if arguments.time and not arguments.out:
        raise InputError(
            "--time is that of the map, and no map is asked for.",
            "The map is drawn into the folder of --out.",
            "Add --out DIR, or leave --time out.",
        )
    folder = make_folder(arguments.out) if arguments.out else None
    sea = Sea.open(*arguments.file, mapping=options.variable_mapping(arguments))
    found = sea.describe().as_dict()
    if arguments.json:
        print(json.dumps(found, indent=2, allow_nan=False))
    else:
        _print_inspection(found)
    if folder:
        shown = sea.member(0) if sea.members else sea
        picture = draw_sea(shown, folder / "sea.png", time=arguments.time)
        if not arguments.json:
            print(f"wrote {picture}")
    return 0


def _print_inspection(found: dict[str, Any]) -> None:
    if found["members"]:
        print(f"Ensemble of {found['members']} members, of which the first is shown")
    print("Recognised")
    for row in _merged(found["recognised"], ("file_variables", "units", "how")):
        names = ", ".join(row["file_variables"])
        print(f"  {names} [{row['units']}]: {row['how']}")
        for variable in row["variables"]:
            print(f"    {variable}")
    print("Coverage")
    for row in _merged(found["coverage"], _EXTENT):
        print(f"  {_extent(row)}")
        for variable in row["variables"]:
            missing = found["missing_fraction"].get(f"{row['source']}: {variable}", 0.0)
            share = f", {100 * missing:.1f} % of the places without a value" if missing else ""
            print(f"    {variable}{share}")
    for gap in found["gaps"]:
        print(f"Gap: nothing from {gap['after']} to {gap['before']}")
    for row in found["ignored"]:
        print(f"Ignored {row['variable']}: {row['reason']}")


_EXTENT = ("source", "south", "north", "west", "east", "start", "end", "step_s", "spacing_deg")


def _merged(rows: list[dict[str, Any]], keys: tuple[str, ...]) -> list[dict[str, Any]]:
    """Return one row for all that agree in some keys, with their variables listed."""
    groups: dict[str, dict[str, Any]] = {}
    for row in rows:
        group = groups.setdefault(repr([row[key] for key in keys]), {**row, "variables": []})
        group["variables"].append(row["variable"])
    return list(groups.values())


def _extent(row: dict[str, Any]) -> str:
    parts = [
        f"latitude {row['south']:.2f} to {row['north']:.2f}",
        f"longitude {row['west']:.2f} to {row['east']:.2f}",
        f"{row['start']} to {row['end']}" if row["start"] else "at all times",
    ]
    if row["step_s"] is not None:
        parts.append(f"every {row['step_s'] / 60:g} min")
    if row["spacing_deg"] is not None:
        parts.append(f"spacing {row['spacing_deg']:.3g} degrees")
    return ", ".join(parts)
