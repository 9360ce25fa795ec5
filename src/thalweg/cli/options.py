"""Definitions of the options that several commands share; `option_values` reads their values."""

from __future__ import annotations

import argparse
import re
from typing import Any

FILLABLE = ("currents", "wind", "waves")


def add_ship_and_chart_options(parser: argparse.ArgumentParser, *, default_ukc: str) -> None:
    """Add the options that name the ship, the sea and the chart, and the output options.

    ``default_ukc`` states the under-keel clearance without ``--ukc``.
    """
    parser.add_argument(
        "--ship",
        required=True,
        metavar="NAME|FILE",
        help="ship of the library (see 'thalweg ship --list') or a ship file (YAML)",
    )
    add_sea_options(parser)
    chart = parser.add_argument_group("chart")
    chart.add_argument(
        "--depth",
        action="append",
        default=[],
        metavar="FILE",
        help="grid of depths or elevations (NetCDF: GEBCO, ETOPO, EMODnet); may be repeated",
    )
    chart.add_argument(
        "--zones",
        action="append",
        default=[],
        metavar="FILE",
        help="zones (GeoJSON with the property kind: no-go, penalty, price, eca, anchorage, "
        "no-waiting); may be repeated",
    )
    chart.add_argument(
        "--coast",
        default="i",
        choices=("c", "l", "i", "h", "f", "none"),
        help="resolution of the GSHHG coastline: c (crude), l, i (default), h, f (full; h and f "
        "need thalweg[hires]); none: no land",
    )
    parser.add_argument(
        "--ukc",
        type=float,
        metavar="M",
        help=f"minimum under-keel clearance [m]; default: {default_ukc}",
    )
    add_load_factor_option(parser)
    add_output_options(parser, "files and plots")


def add_load_factor_option(parser: argparse.ArgumentParser) -> None:
    """Add the option for the load of the ship."""
    parser.add_argument(
        "--load-factor",
        type=float,
        metavar="0..1",
        help="load of the ship: 0 empty, 1 full; default: that of the ship file",
    )


def add_output_options(parser: argparse.ArgumentParser, contents: str) -> None:
    """Add ``--json`` and ``--out``; ``contents`` names what is written into the folder."""
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")
    parser.add_argument(
        "--out", metavar="DIR", help=f"folder for {contents}; created if it does not exist"
    )


def add_sea_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that name a sea."""
    sea = parser.add_argument_group("sea")
    sea.add_argument(
        "--sea",
        nargs="+",
        action="extend",
        metavar="FILE",
        help="met-ocean files (NetCDF, GRIB, Zarr); where they overlap, the first has priority; "
        "'storm': the modelled storm of the package",
    )
    add_mapping_option(sea)
    sea.add_argument(
        "--average-over",
        type=float,
        metavar="M",
        help="average currents that are given in layers from the surface to this depth [m]; "
        "default: the surface layer",
    )
    sea.add_argument("--calm", action="store_true", help="calm sea: no wind, waves or currents")
    sea.add_argument(
        "--fill",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=VALUE",
        help=f"value to use where {', '.join(FILLABLE[:-1])} or {FILLABLE[-1]} are missing [m/s, "
        "m/s, m], for example --fill wind=0 waves=wind; the result records it",
    )


def add_mapping_option(parser: Any) -> None:
    """Add the option that states which variable of a file holds which quantity."""
    parser.add_argument(
        "--map",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=VARIABLE",
        help="variable of the files that holds a quantity (CF standard name), for example "
        "eastward_wind=u; crs=EPSG:32611 names the projection of the grid",
    )


def accept_negative_positions(parser: argparse.ArgumentParser) -> None:
    """Let the parser read a position such as -33.9,151.2 as an argument, not as an option."""
    parser._negative_number_matcher = re.compile(r"^-\d[\d.]*([,;\s].*)?$")
