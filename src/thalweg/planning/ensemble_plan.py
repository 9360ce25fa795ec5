"""Plans under an ensemble forecast: the route with the least risk over all members."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.objective import KEY_FIGURES
from thalweg.core.pareto_fronts import (
    ROUNDING_TOLERANCE,
    evenly_spaced_subset,
    non_dominated_indices,
)
from thalweg.planning.plan import Plan
from thalweg.planning.plan_front import ParetoFront
from thalweg.planning.request.requirements import required_under_keel_clearance
from thalweg.planning.request.voyage_objective import PricedObjective, priced_objective
from thalweg.planning.voyage import Voyage
from thalweg.route import EnsembleResult, Route, evaluate_members
from thalweg.sea import Sea
from thalweg.ship import Ship

#: Number of members that are planned; all routes found are evaluated in all members.
MAX_PLANNED_MEMBERS = 3
#: Number of routes of a front that are evaluated in all members.
MAX_EVALUATED_ROUTES = 10


@dataclass(frozen=True)
class EnsembleCandidate:
    """A route of one plan, evaluated in all members.

    Attributes
    ----------
    member : Member of the plan.
    index : Place of the route in the plan.
    distribution : The route in all members.
    time, value : Time [h] and objective over the members in which the route can be sailed, by the
        measure of the voyage; those of the plan if there is no such member.
    time_risk, value_risk : The same over all members: inf if one of them is infeasible.
    """

    member: int
    plan: Plan
    index: int
    route: Route
    distribution: EnsembleResult
    time: float
    value: float
    time_risk: float
    value_risk: float


def plan_ensemble(
    voyage: Voyage, *, ship: Ship, sea: Sea, plan_one: Callable[[Voyage, Sea], Plan]
) -> Plan:
    """Plan with an ensemble forecast.

    The voyage is planned in a few members, evenly spaced by number. Every route found is evaluated
    in all members, and the route with the least mean (or mean of the worst tenth) is chosen. The
    choice is the best of these routes, not of all possible routes. If none of them can be sailed in
    all members, those that can be in most of them are compared by these members.

    Parameters
    ----------
    sea : An ensemble.
    plan_one : Function that plans a voyage in one sea.

    Returns
    -------
    Plan : Plan of the member of the chosen route (or of the first one of the front), with the
        distributions of its routes in ``ensemble``.

    Raises
    ------
    NoRouteError : If no member has a route.
    """
    measure = voyage.ensemble or "mean"
    planned = np.unique(
        np.linspace(0, sea.members - 1, min(MAX_PLANNED_MEMBERS, sea.members)).astype(int)
    )
    plans: dict[int, Plan] = {}
    refusal = None
    tried: list[int] = []
    for member in planned.tolist():
        tried.append(member)
        try:
            plans[member] = plan_one(voyage, sea.member(member))
        except NoRouteError as error:
            refusal = error
            continue
        if plans[member].cancelled:
            break
    if not plans:
        assert refusal is not None  # some member was planned
        raise refusal
    sailed = [
        item
        for member, plan in plans.items()
        for item in _evaluate_in_all_members(voyage, member, plan, ship, sea, measure)
    ]
    fewest = min(len(item.distribution.infeasible) for item in sailed)
    usable = [item for item in sailed if len(item.distribution.infeasible) == fewest]
    objective = priced_objective(voyage, ship) if voyage.chooses_speeds else None
    chosen = _select_plan(voyage, objective, usable, tried, measure)
    stopped = any(plan.cancelled for plan in plans.values())
    return dataclasses.replace(chosen, cancelled=stopped)


def _evaluate_in_all_members(
    voyage: Voyage, member: int, plan: Plan, ship: Ship, sea: Sea, measure: str
) -> list[EnsembleCandidate]:
    """Evaluate the routes of a plan in all members."""
    terms = priced_objective(voyage, ship).terms if voyage.chooses_speeds else None
    results = []
    for index in _routes_to_evaluate(plan):
        route = plan.routes[index]
        distribution = evaluate_members(
            route,
            ship=ship,
            sea=sea,
            terms=terms,
            chart=None if plan.plot_context is None else plan.plot_context.chart,
            min_ukc=required_under_keel_clearance(voyage, ship),
        )
        figure = _chosen_figure(plan)
        results.append(
            EnsembleCandidate(
                member,
                plan,
                index,
                route,
                distribution,
                _over_feasible_members(route, distribution, "time_h", measure),
                _over_feasible_members(route, distribution, figure, measure),
                _over_all_members(distribution, "time_h", measure),
                _over_all_members(distribution, figure, measure),
            )
        )
    return results


def _routes_to_evaluate(plan: Plan) -> list[int]:
    """Return the routes to evaluate in all members: along a front, or its lowest values."""
    if plan.front is None or plan.voyage.objective != "front":
        return (
            [0]
            if plan.front is None
            else np.argsort(plan.front.values)[:MAX_EVALUATED_ROUTES].tolist()
        )
    time = np.array([route.time_h for route in plan.routes])
    return [int(i) for i in evenly_spaced_subset(time, plan.front.values, MAX_EVALUATED_ROUTES)]


def _chosen_figure(plan: Plan) -> str:
    """Return the attribute of a route by which routes are chosen."""
    name: str = plan.voyage.objective
    if name == "front":
        name = "time" if plan.front is None else plan.front.criterion
    return KEY_FIGURES[name].attribute


def _over_all_members(distribution: EnsembleResult, figure: str, measure: str) -> float:
    """Return the risk of a key figure; a length is the same in all members."""
    if figure == "distance_nm":
        return distribution.routes[0].distance_nm
    return distribution.risk(figure, measure)


def _over_feasible_members(
    route: Route, distribution: EnsembleResult, figure: str, measure: str
) -> float:
    """Return a key figure over the members in which a route can be sailed."""
    if figure == "distance_nm":
        return distribution.routes[0].distance_nm
    statistics = distribution.spread(figure)
    if statistics is None:
        value = getattr(route, figure)
        return math.nan if value is None else float(value)
    return float(getattr(statistics, measure))


def _select_plan(
    voyage: Voyage, objective: PricedObjective | None, sailed: list[EnsembleCandidate],
    planned: list[int],
    measure: str,
) -> Plan:  # fmt: skip
    """Return the plan of the member of the best route, with the best routes of all members.

    Its routes are those evaluated in that one member, for comparison; ``ensemble`` has their
    distributions over the members.
    """
    order = _best_candidates(voyage, sailed)
    first, shown = order[0].plan, order[0].member
    routes = tuple(item.distribution.routes[shown] for item in order)
    members = len(order[0].distribution.routes)
    risk = "mean" if measure == "mean" else "mean of the worst tenth"
    note = (
        f"Planned in members {', '.join(map(str, planned))} of {members} and evaluated in all; "
        f"chosen by the {risk} over the members. The routes are shown as in member {shown}."
    )
    if order[0].distribution.infeasible:
        note += (
            " No route of these plans can be sailed within the limits in all members: those that "
            "can be in most members are compared by these members."
        )
    notes = [note, *first.notes, *(n for item in order for n in item.distribution.notes)]
    return dataclasses.replace(
        first,
        voyage=voyage,
        routes=routes,
        front=_front(order, routes, objective),
        notes=tuple(dict.fromkeys(notes)),
        ensemble=tuple(_distribution_row(item, shown) for item in order),
    )


def _best_candidates(voyage: Voyage, sailed: list[EnsembleCandidate]) -> list[EnsembleCandidate]:
    """Return the front of the candidates by ascending time, or the best one.

    Those that never arrive in the member in which the routes are shown are left out.

    Raises
    ------
    NoRouteError : If no candidate has a time and a value.
    """
    time = np.array([item.time for item in sailed])
    value = np.array([item.value for item in sailed])
    if voyage.objective == "front":
        chosen = non_dominated_indices(time, value, tolerance=ROUNDING_TOLERANCE).tolist()
    else:
        chosen = [int(np.nanargmin(value))] if np.isfinite(value).any() else []
    if not chosen:
        raise NoRouteError(
            "No planned route can be sailed to its end in any member of the ensemble.",
            f"{len(sailed)} routes were evaluated in {len(sailed[0].distribution.routes)} members.",
            "Relax the limits, depart at another time, or plan with one member.",
        )
    order = [sailed[index] for index in chosen]
    shown = order[0].member
    arrives = [math.isfinite(item.distribution.routes[shown].time_h) for item in order]
    return [item for item, ok in zip(order, arrives) if ok or item is order[0]]


def _front(
    order: list[EnsembleCandidate], routes: tuple[Route, ...], objective: PricedObjective | None
) -> ParetoFront | None:
    """Return the front of the chosen routes, which may come from several plans."""
    first = order[0].plan.front
    if first is None or objective is None:
        return None
    fronts = [(item.plan.front, item.index) for item in order]
    return dataclasses.replace(
        first,
        values=np.array([objective.value(route) for route in routes]),
        stages=tuple(front.stages[i] for front, i in fronts if front is not None),
        ways=tuple(front.ways[i] for front, i in fronts if front is not None),
    )


def _distribution_row(item: EnsembleCandidate, shown: int) -> dict[str, Any]:
    """Return the distribution of a route as plain data; a risk is None if it is not finite."""
    return {
        "shown_member": shown,
        "time_risk_h": finite_or_none(item.time_risk),
        "value_risk": finite_or_none(item.value_risk),
        **item.distribution.as_dict(),
    }
