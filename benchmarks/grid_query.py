"""One query on a grid of 100 x 100 nodes with 8 neighbours: Yu's case (2021, chapter 5).

The thesis reports 240 s for a search of this size; the target here is 10 ms with compiled kernels.
Currents and wind vary over eight times; all inputs are plain arrays. Start and goal differ between
queries.

    python benchmarks/grid_query.py [--runs 50]
"""

from __future__ import annotations

import argparse
import statistics
import time

import numpy as np

from relaxations import SPACING, SPEED, TOP_LIMITS, moving_sea, regular_network, speed_table
from thalweg.search import ShipOnNetwork, earliest_arrival

SIDE = 100
OFFSETS = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=50)
    options = parser.parse_args()
    network = regular_network(SIDE, OFFSETS)
    fields = moving_sea(network, 6.0 * SIDE * SPACING / SPEED, 8)
    rng = np.random.default_rng(0)
    ship = ShipOnNetwork(network, fields, speed_table(), 0, TOP_LIMITS, SPEED)
    for method in ("astar", "dijkstra"):
        taken, settled = [], []
        for run in range(options.runs + 1):
            start, goal = rng.integers(0, SIDE, 2) * SIDE + np.array([0, SIDE - 1])
            begin = time.perf_counter()
            result = earliest_arrival(ship, start=start, goal=goal, depart=0.0, method=method)
            if run:  # the first one compiles or loads
                taken.append(1e3 * (time.perf_counter() - begin))
                settled.append(result.settled)
        print(
            f"{method}: median {statistics.median(taken):.2f} ms, maximum {max(taken):.2f} ms per "
            f"query from side to side (target 10; thesis 240,000), "
            f"{statistics.median(settled):.0f} nodes settled"
        )


if __name__ == "__main__":
    main()
