"""Options that several commands share, and how their values become objects."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from thalweg.core.errors import InputError
from thalweg.core.units import NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

FILLABLE = ("currents", "wind", "waves")


def add_ship_and_chart_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that name ship, sea and chart."""
    parser.add_argument("--ship", required=True, metavar="NAME|FILE", help="library ship or YAML")
    add_sea_options(parser)
    chart = parser.add_argument_group("chart")
    chart.add_argument("--depth", action="append", default=[], metavar="FILE", help="depth grid")
    chart.add_argument("--zones", action="append", default=[], metavar="FILE", help="GeoJSON zones")
    chart.add_argument(
        "--coast",
        default="i",
        choices=("c", "l", "i", "h", "f", "none"),
        help="GSHHG coastline resolution (h and f need thalweg[hires]; none: open water)",
    )
    parser.add_argument("--ukc", type=float, metavar="M", help="least under-keel clearance")
    parser.add_argument("--load-factor", type=float, metavar="0..1", help="0 empty, 1 full")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--out", metavar="DIR", help="folder for files and pictures")


def add_sea_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that name a sea; `open_sea` reads them."""
    sea = parser.add_argument_group("sea")
    sea.add_argument(
        "--sea",
        nargs="+",
        action="extend",
        metavar="FILE",
        help="met-ocean files, first has priority; 'storm' for the embedded modelled storm",
    )
    add_mapping_option(sea)
    sea.add_argument(
        "--average-over",
        type=float,
        metavar="M",
        help="average currents given in layers from the surface down to this draught",
    )
    sea.add_argument("--calm", action="store_true", help="no wind, waves or currents at all")
    sea.add_argument(
        "--fill",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=VALUE",
        help=f"take unknown {'/'.join(FILLABLE)} as this value (recorded in the plan)",
    )


def add_mapping_option(parser: Any) -> None:
    """Add the option that tells which variable of a file is which quantity."""
    parser.add_argument(
        "--map",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=VARIABLE",
        help="take a quantity from this variable of the files; crs=EPSG:... names a projection",
    )


def variable_mapping(arguments: argparse.Namespace) -> dict[str, str]:
    """Return what ``--map`` tells.

    Raises
    ------
    InputError
        If a part of it is not NAME=VARIABLE.
    """
    pairs = [text.partition("=") for text in arguments.map]
    for name, equals, variable in pairs:
        if not (name and equals and variable):
            raise InputError(
                f"--map {name}{equals}{variable} is not understood.",
                "It is written NAME=VARIABLE, such as eastward_wind=u or crs=EPSG:32611.",
                "Write it that way.",
            )
    return {name: variable for name, _, variable in pairs}


def open_sea(arguments: argparse.Namespace) -> Sea:
    """Build the sea that the options name."""
    from thalweg.sea import Sea

    policies = dict(_parse_fill_policy(text) for text in arguments.fill)
    _check_options(arguments)
    if not arguments.calm and not arguments.sea:
        raise InputError(
            "No sea is given.",
            "Weather is never assumed to be calm.",
            "Give --sea FILE..., --sea storm, or ask for --calm.",
        )
    if arguments.calm:
        return _check_ensemble_choice(Sea.calm(), arguments)
    files = [name for name in arguments.sea if name != "storm"]
    options: dict[str, Any] = {
        "mapping": variable_mapping(arguments),
        "draught_m": arguments.average_over,
    }
    layers = [Sea.open(*files, **options)] if files else []
    if len(files) > 1 and getattr(arguments, "ensemble", None) and not layers[0].members:
        layers = [Sea.ensemble(*files, **options)]
    if "storm" in arguments.sea:
        layers.append(Sea.storm())
    sea = layers[0] if len(layers) == 1 else Sea.layered(*layers)
    sea = _check_ensemble_choice(sea, arguments)
    return sea.filled(**policies) if policies else sea


def _check_options(arguments: argparse.Namespace) -> None:
    """Raise `InputError` for options that the sea asked for has no use for."""
    of_files = [("--map", arguments.map), ("--average-over", arguments.average_over is not None)]
    for option, given in [("--sea", arguments.sea), ("--fill", arguments.fill), *of_files]:
        if arguments.calm and given:
            raise InputError(
                f"Both --calm and {option} are given.",
                "A calm sea has no wind, waves or currents anywhere.",
                "Choose one.",
            )
    for option, given in of_files:
        if given and arguments.sea and set(arguments.sea) == {"storm"}:
            raise InputError(
                f"{option} is given, but no file.",
                "It is about files; the embedded storm is none.",
                "Leave it out, or name a file.",
            )


def _check_ensemble_choice(sea: Sea, arguments: argparse.Namespace) -> Sea:
    """Return a sea; raise `InputError` if a choice over members is asked for and it has none."""
    if getattr(arguments, "ensemble", None) and not sea.members:
        raise InputError(
            "--ensemble chooses over the members of a forecast, but the sea has none.",
            "A file may have a dimension of members (number, realization, ...), or there is a file "
            "for each member.",
            "Give such files by --sea, or leave --ensemble out.",
        )
    return sea


def _parse_fill_policy(text: str) -> tuple[str, float | str]:
    name, _, value = text.partition("=")
    try:
        if name not in FILLABLE:
            raise ValueError
        return name, value if (name, value) == ("waves", "wind") else float(value)
    except ValueError:
        raise InputError(
            f"--fill {text} is not understood.",
            f"It is one of {', '.join(f'{n}=0' for n in FILLABLE)}, waves=wind.",
            "Write it that way.",
        ) from None


def open_chart(arguments: argparse.Namespace) -> Chart:
    """Build the chart that the options name."""
    from thalweg.chart import Chart

    if arguments.coast == "none":
        chart = Chart.open_water(-90.0, 90.0, -180.0, 180.0)
    else:
        chart = Chart.gshhg(arguments.coast)
    for path in arguments.depth:
        chart = chart.with_depth(path)
    for path in arguments.zones:
        chart = chart.with_zones(path)
    return chart


def open_ship(arguments: argparse.Namespace) -> Ship:
    """Build the ship that the options name."""
    from thalweg.ship import Ship

    ship = Ship.load(arguments.ship)
    if arguments.load_factor is not None:
        ship = ship.with_load_factor(arguments.load_factor)
    return ship


def progress_callback(arguments: argparse.Namespace) -> Callable[[str], None] | None:
    """Return a function that shows what is being done, or None when output is piped or JSON."""
    if arguments.json or not sys.stderr.isatty():
        return None
    from rich.console import Console

    console = Console(stderr=True)
    return lambda text: console.print(f"[dim]{text}[/dim]")


def resolution_m(value_nm: float | None) -> float | None:
    """Turn the option in nautical miles into metres, refusing what cannot be."""
    if value_nm is None:
        return None
    if not 0.001 <= value_nm <= 300:
        raise InputError(
            f"A resolution of {value_nm:g} nm cannot be.", "0.001 to 300 nm.", "Correct it."
        )
    return value_nm * NAUTICAL_MILE
