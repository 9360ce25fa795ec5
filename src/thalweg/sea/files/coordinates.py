"""Where and when the values of a dataset lie: time axes, positions, levels, projections."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray
from thalweg.sea.files import unit_conversion
from thalweg.sea.files.vertical_levels import is_sigma, level_coordinate, surface_index

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
VERTICAL_NAMES: Final = (
    "depth", "lev", "level", "height", "sigma", "s_rho", "deptht", "depthu", "depthv", "altitude",
    "isobaric", "pressure", "plev",
)  # fmt: skip
WIND_HEIGHT: Final = 10.0  #: [m] height at which wind is used
CLIMATOLOGY_NAMES: Final = ("month", "season", "dayofyear", "climatology")


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


def is_time(array: Any) -> bool:
    """Return whether a one-dimensional variable holds times, decoded or not."""
    if array.ndim != 1:
        return False
    if array.dtype.kind == "M":
        return True
    return " since " in str(array.attrs.get("units", ""))


def read_times(array: Any, source: str) -> FloatArray:
    """Return times as seconds since the epoch.

    Raises
    ------
    DatasetError
        If the calendar is not the real one, a time is missing, or times do not increase.
    """
    import xarray as xr

    name = str(array.name)
    if array.dtype.kind != "M":
        bare = xr.Dataset({name: ((name,), np.asarray(array.values), dict(array.attrs))})
        try:
            array = xr.decode_cf(bare, decode_times=True)[name]
        except (ValueError, OverflowError, TypeError) as error:
            raise _time_fault(source, name, f"cannot be decoded ({error})") from error
    if array.dtype.kind != "M":
        calendar = array.attrs.get("calendar", array.encoding.get("calendar", "unknown"))
        raise _time_fault(source, name, f"uses the calendar {calendar!r}, which has no real dates")
    stamps = np.asarray(array.values).astype("datetime64[ns]")
    if np.isnat(stamps).any():
        raise _time_fault(source, name, "has missing values")
    times: FloatArray = np.round(stamps.astype(np.int64) / 1e9, 3).astype(np.float64)
    step = np.diff(times)
    if (step <= 0.0).any():
        where = int(np.flatnonzero(step <= 0.0)[0])
        fault = "stands twice" if step[where] == 0.0 else "is followed by an earlier one"
        raise _time_fault(
            source, name, f"does not increase: step {where} ({stamps[where]}) {fault}"
        )
    return times


def _time_fault(source: str, name: str, fault: str) -> DatasetError:
    return DatasetError(
        f"{source}: the time axis {name!r} {fault}.",
        "Times must be UTC dates that strictly increase.",
        "Sort the file and remove doubles (for example with xarray: ds.sortby('time')."
        "drop_duplicates('time')), or fetch it again.",
        file=source,
    )


def time_coordinate(dataset: Any, array: Any) -> Any:
    """Return the time coordinate of a variable: along one of its dimensions, or scalar, or None."""
    along = [
        dataset[n]
        for n in dataset.variables
        if dataset[n].ndim == 1 and dataset[n].dims[0] in array.dims and is_time(dataset[n])
    ]
    if along:
        return min(along, key=lambda t: _time_rank(t))
    for name in ("valid_time", "time"):
        if name in dataset.variables and dataset[name].ndim == 0:
            scalar = dataset[name].expand_dims("one_time")
            if is_time(scalar):
                return scalar
    return None


def _time_rank(array: Any) -> tuple[bool, bool, bool]:
    name = str(array.name)
    return (
        name != "valid_time",
        array.attrs.get("standard_name") not in ("time", None),
        name != str(array.dims[0]),
    )


def pick_surface(dataset: Any, array: Any, keep: frozenset[str], role: str, source: str) -> Any:
    """Reduce dimensions that are neither time nor place: one entry, or the surface level.

    Of levels the one nearest to the surface is taken; of heights of wind the one at 10 m.
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
            "Make a file with real dates, one for each month you sail in.",
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
            source, name, f"has a dimension {dim!r} that is neither time, place nor level",
            "Select one entry of it into a file first.",
        )  # fmt: skip
    if "wind" not in role:
        return surface_index(levels)
    if _is_pressure(levels):
        raise _layout_fault(
            source, name, f"is wind at levels of pressure ({levels.name}), none of them at 10 m",
            "Fetch the wind at 10 m (u10 and v10).",
        )  # fmt: skip
    return int(np.argmin(np.abs(np.asarray(levels.values, float) - WIND_HEIGHT)))


def wind_height_fault(dataset: Any, array: Any) -> str | None:
    """Return why a wind cannot be used if the file says it is not at 10 m above the sea.

    What counts is the variable's own vertical axis; without one, a single height that the
    variable names (or that GRIB gives).
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
    """Return whether a vertical axis counts in pressure."""
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


def projection_of(dataset: Any, array: Any, mapping: Mapping[str, str], source: str) -> Any:
    """Return the projection (pyproj CRS) of a variable or dataset, or None if none is stated."""
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    text = mapping.get("crs")
    try:
        if text:
            return CRS.from_user_input(text)
        for name in _grid_mappings(dataset, array):
            attributes = {
                k: (v.tolist() if isinstance(v, np.ndarray) else v)
                for k, v in dataset[name].attrs.items()
            }
            for key in ("crs_wkt", "spatial_ref", "proj4_string", "proj4", "proj4_params"):
                if attributes.get(key):
                    return CRS.from_user_input(attributes[key])
            for key in ("epsg", "EPSG", "epsg_code", "EPSG_code"):
                if attributes.get(key):
                    code = str(attributes[key]).upper().removeprefix("EPSG:")
                    return CRS.from_epsg(int(code))
            if attributes.get("grid_mapping_name"):
                return CRS.from_cf(attributes)
        for key in ("crs", "projection", "epsg"):
            if dataset.attrs.get(key):
                return CRS.from_user_input(str(dataset.attrs[key]))
    except (CRSError, ValueError, KeyError) as error:
        raise DatasetError(
            f"{source}: its projection cannot be understood ({error}).",
            "An EPSG code, WKT, PROJ text or CF grid mapping is read.",
            "Give it with mapping={'crs': 'EPSG:...'} (on the command line --map crs=EPSG:...).",
            file=source,
        ) from error
    return None


def _grid_mappings(dataset: Any, array: Any) -> list[str]:
    named = array.attrs.get("grid_mapping") or array.encoding.get("grid_mapping")
    names = [str(named)] if named else []
    names += [
        str(n)
        for n in dataset.variables
        if "grid_mapping_name" in dataset[n].attrs
        or str(n) in ("projected_coordinate_system", "wgs84")
    ]
    return [n for n in names if n in dataset.variables]


def to_degrees(
    crs: Any, x: NDArray[np.float64], y: NDArray[np.float64]
) -> tuple[FloatArray, FloatArray]:
    """Return lat and lon [deg] of projected positions [m]."""
    from pyproj import Transformer

    known = np.isfinite(x) & np.isfinite(y)
    lat, lon = np.full(x.shape, np.nan), np.full(x.shape, np.nan)
    transformer = Transformer.from_crs(crs, 4326, always_xy=True)
    lon[known], lat[known] = transformer.transform(x[known], y[known])
    lat[~np.isfinite(lat)] = np.nan
    return lat, lon


def meridian_angle(crs: Any, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the angle [rad] from true east, counter-clockwise, of the x axis of a projection."""
    lat, lon = to_degrees(crs, x, y)
    lat2, lon2 = to_degrees(crs, x + 100.0, y)
    return np.arctan2(lat2 - lat, ((lon2 - lon + 180.0) % 360.0 - 180.0) * np.cos(np.radians(lat)))


def grid_angle(lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return the angle [rad] from true east, counter-clockwise, in which columns of a grid run.

    From the positions of the neighbouring columns, as a vector in space: right at the
    antimeridian and near the poles.
    """
    a, o = np.radians(lat), np.radians(lon)
    place = np.stack([np.cos(a) * np.cos(o), np.cos(a) * np.sin(o), np.sin(a)])
    along = np.empty_like(place)
    along[:, :, 1:-1] = place[:, :, 2:] - place[:, :, :-2]
    along[:, :, 0] = place[:, :, 1] - place[:, :, 0]
    along[:, :, -1] = place[:, :, -1] - place[:, :, -2]
    east = np.stack([-np.sin(o), np.cos(o), np.zeros_like(a)])
    north = np.stack([-np.sin(a) * np.cos(o), -np.sin(a) * np.sin(o), np.cos(a)])
    return np.asarray(np.arctan2((along * north).sum(axis=0), (along * east).sum(axis=0)))
