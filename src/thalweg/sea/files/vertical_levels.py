"""Vertical axes of files: which level is the surface, and at which height the wind is given."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray
from thalweg.sea.files import unit_conversion

VERTICAL_NAMES: Final = (
    "depth", "lev", "level", "height", "sigma", "s_rho", "deptht", "depthu", "depthv", "altitude",
    "isobaric", "pressure", "plev",
)  # fmt: skip
WIND_HEIGHT: Final = 10.0  #: [m] height above the sea of the wind that is used
CLIMATOLOGY_NAMES: Final = ("month", "season", "dayofyear", "climatology")
SIGMA_STANDARD_NAME: Final = "ocean_sigma_coordinate"
HEIGHT_NAMES: Final = ("altitude", "height", "height_above_mean_sea_level", "height_above_geoid")
DEPTH_NAMES: Final = ("depth", "depth_below_geoid", "depth_below_mean_sea_level")
_ROUNDING_TOLERANCE: Final = 1e-6


def pick_surface(dataset: Any, array: Any, keep: frozenset[str], role: str, source: str) -> Any:
    """Select one index along dimensions that are neither time nor position.

    Of vertical levels the one nearest to the surface is used; of heights of wind the one nearest
    to 10 m.

    Parameters
    ----------
    dataset, array : The file and one of its variables.
    keep : Its dimensions of time and position.
    role : Role of the variable.
    source : File name for messages.

    Raises
    ------
    DatasetError : If a dimension is not a vertical axis, or wind is given at pressure levels.
    """
    for dim in [d for d in array.dims if d not in keep]:
        size = array.sizes[dim]
        if size == 1:
            array = array.isel({dim: 0})
            continue
        levels = level_coordinate(dataset, str(dim))
        array = array.isel({dim: _select_level(dim, levels, role, str(array.name), source)})
    return array


def _select_level(dim: str, levels: Any, role: str, name: str, source: str) -> int:
    lower = dim.lower()
    if any(word in lower for word in CLIMATOLOGY_NAMES):
        raise _layout_fault(
            source, name, f"is a climatology along {dim!r}: a mean year has no dates",
            "Make a file with real dates, one for each month of the voyage.",
        )  # fmt: skip
    attributes = levels.attrs if levels is not None else {}
    is_vertical = (
        any(lower.startswith(word) for word in VERTICAL_NAMES)
        or attributes.get("axis") == "Z"
        or "positive" in attributes
        or (levels is not None and is_sigma(levels))
    )
    if levels is None or not is_vertical:
        raise _layout_fault(
            source, name, f"has a dimension {dim!r} that is neither time, position nor level",
            "Write a file with one index along it.",
        )  # fmt: skip
    if "wind" not in role:
        return surface_index(levels)
    if _is_pressure(levels):
        raise _layout_fault(
            source, name, f"is wind at levels of pressure ({levels.name}), none of them at 10 m",
            "Download the wind at 10 m (u10 and v10).",
        )  # fmt: skip
    return int(np.argmin(np.abs(np.asarray(levels.values, float) - WIND_HEIGHT)))


def wind_height_fault(dataset: Any, array: Any) -> str | None:
    """Return why a wind cannot be used, if the file states that it is not at 10 m; else None.

    The variable's own vertical axis decides; without one, a single height that the variable names
    (or that GRIB gives).
    """
    named = array.encoding.get("coordinates", array.attrs.get("coordinates", ""))
    stated = {"heightAboveGround", *str(named or "").split()}
    axes = [dataset[n] for n in dataset.variables if _is_vertical(dataset[n], str(n))]
    for axis in (a for a in axes if _is_pressure(a)):
        if str(axis.name) in stated or (axis.ndim == 1 and axis.dims[0] in array.dims):
            unit = axis.attrs.get("units", "")
            levels = np.atleast_1d(axis.values).tolist()
            return (
                f"it holds wind at levels of pressure ({axis.name}: {levels} {unit}), not at 10 m"
            )
    along = [a for a in axes if a.ndim == 1 and a.dims[0] in array.dims and a.size > 1]
    single = [a for a in axes if a.size == 1 and (str(a.name) in stated or a.name in array.dims)]
    single = [a for a in single if str(a.name).lower().startswith("height")]
    for axis in along or (single if len(single) == 1 else []):
        values = np.atleast_1d(np.asarray(axis.values, float))
        if np.abs(values - WIND_HEIGHT).min() > 1.0:
            return f"it holds wind at {values.tolist()} ({axis.name}), not at 10 m"
    return None


def _is_pressure(axis: Any) -> bool:
    """Return whether a vertical axis is in units of pressure."""
    named = str(axis.name).lower().startswith(("isobaric", "pressure", "plev"))
    return (
        named or unit_conversion.si_factor(str(axis.attrs.get("units", "")), "pressure") is not None
    )


def _is_vertical(axis: Any, name: str) -> bool:
    known = any(name.lower().startswith(word) for word in VERTICAL_NAMES)
    return known and axis.ndim <= 1 and axis.dtype.kind in "fiu"


def _layout_fault(source: str, name: str, fault: str, remedy: str) -> DatasetError:
    return DatasetError(
        f"{source}: {name!r} {fault}.",
        "Fields on a grid or mesh, with dates, at the surface (wind at 10 m) can be read.",
        remedy,
        file=source,
        variable=name,
    )


def level_coordinate(dataset: Any, dim: str) -> Any:
    """Return the coordinate of levels along a dimension: its own, or another vertical one."""
    if dim in dataset.variables:
        return dataset[dim]
    along = [dataset[n] for n in dataset.variables if dataset[n].dims == (dim,)]
    vertical = (a for a in along if is_sigma(a) or "positive" in a.attrs or depth_sign(a))
    return next(vertical, None)


def is_sigma(coordinate: Any) -> bool:
    """Return whether a coordinate is a fraction of the water depth."""
    standard = str(coordinate.attrs.get("standard_name", ""))
    if standard:
        return standard == SIGMA_STANDARD_NAME
    return "sigma" in str(coordinate.name).lower()


def depth_sign(coordinate: Any) -> float | None:
    """Return the sign that converts a coordinate to a depth below datum; None if it is not one."""
    standard = str(coordinate.attrs.get("standard_name", ""))
    positive = str(coordinate.attrs.get("positive", "")).lower()
    unit = str(coordinate.attrs.get("units", ""))
    if (
        unit
        and not unit_conversion.is_unspecified(unit)
        and unit_conversion.si_factor(unit, "length") is None
    ):
        return None
    if positive in ("up", "down"):
        return 1.0 if positive == "down" else -1.0
    if standard in HEIGHT_NAMES:
        return -1.0
    named = str(coordinate.name).lower().startswith("depth")
    return 1.0 if standard in DEPTH_NAMES or (named and not standard) else None


def sigma_sign_and_offset(coordinate: Any, values: FloatArray) -> tuple[float, float]:
    """Return sign and offset that convert sigma to a fraction of the depth, 0 at the surface."""
    if values.min() < -_ROUNDING_TOLERANCE:  # the convention: 0 at the surface, -1 at the bed
        return -1.0, 0.0
    down = str(coordinate.attrs.get("positive", "up")).lower() == "down"
    return (1.0, 0.0) if down else (-1.0, 1.0)


def surface_index(coordinate: Any) -> int:
    """Return the index of the level nearest to the surface."""
    values = np.asarray(coordinate.values, float)
    if values.ndim == 2:  # FVCOM: layers by node, named as their dimension
        along = (
            list(coordinate.dims).index(coordinate.name)
            if coordinate.name in coordinate.dims
            else 0
        )
        values = np.nanmean(values, axis=1 - along)
    if is_sigma(coordinate):
        sign, offset = sigma_sign_and_offset(coordinate, values)
        return int(np.argmin(sign * values + offset))
    return int(np.argmin(np.abs(values)))
