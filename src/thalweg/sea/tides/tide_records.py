"""Records of water level and current at one place, for harmonic analysis.

The format of a file is recognised by its contents, not by its name: CSV with a header, NOOS series
(Matroos), DIA files of Rijkswaterstaat (Donar), or two columns of days and levels without a header.
Any may be gzipped.
"""

from __future__ import annotations

import gzip
import io
import re
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from thalweg.core.errors import DatasetError, InputError
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY
from thalweg.sea import plausible_values
from thalweg.sea import standard_names as nm
from thalweg.sea.tides.noos_dia_series import (
    LENGTH_UNITS,
    WaterLevelSeries,
    is_dia,
    is_noos,
    read_dia,
    read_noos,
)

#: Canonical names of the columns of a record, lower case (metres above datum, m/s towards).
COLUMN_NAMES: Final[dict[str, str]] = {
    **dict.fromkeys(("water_level", "water_level_m", "level", "level_m"), nm.WATER_LEVEL),
    nm.WATER_LEVEL: nm.WATER_LEVEL,
    **dict.fromkeys(("current_east", "current_east_m_s", nm.EASTWARD_CURRENT), nm.EASTWARD_CURRENT),
    **dict.fromkeys(
        ("current_north", "current_north_m_s", nm.NORTHWARD_CURRENT), nm.NORTHWARD_CURRENT
    ),
}
TIME_COLUMNS: Final = ("time", "time_utc", "datetime")
GZIP_MAGIC: Final = b"\x1f\x8b"
BINARY_MAGIC: Final = (
    b"CDF",
    b"\x89HDF",
    b"GRIB",
)  #: first bytes of files that are opened as a sea
_CONSTITUENT_FILE_PATTERN: Final = re.compile(r"\A\s*[\[{]|^COMP\s+\d", re.M)
#: usual first days of columns of day numbers
DAY_COUNT_EPOCHS: Final = ("1700-01-01", "1858-11-17", "1899-12-30", "1900-01-01", "1970-01-01")
PLAUSIBLE_YEARS: Final = (1850, 2100)  #: likely years of a record, for hints only


@dataclass(frozen=True, eq=False)
class TideRecord:
    """A record at one position.

    Attributes
    ----------
    times : Seconds since 1970-01-01T00:00Z, (T,).
    series : dict of str to float64 array (T,)
        Water level [m above datum] and current [m/s towards] by canonical name, NaN where unknown.
    position : (float, float) or None
        Latitude and longitude [deg], if the file gives them.
    description : Format of the file and location, as far as it is stated.
    """

    times: FloatArray
    series: dict[str, FloatArray]
    position: tuple[float, float] | None
    description: str


def is_text_record(path: str | Path) -> bool:
    """Return whether a path is a file of text (a record), not one to open as a sea."""
    path = Path(path)
    if not path.is_file():
        return False
    head = _read_bytes(path, 1024)
    return not (head.startswith(BINARY_MAGIC[:2]) or BINARY_MAGIC[2] in head or b"\0" in head)


def read_record(
    path: str | Path, *, unit: str | None = None, days_since: TimeLike | None = None
) -> TideRecord:
    """Return the record in a file.

    Parameters
    ----------
    path : path
        * CSV with a header: ``time`` (ISO 8601, UTC where no zone is written) and some of
          ``water_level`` [m], ``current_east`` and ``current_north`` [m/s]. Empty cells are gaps.
          Columns may be separated by semicolons, and the decimals by commas then;
        * a NOOS series of water level, as Matroos writes it;
        * a DIA file with one series of water level at equal steps (clock UTC+1);
        * two columns of numbers without a header: days and water level.
    unit : {"m", "dm", "cm", "mm"}, optional
        Unit of columns without a header, which do not state it.
    days_since : First day of columns without a header, which do not state it either.

    Raises
    ------
    InputError : If columns without a header have no unit and first day, or another format has them.
    DatasetError : If the file cannot be read, has none of these formats, lacks a column, or holds
        an invalid time, number or level.
    """
    path = Path(path)
    source = path.name
    text = _read_bytes(path).decode("utf-8", errors="replace")
    table = _headerless_columns(text)
    if table is not None:
        record = _headerless_record(table, source, unit, days_since)
    elif unit is not None or days_since is not None:
        raise InputError(
            f"{source} states its own unit and times, but others are given.",
            "Unit and first day are for two columns of numbers without a header.",
            "Omit them.",
        )
    elif is_dia(text):
        record = _record_from_series(read_dia(text, source))
    elif is_noos(text):
        record = _record_from_series(read_noos(text, source))
    elif _CONSTITUENT_FILE_PATTERN.search(text):
        raise DatasetError(
            f"{source} holds tidal constituents, not a record.",
            "An analysis needs a record; constituents are its result.",
            "Predict from them with: thalweg tides predict.",
            file=source,
        )
    else:
        record = _read_csv(text, source)
    for name, values in record.series.items():
        plausible_values.check_plausible(name, values, [readable_name(name)], source)
    return record


def readable_name(name: str) -> str:
    """Return the first part of a canonical name as plain text, for messages."""
    return name.split("_above_")[0].replace("_", " ")


def _record_from_series(series: WaterLevelSeries) -> TideRecord:
    return TideRecord(
        series.times, {nm.WATER_LEVEL: series.level}, series.position, series.description
    )


def _read_bytes(path: Path, most: int = -1) -> bytes:
    """Return the first bytes of a file, unpacked."""
    try:
        with path.open("rb") as stream:
            packed = stream.read(2) == GZIP_MAGIC
        with gzip.open(path) if packed else path.open("rb") as stream:
            return stream.read(most)
    except (OSError, EOFError, zlib.error) as error:
        raise DatasetError(
            f"{path.name} cannot be read ({error}).",
            "A record of water level or current is needed.",
            "Check the path.",
            file=str(path),
        ) from error


def _headerless_columns(text: str) -> FloatArray | None:
    """Return two columns of numbers (T, 2), NaN where missing; None for other text."""
    lines = [line for line in text.splitlines() if line.strip()]
    if len(lines) < 3:
        return None
    parts = [line.replace(",", " ").replace(";", " ").split() for line in lines]
    if any(len(row) != 2 for row in parts):
        return None
    try:
        numbers = np.array(parts, np.float64)
    except ValueError:
        return None
    return None if (numbers[:, 0] >= 1e11).all() else numbers  # these are dates: 201801010000


def _headerless_record(
    table: FloatArray, source: str, unit: str | None, days_since: TimeLike | None
) -> TideRecord:
    if unit is None or days_since is None:
        raise _missing_unit_and_epoch_error(table, source)
    if unit not in LENGTH_UNITS:
        raise InputError(
            f"Levels in {unit!r} cannot be read.",
            f"Units are {', '.join(LENGTH_UNITS)}.",
            "Choose one.",
        )
    day = parse_time(days_since)
    times = day + np.round(table[:, 0] * DAY, 0)
    description = f"two columns: days since {format_time(day)[:10]}, water level in {unit}"
    return TideRecord(times, {nm.WATER_LEVEL: table[:, 1] * LENGTH_UNITS[unit]}, None, description)


def _missing_unit_and_epoch_error(table: FloatArray, source: str) -> InputError:
    """Return the error for columns without a header, with dates for the usual first days."""
    first = float(table[0, 0])
    near = []
    for day in DAY_COUNT_EPOCHS:
        start = parse_time(day) + first * DAY
        if (
            parse_time(f"{PLAUSIBLE_YEARS[0]}-01-01")
            <= start
            < parse_time(f"{PLAUSIBLE_YEARS[1]}-01-01")
        ):
            near.append(f"{format_time(start)[:10]} since {day}")
    return InputError(
        f"{source} holds two columns of numbers without their unit and first day.",
        f"Day {first:g} is {', or '.join(near)}; levels may be in {', '.join(LENGTH_UNITS)}."
        if near
        else f"Days are counted from an unknown date; levels may be in {', '.join(LENGTH_UNITS)}.",
        "Give both, for example --days-since 1700-01-01 --unit mm, or write CSV with a header.",
        file=source,
    )


def _read_csv(text: str, source: str) -> TideRecord:
    import pandas as pd

    header = next((line for line in text.splitlines() if line.strip()[:1] not in ("", "#")), "")
    separator, decimal = (";", "," if "," in text else ".") if ";" in header else (",", ".")
    try:
        table = pd.read_csv(
            io.StringIO(text), sep=separator, decimal=decimal, comment="#", skipinitialspace=True
        )
    except (ValueError, pd.errors.ParserError) as error:
        raise _record_file_error(source, f"cannot be read ({error})") from error
    by_name = {str(c).strip().lower(): c for c in table.columns}
    when = next((by_name[n] for n in TIME_COLUMNS if n in by_name), None)
    found = {kept: by_name[n] for n, kept in COLUMN_NAMES.items() if n in by_name}
    if when is None or not found:
        named = [n[:30] for n in by_name]
        more = f" and {len(named) - 8} more" if len(named) > 8 else ""
        raise _record_file_error(source, f"has the columns {', '.join(named[:8]) or 'none'}{more}")
    try:
        times = pd.to_datetime(table[when], utc=True, format="ISO8601")
        series = {n: table[c].to_numpy(np.float64, na_value=np.nan) for n, c in found.items()}
    except ValueError as error:
        raise _record_file_error(
            source, f"holds a cell that is not a time or number ({error})"
        ) from error
    moments = times.dt.tz_localize(None).to_numpy("datetime64[ns]")
    if np.isnat(moments).any():
        raise _record_file_error(source, "has a row without a time")
    return TideRecord(moments.astype(np.int64) / 1e9, series, None, "CSV")


def _record_file_error(source: str, fault: str) -> DatasetError:
    return DatasetError(
        f"{source} {fault}.",
        "A record is CSV with a column time (ISO 8601) and water_level [m], or current_east and "
        "current_north [m/s]; a NOOS series; a DIA file; or two columns of days and levels.",
        "Rename the columns or convert the units.",
        file=source,
    )
