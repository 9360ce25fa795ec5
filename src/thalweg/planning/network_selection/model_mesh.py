"""A network on the mesh of a hydrodynamic model, thinned where its flow is slow and straight."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.network import Network, mesh
from thalweg.network.triangular_mesh.thinning import dimensionless_curl
from thalweg.sea import Mesh, Sea, standard_names

MAX_TIMES = 150  #: times at which the flow is sampled
MAX_MESH_NODES = 30_000  #: larger models are thinned unless a spacing is given
_FLOW_PERIOD = 25 * HOUR  # two tides
_SPACING_GROWTH = 1.25  # growth of the spacing per step
_MIN_SPEED_SCALE = 0.1  # least speed [m/s] that makes the curl dimensionless


def pruned_mesh(
    chart: Chart,
    sea: Sea,
    start: float,
    end: float,
    *,
    largest_spacing: float | None,
    **options: Any,
) -> Network:
    """Build a network on the model's nodes, dense where the flow is strong or turns.

    Parameters
    ----------
    sea : With a mesh.
    start, end : Period over which the flow is sampled [s since 1970], as far as the data cover it.
    largest_spacing : Spacing of the nodes in still water [m]. With the greatest speed of the flow
        it makes the curl dimensionless: the relative change of the current over one spacing. None
        uses all nodes.
    **options
        ``alpha``, ``curl_power``, ``speed_power``, ``rings`` and ``sampling`` of
        `thalweg.network.mesh`.

    Returns
    -------
    Network : Without start and goal (see `thalweg.network.with_endpoints`).

    Raises
    ------
    InputError : If the sea has no mesh.
    """
    model = sea.mesh()
    if model is None:
        raise InputError(
            "The network 'mesh' was chosen, but the sea has no mesh.",
            "UGRID files of hydrodynamic models contain a mesh.",
            "Use a lattice, or open such a file.",
        )
    speed, curl = None, None
    if largest_spacing is not None:
        speed, curl = flow_statistics(sea, start, end, length=largest_spacing)
    return mesh(
        chart, model.lat, model.lon, model.triangles, speed=speed, curl=curl,
        largest_spacing=largest_spacing, **options,
    )  # fmt: skip


def model_mesh_network(
    chart: Chart, sea: Sea, period: tuple[float, float], *, spacing: float | None = None
) -> Network:
    """Build a network on all nodes of a model, or on a selection with a spacing.

    Parameters
    ----------
    sea : With a mesh.
    period : Period of the voyage [s since 1970]; the flow is sampled in its first 25 h.
    spacing : Spacing in still water [m], finer where the flow is strong or turns. By default all
        nodes are used, or about `MAX_MESH_NODES` of larger models.
    """
    model = sea.mesh()
    if spacing is None and (model is None or model.lat.size <= MAX_MESH_NODES):
        return pruned_mesh(chart, sea, *period, largest_spacing=None)
    start, end = period[0], min(period[1], period[0] + _FLOW_PERIOD)
    if spacing is not None:
        return pruned_mesh(chart, sea, start, end, largest_spacing=spacing)
    assert model is not None  # its size is known above
    spacing = 2.0 * mean_spacing(model)
    network = pruned_mesh(chart, sea, start, end, largest_spacing=spacing)
    while network.n_nodes > MAX_MESH_NODES:
        spacing *= max(_SPACING_GROWTH, math.sqrt(network.n_nodes / MAX_MESH_NODES))
        network = pruned_mesh(chart, sea, start, end, largest_spacing=spacing)
    return network


def mean_spacing(model: Mesh) -> float:
    """Return the mean length of the sides of a model's triangles [m]."""
    a, b = model.triangles[:, 0], model.triangles[:, 1]
    return float(np.mean(distance(model.lat[a], model.lon[a], model.lat[b], model.lon[b])))


def flow_statistics(
    sea: Sea, start: float, end: float, *, length: float
) -> tuple[FloatArray | None, FloatArray | None]:
    """Return the largest speed [m/s] and dimensionless curl over a period at the mesh's nodes.

    Unknown currents (dry flats) count as zero; without currents both results are None.
    """
    model = sea.mesh()
    if model is None or not set(standard_names.CURRENT.pair) <= sea.variables:
        return None, None
    times = _times(sea, start, end)
    flow = sea.series(standard_names.CURRENT.pair, times, model.lat, model.lon)
    # only the density of the nodes: the search reads the currents as they are
    east, north = (np.nan_to_num(flow[name]).T for name in standard_names.CURRENT.pair)
    speed = np.hypot(east, north).max(axis=0)
    curl = dimensionless_curl(
        model.lat, model.lon, model.triangles, east, north,
        length=length, speed=max(float(speed.max()), _MIN_SPEED_SCALE),
    )  # fmt: skip
    return np.asarray(speed), curl


def _times(sea: Sea, start: float, end: float) -> FloatArray:
    """Return at most `MAX_TIMES` native times of the current in a period."""
    times = sea.times(start, end, names=standard_names.CURRENT.pair)
    if times.size <= MAX_TIMES:
        return times if times.size else np.array([start])
    return np.asarray(times[np.linspace(0, times.size - 1, MAX_TIMES).round().astype(int)])
