"""Cleaning of measured tracks: order of time, repeated rows, outliers and gaps, with notes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance, rough_lengths, wrap_longitude
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT

_MIN_UNDER_WAY_SPEED = 2.0  #: measured speeds are checked above this speed of positions [m/s]
_SPEED_RATIO_TOLERANCE = 0.2
_ROUGH = 0.02  # rough lengths decide beside this share of the limit


@dataclass(frozen=True)
class CleaningRules:
    """Rules for gaps and outliers.

    Attributes
    ----------
    longest_gap : float
        Longest time between positions [s]; a longer one is a gap, and the track is broken there.
    fastest : float
        Highest speed between two positions [m/s]; positions that need more are outliers.
    max_outliers : int
        At most this number of successive positions are removed as outliers; a longer run at
        another place remains, and the track is split before and after it.
    """

    longest_gap: float = 1800.0
    fastest: float = 40.0 * KNOT
    max_outliers: int = 5

    def __post_init__(self) -> None:
        good = all(math.isfinite(x) and x > 0.0 for x in (self.longest_gap, self.fastest))
        if not (good and self.max_outliers >= 0):
            raise InputError(
                f"The rules are {self}.",
                "Gap and speed are positive numbers; the number of outliers is not negative.",
                "Correct them.",
            )


class RawTrack(NamedTuple):
    """Columns of a track as read: times [s], positions [deg], other values [SI] by name."""

    time: FloatArray
    lat: FloatArray
    lon: FloatArray
    values: dict[str, FloatArray]

    def part(self, index: slice | NDArray[np.bool_] | NDArray[np.int64]) -> RawTrack:
        """Return some of the rows."""
        values = {name: column[index] for name, column in self.values.items()}
        return RawTrack(self.time[index], self.lat[index], self.lon[index], values)


@dataclass(frozen=True, eq=False)
class TrackLog:
    """The cleaned track of one ship.

    Attributes
    ----------
    time : float64 array (n,)
        [s since 1970-01-01T00:00Z], strictly ascending.
    lat, lon : float64 array (n,) [deg]
    values : dict of str to float64 array (n,)
        ``speed`` over ground [m/s], ``course`` [rad], ``draught`` [m], ``power`` [W], as far as
        available; NaN where unknown.
    broken : bool array (n - 1,)
        Intervals without observation: gaps, and jumps faster than the highest speed.
    vessel : str or None
    notes : tuple of str
        Assumptions and corrections.
    removed : dict of str to int
        Rows left out, by reason.
    """

    time: FloatArray
    lat: FloatArray
    lon: FloatArray
    values: dict[str, FloatArray]
    broken: NDArray[np.bool_]
    vessel: str | None
    notes: tuple[str, ...]
    removed: dict[str, int]

    def __len__(self) -> int:
        return len(self.time)

    def speeds(self) -> FloatArray:
        """Return the speed over ground at every position [m/s].

        As measured; where unknown, from the position before to the position after.

        Returns
        -------
        float64 array (N,)
            Speed over ground [m/s].
        """
        before = np.maximum(np.arange(len(self)) - 1, 0)
        after = np.minimum(np.arange(len(self)) + 1, len(self) - 1)
        sailed = distance(self.lat[before], self.lon[before], self.lat[after], self.lon[after])
        derived = sailed / (self.time[after] - self.time[before])
        measured = self.values.get("speed")
        if measured is None:
            return np.asarray(derived)
        return np.where(np.isfinite(measured), measured, derived)


def clean_track(
    raw: RawTrack,
    rules: CleaningRules,
    *,
    vessel: str | None = None,
    source: str = "the track",
    notes: list[str] | None = None,
) -> TrackLog:
    """Sort a track by time, remove invalid positions, and mark where it is broken.

    Parameters
    ----------
    vessel, source : For messages.
    notes : Notes of the reading.

    Raises
    ------
    InputError : If fewer than two positions remain.
    """
    remarks, removed = list(notes or ()), {}
    for reason, step in (
        ("without a readable time", _has_time),
        ("without a position on the globe", _has_position),
        ("at 0 N 0 E, which receivers write without a fix", _has_fix),
    ):
        keep = step(raw)
        removed[reason] = int((~keep).sum())
        raw = raw.part(keep)
    backwards = int((np.diff(raw.time) < 0.0).sum())
    if backwards:
        remarks.append(
            f"Rows were not in order of time ({backwards} steps back); they were sorted."
        )
    raw = raw.part(np.argsort(raw.time, kind="stable"))
    raw = _without_duplicate_times(raw, removed)
    keep, jumps = _reachable_positions(raw, rules)
    removed["out of reach at the highest speed"] = int((~keep).sum())
    raw, count = raw.part(keep), len(raw.time)
    if len(raw.time) < 2:
        raise InputError(
            f"Only {len(raw.time)} of the positions of {source} can be used.",
            _removed_rows_text(removed) or f"It has {count}.",
            "A track needs two positions at different times; check columns and units.",
            removed=removed,
        )
    gaps = np.diff(raw.time) > rules.longest_gap
    broken = gaps | jumps[keep][1:]
    _add_notes(remarks, removed, raw, gaps, broken, rules)
    lon = wrap_longitude(raw.lon)
    removed = {reason: rows for reason, rows in removed.items() if rows}
    log = TrackLog(raw.time, raw.lat, lon, raw.values, broken, vessel, tuple(remarks), removed)
    return replace(log, notes=(*log.notes, *_speed_unit_warnings(log)))


def _speed_unit_warnings(log: TrackLog) -> list[str]:
    """Return a note if the measured speeds differ from those of the positions."""
    if "speed" not in log.values:
        return []
    moved = replace(log, values={}).speeds()
    measured = log.values["speed"]
    fast = np.isfinite(measured) & (moved > _MIN_UNDER_WAY_SPEED) & (measured > 0.0)
    ratio = float(np.median(measured[fast] / moved[fast])) if fast.any() else 1.0
    if abs(ratio - 1.0) <= _SPEED_RATIO_TOLERANCE:
        return []
    return [
        f"Measured speeds are {ratio:.2f} times those of the positions: check their unit. "
        "Speeds of legs use positions alone."
    ]


def _has_time(raw: RawTrack) -> NDArray[np.bool_]:
    return np.isfinite(raw.time)


def _has_fix(raw: RawTrack) -> NDArray[np.bool_]:
    return np.asarray((raw.lat != 0.0) | (raw.lon != 0.0))


def _has_position(raw: RawTrack) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        return np.asarray((np.abs(raw.lat) <= 90.0) & (np.abs(raw.lon) <= 180.0 + 1e-9))


def _without_duplicate_times(raw: RawTrack, removed: dict[str, int]) -> RawTrack:
    """Return the first row of every time."""
    first = np.append(True, np.diff(raw.time) > 0.0)[: len(raw.time)]
    of = np.maximum.accumulate(np.where(first, np.arange(len(first)), 0))
    same = (raw.lat == raw.lat[of]) & (raw.lon == raw.lon[of])
    removed["that repeat a time and position"] = int((~first & same).sum())
    removed["that give a time another position"] = int((~first & ~same).sum())
    return raw.part(first)


def _reachable_positions(
    raw: RawTrack, rules: CleaningRules
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return (positions to keep, whether there is a jump before each of them)."""
    count = len(raw.time)
    keep, jumps = np.ones(count, dtype=bool), np.zeros(count, dtype=bool)
    if count < 2:
        return keep, jumps
    cuts = np.flatnonzero(_too_fast(raw, rules)) + 1
    starts = np.concatenate([[0], cuts])
    ends = np.concatenate([cuts, [count]])
    long = ends - starts > rules.max_outliers
    if not long.any():
        long[np.argmax(ends - starts)] = True
    runs = list(zip(starts.tolist(), ends.tolist(), long.tolist()))
    anchor = int(np.argmax(long))  # the first run that is long enough not to be an outlier
    first = runs[anchor][0]
    for start, end, _ in reversed(runs[:anchor]):
        keep[start:end] = _reachable(raw, end - 1, first, rules)
        first = start if keep[start] else first
    last = runs[anchor][1] - 1
    for number, (start, end, whole) in enumerate(runs[anchor + 1 :], anchor + 1):
        fits = _reachable(raw, last, start, rules)
        kept = fits or (whole and not _is_passed(raw, last, runs[number : number + 2], rules))
        keep[start:end] = kept
        jumps[start] = kept and not fits
        last = end - 1 if kept else last
    return keep, jumps


def _too_fast(raw: RawTrack, rules: CleaningRules) -> NDArray[np.bool_]:
    """Return which steps are too fast; exact lengths only where rough ones do not decide."""
    ratio = rough_lengths(raw.lat, raw.lon) / (rules.fastest * np.diff(raw.time))
    fast = ratio > 1.0
    near = np.flatnonzero(np.abs(ratio - 1.0) < _ROUGH)
    ends = raw.lat[near], raw.lon[near], raw.lat[near + 1], raw.lon[near + 1]
    fast[near] = distance(*ends) > rules.fastest * np.diff(raw.time)[near]
    return np.asarray(fast)


def _is_passed(
    raw: RawTrack, last: int, runs: list[tuple[int, int, bool]], rules: CleaningRules
) -> bool:
    """Return whether the track goes on after a run, which is out of reach, as if without it.

    Parameters
    ----------
    last : The position before the run.
    runs : The run and the next one, where there is one.
    """
    if len(runs) < 2:
        return False
    (_start, end, _whole), (after, _end, _long) = runs
    return _reachable(raw, last, after, rules) and not _reachable(raw, end - 1, after, rules)


def _reachable(raw: RawTrack, i: int, j: int, rules: CleaningRules) -> bool:
    sailed = float(distance(raw.lat[i], raw.lon[i], raw.lat[j], raw.lon[j]))
    return sailed <= rules.fastest * float(raw.time[j] - raw.time[i])


def _add_notes(
    remarks: list[str],
    removed: dict[str, int],
    raw: RawTrack,
    gaps: NDArray[np.bool_],
    broken: NDArray[np.bool_],
    rules: CleaningRules,
) -> None:
    if _removed_rows_text(removed):
        remarks.append(_removed_rows_text(removed))
    if gaps.any():
        lengths = np.diff(raw.time)[gaps]
        worst = int(np.argmax(np.where(gaps, np.diff(raw.time), 0.0)))
        remarks.append(
            f"{int(gaps.sum())} gaps of more than {rules.longest_gap / 60.0:g} min, "
            f"{lengths.sum() / HOUR:.1f} h in all, the longest {lengths.max() / HOUR:.1f} h from "
            f"{format_time(float(raw.time[worst]))}."
        )
    jumps = int((broken & ~gaps).sum())
    if jumps:
        remarks.append(f"{jumps} jumps faster than {rules.fastest / KNOT:g} kn break the track.")


def _removed_rows_text(removed: dict[str, int]) -> str:
    parts = [f"{rows} {reason}" for reason, rows in removed.items() if rows]
    return f"Rows left out: {', '.join(parts)}." if parts else ""
