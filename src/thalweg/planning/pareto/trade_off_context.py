"""What the steps of a trade-off share: the context, explored alternatives, candidate tracks."""

from __future__ import annotations

import math
import time as clock
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.interrupt import InterruptGuard
from thalweg.core.limits import Limits
from thalweg.core.pareto_fronts import ROUNDING_TOLERANCE, non_dominated_indices
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.planning.frozen_sea import FrozenSea
from thalweg.planning.network_selection.route_alternatives import RouteAlternative
from thalweg.planning.planning_context import PlanningContext, greatest_speed_of
from thalweg.planning.report.waiting_report import waiting_weather_texts
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import PricedObjective
from thalweg.planning.single.certified_bound import TABLE_MARGIN
from thalweg.route import Route, Track
from thalweg.route.refinement.better_route import penalty_excess
from thalweg.search import NetworkFront, SearchResult, table_bounds
from thalweg.ship import PerformanceTable
from thalweg.ship.consumption import calm_water_consumption


@dataclass(frozen=True)
class FrontDetail:
    """How many tracks of a front are refined and evaluated.

    Attributes
    ----------
    seeds, dominated_seeds : Greatest number of tracks of the network's front, and of others, from
        which refinement starts.
    size, time_prices, exploration, generations : Of `thalweg.evolution.refine_front`.
    least, most : Number of routes that the referee evaluates.
    """

    seeds: int
    dominated_seeds: int
    size: int
    time_prices: int
    exploration: int
    generations: int
    least: int
    most: int


WHOLE_FRONT = FrontDetail(36, 12, 140, 36, 60, 26, 40, 100)
#: For the best route by one objective, with a few faster ones for comparison.
BEST_ROUTE = FrontDetail(6, 3, 24, 4, 0, 0, 12, 12)
#: Share of the value that a wait in weather within the limits is worth.
WORTH_OF_SHELTER: Final = 0.5
_DAY: Final = 24.0 * HOUR
_ONE_BEST: Final = ("fuel", "energy", "cost", "co2")


def spread_settings(settings: NDArray[np.int64], most: int) -> NDArray[np.int64]:
    """Return at most ``most`` of some settings, evenly spread, with the first and the last."""
    places = np.linspace(0, len(settings) - 1, most).round().astype(int)
    return settings[np.unique(places)]


@dataclass(frozen=True)
class TradeOffContext:
    """What all route alternatives of a trade-off share.

    Attributes
    ----------
    objective : What is traded against time.
    consumption : PerformanceTable
        Consumption that the objective prices (`thalweg.ship.consumption.consumption_table`).
    ends : Start, via points and goal.
    settings : Speed settings to choose from, ascending.
    limits : Limits along the route, perhaps tightened.
    notes : Notes for the plan; steps add theirs.
    began : When planning began, by `time.perf_counter` [s].
    """

    context: PlanningContext
    objective: PricedObjective
    consumption: PerformanceTable
    ends: tuple[Endpoint, ...]
    settings: np.ndarray
    limits: Limits
    interrupt_guard: InterruptGuard
    notes: list[str] = field(default_factory=list)
    began: float = field(default_factory=clock.perf_counter)

    @property
    def detail(self) -> FrontDetail:
        """How much of the front is computed.

        In weather the best route needs the front on both sides of it.
        """
        voyage = self.context.voyage
        one = voyage.objective in _ONE_BEST and voyage.method == "default"
        steady = math.isinf(self.context.data_end) and not self._sea_changes
        return BEST_ROUTE if one and steady else WHOLE_FRONT

    @cached_property
    def _sea_changes(self) -> bool:
        """Whether the sea has times between two that are a day apart: tides, functions of time."""
        depart = self.context.voyage.earliest_departure
        return len(self.context.sea.times(depart, depart + _DAY)) > 2

    @property
    def is_refined(self) -> bool:
        """Whether routes are refined in open water."""
        return self.context.voyage.method != "exact" and not self.objective.prices.counts_water

    @property
    def least_zone_factor(self) -> float:
        """The least factor on prices: a route may sail in the cheapest zone throughout."""
        if not self.objective.prices.dues > 0.0:
            return 1.0
        return min([1.0, *(float(factor) for _, factor in self.context.chart.zones.price)])

    @property
    def table_margin(self) -> float:
        """What a bound is multiplied by for the error of tables; 1 without tables."""
        tables = self.context.table.axes or self.consumption.axes
        return 1.0 - TABLE_MARGIN if tables else 1.0

    def slowness_and_rates(self, current: float) -> tuple[FloatArray, FloatArray]:
        """Return the least time of a metre [s] and the least consumption a second of each setting.

        Parameters
        ----------
        current : No current is stronger [m/s].
        """
        if self._is_as_in_calm_water:
            calm = self._calm_rates[self.settings]
            made = np.asarray(self.context.ship.speeds, float)[self.settings]
            if np.isfinite(calm).all():
                return (1.0 - TABLE_MARGIN) / made, (1.0 - TABLE_MARGIN) * calm
        rates = np.maximum(table_bounds(self.consumption.kernel_arrays(), np.fmin), 0.0)
        ship, speeds = self.context.ship, self.context.table
        speed = [greatest_speed_of(ship, speeds, int(s)) for s in self.settings]
        return 1.0 / (np.array(speed, float) + current), rates[self.settings]

    @cached_property
    def least_price_of_consumption(self) -> float:
        """What the consumption of a second costs at least, under way, in canals or waiting."""
        prices = self.objective.prices
        _, rates = self.slowness_and_rates(0.0)
        rate = self.table_margin * np.min([rates.min(), self.least_rate_in_canals])
        least = np.min([prices.waiting, min(prices.inside, prices.outside) * rate])
        return self.least_zone_factor * float(least) if np.isfinite(least) else 0.0

    @cached_property
    def _calm_rates(self) -> FloatArray:
        """Consumption in a second in calm, deep water at every setting of the ship."""
        prices = self.objective.prices
        return calm_water_consumption(self.context.ship, prices.consumption, prices.mix)

    @property
    def least_rate_in_canals(self) -> float:
        """The least consumption in a second in canals, of all settings: that of calm water."""
        known = self._calm_rates[np.isfinite(self._calm_rates)]
        return (1.0 - TABLE_MARGIN) * float(known.min()) if known.size else 0.0

    @property
    def _is_as_in_calm_water(self) -> bool:
        """Whether a ship with tables of weather makes the speed in calm, deep water everywhere."""
        axes = self.context.table.axes | self.consumption.axes
        no_field = self.context.ship.speed_field is None
        return bool(axes) and "depth" not in axes and no_field and self.context.sea_is_calm

    def worth_of_canals(self, current: float = 0.0) -> dict[str, float]:
        """Return the length at sea [m] that costs as much as the dues of a canal, by name.

        The length includes what its slow passage takes longer. It is 0 where nothing has a price.
        """
        prices, canals = self.objective.prices, self.context.chart.canals
        slow, rates = self.slowness_and_rates(current)
        price = self.least_zone_factor * min(prices.inside, prices.outside)
        per_metre = float(np.min(slow * (price * rates + prices.time)))
        if not per_metre > 0.0:
            return {canal.name: 0.0 for canal in canals}
        return {
            canal.name: prices.dues * canal.fee / per_metre
            + max(canal.transit_time / float(slow.min()) - canal.length, 0.0)
            for canal in canals
        }

    @property
    def via(self) -> tuple[Endpoint, ...]:
        """The via points."""
        return self.ends[1:-1]

    @cached_property
    def calm_water_cost_rates(self) -> FloatArray:
        """Cost of a second in calm water at each of `settings`; infinite if unknown."""
        prices = self.objective.prices
        cost = prices.outside * self._calm_rates[self.settings] + prices.time
        return np.where(np.isfinite(cost), cost, np.inf)


@dataclass(frozen=True)
class ExploredAlternative:
    """Result of one route alternative.

    Attributes
    ----------
    fastest : The fastest route, refined and scored by the referee.
    first : The fastest path on the network.
    exact : The exact front of the network; None where its search was interrupted.
    isochrones : Earliest arrival at every node [s since 1970]; inf where not reached.
    """

    alternative: RouteAlternative
    frozen: FrozenSea
    fastest: Route
    first: SearchResult
    exact: NetworkFront | None
    isochrones: np.ndarray


@dataclass(frozen=True)
class TrackCandidate:
    """A track with its time and value as computed by a solver.

    Attributes
    ----------
    stage : Origin, as in `ParetoFront.stages`.
    alternative : Name of its route alternative.
    time : [s].
    value : [unit of the objective].
    """

    track: Track
    stage: str
    alternative: str
    time: float
    value: float


@dataclass(frozen=True)
class RefereedCandidate:
    """A candidate with its route and value as scored by the referee.

    Attributes
    ----------
    penalty : What penalty zones, shoals and lanes add, as a share of the time, and what a wait in
        weather within the limits is worth (`WORTH_OF_SHELTER`) where the ship waits above them.
    """

    candidate: TrackCandidate
    route: Route
    value: float
    penalty: float = 0.0


def scored_candidate(
    trade_off: TradeOffContext, candidate: TrackCandidate, route: Route, value: float
) -> RefereedCandidate:
    """Return a candidate with its route, its value and what penalties add to it."""
    context = trade_off.context
    penalty = penalty_excess(route, "time", context.chart) / max(route.time_h * HOUR, 1.0)
    if waiting_weather_texts(route, context.ship):
        penalty += WORTH_OF_SHELTER
    return RefereedCandidate(candidate, route, value, penalty)


def non_dominated_candidates(scored: list[RefereedCandidate]) -> list[RefereedCandidate]:
    """Return the routes that no other one beats in time and value, penalties included.

    Of those that are left none beats another one without the penalties either.
    """
    for counted in (1.0, 0.0):
        factor = np.array([1.0 + counted * item.penalty for item in scored])
        time = factor * [item.route.time_h for item in scored]
        value = factor * [item.value for item in scored]
        kept = non_dominated_indices(time, value, tolerance=ROUNDING_TOLERANCE)
        scored = [scored[index] for index in kept]
    return scored
