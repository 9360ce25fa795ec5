"""``thalweg tracks``: cut AIS or log tracks into activities and hold a model against them."""

from __future__ import annotations

import argparse
import json
import math
from typing import TYPE_CHECKING, Any

from thalweg.cli import options
from thalweg.core.errors import InputError
from thalweg.core.units import KNOT

if TYPE_CHECKING:
    from thalweg.operations.tracks.track_analysis import TrackAnalysis
    from thalweg.sea import Sea


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "tracks",
        help="cut a measured track into activities and compare it with a model",
        description="Cut an AIS or log track (CSV) into loading, sailing and unloading by areas.",
    )
    parser.add_argument("file", metavar="FILE", help="CSV with time, lat, lon and maybe more")
    parser.add_argument("--areas", required=True, metavar="FILE", help="GeoJSON of the areas")
    parser.add_argument("--vessel", metavar="ID", help="which ship, if there are several")
    parser.add_argument(
        "--column",
        nargs="+",
        action="extend",
        default=[],
        metavar="WHAT=NAME",
        help="which column is time, lat, lon, speed, course, draught, power or vessel",
    )
    parser.add_argument("--time-format", metavar="FORMAT", help="as of strptime")
    parser.add_argument("--longest-gap", type=float, default=30.0, metavar="MIN")
    parser.add_argument("--fastest", type=float, default=40.0, metavar="KN")
    parser.add_argument(
        "--slow", type=float, default=2.0, metavar="KN", help="slower on the way is waiting"
    )
    options.add_sea_options(parser)
    parser.add_argument("--ship", metavar="NAME|FILE", help="ship model to compare (needs --sea)")
    parser.add_argument("--speed", type=float, metavar="KN", help="ordered speed of the ship")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--out", metavar="DIR", help="folder for files and pictures")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Analyse, print and write."""
    from thalweg.operations.tracks.activities import SegmentationRules
    from thalweg.operations.tracks.track_analysis import analyse_tracks
    from thalweg.operations.tracks.track_cleaning import CleaningRules
    from thalweg.ship import Ship

    if arguments.out:
        from thalweg.planning.report.output_files import make_folder

        make_folder(arguments.out)
    if arguments.ship and not (arguments.sea or arguments.calm):
        raise InputError(
            "A ship is to be compared, but no sea is given.",
            "The ship model needs the currents (and its weather) along the track.",
            "Add --sea FILE..., or ask for --calm.",
        )
    analysis = analyse_tracks(
        arguments.file,
        arguments.areas,
        sea=_sea(arguments),
        ship=Ship.load(arguments.ship) if arguments.ship else None,
        speed_kn=arguments.speed,
        cutting=SegmentationRules(slow=arguments.slow * KNOT),
        cleaning=CleaningRules(
            longest_gap=60.0 * arguments.longest_gap, fastest=arguments.fastest * KNOT
        ),
        columns=_columns(arguments.column),
        vessel=arguments.vessel,
        time_format=arguments.time_format,
    )
    files = _write(analysis, arguments.out) if arguments.out else []
    if arguments.json:
        print(json.dumps({**analysis.as_dict(), "files": files}, indent=2, allow_nan=False))
        return 0
    _print_analysis(analysis)
    for path in files:
        print(f"wrote {path}")
    return 0


def _sea(arguments: argparse.Namespace) -> Sea | None:
    return options.open_sea(arguments) if arguments.sea or arguments.calm else None


def _columns(texts: list[str]) -> dict[str, str]:
    pairs = [text.partition("=") for text in texts]
    for what, equals, name in pairs:
        if not (what and equals and name):
            raise InputError(
                f"--column {what}{equals}{name} is not understood.",
                "It is written WHAT=NAME, such as lat=y.",
                "Write it that way.",
            )
    return {what: name for what, _, name in pairs}


def _write(analysis: TrackAnalysis, out: str) -> list[str]:
    from pathlib import Path

    from thalweg.operations.plots.track_plot import draw_tracks

    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    frames = {
        "activities.csv": analysis.activity_frame(),
        "legs.csv": analysis.leg_frame(),
        "cycles.csv": analysis.cycle_frame(),
    }
    for name, frame in frames.items():
        frame.to_csv(folder / name, index=False, date_format="%Y-%m-%dT%H:%M:%SZ")
    text = json.dumps(analysis.as_dict(), indent=2, allow_nan=False)
    (folder / "tracks.json").write_text(text, encoding="utf-8")
    draw_tracks(analysis, folder / "tracks.png")
    return [str(folder / name) for name in (*frames, "tracks.json", "tracks.png")]


def _print_analysis(analysis: TrackAnalysis) -> None:
    from rich.console import Console

    found, console = analysis.as_dict(), Console(markup=False)  # names may have brackets in them
    console.print(
        f"{found['vessel'] or 'ship'}: {found['start']} to {found['end']}, "
        f"{found['positions']} positions, {found['cycles']['count']} whole cycles "
        f"({found['cycles']['per_week']:.1f} a week)"
    )
    for note in found["notes"]:
        console.print(f"note: {note}", soft_wrap=True, highlight=False)
    _print_activities(console, found)
    _print_models(console, found)


def _print_activities(console: Any, found: dict[str, Any]) -> None:
    from rich.table import Table

    table = Table(title="activities")
    for name in ("activity", "count", "mean, h", "std, h", "sum, h", "share"):
        table.add_column(name, justify="left" if name == "activity" else "right", no_wrap=True)
    for row in found["activities"]:
        table.add_row(
            row["activity"],
            str(row["count"]),
            *(_number(row[key]) for key in ("mean_h", "std_h", "sum_h")),
            f"{100.0 * row['share']:.1f} %",
        )
    console.print(table)
    for kind, row in found["speeds"].items():
        deviation = _number(row["std_kn"])
        console.print(f"{kind}: {row['mean_kn']:.2f} ± {deviation} kn over {row['legs']} legs")


def _print_models(console: Any, found: dict[str, Any]) -> None:
    from rich.table import Table

    table = Table(title="modelled against measured speeds of the legs")
    for name in ("model", "legs", "slope", "intercept, kn", "r2", "RMSE_rel, %"):
        table.add_column(name, justify="left" if name == "model" else "right", no_wrap=True)
    for name, row in found["models"].items():
        intercept = None if row["intercept"] is None else row["intercept"] / KNOT
        values = (row["slope"], intercept, row["r2"], row["rmse_rel"])
        table.add_row(name, str(row["count"]), *(_number(v) for v in values))
    console.print(table)
    fit = found["calibration"]
    if fit is not None:
        speeds = ", ".join(f"{kind} {v / KNOT:.2f} kn" for kind, v in fit["speeds"].items())
        console.print(
            f"factor on the currents {fit['factor']:.3f} ± {fit['factor_error']:.3f} "
            f"(slope of one: {_number(fit['slope_one'])}); through water: {speeds}"
        )


def _number(value: float | None) -> str:
    return "" if value is None or not math.isfinite(value) else f"{value:.2f}"
