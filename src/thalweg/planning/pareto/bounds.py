"""Lower bounds of a Pareto front: for open water and absolute."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.geodesy import distance
from thalweg.core.pareto_fronts import ROUNDING_TOLERANCE, non_dominated_indices
from thalweg.core.units import HOUR
from thalweg.planning.pareto.exploration import strongest_current
from thalweg.planning.pareto.trade_off_context import ExploredAlternative, TradeOffContext
from thalweg.planning.plan_data import Proof
from thalweg.planning.plan_front import ParetoFront
from thalweg.search import table_bounds

_KIND = (
    "the lower front of the network: all conditions as favourable as at any time in each time "
    "step, lengths as short as in open water"
)
_KIND_ABSOLUTE = "the geodesic at the greatest speed over ground in the data"


def open_water_lower_front(
    explored: list[ExploredAlternative], criterion_lower_bound: float
) -> np.ndarray:
    """Return the lower front of open water over all alternatives: times [h] and values.

    For a route in open water with time T and value C there is a path on the network with at most
    time T / k and value C / k, where k is the direction factor. So ``C >= k L(T / k)``
    with the lower front L of the network. The bound is as certain as that factor.
    """
    time, value = [np.empty(0)], [np.empty(0)]
    for one in explored:
        if one.exact is None:
            continue
        k = one.factor
        time.append(k * one.exact.lower_time / HOUR)
        value.append(np.maximum(k * one.exact.lower_cost, criterion_lower_bound))
    times, values = np.concatenate(time), np.concatenate(value)
    non_dominated = non_dominated_indices(times, values, tolerance=ROUNDING_TOLERANCE)
    return np.array([times[non_dominated], values[non_dominated]]).reshape(2, -1)


def correction_factors(lower: np.ndarray, time_h: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the factors (time, value) that lower the lower front to the routes below it.

    1 where no route is below it. Routes between islands may be shorter than paths on a coarse
    network by more than the direction factor.
    """
    if not lower.size:
        return np.ones(2)
    earliest = float(lower[0].min())  # 0 where a setting is slower than the current
    factors = np.array([min(1.0, float(time_h.min()) / earliest) if earliest > 0.0 else 1.0, 1.0])
    for time, value in zip(time_h, values):
        bound = lower[1, factors[0] * lower[0] <= time].min(initial=math.inf)
        if value < bound < math.inf:
            factors[1] = min(factors[1], float(value / bound))
    return factors


def derive_proof(
    trade_off: TradeOffContext,
    explored: list[ExploredAlternative],
    front: ParetoFront,
    *,
    whole: bool,
) -> Proof:
    """Return the bounds: of time for a whole front, else of the objective."""
    certain_time, certain_value = absolute_lower_bound(trade_off, explored)
    kind = _KIND if front.lower.size else _KIND_ABSOLUTE
    if whole:
        fastest = min(one.first.duration for one in explored) / HOUR
        lower = front.lower[0].min() if front.lower.size else certain_time
        return Proof(max(float(lower), certain_time), kind, certain_time, fastest)
    points = [point for one in explored if one.exact for point in one.exact.points]
    solver = min((point.cost for point in points), default=math.nan)
    value = float(front.values[0])
    lower = float(front.lower[1].min()) if front.lower.size else certain_value
    if lower > value:  # the route, which is not on the network, is better
        lower = certain_value
    return Proof(max(lower, certain_value), kind, certain_value, solver)


def absolute_lower_bound(
    trade_off: TradeOffContext, explored: list[ExploredAlternative]
) -> tuple[float, float]:
    """Return lower bounds of time [h] and value that hold for every route.

    For the geodesic at the greatest speed over ground in the data; for the value also with the
    least consumption rate and price of each setting.
    """
    context, prices = trade_off.context, trade_off.objective.prices
    start, goal = trade_off.ends[0], trade_off.ends[-1]
    geodesic = float(distance(start.lat, start.lon, goal.lat, goal.lon))
    current = max(strongest_current(one.frozen.stations) for one in explored)
    least = min(prices.inside, prices.outside)
    if prices.dues > 0.0:  # a route off the network may sail in the cheapest zone throughout
        least *= min([1.0, *(float(factor) for _, factor in context.chart.zones.price)])
    rates = np.maximum(table_bounds(trade_off.consumption.kernel_arrays(), np.fmin), 0.0)
    fastest, value = 0.0, math.inf
    for setting in trade_off.settings:
        over_ground = float(context.ship.top_speed(int(setting)) or math.inf) + current
        fastest = max(fastest, over_ground)
        per_second = least * float(rates[setting]) + prices.time
        value = min(value, per_second * geodesic / over_ground)
    return geodesic / fastest / HOUR, value


def correction_notes(share: np.ndarray) -> list[str]:
    """Return a note about the correction of the lower front, if there was one."""
    least = float(share.min())
    if least == 1.0:
        return []
    return [
        f"Refined routes are up to {1.0 - least:.1%} below the lower front of the network; the "
        "lower front was lowered by that, and is an estimate, not a proof."
    ]
