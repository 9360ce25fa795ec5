"""Fetch: the length of open water over which the wind blows to a position."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core import geodesy
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import LAND

if TYPE_CHECKING:
    from thalweg.chart.chart import Chart

LONGEST_FETCH: Final = 500_000.0  #: longer fetches count as this [m]
SHORTEST_FETCH: Final = 100.0  #: shorter ones as this, as on land [m]
DIRECTIONS: Final = 16  #: for which the fetch of a position is found; between them it is linear
_CELL: Final = 0.01  # positions in one such cell share their fetch [deg]
_STEPS: Final = tuple(LONGEST_FETCH / 2.0**k for k in range(12, -1, -1))
_HALVINGS: Final = 6


class CoastalFetch:
    """The fetch at positions, by the direction that the wind comes from.

    It is the distance along the geodesic to the first land of a chart, for 16 directions, found
    once for every cell of 0.01 degrees.

    Parameters
    ----------
    chart : Its coastline; zones, offing and canals do not count.
    """

    def __init__(self, chart: Chart) -> None:
        self._chart = type(chart)(chart.coastline)
        self._known: dict[tuple[int, int], FloatArray] = {}

    @property
    def name(self) -> str:
        """Name of the coastline, for records."""
        return self._chart.coastline.name

    def __call__(self, lat: FloatArray, lon: FloatArray, origin: FloatArray) -> FloatArray:
        """Return the fetch.

        Parameters
        ----------
        lat, lon : Positions [deg], (n,).
        origin : float64 array (n,) or (n, times)
            Direction that the wind comes from, clockwise from north [rad].

        Returns
        -------
        float64 array : Fetch [m], of the shape of ``origin``; NaN where the direction is NaN.
        """
        table = self._tables(np.asarray(lat, float), np.asarray(lon, float))
        place = np.asarray(origin, float) / (2.0 * math.pi) * DIRECTIONS % DIRECTIONS
        known = np.isfinite(place)
        low = np.where(known, np.floor(place), 0.0).astype(np.int64) % DIRECTIONS
        share = np.where(known, place - np.floor(place), math.nan)
        row = np.arange(len(table)).reshape(-1, *([1] * (place.ndim - 1)))
        first, second = table[row, low], table[row, (low + 1) % DIRECTIONS]
        return np.asarray((1.0 - share) * first + share * second)

    def _tables(self, lat: FloatArray, lon: FloatArray) -> FloatArray:
        """Return the fetch (n, directions) at positions [m]."""
        wrapped = geodesy.wrap_longitude(lon)
        keys = list(zip(np.round(lat / _CELL).astype(int).tolist(),
                        np.round(wrapped / _CELL).astype(int).tolist()))  # fmt: skip
        new: dict[tuple[int, int], int] = {}
        for number, key in enumerate(keys):
            if key not in self._known:
                new.setdefault(key, number)
        if new:
            at = np.fromiter(new.values(), np.int64, len(new))
            found = self._rays(lat[at], wrapped[at])
            self._known.update(zip(new, found))
        return np.array([self._known[key] for key in keys]).reshape(-1, DIRECTIONS)

    def _rays(self, lat: FloatArray, lon: FloatArray) -> FloatArray:
        """Return the distance to land in every direction (n, directions) [m]."""
        count = len(lat)
        a, b = np.repeat(lat, DIRECTIONS), np.repeat(lon, DIRECTIONS)
        course = np.tile(np.arange(DIRECTIONS) * 2.0 * math.pi / DIRECTIONS, count)
        clear, blocked = np.zeros(len(a)), np.full(len(a), math.inf)
        for length in _STEPS:
            rows = np.flatnonzero(np.isinf(blocked))
            hit = self._touches_land(a[rows], b[rows], course[rows], np.full(len(rows), length))
            clear[rows[~hit]], blocked[rows[hit]] = length, length
        for _ in range(_HALVINGS):
            rows = np.flatnonzero(np.isfinite(blocked))
            middle = 0.5 * (clear[rows] + blocked[rows])
            hit = self._touches_land(a[rows], b[rows], course[rows], middle)
            clear[rows[~hit]], blocked[rows[hit]] = middle[~hit], middle[hit]
        return np.maximum(clear, SHORTEST_FETCH).reshape(count, DIRECTIONS)

    def _touches_land(
        self, lat: FloatArray, lon: FloatArray, course: FloatArray, length: FloatArray
    ) -> np.ndarray:
        if not len(lat):
            return np.zeros(0, bool)
        end_lat, end_lon = geodesy.direct(lat, lon, course, length)
        return np.asarray(self._chart.leg_status(lat, lon, end_lat, end_lon)) == LAND
