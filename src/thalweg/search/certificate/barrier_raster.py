"""The sea on a raster for barrier functions: on the lines of the data where that is possible."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.kernels.codes import CHANNEL_COUNT, CURRENT_EAST, CURRENT_NORTH, SPEED_FIELD
from thalweg.kernels.leg.raster_sampling import RasterArrays
from thalweg.route.evaluators.time_evaluator import raster_arrays
from thalweg.sea.frozen_fields import GridFields
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.rectilinear_grid import RectilinearGrid
from thalweg.sea.models.function_layer import FormulaLayer
from thalweg.sea.models.lipschitz_bounds import greatest_spacing, margins_of_samples
from thalweg.sea.standard_names import (
    CHANNEL_VARIABLES,
    EASTWARD_CURRENT,
    EASTWARD_WIND,
    NORTHWARD_CURRENT,
    NORTHWARD_WIND,
    WAVE_HEIGHT,
)

if TYPE_CHECKING:
    from thalweg.sea import Sea
    from thalweg.sea.freeze import DerivedChannel

_MOST_VALUES = 60_000_000
_MOST_CELLS = 400_000
_LINE_TOLERANCE = 1e-4  # of the spacing
#: Variables that change the speed of a ship over ground.
_MOVING = (EASTWARD_CURRENT, NORTHWARD_CURRENT, EASTWARD_WIND, NORTHWARD_WIND, WAVE_HEIGHT)


@dataclass(frozen=True)
class BarrierRaster:
    """The sea on a raster.

    Attributes
    ----------
    arrays : Times since departure [s].
    sampling : "" where the raster has the values and the interpolation of the data; otherwise a
        note on how it differs.
    margins : By how much the sea may differ from the raster, by channel (`margins_of_samples`).
    """

    arrays: RasterArrays
    sampling: str
    margins: FloatArray


@dataclass(frozen=True)
class RasterRequest:
    """What is to be frozen.

    Attributes
    ----------
    box : South, north, west and east [deg]; east above west, without jump.
    period : [s since 1970-01-01T00:00Z].
    cells : Number of cells wanted along the longer side where the data are no finer.
    speed_field : Speed through water as a field of the sea.
    """

    sea: Sea
    channels: Sequence[int]
    box: tuple[float, float, float, float]
    period: tuple[float, float]
    cells: int
    speed_field: DerivedChannel | None = None


def freeze_barrier_raster(request: RasterRequest) -> BarrierRaster:
    """Freeze the sea in a box."""
    south, north, west, east = request.box
    width, height = east - west, north - south
    instants = max(len(request.sea.times(*request.period)), 2)
    numbers = max(len(request.channels), 1) * instants
    wanted = max(width, height) / request.cells
    least = math.sqrt(width * height / min(_MOST_VALUES / numbers, _MOST_CELLS))
    lines, notes = _data_lines(request.sea), []
    if lines is None:
        spacing = max(wanted, least)
        if any(not _is_uniform(layer) for layer in request.sea.layers):
            notes.append(f"the sea sampled every {spacing:.3g} degrees")
    else:
        first_lat, first_lon, spacing = lines
        skipped = math.ceil(least / spacing - 1e-9)
        if skipped > 1:
            notes.append(f"every {skipped} lines of the data")
            spacing *= skipped
        if not _all_on_lines(request.sea, first_lat, first_lon, spacing):
            notes.append(f"the sea sampled every {spacing:.3g} degrees")
        south = first_lat + spacing * math.floor((south - first_lat) / spacing)
        west = first_lon + spacing * math.floor((west - first_lon) / spacing)
        north = south + spacing * math.ceil((north - south) / spacing - 1e-9)
        east = west + spacing * math.ceil((east - west) / spacing - 1e-9)
    extra = None if request.speed_field is None else {SPEED_FIELD: request.speed_field}
    if extra is not None:
        notes.append("with the speed of the ship linear between these places")
    fields = request.sea.freeze_grid(
        south, min(north, 89.9), west, east, *request.period, request.channels,
        spacing_deg=spacing, extra=extra,
    )  # fmt: skip
    if any(_changes_between_samples(layer) for layer in request.sea.layers):
        step = np.diff(fields.times).max() if fields.times.size > 1 else 0.0
        if lines is None and step > 0.0:
            notes.append(f"and every {step / 60.0:.0f} minutes")
    if _layers_overlap(request):
        notes.append("a sea of overlapping files joined at the points of the finest")
    margins = _margins(request, fields)
    if margins is None:
        margins = np.zeros(CHANNEL_COUNT)
    elif notes:
        notes.append("and between samples by the Lipschitz bounds of its functions")
    return BarrierRaster(_arrays(fields, request.period[0]), ", ".join(notes), margins)


def greatest_value(raster: RasterArrays, channel: int) -> float:
    """Return the greatest value of a channel that is not negative; 0 where none is known."""
    return _greatest(raster.values[..., raster.channel_index[channel]])


def strongest_current_of_raster(raster: RasterArrays, margins: FloatArray) -> float:
    """Return the strongest current [m/s] that a raster and its margins allow; 0 without any."""
    east, north = raster.channel_index[CURRENT_EAST], raster.channel_index[CURRENT_NORTH]
    if east < 0 or north < 0:
        return 0.0
    size = np.hypot(raster.values[..., east], raster.values[..., north])
    return _greatest(size) + float(margins[CURRENT_EAST])


def _greatest(values: FloatArray) -> float:
    return float(np.nanmax(values, initial=0.0)) if np.isfinite(values).any() else 0.0


def _layers_overlap(request: RasterRequest) -> bool:
    """Return whether two layers that are not uniform give the same variable."""
    names = {CHANNEL_VARIABLES[channel] for channel in request.channels}
    given = [layer.variables & names for layer in request.sea.layers if not _is_uniform(layer)]
    return sum(map(len, given)) > len(set().union(*given))


def _changes_between_samples(layer: Any) -> bool:
    """Return whether a layer has no times of its own and is not the same everywhere or always."""
    steady = getattr(layer, "time_step", None) == 0.0
    return layer.period is None and not steady and not _is_uniform(layer)


def _margins(request: RasterRequest, fields: GridFields) -> FloatArray | None:
    """Return by how much the sea may differ from its samples; None where that is not known."""
    if request.speed_field is not None:
        return None
    rows = fields.values.shape[1]
    lat: FloatArray = fields.lat0 + fields.dlat * np.arange(rows, dtype=np.float64)
    present = np.flatnonzero(fields.channel_index >= 0)
    channels = present[np.argsort(fields.channel_index[present])].tolist()
    spacing = greatest_spacing(lat, fields.dlat, fields.dlon, fields.times)
    return margins_of_samples(request.sea.layers, channels, fields.values, spacing)


def _arrays(fields: GridFields, origin: float) -> RasterArrays:
    """Return a raster as kernels take it, with two times at least."""
    arrays = raster_arrays(fields, origin)
    if arrays.times.size > 1:
        return arrays
    times = np.array([arrays.times[0], arrays.times[0] + 1.0])
    return arrays._replace(times=times, values=np.repeat(arrays.values, 2, axis=0))


def _is_uniform(layer: object) -> bool:
    """Return whether a layer has the same values everywhere."""
    return isinstance(layer, FormulaLayer) and "values" in layer.facts


def is_uniform(sea: Sea) -> bool:
    """Return whether a sea has the same values everywhere."""
    return all(_is_uniform(layer) for layer in sea.layers)


def is_calm(sea: Sea) -> bool:
    """Return whether there are no currents, wind and waves anywhere."""
    return is_uniform(sea) and not any(
        layer.facts["values"].get(name, 0.0)
        for layer in sea.layers
        if isinstance(layer, FormulaLayer)
        for name in _MOVING
    )


def _data_lines(sea: Sea) -> tuple[float, float, float] | None:
    """Return (latitude, longitude, spacing) [deg] of the lines of the finest regular grid."""
    found: list[tuple[float, float, float]] = []
    for layer in sea.layers:
        if not isinstance(layer, GridLayer) or not isinstance(layer.grid, RectilinearGrid):
            continue
        spacing = _even_spacing(layer.grid)
        if spacing is not None:
            found.append((float(layer.grid.lat.min()), float(layer.grid.lon[0]), spacing))
    return min(found, key=lambda row: row[2]) if found else None


def _even_spacing(grid: RectilinearGrid) -> float | None:
    """Return the spacing [deg] of a grid with even and equal steps both ways, else None."""
    if grid.lat.size < 2 or grid.lon.size < 2:
        return None
    steps: FloatArray = np.concatenate([np.abs(np.diff(grid.lat)), np.diff(grid.lon)])
    middle = float(np.median(steps))
    return middle if np.abs(steps - middle).max() < 1e-3 * middle else None


def _all_on_lines(sea: Sea, lat: float, lon: float, spacing: float) -> bool:
    """Return whether the lines of every layer are among lines of one grid."""
    for layer in sea.layers:
        if _is_uniform(layer):
            continue
        if not isinstance(layer, GridLayer) or not isinstance(layer.grid, RectilinearGrid):
            return False
        for axis, start in ((layer.grid.lat, lat), (layer.grid.lon, lon)):
            place = (axis - start) / spacing
            if np.abs(place - np.round(place)).max() > max(_LINE_TOLERANCE, 1e-3):
                return False
    return True
