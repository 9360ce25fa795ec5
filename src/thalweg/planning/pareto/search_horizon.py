"""The period over which the front of a network is searched."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance
from thalweg.core.units import HOUR
from thalweg.kernels.compilation import warm_up
from thalweg.network import Network, shortest_path
from thalweg.planning.frozen_sea import FrozenSea, freeze_at_stations, ship_in_frozen_sea
from thalweg.planning.pareto.trade_off_context import TradeOffContext
from thalweg.planning.single.weather_stall import SearchedWater
from thalweg.search import SearchResult, ShipOnNetwork, earliest_arrival

#: Time of the slowest ship of interest over that in calm water ...
_SLOWEST_TIME_RATIO = 1.25
#: ... and over that of the cheapest constant setting that was sailed.
_TIME_MARGIN = 1.1
#: Longest period over the time in calm water, and the growth of the period per step.
_MAX_TIME_RATIO, _HORIZON_GROWTH = 30.0, 1.6
_TWO_TIDES = 25 * HOUR
#: Extension of the frozen sea, so that the last edges can be sailed to their end.
_HORIZON_MARGIN = 0.05


@dataclass(frozen=True)
class SearchHorizon:
    """The sea over a network for the period of a front.

    Attributes
    ----------
    first : The fastest path; not found where there is none in the period.
    setting : Its setting: the highest with which there is a path.
    latest : Latest arrival of the front [s since 1970].
    """

    frozen: FrozenSea
    first: SearchResult
    setting: int
    latest: float


def searched_water(trade_off: TradeOffContext, horizon: SearchHorizon) -> SearchedWater:
    """Return what the search of a period knew of the sea and the ship, for its refusal."""
    return SearchedWater(
        horizon.frozen.stations,
        trade_off.limits.required_depth,
        trade_off.context.table,
        horizon.setting,
    )


class FastestPaths:
    """The fastest paths of one network at its settings, each searched as seldom as possible.

    A path that was found holds in every longer period, and one that was not found by a time is not
    found by an earlier one. Prices do not matter: several objectives can share the paths.
    """

    def __init__(self) -> None:
        self._searched: dict[int, tuple[float, SearchResult]] = {}

    def path(
        self,
        trade_off: TradeOffContext,
        network: Network,
        sea: FrozenSea,
        until: float,
        setting: int,
    ) -> SearchResult:
        """Return the fastest path at a setting in a sea that is frozen until a time [s]."""
        known, result = self._searched.get(setting, (-math.inf, None))
        if result is not None and (result.arrive <= until if result.found else until <= known):
            return result
        found = fastest_path(trade_off, network, sea, setting)
        if result is None or not result.found:  # one that arrives later stays known
            self._searched[setting] = until, found
        return found

    def arrival(
        self,
        trade_off: TradeOffContext,
        network: Network,
        sea: FrozenSea,
        until: float,
        setting: int,
    ) -> float:
        """Return the arrival of that path [s]; infinite where it is later than the period."""
        _, result = self._searched.get(setting, (-math.inf, None))
        if result is not None and result.found and result.arrive > until:
            return math.inf
        return self.path(trade_off, network, sea, until, setting).arrive


def extend_horizon(
    trade_off: TradeOffContext, network: Network, paths: FastestPaths | None = None
) -> SearchHorizon:
    """Freeze the sea over a network for the period of its front, and search the fastest path.

    Without a latest arrival the period ends when the slowest ship of interest has arrived. It is
    first estimated from the speed in calm water. Where currents or weather make the ship slower,
    the period grows until the cheapest constant setting reaches the goal.

    Parameters
    ----------
    trade_off : The plan and its prices.
    network : With start and goal.
    paths : Of this network and these limits, found for other prices.

    Returns
    -------
    SearchHorizon : The frozen sea, the fastest path and the latest arrival.

    Raises
    ------
    InputError : If the sea over the shortest period exceeds the memory limit.
    """
    context, depart = trade_off.context, trade_off.context.voyage.earliest_departure
    has_deadline = math.isfinite(context.latest_arrival)
    tides = context.needs.limits.depth_checked
    length = shortest_path_length(network)
    if math.isinf(length):  # no path: the period of the geodesic
        ends = trade_off.ends[0], trade_off.ends[-1]
        length = float(distance(ends[0].lat, ends[0].lon, ends[1].lat, ends[1].lon))
    still = length / float(context.ship.speeds[most_economical_setting(trade_off)])
    slow = depart + _SLOWEST_TIME_RATIO * still + (_TWO_TIDES if tides else 0.0)
    final = min(context.data_end, depart + _MAX_TIME_RATIO * still + _TWO_TIDES)
    latest = min(context.latest_arrival, context.data_end) if has_deadline else min(slow, final)
    horizon: SearchHorizon | None = None
    paths = paths or FastestPaths()
    while True:
        until = latest if has_deadline else min(latest + _HORIZON_MARGIN * (latest - depart), final)
        until = max(until, min(slow, final))
        try:
            frozen = freeze_at_stations(context, network, depart, until)
        except InputError:
            if horizon is None:
                raise
            return horizon  # the longest period that fits into memory
        warm_up.wait_until_compiled()
        path_at = partial(paths.path, trade_off, network, frozen, until)
        first, setting = fastest_at_highest_feasible_setting(trade_off, path_at)
        horizon = SearchHorizon(frozen, first, setting, latest)
        arrival = partial(paths.arrival, trade_off, network, frozen, until)
        need = first.arrive if has_deadline else _latest_useful_arrival(trade_off, arrival, until)
        if need <= until or until >= final:
            return horizon
        slow = depart + _HORIZON_GROWTH * (until - depart) if math.isinf(need) else need
        latest = latest if has_deadline else min(slow, final)


def _latest_useful_arrival(
    trade_off: TradeOffContext, arrival: Callable[[int], float], until: float
) -> float:
    """Return the end of the front's period: with a margin, when the cheapest setting arrives.

    Infinite while a setting that has not arrived at the end of the frozen sea may be cheaper.

    Parameters
    ----------
    arrival : The earliest at a setting [s].
    """
    depart = trade_off.context.voyage.earliest_departure

    def duration(setting: int) -> float:
        return arrival(setting) - depart

    late = _TIME_MARGIN * duration(most_economical_setting(trade_off))
    if depart + late <= until:
        return depart + late
    rates = trade_off.calm_water_cost_rates
    time = np.array([duration(int(setting)) for setting in trade_off.settings])
    cost = rates * np.minimum(time, until - depart)  # a lower bound where the ship has not arrived
    return depart + _TIME_MARGIN * float(time[np.argmin(cost)])


def fastest_at_highest_feasible_setting(
    trade_off: TradeOffContext, path_at: Callable[[int], SearchResult]
) -> tuple[SearchResult, int]:
    """Search the fastest path at the highest setting with which there is one; return both.

    A lower setting may keep limits in waves that the highest does not.

    Parameters
    ----------
    path_at : The fastest path at a setting.
    """
    table = trade_off.context.table.kernel_arrays()
    has_wave_limits = table.safety.size > 0 or table.motions.size > 0
    tried = trade_off.settings[::-1] if has_wave_limits else trade_off.settings[-1:]
    paths = ((path_at(int(one)), int(one)) for one in tried)
    first = next(paths)
    return first if first[0].found else next((path for path in paths if path[0].found), first)


def fastest_path(
    trade_off: TradeOffContext, network: Network, frozen: FrozenSea, setting: int
) -> SearchResult:
    """Search the fastest path over a network at one setting."""
    context = trade_off.context
    return earliest_arrival(
        ship_on_network(trade_off, network, frozen, setting),
        start=network.meta.start,
        goal=network.meta.goal,
        depart=context.voyage.earliest_departure,
        wait=context.voyage.wait,
    )


def ship_on_network(
    trade_off: TradeOffContext, network: Network, frozen: FrozenSea, setting: int
) -> ShipOnNetwork:
    """Return the ship at one setting on a network, within the limits of the trade-off."""
    return ship_in_frozen_sea(
        trade_off.context, network, frozen, setting=setting, limits=trade_off.limits
    )


def shortest_path_length(network: Network) -> float:
    """Return the length of the shortest path over a network [m]; inf if there is none."""
    meta = network.meta
    return float(shortest_path(network, meta.start, meta.goal)[0][meta.goal])


def most_economical_setting(trade_off: TradeOffContext) -> int:
    """Return the setting with the least cost per distance in calm water."""
    speeds = np.asarray(trade_off.context.ship.speeds)[trade_off.settings]
    cost = trade_off.calm_water_cost_rates / speeds
    return int(trade_off.settings[np.argmin(cost)])
