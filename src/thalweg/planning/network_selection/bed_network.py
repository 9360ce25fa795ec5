"""A network on the points of a gridded bed: gullies of one row of the data have nodes on them."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoPathError
from thalweg.core.geodesy import (
    METRES_PER_DEGREE,
    densify,
    distance,
    geocentric_unit_vectors,
)
from thalweg.core.types import FloatArray
from thalweg.network import Network, mesh, with_endpoints
from thalweg.planning.network_selection.bed_along_edges import (
    BedGrid,
    bed_layer,
    with_bed_along_edges,
)
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.sea import Sea

_SLACK: Final = 0.5  # of the length of ways that the network has, over the distance
_MOST_NODES: Final = 30_000
_TIDES: Final = 5.0  # a bed deeper than required by this closes nothing [m]


def network_on_bed(
    chart: Chart, sea: Sea, ends: tuple[Endpoint, Endpoint], required_depth: float
) -> Network | None:
    """Return a network on the points of a gridded bed between two places.

    Parameters
    ----------
    required_depth : Of the ship [m]; -inf if none.

    Returns
    -------
    Network or None : None where the bed closes nothing, is not that of `bed_layer`, or has more
        than 30,000 points near the way.
    """
    if bed_layer(sea) is None or not np.isfinite(required_depth):
        return None
    (lat1, lon1), (lat2, lon2) = ((end.lat, end.lon) for end in ends)
    straight = float(distance(lat1, lon1, lat2, lon2))
    reach = 0.5 * (1.0 + _SLACK) * straight / METRES_PER_DEGREE  # of no way from its middle [deg]
    wide = reach / max(np.cos(np.radians(0.5 * (lat1 + lat2))), 0.1)
    middle = 0.5 * (lat1 + lat2), lon1 + 0.5 * ((lon2 - lon1 + 180.0) % 360.0 - 180.0)
    box = np.array([-1.0, 1.0])
    bed = BedGrid.around(middle[0] + reach * box, middle[1] + wide * box, sea)
    if bed is None or not bed.cells_below(required_depth + _TIDES).any():
        return None
    lat, lon = (axis.ravel() for axis in np.meshgrid(bed.lat, bed.lon, indexing="ij"))
    way = np.asarray(distance(lat1, lon1, lat, lon)) + np.asarray(distance(lat, lon, lat2, lon2))
    near = (way <= (1.0 + _SLACK) * straight) & bed.known_all_round().ravel()
    if not 3 <= near.sum() <= _MOST_NODES:
        return None
    try:
        network = mesh(chart, lat[near], lon[near])
        network = with_endpoints(network, chart, (lat1, lon1), (lat2, lon2))
    except (InputError, NoPathError):
        return None
    return with_bed_along_edges(network, sea, required_depth)


def near_line(network: Network, lat: FloatArray, lon: FloatArray, *, most_nodes: int) -> Network:
    """Return a network with the edges between the nodes nearest to a line.

    Parameters
    ----------
    lat, lon : Of the line [deg].
    most_nodes : That keep their edges.
    """
    line_lat, line_lon, _ = densify(lat, lon, 0.5 * network.meta.spacing_m)
    tree = cKDTree(geocentric_unit_vectors(line_lat, line_lon))
    away, _ = tree.query(geocentric_unit_vectors(network.lat, network.lon))
    near = away <= np.partition(away, min(most_nodes, away.size) - 1)[:most_nodes].max()
    return network.with_some_edges(near[network.tails()] & near[network.graph.target])
