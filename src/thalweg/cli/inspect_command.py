"""``thalweg inspect``: list what was recognised in a met-ocean file."""

from __future__ import annotations

import argparse
import json
from typing import Any

from thalweg.cli import option_values, options
from thalweg.cli.tables import print_written
from thalweg.core.errors import InputError


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "inspect",
        help="list the variables, coverage and gaps of a met-ocean file",
        description="List the variables that were recognised in a file and those that were not, "
        "with their coverage, time steps and gaps.",
        epilog="Example: thalweg inspect forecast.nc --out results",
    )
    parser.add_argument(
        "file", nargs="+", metavar="FILE", help="met-ocean file (NetCDF, GRIB, Zarr)"
    )
    options.add_mapping_option(parser)
    parser.add_argument(
        "--time",
        metavar="TIME",
        help="time of the map (ISO 8601, UTC); default: the time with the highest values",
    )
    options.add_output_options(parser, "the maps (sea.png, or sea_1.png and so on)")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Inspect the files, print what was found and draw the map."""
    from thalweg.core.file_writing import make_folder
    from thalweg.planning.report.output_files import draw_sea
    from thalweg.sea import Sea

    if arguments.time and not arguments.out:
        raise InputError(
            "--time is given without --out.",
            "It is the time of the map, which is written into the folder of --out.",
            "Add --out DIR, or omit --time.",
        )
    folder = make_folder(arguments.out) if arguments.out else None
    arguments.progress(f"reading {', '.join(arguments.file)}")
    sea = Sea.open(*arguments.file, mapping=option_values.variable_mapping(arguments))
    found = sea.describe().as_dict()
    if arguments.json:
        print(json.dumps(found, indent=2, allow_nan=False))
    else:
        _print_inspection(found)
    if folder:
        arguments.progress("drawing the maps")
        shown = sea.member(0) if sea.members else sea
        plots = draw_sea(shown, folder, time=arguments.time)
        if not arguments.json:
            print_written(plots)
    return 0


def _print_inspection(inspection: dict[str, Any]) -> None:
    if inspection["members"]:
        print(f"Ensemble of {inspection['members']} members; the first is shown")
    print("Recognised")
    for row in _merged(inspection["recognised"], ("file_variables", "units", "how")):
        names = ", ".join(row["file_variables"])
        print(f"  {names} [{row['units']}]: {row['how']}")
        for variable in row["variables"]:
            print(f"    {variable}")
    print("Coverage, and values in SI")
    for row in _merged(inspection["coverage"], _EXTENT_KEYS):
        read = inspection["times_read"].get(row["source"], [1, 1])
        part = (
            f"; values at {read[0]} of {read[1]} times, not all read" if read[0] < read[1] else ""
        )
        print(f"  {row['source']}: {_extent_text(row)}{part}")
        for variable in row["variables"]:
            missing = inspection["missing_fraction"].get(f"{row['source']}: {variable}", 0.0)
            share = _missing_text(missing)
            pair = inspection["ranges"].get(f"{row['source']}: {variable}")
            values = f" {pair[0]:.4g} to {pair[1]:.4g}" if pair else ""
            print(f"    {variable}{values}{share}")
    for gap in inspection["gaps"]:
        print(f"Gap: no data from {gap['after']} to {gap['before']}")
    for warning in inspection["warnings"]:
        print(f"Warning: {warning}")
    for row in inspection["ignored"]:
        print(f"Ignored {row['variable']}: {row['reason']}")


_EXTENT_KEYS = ("source", "south", "north", "west", "east", "start", "end", "step_s", "spacing_deg")


def _merged(rows: list[dict[str, Any]], keys: tuple[str, ...]) -> list[dict[str, Any]]:
    """Return one row for all rows with the same values of some keys, with their variables."""
    groups: dict[str, dict[str, Any]] = {}
    for row in rows:
        group = groups.setdefault(repr([row[key] for key in keys]), {**row, "variables": []})
        group["variables"].append(row["variable"])
    return list(groups.values())


def _extent_text(row: dict[str, Any]) -> str:
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


def _missing_text(share: float) -> str:
    if share >= 1.0:
        return ", EMPTY: no value at the positions and times that were read"
    return f", no value at {100 * share:.1f} % of the positions" if share else ""
