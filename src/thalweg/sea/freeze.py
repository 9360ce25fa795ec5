"""Freezing: the sea sampled once at stations or on a raster, for kernels."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError, OutsidePeriodError
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels import codes
from thalweg.sea import standard_names as nm
from thalweg.sea.frozen_fields import GridFields, StationFields
from thalweg.sea.layer_stack import LayeredSea

DerivedChannel: TypeAlias = Callable[
    [Mapping[str, FloatArray], FloatArray, FloatArray, FloatArray], FloatArray
]

POINTS_PER_CHUNK = 1 << 17  #: values computed at a time, so that temporaries stay small


class SampledSea(Mapping[str, FloatArray]):
    """The sea at given points as a mapping; each variable is sampled when first asked for."""

    def __init__(self, sea: LayeredSea, time: FloatArray, lat: FloatArray, lon: FloatArray) -> None:
        self._sea, self._points = sea, (time, lat, lon)
        self._done: dict[str, FloatArray] = {}

    def __getitem__(self, name: str) -> FloatArray:
        if name not in self._done:
            if not self._sea.provides(name):
                raise KeyError(name)
            self._done[name] = self._sea.sample([name], *self._points)[name]
        return self._done[name]

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._sea.variables))

    def __len__(self) -> int:
        return len(self._sea.variables)


def freeze_stations(
    sea: LayeredSea,
    lat: FloatArray,
    lon: FloatArray,
    *,
    window: tuple[float, float],
    channels: Sequence[int],
    extra: Mapping[int, DerivedChannel],
) -> StationFields:
    """Sample the sea at stations for all native times of a window (see `Sea.freeze_stations`)."""
    lat, lon = np.ascontiguousarray(lat, np.float64), np.ascontiguousarray(lon, np.float64)
    index, present = locate_channels(sea, channels, extra)
    times = times_to_freeze(sea, window, [n for c in present if (n := _variable(c, extra))], extra)
    values = np.empty((lat.size, times.size, len(present)), np.float32)
    rows = max(1, POINTS_PER_CHUNK // times.size)
    for first in range(0, lat.size, rows):
        part = slice(first, first + rows)
        _sample_stations(values[part], sea, (times, lat[part], lon[part]), present, extra)
    return StationFields(times, values, index)


def freeze_grid(
    sea: LayeredSea,
    box: tuple[float, float, float, float],
    *,
    window: tuple[float, float],
    channels: Sequence[int],
    spacing_deg: float,
    extra: Mapping[int, DerivedChannel],
) -> GridFields:
    """Sample the sea on a regular raster for all native times (see `Sea.freeze_grid`)."""
    south, north, west, east = box
    if not (spacing_deg > 0.0 and north > south):
        raise InputError(
            f"A raster of spacing {spacing_deg:g} deg from {south:g} to {north:g} N is empty.",
            "The spacing must be positive and the north above the south.",
            "Check the box.",
        )
    width = (east - west) % 360.0 or 360.0
    ny = max(2, int(np.ceil((north - south) / spacing_deg - 1e-9)) + 1)
    nx = max(2, int(np.ceil(width / spacing_deg - 1e-9)) + 1)
    dlat, dlon = (north - south) / (ny - 1), width / (nx - 1)
    rows, columns = np.meshgrid(
        south + dlat * np.arange(ny), west + dlon * np.arange(nx), indexing="ij"
    )
    stations = freeze_stations(
        sea, rows.ravel(), columns.ravel(), window=window, channels=channels, extra=extra
    )
    shape = (ny, nx, stations.times.size, stations.values.shape[2])
    values = np.ascontiguousarray(stations.values.reshape(shape).transpose(2, 0, 1, 3))
    return GridFields(stations.times, south, dlat, west, dlon, values, stations.channel_index)


def locate_channels(
    sea: LayeredSea, channels: Sequence[int], extra: Mapping[int, DerivedChannel]
) -> tuple[IntArray, list[int]]:
    """Return the place of each channel (-1 if the sea lacks it) and the present channels."""
    wanted = sorted({*channels, *extra})
    unknown = [c for c in wanted if c not in range(codes.CHANNEL_COUNT)]
    if unknown:
        raise InputError(
            f"There is no channel {unknown[0]}.",
            f"Channels are numbered 0 to {codes.CHANNEL_COUNT - 1}.",
            "Use the names in thalweg.kernels.codes.",
        )
    present = [c for c in wanted if c in extra or nm.CHANNEL_VARIABLES.get(c) in sea.variables]
    index = np.full(codes.CHANNEL_COUNT, -1, np.int64)
    index[present] = np.arange(len(present))
    return index, present


def times_to_freeze(
    sea: LayeredSea,
    window: tuple[float, float],
    variables: Sequence[str],
    extra: Mapping[int, DerivedChannel],
) -> FloatArray:
    """Return the times to freeze, or raise if the data know none in the window."""
    start, end = window
    if not (np.isfinite(start) and np.isfinite(end) and end >= start):
        raise InputError(
            f"A window from {format_time(start)} to {format_time(end)} holds no time.",
            "The end must not lie before the start.",
            "Check departure and horizon.",
        )
    if not variables and not extra:
        return np.array([start, max(end, start + 1.0)])
    times = sea.times(start, end, names=None if extra else variables)
    if times.size == 0:
        first, last = sea.period_of(variables)
        raise OutsidePeriodError(
            f"The sea was asked for {format_time(start)} to {format_time(end)}.",
            f"The data cover {format_time(first)} to {format_time(last)}.",
            "Choose a departure in that period or give data for the voyage.",
            start=start,
            end=end,
        )
    return times


def _variable(channel: int, extra: Mapping[int, DerivedChannel]) -> str | None:
    return None if channel in extra else nm.CHANNEL_VARIABLES[channel]


def _sample_stations(
    values: NDArray[np.float32],
    sea: LayeredSea,
    points: tuple[FloatArray, FloatArray, FloatArray],
    present: Sequence[int],
    extra: Mapping[int, DerivedChannel],
) -> None:
    """Write the channels of some stations into ``values`` (S, T, K)."""
    times, lat, lon = points
    plain = {k: n for k, c in enumerate(present) if (n := _variable(c, extra))}
    series = sea.series(list(plain.values()), times, lat, lon)
    for k, name in plain.items():
        values[:, :, k] = series[name]
    if not extra:
        return
    shape = (lat.size, times.size)
    wide = [
        np.ascontiguousarray(np.broadcast_to(a, shape)) for a in (times, lat[:, None], lon[:, None])
    ]
    sampled = SampledSea(sea, wide[0], wide[1], wide[2])
    for k, channel in enumerate(present):
        if channel in extra:
            values[:, :, k] = extra[channel](sampled, wide[0], wide[1], wide[2])


@dataclass(frozen=True, eq=False)
class FreezableSea(LayeredSea):
    """A sea that can be handed to kernels, as arrays."""

    def freeze_stations(
        self,
        lat: ArrayLike,
        lon: ArrayLike,
        start: float,
        end: float,
        channels: Sequence[int],
        *,
        extra: Mapping[int, DerivedChannel] | None = None,
    ) -> StationFields:
        """Return the sea at stations for kernels.

        Parameters
        ----------
        lat, lon : array_like (S,)
            Stations [deg].
        start, end : float
            Window [s since epoch]; frozen times reach one native step beyond it.
        channels : sequence of int
            Channels of `thalweg.kernels.codes`; those the sea lacks get index -1.
        extra : mapping of int to callable, optional
            Channels computed as ``f(sampled, time, lat, lon) -> array``, where ``sampled`` maps
            any variable of the sea to its values and all arrays are (stations, times).

        Raises
        ------
        OutsidePeriodError
            If no data reach into the window.
        """
        return freeze_stations(
            self,
            np.asarray(lat, np.float64),
            np.asarray(lon, np.float64),
            window=(float(start), float(end)),
            channels=channels,
            extra=extra or {},
        )

    def freeze_grid(
        self,
        south: float,
        north: float,
        west: float,
        east: float,
        start: float,
        end: float,
        channels: Sequence[int],
        *,
        spacing_deg: float,
        extra: Mapping[int, DerivedChannel] | None = None,
    ) -> GridFields:
        """Return the sea on a regular raster for kernels; arguments as in `freeze_stations`.

        The spacing [deg] is fitted down so that the raster ends on the box; ``east < west`` spans
        the antimeridian.
        """
        return freeze_grid(
            self,
            (float(south), float(north), float(west), float(east)),
            window=(float(start), float(end)),
            channels=channels,
            spacing_deg=float(spacing_deg),
            extra=extra or {},
        )
