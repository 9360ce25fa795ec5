"""The least fuel, cost or CO2 at one speed: one refinement of the cheapest path of the network."""

from __future__ import annotations

import numpy as np

from thalweg.core.units import HOUR
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    TrackCandidate,
    TradeOffContext,
)
from thalweg.planning.single.route_candidates import refine_track
from thalweg.route import RefinementConditions, Route, Track
from thalweg.route.refinement.cost_refinement import refine_cost

_REFINED_OBJECTIVES = ("fuel", "cost", "co2")
_LONGEST = 1.5  # of the refined routes, in multiples of the least time
_EQUAL_RATES = 1e-9  # relative


def has_single_speed(trade_off: TradeOffContext) -> bool:
    """Return whether one route is wanted at one speed, at prices that are the same everywhere."""
    return (
        len(trade_off.settings) == 1
        and trade_off.context.voyage.objective in _REFINED_OBJECTIVES
        and not trade_off.objective.prices.differs_in_control_areas
    )


def refined_cheapest(
    trade_off: TradeOffContext, one: ExploredAlternative, candidates: list[TrackCandidate]
) -> list[TrackCandidate]:
    """Return the cheapest candidate of a route alternative, refined; none without candidates.

    Where the rate of fuel is the same everywhere, the cheapest route is the fastest.
    """
    if not candidates:
        return []
    context, terms = trade_off.context, trade_off.objective.terms
    track = min(candidates, key=lambda item: item.value).track
    if _rate_is_constant(one.fastest):
        refined = refine_track(context, track, trade_off.limits)
    else:
        refined = _refined(trade_off, one, track)
    priced = context.evaluate(refined.track, terms)
    value, name = trade_off.objective.value(priced), one.alternative.name
    return [TrackCandidate(priced.track, "refined", name, priced.time_h * HOUR, value)]


def _refined(trade_off: TradeOffContext, one: ExploredAlternative, track: Track) -> Route:
    context, terms = trade_off.context, trade_off.objective.terms
    context.report_progress(f"refining the route: {one.alternative.name}")
    longest = one.fastest.depart + _LONGEST * (one.fastest.arrive - one.fastest.depart)
    route = context.evaluate(track, terms)
    return refined_in_open_water(trade_off, route, arrive_by=longest)


def refined_in_open_water(
    trade_off: TradeOffContext, route: Route, *, arrive_by: float | None = None
) -> Route:
    """Return a route of a network, refined between its obstacles for its objective.

    Parameters
    ----------
    trade_off : Its objective is fuel, cost or CO2.
    route : Scored by the referee.
    arrive_by : Latest arrival [s since 1970]; by default when the route arrives.

    Returns
    -------
    Route : No worse than the given one; waits and canals do not change.
    """
    context, objective = trade_off.context, trade_off.objective
    latest = route.arrive if arrive_by is None else arrive_by
    return refine_cost(
        route,
        RefinementConditions(
            context.ship,
            context.sea,
            context.chart,
            context.table,
            trade_off.limits,
            context.min_ukc,
            holds_settings=len(trade_off.settings) == 1,
        ),
        fuel=trade_off.consumption,
        objective=objective.name,
        arrive_by=min(context.latest_arrival, latest, context.data_end),
        terms=objective.terms,
    )


def _rate_is_constant(route: Route) -> bool:
    rate = np.asarray(route.samples["fuel_rate"])
    return bool(np.ptp(rate) <= _EQUAL_RATES * np.max(rate)) if len(rate) else False
