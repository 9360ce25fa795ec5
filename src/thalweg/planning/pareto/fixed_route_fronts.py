"""Speed optimisation on fixed alternative routes (string-pulled).

The network of a front has to be coarse. Between islands and along borders of control areas the
shortest lines do not depend on the weather: they are found on a finer network and string-pulled,
and only their speeds and waits are optimised in the weather. Refinement starts from them as well.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from thalweg.core.interrupt import SearchInterrupted
from thalweg.network import (
    AlternativePath,
    EdgeWeights,
    Network,
    alternative_paths,
    fixed_route,
)
from thalweg.planning.network_selection.network_builder import LatticeBetween
from thalweg.planning.network_selection.route_alternatives import OPEN_SEA
from thalweg.planning.pareto.exploration import network_pareto_front
from thalweg.planning.pareto.front_points import track_from_front_point
from thalweg.planning.pareto.search_horizon import extend_horizon
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    TrackCandidate,
    TradeOffContext,
)

_MAX_ALTERNATIVES = 5
_MAX_DETOUR = 0.2  # excess of length or cost over the best
_LEGS_PER_ROUTE = 60  # between which the speed may change
_POINTS_PER_FRONT = 24


def fixed_route_candidates(
    trade_off: TradeOffContext, explored: Sequence[ExploredAlternative]
) -> list[TrackCandidate]:
    """Return candidates along fixed alternative routes, with their best speeds.

    None with via points, and none where the user chose a network or a resolution.

    Parameters
    ----------
    explored : Route alternatives, whose lattices are used again where they suit.
    """
    context = trade_off.context
    choice = context.choice
    own = choice.network not in ("auto", "lattice") or context.sea.mesh() is not None
    if own or choice.spacing is not None or trade_off.via:
        return []
    context.report_progress("finding alternative routes around land and control areas")
    known = (one.alternative.lattices for one in explored)
    lattices = next((one for one in known if one and one.chart is context.chart), None)
    if lattices is None:
        start, goal = ((end.lat, end.lon) for end in (trade_off.ends[0], trade_off.ends[-1]))
        lattices = LatticeBetween(context.chart, start, goal)
    network = lattices.network()
    if trade_off.interrupt_guard.stopped():
        return []
    candidates: list[TrackCandidate] = []
    for path in alternative_paths(
        network,
        context.chart,
        edge_weight_sets=_edge_weights(trade_off, network),
        most=_MAX_ALTERNATIVES,
        stretch=_MAX_DETOUR,
    ):
        if trade_off.interrupt_guard.stopped():
            break
        try:
            candidates += _speed_optimised(trade_off, path)
        except SearchInterrupted:
            break
    return candidates


def _edge_weights(trade_off: TradeOffContext, network: Network) -> list[EdgeWeights]:
    """Return weights of edges: lengths, and lengths with control areas and zones priced."""
    prices = trade_off.objective.prices
    ratio = prices.inside / prices.outside if prices.differs_in_control_areas else 1.0
    if ratio == 1.0 and not trade_off.context.chart.zones.price:
        return [EdgeWeights()]
    factors = sorted({math.sqrt(ratio), ratio})
    return [
        EdgeWeights(),
        *(EdgeWeights.priced(network, trade_off.context.chart, f) for f in factors),
    ]


def _speed_optimised(trade_off: TradeOffContext, path: AlternativePath) -> list[TrackCandidate]:
    """Return candidates along one path with the best speeds; none if none arrives in time."""
    context = trade_off.context
    network = fixed_route(
        context.chart, path.waypoints, spacing=max(path.length / _LEGS_PER_ROUTE, 1.0)
    )
    horizon = extend_horizon(trade_off, network)
    if not horizon.first.found or horizon.first.arrive > horizon.latest:
        return []
    found = network_pareto_front(
        trade_off, network, horizon.frozen, horizon.latest, refined=trade_off.is_refined
    )
    name = " and ".join(path.canals) or OPEN_SEA
    return [
        TrackCandidate(
            track_from_front_point(network, point), "alternative path", name, point.time, point.cost
        )
        for point in found.spread(_POINTS_PER_FRONT)
    ]
