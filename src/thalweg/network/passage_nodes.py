"""Nodes along the lines of named passages, so that every network leads through them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import densify
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.assembly import Pairs, allowed_legs, measured_pairs
from thalweg.network.network import Stations

if TYPE_CHECKING:
    from thalweg.chart import Chart

_NARROW: Final = 1.0 * NAUTICAL_MILE  # half width below which a passage has nodes at any offing
_MARGIN: Final = 1.2  # the same, in offings
_NODE_SPACING: Final = 3.0 * NAUTICAL_MILE  # greatest distance between nodes


class PassageNodes(NamedTuple):
    """Positions along passages.

    Attributes
    ----------
    lat, lon : float64[n] [deg]
    joined : bool[n]
        Whether each is on the same passage as the one before.
    """

    lat: FloatArray
    lon: FloatArray
    joined: BoolArray

    def where(self, keep: BoolArray) -> PassageNodes:
        """Return the selected positions; those that follow an omitted one are not joined."""
        joined = self.joined & np.append(False, keep[:-1])
        return PassageNodes(self.lat[keep], self.lon[keep], joined[keep])

    def followed_by(self, others: PassageNodes) -> PassageNodes:
        """Return these positions and then others."""
        return PassageNodes(*(np.concatenate(pair) for pair in zip(self, others)))


def passage_nodes(chart: Chart) -> PassageNodes:
    """Return positions along the passages of a chart that are not much wider than its offing."""
    widest = max(_NARROW, _MARGIN * chart.offing.distance)
    lat, lon, joined = [np.empty(0)], [np.empty(0)], [np.empty(0, bool)]
    for passage in chart.passages:
        if not passage.half_width <= widest:
            continue
        y, x, _ = densify(*passage.positions, _NODE_SPACING)
        lat.append(y)
        lon.append(x)
        joined.append(np.arange(len(y)) > 0)
    found = PassageNodes(np.concatenate(lat), np.concatenate(lon), np.concatenate(joined))
    return found.where(np.asarray(chart.is_navigable(found.lat, found.lon), bool))


def passage_pairs(chart: Chart, stations: Stations, first: int, joined: BoolArray) -> Pairs:
    """Return allowed pairs of each node from ``first`` on and the one before, where joined."""
    second = first + np.flatnonzero(joined)
    lat, lon = stations.lat, stations.lon
    pairs = measured_pairs(lat, lon, (second - 1).astype(np.int32), second.astype(np.int32))
    pairs = pairs.where(pairs.length > 1.0)
    return pairs.where(allowed_legs(chart, lat, lon, pairs.first, pairs.second)[0])


def pairs_without(pairs: Pairs, others: Pairs) -> Pairs:
    """Return the pairs that join no two nodes that another lot of pairs joins."""

    def keys(lot: Pairs) -> NDArray[np.int64]:
        low, high = np.minimum(lot.first, lot.second), np.maximum(lot.first, lot.second)
        return low.astype(np.int64) << 32 | high.astype(np.int64)

    return pairs.where(~np.isin(keys(pairs), keys(others)))
