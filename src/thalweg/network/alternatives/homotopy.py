"""Homotopy classes of paths: on which side they pass islands, by meridian crossings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import MEAN_RADIUS, wrap_longitude
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.network.static_paths import meridian_crossings
from thalweg.network.network import Network

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.rings import Rings

CrossingCounts: TypeAlias = NDArray[np.int8]
_MAX_ISLANDS = 120  # only the largest islands count


@dataclass(frozen=True, eq=False)
class Obstacles:
    """Islands that separate paths, and the crossings of their meridians by the network's edges.

    Attributes
    ----------
    points : float64[K, 2]
        A position [deg] on each island; the first is the south pole, whose line is a whole
        meridian.
    crossings : int8[E, K + C]
        For each edge, the crossings of the meridian north of each point (+1 eastward), then for
        each of C canals 1 if the edge is that canal.
    """

    points: FloatArray
    crossings: CrossingCounts

    def sides(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> CrossingCounts:
        """Return the crossings (n, K) of legs [deg]."""
        count = np.arange(len(lat1))
        crossings = np.empty((len(count), len(self.points)), np.int8)
        lat, lon = np.concatenate([lat1, lat2]), np.concatenate([lon1, lon2])
        meridian_crossings(lat, lon, count, count + len(count), self.points, crossings)
        return crossings

    def along(self, chart: Chart, lat: FloatArray, lon: FloatArray) -> bytes:
        """Return the crossings of a path given by its waypoints [deg], as a key."""
        nodes = np.arange(len(lat))
        return (
            _meridian_crossing_counts(chart, lat, lon, nodes[:-1], nodes[1:], self.points)
            .sum(axis=0)
            .tobytes()
        )


def obstacles(network: Network, chart: Chart, island: float) -> Obstacles:
    """Return the land that paths over a network can pass on either side.

    Parameters
    ----------
    island : Land narrower than this [m] (square root of its area) does not count.
    """
    points = np.concatenate(
        [[[-90.0, 0.5 * (network.lon[0] + 180.0)]], _large_land(network, chart, island)]
    )
    tail, head = network.tails().astype(np.int64), network.graph.target.astype(np.int64)
    return Obstacles(
        points, _meridian_crossing_counts(chart, network.lat, network.lon, tail, head, points)
    )


def _meridian_crossing_counts(
    chart: Chart, lat: FloatArray, lon: FloatArray, first: IntArray, second: IntArray,
    points: FloatArray,
) -> CrossingCounts:  # fmt: skip
    crossings = np.empty((len(first), len(points)), np.int8)
    meridian_crossings(
        np.ascontiguousarray(lat), np.ascontiguousarray(lon), first, second, points, crossings
    )
    through = chart.canal_of_legs(lat[first], lon[first], lat[second], lon[second])
    canals = through[:, None] == np.arange(len(chart.canals))
    return np.concatenate([crossings, canals.astype(np.int8)], axis=1)


def _large_land(network: Network, chart: Chart, island: float) -> FloatArray:
    """Return a position on each piece of land that is large enough and near the network."""
    rings = chart.coastline.rings
    if not len(rings):
        return np.empty((0, 2))
    begin = rings.start[:-1]
    low, high = (f.reduceat(rings.lat, begin) for f in (np.minimum, np.maximum))
    lon0 = float(network.lon[network.meta.start])
    offset = wrap_longitude(rings.lon - lon0)
    west, east = (f.reduceat(offset, begin) for f in (np.minimum, np.maximum))
    area = ring_areas(rings)
    own = wrap_longitude(network.lon - lon0)
    near = (low <= network.lat.max()) & (high >= network.lat.min())
    near &= (west <= own.max()) & (east >= own.min())
    chosen = np.flatnonzero(near & (area >= island**2))
    chosen = chosen[np.argsort(-area[chosen])][:_MAX_ISLANDS]
    return np.stack([rings.lat[begin[chosen]], rings.lon[begin[chosen]]], axis=1)


def ring_areas(rings: Rings) -> FloatArray:
    """Return the areas [m2] of rings on a sphere, from sums of strips under their edges."""
    lat, lon, start = rings.lat, rings.lon, rings.start
    step = np.radians(np.diff(lon)) * np.sin(np.radians(0.5 * (lat[:-1] + lat[1:])))
    step[start[1:-1] - 1] = 0.0
    return np.asarray(np.abs(np.add.reduceat(np.append(step, 0.0), start[:-1])) * MEAN_RADIUS**2)
