"""Readers of ship tracks: AIS messages and logs in CSV files or tables.

Every row left out and every assumption is recorded in ``notes`` of the track.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.file_reading import cause_of
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.operations.tracks.track_cleaning import CleaningRules, RawTrack, TrackLog, clean_track

if TYPE_CHECKING:
    import pandas as pd

TrackSource: TypeAlias = "str | PathLike[str] | pd.DataFrame"

#: names of columns (lower case, units and signs taken off), the likeliest first
COLUMN_NAMES: Final[dict[str, tuple[str, ...]]] = {
    "time": (
        *("time", "timestamp", "datetime", "date_time", "basedatetime", "base_date_time"),
        *("time_utc", "date_time_utc", "datetime_utc", "timestamp_utc", "utc", "postime", "date"),
    ),
    "lat": ("lat", "latitude", "position_lat", "y_lat"),
    "lon": ("lon", "longitude", "long", "lng", "position_lon", "x_lon"),
    "speed": ("sog", "speed_over_ground", "speed", "vessel_sog", "velocity"),
    "course": ("cog", "course_over_ground", "course"),
    "draught": ("draught", "draft"),
    "length": ("length", "loa", "ship_length", "vessel_length", "length_overall"),
    "power": ("power", "engine_power", "shaft_power", "brake_power"),
    "vessel": ("mmsi", "imo", "vessel", "vessel_name", "ship", "ship_name", "name"),
}
#: SI value of each unit; the first unit of a column is the default
UNIT_FACTORS: Final[dict[str, dict[str, float]]] = {
    "speed": {"kn": KNOT, "kt": KNOT, "knots": KNOT, "m_s": 1.0, "ms": 1.0, "km_h": 1.0 / 3.6},
    "power": {"kw": 1e3, "w": 1.0, "mw": 1e6},
    "draught": {"m": 1.0, "dm": 0.1, "cm": 0.01},
    "length": {"m": 1.0, "ft": 0.3048},
    "course": {"deg": float(np.pi / 180.0), "rad": 1.0},
    "lat": {"deg": 1.0},
    "lon": {"deg": 1.0},
}
#: values above these mean "not available" in AIS
NOT_AVAILABLE_THRESHOLDS: Final = {"speed": 102.25, "course": 359.999}
_DATE_FORMATS: Final = ("%d/%m/%Y", "%m/%d/%Y", "%d-%m-%Y", "%m-%d-%Y", "%d.%m.%Y")
_TIME_FORMATS: Final = (" %H:%M:%S", " %H:%M", "")


def read_tracks(
    source: TrackSource,
    *,
    columns: Mapping[str, str] | None = None,
    vessel: str | int | None = None,
    time_format: str | None = None,
    cleaning: CleaningRules | None = None,
) -> TrackLog:
    """Read the track of one ship and clean it.

    Parameters
    ----------
    source : path or DataFrame
        A CSV file (comma, semicolon or tab) or a table with columns for time, lat, lon and maybe
        speed, course, draught, power and vessel, with usual names; see ``COLUMN_NAMES``.
    columns : mapping of str to str, optional
        Columns with other names, such as ``{"time": "t_gps"}``.
    vessel : str or int, optional
        MMSI or name of the ship, if there are several.
    time_format : str, optional
        As in ``strptime``; by default ISO 8601, seconds or milliseconds since 1970, or day and
        month in the only order that is possible for all rows. Times without a zone are UTC.
    cleaning : CleaningRules, optional
        Rules for gaps and outliers.

    Returns
    -------
    TrackLog
        Sorted, without repeated times and invalid positions; ``notes`` lists the corrections.

    Raises
    ------
    InputError
        If a column is missing, times cannot be read or are ambiguous, several ships are in the
        file, or fewer than two positions remain.
    """
    table, name = _table(source)
    found = recognised_columns(table, dict(columns or {}), name)
    notes: list[str] = []
    ships, rows = _one_vessel(table, found, vessel)
    table = table[rows]
    time = track_times(table, found, time_format, name, notes)
    values = {
        kind: column_in_si(table[column], kind, column, notes)
        for kind, column in found.items()
        if kind not in ("time", "date", "vessel")
    }
    raw = RawTrack(time, values.pop("lat"), values.pop("lon"), values)
    return clean_track(raw, cleaning or CleaningRules(), vessel=ships, source=name, notes=notes)


def _table(source: TrackSource) -> tuple[pd.DataFrame, str]:
    import pandas as pd

    if isinstance(source, pd.DataFrame):
        return source.reset_index(drop=True), "the table"
    path = Path(source)
    try:
        with path.open(encoding="utf-8-sig") as file:
            header = file.readline()
        separator = max(",;\t", key=header.count)
        decimal = "," if separator == ";" else "."
        table = pd.read_csv(path, sep=separator, encoding="utf-8-sig", dtype=str)
        if decimal == ",":
            commas = table.map(lambda x: isinstance(x, str) and bool(re.fullmatch(r"-?\d+,\d+", x)))
            table = table.mask(commas, table.map(lambda x: str(x).replace(",", ".")))
    except (OSError, ValueError) as error:
        raise InputError(
            f"The track file {str(path)!r} cannot be read: {cause_of(error)}.",
            "It must be a CSV file with a line of column names, in UTF-8.",
            "Check the path and the file.",
            file=str(path),
        ) from error
    return table, str(path)


def _normalised_name(column: str) -> str:
    """Return a column name in lower case, words joined by single underscores."""
    return re.sub(r"[^a-z0-9]+", "_", str(column).lower()).strip("_")


def _split_unit(column: str, kind: str) -> tuple[str, str | None]:
    """Return a column name without its unit, and the unit."""
    plain = _normalised_name(column)
    for unit in sorted(UNIT_FACTORS.get(kind, {}), key=len, reverse=True):
        if plain.endswith("_" + unit):
            return plain[: -len(unit) - 1], unit
    return plain, None


def recognised_columns(table: pd.DataFrame, given: dict[str, str], name: str) -> dict[str, str]:
    """Return the column of every kind that is present.

    Parameters
    ----------
    table : Its column names are used.
    given : Columns by kind that the user states.
    name : Of the file, for messages.

    Returns
    -------
    dict of str to str : Column by kind; see ``COLUMN_NAMES``.

    Raises
    ------
    InputError : If a kind or a stated column is unknown, or time or position are missing.
    """
    unknown = sorted(set(given) - set(COLUMN_NAMES))
    absent = sorted(column for column in given.values() if column not in table.columns)
    if unknown or absent:
        raise InputError(
            f"The columns given for {name} are wrong: {', '.join(unknown + absent)}.",
            f"Kinds: {', '.join(COLUMN_NAMES)}; columns: {', '.join(map(str, table.columns))}.",
            "Correct them.",
        )
    columns = dict(given)
    for kind, names in COLUMN_NAMES.items():
        stems = {_split_unit(c, kind)[0]: str(c) for c in reversed(list(table.columns))}
        match = next((stems[n] for n in names if n in stems), None)
        if kind not in columns and match is not None:
            columns[kind] = match
    dates = {_normalised_name(c): str(c) for c in table.columns}
    if "date" in dates and columns.get("time") != dates["date"] and "time" not in given:
        columns["date"] = dates["date"]
    missing = [kind for kind in ("time", "lat", "lon") if kind not in columns]
    if missing:
        raise InputError(
            f"{name} has no column for {' or '.join(missing)}.",
            f"Columns: {', '.join(map(str, table.columns))}; recognised names: "
            + "; ".join(f"{kind}: {', '.join(COLUMN_NAMES[kind][:4])}" for kind in missing)
            + ".",
            "Rename the columns, or name them (columns, or --column lat=NAME).",
            missing=missing,
        )
    return columns


def _one_vessel(
    table: pd.DataFrame, columns: dict[str, str], vessel: str | int | None
) -> tuple[str | None, Any]:
    """Return the ship and its rows.

    Raises
    ------
    InputError : If there are several ships and none is chosen, or the chosen one is not there.
    """
    every = np.ones(len(table), dtype=bool)
    column = columns.get("vessel")
    names = None if column is None else table[column].astype(str).str.strip()
    known = [] if names is None else sorted(set(names[table[column].notna()]))
    if vessel is None and len(known) <= 1:
        return (known[0] if known else None), every
    listed = ", ".join(known[:10]) + (", ..." if len(known) > 10 else "")
    if vessel is None or names is None or str(vessel).strip() not in known:
        request = "none was chosen" if vessel is None else f"{vessel!r} was requested"
        raise InputError(
            f"The tracks are of {len(known)} named ships, and {request}.",
            f"Ships: {listed or 'the file names none'}.",
            "Choose one of them (vessel, or --vessel).",
            vessels=known[:100],
        )
    return str(vessel).strip(), (names == str(vessel).strip()).to_numpy()


def column_in_si(column: pd.Series[Any], kind: str, header: str, notes: list[str]) -> FloatArray:
    """Return a column in SI units; NaN where there is no number.

    Parameters
    ----------
    column : Numbers or texts.
    kind : One of ``UNIT_FACTORS``.
    header : Name of the column, with its unit or without.
    notes : A note is added where the unit is assumed.

    Returns
    -------
    float64 array : [m/s], [W], [m], [rad] or [deg].
    """
    import pandas as pd

    values = pd.to_numeric(column, errors="coerce").to_numpy(dtype=np.float64, na_value=np.nan)
    unit = _split_unit(header, kind)[1]
    units = UNIT_FACTORS[kind]
    if unit is None:
        unit = next(iter(units))
        if kind in ("speed", "power"):
            notes.append(f"Column {header!r} is taken to be in {unit}.")
    limit = NOT_AVAILABLE_THRESHOLDS.get(kind)
    if limit is not None and unit in ("kn", "kt", "knots", "deg"):
        values = np.where(values > limit, np.nan, values)
    return np.asarray(values * units[unit])


def track_times(
    table: pd.DataFrame,
    columns: dict[str, str],
    time_format: str | None,
    name: str,
    notes: list[str],
) -> FloatArray:
    """Return times [s since 1970-01-01T00:00Z]; NaN where unreadable.

    Parameters
    ----------
    columns : Column by kind, by `recognised_columns`.
    time_format : As in ``strptime``; None to recognise it.
    name : Of the file, for messages.
    notes : A note is added where the order of day and month is found from the rows.

    Returns
    -------
    float64 array : One for each row.

    Raises
    ------
    InputError : If times cannot be read or are ambiguous.
    """
    import pandas as pd

    column = table[columns["time"]]
    if "date" in columns:
        column = table[columns["date"]].astype(str) + " " + column.astype(str)
    if isinstance(column.dtype, pd.DatetimeTZDtype) or column.dtype.kind == "M":
        return _seconds(pd.to_datetime(column, utc=True))
    numbers = pd.to_numeric(column, errors="coerce").to_numpy(dtype=np.float64, na_value=np.nan)
    if time_format is None and 2 * np.isfinite(numbers).sum() > len(numbers):
        return _epoch_seconds(numbers, columns["time"])
    if time_format is not None:
        return _by_format(column, time_format)
    parsed = pd.to_datetime(column, format="ISO8601", utc=True, errors="coerce")
    if len(column) == 0 or parsed.notna().mean() >= 0.5:
        return _seconds(parsed)
    return _dates(column, name, notes)


def _by_format(column: pd.Series[Any], time_format: str) -> FloatArray:
    import pandas as pd

    try:
        return _seconds(pd.to_datetime(column, format=time_format, utc=True, errors="coerce"))
    except ValueError as error:
        raise InputError(
            f"The time format {time_format!r} cannot be used: {error}.",
            "A format is written as for strptime.",
            "Write, for example, '%d/%m/%Y %H:%M:%S'.",
        ) from error


def _epoch_seconds(numbers: FloatArray, header: str) -> FloatArray:
    size = float(np.nanmedian(np.abs(numbers)))
    for scale in (1.0, 1e3, 1e6, 1e9):
        if 1e8 <= size / scale < 1e10:
            return np.asarray(numbers / scale)
    raise InputError(
        f"Numbers such as {size:g} in column {header!r} cannot be read as times.",
        "Numbers are read as seconds, milli-, micro- or nanoseconds since 1970-01-01T00:00Z.",
        "Write ISO 8601 times, such as 2026-01-01T06:30:00Z.",
    )


def _dates(column: pd.Series[Any], name: str, notes: list[str]) -> FloatArray:
    """Read dates with slashes, points or dashes in the only order that fits all rows."""
    import pandas as pd

    fits: dict[str, FloatArray] = {}
    for date in _DATE_FORMATS:
        for clock in _TIME_FORMATS:
            parsed = pd.to_datetime(column, format=date + clock, utc=True, errors="coerce")
            if parsed.notna().sum() >= 0.99 * column.notna().sum() and parsed.notna().any():
                fits[date + clock] = _seconds(parsed)
    if not fits:
        raise InputError(
            f"The times of {name} cannot be read, for example {str(column.iloc[0])!r}.",
            "Times are ISO 8601, or seconds since 1970.",
            "Give their format (time_format, or --time-format '%d/%m/%Y %H:%M:%S').",
        )
    (form, first), *others = fits.items()
    for other, seconds in others:
        if not np.array_equal(first, seconds, equal_nan=True):
            raise InputError(
                f"The times of {name} can be read as {form} and as {other}.",
                f"For example {str(column.iloc[0])!r}.",
                "State the format (time_format, or --time-format).",
            )
    notes.append(f"Times are read as {form}.")
    return first


def _seconds(moments: Any) -> FloatArray:
    values = moments.to_numpy(dtype="datetime64[ns]")
    seconds = values.astype(np.int64) / 1e9
    return np.where(np.isnat(values), np.nan, seconds)
