"""Corner cutting: corners of a line are cut off repeatedly, as far as obstacles allow."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.geodesy import (
    direct,
    inverse,
    positions_along,
    rough_lengths,
    unwrap_longitude,
)
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.evaluators.polyline import Polyline, PolylineEvaluator
from thalweg.route.evaluators.time_evaluator import (
    TrackBatch,
    penalty_factors,
)
from thalweg.route.refinement.string_pulling import string_pull

_MAX_ROUNDS = 24
_TRIAL_CUTS = 12  # cuts tried at once
_SCAN_LEVELS = 6  # scans, each within the interval of the one before: to 12^-6 of a leg
_GAIN_TOLERANCE = 1e-7  # relative gain of a round below which the search ends


def cut_corners(line: Polyline, evaluator: PolylineEvaluator) -> Polyline:
    """Return a line shortened around the obstacles it passes.

    Parameters
    ----------
    line : One that can be sailed.

    Notes
    -----
    Each waypoint where the ship does not wait or change its setting is replaced by two: one on the
    incoming leg and one on the outgoing leg, as far from the corner as the leg between them stays
    clear. Waypoints that are then needless are removed. Repeated, this converges to the shortest
    line of the same homotopy class, around corners of polygons and round capes, without using
    their outlines.
    """
    cost = float(evaluator.sail(line.batch())[1][0])
    for _ in range(_MAX_ROUNDS):
        if len(line) < 3 or not math.isfinite(cost):
            return line
        after = string_pull(_cut_every_corner(line, evaluator), evaluator)
        new = float(evaluator.sail(after.batch())[1][0])
        gain = cost - new
        if not gain > 0.0:
            return line
        line, cost = after, new
        if gain < _GAIN_TOLERANCE * (cost if evaluator.by_length else cost - line.depart):
            return line
    return line


def merge_short_legs(line: Polyline, evaluator: PolylineEvaluator, *, shortest: float) -> Polyline:
    """Return the line with the two ends of every very short leg merged, where that is feasible.

    Cutting a corner at a point of the coast leaves two waypoints very close together; they become
    the intersection of the two adjacent legs when these are extended.

    Parameters
    ----------
    shortest : Legs below this length [m] are merged.
    """
    k = 1
    while k < len(line) - 2:
        short = rough_lengths(line.lat[k : k + 2], line.lon[k : k + 2])[0] < shortest
        merged = None
        fixed = line.required_points(evaluator)[k : k + 2]
        if short and np.isinf(line.leave[k : k + 2]).all() and not fixed.any():
            merged = _merged(line, evaluator, k)
        if merged is None:
            k += 1
        else:
            line = merged
    return line


def _merged(line: Polyline, evaluator: PolylineEvaluator, k: int) -> Polyline | None:
    """Return the line with one point for points k and k + 1, the nearest that can be sailed."""
    apex = _leg_intersection(line, k)
    if apex is None:
        return None
    middle = 0.5 * (line.lat[k] + line.lat[k + 1]), 0.5 * (line.lon[k] + line.lon[k + 1])
    out = np.array([1.0, 2.0, 5.0, 20.0])  # ever farther from the corner
    lat = np.repeat(np.delete(line.lat, k)[None], len(out), axis=0)
    lon = np.repeat(np.delete(line.lon, k)[None], len(out), axis=0)
    lat[:, k] = middle[0] + out * (apex[0] - middle[0])
    lon[:, k] = middle[1] + out * (apex[1] - middle[1])
    base = Polyline(
        lat[0], lon[0], np.delete(line.leave, k), np.delete(line.setting, k), line.depart
    )
    cost = evaluator.sail(base.batch(lat, lon))[1]
    if not np.isfinite(cost).any():
        return None
    pick = int(np.argmin(cost))
    return base.moved(lat[pick], lon[pick])


def _leg_intersection(line: Polyline, k: int) -> tuple[float, float] | None:
    """Return the intersection of legs k - 1 and k + 1 extended; None if it is far away."""
    lat, lon = line.lat[k - 1 : k + 3], line.lon[k - 1 : k + 3]
    gaps, starts, ends = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
    x, y = gaps[1] * math.sin(starts[1]), gaps[1] * math.cos(starts[1])
    ax, ay = math.sin(ends[0]), math.cos(ends[0])
    bx, by = -math.sin(starts[2]), -math.cos(starts[2])
    cross = ax * by - ay * bx
    if cross == 0.0:
        return None
    reach = (x * by - y * bx) / cross
    if not 0.0 <= reach <= 20.0 * gaps[1]:
        return None
    apex = direct(lat[1], lon[1], ends[0], reach)
    return float(apex[0]), float(lon[1] + (apex[1] - lon[1] + 180.0) % 360.0 - 180.0)


def _cut_every_corner(line: Polyline, evaluator: PolylineEvaluator) -> Polyline:
    """Return the line with every corner cut off as far as possible."""
    corners = np.arange(1, len(line) - 1)
    fixed = line.required_points(evaluator)
    corners = corners[np.isinf(line.leave[corners]) & ~fixed[corners]]
    if not corners.size:
        return line
    back_most = np.where(corners - 1 == 0, 1.0, 0.5)
    on_most = np.where(corners + 1 == len(line) - 1, 1.0, 0.5)
    arrive = evaluator.sail(line.batch(), check=False)[0][0, corners]
    back, on = np.zeros(len(corners)), np.zeros(len(corners))
    for grow_back, grow_on in ((1.0, 1.0), (0.0, 1.0), (1.0, 0.0)):
        low, high = np.zeros(len(corners)), np.ones(len(corners))
        for _ in range(_SCAN_LEVELS):
            tried = (
                low[:, None] + (high - low)[:, None] * np.arange(1, _TRIAL_CUTS + 1) / _TRIAL_CUTS
            )
            a = back[:, None] + grow_back * tried * (back_most - back)[:, None]
            b = on[:, None] + grow_on * tried * (on_most - on)[:, None]
            clear = _feasible_cuts(line, evaluator, corners, arrive, a, b)
            count = np.cumprod(clear, axis=1).sum(axis=1)
            width = (high - low) / _TRIAL_CUTS
            low, high = low + count * width, np.minimum(low + (count + 1) * width, high)
        back = back + grow_back * low * (back_most - back)
        on = on + grow_on * low * (on_most - on)
    return _with_cuts(line, corners, back, on)


def _feasible_cuts(
    line: Polyline,
    evaluator: PolylineEvaluator,
    corners: IntArray,
    arrive: FloatArray,
    back: FloatArray,
    on: FloatArray,
) -> np.ndarray:
    """Return which cuts (corners, trials) can be sailed."""
    shape = back.shape
    which = np.repeat(corners, shape[1])
    before = _positions_along(line, which, which - 1, back.ravel())
    after = _positions_along(line, which, which + 1, on.ravel())
    batch = TrackBatch(
        np.stack([before[0], after[0]], axis=1),
        _near(np.stack([before[1], after[1]], axis=1)),
        np.full((len(which), 2), -math.inf),
        line.setting[which - 1][:, None],
        np.repeat(arrive, shape[1]),
    )
    clear = np.isfinite(evaluator.sail(batch)[1])
    factor = penalty_factors(evaluator.chart, batch.lat, batch.lon)
    if factor is not None:  # a cut must not enter a zone that both of its legs avoid
        own = penalty_factors(evaluator.chart, line.lat, line.lon)
        allowed = np.maximum(own[which - 1], own[which])  # type: ignore[index]
        clear &= factor[:, 0] <= allowed + 1e-9
    return clear.reshape(shape)


def _positions_along(
    line: Polyline, start: IntArray, end: IntArray, share: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the positions at shares of the geodesics between waypoints."""
    return positions_along(line.lat[start], line.lon[start], line.lat[end], line.lon[end], share)


def _with_cuts(line: Polyline, corners: IntArray, back: FloatArray, on: FloatArray) -> Polyline:
    """Return the line with each corner replaced by the two ends of its cut."""
    cut = np.maximum(back, on) > 0.0
    corners, back, on = corners[cut], back[cut], on[cut]
    before = _positions_along(line, corners, corners - 1, back)
    after = _positions_along(line, corners, corners + 1, on)
    times = np.ones(len(line), dtype=np.int64)
    times[corners] = 2
    old = np.repeat(np.arange(len(line)), times)
    place = np.cumsum(times)[corners] - 2
    lat, lon = line.lat[old], line.lon[old]
    lat[place], lon[place] = before
    lat[place + 1], lon[place + 1] = after
    setting = line.setting[np.maximum(old[1:] - 1, 0)]
    return Polyline(lat, unwrap_longitude(lon), line.leave[old], setting, line.depart)


def _near(lon: FloatArray) -> FloatArray:
    return np.asarray(np.unwrap(lon, period=360.0, axis=1))
