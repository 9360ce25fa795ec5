"""A network on the nodes of the sea's own model, thinned where its flow is slow and straight."""

from __future__ import annotations

from typing import Any

import numpy as np

from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.geodesy import FloatArray
from thalweg.network import Network, mesh
from thalweg.network.pruning import dimensionless_curl
from thalweg.sea import Sea, names

MOST_TIMES = 150  #: moments at which the flow is looked at
_SLOW = 0.1  # speed [m/s] by which curl is made dimensionless at least


def pruned_mesh(
    chart: Chart,
    sea: Sea,
    start: float,
    end: float,
    *,
    largest_spacing: float,
    **options: Any,
) -> Network:
    """Build a network on the model's nodes, dense where the flow is strong or turns.

    Parameters
    ----------
    chart : Chart
    sea : Sea
        With a mesh.
    start, end : float
        Period over which the flow is looked at [s since 1970]; what the data do not cover of it is
        left out.
    largest_spacing : float
        Spacing of the nodes in still water [m]; also the length by which curl becomes
        dimensionless, with the greatest speed of the flow: the change of the current over one
        spacing, as a share of it.
    **options
        ``alpha``, ``curl_power``, ``speed_power``, ``rings`` and ``sampling`` of
        `thalweg.network.mesh`.

    Returns
    -------
    Network
        Without start and goal (see `thalweg.network.with_endpoints`).

    Raises
    ------
    InputError
        If the sea has no mesh.
    """
    model = sea.mesh()
    if model is None:
        raise InputError(
            "A mesh network is asked, but the sea has no mesh.",
            "Meshes come from UGRID files of hydrodynamic models.",
            "Use a lattice, or open such a file first.",
        )
    speed, curl = flow_of(sea, start, end, length=largest_spacing)
    return mesh(
        chart, model.lat, model.lon, model.triangles, speed=speed, curl=curl,
        largest_spacing=largest_spacing, **options,
    )  # fmt: skip


def flow_of(
    sea: Sea, start: float, end: float, *, length: float
) -> tuple[FloatArray | None, FloatArray | None]:
    """Return the largest speed [m/s] and dimensionless curl over a period at the mesh's nodes.

    Where and when the current is not known (dry flats) it counts as still; without currents both
    are None.
    """
    model = sea.mesh()
    if model is None or not set(names.CURRENT.pair) <= sea.variables:
        return None, None
    times = _times(sea, start, end)
    flow = sea.series(names.CURRENT.pair, times, model.lat, model.lon)
    east, north = (np.nan_to_num(flow[name]).T for name in names.CURRENT.pair)
    speed = np.hypot(east, north).max(axis=0)
    curl = dimensionless_curl(
        model.lat, model.lon, model.triangles, east, north,
        length=length, speed=max(float(speed.max()), _SLOW),
    )  # fmt: skip
    return np.asarray(speed), curl


def _times(sea: Sea, start: float, end: float) -> FloatArray:
    """Return native times of the current in a period, not too many."""
    times = sea.times(start, end, names=names.CURRENT.pair)
    if times.size <= MOST_TIMES:
        return times if times.size else np.array([start])
    return np.asarray(times[np.linspace(0, times.size - 1, MOST_TIMES).round().astype(int)])
