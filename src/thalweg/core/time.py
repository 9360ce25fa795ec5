"""Time: ISO 8601 UTC at the boundary, float seconds since 1970-01-01T00:00Z inside."""

from __future__ import annotations

import math
import re
from datetime import UTC, date, datetime, timedelta
from typing import Final, TypeAlias

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import shortened_repr, to_number
from thalweg.core.units import DAY, MINUTE

TimeLike: TypeAlias = "str | float | int | date | np.datetime64"
_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
_NANOSECOND_YEARS: Final = 9.2e9  #: [s] from 1970 to the limits of nanoseconds, in 1678 and 2262
_LEAST_OFFSET, _MOST_OFFSET = timedelta(hours=-12), timedelta(hours=14)  # of time zones
_EARLIEST, _LATEST = -62_135_596_800.0, 253_402_300_799.0  # years 1 to 9999


def parse_time(value: TimeLike) -> float:
    """Return seconds since 1970-01-01T00:00Z.

    Parameters
    ----------
    value : ISO 8601 text (``2026-01-01T00:00Z``; without a zone it is read as UTC), a datetime
        (naive ones are read as UTC) or seconds since the epoch.

    Raises
    ------
    InputError
        If the text is not a time, or the number is not finite or outside the years 1 to 9999.
    """
    if isinstance(value, (np.datetime64, datetime)) and value != value:  # NaT of numpy and pandas
        raise InputError(
            "A time is missing (NaT).",
            "A time is a date and a time of day in UTC.",
            "Give one such as 2026-01-01T00:00Z.",
        )
    if isinstance(value, np.datetime64):
        return _from_datetime64(value)
    if isinstance(value, datetime):
        moment = value
    elif isinstance(value, date):
        moment = datetime(value.year, value.month, value.day)
    elif isinstance(value, str):
        moment = _parse_text(value)
    elif isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
        raise InputError(
            f"{value!r} is not a time.",
            "Times are ISO 8601 text in UTC, datetimes or seconds since 1970.",
            "Give one such as 2026-01-01T06:30Z.",
        )
    else:
        seconds = to_number(value)
        if not math.isfinite(seconds) and isinstance(value, (float, np.floating)):
            raise InputError(
                f"The time is {value!r}.",
                "A time is a finite number of seconds since 1970, or ISO 8601 text.",
                "Give an ISO 8601 time.",
            )
        return _calendar_time(seconds, value)
    if moment.tzinfo is None:
        moment = moment.replace(tzinfo=UTC)
    return _calendar_time(moment.timestamp(), moment)


def _calendar_time(seconds: float, given: object) -> float:
    """Return seconds since 1970 in the years 1 to 9999, or raise `InputError`."""
    if not _EARLIEST <= seconds <= _LATEST:
        raise InputError(
            f"{shortened_repr(given)} is not a calendar time in UTC.",
            "Times are in the years 1 to 9999; a number counts seconds since 1970, not "
            "milliseconds.",
            "Give an ISO 8601 time such as 2026-01-01T06:30Z.",
        )
    return seconds


def _from_datetime64(value: np.datetime64) -> float:
    """Return seconds since 1970; nanoseconds are not used, as they end in the year 2262."""
    unit, _ = np.datetime_data(value.dtype)
    if unit == "generic":
        raise InputError(
            f"The time {value!r} has no unit.",
            "A numpy time has a unit, such as seconds or days.",
            "Give one such as 2026-01-01T00:00Z.",
        )
    # the day first: microseconds overflow for years far away
    _calendar_time(DAY * float(value.astype("datetime64[D]").astype(np.int64)), value)
    return float(value.astype("datetime64[us]").astype(np.int64)) / 1e6


def _parse_text(text: str) -> datetime:
    try:
        moment = datetime.fromisoformat(text.strip())
    except ValueError as error:
        if str(error).startswith("offset must be"):
            raise _offset_error(text) from None
        in_form = re.match(r"\s*\d{4}-\d{2}-\d{2}($|[T\s]+\d{2}:\d{2})", text) is not None
        raise InputError(
            f"{text!r} is not a time" + (f": {error}." if in_form else "."),
            "Times are ISO 8601 in UTC, such as 2026-01-01T06:30Z.",
            "Give a date and time that exist." if in_form else "Write the time in this form.",
            value=text,
        ) from None
    offset = moment.utcoffset()
    if offset is not None and not _LEAST_OFFSET <= offset <= _MOST_OFFSET:
        raise _offset_error(text)
    return moment


def _offset_error(text: str) -> InputError:
    return InputError(
        f"{text!r} is not a time: no time zone has that offset.",
        "Offsets from UTC are -12:00 to +14:00; Z is UTC.",
        "Give the time in UTC, such as 2026-01-01T06:30Z.",
        value=text,
    )


def format_time(seconds: float) -> str:
    """Return ISO 8601 text in UTC with a Z, rounded to the second.

    NaN and times outside the years 1 to 9999 are 'unknown'.
    """
    if not _EARLIEST <= seconds <= _LATEST:
        return "unknown"
    moment = _EPOCH + timedelta(seconds=round(seconds))
    return moment.replace(tzinfo=None).isoformat() + "Z"


def to_datetime64(seconds: float | np.ndarray) -> np.ndarray:
    """Return ``datetime64[ns]`` (UTC) for seconds since the epoch; NaN becomes NaT.

    Times outside the years 1678 to 2261, which nanoseconds do not reach, come as microseconds.

    Raises
    ------
    InputError : If a time is outside the years 1 to 9999.
    """
    given = np.asarray(seconds, float)
    known = given[~np.isnan(given)]
    if known.size and not (known.min() >= _EARLIEST and known.max() <= _LATEST):
        worst = known[np.argmax(np.abs(known))]
        raise InputError(
            f"{worst:g} s since 1970 is not a calendar time in UTC.",
            "Times are in the years 1 to 9999.",
            "Check the time and its unit.",
        )
    unit, scale = "ns", 1e9
    if known.size and np.abs(known).max() > _NANOSECOND_YEARS:
        unit, scale = "us", 1e6
    ticks = np.round(np.where(np.isnan(given), 0.0, given) * scale).astype(np.int64)
    stamps = ticks.astype(f"datetime64[{unit}]")
    return np.where(np.isnan(given), np.array("NaT", stamps.dtype), stamps)[()]


def utc_text(time: float) -> str:
    """Return a time [s since 1970] to the minute, such as ``2026-01-01 06:00 UTC``.

    Parameters
    ----------
    time : Seconds since 1970-01-01T00:00Z; not finite: "not known".
    """
    if not math.isfinite(time):
        return "not known"
    return format_time(round(time / MINUTE) * MINUTE)[:16].replace("T", " ") + " UTC"


def duration_text(seconds: float) -> str:
    """Return a duration [s] to the minute, such as ``7 d 21 h 25 min``."""
    minutes = round(seconds / MINUTE)
    days, rest = divmod(minutes, round(DAY / MINUTE))
    hours, minutes = divmod(rest, 60)
    return (
        (f"{days} d " if days else "") + (f"{hours} h " if days or hours else "") + f"{minutes} min"
    )
