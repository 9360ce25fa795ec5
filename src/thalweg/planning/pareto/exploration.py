"""Plans that trade time for fuel, cost or emissions: exact front, refinement, referee."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance, inverse
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.kernels.compilation import warm_up
from thalweg.network import Network, eca_fractions, shortest_path
from thalweg.planning.frozen_sea import FrozenSea, freeze_at_stations
from thalweg.planning.interrupt_guard import InterruptGuard, SearchInterrupted
from thalweg.planning.network_selection.route_alternatives import RouteAlternative
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import PricedObjective
from thalweg.planning.single.no_route_diagnosis import late_arrival_error, no_route_error
from thalweg.planning.single.passage import isochrones, refine_track, track_from_result
from thalweg.route import Route, Track
from thalweg.sea import StationFields
from thalweg.search import (
    NetworkFront,
    SearchResult,
    direction_factor,
    earliest_arrival,
    pareto_front,
)
from thalweg.ship import PerformanceTable
from thalweg.ship.consumption import calm_water_consumption

#: How much longer than in still water the slowest ship worth looking at may take ...
_SLOWEST_TIME_RATIO = 1.25
#: ... how much longer than the cheapest constant setting that was sailed ...
_TIME_MARGIN = 1.1
#: ... and how much longer than in still water it is looked for, step by step.
_MAX_TIME_RATIO, _HORIZON_GROWTH = 30.0, 1.6
_TWO_TIDES = 25 * HOUR
#: How much longer the sea is frozen, so that edges left last can be sailed to their end.
_HORIZON_MARGIN = 0.05
#: A turn [rad] that is none: by it a leg of 100 km is a metre off at its middle at most.
_MIN_COURSE_CHANGE = 2e-5
#: Into how many bins the time of a front is divided; refinement makes up for what they miss.
_TIME_BINS = 300


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
class SearchHorizon:
    """The sea over a network for as long as a front needs it.

    Attributes
    ----------
    frozen : Frozen
    first : SearchResult
        The fastest way; not found where there is none in that time.
    setting : int
        That of this way: the highest there is a way with.
    latest : float
        Latest arrival of the front [s since 1970].
    """

    frozen: FrozenSea
    first: SearchResult
    setting: int
    latest: float


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


def explore_alternative(trade_off: TradeOffContext, way: RouteAlternative) -> ExploredAlternative:
    """Search the fastest route and the exact front of one way round.

    Raises
    ------
    NoRouteError
        If there is no way in time, with the earliest arrival when there is one.
    """
    context = trade_off.context
    depart = context.voyage.earliest_departure
    context.report_progress(f"freezing the sea: {way.name}")
    ahead = extend_horizon(trade_off, way.network)
    frozen, first, latest = ahead.frozen, ahead.first, ahead.latest
    context.report_progress(f"searching: {way.name}")
    if not first.found:
        raise no_route_error(
            way.network,
            first,
            (trade_off.ends[0], trade_off.ends[-1]),
            depart=depart,
            last=context.data_end,
            fields=frozen.stations,
            required=float(trade_off.limits[codes.LIMIT_REQUIRED_DEPTH]),
        )
    if first.arrive > context.latest_arrival:
        raise late_arrival_error(context.latest_arrival, first.arrive)
    fastest = refine_track(
        context, track_from_result(way.network, first, ahead.setting), trade_off.limits
    )
    trade_off.interrupt_guard.begin()
    context.report_progress(f"searching the front: {way.name}")
    try:
        exact = network_pareto_front(trade_off, way.network, frozen, latest)
    except SearchInterrupted:
        exact = None
    until = first.arrive + 0.5 * first.duration
    arrival = isochrones(context, way.network, frozen, depart, until)
    return ExploredAlternative(
        way,
        frozen,
        fastest,
        first,
        exact,
        arrival,
        _largest_direction_factor(trade_off, way, frozen),
    )


def network_pareto_front(
    trade_off: TradeOffContext,
    network: Network,
    frozen: FrozenSea,
    latest: float,
    *,
    lower: bool = True,
) -> NetworkFront:
    """Search the exact front of a network.

    Raises
    ------
    Stopped
        If Ctrl-C is pressed before there is a front.
    """
    context = trade_off.context
    share_of_labels = 0.5 if lower else 1.0

    def progress(share: float) -> None:
        if share < share_of_labels and trade_off.interrupt_guard.stopped():
            raise SearchInterrupted

    depart = context.voyage.earliest_departure
    prices = trade_off.objective.prices
    differs = prices.differs_in_control_areas
    return pareto_front(
        network,
        frozen.stations,
        context.table,
        trade_off.consumption,
        start=network.meta.start,
        goal=network.meta.goal,
        depart=depart,
        limits=trade_off.limits,
        latest=latest,
        settings=trade_off.settings,
        prices=prices,
        eca_fraction=eca_fractions(network, context.chart) if differs else None,
        wait=context.voyage.wait,
        bin_s=(latest - depart) / _TIME_BINS,
        top_speed=frozen.top_speed,
        lower=lower,
        progress=progress,
    )


def _largest_direction_factor(
    trade_off: TradeOffContext, way: RouteAlternative, frozen: FrozenSea
) -> float:
    """Return the factor of directions for the slowest setting in the strongest current."""
    slowest = float(np.min(np.asarray(trade_off.context.ship.speeds)[trade_off.settings]))
    ratio = strongest_current(frozen.stations) / slowest if slowest > 0.0 else 1.0
    return direction_factor(way.network.meta.gap_rad, ratio)


def fastest_at_highest_feasible_setting(
    trade_off: TradeOffContext, network: Network, frozen: FrozenSea
) -> tuple[SearchResult, int]:
    """Search the fastest way at the highest setting with which there is one; return both.

    A lower setting may keep what is forbidden in waves where the highest does not.
    """
    table = trade_off.context.table.kernel_arrays()
    heeds = table.safety.size > 0 or table.motions.size > 0
    tried = trade_off.settings[::-1] if heeds else trade_off.settings[-1:]
    ways = ((fastest_path(trade_off, network, frozen, int(one)), int(one)) for one in tried)
    first = next(ways)
    return first if first[0].found else next((way for way in ways if way[0].found), first)


def fastest_path(
    trade_off: TradeOffContext, network: Network, frozen: FrozenSea, setting: int
) -> SearchResult:
    """Search the fastest way over a network at one setting."""
    context = trade_off.context
    return earliest_arrival(
        network,
        frozen.stations,
        context.table,
        start=network.meta.start,
        goal=network.meta.goal,
        depart=context.voyage.earliest_departure,
        setting=setting,
        limits=trade_off.limits,
        wait=context.voyage.wait,
        top_speed=frozen.top_speed,
    )


def extend_horizon(trade_off: TradeOffContext, network: Network) -> SearchHorizon:
    """Freeze the sea over a network as long as its front needs it, and search the fastest way.

    Without a latest arrival that is until the slowest ship worth looking at has arrived. How long
    it takes is guessed by its speed in still water first; where currents or weather make it
    slower, the period grows until the cheapest constant setting has been sailed to the end.

    Raises
    ------
    InputError
        If the sea over the shortest period takes more memory than is allowed.
    """
    context, depart = trade_off.context, trade_off.context.voyage.earliest_departure
    asked = math.isfinite(context.latest_arrival)
    tides = math.isfinite(context.needs.limits[codes.LIMIT_REQUIRED_DEPTH])
    length = shortest_path_length(network)
    if math.isinf(length):  # no way: the sea is frozen as for a straight one
        ends = trade_off.ends[0], trade_off.ends[-1]
        length = float(distance(ends[0].lat, ends[0].lon, ends[1].lat, ends[1].lon))
    still = length / float(context.ship.speeds[most_economical_setting(trade_off)])
    slow = depart + _SLOWEST_TIME_RATIO * still + (_TWO_TIDES if tides else 0.0)
    final = min(context.data_end, depart + _MAX_TIME_RATIO * still + _TWO_TIDES)
    latest = min(context.latest_arrival, context.data_end) if asked else min(slow, final)
    ahead: SearchHorizon | None = None
    while True:
        until = latest if asked else min(latest + _HORIZON_MARGIN * (latest - depart), final)
        until = max(until, min(slow, final))
        try:
            frozen = freeze_at_stations(context, network, depart, until)
        except InputError:
            if ahead is None:
                raise
            return ahead  # what fits into the memory
        warm_up.wait_until_compiled()
        first, setting = fastest_at_highest_feasible_setting(trade_off, network, frozen)
        ahead = SearchHorizon(frozen, first, setting, latest)
        need = first.arrive if asked else _latest_useful_arrival(trade_off, network, frozen, until)
        if need <= until or until >= final:
            return ahead
        slow = depart + _HORIZON_GROWTH * (until - depart) if math.isinf(need) else need
        latest = latest if asked else min(slow, final)


def _latest_useful_arrival(
    trade_off: TradeOffContext, network: Network, frozen: FrozenSea, until: float
) -> float:
    """Return until when a front is worth looking for: later than its cheapest constant setting.

    Infinite while a setting that has not arrived when the frozen sea ends may still be cheaper.
    """
    depart = trade_off.context.voyage.earliest_departure

    def duration(setting: int) -> float:
        return fastest_path(trade_off, network, frozen, setting).arrive - depart

    late = _TIME_MARGIN * duration(most_economical_setting(trade_off))
    if depart + late <= until:
        return depart + late
    rates = trade_off.calm_water_cost_rates
    time = np.array([duration(int(setting)) for setting in trade_off.settings])
    cost = rates * np.minimum(time, until - depart)  # of what has not arrived: so much at least
    return depart + _TIME_MARGIN * float(time[np.argmin(cost)])


def shortest_path_length(network: Network) -> float:
    """Return the length of the shortest way over a network [m]; inf if there is none."""
    meta = network.meta
    return float(shortest_path(network, meta.start, meta.goal)[0][meta.goal])


def most_economical_setting(trade_off: TradeOffContext) -> int:
    """Return the setting that makes a mile cheapest in still water."""
    speeds = np.asarray(trade_off.context.ship.speeds)[trade_off.settings]
    cost = trade_off.calm_water_cost_rates / speeds
    return int(trade_off.settings[np.argmin(cost)])


def track_from_front_point(network: Network, point: Any) -> Track:
    """Turn a point of an exact front into a track."""
    path = np.asarray(point.path)
    wait = np.maximum(0.0, np.asarray(point.path_depart) - np.asarray(point.path_arrive))
    wait[-1] = 0.0
    wait = np.where(wait < 1.0, 0.0, wait)
    setting = np.asarray(point.setting)
    lat, lon = network.station_lat[path], network.station_lon[path]
    kept = np.flatnonzero(_essential_nodes(lat, lon, setting, wait))
    return Track(lat[kept], lon[kept], float(point.path_arrive[0]), wait[kept], setting[kept[:-1]])


def _essential_nodes(lat: FloatArray, lon: FloatArray, setting: Any, wait: FloatArray) -> Any:
    """Return which points of a path are needed: it turns, waits or changes its speed there."""
    keep = np.ones(len(lat), bool)
    _, course, back = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
    turn = np.angle(np.exp(1j * (course[1:] - back[:-1])))
    same = (np.abs(turn) < _MIN_COURSE_CHANGE) & (setting[1:] == setting[:-1]) & (wait[1:-1] == 0.0)
    keep[1:-1] = ~same
    return keep


def evenly_spaced_subset(time: FloatArray, value: FloatArray, count: int) -> np.ndarray:
    """Return indices of at most ``count`` points of a front: its ends, and evenly between."""
    order = np.argsort(time, kind="stable")
    if len(order) <= count:
        return order
    x = (time[order] - time[order[0]]) / max(float(np.ptp(time)), 1e-12)
    y = (value[order] - value.min()) / max(float(np.ptp(value)), 1e-12)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    wanted = np.linspace(0.0, along[-1], count)
    picked = np.unique(np.abs(along[None, :] - wanted[:, None]).argmin(axis=1))
    return np.asarray(order[picked])


def non_dominated_indices(time: FloatArray, value: FloatArray) -> list[int]:
    """Return the indices of what is not dominated, by ascending time."""
    kept: list[int] = []
    least = math.inf
    for index in np.lexsort((value, time)):
        if value[index] * (1.0 + 1e-9) < least:
            kept.append(int(index))
            least = float(value[index])
    return kept


def strongest_current(stations: StationFields) -> float:
    """Return the strongest current [m/s] in frozen fields; 0 where there is none."""
    east, north = (stations.channel_index[c] for c in (codes.CURRENT_EAST, codes.CURRENT_NORTH))
    if east < 0 or north < 0:
        return 0.0
    squared = stations.values[:, :, east] ** 2 + stations.values[:, :, north] ** 2
    return math.sqrt(float(np.nanmax(squared, initial=0.0)))
