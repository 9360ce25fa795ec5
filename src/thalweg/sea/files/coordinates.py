"""Recognise the variables that hold latitudes and longitudes."""

from __future__ import annotations

from typing import Any, Final

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
