"""Which limits a route comes near to: the worst value of each, and when it is near."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from thalweg.chart.offing import required_offing
from thalweg.core.geodesy import densify, distance
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.sea import standard_names as nm

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.route import Route
    from thalweg.ship import Ship

NEAR: Final = 0.05  #: A value within this share of its limit is near it ...
_NEAR_CLEARANCE: Final = 0.1  # ... and a clearance within this distance as well [m]
_SPACING: Final = 0.5 * NAUTICAL_MILE  # of positions whose distance to land is looked up
_FARTHEST_LAND: Final = 30.0 * NAUTICAL_MILE


class _Values(NamedTuple):
    """A quantity along a route: its values, its limit at each, and how much of it is used."""

    name: str
    unit: float
    time: FloatArray
    value: FloatArray
    limit: FloatArray
    near: BoolArray
    use: FloatArray


def limits_met(
    route: Route, *, ship: Ship, chart: Chart | None, min_ukc: float
) -> list[dict[str, Any]]:
    """Return each limit that applies to a route: the worst value, when, and how long it is near.

    Port approaches and canals are left out: their speed is fixed, and no weather is read there.

    Parameters
    ----------
    ship : With the limits of the request.
    chart : With the offing that the plan kept; None: the distance from land is not looked at.
    min_ukc : Required under-keel clearance [m].

    Returns
    -------
    list of dict
        ``name`` with its unit, ``limit``, ``worst`` and ``time`` [s since 1970] of the worst value,
        ``near``: stretches of time [s, s] in which the value is within 5 % of the limit, and
        ``near_h``, their sum.
    """
    found = []
    for one in _all_values(route, ship, chart, min_ukc):
        known = np.isfinite(one.value) & np.isfinite(one.time)
        if not known.any():
            continue
        worst = int(np.argmax(np.where(known, one.use, -np.inf)))
        near = _stretches(one.near & known, one.time)
        found.append(
            {
                "name": one.name,
                "limit": round(float(one.limit[worst]) / one.unit, 2),
                "worst": round(float(one.value[worst]) / one.unit, 2),
                "time": round(float(one.time[worst])),
                "near": near,
                "near_h": round(sum(b - a for a, b in near) / 3600.0, 2),
            }
        )
    return found


def _all_values(route: Route, ship: Ship, chart: Chart | None, min_ukc: float) -> Iterator[_Values]:
    samples, limits = route.samples, ship.limits
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(len(route.legs["length"]))))
    leg = np.asarray(samples["leg"])
    at_sea = kind[leg] == 0
    time = np.where(at_sea, np.asarray(samples["time"], float), np.nan)
    if math.isfinite(limits.wave_height) and nm.WAVE_HEIGHT in samples:
        height = np.asarray(samples[nm.WAVE_HEIGHT], float)
        yield _at_most("wave_height_m", 1.0, time, height, limits.wave_height)
    if math.isfinite(limits.wind_speed) and all(name in samples for name in nm.WIND.pair):
        wind = np.hypot(*(np.asarray(samples[name], float) for name in nm.WIND.pair))
        yield _at_most("wind_speed_kn", KNOT, time, wind, limits.wind_speed)
    clearance = np.asarray(samples.get("under_keel_clearance", np.full(len(time), np.nan)), float)
    if np.isfinite(clearance).any():
        limit = np.full(len(time), min_ukc)
        slack = max(NEAR * min_ukc, _NEAR_CLEARANCE)
        near = clearance <= min_ukc + slack
        yield _Values("under_keel_clearance_m", 1.0, time, clearance, limit, near, -clearance)
    if chart is not None and chart.offing.distance > 0.0:
        yield _off_land(route, chart, kind == 0)
    if len(ship.speeds) > 1:
        order = np.asarray(route.legs["ordered_speed"], float)[leg]
        yield _at_most("ordered_speed_kn", KNOT, time, order, float(max(ship.speeds)), near=0.999)


def _at_most(
    name: str,
    unit: float,
    time: FloatArray,
    value: FloatArray,
    most: float,
    near: float = 1.0 - NEAR,
) -> _Values:
    limit = np.full(len(time), most)
    with np.errstate(invalid="ignore"):
        return _Values(name, unit, time, value, limit, value >= near * most, value)


def _off_land(route: Route, chart: Chart, at_sea: BoolArray) -> _Values:
    """Return the distance from land along a route, with what is required at each position."""
    track, legs = route.track, route.legs
    lat, lon, leg = densify(track.lat, track.lon, _SPACING)
    lat, lon = lat[:-1], lon[:-1]
    first_lat, first_lon = np.asarray(track.lat)[leg], np.asarray(track.lon)[leg]
    sailed = np.asarray(distance(first_lat, first_lon, lat, lon))
    share = np.clip(sailed / np.maximum(np.asarray(legs["length"])[leg], 1.0), 0.0, 1.0)
    begin, end = (np.asarray(legs[name], float)[leg] for name in ("depart", "arrive"))
    time = np.where(at_sea[leg], begin + share * (end - begin), np.nan)
    shore = chart.coastline.shore_distance(lat, lon, cap=_FARTHEST_LAND)
    required = required_offing(chart.offing_arrays, lat, lon)
    value = np.where((required > 0.0) & (shore < _FARTHEST_LAND), shore, np.nan)
    with np.errstate(invalid="ignore", divide="ignore"):
        use, near = required / value, value <= (1.0 + NEAR) * required
    return _Values("land_distance_nm", NAUTICAL_MILE, time, value, required, near, use)


def _stretches(near: BoolArray, time: FloatArray) -> list[list[int]]:
    """Return the times [s, s] of the runs of true values."""
    edge = np.flatnonzero(np.diff(np.concatenate([[False], near, [False]])))
    last = len(time) - 1
    ends: Iterable[tuple[int, int]] = zip(edge[::2], edge[1::2])
    found = [(time[a], time[min(b, last)]) for a, b in ends]
    return [[round(float(a)), round(float(b if math.isfinite(b) else a))] for a, b in found]
