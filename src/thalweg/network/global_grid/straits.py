"""Narrow straits with traffic, where a geodesic grid needs more levels than along other coasts."""

from __future__ import annotations

import csv
from functools import cache
from importlib import resources
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.geodesy import MEAN_RADIUS, Position, unit_vectors
from thalweg.core.types import FloatArray, IntArray

FINEST_STRAIT_LEVEL: Final = 14  # level of the grid there: nodes 430 to 515 m apart


class Strait(NamedTuple):
    """Positions (lat, lon) [deg] along a strait; the grid is finer within a radius [km] of each."""

    places: tuple[Position, ...]
    radius_km: float


@cache
def narrow_straits() -> dict[str, Strait]:
    """Return the straits by name, from ``thalweg/network/data/straits.csv``."""
    table = resources.files("thalweg.network").joinpath("data/straits.csv")
    places: dict[str, list[Position]] = {}
    radius: dict[str, float] = {}
    for row in csv.DictReader(table.read_text("utf-8").splitlines()):
        places.setdefault(row["strait"], []).append((float(row["lat"]), float(row["lon"])))
        radius[row["strait"]] = float(row["radius_km"])
    return {name: Strait(tuple(found), radius[name]) for name, found in places.items()}


def strait_levels(middles: FloatArray, levels: int) -> IntArray:
    """Return ``levels`` for unit vectors (n, 3) that lie in a strait, 0 for others."""
    answer = np.zeros(len(middles), np.int64)
    directions = middles / np.linalg.norm(middles, axis=1, keepdims=True)
    for places, radius_km in narrow_straits().values():
        least_cosine = np.cos(1000.0 * radius_km / MEAN_RADIUS)
        for lat, lon in places:
            answer[directions @ unit_vectors(lat, lon) > least_cosine] = levels
    return answer
