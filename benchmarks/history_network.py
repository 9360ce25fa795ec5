"""History networks: from AIS positions in memory and in a file to a network, and route queries.

A made fleet of 200 ships sails the shortest ways between twelve ports, with a spread of 1.5 km and
a position every three minutes. CPU seconds are measured, because other programs may be running.
Call with the number of positions (default 1e6).
"""

from __future__ import annotations

import itertools
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from thalweg.chart import Chart
from thalweg.network.history.history_file import read_history, write_history
from thalweg.operations.examples.synthetic_fleet import (
    SyntheticFleet,
    SyntheticRoute,
    synthetic_fleet,
)
from thalweg.operations.fleet import history_from_tracks, read_fleet
from thalweg.planning.sea_distance import sea_distance

PORTS = ("Rotterdam", "Hamburg", "New York", "Lisbon", "Algeciras", "Genoa", "Port Said",
         "Le Havre", "Santos", "Las Palmas", "Bergen", "Gdansk")  # fmt: skip
SHIPS, INTERVAL = 200, 180.0
MOST_IN_A_FILE = 1_000_000


def routes() -> tuple[dict[tuple[str, str], float], tuple[SyntheticRoute, ...]]:
    """Return the distances [nm] of the sailed pairs, and their routes in both directions."""
    count = len(PORTS)
    pairs = [(PORTS[k], PORTS[(k + step) % count]) for step in (1, 3) for k in range(count)]
    found = {pair: sea_distance(*pair) for pair in pairs}
    berth = {
        name: way.line[end] for (a, b), way in found.items() for name, end in ((a, 0), (b, -1))
    }
    lines = [(berth[a], *way.line[1:-1], berth[b]) for (a, b), way in found.items()]
    both = [SyntheticRoute(tuple(way)) for line in lines for way in (line, line[::-1])]
    return {pair: way.nm for pair, way in found.items()}, tuple(both)


def main() -> None:
    count = int(float(sys.argv[1])) if len(sys.argv) > 1 else 1_000_000
    known, ways = routes()
    fleet = SyntheticFleet(ways, ships=SHIPS, interval_s=INTERVAL)
    days = count * INTERVAL / 86_400.0 / SHIPS
    table = synthetic_fleet(fleet, start="2022-01-01", days=days, seed=1).iloc[:count]
    chart = Chart.gshhg("i")
    begin = time.process_time()
    tracks = read_fleet([table])
    cleaned = time.process_time()
    network = history_from_tracks(tracks, chart)
    done = time.process_time()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(f"{count:,} positions, {network.summary['voyages']:,} voyages: {done - begin:.1f} CPU s "
          f"(cleaning {cleaned - begin:.1f} s), {memory:.1f} GB at most")  # fmt: skip
    print(f"{len(network.nodes)} nodes, arcs: {network.arcs_by_kind()}")
    with tempfile.TemporaryDirectory() as folder:
        if count <= MOST_IN_A_FILE:
            path = Path(folder) / "ais.csv"
            table.to_csv(path, index=False)
            begin = time.process_time()
            read_fleet([path])
            print(f"reading and cleaning as CSV: {time.process_time() - begin:.1f} CPU s")
        path = Path(folder) / "net.json"
        write_history(network, path)
        network = read_history(path)
    names = [port.name for port in network.ports]
    network.route(names[0], names[1])
    spent = []
    for pair in itertools.permutations(names, 2):
        begin = time.process_time()
        network.route(*pair)
        spent.append(1e3 * (time.process_time() - begin))
    print(f"a route: median {np.median(spent):.2f} ms, longest {max(spent):.2f} ms")
    off = [100.0 * (network.route(a, b).nm / nm - 1.0) for (a, b), nm in known.items()]
    print(
        f"usual against sailed distance of {len(off)} pairs: median {np.median(off):+.2f} %, "
        f"of the size {np.median(np.abs(off)):.2f} %, worst {max(off, key=abs):+.2f} %"
    )


if __name__ == "__main__":
    main()
