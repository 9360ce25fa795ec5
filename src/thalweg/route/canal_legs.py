"""Legs of a track through ship canals and port approaches: lines, times, dues and fuel."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.approaches import JOINED_WITHIN, ON_LINE
from thalweg.chart.canal_parts import (
    canal_part,
    first_legs_of_transits,
    joints_to_canals,
    part_number_of_legs,
)
from thalweg.chart.canals import Canal, canals_with_dues
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import ThalwegError
from thalweg.core.geodesy import Position, direct, distance, inverse
from thalweg.core.types import FloatArray
from thalweg.ship.condition_variables import WAVE_NORTH, WAVE_PERIOD
from thalweg.ship.conditions import Conditions

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.route.track import Track
    from thalweg.ship import Ship

_DEEP_WATER = 1e4  # depth of calm water [m]
_WAVE_PERIOD = 9.0  # of no waves [s]


@dataclass(frozen=True)
class ApproachLeg(Canal):
    """A leg along the approach of a port: sailed like a canal, without dues and limits."""


@dataclass(frozen=True)
class CanalPart(ApproachLeg):
    """A leg along a part of a canal: sailed like an approach, with its time, dues and limits."""


@dataclass(frozen=True)
class CanalLegs:
    """Which legs of a track run through canals or along port approaches.

    Attributes
    ----------
    number : Index into ``canals``, (legs,); -1 for legs at sea.
    canals : Those of the chart, then the legs along approaches.
    backward : Whether the canal is passed from its last position to its first, (legs,).
    """

    number: NDArray[np.int64]
    canals: tuple[Canal, ...]
    backward: NDArray[np.bool_]

    @property
    def any(self) -> bool:
        """Whether any leg is a canal."""
        return bool((self.number >= 0).any())

    @property
    def approach(self) -> NDArray[np.bool_]:
        """Which legs run along approaches."""
        kinds = [isinstance(canal, ApproachLeg) for canal in self.canals] + [False]
        return np.asarray(kinds)[self.number]

    @property
    def legs(self) -> list[int]:
        """The legs through canals and approaches, ascending."""
        return [int(leg) for leg in np.flatnonzero(self.number >= 0)]

    def of(self, leg: int) -> Canal:
        """Return the canal of a leg that has one."""
        return self.canals[self.number[leg]]

    @property
    def speed(self) -> FloatArray:
        """Mean speed through the canal of each leg [m/s]; NaN at sea."""
        return self._filled(lambda canal: canal.length / canal.transit_time)

    @property
    def length(self) -> FloatArray:
        """Length of the canal of each leg [m]; NaN at sea."""
        return self._filled(lambda canal: canal.length)

    @property
    def fee(self) -> FloatArray:
        """Dues of each leg [USD]; 0 at sea."""
        fee = self._filled(lambda canal: canal.fee)
        return np.where(np.isnan(fee), 0.0, fee)

    def rates(self, ship: Ship) -> tuple[FloatArray, FloatArray]:
        """Brake power [W] and fuel rate [kg/s] of each leg, as `canal_rates`; NaN at sea."""
        known: dict[float, tuple[float, float]] = {}
        rows = []
        for k in self.number.tolist():
            if k < 0:
                rows.append((math.nan, math.nan))
            elif isinstance(canal := self.canals[k], ApproachLeg):
                speed = round(canal.length / canal.transit_time, 6)
                if speed not in known:  # most legs of an approach have one speed
                    known[speed] = canal_rates(ship, canal)
                rows.append(known[speed])
            else:
                rows.append(canal_rates(ship, canal))
        power, fuel = np.array(rows, float).T
        return power, fuel

    def ordered_speed(self, ship: Ship) -> FloatArray:
        """Calm-water speed [m/s] of the setting each leg is passed at; NaN at sea."""
        return self._filled(lambda canal: ship.speeds[canal_setting(ship, canal)])

    def places(self, leg: int, along: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (lat, lon [deg], course [rad]) at distances [m] from the start of a leg."""
        path = np.array(self.of(leg).path, float)
        if self.backward[leg]:
            path = path[::-1]
        lat, lon = path.T
        lengths, courses, _ = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
        start = cumulative_sums(lengths)
        part = np.clip(np.searchsorted(start, along, side="right") - 1, 0, len(lengths) - 1)
        there = direct(lat[part], lon[part], courses[part], along - start[part])
        return *there, courses[part]

    def _filled(self, value: object) -> FloatArray:
        values = np.array([value(canal) for canal in self.canals] + [math.nan])  # type: ignore[operator]
        return np.asarray(values[self.number])


def canal_legs(track: Track, chart: Chart | None, ship: Ship | None = None) -> CanalLegs:
    """Return which legs of a track run from one end of a canal of the chart to the other.

    Parameters
    ----------
    ship : With a ship, canals have its dues, and legs along approaches of the chart are included,
        from the ends of the track on or where other water is land: they are sailed at
        `Ship.approach_speed`, or the ordered speed if that is lower.
    """
    none = np.full(len(track) - 1, -1, np.int64)
    legs = CanalLegs(none, (), none < -1)
    if chart is not None and chart.canals:
        canals = chart.canals if ship is None else canals_with_dues(chart.canals, ship.file.hull)
        legs = _through_canals(track, chart, canals)
    if ship is not None and legs.canals:
        legs = _with_canal_parts(legs, track)
    if ship is not None and getattr(chart, "approaches", None) is not None:
        legs = _with_approach_legs(legs, track, chart, ship)  # type: ignore[arg-type]
    return legs


def _with_approach_legs(legs: CanalLegs, track: Track, chart: Chart, ship: Ship) -> CanalLegs:
    """Return the legs with those along approaches added."""
    assert chart.approaches is not None  # by the caller
    along = _needed_along_approaches(track, chart)
    part = part_number_of_legs(chart.canals, track.lat, track.lon)
    if (part >= 0).any():
        line = np.stack([track.lat, track.lon], axis=1)
        along[list(joints_to_canals(chart.canals, chart.approaches, part, line))] = True
    has_length = (np.diff(track.lat) != 0.0) | (np.diff(track.lon) != 0.0)  # else it has no speed
    found = np.flatnonzero(along & (legs.number < 0) & has_length)
    if not len(found):
        return legs
    more = [
        approach_leg(
            (track.lat[k], track.lon[k]),
            (track.lat[k + 1], track.lon[k + 1]),
            approach_speed(ship, int(track.setting[k])),
        )
        for k in found
    ]
    return _with_more_legs(legs, found, more)


def _needed_along_approaches(track: Track, chart: Chart) -> NDArray[np.bool_]:
    """Return which legs run along approaches that the track needs.

    These are those from its ends on, and on the way those over land of the chart: in open water a
    ship that passes a port, as in the Elbe after the Kiel Canal, keeps her speed.
    """
    assert chart.approaches is not None  # by the caller
    along = chart.approaches.legs(track.lat, track.lon)
    _add_joints(along, track, chart)
    at_ends = np.logical_and.accumulate(along) | np.logical_and.accumulate(along[::-1])[::-1]
    k = np.flatnonzero(along & ~at_ends)
    if len(k):
        legs = track.lat[k], track.lon[k], track.lat[k + 1], track.lon[k + 1]
        along[k] = chart.legs_blocked(*legs)
    return along


def _add_joints(along: NDArray[np.bool_], track: Track, chart: Chart) -> None:
    """Add the first and last leg where these join an approach that is followed, over water.

    They do at its place nearest to the end of the track.
    """
    assert chart.approaches is not None  # by the caller
    for leg, beside, end in ((0, 1, 0), (len(along) - 1, len(along) - 2, len(along))):
        if len(along) < 2 or along[leg] or not along[beside]:
            continue
        first, second = ((float(track.lat[k]), float(track.lon[k])) for k in (leg, leg + 1))
        length = float(distance(*first, *second))
        place = float(track.lat[end]), float(track.lon[end])
        near = chart.approaches.lines_near(*place, within=JOINED_WITHIN)
        if any(abs(length - apart) <= ON_LINE for _approach, _along, apart in near):
            along[leg] = not bool(chart.legs_blocked(*first, *second))


def _with_canal_parts(legs: CanalLegs, track: Track) -> CanalLegs:
    """Return the legs with those along parts of canals, by ships that enter them on the way."""
    part = part_number_of_legs(legs.canals, track.lat, track.lon)
    part[legs.number >= 0] = -1
    pays = first_legs_of_transits(part)
    found = np.flatnonzero(part >= 0)
    more = [
        _part_of_canal(legs.canals[part[k]], *track.positions[k : k + 2], pays=bool(pays[k]))
        for k in found.tolist()
    ]
    return _with_more_legs(legs, found, more)


def _part_of_canal(canal: Canal, start: Position, goal: Position, *, pays: bool) -> CanalPart:
    part = canal_part(canal, start, goal, pays=pays)
    return CanalPart(**{field.name: getattr(part, field.name) for field in fields(Canal)})


def _with_more_legs(legs: CanalLegs, found: NDArray[np.int64], more: Sequence[Canal]) -> CanalLegs:
    number = legs.number.copy()
    number[found] = len(legs.canals) + np.arange(len(found))
    return CanalLegs(number, (*legs.canals, *more), legs.backward)


def approach_speed(ship: Ship, setting: int) -> float:
    """Return the speed over ground in approaches [m/s] at a speed setting.

    Returns
    -------
    float : `Ship.approach_speed`, or the calm-water speed of the setting if that is lower.
    """
    return float(np.fmin(ship.approach_speed, np.asarray(ship.speeds, float)[setting]))


def approach_leg(start: Position, goal: Position, speed: float) -> ApproachLeg:
    """Return the leg of an approach between two positions [deg] at a speed [m/s]."""
    length = float(inverse(*start, *goal)[0])
    return ApproachLeg("approach", "approach", (start, goal), max(length / speed, 1e-3), 0.0)


def _through_canals(track: Track, chart: Chart, canals: tuple[Canal, ...]) -> CanalLegs:
    a, b, c, d = track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:]
    number = np.asarray(chart.canal_of_legs(a, b, c, d))
    backward = np.zeros(len(number), np.bool_)
    for leg in np.flatnonzero(number >= 0):
        first, last = canals[number[leg]].ends
        here = (track.lat[leg], track.lon[leg])
        backward[leg] = inverse(*here, *last)[0] < inverse(*here, *first)[0]
    return CanalLegs(number, canals, backward)


def sea_stretches(track: Track, chart: Chart | None) -> list[tuple[int, int]]:
    """Return (first waypoint, last waypoint) of the stretches of a track between canals.

    Returns
    -------
    list of (int, int)
    """
    number = canal_legs(track, chart).number
    edges = [
        0,
        *(int(k) for leg in np.flatnonzero(number >= 0) for k in (leg, leg + 1)),
        len(number),
    ]
    return [(a, b) for a, b in zip(edges[::2], edges[1::2]) if b > a]


def canal_ends(track: Track, chart: Chart | None) -> NDArray[np.bool_]:
    """Return which waypoints are ends of canal legs.

    Returns
    -------
    bool array (n,)
    """
    canal = canal_legs(track, chart).number >= 0
    return np.append(canal, False) | np.append(False, canal)


def canal_setting(ship: Ship, canal: Canal) -> int:
    """Return the slowest setting that reaches a canal's mean speed; the highest if none does.

    Returns
    -------
    int : From 0.
    """
    speeds = np.asarray(ship.speeds, float)
    fast = np.flatnonzero(speeds >= canal.length / canal.transit_time * (1.0 - 1e-9))
    return int(fast[0]) if len(fast) else len(speeds) - 1


def canal_rates(ship: Ship, canal: Canal) -> tuple[float, float]:
    """Return (brake power [W], fuel rate [kg/s]) of a ship in a canal; NaN where not known.

    Those of calm, deep water at the canal's setting. Ships whose speed is a field take their only
    one. In approaches they are those at the very speed, if the ship can be ordered to sail it.
    """
    setting = canal_setting(ship, canal)
    if isinstance(canal, ApproachLeg) and ship.speed_field is None:
        # the setting is used for a ship with one speed, or below its range
        with contextlib.suppress(ThalwegError):
            ship, setting = ship.with_speeds(canal.length / canal.transit_time), 0
    calm = {name: np.zeros(1) for name in ship.needs}
    calm |= {
        n: np.full(1, v) for n, v in ((WAVE_NORTH, 1.0), (WAVE_PERIOD, _WAVE_PERIOD)) if n in calm
    }
    lat, lon = canal.path[0]
    conditions = Conditions.from_sea(
        calm, heading=np.zeros(1), time=np.zeros(1), lat=lat, lon=lon, depth=_DEEP_WATER
    )
    power, fuel = ship.power_and_fuel(conditions, setting)
    return float(np.asarray(power).reshape(-1)[0]), float(np.asarray(fuel).reshape(-1)[0])
