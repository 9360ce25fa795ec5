"""One query on a tidal mesh of 50,000 nodes: current, level, bed, flats that dry, waiting allowed.

The mesh is triangular, three rings of neighbours (24 directions), sampled once per spacing; 30 h of
a rotary M2 tide in half-hour steps. Target: 50 ms for one query with compiled kernels. "Prepared"
queries reuse all data that do not depend on the departure (`thalweg.search.prepared_network`), as a
project of many trips does; the plain query prepares them each time.

    python benchmarks/mesh_query.py [--nodes 50000] [--runs 20] [--places 5] [--quick]

Times are CPU times of one core. Prepared queries run between several pairs of places.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time

import numpy as np
from scipy.spatial import Delaunay

from thalweg.chart import Chart
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.network import mesh
from thalweg.sea.frozen_fields import StationFields
from thalweg.search import PreparedNetwork, ShipOnNetwork, earliest_arrival, prepare_profile_search

SPACING = 300.0  # m
SPEED, DRAUGHT = 5.0, 5.0
M2 = 44714.0
CHANNELS = (codes.CURRENT_EAST, codes.CURRENT_NORTH, codes.WATER_LEVEL, codes.BED_DEPTH)


def tidal_mesh(nodes: int):
    """Return a network of about this number of nodes over a square of sea."""
    side = round(math.sqrt(nodes * math.sqrt(3.0) / 2.0))
    rows = round(nodes / side)
    y, x = np.mgrid[0:rows, 0:side].astype(float)
    x += 0.5 * (y % 2)
    lat = 52.0 + y.ravel() * SPACING * math.sqrt(0.75) / 111_200.0
    lon = 3.0 + x.ravel() * SPACING / (111_320.0 * math.cos(math.radians(52.3)))
    triangles = Delaunay(np.column_stack([x.ravel(), y.ravel() * math.sqrt(0.75)])).simplices
    chart = Chart.open_water(50.0, 60.0, 0.0, 15.0)
    return mesh(chart, lat, lon, triangles, rings=3, sampling=1.0)


def tidal_sea(network) -> StationFields:
    """Return a rotary tide over a bed with banks that dry at low water."""
    times = np.arange(0.0, 30.0 * 3600.0 + 1.0, 1800.0)
    lat, lon = network.stations.lat[:, None], network.stations.lon[:, None]
    phase = 2.0 * math.pi * (times / M2 - 0.3 * lon)
    bed = 9.0 + 6.0 * np.sin(25.0 * lat) * np.sin(17.0 * lon)
    values = np.empty((len(lat), len(times), len(CHANNELS)), np.float32)
    values[:, :, 0] = 0.8 * np.cos(phase)
    values[:, :, 1] = 0.5 * np.sin(phase)
    values[:, :, 2] = 1.8 * np.cos(phase - 0.7)
    values[:, :, 3] = bed
    index = np.full(codes.CHANNEL_COUNT, -1, np.int64)
    index[list(CHANNELS)] = np.arange(len(CHANNELS))
    return StationFields(times, values, index)


def steady() -> TableArrays:
    """Return the table of a ship with one speed."""
    none = np.full((1, 6), -1, np.int64)
    zeros = np.zeros((1, 6))
    sizes = np.full((1, 6), 2, np.int64)
    return TableArrays(
        none, zeros, zeros + 1.0, sizes, np.zeros(1, np.int64), 1, np.array([SPEED], np.float32)
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nodes", type=int, default=50_000)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--places", type=int, default=5, help="pairs prepared")
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    nodes = 5_000 if options.quick else options.nodes
    began = time.perf_counter()
    network = tidal_mesh(nodes)
    built = time.perf_counter() - began
    fields = tidal_sea(network)
    stations, edges = len(network.stations.lat), len(network.graph.target)
    print(f"{network.n_nodes} nodes, {edges} edges, {stations} stations, built in {built:.1f} s")
    print(f"fields of {fields.values.nbytes / 1e6:.0f} MB, {len(fields.times)} times")
    limits = Limits(required_depth=DRAUGHT + 1.0)
    rng = np.random.default_rng(0)
    deep = np.flatnonzero(fields.values[: network.n_nodes, 0, 3] > 10.0)
    given = {"setting": 0, "limits": limits, "top_speed": SPEED}
    west = deep[network.lon[deep] < np.quantile(network.lon, 0.15)]
    east = deep[network.lon[deep] > np.quantile(network.lon, 0.85)]
    pairs = [(int(rng.choice(west)), int(rng.choice(east))) for _ in range(options.runs + 1)]
    departs = rng.uniform(3600.0, 12.0 * 3600.0, len(pairs))
    print_times(
        "plain query",
        [
            timed(
                lambda s=s, g=g, t=t: earliest_arrival(
                    ShipOnNetwork(network, fields, steady(), **given), start=s, goal=g, depart=t
                )
            )
            for (s, g), t in zip(pairs, departs)
        ],
    )
    prepared = PreparedNetwork.prepare(network, fields)
    runs = []
    for start, goal in pairs[: options.places]:
        began = time.process_time()
        search = prepare_profile_search(prepared, steady(), start=start, goal=goal, **given)
        print(f"preparing a pair of places {1e3 * (time.process_time() - began):.0f} ms")
        runs += [timed(lambda t=t, p=search: p.sail(t)) for t in departs]
    print_times("prepared query", runs)


def timed(query) -> tuple[float, int]:
    began = time.process_time()
    found = query()
    return 1e3 * (time.process_time() - began), found.settled


def print_times(what: str, runs: list[tuple[float, int]]) -> None:
    taken = [ms for ms, _ in runs[1:]]  # the first query compiles or loads
    settled = statistics.median(n for _, n in runs[1:])
    print(
        f"{what}: median {statistics.median(taken):.1f} ms, minimum {min(taken):.1f}, maximum "
        f"{max(taken):.1f} (target 50), {settled:.0f} nodes settled"
    )


if __name__ == "__main__":
    main()
