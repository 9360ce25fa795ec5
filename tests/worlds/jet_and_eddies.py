"""Networks and frozen fields of the jet and eddies: a plane of 500 x 500 nm, shrunk 100 times.

Lengths and times are shrunk by the same factor, so speeds stay and fuel is divided by it; on
the equator the case is planar to about 1e-5. The sea itself and the ship are those of
`tests.evolution.jet`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.evolution.jet import (
    FUEL_T_DAY,
    KNOT,
    METRES_PER_LAT,
    METRES_PER_LON,
    SHRINK,
    SPEED_KN,
    T0,
    current,
    position,
)
from tests.search.small import make_table
from thalweg.kernels import codes
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.network import Edges, Graph, Network, NetworkMeta, Samples, Stations
from thalweg.sea.frozen_fields import StationFields

NM = 1852.0 / SHRINK  # [m] of the shrunk case
HOUR = 3600.0 / SHRINK  # [s] of the shrunk case
SIDE, START, GOAL, LATEST = 500.0, (100.0, 200.0), (400.0, 300.0), 32.0


def xy(lat, lon):
    """Return (x, y) [nm] of positions [deg]."""
    return np.asarray(lon) * METRES_PER_LON / NM, np.asarray(lat) * METRES_PER_LAT / NM


def tables() -> tuple[TableArrays, TableArrays]:
    """Return the tables of speed [m/s] and fuel rate [kg/s]; of these only the time is shrunk."""
    speed, fuel = np.array(SPEED_KN) * KNOT, np.array(FUEL_T_DAY) * 1000.0 / 86400.0
    return make_table(((), (), speed)), make_table(((), (), fuel))


def tonnes(fuel_kg: float) -> float:
    """Return the fuel of the case [t] for that of the shrunk one [kg]."""
    return fuel_kg * SHRINK / 1000.0


@dataclass(frozen=True)
class Grid:
    """A square grid of the case with all coprime offsets within a reach."""

    spacing: float = 5.0
    reach: int = 3

    @property
    def side(self) -> int:
        return round(SIDE / self.spacing) + 1

    def node(self, place) -> int:
        return round(place[0] / self.spacing) + self.side * round(place[1] / self.spacing)

    def offsets(self) -> list[tuple[int, int]]:
        steps = range(-self.reach, self.reach + 1)
        return [(i, j) for i in steps for j in steps if np.gcd(i, j) == 1]

    def network(self) -> Network:
        """Return the network; edges are sampled where they cross lines of the grid."""
        side, offsets = self.side, self.offsets()
        row, column = np.divmod(np.arange(side * side), side)
        i, j = (np.array(part)[None, :] for part in zip(*offsets))
        inside = (row[:, None] + i >= 0) & (row[:, None] + i < side)
        inside &= (column[:, None] + j >= 0) & (column[:, None] + j < side)
        tail, which = np.nonzero(inside)
        di, dj = i[0, which], j[0, which]
        samples = np.maximum(abs(di), abs(dj)) - 1
        via = np.repeat(np.arange(len(tail)), samples)
        nth = np.arange(len(via)) - np.repeat(np.cumsum(samples) - samples, samples) + 1
        s = nth / (samples[via] + 1)
        y, x = row[tail[via]] + s * di[via], column[tail[via]] + s * dj[via]
        is_mercator = abs(di[via]) >= abs(dj[via])  # crosses rows: between two neighbours of a row
        y0 = np.where(is_mercator, np.round(y), np.floor(y)).astype(np.int64)
        x0 = np.where(is_mercator, np.floor(x), np.round(x)).astype(np.int64)
        a = x0 + side * y0
        b = np.where(is_mercator, x0 + 1 + side * y0, x0 + side * (y0 + 1))
        lat, lon = position(self.spacing * column, self.spacing * row)
        lat, lon = position(self.spacing * column, self.spacing * row)
        length = self.spacing * NM * np.hypot(di, dj)
        edges = len(tail)
        return Network(
            Stations(
                lat=np.ascontiguousarray(lat, float),
                lon=np.ascontiguousarray(lon, float),
                n_nodes=side * side,
            ),
            Graph(
                indptr=np.searchsorted(tail, np.arange(side * side + 1)).astype(np.int64),
                target=(tail + di * side + dj).astype(np.int32),
            ),
            Edges(
                length=length,
                course=(np.arctan2(dj, di) % (2 * np.pi)).astype(np.float32),
                depth=np.full(edges, np.inf, np.float32),
                penalty_factor=np.ones(edges, np.float32),
                price_factor=np.ones(edges, np.float32),
            ),
            Samples(
                ptr=np.concatenate(([0], np.cumsum(samples))).astype(np.int64),
                station_a=a.astype(np.int32),
                station_b=np.where(
                    (is_mercator & (x == x0)) | (~is_mercator & (y == y0)), a, b
                ).astype(np.int32),
                weight=np.where(is_mercator, x - x0, y - y0).astype(np.float32),
                fraction=s.astype(np.float32),
            ),
            can_wait=np.ones(side * side, bool),
            meta=NetworkMeta("square", self.spacing * NM, len(offsets), 0.3),
        )


def freeze(network: Network, step_h: float = 1.0 / 3.0) -> StationFields:
    """Return the current at the nodes, every ``step_h`` [h]."""
    hours = np.arange(0.0, LATEST + 6.0, step_h)
    x, y = xy(network.stations.lat, network.stations.lon)
    u, v = current(hours[None, :], x[:, None], y[:, None])
    index = np.full(codes.CHANNEL_COUNT, -1, np.int64)
    index[[codes.CURRENT_EAST, codes.CURRENT_NORTH]] = 0, 1
    values = np.ascontiguousarray(KNOT * np.stack([u, v], axis=-1), np.float32)
    return StationFields(T0 + HOUR * hours, values, index)
