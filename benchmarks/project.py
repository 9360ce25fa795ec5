"""The dredging project of van Halem, complete: 425,500 m3, 11 loads, 35 days of 10-minute fields.

    python benchmarks/project.py [--quick]

The water is the synthetic estuary of the package (some 6,000 nodes, three rings of neighbours, M2
and S2), the ship that of van Halem (2019) with squat. Printed are the time of every stage on this
computer, the number of routes searched, and the table of his study; then the times of single
queries on a network of 50,000 nodes with compiled kernels.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from dataclasses import replace

import numpy as np

from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.network.triangular_mesh.edge_sampling import sampled_on_triangle_sides
from thalweg.network.triangular_mesh.mesh_builder import mesh
from thalweg.operations.dredging import (
    example_file,
    open_project,
    open_project_inputs,
    run_project,
)
from thalweg.operations.examples.estuary import synthetic_estuary
from thalweg.search import PreparedNetwork, ProfileSearch, prepare_profile_search


class Clock:
    """Prints the wall-clock time and the CPU time of each stage."""

    def __init__(self) -> None:
        self.begin = self.last = time.perf_counter()
        self.cpu = time.process_time()

    def lap(self, what: str) -> None:
        now, cpu = time.perf_counter(), time.process_time()
        print(f"{what:<44}{now - self.last:8.2f} s   (CPU {cpu - self.cpu:6.2f} s)", flush=True)
        self.last, self.cpu = time.perf_counter(), time.process_time()


def whole_project(volume: float | None) -> None:
    """Run the example project once with compiled kernels, and print its table."""
    project = open_project(example_file())
    if volume is not None:
        project = replace(project, work=replace(project.work, volume=volume), days=10.0)
    ship, sea, chart = open_project_inputs(project)
    searches = counted_searches()
    for turn in ("first, may compile", "warm"):
        if turn != "warm":  # a small project compiles all kernels
            small = replace(project, work=replace(project.work, volume=4000.0), days=2.0)
            run_project(small, ship=ship, sea=sea, chart=chart)
            continue
        searches.clear()
        clock = Clock()
        result = run_project(replace(project, base=None), ship=ship, sea=sea, chart=chart)
        clock.lap("project, optimised, all legs evaluated")
    legs = 2 * len(result.optimised.cycles)
    print(f"{legs} legs sailed, {len(searches)} time-dependent routes searched")
    full = run_project(project, ship=ship, sea=sea, chart=chart)
    for row in full.table():
        print("  " + f"{row[0]:<34}" + "".join(f"{cell:>14}" for cell in row[1:]))


def counted_searches() -> list[float]:
    """Return a list that receives the departure of every later search."""
    counted: list[float] = []
    plain = ProfileSearch.sail

    def sail(self, depart, **options):
        counted.append(depart)
        return plain(self, depart, **options)

    ProfileSearch.sail = sail
    return counted


def single_queries(spacing: float) -> None:
    """Print the time of one query on a large network with compiled kernels."""
    estuary = synthetic_estuary(spacing)
    nodes = estuary.sea.mesh()
    lat = np.concatenate([[estuary.load[0], estuary.unload[0]], nodes.lat])
    lon = np.concatenate([[estuary.load[1], estuary.unload[1]], nodes.lon])
    clock = Clock()
    network = sampled_on_triangle_sides(mesh(estuary.chart, lat, lon, rings=3))
    clock.lap(f"network of {network.n_nodes:,} nodes, {network.n_edges:,} edges")
    project = open_project(example_file())
    channels = (codes.CURRENT_EAST, codes.CURRENT_NORTH, codes.WATER_LEVEL)
    period = project.start, project.start + 2 * 86400.0
    fields = estuary.sea.freeze_stations(network.lat, network.lon, *period, channels)
    prepared = PreparedNetwork.prepare(network, fields)
    clock.lap("two days of fields")
    ship = open_project_inputs(project)[0]
    for load in (1.0, 0.5, 0.0):
        loaded = ship.with_load_factor(load)
        limits = Limits(required_depth=loaded.draught + 1.0)
        search = prepare_profile_search(
            prepared, loaded.tabulate(), start=0, goal=1, setting=0, limits=limits,
            top_speed=loaded.top_speed(0),
        )  # fmt: skip
        for turn in ("first round", "warm"):
            times = []
            for depart in project.start + 1800.0 * np.arange(48):
                first = time.thread_time()
                search.sail(depart)
                times.append(1000.0 * (time.thread_time() - first))
            print(
                f"load {load:.1f}, {turn}: median {statistics.median(times):.1f} ms of CPU, "
                f"minimum {min(times):.1f}, maximum {max(times):.1f} of {len(times)} departures"
            )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a tenth of the volume, 13,000 nodes")
    quick = parser.parse_args().quick
    whole_project(42_550.0 if quick else None)
    single_queries(205.0 if quick else 105.0)
    return 0


if __name__ == "__main__":
    sys.exit(main())
