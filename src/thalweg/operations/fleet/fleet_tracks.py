"""Tracks of many ships: read from files, cleaned ship by ship, thinned to an even interval."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.file_reading import cause_of
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import HOUR, KNOT, MINUTE
from thalweg.operations.tracks.track_cleaning import CleaningRules, RawTrack, clean_track
from thalweg.operations.tracks.track_readers import (
    TrackSource,
    column_in_si,
    recognised_columns,
    track_times,
)

if TYPE_CHECKING:
    import pandas as pd

#: Gaps of fleets: noon reports are a day apart.
FLEET_CLEANING: Final = CleaningRules(longest_gap=6.0 * HOUR, fastest=40.0 * KNOT)
INTERVAL: Final = 5.0 * MINUTE  #: of positions that are kept [s]
_OPTIONAL: Final = ("draught", "length")


@dataclass(frozen=True, eq=False)
class FleetTracks:
    """Cleaned tracks of S ships, n positions in all.

    Attributes
    ----------
    ptr : int64 array (S + 1,)
        The positions of ship s are ``ptr[s]:ptr[s + 1]``.
    time : float64 array (n,)
        [s since 1970-01-01T00:00Z], ascending for every ship.
    lat, lon : float64 array (n,)
        [deg].
    broken : bool array (n,)
        Whether the interval after a position is not observed.
    draught, length : float64 array (n,)
        Of the ship [m]; NaN where unknown.
    notes : tuple of str
        Assumptions and corrections.
    """

    ptr: IntArray
    time: FloatArray
    lat: FloatArray
    lon: FloatArray
    broken: BoolArray
    draught: FloatArray
    length: FloatArray
    notes: tuple[str, ...]


def read_fleet(
    sources: Sequence[TrackSource],
    *,
    columns: Mapping[str, str] | None = None,
    time_format: str | None = None,
    cleaning: CleaningRules | None = None,
    interval: float = INTERVAL,
) -> FleetTracks:
    """Read the tracks of many ships and clean them.

    Parameters
    ----------
    sources : sequence of path or DataFrame
        CSV or Parquet files, or tables, with columns for time, lat, lon and vessel, and maybe
        draught and length of the ship. A file without a column for the vessel is of one ship.
    columns : mapping of str to str, optional
        Columns with other names, such as ``{"time": "t_gps"}``.
    time_format : str, optional
        As in ``strptime``; by default recognised, as by `thalweg.operations.tracks.read_tracks`.
    cleaning : CleaningRules, optional
        By default gaps are longer than 6 h.
    interval : float
        One position is kept in every interval of this length [s]; 0 keeps all.

    Returns
    -------
    FleetTracks

    Raises
    ------
    InputError
        If a file cannot be read, or no ship has two positions.
    """
    notes: list[str] = []
    parts = [_columns_of(source, columns, time_format, notes) for source in sources]
    ship, raw = _by_ship(parts)
    starts = np.flatnonzero(np.append(True, np.diff(ship) != 0)) if len(ship) else ship
    ends = np.append(starts[1:], len(ship))
    logs, few = [], 0
    removed: Counter[str] = Counter()
    for a, b in zip(starts.tolist(), ends.tolist()):
        try:
            log = clean_track(raw.part(slice(a, b)), cleaning or FLEET_CLEANING)
        except InputError:
            few += 1
            continue
        removed.update(log.removed)
        keep = _thinned(log.time, log.broken, interval)
        broken = np.append(log.broken, True)
        logs.append((log.time[keep], log.lat[keep], log.lon[keep], broken[keep],
                     *(log.values[name][keep] for name in _OPTIONAL)))  # fmt: skip
    if not logs:
        raise InputError(
            f"No ship has two positions that can be used in {len(parts)} track files.",
            f"They have {len(ship):,} rows.",
            "Check the columns for time, position and vessel.",
        )
    if few:
        notes.append(f"{few} ships with fewer than two positions were left out.")
    notes += [f"Rows left out: {rows:,} {reason}." for reason, rows in removed.items() if rows]
    ptr = np.cumsum([0, *(len(log[0]) for log in logs)]).astype(np.int64)
    time, lat, lon, broken, draught, length = (
        np.concatenate([log[k] for log in logs]) for k in range(6)
    )
    return FleetTracks(ptr, time, lat, lon, broken, draught, length, tuple(dict.fromkeys(notes)))


def _columns_of(
    source: TrackSource,
    columns: Mapping[str, str] | None,
    time_format: str | None,
    notes: list[str],
) -> tuple[NDArray[Any], RawTrack]:
    """Return the names of the ships and the columns of one source."""
    table, named, name = _fleet_table(source, dict(columns or {}))
    time = track_times(table, named, time_format, name, notes)
    unknown = np.full(len(table), np.nan)
    values = {
        kind: column_in_si(table[named[kind]], kind, named[kind], notes) if kind in named
        else unknown
        for kind in ("lat", "lon", *_OPTIONAL)
    }  # fmt: skip
    ships = table[named["vessel"]].to_numpy() if "vessel" in named else np.full(len(table), name)
    return ships, RawTrack(time, values.pop("lat"), values.pop("lon"), values)


def _fleet_table(
    source: TrackSource, given: dict[str, str]
) -> tuple[pd.DataFrame, dict[str, str], str]:
    """Return the columns in use of a source, by kind, and its name."""
    import pandas as pd

    if isinstance(source, pd.DataFrame):
        return source, recognised_columns(source, given, "the table"), "the table"
    path = Path(source)
    try:
        if path.suffix.lower() == ".parquet":
            table = pd.read_parquet(path)
            return table, recognised_columns(table, given, str(path)), str(path)
        with path.open(encoding="utf-8-sig") as file:
            header = file.readline()
        separator = max(",;\t", key=header.count)
        options: dict[str, Any] = {"sep": separator, "encoding": "utf-8-sig"}
        found = recognised_columns(pd.read_csv(path, nrows=5, **options), given, str(path))
        table = pd.read_csv(
            path, usecols=list(set(found.values())), decimal="," if separator == ";" else ".",
            low_memory=False, **options,
        )  # fmt: skip
    except (OSError, ValueError, ImportError) as error:
        if isinstance(error, InputError):
            raise
        raise _unreadable(path, error) from error
    return table, found, str(path)


def _unreadable(path: str | PathLike[str], error: Exception) -> InputError:
    return InputError(
        f"The track file {str(path)!r} cannot be read: {cause_of(error)}.",
        "It must be a CSV file with a line of column names, in UTF-8, or a Parquet file.",
        "Check the path and the file; Parquet needs pyarrow (pip install 'thalweg[studies]').",
        file=str(path),
    )


def _by_ship(parts: Sequence[tuple[NDArray[Any], RawTrack]]) -> tuple[IntArray, RawTrack]:
    """Return the number of the ship of every row, and the rows, ordered by ship and time."""
    import pandas as pd

    names = [pd.Series(ships) for ships, _ in parts]
    if len({column.dtype for column in names}) > 1:
        names = [column.astype(str) for column in names]
    ship, _ = pd.factorize(pd.concat(names, ignore_index=True))
    time, lat, lon = (
        np.concatenate([getattr(raw, k) for _, raw in parts]) for k in ("time", "lat", "lon")
    )
    values = {name: np.concatenate([raw.values[name] for _, raw in parts]) for name in _OPTIONAL}
    raw = RawTrack(time, lat, lon, values)
    known = np.flatnonzero(ship >= 0)
    if len(known) < len(ship):
        ship, raw = ship[known], raw.part(known)
    if (np.diff(ship) < 0).any():
        order = np.argsort(ship, kind="stable")
        ship, raw = ship[order], raw.part(order)
    return ship.astype(np.int64), raw


def _thinned(time: FloatArray, broken: BoolArray, interval: float) -> BoolArray:
    """Return the first position of every interval, and those at gaps and at the ends."""
    if interval <= 0.0:
        return np.ones(len(time), bool)
    keep = np.append(True, np.diff(np.floor(time / interval)) > 0.0)
    keep[:-1] |= broken
    keep[1:] |= broken
    keep[-1] = True
    return keep
