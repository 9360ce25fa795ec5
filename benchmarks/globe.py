"""The global network: construction, loading, search, and alternative routes.

Targets: GSHHG i at level 4 with 6 coast levels built in 20 s, loaded in 1 s. A published prototype
of the method: 33 s to build, queries of 2 to 90 ms.

    python benchmarks/globe.py [--resolution i]
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

from thalweg.chart import Chart
from thalweg.network import alternative_paths, globe, paths_without_canals, shortest_path
from thalweg.network.global_grid import grid as globe_grid

VOYAGES = {
    "Rotterdam - Singapore": ((51.98, 4.0), (1.2, 103.9)),
    "New York - San Francisco": ((40.5, -73.9), (37.75, -122.6)),
    "English Channel - New York": ((49.7, -6.0), (40.5, -73.9)),
    "Rotterdam - Gdansk": ((51.98, 4.0), (54.6, 18.9)),
}


def timed(what, function, *args, **options):
    clock, work = time.perf_counter(), time.process_time()
    answer = function(*args, **options)
    clock, work = time.perf_counter() - clock, time.process_time() - work
    print(f"  {what}: {clock:.3f} s ({work:.3f} s of one core)")
    return answer


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--resolution", default="i")
    options = parser.parse_args()
    chart = Chart.gshhg(options.resolution)
    globe_grid.make_grid(chart, globe_grid.GridResolution(2, 1))  # compiles or loads the kernels
    print(f"grid of GSHHG {options.resolution}, level 4 + 6")
    grid = timed("built", globe_grid.make_grid, chart, globe_grid.GridResolution())
    print(f"  {len(grid.lat):,} nodes, {len(grid.pairs.first):,} legs, {grid.rejected:,} rejected")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "grid.npz"
        globe_grid._save(path, grid)
        timed(f"loaded ({path.stat().st_size / 1e6:.0f} MB)", globe_grid._load, path)
    globe(chart, *VOYAGES["Rotterdam - Gdansk"])
    for name, ends in VOYAGES.items():
        print(name)
        network = timed("network", globe, chart, *ends)
        start, goal = network.meta.start, network.meta.goal
        shortest_path(network, start, goal)
        distance, _ = timed("A*", shortest_path, network, start, goal)
        timed("Dijkstra", shortest_path, network, start, goal, per_metre=0.0)
        print(
            f"  {network.n_nodes:,} nodes, {network.n_edges:,} edges, "
            f"{distance[goal] / 1852:.1f} nm"
        )
        ways = timed("alternatives", alternative_paths, network, chart)
        print("  " + ", ".join(f"{w.length / 1852:.1f} nm {w.canals}" for w in ways))
        ways = timed("without canals", paths_without_canals, network, chart)
        print("  " + ", ".join(f"{w.length / 1852:.1f} nm {w.canals}" for w in ways))


if __name__ == "__main__":
    main()
