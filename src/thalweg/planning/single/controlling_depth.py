"""Controlling depth: the greatest least depth between two places, at the highest tide."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.geodesy import longitude_difference
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import BED_DEPTH, WATER_LEVEL
from thalweg.network import Network
from thalweg.sea import StationFields

_MAX_BISECTIONS = 60
_AS_HIGH: Final = 0.03  # of the range of the tide: high waters so near the highest are as high


class ControllingDepth(NamedTuple):
    """The shallowest place of the deepest path.

    Attributes
    ----------
    depth : Greatest depth over time [m]; -inf where unknown.
    lat, lon : [deg].
    time : Time of the highest water there [s since 1970]; NaN if it does not change.
    """

    depth: float
    lat: float
    lon: float
    time: float


def find_controlling_depth(network: Network, fields: StationFields) -> ControllingDepth | None:
    """Return the shallowest place of the deepest path, each place at its highest tide.

    Parameters
    ----------
    network : With start and goal.
    fields : The sea at its stations, with depth and level where known.

    Returns
    -------
    ControllingDepth or None : None if the network does not connect start and goal.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    start, goal = network.meta.start, network.meta.goal
    greatest, place = _maximum_depths(network, fields)
    tails, heads, n = network.tails(), network.graph.target, network.n_nodes

    def parts(keep: np.ndarray) -> np.ndarray:
        ones = np.ones(int(keep.sum()), np.int8)
        graph = coo_array((ones, (tails[keep], heads[keep])), shape=(n, n))
        return np.asarray(connected_components(graph, directed=False)[1])

    whole = parts(np.ones(len(heads), bool))
    if whole[start] != whole[goal]:
        return None
    levels = np.unique(greatest)
    low, high = 0, len(levels) - 1  # connected at low; bisect for the highest level that connects
    for _ in range(_MAX_BISECTIONS):
        if low >= high:
            break
        middle = (low + high + 1) // 2
        of = parts(greatest >= levels[middle])
        low, high = (middle, high) if of[start] == of[goal] else (low, middle - 1)
    depth = float(levels[low])
    of = parts(greatest > depth)
    least = np.flatnonzero((greatest == depth) & (of[tails] != of[heads]))
    edge = int(least[np.argmin(_detour_measure(network, tails[least], heads[least]))])
    station = int(place[edge])
    return ControllingDepth(
        depth, float(network.stations.lat[station]), float(network.stations.lon[station]),
        _time_of_high_water(fields, station),
    )  # fmt: skip


def _detour_measure(network: Network, tails: np.ndarray, heads: np.ndarray) -> FloatArray:
    """Return the sum of rough distances of legs to start and goal [deg]."""
    lat = 0.5 * (network.stations.lat[tails] + network.stations.lat[heads])
    lon = 0.5 * (network.stations.lon[tails] + network.stations.lon[heads])
    away = np.zeros(len(lat))
    for end in (network.meta.start, network.meta.goal):
        east = longitude_difference(lon, network.stations.lon[end])
        away += np.hypot(lat - network.stations.lat[end], east * np.cos(np.radians(lat)))
    return away


def _maximum_depths(network: Network, fields: StationFields) -> tuple[FloatArray, np.ndarray]:
    """Return the greatest depth over time of each edge [m], and its shallowest station."""
    bed = _maximum_over_time(fields, BED_DEPTH, math.inf)
    level = _maximum_over_time(fields, WATER_LEVEL, 0.0)
    charted = np.asarray(network.edges.depth, float)
    charted = np.where(np.isnan(charted), -math.inf, charted)
    inside = network.samples
    edge = np.repeat(np.arange(len(charted)), np.diff(inside.ptr))
    ends = np.stack([network.tails(), network.graph.target]).astype(np.int64)
    a, b, share = inside.station_a, inside.station_b, inside.weight
    with np.errstate(invalid="ignore"):
        beds, levels = (np.where(share > 0.0, (1.0 - share) * v[a] + share * v[b], v[a])
                        for v in (bed, level))  # fmt: skip
        between = np.minimum(charted[edge], beds) + levels
        at_ends = np.minimum(charted, bed[ends]) + level[ends]
    between = np.where(np.isnan(between), -math.inf, between)
    at_ends = np.where(np.isnan(at_ends), -math.inf, at_ends)
    place = np.where(at_ends[0] <= at_ends[1], ends[0], ends[1])
    depth = at_ends.min(axis=0)
    lower = np.flatnonzero(between < depth[edge])
    np.minimum.at(depth, edge[lower], between[lower])
    least = lower[between[lower] == depth[edge[lower]]][::-1]  # the first of equal samples
    place[edge[least]] = np.where(share > 0.5, b, a)[least]
    return depth, place


def _maximum_over_time(fields: StationFields, channel: int, absent: float) -> FloatArray:
    """Return the greatest value over time of a channel at every station; -inf if unknown."""
    k = fields.channel_index[channel]
    if k < 0:
        return np.full(fields.values.shape[0], absent)
    values = np.fmax.reduce(fields.values[:, :, k], axis=1).astype(float)
    return np.where(np.isnan(values), -math.inf, values)


def _time_of_high_water(fields: StationFields, station: int) -> float:
    """Return the time of the first high water about as high as the highest; NaN without a tide."""
    total = np.zeros(len(fields.times))
    for channel in (BED_DEPTH, WATER_LEVEL):
        k = fields.channel_index[channel]
        if k >= 0:
            total = total + fields.values[station, :, k]
    if np.isnan(total).all() or np.nanmax(total) == np.nanmin(total):
        return math.nan
    highest, lowest = float(np.nanmax(total)), float(np.nanmin(total))
    total = np.where(np.isnan(total), -np.inf, total)
    high = total >= highest - _AS_HIGH * (highest - lowest)
    first = int(np.argmax(high))
    ends = np.flatnonzero(~high[first:])
    around = total[first : first + int(ends[0])] if len(ends) else total[first:]
    return float(fields.times[first + int(np.argmax(around))])
