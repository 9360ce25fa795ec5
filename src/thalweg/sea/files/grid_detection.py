"""Detect the grid of a variable from its coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray, IntArray
from thalweg.sea.files import coordinates as co
from thalweg.sea.files import projections
from thalweg.sea.files.ugrid import MeshLayout
from thalweg.sea.grids.grid_protocol import Grid
from thalweg.sea.grids.rectilinear_grid import RectilinearGrid
from thalweg.sea.grids.triangle_grid import curvilinear_grid

NEMO_U_COORDINATES = ("glamu", "gphiu")


@dataclass(frozen=True, eq=False)
class GridPlacement:
    """The grid of a variable and the order of its dimensions.

    Attributes
    ----------
    key : Equal for variables on the same grid.
    dims : Dimensions of position, rows first.
    angle : Angle [rad] from true east to the direction of increasing column number (rows, columns);
        None if that is east.
    order : Columns of the file from west to east; None if they are stored in this order.
    mesh : For meshes, how values belong to grid points.
    """

    key: tuple[str, ...]
    grid: Grid
    dims: tuple[str, ...]
    angle: FloatArray | None = None
    order: slice | IntArray | None = None
    mesh: MeshLayout | None = None


def grid_placement(
    dataset: Any, array: Any, mapping: Mapping[str, str], source: str, meshes: list[MeshLayout]
) -> GridPlacement:
    """Return the grid of a variable.

    Parameters
    ----------
    dataset, array : The file and one of its variables.
    mapping : Given by the user; its key "crs" names the projection.
    source : File name for messages.
    meshes : Meshes of the file.

    Raises
    ------
    DatasetError : If its positions are not those of a grid or mesh; the message gives the reason.
    """
    for mesh in meshes:
        if mesh.dim in array.dims:
            return GridPlacement(mesh.key, mesh.grid, (mesh.dim,), mesh.angle, mesh=mesh)
    lat = _find_coordinate(dataset, array, co.is_latitude, co.LATITUDE_NAMES)
    lon = _find_coordinate(dataset, array, co.is_longitude, co.LONGITUDE_NAMES)
    if lat is None or lon is None:
        return _projected_placement(dataset, array, mapping, source)
    if lat.ndim == 2 and lon.ndim == 2 and lat.dims == lon.dims:
        return _curvilinear_placement(dataset, lat, lon)
    if lat.ndim == 1 and lon.ndim == 1 and lat.dims != lon.dims:
        return _rectilinear_grid(lat, lon, source)
    raise _no_field_error(array, source, "is given at single points, and no mesh connects them")


def _find_coordinate(dataset: Any, array: Any, test: Any, order: tuple[str, ...]) -> Any:
    """Return the latitude or longitude with a variable's dimensions; T points have priority."""
    fitting = [
        dataset[n]
        for n in dataset.variables
        if 1 <= dataset[n].ndim <= 2
        and set(dataset[n].dims) <= set(array.dims)
        and test(dataset[n], str(n))
    ]
    return min(fitting, key=lambda a: _coordinate_rank(a, order), default=None)


def _coordinate_rank(array: Any, order: tuple[str, ...]) -> tuple[int, int]:
    name = str(array.name).lower()
    return -array.ndim, order.index(name) if name in order else 3


def _rectilinear_grid(lat: Any, lon: Any, source: str) -> GridPlacement:
    y = _read_axis(lat, source, "latitude")
    stored = _read_axis(lon, source, "longitude")
    x = np.unwrap(stored, period=360.0)
    co.check_no_radians(y, x, source)
    if np.abs(y).max() > 90.0 + 1e-6:
        raise _axis_fault(source, str(lat.name), f"reaches {y[np.argmax(np.abs(y))]:g} degrees")
    order = _west_to_east(stored, x)
    x = x if order is None else x[order]
    for axis, name in ((np.sort(y) if _is_decreasing(y) else y, lat.name), (x, lon.name)):
        if (np.diff(axis) <= 0.0).any():
            raise _axis_fault(source, str(name), "neither increases nor decreases throughout")
    grid = RectilinearGrid(np.ascontiguousarray(y), np.ascontiguousarray(x))
    dims = (str(lat.dims[0]), str(lon.dims[0]))
    return GridPlacement((*dims, str(lat.name), str(lon.name)), grid, dims, order=order)


def _west_to_east(stored: FloatArray, unwrapped: FloatArray) -> slice | IntArray | None:
    """Return the order of columns from west to east; None if they need no other order.

    A box over Greenwich cut from a file of 0 to 360 degrees may hold 0 to 12 and then 350 to 359.5:
    it is sorted if its two parts meet.
    """
    if _is_decreasing(unwrapped):
        return slice(None, None, -1)
    order = np.argsort(unwrapped, kind="stable")
    steps = np.diff(unwrapped[order])
    is_monotonic = bool((np.diff(stored) > 0.0).all()) or _is_decreasing(stored)
    is_cut = is_monotonic and bool((np.diff(unwrapped) < 0.0).any())
    return order if is_cut and steps.max() < 2.0 * np.median(steps) else None


def _is_decreasing(axis: FloatArray) -> bool:
    return bool((np.diff(axis) < 0.0).all())


def _read_axis(array: Any, source: str, what: str) -> FloatArray:
    values = co.in_degrees(array)
    if not np.isfinite(values).all():
        raise _axis_fault(source, str(array.name), f"has a missing {what}")
    return values


def _axis_fault(source: str, name: str, fault: str) -> DatasetError:
    return DatasetError(
        f"{source}: the axis {name!r} {fault}.",
        "Latitudes must be within -90 and 90 degrees, and axes must be monotonic.",
        "Correct the axis in the file.",
        file=source,
        variable=name,
    )


def _curvilinear_placement(dataset: Any, lat: Any, lon: Any) -> GridPlacement:
    y, x = co.in_degrees(lat), co.in_degrees(lon)
    dims = (str(lat.dims[0]), str(lat.dims[1]))
    key = (*dims, str(lat.name), str(lon.name))
    rows, columns = y[:, 0], np.unwrap(x[0], period=360.0)
    is_plain = np.array_equal(y, np.broadcast_to(rows[:, None], y.shape)) and np.array_equal(
        x, np.broadcast_to(x[0], x.shape)
    )
    rising = is_plain and (np.diff(columns) > 0.0).all()
    if rising and ((np.diff(rows) > 0.0).all() or _is_decreasing(rows)):
        return GridPlacement(key, RectilinearGrid(rows.copy(), columns), dims)
    angle = projections.grid_angle(y, x)
    if _runs_backwards(dataset, dims[1]):
        angle = angle + np.pi
    return GridPlacement(key, curvilinear_grid(y, x), dims, angle)


def _runs_backwards(dataset: Any, dim: str) -> bool:
    """Return whether the projected x coordinate decreases along its dimension."""
    if dim not in dataset.variables or dataset[dim].size < 2:
        return False
    first = np.asarray(dataset[dim].values[:2], float)
    return bool(first[1] < first[0])


def _projected_placement(
    dataset: Any, array: Any, mapping: Mapping[str, str], source: str
) -> GridPlacement:
    """Return the grid of a variable that has only projected x and y axes."""
    axes = {}
    for name in dataset.variables:
        axis = dataset[name]
        standard = str(axis.attrs.get("standard_name", ""))
        if axis.ndim == 1 and axis.dims[0] in array.dims and standard.startswith("projection_"):
            axes[standard[11]] = axis
    if len(axes) < 2:
        raise _no_field_error(array, source, "has no positions: no latitude and longitude along it")
    crs = projections.projection_of(dataset, array, mapping, source)
    if crs is None:
        raise projections.no_projection_error(source)
    scale = [1000.0 if axes[k].attrs.get("units") == "km" else 1.0 for k in "xy"]
    x, y = np.meshgrid(
        np.asarray(axes["x"].values, float) * scale[0],
        np.asarray(axes["y"].values, float) * scale[1],
    )
    lat, lon = projections.to_degrees(crs, x, y)
    dims = (str(axes["y"].dims[0]), str(axes["x"].dims[0]))
    return GridPlacement(
        dims, curvilinear_grid(lat, lon), dims, projections.meridian_angle(crs, x, y)
    )


def _no_field_error(array: Any, source: str, fault: str) -> DatasetError:
    return DatasetError(
        f"{source}: {array.name!r} {fault} (dimensions {', '.join(map(str, array.dims))}).",
        "A sea needs fields on a grid or mesh; series at buoys or along lines cannot be used.",
        "Give a gridded file, a mesh with its face_node_connectivity, or wrap the series in "
        "Sea.from_functions.",
        file=source,
        variable=str(array.name),
    )
