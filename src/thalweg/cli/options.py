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
        help="zones (GeoJSON with the property kind: no-go, penalty, price, eca, lane, "
        "anchorage, no-waiting); may be repeated",
    )
    chart.add_argument(
        "--traffic",
        action="append",
        default=[],
        metavar="FILE",
        help="traffic of other ships, for expected encounters: zones (GeoJSON with the property "
        "encounters_per_h, encounters_per_nm or ships_per_km2) or a grid of density (NetCDF, "
        "ships km-2); may be repeated",
    )
    chart.add_argument(
        "--coast",
        choices=("c", "l", "i", "h", "f", "none"),
        help="resolution of the GSHHG coastline: c (crude), l, i, h, f (full; h and f need "
        "thalweg[hires]); none: no land; default: h where it is installed, else i",
    )
    parser.add_argument(
        "--ukc",
        type=float,
        metavar="M",
        help="minimum under-keel clearance [m]: depth less draught, squat not subtracted; "
        f"default: {default_ukc}",
    )
    add_load_factor_option(parser)
    parser.add_argument(
        "--approach-speed",
        type=float,
        metavar="KN",
        help="greatest speed over ground in the approaches of ports [kn]; default: that of the "
        "ship file, or 10",
    )
    add_output_options(parser, "files and plots")
    _add_route_file_options(parser)


def _add_route_file_options(parser: argparse.ArgumentParser) -> None:
    files = parser.add_argument_group("route files", "Formats and waypoints of the files of --out.")
    files.add_argument(
        "--formats", metavar="LIST",
        help="formats by ending, separated by commas: rtz, rtzp, gml (S-421), gpx, geojson, kml, "
        "csv; or all; default: rtz,gpx,geojson,csv",
    )  # fmt: skip
    files.add_argument(
        "--xtd",
        type=float,
        metavar="NM",
        help="cross-track limit: the lines between the waypoints are closer to the route than this "
        "[nm]; default: 0.1",
    )
    files.add_argument(
        "--legs",
        choices=("rhumb", "great-circle"),
        help="lines between the waypoints: rhumb lines (default), as plotters sail them, or great "
        "circles",
    )
    files.add_argument(
        "--waypoint-spacing", type=float, metavar="NM", help="longest leg [nm]; default: no limit"
    )
    files.add_argument(
        "--max-waypoints",
        type=int,
        metavar="N",
        help="greatest number of waypoints; the cross-track limit grows as far as this needs",
    )
    files.add_argument(
        "--rtz", choices=("1.0", "1.1", "1.2"), metavar="VERSION",
        help="version of RTZ: 1.0, 1.1 or 1.2 (default)",
    )  # fmt: skip


def add_hold_option(parser: argparse.ArgumentParser, *, with_arrival: bool = False) -> None:
    """Add ``--hold``: what is held at the speed of ``--speed``, or ``--arrive`` where it exists."""
    text = (
        "what is held at --speed: the power that makes this speed in calm water, or the speed "
        "through water itself while the power allows"
    )
    if with_arrival:
        text += "; or ground, at the speed that arrives at --arrive: the speed over ground"
    parser.add_argument(
        "--hold",
        choices=("power", "speed", "ground") if with_arrival else ("power", "speed"),
        help=f"{text}; default: as the ship file orders",
    )


def add_price_options(group: Any) -> None:
    """Add the options that replace the prices of the ship file, and ``--no-eca``."""
    group.add_argument(
        "--fuel-price",
        type=float,
        metavar="USD",
        help="price of fuel [USD per tonne]; default: that of the ship file",
    )
    group.add_argument(
        "--eca-price-factor",
        type=float,
        metavar="F",
        help="price of fuel inside emission control areas divided by the price outside",
    )
    group.add_argument(
        "--time-price",
        type=float,
        metavar="USD",
        help="cost of time in addition to fuel [USD per hour], in place of the hire of the ship "
        "file; default: that hire",
    )
    group.add_argument(
        "--eu-share",
        type=int,
        choices=(0, 50, 100),
        metavar="0|50|100",
        help="share of the voyage in scope of charges of the European Union [%%]: 100 between two "
        "of its ports, 50 to or from one; default with --ets-price and --eur-rate: by the "
        "countries of the two ports of a plan (Union, Iceland, Norway); a route of 'thalweg "
        "evaluate' has no ports and needs it",
    )
    group.add_argument(
        "--ets-price",
        type=float,
        metavar="P",
        help="price of an emission allowance [currency of the prices per tonne of CO2]",
    )
    group.add_argument(
        "--eur-rate",
        type=float,
        metavar="R",
        help="price of a euro in the currency of the prices: counts the FuelEU penalty",
    )
    group.add_argument(
        "--eu-year",
        type=int,
        metavar="YEAR",
        help="year of the European Union's rules; default: that of the departure, or 2026 for "
        "departures before 2024",
    )
    group.add_argument(
        "--no-eca",
        action="store_true",
        help="ignore emission control areas; default: those in force count in every cost",
    )


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


def add_verbose_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--verbose``."""
    parser.add_argument(
        "--verbose",
        action="store_true",
        help="print the waypoints, lower bounds, all notes, networks and fingerprints as well",
    )


def add_quiet_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--quiet`` to a command, or to its actions if it has some."""
    actions = [a.choices for a in parser._actions if isinstance(a, argparse._SubParsersAction)]
    for choices in actions:
        for action in choices.values():
            add_quiet_option(action)
    if not actions:
        parser.add_argument(
            "--quiet", action="store_true", help="print no progress messages on stderr"
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
        "'storm': the modelled storm of the package; FILE@SOUTH,NORTH,WEST,EAST: the tide of one "
        "station (record, tide table or constituents) in a box of degrees",
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
        "m/s, m], for example --fill wind=0 waves=wind; wind=EAST,NORTH and currents=EAST,NORTH: "
        "the same vector [m/s, towards]; wind=waves: that which raises the known waves; "
        "waves=head_seas: waves of known height without direction "
        "come from ahead; NAME=nearest:NM: the nearest known value within so "
        "many nm (cells without data next to land); waves=coastal_shelter[:NM[:FACTOR]]: the same "
        "with 0.8 of the height; waves=fetch_limited: those of the local wind over its fetch to "
        "the coast; the result records it",
    )
    sea.add_argument(
        "--sampling",
        default="linear",
        metavar="linear|nearest:H",
        help="weather between its times: linear, or that of the nearest of updates H hours apart "
        "(quasi-static, to study what coarse updates do)",
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
    parser._negative_number_matcher = re.compile(r"^-\d[\d.]*([,;\sNSns°].*)?$")
