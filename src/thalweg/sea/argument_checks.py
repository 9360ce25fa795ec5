"""Checks of the areas, periods and time steps that users give."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import is_number, shortened_repr, to_number
from thalweg.core.time import TimeLike, parse_time


def parse_area(area: tuple[float, float, float, float] | BoundingBox | None) -> BoundingBox:
    """Return the box for (south, north, west, east) [deg]; the world for None.

    Parameters
    ----------
    area : (south, north, west, east) [deg].

    Returns
    -------
    BoundingBox : With ``east`` above ``west``; it may exceed 180.

    Raises
    ------
    InputError : If the values are not four finite numbers with south below north.
    """
    if area is None:
        return WORLD
    if isinstance(area, BoundingBox):
        area = (area.south, area.north, area.west, area.east)
    try:
        south, north, west, east = (to_number(x) for x in area)
    except (TypeError, ValueError):
        south = north = west = east = np.nan
    if not (-90.0 <= south < north <= 90.0 and np.isfinite([west, east]).all()):
        raise InputError(
            f"The area {area!r} is not a valid box.",
            "An area is (south, north, west, east) in degrees with south < north.",
            "Check the four numbers and their order.",
        )
    return BoundingBox(south, north, west, east if east > west else east + 360.0)


def parse_period(period: tuple[TimeLike, TimeLike] | None) -> tuple[float, float] | None:
    """Return (start, end) [s since epoch].

    Parameters
    ----------
    period : Start and end; None stays None.

    Raises
    ------
    InputError : If there are not two times, or the end is before the start.
    """
    if period is None:
        return None
    listed = isinstance(period, (Sequence, np.ndarray)) and not isinstance(period, str)
    if not listed or len(period) != 2:
        raise InputError(
            f"The period {shortened_repr(period)} is not valid.",
            "A period is (start, end).",
            "Give two times.",
        )
    start, end = parse_time(period[0]), parse_time(period[1])
    if end < start:
        raise InputError(
            "The period ends before it starts.", "A period is (start, end).", "Swap the two times."
        )
    return start, end


def parse_time_step(time_step: float | None, *, least: float = 0.0) -> float | None:
    """Return a time step [s] that is None, or not less than the smallest allowed.

    Parameters
    ----------
    time_step : Time step [s]; None stays None.
    least : Smallest allowed step [s].

    Raises
    ------
    InputError : If the step is not finite or too small.
    """
    if time_step is not None and not (is_number(time_step) and time_step >= least):
        raise InputError(
            f"A time step of {shortened_repr(time_step)} s cannot be used.",
            f"It must be {least:g} s or more."
            if least
            else "It must be positive, or 0 for fields that never change.",
            "Correct it, or omit it to use the default.",
        )
    return None if time_step is None else float(time_step)
