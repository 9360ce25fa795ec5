"""Distances by sea against those of searoute, for pairs of large ports.

Needs ``pip install searoute`` (1.6.0), which is not a dependency. searoute finds the shortest way
on a network of shipping lanes (marnet), from the vertex nearest to each port; the straight lines
from the ports to those vertices are added here. Panama and Suez are open in both, the Northwest
and Northeast Passages closed, and so are the canals of Kiel, Corinth and Cape Cod: it lacks them.

The lanes bend. To tell bends from another choice of water, the line of searoute is also pulled taut
on our chart (legs 2 nm off land, as ours): what is left of the difference is ours to explain. The
last column says "bends" where this is at most 1 %, else which passages only one of the two uses.

Usage: ``python benchmarks/sea_distances.py [PAIRS] [FILE.csv]``
"""

from __future__ import annotations

import csv
import importlib.util
import random
import sys
import time

import numpy as np

from thalweg import Chart
from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.passage_crossings import names_passed
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import line_length
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.planning.sea_distance import sea_distance
from thalweg.planning.seaways import Seaways

SEED = 7
MOST_LINKED = 90


def chosen_pairs(count: int) -> list[tuple[str, str]]:
    """Return pairs of the ports with most liner connections, at random."""
    linked = sorted(PORTS.all, key=lambda port: -port.importance)
    codes = [p.locode for p in linked if p.locode and PORT_APPROACHES.of(p)][:MOST_LINKED]
    every = [(a, b) for k, a in enumerate(codes) for b in codes[k + 1 :]]
    return random.Random(SEED).sample(every, count)


def pulled_taut(seas: Seaways, line: list[list[float]]) -> list[tuple[float, float]]:
    """Return the line of searoute (lon, lat) with its bends removed, where legs may be sailed."""
    lon, lat = np.array(line, float).T
    chart = seas.chart.without_canals("all").with_offing(2.0 * NAUTICAL_MILE)
    keep = np.append(True, (np.abs(np.diff(lat)) + np.abs(np.diff(lon))) > 1e-9)
    pulled = string_pull_path(chart, lat[keep], (lon[keep] + 180.0) % 360.0 - 180.0, rounds=4)
    return list(zip(*(part.tolist() for part in pulled)))


def cause(ours: tuple[str, ...], lanes: tuple[str, ...], rest: float) -> str:
    """Return why our distance is another than that of the lanes without bends [%]."""
    if abs(rest) <= 1.0:
        return "bends"
    only = [f"only ours: {', '.join(x for x in ours if x not in lanes)}"]
    only += [f"only lanes: {', '.join(x for x in lanes if x not in ours)}"]
    return "; ".join(text for text in only if not text.endswith(": ")) or "same passages"


def compare(start: str, goal: str, seas: Seaways) -> dict[str, object]:
    """Return one row of the comparison."""
    import searoute

    first, last = PORTS.lookup(start), PORTS.lookup(goal)
    begin = time.perf_counter()
    ours = sea_distance(start, goal, avoid=("kiel", "corinth", "cape-cod"))
    spent = time.perf_counter() - begin
    route = searoute.searoute(
        [first.lon, first.lat],
        [last.lon, last.lat],
        units="naut",
        append_orig_dest=True,
        restrictions=["northwest", "northeast"],
    )
    theirs = float(route["properties"]["length"])
    line = pulled_taut(seas, route["geometry"]["coordinates"])
    taut = line_length(line) / NAUTICAL_MILE
    rest = 100.0 * (ours.nm / taut - 1.0)
    lanes = names_passed(seas.chart.coastline, seas.chart.passages, *np.array(line).T)
    return {
        "from": start, "to": goal, "thalweg_nm": round(ours.nm, 1),
        "searoute_nm": round(theirs, 1),
        "difference_percent": round(100.0 * (ours.nm / theirs - 1.0), 2),
        "taut_nm": round(taut, 1), "rest_percent": round(rest, 2),
        "canals": "+".join(ours.canals), "straits": "+".join(ours.straits),
        "seconds": round(spent, 2), "cause": cause(ours.straits, lanes, rest),
    }  # fmt: skip


def main() -> None:
    if importlib.util.find_spec("searoute") is None:
        print("searoute is not installed: there is nothing to compare (pip install searoute)")
        return
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    seas = Seaways.of_chart(Chart.gshhg("i"), ())
    rows = [compare(a, b, seas) for a, b in chosen_pairs(count)]
    if len(sys.argv) > 2:
        with open(sys.argv[2], "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
    off = np.array([float(row["difference_percent"]) for row in rows])  # type: ignore[arg-type]
    print(f"{count} pairs: median {np.median(off):+.2f} %, of the size {np.median(abs(off)):.2f} %")
    print(f"95 % within {np.percentile(abs(off), 95):.2f} %, largest {abs(off).max():.1f} %")
    rest = np.array([float(row["rest_percent"]) for row in rows])  # type: ignore[arg-type]
    print(
        f"without the bends of the lanes: median {np.median(rest):+.2f} %, of the size "
        f"{np.median(abs(rest)):.2f} %, 95 % within {np.percentile(abs(rest), 95):.2f} %"
    )
    print(f"median time {np.median([row['seconds'] for row in rows]):.2f} s")  # type: ignore[misc]
    for row in sorted(rows, key=lambda row: -abs(float(row["rest_percent"])))[:40]:  # type: ignore[arg-type]
        print(*row.values(), sep="  ")


if __name__ == "__main__":
    main()
