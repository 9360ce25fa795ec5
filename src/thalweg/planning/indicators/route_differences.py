"""Whether two routes lead through different water."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.geodesy import distance
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route import Route

_SAMPLES: Final = 60
_APART: Final = 0.02  # of the length: routes this far apart somewhere differ ...
_LEAST_APART: Final = 1.0 * NAUTICAL_MILE  # ... but not below this [m]


def line_at_shares(route: Route) -> tuple[FloatArray, FloatArray]:
    """Return positions at equal shares of the length of a route [deg]."""
    at = route.samples
    share = np.linspace(at["distance"][0], at["distance"][-1], _SAMPLES)
    lon = np.degrees(np.unwrap(np.radians(at["lon"])))
    lat = np.interp(share, at["distance"], at["lat"])
    return lat, np.interp(share, at["distance"], lon)


def lines_differ(one: tuple[FloatArray, FloatArray], other: tuple[FloatArray, FloatArray]) -> bool:
    """Return whether two routes are far apart somewhere: each position to the nearest other."""
    lat, lon = one
    away = np.asarray(distance(lat[:, None], lon[:, None], other[0][None, :], other[1][None, :]))
    steps = np.asarray(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    length = float(steps.sum())
    grid = 0.5 * length / (_SAMPLES - 1)  # positions of one line are this far from the other's
    return float(away.min(axis=1).max()) - grid > max(_APART * length, _LEAST_APART)
