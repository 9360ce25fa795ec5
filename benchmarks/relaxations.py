"""Edge relaxations per second of the time-dependent search, on one core.

A regular network of 10^6 nodes and 16 directions with currents, wind, waves and water level in
eight channels and eight times. Every edge is sampled at both ends and, if it is longer than the
diagonal of the spacing, at its midpoint. Every sample is checked against a depth limit and a wave
limit. The speed is a table of wind speed and wind angle as in Kwon's method. All inputs are plain
arrays.

    python benchmarks/relaxations.py [--side 1000] [--times 8] [--runs 3]

"Relaxed" counts every edge that leaves a settled node, once. Most of these are rejected by a bound
before the sea is sampled; "sailed" counts the others.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import time

import numpy as np

from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.network import Edges, Graph, Network, NetworkMeta, Samples, Stations
from thalweg.sea.frozen_fields import StationFields
from thalweg.search.earliest_arrival import ArrivalQuery, solve_earliest_arrival
from thalweg.search.search_problem import ShipOnNetwork, make_search_problem

SPACING = 2000.0  # [m]
OFFSETS = [
    (i, j) for i in range(-2, 3) for j in range(-2, 3) if np.gcd(i, j) == 1
]  # (rows, columns): 16 directions
CHANNELS = (
    codes.CURRENT_EAST,
    codes.CURRENT_NORTH,
    codes.WIND_EAST,
    codes.WIND_NORTH,
    codes.WAVE_HEIGHT_CHANNEL,
    codes.WAVE_EAST,
    codes.WAVE_NORTH,
    codes.WATER_LEVEL,
)
SPEED, TOP_LIMITS = 8.0, Limits(required_depth=8.0, wave_height=9.0)


def regular_network(side: int, offsets=OFFSETS) -> Network:
    """Return a square network around the equator, rows to the north; lengths as on a plane."""
    row, column = np.divmod(np.arange(side * side, dtype=np.int32), side)
    inside = np.empty((side * side, len(offsets)), bool)
    target = np.empty((side * side, len(offsets)), np.int32)
    middle = np.empty((2, side * side, len(offsets)), np.int32)
    for k, (i, j) in enumerate(offsets):
        inside[:, k] = (row + i >= 0) & (row + i < side) & (column + j >= 0) & (column + j < side)
        target[:, k] = (row + i) * side + column + j
        for end, half in enumerate((np.floor, np.ceil)):
            di, dj = int(half(i / 2)), int(half(j / 2))
            middle[end, :, k] = (row + di) * side + column + dj

    def each(values, dtype):
        return np.broadcast_to(np.asarray(values, dtype), inside.shape)[inside]

    length = SPACING * np.hypot(*np.array(offsets).T)
    long = each(length > 1.5 * SPACING, bool)
    edges, samples = len(long), int(long.sum())
    indptr = np.concatenate(([0], np.cumsum(inside.sum(axis=1))))
    degree = SPACING / 111e3
    return Network(
        Stations(degree * (row - side / 2), degree * (column - side / 2), side * side),
        Graph(indptr.astype(np.int64), target[inside]),
        Edges(
            length=each(length, np.float64),
            course=each([np.arctan2(j, i) % (2 * np.pi) for i, j in offsets], np.float32),
            depth=np.full(edges, 100.0, np.float32),
            penalty_factor=np.ones(edges, np.float32),
            price_factor=np.ones(edges, np.float32),
        ),
        Samples(
            ptr=np.concatenate(([0], np.cumsum(long))).astype(np.int64),
            station_a=middle[0][inside][long],
            station_b=middle[1][inside][long],
            weight=np.full(samples, 0.5, np.float32),
            fraction=np.full(samples, 0.5, np.float32),
        ),
        can_wait=np.ones(side * side, bool),
        meta=NetworkMeta("regular", SPACING, len(offsets), np.arctan(0.5)),
    )


def moving_sea(network: Network, period: float, steps: int) -> StationFields:
    """Return eddies, travelling weather, waves with it, and a tide."""
    x, y = network.stations.lon / 9.0, network.stations.lat / 9.0
    times = np.linspace(0.0, period, steps)
    values = np.empty((len(x), steps, len(CHANNELS)), np.float32)
    for k, t in enumerate(times):
        phase = 2 * np.pi * t / period
        veer = 5 * y + phase + x
        fields = (
            0.8 * np.sin(30 * x + phase), 0.8 * np.cos(25 * y - phase),
            12 * np.sin(5 * x + 3 * y + phase), 12 * np.cos(4 * y - 2 * x + phase),
            3 + 2 * np.sin(4 * x + phase), np.sin(veer), np.cos(veer), np.sin(9 * phase + x),
        )  # fmt: skip
        for channel, field in enumerate(fields):
            values[:, k, channel] = field
    index = np.full(codes.CHANNEL_COUNT, -1, np.int64)
    index[list(CHANNELS)] = np.arange(len(CHANNELS))
    return StationFields(times, values, index)


def speed_table() -> TableArrays:
    """Return calm-water speed plus a loss by wind speed and angle."""
    wind, angle = np.linspace(0.0, 40.0, 41), np.linspace(0.0, np.pi, 37)
    loss = -0.08 * (wind[:, None] / 10.0) ** 2 * (1.0 + np.cos(angle))
    axes, start, inverse = np.full((2, 6), -1, np.int64), np.zeros((2, 6)), np.ones((2, 6))
    size = np.full((2, 6), 2, np.int64)
    axes[1, :2] = codes.AXIS_WIND_SPEED, codes.AXIS_WIND_ANGLE
    inverse[1, :2] = 1.0 / wind[1], 1.0 / angle[1]
    size[1, :2] = loss.shape
    values = np.concatenate(([SPEED], loss.ravel())).astype(np.float32)
    return TableArrays(axes, start, inverse, size, np.array([0, 1]), 1, values)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=1000, help="nodes along each side")
    parser.add_argument("--times", type=int, default=8, help="times of the fields")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    side = options.side
    network = regular_network(side)
    fields = moving_sea(network, 3.0 * side * SPACING / SPEED, options.times)
    given = make_search_problem(
        ShipOnNetwork(network, fields, speed_table(), setting=0, limits=TOP_LIMITS, top_speed=SPEED)
    )
    solve_earliest_arrival(network, given, ArrivalQuery(0, 1, 0.0))  # compile
    print(f"{network.n_nodes:,} nodes, {network.n_edges:,} edges, {len(network.samples):,} middles")
    starts = [0, side * side // 2 + side // 2, side * side - 1, side * side // 4 + 3]
    relaxed, sailed = [], []
    for run in range(options.runs):
        begin = time.process_time()
        query = ArrivalQuery(starts[run % 4], None, 60.0 * run)
        result = solve_earliest_arrival(network, given, query)
        taken = time.process_time() - begin
        relaxed.append(result.relaxed / taken / 1e6)
        sailed.append(result.work.sailed / taken / 1e6)
        print(
            f"  all nodes from {starts[run % 4]:>8}: {taken:.2f} s, {result.settled:,} settled, "
            f"{result.relaxed:,} relaxed, {result.work.sailed:,} sailed, {result.refused}"
        )
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(
        f"median {statistics.median(relaxed):.1f} million relaxations per second (target 10), of "
        f"which {statistics.median(sailed):.2f} million sailed; peak memory {memory:.2f} GB "
        "(target < 2)"
    )


if __name__ == "__main__":
    main()
