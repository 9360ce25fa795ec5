"""Figures of paths on networks without the referee: time, fuel, comfort, land, waves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.network.assembly import measured_pairs
from thalweg.network.short_legs import positions_on_short_legs
from thalweg.planning.approach_sailing import ApproachSailing
from thalweg.planning.departures.path_consumption import consumed_by_paths, consumed_by_route
from thalweg.planning.departures.path_points import PathPoints, SailedPath, points_of_paths
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.filled_weather import has_fills, waves_are_filled
from thalweg.route.indicator_columns import (
    INSHORE_DISTANCE,
    LAND_DISTANCE_CAP,
    PERCENT_PER_DOSE,
)
from thalweg.ship import Ship
from thalweg.ship.comfort.onboard_motions import onboard_motions
from thalweg.ship.condition_variables import (
    EASTWARD_WIND,
    NORTHWARD_WIND,
    WAVE_EAST,
    WAVE_HEIGHT,
    WAVE_NORTH,
    WAVE_PERIOD,
)
from thalweg.ship.conditions import Conditions

_SHORE_SPACING: Final = 0.5 * NAUTICAL_MILE  #: between points whose distance to land is taken
_BLOCK: Final = 400  # points whose motions are computed together: their spectra fit in the cache
_WAVES: Final = (WAVE_HEIGHT, WAVE_PERIOD, WAVE_EAST, WAVE_NORTH)
_WIND: Final = (EASTWARD_WIND, NORTHWARD_WIND)


@dataclass(frozen=True)
class ApproachFigures:
    """What the approaches of the ports add to every route.

    Attributes
    ----------
    outward_s, inward_s : Time [s].
    length : [m].
    consumed : As `consumed_by_route`; empty without approaches.
    """

    outward_s: float
    inward_s: float
    length: float
    consumed: Mapping[str, float]


def approach_figures(sailing: ApproachSailing, context: PlanningContext) -> ApproachFigures:
    """Return the figures of the approaches at both ends; there is no weather in them."""
    times, length = [], 0.0
    consumed: dict[str, float] = {}
    for approach in (sailing.outward, sailing.inward):
        if approach is None or approach.length <= 1.0:
            times.append(0.0)
            continue
        route = sailing.sail(approach.line, context.voyage.earliest_departure, context)
        times.append(route.time_h * HOUR)
        length += route.distance_nm * NAUTICAL_MILE
        for name, value in consumed_by_route(route).items():
            consumed[name] = consumed.get(name, 0.0) + value
    return ApproachFigures(times[0], times[1], length, consumed)


@dataclass(frozen=True, eq=False)
class LandAlongLegs:
    """Land beside the legs of paths; each leg is looked up once.

    Attributes
    ----------
    chart : With a coastline, or unknown land.
    """

    chart: Chart
    _known: dict[bytes, tuple[float, float]] = field(default_factory=dict)

    def along(self, lat: FloatArray, lon: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the share that is inshore, and the least distance from land [m], of legs.

        Parameters
        ----------
        lat, lon : float64 array (legs, 2)
            Their ends [deg].
        """
        if not hasattr(self.chart, "coastline"):
            return np.full(len(lat), math.nan), np.full(len(lat), math.nan)
        legs, back = np.unique(np.concatenate([lat, lon], axis=1), axis=0, return_inverse=True)
        keys = [leg.tobytes() for leg in legs]
        new = [k for k, key in enumerate(keys) if key not in self._known]
        for k, found in zip(new, self._looked_up(legs[new])):
            self._known[keys[k]] = found
        values = np.array([self._known[key] for key in keys])[back.reshape(-1)]
        return values[:, 0], values[:, 1]

    def _looked_up(self, legs: FloatArray) -> list[tuple[float, float]]:
        if not len(legs):
            return []
        ends = legs[:, :2].ravel(), legs[:, 2:].ravel()
        first = np.arange(0, 2 * len(legs), 2, dtype=np.int32)
        pairs = measured_pairs(*ends, first, first + np.int32(1))
        pieces = np.maximum(2, np.ceil(pairs.length / _SHORE_SPACING)).astype(np.int64)
        leg = np.repeat(np.arange(len(legs)), pieces + 1)
        starts = np.cumsum(pieces + 1) - (pieces + 1)
        share = (np.arange(len(leg)) - starts[leg]) / pieces[leg]
        there = positions_on_short_legs(*ends, first[leg], first[leg] + 1, pairs.length[leg], share)
        shore = np.asarray(self.chart.coastline.shore_distance(*there, cap=LAND_DISTANCE_CAP))
        shore = np.minimum(shore, LAND_DISTANCE_CAP)
        near = (shore < INSHORE_DISTANCE) * np.where((share == 0.0) | (share == 1.0), 0.5, 1.0)
        inshore = np.add.reduceat(near, starts) / pieces
        return list(zip(inshore.tolist(), np.minimum.reduceat(shore, starts).tolist()))


def figures_of_paths(
    context: PlanningContext,
    paths: Sequence[SailedPath],
    approaches: ApproachFigures,
    land: LandAlongLegs,
) -> list[dict[str, Any]]:
    """Return the figures of paths.

    Fuel rates and motions are those at the middle of pieces of the legs, in the sea itself; fuel
    rates are from the table of the ship.

    Returns
    -------
    list of dict
        ``arrive``, ``time_h``, ``waiting_h``, ``distance_nm``, ``fuel_t``, ``fuel_eca_t``,
        ``co2_t``, ``cost_...`` with ``currency``, ``comfort`` [m2/s3] and ``sick_percent`` at the
        first place of the ship, ``inshore_nm``, ``inshore_percent``, ``inshore_h``,
        ``land_distance_nm`` (approaches left out),
        ``max_significant_wave_height_m``, ``max_wind_speed_ms``, and of a sea with fills
        ``waves_filled_percent``, the share of the way where waves are filled; None where unknown.
        ``feasible`` is true: the network keeps the limits.
    """
    if not paths:
        return []
    at = points_of_paths(paths)
    names = [n for n in (*_WAVES, *_WIND) if context.sea.provides(n)]
    names += [n for n in sorted(context.ship.needs) if n not in names and context.sea.provides(n)]
    sampled = context.sea.sample(names, at.time, at.lat, at.lon) if names else {}
    conditions = Conditions.from_sea(sampled, heading=at.course)
    waits = np.bincount(at.waits.path, at.waits.seconds, len(paths))
    consumed = consumed_by_paths(context, conditions, at)
    dose = at.sums(_dose_rate(context.ship, conditions, at), at.seconds)
    dose = np.where(waits > 0.0, math.nan, dose)  # motions of a ship that waits are not computed
    near, clearance = land.along(at.lat_of_legs, at.lon_of_legs)
    inshore = [np.bincount(at.path_of_legs, near * w, len(paths)) for w in at.weights_of_legs]
    length = at.sums(np.ones(len(at.lat)), at.length)
    columns = {
        "waiting_h": waits / HOUR,
        "distance_nm": (length + approaches.length) / NAUTICAL_MILE,
        **{name: own + approaches.consumed.get(name, 0.0) for name, own in consumed.items()},
        "comfort": dose,
        "sick_percent": np.minimum(PERCENT_PER_DOSE * np.sqrt(dose), 100.0),
        "inshore_nm": inshore[0] / NAUTICAL_MILE,
        "inshore_percent": 100.0 * inshore[0] / length,
        "inshore_h": inshore[1] / HOUR,
        "land_distance_nm": -_greatest(at.path_of_legs, -clearance, len(paths)) / NAUTICAL_MILE,
        "max_significant_wave_height_m": _greatest(at.path, sampled.get(WAVE_HEIGHT), len(paths)),
        "max_wind_speed_ms": _greatest(at.path, _wind_speed(sampled), len(paths)),
    }
    if WAVE_HEIGHT in sampled and has_fills(context.sea):
        filled = waves_are_filled(context.sea, at.time, at.lat, at.lon)
        columns["waves_filled_percent"] = 100.0 * at.sums(filled.astype(float), at.length) / length
    rows, currency = [], context.ship.fuel_terms.currency or "USD"
    for number, path in enumerate(paths):
        row: dict[str, Any] = {
            "arrive": format_time(path.arrive),
            "time_h": (path.arrive - path.depart) / HOUR,
        }
        values = {name: float(column[number]) for name, column in columns.items()}
        row |= {name: value if math.isfinite(value) else None for name, value in values.items()}
        rows.append(row | {"currency": currency, "feasible": True})
    return rows


def _greatest(path: IntArray, values: FloatArray | None, count: int) -> FloatArray:
    """Return the greatest value of each path, in ascending order; NaN where one is unknown."""
    if values is None:
        return np.full(count, math.nan)
    return np.asarray(np.maximum.reduceat(values, np.searchsorted(path, np.arange(count))))


def _wind_speed(sampled: Mapping[str, FloatArray]) -> FloatArray | None:
    known = all(name in sampled for name in _WIND)
    return np.hypot(*(sampled[name] for name in _WIND)) if known else None


def _dose_rate(ship: Ship, conditions: Conditions, at: PathPoints) -> FloatArray:
    """Return the squared weighted acceleration [m2/s4] at the first place; NaN if unknown."""
    own = onboard_motions(ship)
    rate = np.full(len(at.lat), math.nan)
    if own is None or not {"wave_angle", "wave_height", "wave_period"} <= set(conditions):
        return rate
    own = replace(own, places={own.first_place: own.places[own.first_place]}, tasks={})
    speed = at.length / at.seconds
    for begin in range(0, len(rate), _BLOCK):
        part = slice(begin, begin + _BLOCK)
        state = own.at(
            speed[part],
            wave_angle=conditions["wave_angle"][part],
            wave_height=conditions["wave_height"][part],
            wave_period=conditions["wave_period"][part],
        )
        rate[part] = np.asarray(state.places[own.first_place].weighted) ** 2
    return rate
