"""Waits of the routes of a front in weather within the limits of the ship."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import HOUR
from thalweg.planning.pareto.trade_off_context import WORTH_OF_SHELTER
from thalweg.planning.pareto.waiting.wait_screening import WaitScreen
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.waiting_report import waiting_weather_warnings
from thalweg.route import Route, Track

_MOST_LATER: Final = 0.3  # share of the time by which a route with other waits may arrive later
_MOST_PLACES: Final = 16  # waypoints at which a wait is tried
_AT_BERTH: Final = (1.0, 0.75, 0.5, 0.25, 0.0)  # shares of the wait that are spent at the berth
#: By how much all waits together may be longer or shorter [h].
_CHANGES: Final = (0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 4.0, -4.0, 6.0, -6.0)
_SAMPLES: Final = 13  # of the weather in a wait
_MOST_EVALUATED, _MOST_ALIKE = 6, 2  # by the referee, of all and of each sum of waits


def with_waits_in_shelter(
    route: Route,
    score: Callable[[Track], Route],
    value: Callable[[Route], float],
    context: PlanningContext,
    screen: WaitScreen,
) -> Route:
    """Return a route that waits at the berth and where the weather is within the limits.

    Parameters
    ----------
    route : As evaluated; it waits at sea in weather above the limits, or where it is unknown.
    score : Evaluates a track.
    value : Of a route, to be small.
    screen : Chooses the waits that are evaluated.

    Returns
    -------
    Route
        The same line and speeds with one wait at the berth and one at most under way. The given
        route where that takes over 30 % or costs over half more, no such waits keep the limits, or
        the sea is an ensemble.
    """
    if context.sea.members:  # each has other weather in a wait
        return route
    longest = (1.0 + _MOST_LATER) * route.time_h * HOUR
    latest = min(route.depart + longest, context.latest_arrival + 1.0)
    most = (1.0 + WORTH_OF_SHELTER) * value(route)
    track, places = route.track, _places(context, route.track)
    waits = np.array([row for place in places for row in _waits_at(track, place)])
    place = np.array([place for place in places for _ in _waits_at(track, place)])
    found = screen.screened(track, waits)
    may_keep = found.may_keep & (found.arrive[:, len(track) - 1] <= latest + HOUR)
    rows = np.arange(len(waits))
    begin, lasting = found.arrive[rows, place], waits[rows, place]
    sheltered = is_sheltered(context, track.lat[place], track.lon[place], begin, lasting)
    may_keep &= sheltered | (place == 0) | (lasting <= 0.0)
    rows = np.flatnonzero(may_keep)
    for row in _chosen(rows[np.argsort(found.cost[rows], kind="stable")], waits):
        tried = score(track.replaced(wait=waits[row]))
        if not tried.feasible or tried.arrive > latest or value(tried) > most:
            continue
        if not waiting_weather_warnings(tried, context.ship):
            return tried
    return route


def _places(context: PlanningContext, track: Track) -> list[int]:
    """Return the waypoints at which a wait is tried; the first is the berth."""
    last = int(np.flatnonzero(track.wait)[-1])
    places = np.unique(np.linspace(0, last, min(last + 1, _MOST_PLACES)).astype(int))
    may_wait = context.chart.zones.may_wait(track.lat[places], track.lon[places])
    return places[np.asarray(may_wait) | (places == 0)].tolist()


def _waits_at(track: Track, place: int) -> Iterator[FloatArray]:
    """Yield waits [s] at the waypoints of a track: a part at the berth, the rest at one place."""
    total = float(np.sum(track.wait))
    for share in _AT_BERTH[1:] if place else (1.0,):
        for hours in _CHANGES:
            together = total + hours * HOUR
            if together > 0.0:
                wait = np.zeros(len(track))
                wait[0] = share * together
                wait[place] += (1.0 - share) * together
                yield wait


def _chosen(rows: NDArray[np.int64], waits: FloatArray) -> list[int]:
    """Return the first rows, at most two of each sum of waits: what closes one closes others."""
    chosen: list[int] = []
    sums: list[int] = []
    for row in rows.tolist():
        total = round(float(waits[row].sum()))
        if sums.count(total) < _MOST_ALIKE:
            chosen.append(row)
            sums.append(total)
    return chosen[:_MOST_EVALUATED]


def is_sheltered(
    context: PlanningContext,
    lat: FloatArray,
    lon: FloatArray,
    begin: FloatArray,
    lasting: FloatArray,
) -> BoolArray:
    """Return which waits are in known waves and wind within the limits of the ship.

    Parameters
    ----------
    lat, lon : Positions [deg].
    begin, lasting : Begin of each wait [s since 1970-01-01T00:00Z] and its length [s].
    """
    sea, limits = context.sea, context.ship.limits
    time = begin[:, None] + lasting[:, None] * np.linspace(0.0, 1.0, _SAMPLES)
    place = lat[:, None], lon[:, None]
    if not all(sea.provides(name) for name in limits.limited_weather):
        return np.zeros(len(lat), bool)
    kept = limits.keeps_weather_limits(sea.sample(limits.limited_weather, time, *place))
    return np.asarray(np.broadcast_to(kept, time.shape).all(axis=1))
