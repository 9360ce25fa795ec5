"""What the steps of a trade-off share: the context, explored alternatives, candidate tracks."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.planning.frozen_sea import FrozenSea
from thalweg.planning.interrupt_guard import InterruptGuard
from thalweg.planning.network_selection.route_alternatives import RouteAlternative
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import PricedObjective
from thalweg.route import Route, Track
from thalweg.search import NetworkFront, SearchResult
from thalweg.ship import PerformanceTable
from thalweg.ship.consumption import calm_water_consumption


@dataclass(frozen=True)
class TradeOffContext:
    """What all ways round are explored with."""

    context: PlanningContext
    objective: PricedObjective
    consumption: PerformanceTable
    ends: tuple[Endpoint, ...]
    settings: np.ndarray
    limits: np.ndarray
    interrupt_guard: InterruptGuard
    notes: list[str] = field(default_factory=list)  # for the plan, as they come up

    @property
    def via(self) -> tuple[Endpoint, ...]:
        """The places between the first end and the last."""
        return self.ends[1:-1]

    @cached_property
    def calm_water_cost_rates(self) -> FloatArray:
        """Cost of a second in calm water at each of `settings`; infinite if unknown."""
        prices = self.objective.prices
        rates = calm_water_consumption(self.context.ship, prices.consumption)[self.settings]
        cost = prices.outside * rates + prices.time
        return np.where(np.isfinite(cost), cost, np.inf)


@dataclass(frozen=True)
class ExploredAlternative:
    """What came of one way round.

    Attributes
    ----------
    way : Way
    frozen : Frozen
    fastest : Route
        The fastest route, refined and refereed.
    first : SearchResult
        The fastest way on the network.
    exact : Front or None
        The exact front of the network; None where its search was stopped.
    isochrones : ndarray
        Earliest arrival at every node [s since 1970]; inf where never reached.
    factor : float
        How much shorter than the network's way the way in open water may be.
    """

    way: RouteAlternative
    frozen: FrozenSea
    fastest: Route
    first: SearchResult
    exact: NetworkFront | None
    isochrones: np.ndarray
    factor: float


@dataclass(frozen=True)
class TrackCandidate:
    """A track with what the solver says of it.

    Attributes
    ----------
    track : Track
    stage : str
        Where it comes from.
    way : str
        The way round.
    time : float
        [s].
    value : float
        [unit of the criterion].
    """

    track: Track
    stage: str
    way: str
    time: float
    value: float
