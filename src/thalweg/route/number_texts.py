"""Numbers in summaries and tables, with as many digits as their size and differences need."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np

#: Units that are too large for small craft, with the smaller one and how many of it make one.
_SMALLER: Final[Mapping[str, tuple[str, float]]] = {"t": ("kg", 1e3), "MWh": ("kWh", 1e3)}
_SIGNIFICANT: Final = 3  # digits that the largest value has at least
_MOST_SIGNIFICANT: Final = 5  # digits that it has at most, for values that differ little
_UNITS_OF_MONEY: Final = 3  # letters of a currency
_LARGE: Final = 1e4  # values from here on have no decimals


class AmountColumn(NamedTuple):
    """Amounts as texts, with one number of decimals.

    Attributes
    ----------
    texts : ``"-"`` where a value is not known.
    unit : In which they are.
    """

    texts: list[str]
    unit: str


def decimals(values: Iterable[float], *, least: int = 0, most: int = 2) -> int:
    """Return with how many decimals values are written beside each other.

    Parameters
    ----------
    values : Those that are not known do not count.
    least, most : Bounds of the number.

    Returns
    -------
    int : So many that the largest has three digits, and more where they keep values apart, up to
        five digits.
    """
    known = np.array([value for value in values if math.isfinite(value)], float)
    largest = float(np.max(np.abs(known), initial=0.0))
    if largest == 0.0:
        return least
    before = math.floor(math.log10(largest)) + 1  # the point
    low = max(least, min(most, _SIGNIFICANT - before))
    high = max(low, min(most, _MOST_SIGNIFICANT - before))
    apart = len(np.unique(np.round(known, high)))
    return next(d for d in range(low, high + 1) if len(np.unique(np.round(known, d))) == apart)


def amount_column(values: Sequence[float], unit: str) -> AmountColumn:
    """Return amounts of one unit as texts: in kg and kWh where all are below a tonne or a MWh.

    Parameters
    ----------
    values : NaN where not known.
    unit : ``"t"``, ``"MWh"``, a currency or another one.
    """
    known = [abs(value) for value in values if math.isfinite(value)]
    largest = max(known, default=0.0)
    scale, least, most = 1.0, 2 if unit == "MWh" else 1, 3
    if unit in _SMALLER and 0.0 < largest < 1.0:
        unit, scale = _SMALLER[unit]
        least = 0
    elif len(unit) == _UNITS_OF_MONEY and unit.isupper():
        least, most = (2, 2) if 0.0 < largest < 100.0 else (0, 2)
    elif largest >= _LARGE:
        least, most = 0, 1
    scaled = [scale * value for value in values]
    digits = decimals(scaled, least=least, most=most)
    texts = [f"{value:,.{digits}f}" if math.isfinite(value) else "-" for value in scaled]
    return AmountColumn(texts, unit)


def amount_text(value: float, unit: str) -> str:
    """Return an amount with its unit, such as ``312 kg`` for 0.312 t."""
    (text,), unit = amount_column([value], unit)
    return f"{text} {unit}".rstrip()


def hours_texts(values: Sequence[float]) -> list[str]:
    """Return times [h] as texts with one decimal, or two where they are short or near each other.

    Parameters
    ----------
    values : [h]; NaN where not known.
    """
    digits = decimals(values, least=1)
    return [f"{value:,.{digits}f}" if math.isfinite(value) else "-" for value in values]


def miles_text(value: float) -> str:
    """Return a length [nautical miles] with one decimal, or two where it is short."""
    return f"{value:,.{decimals([value], least=1)}f}"
