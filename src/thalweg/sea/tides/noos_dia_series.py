"""Readers for series of water level in the formats NOOS (Matroos) and DIA (Donar).

* NOOS: a header of ``# Key : value`` lines, then ``YYYYMMDDhhmm value`` in metres.
* DIA (Rijkswaterstaat): blocks of ``KEY;value`` lines; ``TYD`` gives start, end and step; after
  ``[WRD]`` follow the values, each ``value/quality:``. Times are in MET (UTC+1) throughout the
  year, as in hatyan's component files. Quality 99 marks a missing value.
"""

from __future__ import annotations

import re
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.sea.files.projections import to_degrees

LENGTH_UNITS: Final[dict[str, float]] = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001}
MET_OFFSET_HOURS: Final = 1.0  #: [h] Middle European Time ahead of UTC
TIME_ZONES: Final = {
    "GMT": 0.0,
    "UTC": 0.0,
    "UT": 0.0,
    "Z": 0.0,
    "MET": MET_OFFSET_HOURS,
    "CET": MET_OFFSET_HOURS,
}
MISSING_VALUE_QUALITY: Final = 99  #: quality of a missing value in DIA files
#: coordinate systems of DIA files: EPSG code and size of one unit
COORDINATE_SYSTEMS: Final = {"RD": (28992, 0.01), "W84": (4326, 1e-6), "E50": (4230, 1e-6)}
_NOOS_ROW: Final = re.compile(r"^\s*(\d{12}|\d{14})\s+(\S+)\s*$")


class WaterLevelSeries(NamedTuple):
    """A series of water level and its description.

    Attributes
    ----------
    times : Seconds since 1970-01-01T00:00Z, (T,).
    level : Water level [m above datum], (T,).
    position : (float, float) or None
        Latitude and longitude [deg], if the file gives them.
    description : Format and location.
    """

    times: FloatArray
    level: FloatArray
    position: tuple[float, float] | None
    description: str


def is_noos(text: str) -> bool:
    """Return whether a text is a NOOS series: dates of twelve digits after its header."""
    row = next((x for x in text.splitlines() if x.strip() and not x.lstrip().startswith("#")), "")
    return _NOOS_ROW.match(row) is not None


def is_dia(text: str) -> bool:
    """Return whether a text is a DIA file."""
    return text.lstrip().startswith("[IDT;")


def read_noos(text: str, source: str) -> WaterLevelSeries:
    """Return the water level of a NOOS file.

    Parameters
    ----------
    text : Contents of the file.
    source : File name for messages.

    Raises
    ------
    DatasetError
        If it holds another quantity, several series, an unknown time zone or an invalid row.
    """
    header: dict[str, str] = {}
    rows: list[tuple[str, str]] = []
    for number, line in enumerate(text.splitlines(), 1):
        key, _, value = line.lstrip().lstrip("#").partition(":")
        if line.lstrip().startswith("#"):
            if rows:
                raise _series_file_error(
                    source, f"holds several series (another header in line {number})"
                )
            header[key.strip().lower()] = value.strip()
        elif line.strip():
            found = _NOOS_ROW.match(line)
            if found is None:
                raise _series_file_error(
                    source, f"has an invalid row in line {number}: {line.strip()[:40]!r}"
                )
            rows.append((found[1], found[2]))
    unit, zone = header.get("unit", "waterlevel"), header.get("timezone", "GMT").upper()
    if not unit.lower().startswith("waterlevel"):
        raise _series_file_error(source, f"holds {unit!r}, not a water level")
    if zone not in TIME_ZONES:
        raise _series_file_error(
            source, f"uses the time zone {zone!r}; known are {', '.join(TIME_ZONES)}"
        )
    times = _noos_times([stamp for stamp, _ in rows], source) - TIME_ZONES[zone] * HOUR
    place = [header[k] for k in ("location", "source") if header.get(k)]
    level = _parse_levels([value for _, value in rows], source)
    return WaterLevelSeries(
        times, level, _noos_position(header), ", ".join(["NOOS series", *place])
    )


def _noos_times(stamps: list[str], source: str) -> FloatArray:
    iso = [f"{s[:4]}-{s[4:6]}-{s[6:8]}T{s[8:10]}:{s[10:12]}:{s[12:] or '00'}" for s in stamps]
    try:
        return np.array(iso, "datetime64[s]").astype(np.float64)
    except ValueError as error:
        raise _series_file_error(source, f"holds an invalid date ({error})") from error


def _noos_position(header: dict[str, str]) -> tuple[float, float] | None:
    """Return (lat, lon) of a header's ``(lon,lat)``."""
    try:
        lon, lat = (float(x) for x in header.get("position", "").strip("() ").split(","))
    except ValueError:
        return None
    return (lat, lon) if abs(lat) <= 90.0 and abs(lon) <= 360.0 else None


def _parse_levels(words: list[str], source: str) -> FloatArray:
    try:
        return np.array(words, np.float64)
    except ValueError as error:
        raise _series_file_error(source, f"holds a level that is not a number ({error})") from error


def read_dia(text: str, source: str) -> WaterLevelSeries:
    """Return the water level of a DIA file with one series at equal steps.

    Parameters
    ----------
    text : Contents of the file.
    source : File name for messages.

    Raises
    ------
    DatasetError : If it holds another quantity, several series or uneven times, or is truncated.
    """
    heads, *bodies = text.split("[WRD]")
    if len(bodies) != 1:
        raise _series_file_error(source, f"holds {len(bodies)} series; one can be read")
    keys = {line.split(";")[0]: line.strip().split(";")[1:] for line in heads.splitlines()}
    quantity = keys.get("PAR") or keys.get("GHD") or [""]
    if not quantity[0].startswith("WATH"):
        raise _series_file_error(source, "holds "
            f" {' '.join(quantity[:2]).strip() or 'no named quantity'!r}, "
                     "not a water level at equal steps")  # fmt: skip
    unit = keys.get("EHD", ["", ""])[1:2]
    if unit[:1] == [] or unit[0] not in LENGTH_UNITS:
        raise _series_file_error(source, f"gives levels in {unit[0] if unit else 'no unit'!r}")
    times = _dia_times(keys.get("TYD", []), source)
    level = _dia_levels(bodies[0], source) * LENGTH_UNITS[unit[0]]
    if times.size != level.size:
        raise _series_file_error(source, f"states {times.size} values and has {level.size}")
    place = keys.get("LOC", [])
    words = ["DIA series", *place[1:2], *quantity[1:2]]
    return WaterLevelSeries(times, level, _dia_position(place), ", ".join(w for w in words if w))


def _dia_times(span: list[str], source: str) -> FloatArray:
    """Return times of start, end and step: date, time, date, time, minutes, 'min'."""
    if len(span) != 6 or span[5] != "min" or not all(x.isdigit() for x in span[:5]):
        raise _series_file_error(
            source, f"has the times {';'.join(span) or 'none'}, not equal steps of minutes"
        )
    start, end = (
        _noos_times([span[0] + span[1], span[2] + span[3]], source) - MET_OFFSET_HOURS * HOUR
    )
    step = 60.0 * int(span[4])
    if not (step > 0.0 and end >= start):
        raise _series_file_error(source, f"has the times {';'.join(span)}, which are not a series")
    return np.asarray(np.arange(start, end + 0.5 * step, step), np.float64)


def _dia_levels(body: str, source: str) -> FloatArray:
    """Return values in the file's unit, NaN where the quality marks a missing value."""
    pairs = [x.split("/") for x in re.sub(r"\s", "", body).strip(":").split(":")]
    try:
        value, quality = np.array(pairs, np.float64).T
    except ValueError as error:
        raise _series_file_error(source, f"holds values that are not numbers ({error})") from error
    return np.where(quality == MISSING_VALUE_QUALITY, np.nan, value)


def _dia_position(place: list[str]) -> tuple[float, float] | None:
    """Return (lat, lon) of a location: code, name, kind, system, x, y."""
    if len(place) < 6 or place[3] not in COORDINATE_SYSTEMS:
        return None
    code, size = COORDINATE_SYSTEMS[place[3]]
    try:
        x, y = (np.array([float(v) * size]) for v in place[4:6])
    except ValueError:
        return None
    lat, lon = to_degrees(code, x, y)
    return (float(lat[0]), float(lon[0])) if np.isfinite([lat[0], lon[0]]).all() else None


def _series_file_error(source: str, fault: str) -> DatasetError:
    return DatasetError(
        f"{source} {fault}.",
        "One series of water level can be read from a NOOS or DIA file.",
        "Write the series to a separate file, or as CSV with time and water_level.",
        file=source,
    )
