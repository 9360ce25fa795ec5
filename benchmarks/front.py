"""The Pareto front of time and cost on 10^4 nodes with 32 directions and 12 settings, on one core.

The case "jet and eddies" of the tests: a grid of 101 x 101 nodes, 1-minute bins over 32 hours (of
the case, which is scaled down by 100 in length and time). Memory is that of the whole process.

    python benchmarks/front.py [--reach 3] [--bin-min 1.0] [--spacing 5] [--runs 3] [--no-lower]
"""

from __future__ import annotations

import argparse
import resource
import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import numpy as np
from tests.search.small import NO_LIMITS
from tests.worlds import jet_and_eddies as world

from thalweg.search import FrontQuery, MultiSettingShipOnNetwork, NetworkFront, pareto_front


def search(grid: world.Grid, given: tuple, bin_min: float, lower: bool) -> NetworkFront:
    network, fields = given
    table, fuel = world.tables()
    latest = world.T0 + world.LATEST * world.HOUR
    return pareto_front(
        MultiSettingShipOnNetwork(network, fields, table, fuel, NO_LIMITS),
        FrontQuery(grid.node(world.START), grid.node(world.GOAL), world.T0, latest),
        bin_s=bin_min * world.HOUR / 60.0,
        lower=lower,
        memory_limit=8e9,
    )


def print_front(found: NetworkFront, seconds: list[float], what: str) -> None:
    work = found.work
    print(
        f"{what}: median {statistics.median(seconds):.2f} s (best {min(seconds):.2f}), "
        f"{len(found.points)} points, {work.relaxed / 1e6:.0f} million relaxations, "
        f"{work.sailed / 1e6:.1f} million sails, {work.slices} slices, table error "
        f"{work.table_error:.1e}, {work.memory / 1e6:.0f} MB planned"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--reach", type=int, default=3, help="3: 32 directions, 5: 80")
    parser.add_argument("--bin-min", type=float, default=1.0)
    parser.add_argument("--spacing", type=float, default=5.0, help="of the grid [nm]")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--no-lower", action="store_true")
    options = parser.parse_args()
    grid = world.Grid(options.spacing, options.reach)
    network = grid.network()
    given = network, world.freeze(network)
    small = world.Grid(25.0, 1)
    few = small.network()
    search(small, (few, world.freeze(few)), 10.0, True)  # compile
    print(f"{network.n_nodes:,} nodes, {network.n_edges:,} edges, 12 settings")
    for lower in (False, True)[: 1 if options.no_lower else 2]:
        seconds = []
        for _ in range(options.runs):
            begin = time.process_time()
            found = search(grid, given, options.bin_min, lower)
            seconds.append(time.process_time() - begin)
        print_front(found, seconds, "front and lower front" if lower else "front (target 8 s)")
    for hours in (20.0, 24.0, 28.0):
        until = hours * world.HOUR
        cost = found.cost[found.time <= until].min()
        print(
            f"  {hours:.0f} h: {world.tonnes(cost):.4f} t, "
            f"lower {world.tonnes(found.lower_at(until)):.4f} t"
        )
    if found.lower_time.size:
        print(f"  gap: median {np.median(found.gap):.2%}, maximum {found.gap.max():.2%}")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(f"  peak memory {peak:.2f} GB")


if __name__ == "__main__":
    main()
