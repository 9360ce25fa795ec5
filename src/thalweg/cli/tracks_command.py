"""``thalweg tracks``: find the activities in AIS or log tracks and compare speed models."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any

from thalweg.cli import option_values, options
from thalweg.cli.operations_tables import print_track_analysis
from thalweg.cli.tables import print_written
from thalweg.core.errors import InputError
from thalweg.core.units import KNOT

if TYPE_CHECKING:
    from thalweg.operations.tracks.track_analysis import TrackAnalysis


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "tracks",
        help="find the activities in a measured track and compare its speeds with models",
        description="Divide an AIS or log track (CSV) into loading, sailing full, unloading, "
        "sailing empty and waiting, by the areas of work. With a sea, compare the measured speeds "
        "with models.",
        epilog="Example: thalweg tracks ais.csv --areas areas.geojson --sea tide.nc --out results",
    )
    parser.add_argument(
        "file",
        metavar="FILE",
        help="CSV with columns for time, lat and lon; optional: speed, course, draught, power, "
        "vessel",
    )
    parser.add_argument(
        "--areas",
        required=True,
        metavar="FILE",
        help="GeoJSON polygons with the property activity: loading, unloading or waiting",
    )
    _add_reading_options(parser)
    _add_division_options(parser)
    options.add_sea_options(parser)
    parser.add_argument(
        "--ship", metavar="NAME|FILE", help="ship model to compare (needs --sea or --calm)"
    )
    parser.add_argument(
        "--speed",
        type=float,
        metavar="KN",
        help="ordered speed of that ship [kn]; default: its setting nearest to the measured speed",
    )
    options.add_output_options(
        parser, "activities.csv, legs.csv, cycles.csv, tracks.json and tracks.png"
    )
    parser.set_defaults(run=run)


def _add_reading_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--vessel", metavar="ID", help="MMSI or name of the ship, if the file has several"
    )
    parser.add_argument(
        "--column",
        nargs="+",
        action="extend",
        default=[],
        metavar="WHAT=NAME",
        help="column that holds time, lat, lon, speed, course, draught, power or vessel, for "
        "example --column time=t_gps lat=y",
    )
    parser.add_argument(
        "--time-format",
        metavar="FORMAT",
        help="format of the times as in strptime, for example '%%d/%%m/%%Y %%H:%%M:%%S'; default: "
        "recognised",
    )


def _add_division_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--longest-gap",
        type=float,
        default=30.0,
        metavar="MIN",
        help="time between positions that counts as a gap [min] (default: 30)",
    )
    parser.add_argument(
        "--fastest",
        type=float,
        default=40.0,
        metavar="KN",
        help="highest possible speed between two positions [kn] (default: 40); positions that "
        "need more are left out",
    )
    parser.add_argument(
        "--slow",
        type=float,
        default=2.0,
        metavar="KN",
        help="outside the areas, a lower speed over ground than this counts as waiting [kn] "
        "(default: 2)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Analyse the track, print its tables and write its files."""
    option_values.prepare_output_folder(arguments)
    if arguments.ship and not (arguments.sea or arguments.calm):
        raise InputError(
            "--ship is given, but no sea is given.",
            "The ship model needs the currents (and its weather) along the track.",
            "Add --sea FILE..., or --calm.",
        )
    arguments.progress(f"analysing {arguments.file}")
    analysis = _analysis(arguments)
    files: list[str] = []
    if arguments.out:
        from thalweg.operations.result_files import write_track_files

        files = [str(path) for path in write_track_files(analysis, arguments.out)]
    if arguments.json:
        print(json.dumps({**analysis.as_dict(), "files": files}, indent=2, allow_nan=False))
        return 0
    print_track_analysis(analysis)
    print_written(files)
    return 0


def _analysis(arguments: argparse.Namespace) -> TrackAnalysis:
    from thalweg.operations.tracks import CleaningRules, SegmentationRules, analyse_tracks
    from thalweg.ship import Ship

    example = "lat=y"
    return analyse_tracks(
        arguments.file,
        arguments.areas,
        sea=option_values.open_sea(arguments) if arguments.sea or arguments.calm else None,
        ship=Ship.load(arguments.ship) if arguments.ship else None,
        speed_kn=arguments.speed,
        cutting=SegmentationRules(slow=arguments.slow * KNOT),
        cleaning=CleaningRules(
            longest_gap=60.0 * arguments.longest_gap, fastest=arguments.fastest * KNOT
        ),
        columns=option_values.parse_pairs("--column", arguments.column, "WHAT=NAME", example),
        vessel=arguments.vessel,
        time_format=arguments.time_format,
    )
