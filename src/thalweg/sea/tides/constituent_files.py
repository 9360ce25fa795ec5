"""Read and write files of tidal constituents.

* Component files of Rijkswaterstaat (hatyan): phases for times in MET (UTC+1), amplitudes in the
  unit that the file states, the mean above the datum.
* JSON sets of stations as in the neaps tide database (NOAA, TICON-4, Kartverket), heights in metres
  or currents in knots along the direction of flood, Greenwich phases in UTC.
* Thalweg's own JSON (what ``thalweg tides analyse --out`` writes).
"""

from __future__ import annotations

import gzip
import json
import math
import re
import warnings
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.core.errors import DatasetError, InputError, ThalwegWarning, unknown_name_error
from thalweg.core.file_writing import write_text
from thalweg.core.units import KNOT
from thalweg.sea import standard_names as nm
from thalweg.sea.tides import schureman
from thalweg.sea.tides.constituents import Constituents
from thalweg.sea.tides.noos_dia_series import LENGTH_UNITS, MET_OFFSET_HOURS

FILE_FORMAT: Final = "thalweg-constituents-1"
#: Largest difference of a printed speed from that of the constituent [deg/h].
_SPEED_TOLERANCE = 1e-4


def read_constituents(path: str | Path, *, station: str | None = None) -> Constituents:
    """Return the constituents of a file in one of the formats of this module.

    Parameters
    ----------
    path : path
        A hatyan component file, a JSON set of stations or Thalweg's JSON; may be gzipped.
    station : str, optional
        Id or name of a station, for files with several.

    Returns
    -------
    Constituents
        Of one station, or of all nodes of a file of Thalweg.

    Raises
    ------
    DatasetError
        If the file has none of these formats.
    InputError
        If the station is not in the file, or none is named in a file with several.
    """
    text = _read_text(Path(path))
    source = Path(path).name
    if not text.lstrip().startswith(("[", "{")):
        return _check_station(_read_hatyan(text, source), station, source)
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        raise _constituent_file_error(source, f"is not valid JSON ({error})") from error
    if isinstance(data, list):
        return select_station(data, station, source)
    return _check_station(from_dict(data, source), station, source)


def is_constituent_file(path: str | Path) -> bool:
    """Return whether a file of text begins as one of the formats of this module.

    Parameters
    ----------
    path : A file; may be gzipped.
    """
    try:
        head = _read_text(Path(path)).lstrip()
    except DatasetError:
        return False
    if head.startswith("{"):
        return FILE_FORMAT.rpartition("-")[0] in head[:400]
    return head.startswith("[") or re.search(r"^COMP\s+\d", head, re.M) is not None


def _check_station(constants: Constituents, station: str | None, source: str) -> Constituents:
    """Return constants of a file with one station, if it is the requested one."""
    names = [str(constants.facts[k]) for k in ("station", "name") if constants.facts.get(k)]
    if station is None or station in names:
        return constants
    raise InputError(
        f"Station {station!r} was requested, but {source} is not a set of stations.",
        f"It holds {' or '.join(names) or 'constants without a name'}.",
        "Omit the station.",
        file=source,
    )


def write_constituents(constituents: Constituents, path: str | Path) -> None:
    """Write constituents as JSON, which `read_constituents` reads.

    Parameters
    ----------
    constituents : Constituents
        Constants.
    path : path
        JSON file to write.
    """
    text = json.dumps(as_dict(constituents), indent=1, allow_nan=False)
    write_text(path, text)


def as_dict(constituents: Constituents) -> dict[str, Any]:
    """Return constituents as plain data for JSON; unknown values are None."""
    return {
        "format": FILE_FORMAT,
        "convention": constituents.convention,
        "names": list(constituents.names),
        "lat": _json_numbers(constituents.lat),
        "lon": _json_numbers(constituents.lon),
        "variables": {
            name: {
                "amplitude": [_json_numbers(row) for row in constituents.amplitude[name]],
                "phase_deg": [_json_numbers(row) for row in constituents.phase[name]],
                "mean": _json_numbers(constituents.mean[name]),
            }
            for name in sorted(constituents.variables)
        },
        "facts": dict(constituents.facts),
    }


def from_dict(data: Mapping[str, Any], source: str = "constituents") -> Constituents:
    """Return constituents from the plain data of `as_dict`.

    Parameters
    ----------
    source : File name for messages.

    Raises
    ------
    DatasetError : If the format is another, or a key or array is missing or invalid.
    """
    if data.get("format") != FILE_FORMAT:
        raise _constituent_file_error(source, f"is not of the format {FILE_FORMAT}")
    try:
        nodes, parts = len(data["lat"]), data["variables"]
        if not (parts and data["names"]):
            raise _constituent_file_error(source, "holds no constituents")
        shape = (len(data["names"]), nodes)
        return Constituents(
            tuple(str(n) for n in data["names"]),
            {n: np.array(v["amplitude"], float).reshape(shape) for n, v in parts.items()},
            {n: np.array(v["phase_deg"], float).reshape(shape) for n, v in parts.items()},
            {n: np.array(v["mean"], float).reshape(nodes) for n, v in parts.items()},
            np.array(data["lat"], float),
            np.array(data["lon"], float),
            str(data["convention"]),
            dict(data.get("facts", {})),
        )
    except (KeyError, TypeError, AttributeError) as error:
        raise _constituent_file_error(source, f"lacks a key ({error})") from error
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise _constituent_file_error(
            source, f"holds arrays of different shapes ({error})"
        ) from error


def select_station(
    stations: Sequence[Mapping[str, Any]], wanted: str | None, source: str = "stations"
) -> Constituents:
    """Return the constituents of one station of a JSON set.

    Parameters
    ----------
    stations : Stations as in the neaps tide database.
    wanted : Id or name; None if there is one station only.
    source : File name for messages.

    Raises
    ------
    DatasetError : If the data are not those of stations.
    InputError : If the station is not in the set, or none is named.
    """
    try:
        names = {str(s["id"]): s for s in stations}
        for s in stations:
            names.setdefault(str(s.get("name", "")), s)
    except (KeyError, TypeError, AttributeError) as error:
        raise _constituent_file_error(
            source, f"is a list, but not of stations with an id ({error!r})"
        ) from error
    if not names:
        raise _constituent_file_error(source, "holds no station")
    if wanted is None and len(stations) != 1:
        raise InputError(
            f"{source} holds {len(stations)} stations and none is named.",
            f"For example {', '.join(list(names)[:3])}.",
            "Name one by its id or name: --station of 'thalweg tides predict'; in Python "
            "read_constituents(file, station=...), whose tide Sea.from_tides applies to an area.",
            file=source,
        )
    if wanted is not None and wanted not in names:
        raise unknown_name_error("station", wanted, names)
    one = names[wanted] if wanted is not None else stations[0]
    try:
        return _read_station(one, source)
    except InputError:
        raise
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise _constituent_file_error(
            source, f"holds an invalid station {one['id']!r} ({error!r})"
        ) from error


def _read_station(data: Mapping[str, Any], source: str) -> Constituents:
    is_current = data.get("kind") == "current" or "current" in data
    table: dict[str, tuple[float, float]] = {}
    left_out: dict[str, float] = {}
    for name, size, lag in data["constituents"]:
        if not size:
            continue
        if _is_known_constituent(str(name)):
            table[schureman.constituent_definition(str(name)).name] = (float(size), float(lag))
        else:
            left_out[str(name)] = float(size)
    if not table:
        raise _constituent_file_error(
            source, f"holds no constituents for the station {data['id']!r}"
        )
    if left_out:
        listed = ", ".join(f"{n} ({a:g})" for n, a in left_out.items())
        warnings.warn(
            f"{source}: constituents without a known argument are omitted: {listed}.",
            ThalwegWarning,
            stacklevel=4,
        )
    facts = {
        "source": str(data.get("source", source)),
        "station": str(data["id"]),
        "name": str(data.get("name", "")),
        "license": str(data.get("license", "")),
        "left_out": left_out,
    }
    lat, lon = float(data["lat"]), float(data["lon"])
    if is_current:
        return _current_components(data["current"], table, facts, (lat, lon))
    return Constituents.single(nm.WATER_LEVEL, table, lat=lat, lon=lon, facts=facts)


def _current_components(
    current: Mapping[str, Any],
    table: Mapping[str, tuple[float, float]],
    facts: Mapping[str, Any],
    place: tuple[float, float],
) -> Constituents:
    """Convert a tidal current along the direction of flood [kn] to east and north [m/s]."""
    flood = math.radians(float(current["flood_direction"]))
    mean = float(current.get("mean_flow") or 0.0) * KNOT
    size = np.array([a for a, _ in table.values()])[:, None] * KNOT
    phase = np.array([g for _, g in table.values()])[:, None]
    parts = {nm.EASTWARD_CURRENT: math.sin(flood), nm.NORTHWARD_CURRENT: math.cos(flood)}
    return Constituents(
        tuple(table),
        {n: size * abs(part) for n, part in parts.items()},
        {n: (phase + (180.0 if part < 0.0 else 0.0)) % 360.0 for n, part in parts.items()},
        {n: np.array([mean * part]) for n, part in parts.items()},
        np.array([place[0]]),
        np.array([place[1]]),
        "schureman",
        dict(facts),
    )


def _read_hatyan(text: str, source: str) -> Constituents:
    """Read a component file; the format holds water levels only."""
    header = dict(re.findall(r"^(STAT|MIDD|NCOM)\s+(.*?)\s*$", text, re.M))
    rows = re.findall(r"^COMP\s+\d+\s+([\d.]+)\s+(\S+)\s+(\S+)\s+(\S+)\s*$", text, re.M)
    station = header.get("STAT", "").split()
    if not rows or len(station) < 4:
        raise _constituent_file_error(source, "has no STAT line or no components")
    unit = station[3]
    if unit not in LENGTH_UNITS:
        raise _constituent_file_error(source, f"gives heights in {unit!r}")
    try:
        count, mean = int(header.get("NCOM", len(rows))), float(header.get("MIDD", 0.0))
        numbers = [(name, float(v), float(size), float(lag)) for v, size, lag, name in rows]
    except ValueError as error:
        raise _constituent_file_error(
            source, f"holds a constant that is not a number ({error})"
        ) from error
    if len(rows) != count:
        raise _constituent_file_error(source, f"states {count} components and has {len(rows)}")
    table = {}
    for name, speed, size, lag in numbers:
        hourly = schureman.frequency(name) * 360.0
        if abs(hourly - speed) > _SPEED_TOLERANCE:
            raise _constituent_file_error(
                source, f"gives {name} a speed of {speed:g}, not {hourly:.6f} deg/h"
            )
        table[name] = (size * LENGTH_UNITS[unit], (lag - hourly * MET_OFFSET_HOURS) % 360.0)
    return Constituents.single(
        nm.WATER_LEVEL,
        table,
        mean=mean * LENGTH_UNITS[unit],
        convention="rws",
        facts={"source": source, "station": station[0], "datum": station[2]},
    )


def _is_known_constituent(name: str) -> bool:
    try:
        schureman.constituent_definition(name)
    except InputError:
        return False
    return True


def _read_text(path: Path) -> str:
    try:
        raw = path.read_bytes()
        raw = gzip.decompress(raw) if raw[:2] == b"\x1f\x8b" else raw
        return raw.decode("utf-8", errors="replace")
    except (OSError, EOFError, zlib.error) as error:
        raise DatasetError(
            f"{path} cannot be read ({error}).",
            "A file of tidal constituents is needed.",
            "Check the path.",
            file=str(path),
        ) from error


def _json_numbers(values: Any) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in np.asarray(values, float)]


def _constituent_file_error(source: str, fault: str) -> DatasetError:
    return DatasetError(
        f"{source} {fault}.",
        "Constituents can be read from hatyan component files, JSON sets of stations and "
        "Thalweg's own JSON.",
        "Check the file.",
        file=source,
    )
