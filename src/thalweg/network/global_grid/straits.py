"""Narrow straits with traffic, where a geodesic grid needs more levels than along other coasts."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.geodesy import MEAN_RADIUS, unit_vectors
from thalweg.core.types import FloatArray, IntArray

FINEST_STRAIT_LEVEL: Final = 14  # level of the grid there: nodes 430 to 515 m apart

#: Positions (lat, lon) [deg] along each strait, and how far round them is finer [km].
STRAITS: Final[dict[str, tuple[tuple[tuple[float, float], ...], float]]] = {
    "Bosporus": (((41.02, 29.0), (41.12, 29.07), (41.22, 29.12)), 10.0),
    "Dardanelles": (((40.03, 26.2), (40.15, 26.4), (40.25, 26.5), (40.38, 26.68)), 12.0),
    "Kerch": (((45.2, 36.45), (45.35, 36.6)), 18.0),
    "Oresund": (((56.03, 12.65), (55.75, 12.75), (55.5, 12.75)), 20.0),
    "Great Belt": (((55.8, 10.9), (55.35, 11.0), (54.9, 10.9)), 25.0),
    "Little Belt": (((55.52, 9.73),), 12.0),
    "Messina": (((38.23, 15.62), (38.05, 15.6)), 15.0),
    "Bonifacio": (((41.3, 9.25),), 15.0),
    "Rion": (((38.32, 21.77),), 10.0),
    "Magellan": (
        (
            (-52.55, -69.6), (-52.7, -70.4), (-53.3, -70.8), (-53.85, -71.1), (-53.75, -71.9),
            (-53.4, -72.7), (-53.1, -73.3), (-52.85, -73.9), (-52.65, -74.6),
        ),
        28.0,
    ),
    "Beagle": (((-54.9, -68.3), (-54.95, -67.3)), 25.0),
    "Pentland": (((58.7, -3.1),), 20.0),
    "Shimonoseki": (((33.95, 130.95),), 10.0),
    "Akashi": (((34.62, 135.02), (34.25, 134.65)), 10.0),
    "Singapore": (((1.2, 103.8), (1.25, 104.1)), 25.0),
    "Torres": (((-10.55, 142.2),), 30.0),
    "Tiran": (((28.0, 34.47),), 12.0),
    "Maracaibo": (((10.97, -71.58),), 15.0),
    "Patos": (((-32.13, -52.1),), 12.0),
}  # fmt: skip


def strait_levels(middles: FloatArray, levels: int) -> IntArray:
    """Return ``levels`` for unit vectors (n, 3) that lie in a strait, 0 for others."""
    answer = np.zeros(len(middles), np.int64)
    directions = middles / np.linalg.norm(middles, axis=1, keepdims=True)
    for places, radius in STRAITS.values():
        far = np.cos(1000.0 * radius / MEAN_RADIUS)
        for lat, lon in places:
            answer[directions @ unit_vectors(lat, lon) > far] = levels
    return answer
