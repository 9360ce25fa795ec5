"""The least length round land against ways that exist, between ports chosen at random.

    python -m tests.campaigns.least_lengths [--pairs 200] [--seconds 5] [--seed 1]

A way that `thalweg.sea_distance` finds, from sea end to sea end of the approaches, must not be
shorter than the bound. The ratio of the two is printed: what the bound loses.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from thalweg import Chart
from thalweg.chart.ports import PORTS
from thalweg.core.errors import ThalwegError
from thalweg.core.geodesy import distance
from thalweg.planning.sea_distance import sea_distance
from thalweg.search.certificate.barrier_mesh import BarrierLink
from thalweg.search.certificate.length_round_land import length_round_land

NM = 1852.0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=5.0, help="for each bound")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    chart = Chart.gshhg("i").within(-60.0, 72.0, -180.0, 180.0)
    ports = [port for port in PORTS.all if chart.approaches.of(port) is not None]
    links = [BarrierLink(*canal.ends, canal.length) for canal in chart.canals]
    shares, violations = [], 0
    while len(shares) < options.pairs:
        start, goal = (ports[k] for k in random.choice(len(ports), 2, replace=False))
        ends = [chart.approaches.of(port).line[-1] for port in (start, goal)]
        if float(distance(*ends[0], *ends[1])) < 20.0 * NM or max(e[0] for e in ends) > 71.0:
            continue
        try:
            way = sea_distance(ends[0], ends[1], avoid=())
        except ThalwegError:
            continue
        known = way.length
        began = time.perf_counter()
        least = length_round_land(chart, *ends, 1.02 * known, links=links, seconds=options.seconds)
        shares.append(least / known)
        wrong = least > known * (1.0 + 1e-6)
        violations += wrong
        print(
            f"{start.name} - {goal.name}: {known / NM:.1f} nm, bound {least / NM:.1f} "
            f"({100.0 * shares[-1]:.2f} %), {time.perf_counter() - began:.1f} s"
            + (" VIOLATION" if wrong else ""),
            flush=True,
        )
    low, middle = np.quantile(shares, [0.05, 0.5])
    print(
        f"{len(shares)} pairs: {violations} violations; bound over way: median {middle:.4f}, "
        f"5 % below {low:.4f}, least {min(shares):.4f}"
    )
    return int(violations > 0)


if __name__ == "__main__":
    raise SystemExit(main())
