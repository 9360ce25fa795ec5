"""Tightening: corners of a line are cut off as far as obstacles allow, until it lies taut."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.geodesy import FloatArray, direct, inverse
from thalweg.route.line import IntArray, Line, unwrapped
from thalweg.route.pulling import pull
from thalweg.route.quick import Bundle, Sailor

_ROUNDS = 24
_SCAN = 12  # cuts tried at once
_DEEPER = 6  # scans, each inside the interval of the one before: 12^-6 of a leg
_SETTLED = 1e-7  # relative gain of a round that ends the work


def tighten(line: Line, sailor: Sailor) -> Line:
    """Return a line pulled tight around what it must keep clear of.

    Parameters
    ----------
    line : Line
        One that can be sailed.
    sailor : Sailor

    Notes
    -----
    Each waypoint where the ship does not wait is replaced by two, one back along the leg that comes
    in and one on along the leg that goes out, as far as the leg between them stays clear; waypoints
    that have become needless are dropped. Repeated, this converges to the taut string of the same
    way round, corners of polygons and round capes alike, without knowing their outlines.
    """
    cost = float(sailor.sail(line.bundle())[1][0])
    for _ in range(_ROUNDS):
        if len(line) < 3 or not math.isfinite(cost):
            return line
        after = pull(_cut(line, sailor), sailor)
        new = float(sailor.sail(after.bundle())[1][0])
        gain = cost - new
        if not gain > 0.0:
            return line
        line, cost = after, new
        if gain < _SETTLED * (cost if sailor.by_length else cost - line.depart):
            return line
    return line


def _cut(line: Line, sailor: Sailor) -> Line:
    """Return the line with every corner cut off as far as possible."""
    corners = np.arange(1, len(line) - 1)
    corners = corners[np.isinf(line.leave[corners])]
    if not corners.size:
        return line
    back_most = np.where(corners - 1 == 0, 1.0, 0.5)
    on_most = np.where(corners + 1 == len(line) - 1, 1.0, 0.5)
    arrive = sailor.sail(line.bundle(), check=False)[0][0, corners]
    back, on = np.zeros(len(corners)), np.zeros(len(corners))
    for grow_back, grow_on in ((1.0, 1.0), (0.0, 1.0), (1.0, 0.0)):
        low, high = np.zeros(len(corners)), np.ones(len(corners))
        for _ in range(_DEEPER):
            tried = low[:, None] + (high - low)[:, None] * np.arange(1, _SCAN + 1) / _SCAN
            a = back[:, None] + grow_back * tried * (back_most - back)[:, None]
            b = on[:, None] + grow_on * tried * (on_most - on)[:, None]
            clear = _clear(line, sailor, corners, arrive, a, b)
            count = np.cumprod(clear, axis=1).sum(axis=1)
            width = (high - low) / _SCAN
            low, high = low + count * width, np.minimum(low + (count + 1) * width, high)
        back = back + grow_back * low * (back_most - back)
        on = on + grow_on * low * (on_most - on)
    return _with_cuts(line, corners, back, on)


def _clear(
    line: Line,
    sailor: Sailor,
    corners: IntArray,
    arrive: FloatArray,
    back: FloatArray,
    on: FloatArray,
) -> np.ndarray:
    """Return which cuts (corners, trials) can be sailed."""
    shape = back.shape
    which = np.repeat(corners, shape[1])
    before = _part(line, which, which - 1, back.ravel())
    after = _part(line, which, which + 1, on.ravel())
    bundle = Bundle(
        np.stack([before[0], after[0]], axis=1),
        _near(np.stack([before[1], after[1]], axis=1)),
        np.full((len(which), 2), -math.inf),
        line.setting[which - 1][:, None],
        np.repeat(arrive, shape[1]),
    )
    return np.isfinite(sailor.sail(bundle)[1]).reshape(shape)


def _part(
    line: Line, start: IntArray, end: IntArray, share: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the positions a share of the way along the geodesics between waypoints."""
    length, course, _ = inverse(line.lat[start], line.lon[start], line.lat[end], line.lon[end])
    return direct(line.lat[start], line.lon[start], course, share * length)


def _with_cuts(line: Line, corners: IntArray, back: FloatArray, on: FloatArray) -> Line:
    """Return the line with each corner replaced by the two ends of its cut."""
    cut = np.maximum(back, on) > 0.0
    corners, back, on = corners[cut], back[cut], on[cut]
    before = _part(line, corners, corners - 1, back)
    after = _part(line, corners, corners + 1, on)
    times = np.ones(len(line), dtype=np.int64)
    times[corners] = 2
    old = np.repeat(np.arange(len(line)), times)
    place = np.cumsum(times)[corners] - 2
    lat, lon = line.lat[old], line.lon[old]
    lat[place], lon[place] = before
    lat[place + 1], lon[place + 1] = after
    setting = line.setting[np.maximum(old[1:] - 1, 0)]
    return Line(lat, unwrapped(lon), line.leave[old], setting, line.depart)


def _near(lon: FloatArray) -> FloatArray:
    return np.asarray(np.unwrap(lon, period=360.0, axis=1))
