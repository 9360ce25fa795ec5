"""Nodes in the lanes of traffic separation schemes, which are narrower than edges at sea."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.zones.traffic_schemes import TRAFFIC_SCHEMES
from thalweg.core.geodesy import densify
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.passage_nodes import PassageNodes

if TYPE_CHECKING:
    from thalweg.chart import Chart

_NODE_SPACING: Final = 8.0 * NAUTICAL_MILE  # greatest distance between nodes
_SHARE: Final = 0.5  # of the width of a lane, from the separation zone


def lane_nodes(chart: Chart) -> PassageNodes:
    """Return positions along the middle of both lanes of the schemes that a chart keeps.

    Parameters
    ----------
    chart : With lanes of schemes of the package; others have no nodes.
    """
    kept = {lane.name.partition(", ")[0] for lane in chart.zones.lanes}
    lines = []
    for scheme in TRAFFIC_SCHEMES:
        for side in (1.0, -1.0) if scheme.name in kept else ():
            lon, lat = scheme.shifted(side * (scheme.zone + _SHARE * scheme.lane)).T
            lines.append(densify(lat, lon, _NODE_SPACING)[:2])
    lat, lon = (np.concatenate([np.empty(0), *(line[k] for line in lines)]) for k in (0, 1))
    joined = [np.arange(len(line[0])) > 0 for line in lines]
    found = PassageNodes(lat, lon, np.concatenate([np.empty(0, bool), *joined]))
    return found.where(np.asarray(chart.is_navigable(lat, lon), bool))
