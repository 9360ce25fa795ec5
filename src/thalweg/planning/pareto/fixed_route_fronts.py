"""Ways round land and control areas, drawn taut, each with its own front of speeds.

The network of a front has to be coarse. Between islands and along borders of control areas the
best lines are known exactly without weather: they are found on a finer network, pulled taut, and
only their speeds and waits are searched, in the weather. Refinement goes on from them.
"""

from __future__ import annotations

import math

from thalweg.network import EdgeWeights, Network, alternative_paths, fixed_route
from thalweg.network.alternatives.alternative_path import AlternativePath as TautWay
from thalweg.planning.interrupt_guard import SearchInterrupted
from thalweg.planning.network_selection.network_choice import lattice_between
from thalweg.planning.pareto.exploration import network_pareto_front
from thalweg.planning.pareto.front_points import track_from_front_point
from thalweg.planning.pareto.search_horizon import extend_horizon
from thalweg.planning.pareto.trade_off_context import TrackCandidate, TradeOffContext

_MAX_ALTERNATIVES = 5  # ways round
_MAX_DETOUR = 0.2  # at most so much longer, or dearer, than the best
_LEGS_PER_ROUTE = 60  # of a way, between which the speed may change
_POINTS_PER_FRONT = 24  # of the front of each way


def fixed_route_candidates(trade_off: TradeOffContext) -> list[TrackCandidate]:
    """Return routes along the ways round between two ends, with their best speeds.

    Voyages by other places, and networks that are asked for by name, have none.
    """
    context = trade_off.context
    choice = context.choice
    own = choice.network not in ("auto", "lattice") or context.sea.mesh() is not None
    if own or choice.spacing is not None or trade_off.via:
        return []
    context.report_progress("drawing the ways round land and control areas")
    start, goal = ((end.lat, end.lon) for end in (trade_off.ends[0], trade_off.ends[-1]))
    network = lattice_between(context.chart, start, goal)
    found: list[TrackCandidate] = []
    for way in alternative_paths(
        network,
        context.chart,
        edge_weight_sets=_edge_weights(trade_off, network),
        most=_MAX_ALTERNATIVES,
        stretch=_MAX_DETOUR,
    ):
        try:
            found += _speed_optimised(trade_off, way)
        except SearchInterrupted:
            break
    return found


def _edge_weights(trade_off: TradeOffContext, network: Network) -> list[EdgeWeights]:
    """Return lengths, and lengths with what control areas and zones cost, in full and by half."""
    prices = trade_off.objective.prices
    ratio = prices.inside / prices.outside if prices.differs_in_control_areas else 1.0
    if ratio == 1.0 and not trade_off.context.chart.zones.price:
        return [EdgeWeights()]
    factors = sorted({math.sqrt(ratio), ratio})
    return [
        EdgeWeights(),
        *(EdgeWeights.priced(network, trade_off.context.chart, f) for f in factors),
    ]


def _speed_optimised(trade_off: TradeOffContext, way: TautWay) -> list[TrackCandidate]:
    """Return routes along one way with the best speeds; none if it cannot be sailed in time."""
    context = trade_off.context
    network = fixed_route(
        context.chart, way.waypoints, spacing=max(way.length / _LEGS_PER_ROUTE, 1.0)
    )
    ahead = extend_horizon(trade_off, network)
    if not ahead.first.found or ahead.first.arrive > ahead.latest:
        return []
    found = network_pareto_front(trade_off, network, ahead.frozen, ahead.latest, lower=False)
    name = " and ".join(way.canals) or "open sea"
    return [
        TrackCandidate(
            track_from_front_point(network, point), "way round", name, point.time, point.cost
        )
        for point in found.spread(_POINTS_PER_FRONT)
    ]
