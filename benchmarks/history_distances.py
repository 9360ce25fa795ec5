"""Distances of a history network against NGA Publication 151.

A made fleet sails the shortest ways between the ports of the table in `tests/reference`, both ways,
for 600 days with a position every hour. The network is made from its tracks; its distances and
those of the ways themselves are compared with the published ones.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from thalweg.chart import Chart
from thalweg.operations.examples.synthetic_fleet import (
    SyntheticFleet,
    SyntheticRoute,
    synthetic_fleet,
)
from thalweg.operations.fleet import history_from_tracks, read_fleet
from thalweg.planning.sea_distance import sea_distance

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tests.reference.test_distances_nga_pub_151 import PUBLISHED


def main() -> None:
    pairs = [row for row in PUBLISHED if isinstance(row[0], str) and isinstance(row[1], str)]
    ways = [sea_distance(start, goal) for start, goal, _ in pairs]
    berth: dict[str, tuple[float, float]] = {}
    for (start, goal, _), way in zip(pairs, ways):
        berth.setdefault(str(start), way.line[0])
        berth.setdefault(str(goal), way.line[-1])
    routes = []
    for (start, goal, _), way in zip(pairs, ways):
        line = (berth[str(start)], *way.line[1:-1], berth[str(goal)])
        routes += [SyntheticRoute(line), SyntheticRoute(line[::-1])]
    fleet = SyntheticFleet(tuple(routes), ships=len(routes), interval_s=3600.0)
    messages = synthetic_fleet(fleet, start="2022-01-01", days=600, seed=1)
    network = history_from_tracks(read_fleet([messages]), Chart.gshhg("i"))
    print(f"{len(messages):,} positions, arcs: {network.arcs_by_kind()}")
    published = np.array([nm for *_, nm in pairs], float)
    usual = np.array([network.route(str(a), str(b)).nm for a, b, _ in pairs])
    for name, found in (("usual", usual), ("shortest", np.array([way.nm for way in ways]))):
        off = 100.0 * (found / published - 1.0)
        worst = int(np.argmax(np.abs(off)))
        print(
            f"{name} distances of {len(off)} pairs: median {np.median(off):+.2f} %, of the size "
            f"{np.median(np.abs(off)):.2f} %, 95 % within {np.percentile(np.abs(off), 95):.2f} %, "
            f"worst {off[worst]:+.2f} % ({pairs[worst][0]} to {pairs[worst][1]})"
        )


if __name__ == "__main__":
    main()
