"""The speed or the departure of a given arrival: solved along the routes of trial plans."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

from thalweg.core.errors import NoRouteError
from thalweg.core.time import utc_text
from thalweg.core.units import MINUTE
from thalweg.planning.plan import Plan

#: A plan that arrives this much too early or too late arrives on time [s].
EARLY: Final = MINUTE
LATE: Final = 1.0
AIM: Final = 20.0  #: before the requested time [s]
_NEAR_JUMP = 5.0  # of the departure [s]
_MOST_PLANS = 8


@dataclass(frozen=True)
class ArrivalSearch:
    """A search for the value (departure, or speed with its sign changed) of a given arrival.

    The arrival does not decrease with the value. ``plan_at`` plans at a value, ``arrival_on`` sails
    the track of a plan at another one; ``near`` is the difference of values that hardly matters;
    ``within_limits`` gives inf where the track breaks a limit.
    """

    plan_at: Callable[[float], Plan]
    arrival_on: Callable[[Plan, float], float]
    arrive: float
    limits: tuple[float, float]
    near: float
    within_limits: Callable[[Plan, float], float] | None = None

    def on_time(self, plan: Plan) -> bool:
        """Return whether a plan arrives in the minute before the time."""
        return plan.best.feasible and -EARLY <= plan.best.arrive - self.arrive <= LATE


def solve_arrival(search: ArrivalSearch, first: tuple[float, Plan]) -> tuple[float, Plan]:
    """Return the value and the plan that arrives in time; where arrivals jump, the one before."""
    value, plan = first
    low, high = search.limits
    best: tuple[float, Plan] | None = None
    tried_near = 0
    for _ in range(_MOST_PLANS):
        if search.on_time(plan):
            return value, plan
        if plan.best.feasible and plan.best.arrive <= search.arrive + LATE:
            low = max(low, value)
            if best is None or plan.best.arrive > best[1].best.arrive:
                best = value, plan
        else:
            high = min(high, value)
        tried_near += high - low < search.near
        if tried_near > 1:
            break
        value = _next_value(search, plan, low, high)
        try:
            plan = search.plan_at(value)
        except NoRouteError:
            high = value
            if best is None:
                raise
            plan = best[1]
    if best is None:
        raise NoRouteError(
            f"No route that arrives at {utc_text(search.arrive)} was found.",
            f"{_MOST_PLANS} departures or speeds were tried; the last arrives at "
            f"{utc_text(plan.best.arrive)}.",
            "Give the latest arrival with arrive_by, which allows waits.",
        )
    return _at_the_jump(search, best, high)


def whole_answer(
    search: ArrivalSearch, value: float, plan_at: Callable[[float], Plan]
) -> tuple[float, Plan]:
    """Return the value and its whole plan; another value where this leaves later and is late."""
    plan = plan_at(value)
    if plan.best.arrive <= search.arrive + LATE:
        return value, plan
    return solve_arrival(replace(search, plan_at=plan_at), (value, plan))


def _at_the_jump(
    search: ArrivalSearch, best: tuple[float, Plan], late: float
) -> tuple[float, Plan]:
    """Return the last value at which the track of a plan is open, where arrivals jump.

    Each plan takes seconds, so that plans alone come no nearer than some minutes to the jump.
    """
    if search.within_limits is None:
        return best
    low, high = best[0], late
    while high - low > _NEAR_JUMP:
        middle = 0.5 * (low + high)
        if search.within_limits(best[1], middle) <= search.arrive + LATE:
            low = middle
        else:
            high = middle
    if low - best[0] < EARLY:
        return best
    try:
        plan = search.plan_at(low - _NEAR_JUMP)
    except NoRouteError:
        return best
    later = plan.best.feasible and best[1].best.arrive < plan.best.arrive <= search.arrive + LATE
    return (low - _NEAR_JUMP, plan) if later else best


def _next_value(search: ArrivalSearch, plan: Plan, low: float, high: float) -> float:
    """Return the value at which the track of a plan arrives in time; else the middle."""
    from scipy.optimize import brentq

    aim = search.arrive - AIM

    def late(value: float) -> float:
        return min(search.arrival_on(plan, value) - aim, 1e9)

    try:
        found = float(brentq(late, low, high, xtol=1e-5 * (high - low), maxiter=30))
    except ValueError:  # no change of sign on this track
        return 0.5 * (low + high)
    inside = low < found < high
    return found if inside else 0.5 * (low + high)
