"""Candidates of a front that wait once, at the start, and sail on at one speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from thalweg.network import Network, fixed_route
from thalweg.planning.pareto.search_horizon import (
    SearchHorizon,
    extend_horizon,
    fastest_path,
    ship_on_network,
)
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    TrackCandidate,
    TradeOffContext,
    spread_settings,
)
from thalweg.planning.pareto.waiting.waits_in_shelter import is_sheltered
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.waiting_report import LEAST_WAIT_H
from thalweg.planning.single.late_paths import waiting_at_berth
from thalweg.planning.single.route_candidates import track_from_result
from thalweg.route import Route, Track
from thalweg.search import SearchResult
from thalweg.search.earliest_arrival import ArrivalQuery
from thalweg.search.latest_departure import departures_without_waits, latest_departure

_MOST_SETTINGS: Final = 8
_EDGES: Final = 60  # of a line
_MOST_DEPARTURES: Final = 30  # at each speed
_LONG_WAIT: Final = 1800.0  # of a path, for which later departures are tried [s]
_LATER: Final = 30.0  # than the earliest arrival at a speed [s]
_STEP, _STEPS = 3600.0, 12  # of later arrivals [s]: half a day, as tides


def one_wait_candidates(
    trade_off: TradeOffContext, explored: Sequence[ExploredAlternative]
) -> list[TrackCandidate]:
    """Return candidates at each speed that leave as late as arrives first, on known lines.

    Where a ship has to wait for a tide or a storm, a front over time bins has the paths that wait
    least; between them a lower speed held throughout may be cheaper and as early.

    Parameters
    ----------
    explored : Alternatives; on the lines of the fastest routes that wait, and on the networks of
        those where paths wait under way in weather above the limits.
    """
    context = trade_off.context
    if not (context.voyage.wait and trade_off.is_refined) or len(trade_off.settings) < 2:
        return []
    found = []
    for one in explored:
        if trade_off.interrupt_guard.stopped():
            break
        if _waits_in_weather(context, one):
            found += _leaving_later(trade_off, one)
        if not one.fastest.feasible or one.fastest.waiting_h <= LEAST_WAIT_H:
            continue
        network = _network_of(trade_off, one.fastest)
        horizon = extend_horizon(trade_off, network)
        for setting in spread_settings(trade_off.settings, _MOST_SETTINGS).tolist():
            found += [
                TrackCandidate(track, "one wait", one.alternative.name, math.nan, math.nan)
                for track in _waiting_once(trade_off, network, horizon, setting)
            ]
    return found


def _waits_in_weather(context: PlanningContext, one: ExploredAlternative) -> bool:
    """Return whether paths of the front wait under way in weather above the limits, or unknown."""
    points = one.exact.points if one.exact and not context.sea.members else ()
    rows = [np.zeros((0, 3))]
    for point in points:
        lasting = (point.path_depart - point.path_arrive)[1:-1]
        long = np.flatnonzero(lasting > _LONG_WAIT) + 1
        rows.append(np.stack([point.path[long], point.path_arrive[long], lasting[long - 1]], -1))
    node, begin, lasting = np.unique(np.concatenate(rows), axis=0).T
    network, node = one.alternative.network, node.astype(np.int64)
    sheltered = is_sheltered(context, network.lat[node], network.lon[node], begin, lasting)
    return not bool(sheltered.all())


def _leaving_later(trade_off: TradeOffContext, one: ExploredAlternative) -> list[TrackCandidate]:
    """Return candidates that wait at the berth only, on the network of an alternative."""
    context, network = trade_off.context, one.alternative.network
    meta, depart = network.meta, context.voyage.earliest_departure
    last = min(context.latest_arrival, float(one.frozen.stations.times[-1]))
    query = ArrivalQuery(meta.start, meta.goal, depart)
    found = []
    for setting in spread_settings(trade_off.settings, _MOST_SETTINGS).tolist():
        ship = ship_on_network(trade_off, network, one.frozen, setting)
        results = departures_without_waits(ship, query, last, _MOST_DEPARTURES)
        tracks = [
            track_from_result(network, result, setting) for result in _first_and_shortest(results)
        ]
        found += [
            TrackCandidate(
                waiting_at_berth(track, depart),
                "one wait",
                one.alternative.name,
                math.nan,
                math.nan,
            )
            for track in tracks
        ]
    return found


def _first_and_shortest(results: list[SearchResult]) -> list[SearchResult]:
    """Return the first of some results, and that with the shortest time of the others."""
    return [*results[:1], *sorted(results[1:], key=lambda result: result.duration)[:1]]


def _network_of(trade_off: TradeOffContext, route: Route) -> Network:
    """Return the line of a route as a network."""
    lat, lon = np.asarray(route.track.lat), np.asarray(route.track.lon)
    moves = np.append(True, np.asarray(route.legs["length"]) > 1.0)
    spacing = max(float(np.sum(route.legs["length"])) / _EDGES, 1.0)
    line = list(zip(lat[moves].tolist(), lon[moves].tolist(), strict=True))
    return fixed_route(trade_off.context.chart, line, spacing=spacing)


def _waiting_once(
    trade_off: TradeOffContext, network: Network, horizon: SearchHorizon, setting: int
) -> list[Track]:
    """Return the tracks of the latest departures at a setting.

    One arrives first, the other is least under way: a later tide may carry the ship.
    """
    context, meta = trade_off.context, network.meta
    depart = context.voyage.earliest_departure
    first = fastest_path(trade_off, network, horizon.frozen, setting)
    last = min(context.latest_arrival, horizon.latest) + 1.0
    if not first.found or first.arrive > last:
        return []
    ship = ship_on_network(trade_off, network, horizon.frozen, setting)
    query = ArrivalQuery(meta.start, meta.goal, depart, wait=True)
    arrivals = first.arrive + np.append(_LATER, _STEP * np.arange(1, _STEPS + 1))
    later = [latest_departure(ship, query, float(by)) for by in arrivals if by <= last]
    found = [later[0] if later and later[0] else first, *filter(None, later[1:])]
    shortest = min(found, key=lambda result: result.duration - result.waiting)
    chosen = [found[0]]
    if shortest.duration - shortest.waiting < found[0].duration - found[0].waiting - _LATER:
        chosen.append(shortest)
    if any(result.waiting > _LATER for result in chosen):  # at sea, perhaps above her limits
        chosen += _first_and_shortest(departures_without_waits(ship, query, last))
    return [
        waiting_at_berth(track_from_result(network, result, setting), depart) for result in chosen
    ]
