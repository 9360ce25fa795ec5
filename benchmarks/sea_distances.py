"""Distances by sea against those of searoute, for pairs of large ports.

Needs ``pip install searoute`` (1.6.0), which is not a dependency. searoute finds the shortest way
on a network of shipping lanes (marnet), from the vertex nearest to each port; the straight lines
from the ports to those vertices are added here. Panama and Suez are open in both, the Northwest
and Northeast Passages closed, and so are the canals of Kiel and Corinth, which it does not have.

Usage: ``python benchmarks/sea_distances.py [PAIRS] [FILE.csv]``
"""

from __future__ import annotations

import csv
import random
import sys
import time

import numpy as np

from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.ports import PORTS
from thalweg.planning.sea_distance import sea_distance

SEED = 7
MOST_LINKED = 90


def chosen_pairs(count: int) -> list[tuple[str, str]]:
    """Return pairs of the ports with most liner connections, at random."""
    linked = sorted(PORTS.all, key=lambda port: -port.importance)
    codes = [p.locode for p in linked if p.locode and PORT_APPROACHES.of(p)][:MOST_LINKED]
    every = [(a, b) for k, a in enumerate(codes) for b in codes[k + 1 :]]
    return random.Random(SEED).sample(every, count)


def compare(start: str, goal: str) -> dict[str, object]:
    """Return one row of the comparison."""
    import searoute

    first, last = PORTS.lookup(start), PORTS.lookup(goal)
    begin = time.perf_counter()
    ours = sea_distance(start, goal, avoid=("kiel", "corinth"))
    spent = time.perf_counter() - begin
    route = searoute.searoute(
        [first.lon, first.lat],
        [last.lon, last.lat],
        units="naut",
        append_orig_dest=True,
        restrictions=["northwest", "northeast"],
    )
    theirs = float(route["properties"]["length"])
    return {
        "from": start, "to": goal, "thalweg_nm": round(ours.nm, 1),
        "searoute_nm": round(theirs, 1),
        "difference_percent": round(100.0 * (ours.nm / theirs - 1.0), 2),
        "canals": "+".join(ours.canals), "straits": "+".join(ours.straits),
        "seconds": round(spent, 2),
    }  # fmt: skip


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    rows = [compare(a, b) for a, b in chosen_pairs(count)]
    if len(sys.argv) > 2:
        with open(sys.argv[2], "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
    off = np.array([float(row["difference_percent"]) for row in rows])  # type: ignore[arg-type]
    print(f"{count} pairs: median {np.median(off):+.2f} %, of the size {np.median(abs(off)):.2f} %")
    print(f"95 % within {np.percentile(abs(off), 95):.2f} %, largest {abs(off).max():.1f} %")
    print(f"median time {np.median([row['seconds'] for row in rows]):.2f} s")  # type: ignore[misc]
    for row in sorted(rows, key=lambda row: -abs(float(row["difference_percent"])))[:40]:  # type: ignore[arg-type]
        print(*row.values(), sep="  ")


if __name__ == "__main__":
    main()
