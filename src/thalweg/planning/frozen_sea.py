"""The sea frozen at the stations of a network."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.limits import Limits
from thalweg.core.memory import machine_memory
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.network.network import Stations
from thalweg.planning.planning_context import PlanningContext, greatest_speed_of
from thalweg.sea import StationFields
from thalweg.search import ShipOnNetwork

#: Greatest size of frozen fields [bytes].
MEMORY_LIMIT = min(4_000_000_000, machine_memory() // 2)


@dataclass(frozen=True)
class FrozenSea:
    """The sea at the stations of a network, and the greatest speed in it.

    Attributes
    ----------
    top_speed : Upper bound of the speed through water [m/s].
    """

    stations: StationFields
    top_speed: float


def ship_in_frozen_sea(
    context: PlanningContext, network: Network, frozen: FrozenSea, *, setting: int, limits: Limits
) -> ShipOnNetwork:
    """Return the ship at one setting on a network in a frozen sea."""
    return ShipOnNetwork(
        network,
        frozen.stations,
        context.table,
        setting=setting,
        limits=limits,
        top_speed=frozen.top_speed,
    )


@dataclass
class LastFrozenSea:
    """The sea that was frozen last, for searches at the same stations in the same period.

    Attributes
    ----------
    stations, period : Of that sea.
    horizon : Number of the shortest period that was long enough for a search at these stations.
    """

    stations: Stations | None = None
    period: tuple[float, float] = (math.nan, math.nan)
    sea: FrozenSea | None = None
    horizon: int = 0

    def first_horizon(self, network: Network) -> int:
        """Return the number of the first period for a search with equal or stricter limits."""
        return self.horizon if network.stations is self.stations else 0

    def freeze(
        self, context: PlanningContext, network: Network, start: float, end: float
    ) -> FrozenSea:
        """Return the sea at the stations of a network; see `freeze_at_stations`."""
        known = network.stations is self.stations and self.period == (start, end)
        if self.sea is None or not known:
            self.sea = None  # its memory is free before the next is read
            self.sea = freeze_at_stations(context, network, start, end)
            self.stations, self.period = network.stations, (start, end)
        return self.sea


def freeze_at_stations(
    context: PlanningContext, network: Network, start: float, end: float
) -> FrozenSea:
    """Freeze the sea at the stations of a network.

    Raises
    ------
    InputError : If the fields exceed `MEMORY_LIMIT`.
    """
    lat, lon = network.stations.lat, network.stations.lon
    steps = len(context.sea.times(start, end))
    channels = context.needs.channels
    extra = None
    if context.ship.speed_field is not None:
        extra = {codes.SPEED_FIELD: context.ship.speed_field}
    size = len(lat) * steps * (len(channels) + bool(extra)) * 4
    if size > MEMORY_LIMIT:
        raise InputError(
            f"The sea at {len(lat):,} stations and {steps:,} times takes {size / 1e9:.1f} GB.",
            f"The limit is {MEMORY_LIMIT / 1e9:.0f} GB.",
            "Use a coarser resolution, a shorter window, or a longer time step of the sea's "
            "functions; waits for a limit to open are searched over days.",
        )
    stations = context.sea.freeze_stations(lat, lon, start, end, channels, extra=extra)
    return FrozenSea(stations, _top_speed(context, stations))


def _top_speed(context: PlanningContext, stations: StationFields) -> float:
    column = stations.channel_index[codes.SPEED_FIELD]
    if column >= 0:
        return float(np.nanmax(stations.values[:, :, column], initial=0.0))
    return greatest_speed_of(context.ship, context.table, context.setting)
