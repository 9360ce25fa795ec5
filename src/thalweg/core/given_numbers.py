"""Numbers as a user, a file or another program gives them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray


def to_number(value: object) -> float:
    """Return a value as a float; NaN for what is not a number.

    Truth values are not numbers (``true`` in a list of coordinates is an error), and neither are
    integers beyond the range of floats. Text that reads as a number is one.
    """
    if isinstance(value, (bool, np.bool_)):
        return math.nan
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return math.nan


def finite_number(text: object, what: str, remedy: str) -> float:
    """Return a finite number, or raise `InputError` naming what it should have been."""
    value = to_number(text)
    if not math.isfinite(value):
        raise InputError(
            f"The {what} is {shortened_repr(text)}, not a number.",
            "It is a decimal number.",
            remedy,
            value=text,
        )
    return value


def is_number(value: object) -> bool:
    """Return whether a value is a finite number; text and truth values are not."""
    return not isinstance(value, (str, bytes, np.ndarray)) and math.isfinite(to_number(value))


def finite_or_none(value: float | None) -> float | None:
    """Return a number, or None where there is none or it is not finite, as JSON has no other."""
    return None if value is None or not math.isfinite(value) else float(value)


def rounded_or_none(value: float | None, digits: int) -> float | None:
    """Return a number with some decimals, or None where there is none or it is not finite."""
    return None if value is None or not math.isfinite(value) else round(float(value), digits)


def float_array(values: ArrayLike, what: str) -> FloatArray:
    """Return a new array of floats.

    Parameters
    ----------
    what : Name of the values in errors, such as ``latitudes``.

    Raises
    ------
    InputError : If they are not numbers, or not in rows of one length.
    """
    try:
        given = np.array(values)
        if given.dtype.kind != "b":
            return np.array(given, dtype=float)
    except (TypeError, ValueError, OverflowError):
        pass
    raise InputError(
        f"The {what} are {shortened_repr(values)}, which are not numbers.",
        "They are an array or a list of numbers.",
        "Correct them.",
        field=what,
    )


def shortened_repr(value: object, most: int = 60) -> str:
    """Return how Python writes a value, cut to a length that fits into a message."""
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # an integer of thousands of digits, or deep nesting
        text = f"a {type(value).__name__} that is too long to show"
    return text if len(text) <= most else f"{text[: most - 3]}..."
