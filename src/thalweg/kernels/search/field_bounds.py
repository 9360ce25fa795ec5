"""Extremes of frozen fields: bounds for searches, and edges too shallow at every tide."""

import math

from thalweg.kernels.codes import (
    BED_DEPTH,
    CURRENT_EAST,
    CURRENT_NORTH,
    DEPTH,
    NO_DATA,
    OK,
    SPEED_FIELD,
    WATER_LEVEL,
)
from thalweg.kernels.compilation.decorators import allocation_free, inlined


@inlined
def never_deep_enough(network, sea, edge, required):
    """Return `OK`, or why no tide in the data makes an edge deep enough."""
    depth, head = network.depth[edge], network.station[network.target[edge]]
    if network.fixed_time[edge] == network.fixed_time[edge]:
        return OK
    if depth != depth:
        return NO_DATA
    enough = required - 1e-4  # the extremes are rounded
    if depth + sea.highest[head] < enough or sea.deepest[head] < enough:
        return DEPTH
    return OK


@allocation_free
def tidal_extremes(sea):
    """Fill ``sea.highest`` and ``sea.deepest``; NaN in the fields is passed over.

    Without a water level the highest is 0; without a bed depth the deepest is +inf.
    """
    i, j = sea.channel_index[WATER_LEVEL], sea.channel_index[BED_DEPTH]
    for s in range(sea.values.shape[0]):
        highest, deepest = -math.inf, -math.inf
        for t in range(sea.values.shape[1]):
            level = 1.0 * sea.values[s, t, i] if i >= 0 else 0.0
            if level > highest:
                highest = level
            if j >= 0 and sea.values[s, t, j] + level > deepest:
                deepest = sea.values[s, t, j] + level
        sea.highest[s] = highest if highest > -math.inf else math.inf
        sea.deepest[s] = deepest if deepest > -math.inf else math.inf


@allocation_free
def largest_current(sea):
    """Return the largest strength of current in the fields [m/s]; 0 when they have none."""
    i, j = sea.channel_index[CURRENT_EAST], sea.channel_index[CURRENT_NORTH]
    if i < 0 or j < 0:
        return 0.0
    largest = 0.0
    values = sea.values
    for s in range(values.shape[0]):
        for t in range(values.shape[1]):
            u, v = 1.0 * values[s, t, i], 1.0 * values[s, t, j]  # in double precision
            squared = u * u + v * v
            if squared > largest:
                largest = squared
    return math.sqrt(largest)


@allocation_free
def largest_speed_field(sea):
    """Return the largest value of the speed field [m/s]; -1 when there is none."""
    k = sea.channel_index[SPEED_FIELD]
    largest = -1.0
    if k >= 0:
        values = sea.values
        for s in range(values.shape[0]):
            for t in range(values.shape[1]):
                if values[s, t, k] > largest:
                    largest = float(values[s, t, k])
    return largest
