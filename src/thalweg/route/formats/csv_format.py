"""Routes as CSV: one row per waypoint, with a header."""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import replace
from pathlib import Path

from thalweg.core.errors import InputError
from thalweg.core.file_writing import write_csv_rows
from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.parsed_track import (
    GEOMETRY,
    SPEEDS,
    WAITS,
    ParsedTrack,
    carried_names,
    position_of,
    unused_column_notes,
    waypoint_track,
)  # fmt: skip
from thalweg.route.formats.route_file_options import RouteFileOptions
from thalweg.route.route import Route

_NAMES = {
    "lat": ("lat", "latitude", "lat_deg", "y"),
    "lon": ("lon", "long", "lng", "longitude", "lon_deg", "x"),
    "name": ("name", "waypoint", "waypoint name", "waypoint_name", "wp name", "wp_name"),
    "time": ("time", "datetime", "timestamp", "eta", "date"),
}

#: A number, or minutes before the letter of a hemisphere.
_DECIMAL_COMMA = re.compile(r"^([\s+NSEWnsew-]*(?:\d+[°\s-]+)?\d+),(\d+)([\s'′°]*[NSEWnsew]?\s*)$")
_SUMS = ("fuel_t", "energy_mwh", "co2_t", "cost_")  # columns that are sums from the start


def parse_csv(text: str) -> ParsedTrack:
    """Read CSV text with columns lat and lon, separated by comma, semicolon or tab.

    Positions are in degrees, or in degrees and minutes as ``37 53.5N``. Columns name, time,
    waiting_h and ordered_speed_kn are taken, too, and geometry: RL or GC for the leg
    after a waypoint, without it GC.

    Raises
    ------
    InputError : If there is no such header, or a row is not a position.
    """
    header_line = text.lstrip().partition("\n")[0]
    separator = max(",;\t", key=header_line.count)
    try:
        rows = [row for row in csv.reader(io.StringIO(text.lstrip()), delimiter=separator) if row]
    except csv.Error as error:
        raise InputError(
            f"The CSV cannot be read: {error}.",
            "A route is a table with a header and one waypoint per row.",
            "Check its quotes and that it is a table.",
        ) from None
    header = [_bare(name) for name in rows[0]] if rows else []
    lat, lon = _column(header, "lat"), _column(header, "lon")
    if lat is None or lon is None:
        raise InputError(
            "The CSV has no columns of latitude and longitude.",
            f"Its first line is {header_line.strip()[:80]!r}; needed are lat and lon (and time).",
            "Give it a header such as lat,lon,time.",
        )
    if separator != ",":  # then a comma is the decimal sign of many languages
        for row in rows[1:]:
            row[:] = [re.sub(_DECIMAL_COMMA, r"\1.\2\3", cell) for cell in row]
    _check_last_row(rows)
    positions = [_position(row, lat, lon, i) for i, row in enumerate(rows[1:], start=1)]
    time = _column(header, "time")
    times = [None if time is None else _cell_of(row, time) for row in rows[1:]]
    given = {name: header.index(name) for name in (*WAITS, *SPEEDS, GEOMETRY) if name in header}
    values = [{name: _cell_of(row, k) for name, k in given.items()} for row in rows[1:]]
    parsed = waypoint_track(positions, times, values)
    notes = [f"its column {one}" for one in unused_column_notes(header)]
    label = _column(header, "name")
    texts = [] if label is None else [_cell_of(row, label) for row in rows[1:]]
    return replace(parsed, notes=notes, extensions=carried_names(texts, positions))


def write_csv(route: Route, path: str | Path, options: RouteFileOptions | None = None) -> None:
    """Write the table of waypoints of a route; unknown values are left empty.

    A column without any value, such as the cost of a ship without prices, is left out.

    Parameters
    ----------
    route : Route
    path : str or Path
    options : RouteFileOptions, optional
        Names and waypoints.
    """
    rows = file_route(route, options).rows
    names = [name for name in rows[0] if _is_known(name, [_cell(row[name]) for row in rows])]
    write_csv_rows(path, [names, *([_cell(row[name]) for name in names] for row in rows)])


def _is_known(name: str, values: list[object]) -> bool:
    """Return whether a column has a value; an unknown sum has that of the start alone, zero."""
    known = [value for value in values if value != ""]
    return bool(known) and not (name.startswith(_SUMS) and known == [0.0])


def _check_last_row(rows: list[list[str]]) -> None:
    """Raise `InputError` where the last row has less than half of the columns of all others."""
    if len(rows) > 2 and 2 * len(rows[-1]) < min(map(len, rows[:-1])):
        raise InputError(
            f"The last row of the CSV has {len(rows[-1])} of {len(rows[0])} columns.",
            "All rows before it have more than twice as many: the file seems to be cut off.",
            "Get the whole file, or complete the row.",
        )


def _bare(name: str) -> str:
    """Return the name of a column without its unit in brackets, case and spaces."""
    return re.sub(r"[(\[].*?[)\]]", "", name).strip().casefold()


def _column(header: list[str], name: str) -> int | None:
    return next((header.index(n) for n in _NAMES[name] if n in header), None)


def _position(row: list[str], lat: int, lon: int, number: int) -> tuple[float, float]:
    if len(row) <= max(lat, lon):
        raise InputError(
            f"Waypoint {number} of the CSV has {len(row)} columns.",
            f"Latitude and longitude are columns {lat + 1} and {lon + 1}.",
            "Complete the row.",
        )
    return position_of(row[lat].strip(), row[lon].strip(), number)


def _cell_of(row: list[str], column: int) -> str:
    return row[column].strip() if column < len(row) else ""


def _cell(value: object) -> object:
    return "" if value is None or (isinstance(value, float) and math.isnan(value)) else value
