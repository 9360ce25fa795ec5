"""Records of water level and current from CSV files, for harmonic analysis."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.sea import names as nm
from thalweg.sea.fields import FloatArray

#: Columns of a record, lower case, and what they are (metres above datum, m/s towards).
COLUMNS: Final[dict[str, str]] = {
    **dict.fromkeys(("water_level", "water_level_m", "level", "level_m"), nm.WATER_LEVEL),
    nm.WATER_LEVEL: nm.WATER_LEVEL,
    **dict.fromkeys(("current_east", "current_east_m_s", nm.EASTWARD_CURRENT), nm.EASTWARD_CURRENT),
    **dict.fromkeys(
        ("current_north", "current_north_m_s", nm.NORTHWARD_CURRENT), nm.NORTHWARD_CURRENT
    ),
}
TIMES: Final = ("time", "time_utc", "datetime")


def read_record(path: str | Path) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Return times and series of a CSV record.

    Parameters
    ----------
    path : path
        A CSV file with a header: ``time`` (ISO 8601, UTC where no zone is written) and some of
        ``water_level`` [m], ``current_east`` and ``current_north`` [m/s]. Empty cells are gaps.

    Returns
    -------
    times : float64 array (T,)
        Seconds since 1970-01-01T00:00Z.
    series : dict of str to float64 array (T,)
        By canonical name, NaN where unknown.

    Raises
    ------
    DatasetError
        If the file cannot be read, lacks a column, or a cell is no time or number.
    """
    import pandas as pd

    source = Path(path).name
    try:
        table = pd.read_csv(path, comment="#", skipinitialspace=True)
    except (OSError, ValueError, pd.errors.ParserError) as error:
        raise _fault(source, f"cannot be read ({error})") from error
    by_name = {str(c).strip().lower(): c for c in table.columns}
    when = next((by_name[n] for n in TIMES if n in by_name), None)
    found = {kept: by_name[n] for n, kept in COLUMNS.items() if n in by_name}
    if when is None or not found:
        raise _fault(source, f"has the columns {', '.join(by_name) or 'none'}")
    try:
        times = pd.to_datetime(table[when], utc=True, format="ISO8601")
        series = {n: table[c].to_numpy(np.float64, na_value=np.nan) for n, c in found.items()}
    except ValueError as error:
        raise _fault(source, f"holds a cell that is no time or number ({error})") from error
    moments = times.dt.tz_localize(None).to_numpy("datetime64[ns]")
    if np.isnat(moments).any():
        raise _fault(source, "has a row without a time")
    return moments.astype(np.int64) / 1e9, series


def _fault(source: str, fault: str) -> DatasetError:
    return DatasetError(
        f"{source} {fault}.",
        "A record is CSV with a column time (ISO 8601) and water_level [m], or current_east and "
        "current_north [m/s].",
        "Rename the columns or convert the units.",
        file=source,
    )
