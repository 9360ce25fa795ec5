"""The referee: re-sails any track in small steps with the ship's own formulas.

No tables, no network, no frozen fields: what it says about time, distance, fuel and clearance is
what gets published. Its own error is told with every route.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.geodesy import FloatArray
from thalweg.core.time import TimeLike, parse_time
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.route.limits import (
    broken_limits,
    coverage_error,
    is_gap,
    land_violations,
    stops,
)
from thalweg.route.passage_times import Passage, find_times
from thalweg.route.physics import Motion, World, conditions_at, look, move, open_world
from thalweg.route.pieces import IntArray, Pieces, Points, cut
from thalweg.route.route import Route, Violation
from thalweg.route.track import Track

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

Routable: TypeAlias = "Track | Route | str | Path | Iterable[Sequence[float]]"

LEAST_PIECES = 8  #: of every leg
LARGEST_STEP = 0.5 * NAUTICAL_MILE  #: [m]
MOST_PIECES = 2000  #: of a route at the coarser of its two step sizes (besides `LEAST_PIECES`)
MOST_LOOKS = 10_000  #: points at which limits are looked at besides (fewer on coarse data)
LOOKS_PER_CELL = 8  #: of gridded data
_METRES_PER_DEGREE = 111_000.0
_WAIT_LOOKS = 300.0  # longest time between two looks at the depth while waiting [s]


def evaluate(
    route: Routable,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    depart: TimeLike | None = None,
    min_ukc: float | None = 0.0,
    step: float | None = None,
    load_factor: float | None = None,
    speed_kn: float | None = None,
    strict: bool = True,
) -> Route:
    """Sail a route in small steps with the ship's own formulas, and check every limit.

    Parameters
    ----------
    route : Track, Route, path, or iterable of (lat, lon)
        What to sail along geodesics of WGS 84. Files are CSV, GeoJSON or GPX.
    ship : Ship
    sea : Sea
    chart : Chart, optional
        Land, zones and charted depth; without one they are not checked, which is told.
    depart : time, optional
        Departure; needed unless the track or the file tells it.
    min_ukc : float or None
        Least under-keel clearance [m], checked wherever the chart or the sea tells depth;
        None: not checked.
    step : float, optional
        Length of a piece [m]. By default the least of an eighth of the leg, half a nautical mile
        and a quarter of the spacing of the data, but not below 1/2000 of the route.
    load_factor : float, optional
        0 empty to 1 full; by default as the ship is loaded.
    speed_kn : float, optional
        Ordered calm-water speed on every leg [kn]; by default the track's own settings, and the
        ship's highest for positions and files.
    strict : bool
        Raise if the data end before the route does. Otherwise that is listed among the violations
        and the totals are NaN.

    Returns
    -------
    Route

    Raises
    ------
    CoverageError
        If strict and the route runs where or when a variable that is needed is not known.
    MissingVariableError
        If the ship needs a variable that the sea does not hold.
    InputError
        If the route cannot be read, there is no departure, or a setting does not exist.

    Notes
    -----
    The time of passage solves ``dT/ds = 1 / SOG(s, T)`` by the two-stage Gauss method (order 4 in
    smooth fields, 2 across the kinks of gridded data), first with pieces of ``step``, then of half
    that; the second is what is told and the difference is its ``tolerance_s``. Limits are looked at
    more closely, at up to 10,000 places; for a route that waits, the time between two of them is
    part of the tolerance, as its waits can be that much too short. Wind acts relative
    to the moving water, weather at angles from the heading. Waiting costs time but no fuel, and
    the ship does not drift (it lies at anchor); only its clearance is checked meanwhile, and
    not at the first waypoint, where it lies at its berth. Without currents in the sea (no such
    variable at all) still water is assumed, which is told.
    """
    ship = ship if load_factor is None else ship.with_load_factor(load_factor)
    ship, track = _order(ship, as_track(route, depart), speed_kn)
    world = open_world(ship, sea, chart)
    step = _default_step(world, track) if step is None else _checked_step(step)
    coarse = _sail(world, track, step, LEAST_PIECES, None)
    fine = _sail(world, track, 0.5 * step, 2 * LEAST_PIECES, coarse)
    result = _report(fine, min_ukc, abs(_arrival(fine) - _arrival(coarse)))
    if strict and not math.isfinite(result.arrive):
        gaps = [violation for violation in result.violations if is_gap(violation)]
        if gaps:
            raise coverage_error(gaps[-1])
    return result


def as_track(route: Routable, depart: TimeLike | None = None) -> Track:
    """Return the track of a route, a file or positions, with the departure if one is given.

    Raises
    ------
    InputError
        If it cannot be read or nothing tells the departure.
    """
    if isinstance(route, Route):
        route = route.track
    if isinstance(route, (str, Path)):
        from thalweg.route.formats import read_track

        route = read_track(route, depart=depart)
    if isinstance(route, Track):
        return route if depart is None else route.replaced(depart=parse_time(depart))
    if depart is None:
        raise InputError(
            "The route has no departure.",
            "A list of positions tells no times.",
            "Give depart, such as 2026-01-01T06:00Z.",
            field="depart",
        )
    return Track.from_positions(route, depart=depart)


@dataclass(frozen=True)
class _Sailed:
    """A track, cut and sailed at one step size."""

    world: World
    pieces: Pieces
    gauss: Points
    passage: Passage


def _order(ship: Ship, track: Track, speed_kn: float | None) -> tuple[Ship, Track]:
    """Return the ship and track with every setting an index from the bottom."""
    if speed_kn is not None:
        ship = ship.with_speeds([speed_kn * KNOT])
        return ship, track.replaced(setting=np.zeros(len(track) - 1, dtype=np.int64))
    count = len(ship.speeds)
    setting = np.where(track.setting < 0, track.setting + count, track.setting)
    if np.any((setting < 0) | (setting >= count)):
        raise InputError(
            f"The track asks for a speed setting that {ship.name!r} does not have.",
            f"It has {count} settings, 0 to {count - 1}.",
            "Give the settings of this ship, or an ordered speed.",
        )
    return ship, track.replaced(setting=setting)


def _checked_step(step: float) -> float:
    if not (math.isfinite(step) and step > 0.0):
        raise InputError(
            f"A step of {step!r} m cannot be used.", "It is a length above zero.", "Leave it out."
        )
    return float(step)


def _default_step(world: World, track: Track) -> float:
    spacings = _spacings(world, 0.25)
    total = float(track.lengths.sum())
    return max(min([LARGEST_STEP, *spacings]), total / MOST_PIECES, 1e-3)


def _sail(world: World, track: Track, step: float, least: int, coarse: _Sailed | None) -> _Sailed:
    """Cut and sail a track; a coarser answer gives the first guess."""
    pieces = cut(track, step, least)
    gauss = _with_charted(world, pieces.gauss_points(), pieces)

    def slowness(
        first: int, last: int, time: FloatArray, guess: FloatArray | None
    ) -> tuple[FloatArray, FloatArray]:
        motion = move(world, gauss.part(slice(first, last)), time, guess)
        return 1.0 / motion.over_ground, motion.through_water

    passage = find_times(
        slowness,
        step=pieces.step,
        wait=pieces.wait,
        depart=track.depart + float(track.wait[0]),
        guess=_first_guess(world, pieces, coarse),
    )
    return _Sailed(world, pieces, gauss, passage)


def _first_guess(world: World, pieces: Pieces, coarse: _Sailed | None) -> FloatArray:
    """Return a slowness to begin with at the Gauss points of every piece [s/m]."""
    if coarse is not None:
        middle = pieces.start + 0.5 * pieces.step
        ends = np.cumsum(np.bincount(coarse.pieces.leg))
        first = np.concatenate([[0], ends[:-1]])[pieces.leg]
        nearest = first + (middle / coarse.pieces.step[first]).astype(np.int64)
        mean = coarse.passage.slowness.mean(axis=1)
        return np.repeat(mean[np.minimum(nearest, ends[pieces.leg] - 1), None], 2, axis=1)
    speeds = world.ship.speeds[pieces.track.setting[pieces.leg]]
    usual = np.where(np.isfinite(speeds) & (speeds > 0.0), speeds, 5.0)
    return np.repeat(1.0 / usual[:, None], 2, axis=1)


def _with_charted(world: World, points: Points, pieces: Pieces) -> Points:
    """Return the points with the least charted depth of the piece each lies on."""
    if not world.charted:
        return points
    depth = _charted(world, pieces)
    count = len(pieces)
    if len(points) == 2 * count:
        return replace(points, charted=np.repeat(depth, 2))
    return replace(points, charted=np.concatenate([depth, depth[pieces.last_of_leg()]]))


def _charted(world: World, pieces: Pieces) -> FloatArray:
    """Return the least charted depth along every piece [m below datum]."""
    low = pieces.points(pieces.leg, pieces.start)
    high = pieces.points(pieces.leg, pieces.start + pieces.step)
    depth = world.chart.depth_along(low.lat, low.lon, high.lat, high.lon)  # type: ignore[union-attr]
    return np.asarray(depth, dtype=np.float64)


def _arrival(sailed: _Sailed) -> float:
    """Return the arrival [s]; NaN if the ship does not get there."""
    passage = sailed.passage
    return float(passage.start[-1]) if passage.first_bad == len(sailed.pieces) else math.nan


def _report(sailed: _Sailed, min_ukc: float | None, tolerance: float) -> Route:
    """Look at every point once more, check the limits and put the route together."""
    world, pieces, passage = sailed.world, sailed.pieces, sailed.passage
    track = pieces.track
    points, time, order = _all_points(sailed)
    looked_at = np.where(np.isfinite(time), time, track.depart)
    motion = move(world, points, looked_at)
    near, moments = _looks(sailed, points, time)
    sampled, depth = look(world, near, np.where(np.isfinite(moments), moments, track.depart))
    violations = broken_limits(world, near, moments, sampled=sampled, depth=depth, min_ukc=min_ukc)
    violations += stops(world, points, time, motion)
    violations += _grounded_waits(sailed, min_ukc)
    departs, arrives = _leg_times(sailed)
    violations += land_violations(world, track, departs)
    violations.sort(key=lambda item: item.time if math.isfinite(item.time) else math.inf)
    rate = _fuel_rate(world, points, looked_at, motion)
    clearance = _finite(motion.depth - world.ship.draught)
    least = _leg_least(near.leg, _finite(depth - world.ship.draught), moments, len(departs))
    fuel = _leg_fuel(pieces, passage, rate[order])
    samples: dict[str, FloatArray] = {
        **motion.sampled,
        "time": time,
        "leg": points.leg,  # type: ignore[dict-item]
        "lat": points.lat,
        "lon": points.lon,
        "distance": np.concatenate([[0.0], np.cumsum(pieces.length)])[points.leg] + points.along,
        "course": points.course,
        "heading": motion.heading,
        "speed_through_water": motion.through_water,
        "speed_over_ground": motion.over_ground,
        "depth": _finite(motion.depth),
        "under_keel_clearance": clearance,
        "fuel_rate": rate,
    }
    unreached = ~np.isfinite(time)
    for name, values in samples.items():
        if name not in ("leg", "lat", "lon", "distance", "course"):
            samples[name] = np.where(unreached, math.nan, values)
    legs = {
        "length": pieces.length,
        "course": pieces.course,
        "depart": departs,
        "arrive": arrives,
        "fuel": fuel,
        "under_keel_clearance": least,
    }
    if np.any(track.wait) and world.has_depth:
        tolerance += float(np.max(np.diff(moments), initial=0.0, where=np.diff(near.leg) == 0))
    return Route(track, legs, samples, tuple(violations), tolerance, world.assumptions)


def _all_points(sailed: _Sailed) -> tuple[Points, FloatArray, IntArray]:
    """Return all points in the order of sailing, their times, and where the Gauss points are."""
    pieces, passage = sailed.pieces, sailed.passage
    ends = _with_charted(sailed.world, pieces.ends(), pieces)
    last = pieces.last_of_leg()
    arrive = passage.start[1:][last] - pieces.wait[last]
    fields = ("lat", "lon", "course", "setting", "leg", "along", "charted")
    both = Points(*(np.concatenate([getattr(sailed.gauss, f), getattr(ends, f)]) for f in fields))
    time = np.concatenate([passage.inside.reshape(-1), passage.start[:-1], arrive])
    stop = passage.first_bad
    if stop < len(pieces):
        time[time > passage.inside[stop, int(np.argmax(passage.bad[stop]))]] = math.nan
    order = np.lexsort((both.along, both.leg))
    place = np.empty(len(both), dtype=np.int64)
    place[order] = np.arange(len(both))
    return both.part(order), time[order], place[: len(sailed.gauss)]


def _leg_times(sailed: _Sailed) -> tuple[FloatArray, FloatArray]:
    """Return when each leg is begun and ended [s]; NaN from where the ship cannot go on."""
    passage, last = sailed.passage, sailed.pieces.last_of_leg()
    first = np.concatenate([[True], last[:-1]])
    depart = passage.start[:-1][first]
    arrive = passage.start[1:][last] - sailed.pieces.wait[last]
    stuck = sailed.pieces.leg[passage.first_bad] if passage.first_bad < len(last) else len(depart)
    legs = np.arange(len(depart))
    return np.where(legs <= stuck, depart, math.nan), np.where(legs < stuck, arrive, math.nan)


def _fuel_rate(world: World, points: Points, time: FloatArray, motion: Motion) -> FloatArray:
    """Return the fuel rate [kg/s] at points; NaN where the ship has no fuel model."""
    here = conditions_at(
        world,
        points,
        time,
        sampled=motion.sampled,
        depth=motion.depth,
        heading=motion.heading,
    )
    rate = world.ship.fuel_rate(here, points.setting)
    return np.array(np.broadcast_to(rate, len(points)), dtype=float)


def _leg_fuel(pieces: Pieces, passage: Passage, rate: FloatArray) -> FloatArray:
    """Return the fuel of each leg [kg]: rate times slowness, integrated over the pieces."""
    burnt = 0.5 * pieces.step * (rate.reshape(-1, 2) * passage.slowness).sum(axis=1)
    if passage.first_bad < len(pieces):
        burnt[passage.first_bad :] = math.nan
    total = np.bincount(pieces.leg, weights=burnt, minlength=len(pieces.length))
    return total.astype(np.float64)


def _leg_least(leg: IntArray, values: FloatArray, time: FloatArray, count: int) -> FloatArray:
    """Return the least known value on each leg as far as it is sailed; NaN where none is known."""
    least = np.full(count, math.inf)
    known = np.isfinite(values) & np.isfinite(time)
    np.minimum.at(least, leg[known], values[known])
    return np.where(np.isfinite(least), least, math.nan)


def _looks(sailed: _Sailed, points: Points, time: FloatArray) -> tuple[Points, FloatArray]:
    """Return closely spaced points where limits are looked at, and when they are passed."""
    world, pieces = sailed.world, sailed.pieces
    spacing = float(pieces.length.sum()) / MOST_LOOKS
    spacing = max(spacing, min(_spacings(world, 1.0 / LOOKS_PER_CELL), default=0.0))
    count = np.maximum(np.ceil(pieces.length / max(spacing, 1e-3)).astype(np.int64), 1) + 1
    leg = np.repeat(np.arange(len(count)), count)
    share = (np.arange(len(leg)) - np.repeat(np.cumsum(count) - count, count)) / (count[leg] - 1)
    near = pieces.points(leg, share * pieces.length[leg])
    step = np.zeros(len(pieces.length))
    step[pieces.leg] = pieces.step
    first = np.searchsorted(pieces.leg, leg)
    last = np.searchsorted(pieces.leg, leg, side="right") - 1
    with np.errstate(invalid="ignore", divide="ignore"):
        number = np.where(step[leg] > 0.0, near.along / step[leg], 0.0).astype(np.int64)
    if world.charted:
        charted = _charted(world, pieces)[np.minimum(first + number, last)]
        near = replace(near, charted=charted)
    key = _key(points.leg, points.along, pieces.length)
    return near, np.interp(_key(leg, near.along, pieces.length), key, time)


def _key(leg: IntArray, along: FloatArray, length: FloatArray) -> FloatArray:
    """Return a number that grows along the track, with a step between legs."""
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(length[leg] > 0.0, along / length[leg], 0.0)
    return leg * 2.0 + np.clip(share, 0.0, 1.0)


def _spacings(world: World, share: float) -> list[float]:
    """Return a share of the spacing of every source of data that is looked at [m]."""
    return [
        row.spacing_deg * _METRES_PER_DEGREE * share
        for row in world.sea.coverage()
        if row.variable in world.names and row.spacing_deg
    ]


def _finite(values: FloatArray) -> FloatArray:
    return np.where(np.isfinite(values), values, math.nan)


def _grounded_waits(sailed: _Sailed, min_ukc: float | None) -> list[Violation]:
    """Return the waits during which there is too little water."""
    world, track = sailed.world, sailed.pieces.track
    waits = np.flatnonzero(track.wait[1:-1]) + 1
    if min_ukc is None or not world.has_depth or not len(waits):
        return []
    _, arrive = _leg_times(sailed)
    found = []
    for index in waits:
        if not math.isfinite(arrive[index - 1]):
            continue
        count = 2 + int(track.wait[index] / _WAIT_LOOKS)
        time = arrive[index - 1] + np.linspace(0.0, track.wait[index], count)
        points = _still(world, track, int(index), count)
        _, depth = look(world, points, time)
        clearance = depth - world.ship.draught
        worst = int(np.argmin(clearance))
        if not clearance[worst] >= min_ukc - 1e-9:
            place = (float(track.lat[index]), float(track.lon[index]))
            value = float(clearance[worst])
            reason = "under-keel clearance" if math.isfinite(value) else "no data: depth"
            found.append(
                Violation(f"{reason} (waiting)", float(time[worst]), *place, value, min_ukc)
            )
    return found


def _still(world: World, track: Track, index: int, count: int) -> Points:
    """Return one waypoint, several times."""
    lat, lon = np.full(count, track.lat[index]), np.full(count, track.lon[index])
    charted = np.full(count, math.inf)
    if world.charted and world.chart is not None:
        charted[:] = np.asarray(world.chart.depth_at(track.lat[index], track.lon[index]), float)
    zero = np.zeros(count, dtype=np.int64)
    return Points(lat, lon, np.zeros(count), zero, zero, np.zeros(count), charted)
