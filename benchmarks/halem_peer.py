"""HALEM 1.0.3 and Thalweg in the same rotating flow: time of preparation and query.

    python benchmarks/halem_peer.py [--halem-python PATH]

Without `--halem-python`, HALEM is installed into a temporary environment (needs the package index).
The flow is van Halem's first case (u = 2 cos(pi lat), v = -2 cos(pi lon), ship 4 m/s) on 625 nodes
0.05 degrees apart, three rings of neighbours; its certified optimum is 26240.46 s.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
import venv
from pathlib import Path

import numpy as np

from thalweg import Chart, Sea, Ship, lattice
from thalweg.core.limits import Limits
from thalweg.core.units import KNOT
from thalweg.kernels import codes
from thalweg.search import ShipOnNetwork, earliest_arrival

OPTIMUM = 26240.4617
METRES_PER_DEGREE = 6_372_800.0 * math.pi / 180.0
PER_LON, PER_LAT = 111319.490793, 110574.2759
T0 = 1_546_300_800.0
SPACING = 0.04  # degrees: a little finer than HALEM, so that the error is smaller too
WORKER = Path(__file__).with_name("_halem_worker.py")


def degrees(lat, lon):
    """Return positions near the equator as degrees on van Halem's sphere, for equal distances."""
    return lat * PER_LAT / METRES_PER_DEGREE + 0.5, lon * PER_LON / METRES_PER_DEGREE + 0.5


def position(y, x):
    return (y - 0.5) * METRES_PER_DEGREE / PER_LAT, (x - 0.5) * METRES_PER_DEGREE / PER_LON


def rotating_sea():
    def east(time_s, lat, lon):
        return 2.0 * np.cos(np.pi * degrees(lat, lon)[0])

    def north(time_s, lat, lon):
        return -2.0 * np.cos(np.pi * degrees(lat, lon)[1])

    names = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
    return Sea.from_functions(dict(zip(names, (east, north))), time_step=1800.0)


def ours(directions):
    """Build the network, freeze the sea and search; return (nodes, passage time [s])."""
    south_west, north_east = position(-0.1, -0.1), position(1.1, 1.1)
    chart = Chart.open_water(south_west[0], north_east[0], south_west[1], north_east[1])
    ship = Ship.simple(speed_kn=4.0 / KNOT, draught_m=1.5)
    start, goal = position(0.1, 0.1), position(0.9, 0.9)
    network = lattice(
        chart,
        start,
        goal,
        spacing=SPACING * METRES_PER_DEGREE,
        directions=directions,
        orientation="latlon",
        slack=math.inf,
    )
    fields = rotating_sea().freeze_stations(
        network.stations.lat,
        network.stations.lon,
        T0,
        T0 + 15 * 3600.0,
        (codes.CURRENT_EAST, codes.CURRENT_NORTH),
        extra=None,
    )
    found = earliest_arrival(
        ShipOnNetwork(network, fields, ship.tabulate(), setting=0, limits=Limits(), top_speed=4.0),
        start=network.meta.start,
        goal=network.meta.goal,
        depart=T0,
    )
    return network.n_nodes, found.cost


def halem_python() -> str:
    folder = Path(tempfile.mkdtemp(prefix="halem-"))
    venv.create(folder, with_pip=True)
    python = str(folder / "bin" / "python")
    packages = ["halem==1.0.3", "numpy<2", "scipy", "netCDF4", "IPython"]
    subprocess.run([python, "-m", "pip", "install", "-q", *packages], check=True)
    return python


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--halem-python")
    chosen = parser.parse_args().halem_python
    done = subprocess.run(
        [chosen or halem_python(), str(WORKER), "time"], check=True, stdout=subprocess.PIPE
    )
    peer = json.loads(done.stdout)
    whole = peer["prepare_s"] + peer["query_s"]
    print(
        f"HALEM 1.0.3   {peer['nodes']} nodes: prepare {peer['prepare_s']:.2f} s, query "
        f"{peer['query_s']:.3f} s; passage {peer['passage_s']:.1f} s, "
        f"{100 * (peer['passage_s'] / OPTIMUM - 1):+.2f} % of the optimum"
    )
    for directions in (32, 48):
        ours(directions)
        times = []
        for _ in range(9):
            first = time.perf_counter()
            nodes, passage = ours(directions)
            times.append(time.perf_counter() - first)
        middle = statistics.median(times)
        print(
            f"Thalweg       {nodes} nodes, {directions} directions: prepare + query "
            f"{1000 * middle:.1f} ms (median of 9); passage {passage:.1f} s, "
            f"{100 * (passage / OPTIMUM - 1):+.2f} % of the optimum; "
            f"{whole / middle:,.0f} times faster"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
