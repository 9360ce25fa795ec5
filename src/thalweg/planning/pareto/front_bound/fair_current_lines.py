"""A lower bound of a Pareto front that knows when currents are fair: it counts the tide."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from thalweg.core.pareto_fronts import falling_hull
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import HOUR
from thalweg.planning.pareto.trade_off_context import TradeOffContext
from thalweg.planning.single.certified_bound import CurrentsInReach
from thalweg.route import Route
from thalweg.search.certificate.barrier_domain import BarrierDomain
from thalweg.search.certificate.closed_water import cells_inside
from thalweg.search.certificate.fair_currents import (
    FairCurrents,
    heights_along,
    strongest_fair_currents,
)

WITH_FAIR_CURRENTS: Final = "with the strongest fair current of each time"  #: part of a kind
_VOYAGES: Final = 400  # lengths of voyages for which a value is bounded, at most
_MULTIPLIERS: Final = 64  # values of a metre that are tried
_MOST_NUMBERS: Final = 2e7  # times, voyages and settings together
_SPREAD: Final = 4.0  # of the values of a metre, beyond those of the settings
_OVERSHOOT: Final = 1.0 + 1e-6  # of the greatest speed over ground, beyond that of the domain
_SHORTER: Final = 1.0 - 1e-6  # geodesic, for the rounding of sums


def fair_current_lines(
    trade_off: TradeOffContext, routes: Sequence[Route], reached: CurrentsInReach | None
) -> tuple[FloatArray, float, float]:
    """Return lines that no route is below, by the fair currents that a ship can meet.

    Parameters
    ----------
    routes : Of the front.
    reached : Currents in reach of the slowest of them.

    Returns
    -------
    lines : float64 array (2, n)
        Slopes [1/h], turned round, and values at no time, both beyond what all time costs; none
        with via points, canals in reach or a window of departures, and without currents.
    until : float
        Longest time that they hold for [h]: that of the slowest route.
    least : float
        No route takes less [h]; 0 where nothing is known.

    Notes
    -----
    A ship at setting i, with the greatest speed v[i] through water and the least cost r[i] of a
    second, rises by ``g v[i] + m`` in a second at most, where g is the steepest slope and m the
    strongest fair current at that time in the water that she can be in; at anchor by none. For
    every value w of a metre a voyage of the time T costs at least w times the rise from the start
    to the goal, less the integral over T of ``max(0, w (g v[i] + m) - r[i])``. The greatest over w
    is the bound: the dual of the linear programme that mixes settings over time.
    """
    none = np.empty((2, 0)), 0.0, 0.0
    departures = {route.depart for route in routes if route.feasible}
    if reached is None or len(trade_off.ends) > 2 or len(departures) != 1:
        return none
    stretch, domain = reached.stretch, reached.domain
    slow, rates = trade_off.slowness_and_rates(0.0)
    if domain is None or not (np.isfinite(slow) & (slow > 0.0) & np.isfinite(rates)).all():
        return none
    fastest = float(1.0 / slow.min()) + domain.strongest_current
    if fastest > _OVERSHOOT * domain.fastest or stretch.canal_speed(fastest) > 0.0:
        return none
    prices, (areas, in_area) = trade_off.objective.prices, _areas(trade_off, domain)
    cheapest = min(prices.inside, prices.outside)
    of_area = [prices.inside if inside else cheapest for inside in in_area]
    everywhere = trade_off.least_price_of_consumption
    costs = [trade_off.least_zone_factor * price * rates - everywhere for price in of_area]
    count = _MOST_NUMBERS / (domain.raster.times.size * slow.size)
    first = min(_SHORTER * stretch.length / fastest, stretch.known)
    times = np.linspace(first, stretch.known, int(min(max(count, 8), _VOYAGES)))
    least, values = first, np.zeros(times.size)
    for height in heights_along(stretch, domain):
        steepest, currents = strongest_fair_currents(stretch, domain, fastest, height, areas, times)
        speeds, rise = steepest / slow, _SHORTER * height.rise
        possible = np.flatnonzero(greatest_rise(currents, float(speeds.max())) >= rise)
        if possible.size:
            least = max(least, float(times[max(int(possible[0]) - 1, 0)]))
        np.maximum(values, least_costs(currents, speeds, costs, rise), out=values)
    least, values = trade_off.table_margin * least, trade_off.table_margin * values
    # a voyage between two of the times costs no less than one of the later of them
    values, times = values[1:], times[:-1]
    values, times = values[times >= least], times[times >= least]
    if times.size < 2:
        return np.empty((2, 0)), 0.0, least / HOUR
    hull = falling_hull(times, values)
    slopes = np.diff(values[hull]) / np.diff(times[hull])
    lines = np.array([-slopes, values[hull][:-1] - slopes * times[hull][:-1]])
    lines = np.append(lines, [[0.0], [values[hull][-1]]], axis=1)
    lines[0] *= HOUR
    return lines, stretch.known / HOUR, least / HOUR


def _areas(trade_off: TradeOffContext, domain: BarrierDomain) -> tuple[list[BoolArray], list[bool]]:
    """Return cells of a raster by the price of fuel there, and whether it is that of an area."""
    lat, lon = domain.axes
    zones, prices = trade_off.context.chart.zones, trade_off.objective.prices
    everywhere = np.ones((lat.size - 1, lon.size - 1), bool)
    if not zones.eca or not prices.inside > prices.outside:
        return [everywhere], [False]
    inside = cells_inside(zones, lat, lon)
    parts = [(part, name) for part, name in ((inside, True), (~inside, False)) if part.any()]
    return [part for part, _ in parts], [name for _, name in parts]


def greatest_rise(currents: Sequence[FairCurrents], speed: float) -> FloatArray:
    """Return how far a ship may rise in voyages of some lengths [m], at most."""
    first = np.max([area.first for area in currents], axis=0)
    last = np.max([area.last for area in currents], axis=0)
    ends = np.maximum(speed + first, 0.0) + np.maximum(speed + last, 0.0)
    return np.asarray((0.5 * currents[0].seconds * ends).sum(axis=1))


def least_costs(
    currents: Sequence[FairCurrents],
    speeds: FloatArray,
    costs: Sequence[FloatArray],
    rise: float,
) -> FloatArray:
    """Return the least cost of voyages of some lengths, without the price of time.

    Parameters
    ----------
    currents, costs : By area; costs of a second at each of ``speeds`` [m/s].
    rise : From the start to the goal [m].
    """
    seconds = currents[0].seconds
    best = np.zeros(len(seconds))
    for worth in _worth_of_a_metre(speeds, costs):
        gain = [np.zeros(seconds.shape) for _ in range(2)]
        for area, cost in zip(currents, costs, strict=True):
            for fair, most in zip((area.first, area.last), gain, strict=True):
                for speed, rate in zip(speeds, cost, strict=True):
                    np.maximum(most, worth * (speed + fair) - rate, out=most)
        spent = (0.5 * seconds * (gain[0] + gain[1])).sum(axis=1)
        np.maximum(best, worth * rise - spent, out=best)
    return best


def _worth_of_a_metre(speeds: FloatArray, costs: Sequence[FloatArray]) -> FloatArray:
    """Return values of a metre to try, from below the cheapest costs to above the dearest."""
    order = np.argsort(speeds)
    known = []
    for cost in costs:
        rates = cost[order]
        with np.errstate(divide="ignore", invalid="ignore"):
            known += [rates / speeds[order], np.diff(rates) / np.diff(speeds[order])]
    values = np.concatenate(known)
    values = values[np.isfinite(values) & (values > 0.0)]
    if not values.size:
        return np.empty(0)
    return np.geomspace(values.min() / _SPREAD, values.max() * _SPREAD, _MULTIPLIERS)
