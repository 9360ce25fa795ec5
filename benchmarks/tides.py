"""Tides: harmonic analysis of a model run, and sampling of the predicted sea.

Run ``python benchmarks/tides.py [--quick]``; prints seconds of wall-clock time. Target: 5,000 nodes
and 35 days of 10-minute currents and levels analysed in 3 minutes on 2 cores.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from thalweg.kernels import codes
from thalweg.sea import Sea
from thalweg.sea import standard_names as nm
from thalweg.sea.tides.harmonic_analysis import analyse, select_constituents

VARIABLES = (*nm.CURRENT.pair, nm.WATER_LEVEL)
START = 1.7e9


def main() -> None:
    """Print the time of each part."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    nodes = 500 if parser.parse_args().quick else 5000
    times = START + 600.0 * np.arange(35 * 144)
    rng = np.random.default_rng(0)
    lat, lon = 51.0 + rng.random(nodes), 2.0 + rng.random(nodes)
    run = {n: rng.normal(size=(nodes, times.size)).astype(np.float32) for n in VARIABLES}
    print(
        f"{nodes} nodes, {times.size} times, {len(select_constituents(times, None))} constituents"
    )

    began = time.perf_counter()
    found = analyse(times, run, lat=lat, lon=lon)
    print(f"analysis of currents and level       {time.perf_counter() - began:8.2f} s")

    level = run[nm.WATER_LEVEL]
    level[rng.random(level.shape) < 1e-3] = np.nan
    began = time.perf_counter()
    analyse(times, {nm.WATER_LEVEL: level}, lat=lat, lon=lon)
    print(f"level, each node with different gaps  {time.perf_counter() - began:7.2f} s")

    sea = Sea.from_tides(found)
    inside = 51.1 + 0.8 * rng.random(nodes), 2.1 + 0.8 * rng.random(nodes)
    channels = [codes.CURRENT_EAST, codes.CURRENT_NORTH, codes.WATER_LEVEL]
    for days in (2.0, 35.0):
        began = time.perf_counter()
        sea.freeze_stations(*inside, START + 1e8, START + 1e8 + days * 86400.0, channels)
        taken = time.perf_counter() - began
        print(f"frozen for kernels at {nodes} stations, {days:2.0f} days {taken:6.2f} s")


if __name__ == "__main__":
    main()
