"""Validation of the entries of a project file: numbers, places and times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, check_position
from thalweg.core.given_numbers import is_number
from thalweg.core.time import parse_time

MAX_LOAD_FACTORS = 201
MAX_DAYS = 4000.0  #: longest period of a project


def parse_load_factors(value: Any) -> tuple[float, ...]:
    """Return load factors, ascending, from a list or a number of evenly spaced values from 0 to 1.

    Raises
    ------
    InputError
    """
    if isinstance(value, int) and not isinstance(value, bool) and 2 <= value <= MAX_LOAD_FACTORS:
        return tuple(round(float(x), 12) for x in np.linspace(0.0, 1.0, value))
    listed = isinstance(value, Sequence) and not isinstance(value, str) and len(value)
    if not listed or not all(is_number(x) and 0.0 <= x <= 1.0 for x in value):
        raise InputError(
            f"load_factors is {value!r}.",
            f"It is a list of shares from 0 to 1, or a number of values (2 to {MAX_LOAD_FACTORS}).",
            "Write load_factors: 11.",
            field="load_factors",
        )
    found = tuple(sorted({float(x) for x in value}))
    if found[-1] <= 0.0 or len(found) > MAX_LOAD_FACTORS:
        raise InputError(
            f"load_factors is {value!r}.",
            f"It has at most {MAX_LOAD_FACTORS} values, one of them above 0.",
            "Correct load_factors.",
            field="load_factors",
        )
    return found


def parse_start(value: Any) -> float:
    """Return a start [s since 1970-01-01T00:00Z]; a number such as 20260501 is not accepted."""
    if isinstance(value, (int, float)):
        raise InputError(
            f"start is the number {value!r}.",
            "Times are ISO 8601 in UTC, such as 2026-01-01T06:30Z.",
            "Give the time in this form.",
            field="start",
        )
    return parse_time(value)


def parse_days(data: Mapping[str, Any]) -> float:
    """Return the longest duration of a project [days]; 35 if none is given."""
    days = positive_number(data, "days", 35.0)
    if days > MAX_DAYS:
        raise InputError(
            f"days is {days:g}.", f"It is at most {MAX_DAYS:g}.", "Give fewer days.", field="days"
        )
    return days


def parse_place(value: Any, what: str) -> Position:
    """Return a (lat, lon) [deg]."""
    try:
        lat, lon = value
        return check_position(float(lat), float(lon), what)
    except (TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"{what} is {value!r}.", "A place is [lat, lon] in degrees.", "Correct it.", field=what
        ) from None


def positive_number(data: Mapping[str, Any], name: str, default: float | None = None) -> float:
    """Return the positive number under a name.

    Raises
    ------
    InputError : If it is missing without a default, or not a positive finite number.
    """
    value = data.get(name, default)
    if not is_number(value) or value <= 0.0:  # type: ignore[operator]
        raise InputError(
            f"{name} is {value!r}.",
            "It is a number above zero, without spaces and separators of thousands.",
            "Correct it.",
            field=name,
        )
    return float(value)  # type: ignore[arg-type]


def check_clearance(name: str, value: Any) -> None:
    """Raise `InputError` unless a clearance is from 0 to 100 m."""
    if not is_number(value) or not 0.0 <= value <= 100.0:
        raise InputError(f"{name} is {value!r}.", "It is 0 to 100 m.", "Correct it.", field=name)
