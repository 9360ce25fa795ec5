"""Recognise the variables that hold latitudes and longitudes."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray

LATITUDE_NAMES: Final = (
    "latitude",
    "lat",
    "nav_lat",
    "gphit",
    "xlat",
    "lat_rho",
    "gphiu",
    "gphiv",
    "gphif",
)
LONGITUDE_NAMES: Final = (
    "longitude", "lon", "nav_lon", "glamt", "xlong", "lon_rho", "glamu", "glamv", "glamf",
)  # fmt: skip
NORTH_UNITS: Final = (
    "degrees_north",
    "degree_north",
    "degree_n",
    "degrees_n",
    "degreen",
    "degreesn",
)
_RADIANS: Final = ("radian", "radians", "rad")
_PARTS_OF_DEGREE: Final = 2400  #: 1/2, 1/3, 1/4, 1/5, 1/12, 1/16, 1/24, 1/32, 1/60 and others
EAST_UNITS: Final = ("degrees_east", "degree_east", "degree_e", "degrees_e", "degreee", "degreese")


def is_latitude(array: Any, name: str) -> bool:
    """Return whether a variable holds latitudes."""
    return _is_axis(array, name, "latitude", NORTH_UNITS, LATITUDE_NAMES)


def is_longitude(array: Any, name: str) -> bool:
    """Return whether a variable holds longitudes."""
    return _is_axis(array, name, "longitude", EAST_UNITS, LONGITUDE_NAMES)


def _is_axis(
    array: Any, name: str, standard: str, units: tuple[str, ...], known: tuple[str, ...]
) -> bool:
    attributes = array.attrs
    given = str(attributes.get("standard_name", "")).lower()
    if given:
        return given == standard
    if str(attributes.get("units", "")).lower() in units:
        return True
    return name.lower() in known


def in_degrees(array: Any) -> FloatArray:
    """Return latitudes or longitudes in degrees, whatever their unit."""
    values = np.asarray(array.values, np.float64)
    unit = str(array.attrs.get("units", "")).strip().lower().partition("_")[0]
    if unit not in _RADIANS:
        return values
    single = array.dtype == np.float32  # radians of single precision put poles beyond 90 degrees
    return np.asarray(np.round(np.degrees(values), 5 if single else 10), np.float64)


def check_no_radians(lat: FloatArray, lon: FloatArray, source: str) -> None:
    """Raise `DatasetError` if axes that count as degrees hold radians.

    Axes of models are multiples of small parts of a degree. Where both are so after a conversion
    from radians, and neither is as it stands, the unit in the file is wrong.

    Parameters
    ----------
    lat, lon : Axes [deg], (n,) and (m,).
    """
    if np.abs(lat).max() > 0.5 * np.pi + 0.01 or np.abs(lon).max() > 2.0 * np.pi + 0.01:
        return
    axes = [axis for axis in (lat, lon) if axis.size > 2]
    if len(axes) < 2 or any(_round_axis(axis) for axis in axes):
        return
    if all(_round_axis(np.degrees(axis)) for axis in axes):
        raise DatasetError(
            f"{source}: latitudes to {np.abs(lat).max():.4g} and longitudes to "
            f"{np.abs(lon).max():.4g} count as degrees and look like radians.",
            f"As radians they are steps of {np.degrees(abs(lat[1] - lat[0])):.4g} degrees.",
            "Correct the attribute units of both axes: 'radian', or the values.",
            file=source,
        )


def _round_axis(axis: FloatArray) -> bool:
    """Return whether an axis has equal steps that are, as its start, round parts of a degree."""
    step = (axis[-1] - axis[0]) / (axis.size - 1)
    equal = np.abs(np.diff(axis) - step).max() <= 5e-3 * abs(step)
    parts = np.array([step, axis[0]]) * _PARTS_OF_DEGREE
    return bool(equal and np.abs(parts - np.round(parts)).max() < 0.05 and abs(parts[0]) > 0.5)
