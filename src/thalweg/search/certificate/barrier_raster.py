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
from thalweg.search.certificate.data_deviation import margins_of_data

if TYPE_CHECKING:
    from thalweg.sea import Sea
    from thalweg.sea.freeze import DerivedChannel

_MOST_VALUES = 60_000_000
_MOST_CELLS = 400_000
_LINE_TOLERANCE = 1.6e-5  # [deg]: a line of the raster so far beyond the last of data is in them
_LONGEST_CELL = 3.0  # sides of a cell [deg]: columns or rows are divided if one is longer
_MUCH_FINER = 0.5  # of a spacing
#: Variables that change the speed of a ship over ground.
_MOVING = (EASTWARD_CURRENT, NORTHWARD_CURRENT, EASTWARD_WIND, NORTHWARD_WIND, WAVE_HEIGHT)


@dataclass(frozen=True)
class BarrierRaster:
    """The sea on a raster.

    Attributes
    ----------
    arrays : Times since departure [s].
    sampling : "" where the raster and its margins hold for the data as they are interpolated;
        otherwise a note on how it differs from them.
    margins : float64[Y - 1, X - 1, CHANNELS]
        By how much the sea may differ from the raster in each cell, by channel
        (`margins_of_samples`, `margins_of_data`); (1, 1, CHANNELS) where that is the same in all.
    strongest_current : No current is stronger [m/s]; 0 without currents.
    """

    arrays: RasterArrays
    sampling: str
    margins: FloatArray
    strongest_current: float


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
    most_cells = min(_MOST_VALUES / numbers, _MOST_CELLS)
    wanted = max(width, height) / request.cells
    layers = [layer for layer in request.sea.layers if not _is_uniform(layer)]
    lines, notes = _data_lines(layers), []
    if lines is None:
        finest = min(
            (one for layer in layers if (one := _grid_spacing(layer)) > 0.0), default=wanted
        )
        side = max(min(wanted, finest), math.sqrt(width * height / most_cells))
        spacing = side, side
        if layers:
            notes.append(f"the sea sampled every {side:.3g} degrees")
    else:
        spacing = _spacing_of_raster(lines, (height, width), most_cells)
        skipped = [round(wide / own) for wide, own in zip(spacing, lines[2:])]
        if max(skipped) > 1:
            notes.append(f"every {max(skipped)} lines of the data")
        if not _all_on_lines(layers, lines[:2], spacing):
            notes.append(f"the sea sampled every {max(spacing):.3g} degrees")
        south = lines[0] + spacing[0] * math.floor((south - lines[0]) / spacing[0])
        west = lines[1] + spacing[1] * math.floor((west - lines[1]) / spacing[1])
        north = south + spacing[0] * math.ceil((north - south) / spacing[0] - 1e-9)
        east = west + spacing[1] * math.ceil((east - west) / spacing[1] - 1e-9)
    extra = None if request.speed_field is None else {SPEED_FIELD: request.speed_field}
    if extra is not None:
        notes.append("with the speed of the ship linear between these places")
    fields = request.sea.freeze_grid(
        south, min(north, 89.9), west, east, *request.period, request.channels,
        spacing_deg=spacing, extra=extra,
    )  # fmt: skip
    if any(_changes_between_samples(layer) for layer in layers):
        step = np.diff(fields.times).max() if fields.times.size > 1 else 0.0
        if lines is None and step > 0.0:
            notes.append(f"and every {step / 60.0:.0f} minutes")
    if _layers_overlap(request):
        notes.append("a sea of overlapping files joined at the points of the finest")
    margins, strongest = _margins(request, fields), math.inf
    if margins is None and notes and request.speed_field is None:
        found = margins_of_data(request.sea.layers, fields)
        if found is not None:
            (margins, strongest), notes = found, []
    elif margins is not None and not margins.any():  # the same everywhere
        notes = []
    elif margins is not None and notes:
        notes.append("and between samples by the Lipschitz bounds of its functions")
    if margins is None:
        margins = np.zeros((1, 1, CHANNEL_COUNT))
    arrays = _arrays(fields, request.period[0])
    strongest = min(strongest, strongest_current_of_raster(arrays, margins))
    return BarrierRaster(arrays, ", ".join(notes), margins, strongest)


def _spacing_of_raster(
    lines: tuple[float, float, float, float], size: tuple[float, float], most_cells: float
) -> tuple[float, float]:
    """Return the spacing [deg] of rows and columns: multiples or parts of that of the data.

    Parameters
    ----------
    lines : First latitude and longitude, and the spacings of the data [deg].
    size : Height and width of the box [deg].
    """
    own = np.array(lines[2:])
    longest, shortest = int(np.argmax(own)), int(np.argmin(own))
    parts = np.ones(2)
    parts[longest] = max(1.0, round(own[longest] / own[shortest] / _LONGEST_CELL))
    if float(np.prod(np.array(size) / own * parts)) > most_cells:
        parts[:] = 1.0
    steps = np.ones(2)
    while float(np.prod(np.array(size) / (own * steps))) * float(np.prod(parts)) > most_cells:
        finer = int(np.argmin(own * steps))
        steps[finer] = max(steps[finer] + 1.0, math.floor(1.02 * steps[finer]))
    return float(own[0] * steps[0] / parts[0]), float(own[1] * steps[1] / parts[1])


def greatest_value(raster: RasterArrays, channel: int) -> float:
    """Return the greatest value of a channel that is not negative; 0 where none is known."""
    return _greatest(raster.values[..., raster.channel_index[channel]])


def strongest_current_of_raster(raster: RasterArrays, margins: FloatArray) -> float:
    """Return the strongest current [m/s] that a raster and its margins allow; 0 without any."""
    east, north = raster.channel_index[CURRENT_EAST], raster.channel_index[CURRENT_NORTH]
    if east < 0 or north < 0:
        return 0.0
    size = np.hypot(raster.values[..., east], raster.values[..., north])
    if margins.shape[0] == 1:
        return _greatest(size) + float(margins[0, 0, CURRENT_EAST])
    most = np.nan_to_num(np.fmax.reduce(size, axis=0))  # unknown: no ship is there
    corners = [most[:-1, :-1], most[:-1, 1:], most[1:, :-1], most[1:, 1:]]
    return _greatest(np.maximum.reduce(corners) + margins[..., CURRENT_EAST])


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
    margins = margins_of_samples(request.sea.layers, channels, fields.values, spacing)
    return None if margins is None else margins[None, None]


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


def _data_lines(layers: Sequence[Any]) -> tuple[float, float, float, float] | None:
    """Return the first latitude and longitude, and the spacings, of the finest regular grid [deg].

    None where a grid of another kind is much finer.
    """
    found: list[tuple[float, float, float, float]] = []
    for layer in layers:
        if not isinstance(layer, GridLayer) or not isinstance(layer.grid, RectilinearGrid):
            continue
        steps = _even_spacing(layer.grid.lat), _even_spacing(layer.grid.lon)
        if steps[0] is not None and steps[1] is not None:
            found.append((float(layer.grid.lat.min()), float(layer.grid.lon[0]), *steps))  # type: ignore[arg-type]
    if not found:
        return None
    lines = min(found, key=lambda row: row[2] * row[3])
    finest = min(_grid_spacing(layer) or math.inf for layer in layers)
    return lines if finest > _MUCH_FINER * min(lines[2:]) else None


def _grid_spacing(layer: Any) -> float:
    """Return the typical spacing of the grid of a layer [deg]; 0 for other layers."""
    return float(layer.grid.spacing) if isinstance(layer, GridLayer) else 0.0


def _even_spacing(axis: FloatArray) -> float | None:
    """Return the spacing [deg] of an axis with even steps, else None."""
    if axis.size < 2:
        return None
    steps: FloatArray = np.abs(np.diff(axis))
    mean = abs(float(axis[-1]) - float(axis[0])) / steps.size  # so that the last line is one, too
    return mean if np.abs(steps - mean).max() < 1e-3 * mean else None


def _all_on_lines(
    layers: Sequence[Any], first: tuple[float, float], spacing: tuple[float, float]
) -> bool:
    """Return whether the lines of every layer are among lines of one grid."""
    for layer in layers:
        if not isinstance(layer, GridLayer) or not isinstance(layer.grid, RectilinearGrid):
            return False
        for axis, start, step in zip((layer.grid.lat, layer.grid.lon), first, spacing):
            place = (np.asarray(axis, float) - start) / step
            if np.abs(place - np.round(place)).max() * step > _LINE_TOLERANCE:
                return False
    return True
