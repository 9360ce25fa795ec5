"""Quick evaluation of time and length: many polylines at once through a frozen raster."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.geodesy import METRES_PER_DEGREE, direct, inverse, rough_lengths
from thalweg.core.limits import Limits
from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.kernels.leg.great_circle_sailing import SCRATCH_SIZE, ShipOnRaster
from thalweg.kernels.leg.polyline_sailing import (
    PolylineArrays,
    PolylineResults,
    sail_polylines,
)
from thalweg.kernels.leg.raster_sampling import RasterArrays
from thalweg.kernels.leg.table_lookup import TableArrays

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import GridFields
    from thalweg.ship import PerformanceTable

_CORRIDOR_HALF_WIDTH = 5.0  # metres to each side of a leg where charted depth is looked up
_DEPTH_LOOKUP_SPAN = 0.5  # degrees of a leg whose charted depth is looked up at once
_MAX_WAIT = 13.0 * HOUR  # longest wait for a leg to open [s]: a little more than a tide
_WAIT_STEPS = (30.0, 900.0)  # least and largest time between two trial departures [s]
_OPENING_TOLERANCE = 0.1  # tolerance of the time of opening [s]
_MAX_PIECE_LENGTH = 100_000.0  # metres; keeps lengths within 1e-6 of the geodesic's

#: Whether legs (L, n - 1) are blocked, and their least charted depth [m]; None: not known.
LookedUpLegs: TypeAlias = tuple[NDArray[np.bool_] | None, FloatArray | None]


@dataclass(frozen=True)
class TrackBatch:
    """Polylines of one number of points.

    Attributes
    ----------
    lat, lon : Points [deg], (L, n).
    leave : float64 array (L, n)
        The ship leaves a point no earlier [s after the origin]; -inf where it does not wait.
    setting : int64 array (L, n - 1)
    depart : float64 array (L,) [s after the origin]
    """

    lat: FloatArray
    lon: FloatArray
    leave: FloatArray
    setting: IntArray
    depart: FloatArray


@dataclass(frozen=True)
class TimeEvaluator:
    """Sea, ship, chart and limits that tracks are sailed with; make one with `make_time_evaluator`.

    Attributes
    ----------
    raster : Times are seconds after ``origin``.
    limits : float64 array
    origin : [s since 1970-01-01T00:00Z].
    by_length : Whether tracks compare by length instead of time.
    spacing : Longest piece [m].
    waiting_parameters : How the ship waits where a leg is closed, beside the given waits (see
        `thalweg.kernels.leg.polyline_sailing.sail_polylines`), (3,); zeros: it does not.
    """

    raster: RasterArrays
    table: TableArrays
    chart: Chart | None
    limits: FloatArray
    origin: float
    by_length: bool
    spacing: float
    waiting_parameters: FloatArray

    chooses_settings = False  # settings of a track stay as they are

    def fixed_points(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return which points of one polyline may not move: its ends."""
        fixed = np.zeros(len(lat), dtype=bool)
        fixed[[0, -1]] = True
        return fixed

    def pieces(self, lat: FloatArray, lon: FloatArray) -> IntArray:
        """Return the number of pieces into which each leg of polylines (..., n) is split."""
        return np.maximum(2, np.ceil(rough_lengths(lat, lon) / self.spacing)).astype(np.int64)

    def sail(
        self,
        batch: TrackBatch,
        *,
        pieces: IntArray | None = None,
        check: bool = True,
        looked_up: LookedUpLegs | None = None,
    ) -> tuple[FloatArray, FloatArray]:
        """Sail polylines.

        Parameters
        ----------
        pieces : int64 array (L, n - 1), optional
            Pieces of each leg; the same for polylines whose times are to be differenced.
        check : Check land, zones and charted depth too.
        looked_up : What `look_up_legs` returns for these polylines, where it is known already.

        Returns
        -------
        arrive : Arrival at every point [s after the origin], (L, n); +inf from the first leg that
            cannot be sailed.
        cost : Last arrival [s] or length [m], with the additions of penalty zones, (L,); +inf for a
            polyline that cannot be sailed.
        """
        arrive, _, cost = self.sail_and_wait(batch, pieces=pieces, check=check, looked_up=looked_up)
        return arrive, cost

    def sail_and_wait(
        self,
        batch: TrackBatch,
        *,
        pieces: IntArray | None = None,
        check: bool = True,
        looked_up: LookedUpLegs | None = None,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Sail as `sail` does; return (arrive, leave, cost), with the departure from each point."""
        count, size = batch.lat.shape
        shape = (count, size - 1)
        pieces = self.pieces(batch.lat, batch.lon) if pieces is None else pieces
        if looked_up is None:
            looked_up = self.look_up_legs(batch.lat, batch.lon) if check else (None, None)
        blocked, charted = looked_up
        lines = PolylineArrays(
            np.arange(count + 1, dtype=np.int64) * size,
            _flat(batch.lat),
            _flat(batch.lon),
            _flat(batch.leave),
            _of_legs(batch.setting, shape, np.int64),
            _of_legs(pieces, shape, np.int64),
            _of_legs(math.inf if charted is None else charted, shape, np.float64),
            _flat(batch.depart),
        )
        out = PolylineResults(
            np.empty(count * size),
            np.array(lines.leave),
            np.empty(count),
            np.empty(count, dtype=np.int64),
        )
        world = ShipOnRaster(self.raster, self.table, self.limits)
        sail_polylines(lines, world, self.waiting_parameters, out, np.zeros(SCRATCH_SIZE))
        arrive = out.arrive.reshape(count, size)
        cost = out.length.copy() if self.by_length else arrive[:, -1].copy()
        cost[out.status != codes.OK] = math.inf
        if blocked is not None:
            over = np.logical_or.accumulate(blocked, axis=1)
            arrive[:, 1:][over] = math.inf
            cost[over[:, -1]] = math.inf
        leave = out.leave.reshape(count, size)
        return arrive, leave, cost + self._penalty(batch, arrive, leave, cost) if check else cost

    def _penalty(
        self, batch: TrackBatch, arrive: FloatArray, leave: FloatArray, cost: FloatArray
    ) -> FloatArray:
        """Return the additions of penalty zones to the cost of polylines."""
        added = np.zeros(len(cost))
        sailed = np.flatnonzero(np.isfinite(cost))
        lat, lon = batch.lat[sailed], batch.lon[sailed]
        factor = penalty_factors(self.chart, lat, lon)
        if factor is None:
            return added
        spent = rough_lengths(lat, lon)
        if not self.by_length:
            spent = arrive[sailed, 1:] - leave[sailed, :-1]
        added[sailed] = ((factor - 1.0) * spent).sum(axis=1)
        return added

    def infeasible_legs(self, batch: TrackBatch, arrive: FloatArray) -> NDArray[np.bool_]:
        """Return which legs (L, n - 1) of sailed polylines are known to be infeasible.

        Those that are blocked, and the first of each polyline that cannot be sailed; ``arrive`` is
        the arrival at every point as `sail` returns it.
        """
        bad = np.isinf(arrive[:, 1:]) & np.isfinite(arrive[:, :-1])
        blocked, _ = self.look_up_legs(batch.lat, batch.lon)
        return bad if blocked is None else bad | blocked

    def look_up_legs(self, lat: FloatArray, lon: FloatArray) -> LookedUpLegs:
        """Return (blocked, least charted depth) of the legs of polylines; None: not known."""
        if self.chart is None:
            return None, None
        shape = (lat.shape[0], lat.shape[1] - 1)
        ends = [values.ravel() for values in (lat[:, :-1], lon[:, :-1], lat[:, 1:], lon[:, 1:])]
        first, place = unique_legs(ends)
        legs = np.stack([end[first] for end in ends], axis=1)
        blocked = np.asarray(self.chart.legs_blocked(*legs.T))
        required = self.limits[codes.LIMIT_REQUIRED_DEPTH]
        charted = None
        if self.chart.has_depth and math.isfinite(required):
            least = np.full(len(legs), -math.inf)
            least[~blocked] = _least_depths(self.chart, legs[~blocked])
            charted = least[place].reshape(shape)
        return blocked[place].reshape(shape), charted


def _least_depths(chart: Chart, legs: FloatArray) -> FloatArray:
    """Return the least charted depth of legs (n, 4); long legs in short parts, which is faster."""
    lat1, lon1, lat2, lon2 = legs.T
    span = np.maximum(np.abs(lat2 - lat1), np.abs(lon2 - lon1))
    count = np.maximum(np.ceil(span / _DEPTH_LOOKUP_SPAN), 1.0).astype(np.int64)
    first = np.cumsum(count) - count
    leg, number = numbered_parts(count)
    length, course, _ = inverse(lat1, lon1, lat2, lon2)
    if not len(legs):
        return np.empty(0)
    part, direction = (length / count)[leg], course[leg]
    a = direct(lat1[leg], lon1[leg], direction, number * part)
    b = direct(lat1[leg], lon1[leg], direction, (number + 1) * part)
    offset = np.minimum(_CORRIDOR_HALF_WIDTH, 1e-3 * length)[leg]
    depth = np.full(len(leg), math.inf)
    for side in (-0.5 * math.pi, 0.5 * math.pi):  # a corridor: independent of the division of legs
        ends = *direct(*a, direction + side, offset), *direct(*b, direction + side, offset)
        depth = np.minimum(depth, np.asarray(chart.depths.along(*ends), dtype=np.float64))
    least: FloatArray = np.minimum.reduceat(depth, first)
    return least


def make_time_evaluator(
    *,
    table: PerformanceTable | TableArrays,
    chart: Chart | None,
    fields: GridFields,
    limits: Limits,
    origin: float,
    by_length: bool,
    total: float,
    wait: bool = False,
) -> TimeEvaluator:
    """Return a time evaluator.

    Parameters
    ----------
    table : Speed through water [m/s].
    chart : Land, zones and charted depth; None: not checked.
    fields : The sea frozen around the tracks.
    limits : Limits along the route (`thalweg.core.limits.Limits`).
    origin : Where times count from [s since 1970-01-01T00:00Z].
    by_length : Whether tracks compare by length instead of time.
    total : Rough length of the track [m]. Pieces are half a cell of the raster, at least a 400th of
        this and at most 100 km.
    wait : Whether the ship may wait where a leg is closed for some time.
    """
    raster = raster_arrays(fields, origin)
    arrays = table if isinstance(table, TableArrays) else table.kernel_arrays()
    spacing = min(max(0.5 * fields.dlat * METRES_PER_DEGREE, total / 400.0), _MAX_PIECE_LENGTH)
    bounds = limits.array
    waiting_parameters = np.zeros(3)
    if wait and np.isfinite(bounds).any():
        pause = float(np.clip(np.median(np.diff(raster.times)), *_WAIT_STEPS))
        waiting_parameters[:] = _MAX_WAIT, pause, _OPENING_TOLERANCE
    return TimeEvaluator(
        raster, arrays, chart, bounds, origin, by_length, spacing, waiting_parameters
    )


def raster_arrays(fields: GridFields, origin: float) -> RasterArrays:
    """Return a frozen raster as kernels take it; times count from ``origin``.

    ``origin`` is in seconds since 1970-01-01T00:00Z.
    """
    index = np.asarray(fields.channel_index, np.int64)
    channels = np.zeros(fields.values.shape[3], dtype=np.int64)
    channels[index[index >= 0]] = np.flatnonzero(index >= 0)
    return RasterArrays(
        np.asarray(fields.times, np.float64) - origin,
        np.array([fields.lat0, fields.dlat, fields.lon0, fields.dlon], np.float64),
        np.ascontiguousarray(fields.values, dtype=np.float32),
        index,
        channels,
    )


def penalty_factors(chart: Chart | None, lat: FloatArray, lon: FloatArray) -> FloatArray | None:
    """Return the penalty factor of every leg of polylines (..., n); None if there are no zones.

    Parameters
    ----------
    lat, lon : float64 array (..., n) [deg]

    Returns
    -------
    float64 array (..., n - 1) or None
    """
    if chart is None or not chart.zones.has_penalty:
        return None
    shape = lat[..., 1:].shape
    ends = [x.ravel() for x in (lat[..., :-1], lon[..., :-1], lat[..., 1:], lon[..., 1:])]
    first, place = unique_legs(ends)
    factor = np.asarray(chart.zones.factors(*(x[first] for x in ends))[0])
    return factor[place].reshape(shape)


def unique_legs(ends: Sequence[FloatArray]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the first of every different leg, and which of these each leg is.

    ``ends`` are (lat1, lon1, lat2, lon2) of legs [deg]. A third of the legs that refinement tries
    are tried more than once.
    """
    mixed = ends[0] + math.sqrt(2.0) * ends[1] + math.sqrt(3.0) * ends[2] + math.sqrt(5.0) * ends[3]
    _, first, back = np.unique(mixed, return_index=True, return_inverse=True)
    back = back.reshape(-1)
    if all(np.array_equal(end, end[first][back]) for end in ends):
        return first, back
    every = np.arange(len(mixed))  # different legs with equal sums, which is very rare
    return every, every


def _flat(values: FloatArray) -> FloatArray:
    return np.array(values, np.float64, order="C").reshape(-1)  # read-only: another kernel


def _of_legs(values: ArrayLike, shape: tuple[int, int], kind: type) -> NDArray[Any]:
    """Return values per leg (L, n - 1), flat, with those of the last points, which are not read."""
    padded: NDArray[Any] = np.ones((shape[0], shape[1] + 1), kind)
    padded[:, :-1] = values
    return padded.reshape(-1)
