"""Whether the limits of a ship count in a cell, and whether what they limit is known."""

import math

from thalweg.kernels.codes import (
    BED_DEPTH,
    LIMIT_REQUIRED_DEPTH,
    LIMIT_WAVE_HEIGHT,
    LIMIT_WIND_SPEED,
    WATER_LEVEL,
    WAVE_HEIGHT_CHANNEL,
    WIND_EAST,
    WIND_NORTH,
)
from thalweg.kernels.compilation.decorators import kernel_only


@kernel_only
def limits_are_known(index, sample, limits):
    """Return whether all that limits of a ship count is known: elsewhere she may not be."""
    known = True
    if limits[LIMIT_REQUIRED_DEPTH] > -math.inf:
        for channel in (BED_DEPTH, WATER_LEVEL):
            known = known and not (index[channel] >= 0 and sample[channel] != sample[channel])
    if limits[LIMIT_WAVE_HEIGHT] < math.inf and index[WAVE_HEIGHT_CHANNEL] >= 0:
        known = known and sample[WAVE_HEIGHT_CHANNEL] == sample[WAVE_HEIGHT_CHANNEL]
    if limits[LIMIT_WIND_SPEED] < math.inf and index[WIND_EAST] >= 0 and index[WIND_NORTH] >= 0:
        east, north = sample[WIND_EAST], sample[WIND_NORTH]
        known = known and east == east and north == north
    return known


@kernel_only
def has_limits(world):
    """Return whether depth, waves or wind may close a cell."""
    limits = world.ship.limits
    return (
        limits[LIMIT_REQUIRED_DEPTH] > -math.inf
        or limits[LIMIT_WAVE_HEIGHT] < math.inf
        or limits[LIMIT_WIND_SPEED] < math.inf
    )
