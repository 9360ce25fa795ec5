"""Plans whose routes keep limits of indicators over the whole route."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.objective import OBJECTIVE_NAMES, Objective
from thalweg.core.pareto_fronts import non_dominated_indices
from thalweg.core.units import HOUR
from thalweg.planning.network_selection.route_alternatives import OPEN_SEA
from thalweg.planning.pareto.indicator_limit import IndicatorLimit
from thalweg.planning.plan import Plan
from thalweg.planning.plan_data import Proof
from thalweg.planning.plan_front import ParetoFront, not_rising
from thalweg.planning.voyage import Voyage
from thalweg.route import Route
from thalweg.route.indicator_columns import indicator_value

_ROUNDS: Final = 5  # halvings of the weight of the limited key figure
_ARRIVALS: Final = 6  # that are tried to keep a limit just
_UNUSED: Final = 2e-3  # share of a limit that may be left
_AIM: Final = 3e-4  # share of a limit by which the search aims below it
_SAME_TIME: Final = 1e-4  # share of the time below which two routes count as equally long
_OF_FUEL: Final = ("fuel", "cost", "co2")  # one price of fuel gives each from fuel and time
_TRADED: Final = (*_OF_FUEL, "energy")  # against time, by the choice of speeds
#: Key figure that lowers an indicator.
_LOWERED_BY: Final[dict[str, str]] = {
    **{str(name): str(name) for name in OBJECTIVE_NAMES},
    "sick_percent": "comfort",
    "worst_hour_percent": "comfort",
    "max_acceleration": "comfort",
    "uncomfortable_percent": "comfort",
    "workable_percent": "comfort",
    "inshore_nm": "inshore",
    "inshore_percent": "inshore",
    "inshore_h": "inshore",
    "land_distance_nm": "inshore",
    "near_ground_h": "inshore",
    "contour_distance_nm": "inshore",
    "dense_traffic_h": "encounters",
}


def plan_within_limits(
    voyage: Voyage,
    plan_one: Callable[[Voyage], Plan],
    other_routes: Callable[[], Sequence[Route]] = tuple,
) -> Plan:
    """Plan a voyage whose route keeps limits of indicators.

    Parameters
    ----------
    plan_one : Plans a voyage without such limits.
    other_routes : Routes of the voyage by other ways, called where no plan keeps the limits.

    Returns
    -------
    Plan
        With the best route found that keeps the limits; with the objective "front" all of them.

    Raises
    ------
    NoRouteError
        If none was found, with the nearest.

    Notes
    -----
    Without the limits first. If that route breaks one, the key figure that lowers the indicator is
    the objective, and the arrival between the slowest route that breaks the limit and the fastest
    that keeps it is varied until the limit is just kept. Where that is not known to be the best,
    the key figure is added to the objective with a growing weight (Lagrangian relaxation). All
    routes of these fronts are candidates. Where none keeps the limits, routes by other ways are.
    The bound of the plan without limits holds for every route, and that of the plan with the latest
    arrival that a limit of time allows for those that keep it; that of the least time is raised to
    when the front of a limited key figure, which no route is below, falls to the limit.
    """
    limits = IndicatorLimit.of_voyage(voyage)
    free = replace(voyage, at_most={}, at_least={})
    found = plan_one(free)
    if voyage.objective == "front":
        return _front_within(voyage, plan_one, found, limits)
    unknown = [one.text() for one in limits if math.isinf(one.excess(found.best))]
    if unknown:
        raise InputError(
            f"The limit {unknown[0]} is given, but that indicator is not known on this voyage.",
            "It needs data: waves and named places for motions, --traffic for encounters, --depth "
            "for depths.",
            "Add the data, or leave out the limit.",
            field="at_most",
        )
    plans = _plans_within(free, plan_one, found, limits)
    objective = found.objective
    candidates = [
        (objective.value(route), number, k)
        for number, plan in enumerate(plans)
        for k, route in enumerate(plan.routes)
        if route.feasible and _kept(route, limits)
    ]
    if not candidates:
        others = [one for one in other_routes() if one.feasible and _kept(one, limits)]
        if not others:
            raise _no_route_within(plans, limits)
        plans.append(replace(found, routes=tuple(others), front=None))
        candidates = [(objective.value(route), len(plans) - 1, k) for k, route in enumerate(others)]
    value, number, k = min(candidates)
    within = _assembled(voyage, found, plans[number], (k, value), limits)
    if voyage.objective != "time":
        return replace(within, proof=_proof_in_time(found.proof, _in_time(free, limits), plans))
    return replace(within, proof=_proof_within(found.proof, free, plans, limits))


def _kept(route: Route, limits: tuple[IndicatorLimit, ...]) -> bool:
    return all(one.excess(route) == 0.0 for one in limits)


def _plans_within(
    free: Voyage,
    plan_one: Callable[[Voyage], Plan],
    found: Plan,
    limits: tuple[IndicatorLimit, ...],
) -> list[Plan]:
    """Return plans whose routes are candidates, the first without limits.

    Parameters
    ----------
    free : Without the limits.
    found : Its plan.
    """
    plans = [found]
    if any(_kept(route, limits) for route in found.routes[:1]):
        return plans
    broken = [one for one in limits if one.excess(found.best) > 0.0]
    free = _in_time(free, limits)
    if free.arrive_by != found.voyage.arrive_by and free.chooses_speeds:
        plans.append(plan_one(free))
        if _kept(plans[-1].best, limits):
            return plans
    names = list(dict.fromkeys(_LOWERED_BY.get(one.name, "") for one in broken))
    own = dict(free.weights) or {str(free.objective): 1.0}
    names = [name for name in names if name not in ("", "time")]
    for name in names:
        if name not in own:  # fronts span time anyway
            plans.append(plan_one(replace(free, objective=name, weights={})))  # type: ignore[arg-type]
        for limit in broken:
            if limit.name == name and name in _TRADED:
                _narrow_down(free, limit, plan_one, plans, limits)
    names = [name for name in names if name not in own]
    if not names or set(own) == {"time"} or _spanned_by_time(own, names, plans):
        return plans  # the front of time against it holds every trade-off
    _weigh(free, own, names, plan_one, plans, limits)
    return plans


def _in_time(free: Voyage, limits: tuple[IndicatorLimit, ...]) -> Voyage:
    """Return a voyage that arrives within the limits of the time under way."""
    if free.depart_window is not None or free.arrive is not None or free.depart is None:
        return free
    hours = [one.value for one in limits if one.name == "time" and one.sense > 0]
    latest = [free.depart + HOUR * value for value in hours]  # type: ignore[operator]
    latest += [] if free.arrive_by is None else [free.arrive_by]  # type: ignore[list-item]
    return replace(free, arrive_by=min(latest)) if hours else free


def _narrow_down(
    free: Voyage,
    limit: IndicatorLimit,
    plan_one: Callable[[Voyage], Plan],
    plans: list[Plan],
    limits: tuple[IndicatorLimit, ...],
) -> None:
    """Append plans with arrivals at which a limit of a key figure is just kept.

    Between the slowest route that breaks the limit and the fastest that keeps all, the least key
    figure falls with the time, and is convex or nearly so: the line between both is kept or nearly.
    """
    if free.depart is None or free.depart_window is not None or free.arrive is not None:
        return
    early, tried = 0.0, list[float]()  # [s] by which the last plan arrived before it had to
    for _ in range(_ARRIVALS):
        routes = [one for plan in plans for one in plan.routes if one.feasible]
        routes = [one for one in routes if math.isfinite(indicator_value(one, limit.name))]
        right = min((one for one in routes if _kept(one, limits)), key=_hours, default=None)
        if right is None or indicator_value(right, limit.name) > (1.0 - _UNUSED) * limit.value:
            return
        over = [one for one in routes if limit.excess(one) > 0.0 and one.time_h < right.time_h]
        left = max(over, key=_hours, default=None)
        if left is None or right.time_h - left.time_h < _SAME_TIME * right.time_h:
            return
        value, other = (indicator_value(one, limit.name) for one in (right, left))
        share = ((1.0 - _AIM) * limit.value - value) / (other - value)
        latest = right.arrive + share * (left.arrive - right.arrive)
        latest += early if latest + early < right.arrive else 0.0
        if latest in tried:
            return
        tried.append(latest)
        request = replace(free, objective=limit.name, weights={}, arrive_by=latest)  # type: ignore[arg-type]
        try:
            plans.append(plan_one(request))
        except NoRouteError:  # none is as early
            return
        early = latest - plans[-1].best.arrive


def _hours(route: Route) -> float:
    return route.time_h


def _spanned_by_time(own: Mapping[str, float], names: list[str], plans: list[Plan]) -> bool:
    """Return whether an objective and key figures follow from time and fuel on all routes.

    That is so for fuel, its cost and its CO2 where all or none of it is burnt in control areas, and
    canal dues are the same.
    """
    routes = [route for plan in plans for route in plan.routes]
    inside = {
        round((route.fuel_eca_t or 0.0) / route.fuel_t, 6) if route.fuel_t else 0.0
        for route in routes
    }
    dues = {route.cost_parts["canal dues"] for route in routes}
    return {*own, *names} <= {"time", *_OF_FUEL} and inside in ({0.0}, {1.0}) and len(dues) == 1


def _weigh(
    free: Voyage,
    own: Mapping[str, float],
    names: list[str],
    plan_one: Callable[[Voyage], Plan],
    plans: list[Plan],
    limits: tuple[IndicatorLimit, ...],
) -> None:
    """Append plans that count what lowers the broken indicators, with a growing weight."""
    low, high = 0.0, 1.0
    for _ in range(_ROUNDS):
        share = 0.5 * (low + high)
        weights = {name: (1.0 - share) * weight for name, weight in own.items()}
        weights |= {name: share * sum(own.values()) / len(names) for name in names}
        try:
            plans.append(plan_one(replace(free, objective="weighted", weights=weights)))
        except InputError as error:
            if error.details.get("field") != "weights":
                raise
            return  # this ship, or the prices in control areas, do not allow the sum
        low, high = (low, share) if _kept(plans[-1].best, limits) else (share, high)


def _front_within(
    voyage: Voyage,
    plan_one: Callable[[Voyage], Plan],
    found: Plan,
    limits: tuple[IndicatorLimit, ...],
) -> Plan:
    """Return a plan with the routes of a front that keep limits, up to where these are just kept.

    Parameters
    ----------
    plan_one, found : As for `plan_within_limits`, and the plan of the whole front.
    """
    front = found.front
    if front is None or front.objective is None:
        raise _no_route_within([found], limits)
    plans = [found]
    free = replace(voyage, at_most={}, at_least={})
    for limit in limits:
        if limit.name in _TRADED and any(limit.excess(route) > 0.0 for route in found.routes):
            if not any(_kept(route, limits) for route in found.routes):
                plans.append(plan_one(replace(free, objective=limit.name)))  # type: ignore[arg-type]
            _narrow_down(free, limit, plan_one, plans, limits)
    kept = [
        (route, plan, k)
        for plan in plans
        for k, route in enumerate(plan.routes)
        if route.feasible and _kept(route, limits)
    ]
    times = [route.time_h for route, _, _ in kept]
    values = [front.objective.value(route) for route, _, _ in kept]
    chosen = non_dominated_indices(times, values).tolist()
    if not chosen:
        raise _no_route_within(plans, limits)
    words = ", ".join(one.text() for one in limits)
    left = sum(not _kept(route, limits) for route in found.routes)
    return replace(
        found,
        voyage=voyage,
        routes=tuple(kept[n][0] for n in chosen),
        front=replace(
            front,
            values=np.array([values[n] for n in chosen]),
            stages=tuple(_of_front(kept[n][1], kept[n][2])[0] for n in chosen),
            ways=tuple(_of_front(kept[n][1], kept[n][2])[1] for n in chosen),
        ),
        notes=(
            *found.notes,
            f"Limits of the route: {words}; {left} routes of the front without them break them.",
        ),
    )


def _of_front(plan: Plan, k: int) -> tuple[str, str]:
    """Return the stage and the way of a route of a plan."""
    if plan.front is None:
        return "within limits", OPEN_SEA
    return plan.front.stages[k], plan.front.ways[k]


def _assembled(
    voyage: Voyage,
    found: Plan,
    source: Plan,
    best: tuple[int, float],
    limits: tuple[IndicatorLimit, ...],
) -> Plan:
    """Return the plan of one route, with the bound of the plan without limits."""
    k, value = best
    route = source.routes[k]
    objective: Objective = found.objective
    words = ", ".join(one.text(route) for one in limits)
    note = f"Limits of the route: {words}."
    free = objective.value(found.best)
    if route is not found.best:
        broken = ", ".join(one.text(found.best) for one in limits if one.excess(found.best) > 0.0)
        more = value - free
        note += f" They cost {more:.4g} {objective.unit}".rstrip()
        note += f" more than the best route without them, which breaks {broken}."
    settings_alone = voyage.speed_step_kn is None and source.voyage.chooses_speeds
    if voyage.objective == "time" and settings_alone:
        note += " Its speeds are those of the ship file; --speed-step 0.5 counts those between."
    way = _of_front(source, k)[1]
    front = found.front
    if front is not None:
        front = ParetoFront(
            criterion=front.criterion,
            unit=front.unit,
            values=np.array([value]),
            stages=("within limits",),
            ways=(way,),
            certain=front.certain,
            objective=front.objective,
        )
    notes = tuple(dict.fromkeys((note, *source.notes)))
    return replace(found, voyage=voyage, routes=(route,), front=front, notes=notes)


def _proof_in_time(proof: Proof, in_time: Voyage, plans: list[Plan]) -> Proof:
    """Return the greatest of a bound and those of plans that arrive within the limits of time."""
    proofs = [proof, *(plan.proof for plan in plans if plan.voyage == in_time)]
    return max(proofs, key=lambda one: one.certain if math.isfinite(one.certain) else -math.inf)


def _proof_within(
    proof: Proof, free: Voyage, plans: list[Plan], limits: tuple[IndicatorLimit, ...]
) -> Proof:
    """Return the bound of the least time, raised by fronts that no route is below.

    Before the time at which such a front falls to a limit, no route keeps the limit.

    Parameters
    ----------
    proof : Of the plan without limits.
    free, plans : That voyage, and its plans; those with an earlier arrival are left out.
    """
    for plan in plans:
        front = plan.front
        if front is None or not front.certain.size or plan.voyage.arrive_by != free.arrive_by:
            continue
        times, values = not_rising(front.certain)
        for limit in limits:
            if limit.name != front.criterion or limit.sense < 0 or not values[-1] <= limit.value:
                continue
            at = int(np.argmax(values <= limit.value))
            least = float(times[at])
            if at:  # the front is joined by lines
                share = (values[at - 1] - limit.value) / (values[at - 1] - values[at])
                least = float(times[at - 1] + share * (times[at] - times[at - 1]))
            if not least <= proof.certain:
                kind = (
                    f"{plan.proof.kind}; the time from which {limit.name} may be within its limit"
                )
                proof = Proof(least, kind, proof.solver_total)
    return proof


def _no_route_within(plans: list[Plan], limits: tuple[IndicatorLimit, ...]) -> NoRouteError:
    routes = [route for plan in plans for route in plan.routes if route.feasible]
    nearest = min(routes, key=lambda route: sum(one.excess(route) for one in limits), default=None)
    asked = ", ".join(one.text() for one in limits)
    got = "" if nearest is None else ", ".join(one.value_text(nearest) for one in limits)
    return NoRouteError(
        f"No route was found with {asked}.",
        f"Of {len(routes)} routes found, the one nearest to that has {got}."
        if got
        else "No route was found.",
        "Relax the limit, allow more time, or change the departure.",
        reasons={},
    )
