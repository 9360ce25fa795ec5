"""Plausible ranges of values: a final check against wrong units and unmarked fill values."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import DatasetError
from thalweg.sea import standard_names as nm

#: smallest and largest plausible value, SI; wide, to detect wrong units and fill values only
PLAUSIBLE_RANGES: Final[dict[str, tuple[float, float]]] = {
    nm.EASTWARD_WIND: (-120.0, 120.0),
    nm.NORTHWARD_WIND: (-120.0, 120.0),
    "wind_speed": (0.0, 120.0),
    nm.EASTWARD_CURRENT: (-15.0, 15.0),
    nm.NORTHWARD_CURRENT: (-15.0, 15.0),
    "sea_water_speed": (0.0, 15.0),
    nm.WAVE_HEIGHT: (0.0, 40.0),
    nm.WAVE_PERIOD: (0.0, 60.0),
    nm.WATER_LEVEL: (-50.0, 50.0),
    nm.BED_DEPTH: (-9500.0, 12000.0),
    nm.PRESSURE: (80000.0, 112000.0),
    nm.ICE: (0.0, 1.01),
}
RANGE_TOLERANCE: Final = 0.01  #: fraction of the range by which packed values may exceed it
NEGATIVE_TOLERANCE: Final = 0.02  #: packing error of heights [m] and periods [s], read as zero
NEVER_NEGATIVE: Final = frozenset({nm.WAVE_HEIGHT, nm.WAVE_PERIOD, "wind_speed", "sea_water_speed"})
_WIND_FILLS: Final = (99.0, 99.9, 99.99, 99.999)
_PACKED_FILLS: Final = (32.766, 32.767, 32.768)
DEPTH_FILLS: Final = (999.0, 999.9, 9999.0, 9999.9)
#: plausible numbers (with either sign) that often stand for missing values
COMMON_FILLS: Final[dict[str, tuple[float, ...]]] = {
    **dict.fromkeys((*nm.WIND.pair, "wind_speed"), _WIND_FILLS),
    **dict.fromkeys((*nm.CURRENT.pair, "sea_water_speed"), (9.9, 9.99, 9.999)),
    **dict.fromkeys((nm.WAVE_HEIGHT, nm.WATER_LEVEL), _PACKED_FILLS),
    nm.BED_DEPTH: DEPTH_FILLS,
}
DIRECTION_FILLS: Final = (-9.0, -9.9, -9.99, -99.0, -99.9, -99.99)
_BLOCK: Final = 1 << 20  #: values compared at a time, so that temporaries stay small
_FEW: Final = 3  #: so many equal values are needed for a fill value that is a common number
_RARE: Final = 9000.0  #: from this size on, one is enough


def check_plausible(name: str, value: NDArray[Any], variables: list[str], source: str) -> None:
    """Raise `DatasetError` if values are outside the plausible range of a variable.

    Parameters
    ----------
    name : Canonical name.
    value : Values [SI], NaN where unknown.
    variables : Names in the file, for messages.
    source : File name for messages.
    """
    if name not in PLAUSIBLE_RANGES or value.size == 0:
        return
    low, high = PLAUSIBLE_RANGES[name]
    slack = RANGE_TOLERANCE * (high - low)
    below = NEGATIVE_TOLERANCE if name in NEVER_NEGATIVE else slack
    least, largest = _extremes(value)
    if np.isnan(least):
        return
    if least >= low - below and largest <= high + slack:
        fill = unmarked_fill(value, COMMON_FILLS.get(name, ()))
        if fill is not None:
            raise unmarked_fill_error(source, ", ".join(variables), name, fill)
        return
    worst = largest if largest > high + slack else least
    unit = nm.CANONICAL_UNITS.get(name, "")
    raise DatasetError(
        f"{source}: {', '.join(variables)} read as {name} reaches {worst:g} {unit}.",
        f"Values between {low:g} and {high:g} {unit} are plausible; the units may be wrong, or "
        "missing values not marked.",
        "Correct the file's units or _FillValue, or map another variable.",
        variable=name,
        value=worst,
        file=source,
    )


def check_not_negative(name: str, value: NDArray[Any]) -> None:
    """Raise `DatasetError` if a function returns a negative height, period or speed.

    Parameters
    ----------
    name : Standard name of what the function returns.
    value : What it returned [SI].
    """
    if nm.canonical_name(name) not in NEVER_NEGATIVE:
        return
    least = float(np.fmin.reduce(np.ravel(value), initial=np.inf))
    if least < -NEGATIVE_TOLERANCE:
        raise DatasetError(
            f"The function of {name} returns {least:g}.",
            "It is never negative; NaN stands for a value that is not known.",
            "Correct the function.",
            variable=name,
            value=least,
        )


def without_packing_error(name: str, value: NDArray[Any]) -> NDArray[Any]:
    """Return values, small negative ones of quantities that are never negative as zero.

    Parameters
    ----------
    name : Canonical name.
    value : Values [SI] that passed `check_plausible`.
    """
    return np.maximum(value, 0.0) if name in NEVER_NEGATIVE else value


def unmarked_fill(value: NDArray[Any], candidates: tuple[float, ...]) -> float | None:
    """Return the number that stands for missing values without being marked so, or None.

    It is one of the candidates, with either sign, that occurs far more often than the values
    around it (within 2 %): fields of nature vary.

    Parameters
    ----------
    value : Values in the unit of the file.
    candidates : Positive numbers.
    """
    if not candidates or value.size == 0:
        return None
    least, largest = _extremes(value)
    for number in (sign * c for c in candidates for sign in (1.0, -1.0)):
        if not least <= number * (1.0 + 1e-6 * np.sign(number)) or not number <= largest + 1e-3:
            continue
        same, near = _count_near(value, number)
        if same >= (1 if abs(number) >= _RARE else _FEW) and same > near / 4:
            return number
    return None


def holds_any(value: NDArray[Any], candidates: tuple[float, ...]) -> bool:
    """Return whether values hold one of the candidates, with either sign."""
    size = np.abs(value)
    return any(bool((np.abs(size - c) <= 1e-6 * c).any()) for c in candidates)


def _count_near(value: NDArray[Any], number: float) -> tuple[int, int]:
    """Return how many values equal a number, and how many others are within 2 % of it."""
    same = near = 0
    flat = value.reshape(-1)
    for first in range(0, flat.size, _BLOCK):
        offset = np.abs(flat[first : first + _BLOCK] - number)
        same += int((offset <= 1e-6 * abs(number)).sum())
        near += int((offset <= 0.02 * abs(number)).sum())
    return same, near - same


def unmarked_fill_error(source: str, variable: str, role: str, fill: float) -> DatasetError:
    """Return the error for a number that seems to stand for missing values."""
    return DatasetError(
        f"{source}: {variable}, read as {role}, has the value {fill:g} at many places and no value "
        "near it.",
        "It seems to stand for missing values, which the file must mark: as values they would "
        "count as true ones.",
        f"Set the attribute _FillValue or missing_value to {fill:g} (for example with ncatted), or "
        "replace these values by NaN.",
        variable=role,
        value=fill,
        file=source,
    )


def check_direction(value: NDArray[Any], variable: str, source: str) -> None:
    """Raise `DatasetError` if directions hold numbers that are none.

    Parameters
    ----------
    value : Directions [deg]; -360 to 360 is plausible.
    variable : Name in the file.
    source : File name for messages.
    """
    if value.size == 0:
        return
    least, largest = _extremes(value)
    if np.isnan(least):
        return
    worst = None
    if least < -360.5 or largest > 360.5:
        worst = largest if largest > 360.5 else least
    elif least < 0.0:
        below = value[value < 0.0]
        alone = float(below.flat[0])
        if (below == alone).all() and np.isclose(alone, DIRECTION_FILLS, rtol=1e-6).any():
            worst = alone
    if worst is None:
        return
    raise DatasetError(
        f"{source}: the direction {variable!r} has the value {worst:g}.",
        "Directions are between 0 and 360 or between -180 and 180 degrees; this number seems to "
        "stand for missing values that are not marked.",
        "Correct the file's units or _FillValue.",
        variable=variable,
        value=worst,
        file=source,
    )


def _extremes(value: NDArray[Any]) -> tuple[float, float]:
    return float(np.fmin.reduce(value, axis=None)), float(np.fmax.reduce(value, axis=None))
