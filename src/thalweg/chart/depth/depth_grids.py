"""Depth from files: finding the variable and its sign, and reading parts of it when needed."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike
from typing import Any, Final

import numpy as np

from thalweg.core.errors import DatasetError, InputError
from thalweg.core.geodesy import wrap_longitude
from thalweg.core.types import Float32Array, FloatArray
from thalweg.sea.plausible_values import (
    DEPTH_FILLS,
    holds_any,
    unmarked_fill,
    unmarked_fill_error,
)

DepthFunction = Callable[[FloatArray, FloatArray], Any]

#: names (standard names or variable names) of heights, positive up, and of depths, positive down
HEIGHT_NAMES: Final = frozenset(
    (
        *("height", "altitude", "elevation", "z", "bed", "topo", "topography", "band1"),
        *("bed_level", "surface_altitude", "bedrock_altitude", "sea_floor_altitude"),
        *("height_above_mean_sea_level", "height_above_geoid", "height_above_geopotential_datum"),
        "height_above_reference_ellipsoid",
    )
)
DEPTH_NAMES: Final = frozenset(
    (
        *("depth", "deptho", "depths", "bathymetry", "bathy", "water_depth", "bed_depth"),
        *("sea_floor_depth", "sea_floor_depth_below_geoid", "sea_floor_depth_below_sea_surface"),
        "sea_floor_depth_below_mean_sea_level",
        "sea_floor_depth_below_reference_ellipsoid",
        "sea_floor_depth_below_geopotential_datum",
        "model_sea_floor_depth_below_geoid",
    )
)
_AROUND: Final = 50  # rows and columns around a sounding that are read to judge it
MAX_HEIGHT, MAX_DEPTH = 9_500.0, 12_000.0  # [m] largest plausible height and depth
UNIT_FACTORS: Final = {
    "m": 1.0,
    "meter": 1.0,
    "metre": 1.0,
    "": 1.0,
    "km": 1000.0,
    "cm": 0.01,
    "ft": 0.3048,
}


@dataclass(frozen=True)
class DepthGrid:
    """Depth on latitudes and longitudes [deg], both ascending; read when needed."""

    name: str
    lat: FloatArray
    lon: FloatArray
    read: Callable[[slice, slice], Float32Array]

    def fingerprint(self) -> str:
        """Return a digest of the name, the axes and about 10,000 of the soundings."""
        digest = hashlib.sha256(self.name.encode())
        tall, wide = (max(len(axis) // 100, 1) for axis in (self.lat, self.lon))
        sample = self.read(slice(None, None, tall), slice(None, None, wide))
        for array in (self.lat, self.lon, sample):
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()[:16]

    def window(
        self, south: float, north: float, west: float, east: float
    ) -> tuple[tuple[float, float, float, float], Float32Array] | None:
        """Return the regular grid over a box (east may exceed 360), one step wider."""
        step = (self.lat[-1] - self.lat[0]) / (len(self.lat) - 1)
        wide = (self.lon[-1] - self.lon[0]) / (len(self.lon) - 1)
        around = (len(self.lon) + 0.5) * wide > 360.0
        j0 = max(int(np.searchsorted(self.lat, south - step)) - 1, 0)
        j1 = min(int(np.searchsorted(self.lat, north + step)) + 1, len(self.lat))
        turns = [0.0] if around and east - west >= 360.0 else [360.0 * t for t in (-2, -1, 0, 1, 2)]
        ranges = []
        for turn in turns:
            i0 = max(int(np.searchsorted(self.lon + turn, west - wide)) - 1, 0)
            i1 = min(int(np.searchsorted(self.lon + turn, east + wide)) + 1, len(self.lon))
            if len(turns) == 1:
                i0, i1 = 0, len(self.lon)
            reaches = i0 < i1 and self.lon[i0] + turn <= east + wide
            if reaches and self.lon[i1 - 1] + turn >= west - wide:
                ranges.append((i0, i1, turn))
        if j1 - j0 < 2 or not ranges:
            return None
        if around and (len(ranges) > 1 or len(turns) == 1):
            return self._whole_circle(j0, j1)
        i0, i1, _ = max(ranges, key=lambda r: r[1] - r[0])
        if i1 - i0 < 2:
            return None
        values = self.read(slice(j0, j1), slice(i0, i1))
        return _on_equal_steps(self.lat[j0:j1], self.lon[i0:i1], values)

    def _whole_circle(
        self, j0: int, j1: int
    ) -> tuple[tuple[float, float, float, float], Float32Array]:
        """Return whole circles of latitude, the first meridian repeated at the end."""
        values = self.read(slice(j0, j1), slice(0, len(self.lon)))
        values = np.concatenate([values, values[:, :1]], 1)
        lon = np.append(self.lon, self.lon[0] + 360.0)
        return _on_equal_steps(self.lat[j0:j1], lon, values)


@dataclass(frozen=True)
class DepthFunctionLayer:
    """Depth from a function of (lat, lon) [deg]; sampled on a grid for legs."""

    name: str
    function: DepthFunction
    spacing_deg: float | None = None

    def fingerprint(self) -> str:
        """Return the function's name and spacing: its results are not part of it."""
        where = getattr(self.function, "__module__", "")
        return f"{where}.{self.name} {self.spacing_deg}"

    def at(self, lat: FloatArray, lon: FloatArray) -> FloatArray:
        """Return the depth [m] the function gives."""
        found = np.asarray(self.function(lat, lon), float)
        return np.array(np.broadcast_to(found, np.broadcast(lat, lon).shape))

    def window(
        self, south: float, north: float, west: float, east: float
    ) -> tuple[tuple[float, float, float, float], Float32Array] | None:
        """Return the function on a grid over a box: ``spacing_deg``, or 1/1000 of the box."""
        step = self.spacing_deg or max(north - south, east - west) / 1000.0
        lat = np.arange(south - step, north + 2.0 * step, step)
        lon = np.arange(west - step, east + 2.0 * step, step)
        wrapped = wrap_longitude(lon)
        y, x = np.meshgrid(np.clip(lat, -90.0, 90.0), wrapped, indexing="ij")
        return (lat[0], step, lon[0], step), self.at(y, x).astype(np.float32)


def _on_equal_steps(
    lat: FloatArray, lon: FloatArray, values: Float32Array
) -> tuple[tuple[float, float, float, float], Float32Array]:
    """Return values on equal steps; uneven grids are put on their finest step by least sounding."""
    grids = []
    for axis, line in enumerate((lat, lon)):
        steps = np.diff(line)
        step = (line[-1] - line[0]) / len(steps)
        if np.abs(steps - step).max() > 1e-3 * step:
            count = int(np.ceil((line[-1] - line[0]) / steps.min())) + 1
            even = np.linspace(line[0], line[-1], count)
            low = np.clip(np.searchsorted(line, even, "right") - 1, 0, len(line) - 2)
            on = np.isclose(even, line[low], rtol=0, atol=1e-9)
            below, above = values.take(low, axis), values.take(np.where(on, low, low + 1), axis)
            values = np.minimum(below, above)
            step = even[1] - even[0]
        grids += [float(line[0]), float(step)]
    return (grids[0], grids[1], grids[2], grids[3]), values


def make_depth_layer(
    source: Any, *, variable: str | None, positive: str | None, spacing_deg: float | None
) -> DepthGrid | DepthFunctionLayer:
    """Return the depth layer of a file, an xarray object or a function of (lat, lon).

    Raises
    ------
    InputError, DatasetError
        If the file does not exist, or the variable, its sign, its units or its grid is unclear.
    """
    if callable(source):
        return DepthFunctionLayer(getattr(source, "__name__", "function"), source, spacing_deg)
    if positive not in (None, "up", "down"):
        raise InputError(
            f"positive={positive!r} is not a direction.",
            "It is 'up' or 'down' (elevations or depths).",
            "Give one of these.",
        )
    name, data = open_grid_source(source, "Depth")
    array = _select_depth_variable(data, variable, name)
    scale = _depth_sign(array, positive, name) * _unit_factor(array, name)
    lat_name, lon_name = horizontal_axes(array)
    array = array.squeeze(drop=True).transpose(lat_name, lon_name)
    lat, lon = np.asarray(array[lat_name], float), np.asarray(array[lon_name], float)
    for axis, line in ((lat_name, lat), (lon_name, lon)):
        steps = np.diff(line)
        if len(line) < 2 or not ((steps > 0).all() or (steps < 0).all()):
            raise DatasetError(
                f"The axis {axis!r} of the depth in {name} is not in order.",
                "Latitudes and longitudes must increase or decrease throughout, two or more.",
                "Sort the file, or use another.",
                file=name,
            )
    if lat[0] > lat[-1]:
        array, lat = array.isel({lat_name: slice(None, None, -1)}), lat[::-1].copy()
    if lon[0] > lon[-1]:
        array, lon = array.isel({lon_name: slice(None, None, -1)}), lon[::-1].copy()

    def read(rows: slice, columns: slice) -> Float32Array:
        part = array.isel({lat_name: rows, lon_name: columns}).values
        if holds_any(part, DEPTH_FILLS):
            around = {lat_name: _widened(rows, len(lat)), lon_name: _widened(columns, len(lon))}
            _check_fills(array.isel(around).values, name)
        depth = np.asarray(part, np.float32) * np.float32(scale)
        _check_plausible(depth, name)
        return depth

    return DepthGrid(name, lat, lon, read)


def _widened(part: slice, size: int) -> slice:
    """Return a range of rows or columns with `_AROUND` more on either side."""
    first, last, step = part.indices(size)
    return slice(max(first - _AROUND, 0), min(last + _AROUND, size), step)


def _check_fills(part: Any, name: str) -> None:
    """Raise for numbers that stand for missing values, in the unit and sign of the file."""
    fill = unmarked_fill(np.asarray(part), DEPTH_FILLS)
    if fill is not None:
        raise unmarked_fill_error(name, "the depth", "depth", fill)


def _check_plausible(depth: Float32Array, name: str) -> None:
    """Raise for impossible depths: unmarked missing values would count as deep water."""
    odd = depth[(depth < -MAX_HEIGHT) | (depth > MAX_DEPTH)]
    if odd.size:
        raise DatasetError(
            f"The depth in {name} reaches {odd[0]:g} m.",
            f"Depths between {-MAX_HEIGHT:g} and {MAX_DEPTH:g} m are plausible: wrong units, or "
            "missing values that are not marked?",
            "Correct the file's units or _FillValue.",
            file=name,
        )


def open_grid_source(source: Any, what: str) -> tuple[str, Any]:
    """Return the name and the dataset of a file or an xarray object; ``what`` names its contents.

    Raises
    ------
    InputError
        If it is neither.
    """
    import xarray as xr

    from thalweg.sea.files.file_opener import open_file

    if isinstance(source, xr.DataArray):
        return "the array", source.to_dataset(name=source.name or "depth")
    if isinstance(source, xr.Dataset):
        return "the dataset", source
    if not isinstance(source, (str, PathLike)):
        raise InputError(
            f"{what} cannot be read from {type(source).__name__!r}.",
            "It comes from a file, an xarray object or a function of (lat, lon).",
            "Give one of these.",
        )
    parts = [file.dataset for file in open_file(source)]
    return str(source), parts[0] if len(parts) == 1 else xr.merge(parts, compat="override")


def horizontal_axes(array: Any) -> tuple[str, str]:
    """Return the names of the axes of latitude and longitude; empty where there is none."""
    found: dict[str, str] = {}
    for name in array.dims:
        if array.sizes[name] > 1 and name in array.coords:
            axis = array.coords[name]
            words = {str(name).casefold(), str(axis.attrs.get("standard_name", "")).casefold()}
            units = str(axis.attrs.get("units", ""))
            if words & {"lat", "latitude", "y"} or units.startswith("degrees_n"):
                found["lat"] = name
            elif words & {"lon", "longitude", "x"} or units.startswith("degrees_e"):
                found["lon"] = name
    return found.get("lat", ""), found.get("lon", "")


def _select_depth_variable(data: Any, variable: str | None, name: str) -> Any:
    gridded = []
    for key in data.data_vars:
        wide = [d for d in data[key].dims if data[key].sizes[d] > 1]
        if len(wide) == 2 and all(horizontal_axes(data[key])):
            gridded.append(str(key))
    if variable is not None:
        known = [variable] if variable in gridded else []
    else:
        known = [k for k in gridded if _variable_names(data[k]) & (HEIGHT_NAMES | DEPTH_NAMES)]
        known = known or (gridded if len(gridded) == 1 else [])
    if len(known) == 1:
        return data[known[0]]
    if not gridded:
        raise DatasetError(
            f"{name} holds no field on an axis of latitude and one of longitude.",
            "Depth is read from such grids (GEBCO, ETOPO, EMODnet, ...); a model's mesh or turned "
            "grid is given as the sea, with its bed.",
            "Give another file, or give this one as the sea.",
            file=name,
        )
    raise DatasetError(
        f"It is not clear which variable of {name} is the depth."
        if variable is None
        else f"{name} has no gridded variable {variable!r}.",
        f"On latitude and longitude it has: {', '.join(known or gridded)}.",
        "Name it: with_depth(..., variable='...').",
        file=name,
        near=known or gridded,
    )


def _variable_names(array: Any) -> set[str]:
    standard = str(array.attrs.get("standard_name", "")).casefold()
    return {str(array.name).casefold(), standard}


def _depth_sign(array: Any, positive: str | None, name: str) -> float:
    given = positive or str(array.attrs.get("positive", "")).casefold()
    if given in ("up", "down"):
        return -1.0 if given == "up" else 1.0
    standard = str(array.attrs.get("standard_name", "")).casefold()
    for word in (standard, str(array.name).casefold()):
        if word in HEIGHT_NAMES:
            return -1.0
        if word in DEPTH_NAMES:
            return 1.0
    raise DatasetError(
        f"It is not clear whether {array.name!r} of {name} is positive up or down.",
        "Its name, standard_name and attribute 'positive' do not state it.",
        "State it: with_depth(..., positive='up') for elevation, 'down' for depth.",
        file=name,
    )


def _unit_factor(array: Any, name: str) -> float:
    unit = str(array.attrs.get("units", "")).casefold().strip().removesuffix("s")
    if unit not in UNIT_FACTORS:
        raise DatasetError(
            f"The depth in {name} has the unit {unit!r}.",
            "Known units: " + ", ".join(u for u in UNIT_FACTORS if u) + ".",
            "Convert it to metres.",
            file=name,
        )
    return UNIT_FACTORS[unit]
