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


def check_plausible(name: str, value: NDArray[Any], variables: list[str], source: str) -> None:
    """Raise `DatasetError` if values are outside the plausible range of a variable.

    Parameters
    ----------
    name : str
        Canonical name.
    value : array
        Values [SI], NaN where unknown.
    variables : list of str
        Names in the file, for messages.
    source : str
        File name for messages.
    """
    if name not in PLAUSIBLE_RANGES or value.size == 0:
        return
    low, high = PLAUSIBLE_RANGES[name]
    slack = RANGE_TOLERANCE * (high - low)
    least, largest = _extremes(value)
    if least >= low - slack and largest <= high + slack:
        return
    if np.isnan(least):
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


def _extremes(value: NDArray[Any]) -> tuple[float, float]:
    least, largest = (
        float(np.fmin.reduce(value, axis=None)),
        float(np.fmax.reduce(value, axis=None)),
    )
    return least, largest
