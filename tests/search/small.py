"""Small networks, seas and ships for tests, made as plain arrays."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core import geodesy
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.kernels.leg.point_speed import point_speed
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.network import Edges, Graph, Network, NetworkMeta, Samples, Stations
from thalweg.sea.frozen_fields import StationFields

NO_LIMITS = Limits()


def limits(depth: float = -np.inf, wave: float = np.inf, wind: float = np.inf) -> Limits:
    return Limits(depth, wave, wind)


def make_network(
    lat,
    lon,
    edges,
    *,
    length=None,
    course=None,
    depth=np.inf,
    factor=1.0,
    can_wait=True,
    pieces=1,
    gap=np.pi / 2,
) -> Network:
    """Build a network from positions and (tail, head) pairs, with samples inside the edges.

    An edge has ``pieces - 1`` interior samples, which are stations of their own.
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    n = len(lat)
    edges = np.asarray(edges, np.int64).reshape(-1, 2)
    order = np.argsort(edges[:, 0], kind="stable")
    tail, head = edges[order].T
    exact, first, last = geodesy.inverse(lat[tail], lon[tail], lat[head], lon[head])
    mean = np.angle(np.exp(1j * first) + np.exp(1j * last)) % (2 * np.pi)
    each = len(order)

    def per_edge(value, default, dtype):
        values = default if value is None else np.broadcast_to(value, each)[order]
        return np.ascontiguousarray(values, dtype)

    s = np.arange(1, pieces) / pieces
    via = geodesy.direct(
        np.repeat(lat[tail], pieces - 1),
        np.repeat(lon[tail], pieces - 1),
        np.repeat(first, pieces - 1),
        np.repeat(exact, pieces - 1) * np.tile(s, each),
    )
    station = (n + np.arange(each * (pieces - 1))).astype(np.int32)
    return Network(
        Stations(np.concatenate([lat, via[0]]), np.concatenate([lon, via[1]]), n),
        Graph(np.searchsorted(tail, np.arange(n + 1)).astype(np.int64), head.astype(np.int32)),
        Edges(
            length=per_edge(length, exact, np.float64),
            course=per_edge(course, mean, np.float32),
            depth=per_edge(depth, None, np.float32),
            penalty_factor=per_edge(factor, None, np.float32),
            price_factor=np.ones(each, np.float32),
        ),
        Samples(
            ptr=np.arange(each + 1, dtype=np.int64) * (pieces - 1),
            station_a=station,
            station_b=station,
            weight=np.zeros(len(station), np.float32),
            fraction=np.tile(s, each).astype(np.float32),
        ),
        can_wait=np.ascontiguousarray(np.broadcast_to(can_wait, n), bool),
        meta=NetworkMeta("test", 0.0, 0, gap),
    )


def make_fields(network: Network, times, **channels) -> StationFields:
    """Freeze fields given as functions of (time, lat, lon), arrays [S, T] or numbers."""
    times = np.asarray(times, float)
    ids = {name: getattr(codes, name.upper()) for name in channels}
    names = sorted(channels, key=lambda name: ids[name])
    shape = (len(network.stations.lat), len(times))
    values = np.zeros((*shape, len(names)), np.float32)
    index = np.full(codes.CHANNEL_COUNT, -1, np.int64)
    for k, name in enumerate(names):
        value = channels[name]
        if callable(value):
            value = value(
                times[None, :], network.stations.lat[:, None], network.stations.lon[:, None]
            )
        values[:, :, k] = np.broadcast_to(value, shape)
        index[ids[name]] = k
    return StationFields(times, values, index)


def make_table(*parts) -> TableArrays:
    """Build a table from (axis ids, grids, values) parts; values have the setting innermost."""
    count = len(parts)
    axes = np.full((count, 6), -1, np.int64)
    start, inverse = np.zeros((count, 6)), np.ones((count, 6))
    size, offset, flat = np.full((count, 6), 2, np.int64), np.zeros(count, np.int64), []
    for p, (ids, grids, values) in enumerate(parts):
        for k, (axis, grid) in enumerate(zip(ids, grids)):
            axes[p, k], start[p, k] = axis, grid[0]
            inverse[p, k], size[p, k] = 1.0 / (grid[1] - grid[0]), len(grid)
        offset[p] = sum(len(v) for v in flat)
        flat.append(np.asarray(values, np.float32).ravel())
    settings = np.asarray(parts[0][2]).shape[-1]
    return TableArrays(axes, start, inverse, size, offset, settings, np.concatenate(flat))


def steady(speed: float) -> TableArrays:
    """Return the table of a ship with constant speed in all weather."""
    return make_table(((), (), np.array([speed])))


def point_speed_at(table=None, *, course=0.0, depth=np.inf, bounds=None, setting=0, **channels):
    """Return (speed, status) for a course [rad] and channel values by name."""
    sample = np.full(codes.CHANNEL_COUNT, np.nan)
    index = np.full(codes.CHANNEL_COUNT, -1, np.int64)
    for k, (name, value) in enumerate(channels.items()):
        channel = getattr(codes, name.upper())
        sample[channel], index[channel] = value, k
    bounds = (limits() if bounds is None else bounds).array
    table = steady(5.0) if table is None else table
    return point_speed(
        sample, index, math.sin(course), math.cos(course), table, setting, depth, bounds
    )


def line(count: int, spacing: float, **options) -> Network:
    """Return nodes along the equator, linked in both directions, ``spacing`` metres apart."""
    lat, lon = geodesy.direct(0.0, 0.0, np.pi / 2, spacing * np.arange(count))
    there = [(i, i + 1) for i in range(count - 1)] + [(i + 1, i) for i in range(count - 1)]
    return make_network(lat, lon, there, **options)


def grid(rows: int, columns: int, spacing_deg: float = 0.05, reach: int = 1, **options) -> Network:
    """Return a square grid; ``reach`` 1 has 8 directions, 2 has 16."""
    lat, lon = np.divmod(np.arange(rows * columns), columns)
    steps = range(-reach, reach + 1)
    offsets = [(i, j) for i in steps for j in steps if np.gcd(i, j) == 1]
    edges = [
        (r * columns + c, (r + i) * columns + c + j)
        for r in range(rows)
        for c in range(columns)
        for i, j in offsets
        if 0 <= r + i < rows and 0 <= c + j < columns
    ]
    return make_network(spacing_deg * lat, spacing_deg * lon, edges, **options)
