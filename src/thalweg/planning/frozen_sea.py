"""The sea frozen at the stations of a network."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.memory import machine_memory
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.planning.planning_context import PlanningContext
from thalweg.sea import StationFields

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
            "Use a coarser resolution or a shorter window.",
        )
    stations = context.sea.freeze_stations(lat, lon, start, end, channels, extra=extra)
    return FrozenSea(stations, _top_speed(context, stations))


def _top_speed(context: PlanningContext, stations: StationFields) -> float:
    column = stations.channel_index[codes.SPEED_FIELD]
    if column >= 0:
        return float(np.nanmax(stations.values[:, :, column], initial=0.0))
    top = context.ship.top_speed(context.setting)
    return float(context.ship.speeds[context.setting] if top is None else top)
