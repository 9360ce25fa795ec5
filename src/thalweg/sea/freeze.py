"""Freezing: sample the sea once, at stations or on a regular grid, for the compiled kernels."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import InputError, OutsidePeriodError
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels import codes
from thalweg.sea import standard_names as nm
from thalweg.sea.frozen_fields import GridFields, StationFields
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.layer import Layer
from thalweg.sea.layer_stack import (
    sample_stack,
    series_of_stack,
    stack_period,
    stack_provides,
    stack_times,
    stack_variables,
)

DerivedChannel: TypeAlias = Callable[
    [Mapping[str, FloatArray], FloatArray, FloatArray, FloatArray], FloatArray
]

POINTS_PER_CHUNK = 1 << 17  #: values computed at a time, so that temporaries stay small
POINTS_OF_SOME_TIMES = 1 << 20  #: the same where all stations of some times are computed


class SampledSea(Mapping[str, FloatArray]):
    """The sea at given points as a mapping; each variable is sampled at its first use."""

    def __init__(
        self, layers: Sequence[Layer], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> None:
        self._layers, self._points = layers, (time, lat, lon)
        self._done: dict[str, FloatArray] = {}

    def __getitem__(self, name: str) -> FloatArray:
        if name not in self._done:
            if not stack_provides(self._layers, name):
                raise KeyError(name)
            self._done[name] = sample_stack(self._layers, [name], *self._points)[name]
        return self._done[name]

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(stack_variables(self._layers)))

    def __len__(self) -> int:
        return len(stack_variables(self._layers))


def freeze_station_fields(
    layers: Sequence[Layer],
    lat: ArrayLike,
    lon: ArrayLike,
    start: float,
    end: float,
    channels: Sequence[int],
    *,
    extra: Mapping[int, DerivedChannel] | None = None,
) -> StationFields:
    """Return the sea at stations for kernels, at all native times of a window.

    Parameters
    ----------
    lat, lon : array_like (S,)
        Stations [deg].
    start, end : float
        Window [s since epoch]; frozen times reach one native step beyond it.
    channels : sequence of int
        Channels of `thalweg.kernels.codes`; those the sea lacks get index -1.
    extra : mapping of int to callable, optional
        Channels computed as ``f(sampled, time, lat, lon) -> array``, where ``sampled`` maps any
        variable of the sea to its values and all arrays are (stations, times).

    Returns
    -------
    StationFields
        Values (S, T, K) of the K channels present.

    Raises
    ------
    InputError
        If the window ends before it starts, a channel does not exist, or the sea is an ensemble.
    OutsidePeriodError
        If the data have no time in the window.
    """
    derived = extra or {}
    lat, lon = np.ascontiguousarray(lat, np.float64), np.ascontiguousarray(lon, np.float64)
    index, present = locate_channels(layers, channels, derived)
    times = times_to_freeze(
        layers, (float(start), float(end)), _variables(present, derived), derived
    )
    values = np.empty((lat.size, times.size, len(present)), np.float32)
    _fill_stations(values, layers, (times, lat, lon), present, derived)
    return StationFields(times, values, index)


def _fill_stations(
    values: NDArray[np.float32],
    layers: Sequence[Layer],
    points: tuple[FloatArray, FloatArray, FloatArray],
    present: Sequence[int],
    derived: Mapping[int, DerivedChannel],
) -> None:
    """Write the channels of stations into ``values`` (S, T, K), in parts that fit into memory."""
    times, lat, lon = points
    plain = _variables(present, derived)
    if any(
        layer.is_read_in_parts(layer.variables if derived else plain, times, lat, lon)
        for layer in layers
        if isinstance(layer, GridLayer)
    ):  # all stations of some times, so that each part of the files is read once
        count = max(1, POINTS_OF_SOME_TIMES // lat.size)
        for first in range(0, times.size, count):
            part = slice(first, first + count)
            _sample_stations(values[:, part], layers, (times[part], lat, lon), present, derived)
        return
    rows = max(1, POINTS_PER_CHUNK // times.size)
    for first in range(0, lat.size, rows):
        part = slice(first, first + rows)
        _sample_stations(values[part], layers, (times, lat[part], lon[part]), present, derived)


def _box_as_four_numbers(function: Callable[..., GridFields]) -> Callable[..., GridFields]:
    """Let a function take ``area`` as south, north, west and east [deg] too."""

    @functools.wraps(function)
    def accept(layers: Sequence[Layer], *args: Any, **kwargs: Any) -> GridFields:
        if not isinstance(args[0] if args else kwargs.get("area"), BoundingBox):
            by_position = args[:4]
            names = ("south", "north", "west", "east")[len(by_position) :]
            by_name = [kwargs.pop(name) for name in names if name in kwargs]
            sides = [float(side) for side in (*by_position, *by_name)]
            args = (BoundingBox(*sides), *args[4:])
        return function(layers, *args, **kwargs)

    return accept


@_box_as_four_numbers
def freeze_grid_fields(
    layers: Sequence[Layer],
    area: BoundingBox,
    start: float,
    end: float,
    channels: Sequence[int],
    *,
    spacing_deg: float | tuple[float, float],
    extra: Mapping[int, DerivedChannel] | None = None,
) -> GridFields:
    """Return the sea on a regular grid for kernels, at all native times of a window.

    Parameters
    ----------
    area : BoundingBox
        Box of the grid; ``east < west`` spans the antimeridian. Four numbers, south, north, west
        and east [deg], are accepted in its place.
    start, end : float
        Window [s since epoch]; frozen times reach one native step beyond it.
    channels : sequence of int
        Channels of `thalweg.kernels.codes`; those the sea lacks get index -1.
    spacing_deg : float or (float, float)
        Largest spacing [deg], of rows and of columns; it is reduced so that the grid ends on the
        box.
    extra : mapping of int to callable, optional
        Derived channels, as in `freeze_stations`.

    Returns
    -------
    GridFields
        Values (T, rows, columns, K) of the K channels present.

    Raises
    ------
    InputError
        If the spacing is not positive, the box is empty, the window ends before it starts, a
        channel does not exist, or the sea is an ensemble.
    OutsidePeriodError
        If the data have no time in the window.
    """
    south, north, west, east = area.south, area.north, area.west, area.east
    steps: FloatArray = np.broadcast_to(np.asarray(spacing_deg, np.float64), 2)
    if not ((steps > 0.0).all() and north > south):
        raise InputError(
            f"A grid with spacing {steps.min():g} deg from {south:g} to {north:g} N is empty.",
            "The spacing must be positive, and north must be above south.",
            "Correct the box or the spacing.",
        )
    width = (east - west) % 360.0 or 360.0
    ny = max(2, int(np.ceil((north - south) / steps[0] - 1e-9)) + 1)
    nx = max(2, int(np.ceil(width / steps[1] - 1e-9)) + 1)
    dlat, dlon = (north - south) / (ny - 1), width / (nx - 1)
    rows, columns = np.meshgrid(
        south + dlat * np.arange(ny), west + dlon * np.arange(nx), indexing="ij"
    )
    derived = extra or {}
    index, present = locate_channels(layers, channels, derived)
    times = times_to_freeze(
        layers, (float(start), float(end)), _variables(present, derived), derived
    )
    values = np.empty((times.size, ny * nx, len(present)), np.float32)
    by_station = values.transpose(1, 0, 2)  # a view, so that the sea is in memory once
    _fill_stations(by_station, layers, (times, rows.ravel(), columns.ravel()), present, derived)
    grid = values.reshape(times.size, ny, nx, len(present))
    return GridFields(times, south, dlat, west, dlon, grid, index)


def locate_channels(
    layers: Sequence[Layer], channels: Sequence[int], extra: Mapping[int, DerivedChannel]
) -> tuple[IntArray, list[int]]:
    """Return the index of each channel (-1 if the layers lack it) and the channels present."""
    wanted = sorted({*channels, *extra})
    unknown = [c for c in wanted if c not in range(codes.CHANNEL_COUNT)]
    if unknown:
        raise InputError(
            f"There is no channel {unknown[0]}.",
            f"Channels are numbered 0 to {codes.CHANNEL_COUNT - 1}.",
            "Use the names in thalweg.kernels.codes.",
        )
    variables = stack_variables(layers)
    present = [c for c in wanted if c in extra or nm.CHANNEL_VARIABLES.get(c) in variables]
    index = np.full(codes.CHANNEL_COUNT, -1, np.int64)
    index[present] = np.arange(len(present))
    return index, present


def times_to_freeze(
    layers: Sequence[Layer],
    window: tuple[float, float],
    variables: Sequence[str],
    extra: Mapping[int, DerivedChannel],
) -> FloatArray:
    """Return the times to freeze.

    Raises
    ------
    InputError : If the window ends before it starts.
    OutsidePeriodError : If the data have no time in the window.
    """
    start, end = window
    if not (np.isfinite(start) and np.isfinite(end) and end >= start):
        raise InputError(
            f"The window from {format_time(start)} to {format_time(end)} is empty.",
            "The end must not be before the start.",
            "Correct the departure or the horizon.",
        )
    if not variables and not extra:
        return np.array([start, max(end, start + 1.0)])
    times = stack_times(layers, start, end, names=None if extra else variables)
    if times.size == 0:
        first, last = stack_period(layers, variables)
        raise OutsidePeriodError(
            f"The sea is needed from {format_time(start)} to {format_time(end)}.",
            f"The data cover {format_time(first)} to {format_time(last)}.",
            "Choose a departure in that period, or give data for the voyage.",
            start=start,
            end=end,
        )
    return times


def _variables(channels: Sequence[int], extra: Mapping[int, DerivedChannel]) -> list[str]:
    """Return the variables that are read as they stand, in the order of their channels."""
    return [name for c in channels if (name := _variable(c, extra))]


def _variable(channel: int, extra: Mapping[int, DerivedChannel]) -> str | None:
    return None if channel in extra else nm.CHANNEL_VARIABLES[channel]


def _sample_stations(
    values: NDArray[np.float32],
    layers: Sequence[Layer],
    points: tuple[FloatArray, FloatArray, FloatArray],
    present: Sequence[int],
    extra: Mapping[int, DerivedChannel],
) -> None:
    """Write the channels of some stations into ``values`` (S, T, K)."""
    times, lat, lon = points
    plain = {k: n for k, c in enumerate(present) if (n := _variable(c, extra))}
    series = series_of_stack(layers, list(plain.values()), times, lat, lon)
    for k, name in plain.items():
        values[:, :, k] = series[name]
    if not extra:
        return
    shape = (lat.size, times.size)
    wide = [
        np.ascontiguousarray(np.broadcast_to(a, shape)) for a in (times, lat[:, None], lon[:, None])
    ]
    sampled = SampledSea(layers, wide[0], wide[1], wide[2])
    for k, channel in enumerate(present):
        if channel in extra:
            values[:, :, k] = extra[channel](sampled, wide[0], wide[1], wide[2])
