"""Which nodes of a model's mesh a network needs: dense where the flow is strong or turns.

After van Halem (2019), "Route optimization in dynamic currents", section 3.1, with the bracket
as the fraction of the largest spacing and a dimensionless curl.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.geodesy import METRES_PER_DEGREE, wrap_longitude
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.network import graph_building


def spacing_fraction(
    speed: ArrayLike,
    curl: ArrayLike,
    *,
    alpha: float = 0.8,
    curl_power: float = 0.6,
    speed_power: float = 3.5,
) -> FloatArray:
    """Return the fraction of the largest spacing that suits the flow at a node.

    ``alpha (1 + |curl|)^-curl_power + (1 - alpha) (1 + |u|)^-speed_power``: van Halem (2019),
    eq. 3.2, in (0, 1].

    Parameters
    ----------
    speed : array_like
        Largest speed of the current over time [m/s].
    curl : array_like
        Largest dimensionless curl over time, ``|dv/dx - du/dy| L_ref / u_ref``.
    alpha : float, optional
        Weight of the curl, 0 to 1.
    curl_power, speed_power : float, optional
        Powers, not negative.

    Returns
    -------
    float64 array
        Fraction [-] in the broadcast shape, in (0, 1].
    """
    turning = (1.0 + np.abs(np.asarray(curl, float))) ** -curl_power
    running = (1.0 + np.abs(np.asarray(speed, float))) ** -speed_power
    return np.asarray(alpha * turning + (1.0 - alpha) * running)


def thin_by_spacing(x: ArrayLike, y: ArrayLike, spacing: ArrayLike) -> BoolArray:
    """Return a selection of points of a plane, in their order, no nearer than their spacing.

    The first point is selected; every next one if and only if its distance to the nearest point
    selected before is larger than its own spacing (all in one unit).

    Raises
    ------
    InputError : If a spacing is negative or not finite.
    """
    x, y, gap = np.broadcast_arrays(
        np.asarray(x, float), np.asarray(y, float), np.asarray(spacing, float)
    )
    if not np.all(np.isfinite(gap) & (gap >= 0.0)):
        raise InputError(
            "A node's spacing is negative or not a number.",
            "Speed and curl of the flow must be known at every node that is used.",
            "Leave out nodes without data, or fill them.",
        )
    keep = np.zeros(len(x), bool)
    graph_building.keep_spaced_points(
        np.ascontiguousarray(x), np.ascontiguousarray(y), np.ascontiguousarray(gap), keep
    )
    return keep


def dimensionless_curl(
    lat: FloatArray, lon: FloatArray, triangles: IntArray, east: FloatArray, north: FloatArray,
    *, length: float, speed: float,
) -> FloatArray:  # fmt: skip
    """Return the largest ``|dv/dx - du/dy| length / speed`` over time at the nodes of a mesh.

    Parameters
    ----------
    lat, lon : Nodes [deg], (N,).
    triangles : Nodes of the triangles, (M, 3).
    east, north : ndarray (T, N) or (N,)
        Current [m/s].
    length, speed : Reference length [m] and speed [m/s].

    Returns
    -------
    ndarray (N,)
        The largest over the triangles at a node and over time; 0 for nodes of no triangle.
    """
    a, b, c = np.asarray(triangles).T
    x = (
        np.stack([wrap_longitude(lon[k] - lon[a]) for k in (b, c)])
        * METRES_PER_DEGREE
        * np.cos(np.radians(lat[a]))
    )
    y = np.stack([lat[k] - lat[a] for k in (b, c)]) * METRES_PER_DEGREE
    double_area = x[0] * y[1] - x[1] * y[0]
    u, v = np.atleast_2d(east), np.atleast_2d(north)
    dv_dx = ((v[:, b] - v[:, a]) * y[1] - (v[:, c] - v[:, a]) * y[0]) / double_area
    du_dy = ((u[:, c] - u[:, a]) * x[0] - (u[:, b] - u[:, a]) * x[1]) / double_area
    largest = np.nanmax(np.abs(dv_dx - du_dy), axis=0) * length / speed
    result = np.zeros(len(lat))
    for corner in (a, b, c):
        np.maximum.at(result, corner, largest)
    return result
