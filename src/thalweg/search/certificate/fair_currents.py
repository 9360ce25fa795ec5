"""The strongest fair current, towards the goal, that a ship can meet at each time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from thalweg.core.errors import OutsidePeriodError
from thalweg.core.geodesy import distance, unit_vectors
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH
from thalweg.kernels.leg.raster_sampling import RasterArrays
from thalweg.sea.freeze import freeze_station_fields
from thalweg.sea.standard_names import CHANNEL_VARIABLES
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import metres_per_degree

_RADIUS = 6.371e6  # scale of a height along the way [m]; its slope is measured on the ellipsoid
_UNREACHED = -math.inf
_SIDES = slice(None, -1), slice(1, None)  # of cells: nodes before and after


class FairCurrents(NamedTuple):
    """The strongest fair currents that voyages of some lengths can meet, step by step.

    A fair current is what a current adds to the height of a ship (`heights_along`) in a second.

    Attributes
    ----------
    seconds : Length of each step between times of the data within a voyage [s], (voyages, steps).
    first, last : The strongest fair current at its begin and at its end [m/s], (voyages, steps);
        linear between is an upper bound. -inf where a ship is nowhere.
    """

    seconds: FloatArray
    first: FloatArray
    last: FloatArray


@dataclass(frozen=True, eq=False)
class HeightField:
    """A function of the position, bilinear on the cells of a raster, that rises to the goal.

    Attributes
    ----------
    rise : From the start to the goal [m].
    east, north : Least and greatest slope in each cell, (2, rows, columns).
    """

    rise: float
    east: FloatArray
    north: FloatArray

    @property
    def steepest(self) -> FloatArray:
        """The greatest slope in each cell, (rows, columns)."""
        return np.hypot(np.abs(self.east).max(axis=0), np.abs(self.north).max(axis=0))


def heights_along(stretch: StretchToBound, domain: BarrierDomain) -> list[HeightField]:
    """Return heights: by the length along the great circle, and by the distance from the goal."""
    lat, lon = domain.axes
    here = np.meshgrid(lat, lon, indexing="ij")
    start, goal = unit_vectors(*np.array([stretch.start, stretch.goal]).T)
    ahead = goal - (goal @ start) * start
    ahead /= max(float(np.linalg.norm(ahead)), 1e-12)
    there = unit_vectors(*here)
    along = _RADIUS * np.arctan2(there @ ahead, there @ start)
    nearer = -np.asarray(distance(*here, *stretch.goal))
    return [_height_field(values, stretch, lat, lon) for values in (along, nearer)]


def _height_field(
    values: FloatArray, stretch: StretchToBound, lat: FloatArray, lon: FloatArray
) -> HeightField:
    # degrees of longitude are longest, and those of latitude shortest, at the equator
    rows = (lat[:-1], lat[1:], np.clip(0.0, lat[:-1], lat[1:]))
    by_east = np.diff(values, axis=1) / np.diff(lon)
    by_north = np.diff(values, axis=0) / np.diff(lat)[:, None]
    slopes_east, slopes_north = [], []
    for north, east in map(metres_per_degree, rows):
        slopes_east += [by_east[side] / east[:, None] for side in _SIDES]
        slopes_north += [by_north[:, side] / north[:, None] for side in _SIDES]
    ends = [_bilinear(values, lat, lon, *end) for end in (stretch.start, stretch.goal)]
    return HeightField(
        ends[1] - ends[0],
        np.array([np.min(slopes_east, axis=0), np.max(slopes_east, axis=0)]),
        np.array([np.min(slopes_north, axis=0), np.max(slopes_north, axis=0)]),
    )


def _bilinear(values: FloatArray, lat: FloatArray, lon: FloatArray, y: float, x: float) -> float:
    east = (x - lon[0]) % 360.0 + lon[0]
    j = min(max(int(np.searchsorted(lat, y, side="right")) - 1, 0), lat.size - 2)
    i = min(max(int(np.searchsorted(lon, east, side="right")) - 1, 0), lon.size - 2)
    b = (y - lat[j]) / (lat[j + 1] - lat[j])
    a = (east - lon[i]) / (lon[i + 1] - lon[i])
    low, high = (values[k, i] * (1.0 - a) + values[k, i + 1] * a for k in (j, j + 1))
    return float(low * (1.0 - b) + high * b)


def strongest_fair_currents(
    stretch: StretchToBound,
    domain: BarrierDomain,
    fastest: float,
    height: HeightField,
    areas: Sequence[BoolArray],
    durations: FloatArray,
) -> tuple[float, list[FairCurrents]]:
    """Return the steepest slope in reach, and the strongest fair currents in parts of a domain.

    Parameters
    ----------
    stretch : With one departure.
    domain : All water that the ship can reach in the known time.
    fastest : No ship is faster over ground [m/s].
    areas : Cells of the raster, (rows, columns), for which the currents are taken together.
    durations : Of voyages [s], (n,), up to the known time.

    Notes
    -----
    A current is a mean of those at the corners of its cell, and linear between the times of the
    data; the slopes of a bilinear function are between those on opposite sides of a cell. A ship
    is in a cell at a time if its distances from the start and to the goal allow it at the greatest
    speed over ground.
    """
    lat, lon = domain.axes
    middle = np.meshgrid(0.5 * (lat[1:] + lat[:-1]), 0.5 * (lon[1:] + lon[:-1]), indexing="ij")
    half = _half_diagonals(lat, lon)[:, None]
    from_start, to_goal = (
        np.maximum(np.asarray(distance(*end, *middle)) - half, 0.0) / fastest
        for end in (stretch.start, stretch.goal)
    )
    in_reach = from_start + to_goal <= stretch.known
    steepest = float(height.steepest[in_reach].max(initial=0.0))
    times = np.clip(domain.raster.times, 0.0, stretch.known)
    times = np.unique([0.0, *times, stretch.known])
    order = np.flatnonzero(in_reach)
    order = order[np.argsort(to_goal.ravel()[order])]
    rasters = _by_layer(stretch, domain)
    drift = domain.margins[..., CURRENT_EAST] * height.steepest

    def fair_at(time: float) -> FloatArray:
        strongest = np.fmax.reduce([_fair_at(raster, time, height) for raster in rasters])
        return np.asarray((strongest + drift).ravel()[order])

    counted = [area.ravel()[order] for area in areas]
    left = durations[:, None] - times[:-1]
    # cells are in reach of the goal up to a place in the order
    place = np.searchsorted(to_goal.ravel()[order], left, side="right") - 1
    ends = np.full((2, len(areas), *left.shape), _UNREACHED)
    after = fair_at(float(times[0]))
    for step, end in enumerate(times[1:]):
        before, after = after, fair_at(float(end))
        early = from_start.ravel()[order] <= end
        reached = place[:, step] >= 0
        for number, area in enumerate(counted):
            for side, fair in enumerate((before, after)):
                most = np.maximum.accumulate(np.where(area & early, fair, _UNREACHED))
                ends[side, number, reached, step] = most[place[reached, step]]
    seconds = np.clip(left, 0.0, np.diff(times))
    return steepest, [
        _cut_off(seconds, ends[0, k], ends[1, k], np.diff(times)) for k in range(len(areas))
    ]


def _cut_off(
    seconds: FloatArray, first: FloatArray, last: FloatArray, whole: FloatArray
) -> FairCurrents:
    """Return fair currents of steps that may end with the voyage, before the data's next time."""
    with np.errstate(invalid="ignore"):
        cut = first + (last - first) * (seconds / whole)
    return FairCurrents(seconds, first, np.where(np.isfinite(first) & np.isfinite(last), cut, last))


def _half_diagonals(lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return half the diagonal of the cells of each row [m], or a little more."""
    north, east = metres_per_degree(lat)
    width = np.maximum(east[1:], east[:-1]) * (lon[1] - lon[0])
    tall = np.maximum(north[1:], north[:-1]) * np.diff(lat)
    return np.asarray(0.5 * 1.01 * np.hypot(width, tall))


def _by_layer(stretch: StretchToBound, domain: BarrierDomain) -> list[RasterArrays]:
    """Return the raster of a domain, of each layer of the sea alone where there are several.

    In a cell, and between two times, with one unknown value a layer is unknown all over: the next
    layer holds there up to the corners and times at which the first one is known.
    """
    name = CHANNEL_VARIABLES[CURRENT_EAST]
    layers = [layer for layer in stretch.sea.layers if name in layer.variables]
    if len(layers) < 2 or domain.margins.any():  # those are for the layers together
        return [domain.raster]
    lat, lon = np.meshgrid(*domain.axes, indexing="ij")
    rasters = []
    for layer in layers:
        try:
            fields = freeze_station_fields(
                (layer,), lat.ravel(), lon.ravel(), *stretch.period, (CURRENT_EAST, CURRENT_NORTH)
            )
        except OutsidePeriodError:  # of data that have no value at these times
            continue
        values = np.moveaxis(fields.values.reshape(*lat.shape, *fields.values.shape[1:]), 2, 0)
        times = fields.times - stretch.depart
        rasters.append(
            domain.raster._replace(times=times, values=values, channel_index=fields.channel_index)
        )
    return rasters


def _fair_at(raster: RasterArrays, time: float, height: HeightField) -> FloatArray:
    """Return the strongest fair current in each cell at a time [m/s]; -inf where none is known."""
    k = int(np.clip(np.searchsorted(raster.times, time) - 1, 0, raster.times.size - 2))
    share = (time - raster.times[k]) / (raster.times[k + 1] - raster.times[k])
    share = min(max(float(share), 0.0), 1.0)
    values = raster.values[k + (share == 1.0)].astype(float)
    if 0.0 < share < 1.0:
        values = values * (1.0 - share) + raster.values[k + 1] * share
    east = values[..., raster.channel_index[CURRENT_EAST]]
    north = values[..., raster.channel_index[CURRENT_NORTH]]
    best = np.full(height.east.shape[1:], _UNREACHED)
    for rows in _SIDES:
        for columns in _SIDES:
            fair = (east[rows, columns] * height.east).max(axis=0)
            best = np.fmax(best, fair + (north[rows, columns] * height.north).max(axis=0))
    return np.asarray(best)
