"""Growth of time and memory with nodes, directions, time steps, speeds and legs.

Every case runs in a process of its own and gives its processor time and its largest memory. Over
the sizes of one quantity, all others fixed, two lines are fitted: the slope of the logarithm of the
time (1 is proportional, 2 is the square, 0 does not grow), and the memory as a fixed part and so
much for each. From these follows what fits into the memory of this machine, and how long that would
take.

    python benchmarks/growth.py [--quick]

* Search: the earliest arrival at all nodes of `relaxations.py`, one setting.
* Front: time against fuel in the jet and eddies of `front.py`, 5-minute bins.
* Referee: a track of one length sailed along more and more legs, in a current of formulas.
"""

from __future__ import annotations

import argparse
import multiprocessing
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import numpy as np
from benchmarks.relaxations import OFFSETS, SPACING, SPEED, TOP_LIMITS, moving_sea, speed_table
from benchmarks.relaxations import regular_network as network_of_side
from tests.search.small import NO_LIMITS
from tests.worlds import jet_and_eddies as world

from thalweg import Sea, Ship, evaluate
from thalweg.core.memory import machine_memory
from thalweg.route import Track
from thalweg.search import FrontQuery, MultiSettingShipOnNetwork, pareto_front
from thalweg.search.earliest_arrival import ArrivalQuery, solve_earliest_arrival
from thalweg.search.search_problem import ShipOnNetwork, make_search_problem

REACHES = {8: 1, 16: 2, 32: 3, 48: 4, 80: 5}  #: largest step of the offsets by directions
EIGHT = 8  # channels of the sea of `relaxations.py`


@dataclass(frozen=True)
class Growth:
    """One quantity that grows, the others fixed."""

    what: str
    quantity: str
    sizes: tuple[int, ...]
    run: Callable[[int], float]  # returns processor time [s], without the preparation


def offsets_of(directions: int) -> list[tuple[int, int]]:
    """Return offsets of a lattice with a number of directions."""
    steps = range(-REACHES[directions], REACHES[directions] + 1)
    return [(i, j) for i in steps for j in steps if np.gcd(i, j) == 1]


def search(side: int, directions: int = 16, times: int = 8) -> float:
    """Search the earliest arrivals at all nodes of a square of nodes."""
    network = network_of_side(side, OFFSETS if directions == 16 else offsets_of(directions))
    fields = moving_sea(network, 3.0 * side * SPACING / SPEED, times)
    ship = ShipOnNetwork(
        network, fields, speed_table(), setting=0, limits=TOP_LIMITS, top_speed=SPEED
    )
    problem = make_search_problem(ship)
    return timed(lambda: solve_earliest_arrival(network, problem, ArrivalQuery(0, None, 0.0)))


def front(spacing: float = 12.5, settings: int = 12) -> float:
    """Search the front of the jet and eddies at some of its settings, spread evenly."""
    grid = world.Grid(spacing)
    network = grid.network()
    table, fuel = world.tables()
    ship = MultiSettingShipOnNetwork(network, world.freeze(network), table, fuel, NO_LIMITS)
    chosen = np.unique(np.linspace(0, 11, settings).round().astype(int))
    latest = world.T0 + world.LATEST * world.HOUR
    start, goal = grid.node(world.START), grid.node(world.GOAL)
    query = FrontQuery(start, goal, world.T0, latest, settings=chosen)
    return timed(
        lambda: pareto_front(ship, query, bin_s=world.HOUR / 12.0, lower=False, memory_limit=8e9)
    )


def referee(legs: int) -> float:
    """Sail 600 nm along a number of legs."""
    lon = np.linspace(0.0, 10.0, legs + 1)
    track = Track(0.2 * np.sin(lon), lon, 0.0, None, np.zeros(legs, np.int64))
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, lat, lon: 0.5 * np.sin(lon + t / 9000.0),
            "northward_sea_water_velocity": lambda t, lat, lon: 0.2 * np.cos(lat + 0.0 * t),
        }
    )
    ship = Ship.simple(speed_kn=12.0, draught_m=5.0)
    return timed(lambda: evaluate(track, ship=ship, sea=sea))


def timed(work: Callable[[], object]) -> float:
    """Return the processor time [s] of the second call: the first loads kernels."""
    for _ in range(2):
        began = time.process_time()
        work()
    return time.process_time() - began


def measured(run: Callable[[int], float], size: int) -> tuple[float, float]:
    """Return processor time [s] and memory [bytes] of a case in a process of its own."""
    with multiprocessing.get_context("fork").Pool(1) as pool:
        return pool.apply(run, (size,)), pool.apply(peak)


def peak() -> float:
    """Return the largest memory that this process has had [bytes]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024.0


@dataclass(frozen=True)
class Fit:
    """The growth with one quantity: time as a power of it, memory as a line.

    Attributes
    ----------
    time_slope, time_factor : Time is the factor times the size to the power of the slope [s].
    each, fixed : Memory [bytes].
    """

    time_slope: float
    time_factor: float
    each: float
    fixed: float

    def time(self, size: float) -> float:
        """Return the time of a size [s]."""
        return self.time_factor * size**self.time_slope


def show(growth: Growth) -> Fit:
    """Measure one quantity, print it and return its growth."""
    print(f"{growth.what} against {growth.quantity}")
    rows = []
    for size in growth.sizes:
        taken, used = measured(growth.run, size)
        rows.append((size, max(taken, 1e-6), used))
        print(f"  {size:>10,}  {taken:8.3f} s  {used / 1e6:8.0f} MB", flush=True)
    sizes, seconds, memory = np.array(rows).T
    slope, factor = np.polyfit(np.log(sizes), np.log(seconds), 1)
    each, fixed = np.polyfit(sizes, memory, 1)
    print(
        f"  time grows with the power {slope:.2f}; {each / 1e3:.3g} kB each "
        f"and {fixed / 1e6:.0f} MB"
    )
    return Fit(float(slope), float(np.exp(factor)), float(each), float(fixed))


def run_search_of_nodes(nodes: int) -> float:
    return search(round(nodes**0.5))


def run_search_of_directions(directions: int) -> float:
    return search(300, directions)


def run_search_of_times(times: int) -> float:
    return search(300, times=times)


def run_front_of_nodes(nodes: int) -> float:
    return front(world.SIDE / (round(nodes**0.5) - 1))


def run_front_of_speeds(settings: int) -> float:
    return front(settings=settings)


GROWTHS = (
    Growth("search", "directions", (8, 16, 32, 80), run_search_of_directions),
    Growth("search", "time steps", (8, 16, 32, 64), run_search_of_times),
    Growth("front", "nodes", (441, 961, 1681, 2601), run_front_of_nodes),
    Growth("front", "speeds", (2, 3, 6, 12), run_front_of_speeds),
    Growth("referee", "legs", (10, 40, 160, 640), referee),
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="the search up to 40,000 nodes")
    options = parser.parse_args()
    sizes = (10_000, 40_000, 160_000, 640_000)
    nodes = Growth("search", "nodes", sizes[: 2 if options.quick else 4], run_search_of_nodes)
    fit, total = show(nodes), machine_memory()
    most = (total - fit.fixed) / fit.each
    print(
        f"  the {total / 1e9:.0f} GB of this machine end at about {most / 1e6:.0f} million nodes "
        f"(16 directions, 8 times, {EIGHT} channels), which would take {fit.time(most):.0f} s"
    )
    for growth in GROWTHS:
        show(growth)


if __name__ == "__main__":
    main()
