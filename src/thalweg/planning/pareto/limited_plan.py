"""Plans whose routes keep limits of indicators over the whole route."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.objective import OBJECTIVE_NAMES, Objective
from thalweg.planning.network_selection.route_alternatives import OPEN_SEA
from thalweg.planning.plan import Plan
from thalweg.planning.plan_front import ParetoFront
from thalweg.planning.voyage import Voyage
from thalweg.route import Route
from thalweg.route.indicator_columns import INDICATOR_WORDS, INDICATORS, indicator_value

_ROUNDS: Final = 5  # halvings of the weight of the limited key figure
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


@dataclass(frozen=True)
class IndicatorLimit:
    """A limit of an indicator of the whole route.

    Attributes
    ----------
    name, at : Indicator, and place or task (None for the first).
    value : [unit of the indicator].
    sense : 1 for at most, -1 for at least.
    """

    name: str
    at: str | None
    value: float
    sense: int

    @classmethod
    def of_voyage(cls, voyage: Voyage) -> tuple[IndicatorLimit, ...]:
        """Return the limits of a voyage."""
        found = []
        for sense, given in ((1, voyage.at_most), (-1, voyage.at_least)):
            for key, value in given.items():
                name, _, at = key.partition(":")
                found.append(cls(name, at or None, float(value), sense))
        return tuple(found)

    def excess(self, route: Route) -> float:
        """Return by how much a route breaks the limit; 0 where it keeps it, inf where unknown."""
        value = indicator_value(route, self.name, self.at)
        return max(self.sense * (value - self.value), 0.0) if math.isfinite(value) else math.inf

    def text(self, route: Route | None = None) -> str:
        """Return the limit, and the value of a route, in words."""
        unit = INDICATORS[self.name][0]
        sense = "most" if self.sense > 0 else "least"
        words = f"{self._words} at {sense} {self.value:g} {unit}".rstrip()
        if route is None:
            return words
        value = indicator_value(route, self.name, self.at)
        return (
            f"{words} (this route: {value:.3g})" if math.isfinite(value) else f"{words} (not known)"
        )

    def value_text(self, route: Route) -> str:
        """Return the value of a route in words."""
        value = indicator_value(route, self.name, self.at)
        unit = INDICATORS[self.name][0]
        known = f"{value:.3g} {unit}".rstrip() if math.isfinite(value) else "not known"
        return f"{self._words} {known}"

    @property
    def _words(self) -> str:
        """The indicator in words, with its name and its place."""
        name = f"{self.name}:{self.at}" if self.at else self.name
        words = INDICATOR_WORDS.get(self.name, "")
        return f"{words} ({name})" if words else name


def plan_within_limits(
    voyage: Voyage,
    plan_one: Callable[[Voyage], Plan],
    other_routes: Callable[[], Sequence[Route]] = tuple,
) -> Plan:
    """Plan a voyage whose route keeps limits of indicators.

    Parameters
    ----------
    voyage : With ``at_most`` or ``at_least``.
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
    added to the objective with a growing weight (Lagrangian relaxation), and all routes of these
    fronts are candidates. Where none keeps the limits, routes by other ways are. The bound of the
    plan without limits holds for every route.
    """
    limits = IndicatorLimit.of_voyage(voyage)
    free = replace(voyage, at_most={}, at_least={})
    found = plan_one(free)
    if voyage.objective == "front":
        return _front_within(voyage, found, limits)
    unknown = [one.text() for one in limits if math.isinf(one.excess(found.best))]
    if unknown:
        raise InputError(
            f"The limit {unknown[0]} is given, but that indicator is not known on this voyage.",
            "It needs data: waves and named places for motions, --traffic for encounters, --depth "
            "for depths.",
            "Add the data, or leave out the limit.",
            field="at_most",
        )
    plans = [found]
    if not _kept(found.best, limits):
        broken = [one for one in limits if one.excess(found.best) > 0.0]
        for other in _stricter_voyages(free, broken, lambda: plans[-1], limits):
            plans.append(plan_one(other))
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
    return _assembled(voyage, found, plans[number], (k, value), limits)


def _kept(route: Route, limits: tuple[IndicatorLimit, ...]) -> bool:
    return all(one.excess(route) == 0.0 for one in limits)


def _stricter_voyages(
    free: Voyage,
    broken: list[IndicatorLimit],
    last: Callable[[], Plan],
    limits: tuple[IndicatorLimit, ...],
) -> Iterator[Voyage]:
    """Yield voyages that count what lowers the broken indicators; ``last`` is the last plan."""
    names = list(dict.fromkeys(_LOWERED_BY.get(one.name, "") for one in broken))
    own = dict(free.weights) or {str(free.objective): 1.0}
    names = [name for name in names if name not in ("", "time", *own)]  # fronts span time anyway
    for name in names:
        yield replace(free, objective=name, weights={})  # type: ignore[arg-type]
    if not names or set(own) == {"time"}:
        return  # the front of time against it holds every trade-off
    low, high = 0.0, 1.0
    for _ in range(_ROUNDS):
        share = 0.5 * (low + high)
        weights = {name: (1.0 - share) * weight for name, weight in own.items()}
        weights |= {name: share * sum(own.values()) / len(names) for name in names}
        yield replace(free, objective="weighted", weights=weights)
        low, high = (low, share) if _kept(last().best, limits) else (share, high)


def _front_within(voyage: Voyage, found: Plan, limits: tuple[IndicatorLimit, ...]) -> Plan:
    """Return a plan with the routes of its front that keep limits."""
    kept = [k for k, route in enumerate(found.routes) if _kept(route, limits)]
    front = found.front
    if not kept or front is None:
        raise _no_route_within([found], limits)
    words = ", ".join(one.text() for one in limits)
    left = len(found.routes) - len(kept)
    return replace(
        found,
        voyage=voyage,
        routes=tuple(found.routes[k] for k in kept),
        front=replace(
            front,
            values=front.values[kept],
            stages=tuple(front.stages[k] for k in kept),
            ways=tuple(front.ways[k] for k in kept),
        ),
        notes=(*found.notes, f"Limits of the route: {words}; {left} routes break them."),
    )


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
    way = source.front.ways[k] if source.front is not None else OPEN_SEA
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
