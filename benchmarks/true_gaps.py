"""The stated gap of plans against the true one, in worlds with a known optimum and in storms.

    python benchmarks/true_gaps.py [--proof 30 120] [--world NAME ...] [--data FOLDER]

The true gap is that of the route to the optimum, a closed form. In storms no optimum is known: the
true gap is between nil and the stated one. The time for the proof is processor time here, so that
other work on the machine does not count. ``--data`` holds ``metocean/`` with the blizzard of 1996.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import numpy as np
from tests.worlds.plane import Plane, simple_ship

from thalweg import Chart, Plan, Sea, Ship, Voyage, plan
from thalweg.core.geodesy import distance
from thalweg.search.certificate import departure_certificate, time_certificate

BLIZZARD = "metocean/noaa_ngm_blizzard_1996_wind_msl_6h.nc"
M2, LOW_WATER = 12.42 * 3600.0, 1767236400.0  # [s]; 2026-01-01T03:00Z
Case = tuple[Voyage, dict, float]  # voyage, arguments of `plan`, optimum [s] or NaN


def in_plane(
    unit: float, ends: tuple, flow: Callable, optimum: float, reach: float, spacing: float
) -> Case:
    """Return a case of a ship of 5 m/s in a current, with the optimum in units of unit / 5."""
    plane = Plane(unit)
    voyage = Voyage(
        offing_nm=0.0, start=plane.position(*ends[0]), goal=plane.position(*ends[1]),
        depart="2026-01-01T00:00Z",
    )  # fmt: skip
    given = {
        "sea": plane.sea(flow),
        "ship": simple_ship(5.0),
        "chart": plane.water(-reach, reach, -reach, reach),
        "resolution": spacing * unit,
    }
    return voyage, given, optimum * unit / 5.0


def constant_current() -> Case:
    """Return the case of a constant current: a straight line with a crab angle."""
    along, across = 4.0 / math.sqrt(5.0), 3.0 / math.sqrt(5.0)
    optimum = math.hypot(100.0, 50.0) / ((along + math.sqrt(25.0 - across**2)) / 5.0)
    flow = lambda t, x, y: (1.0 + 0 * x, 2.0 + 0 * x)  # noqa: E731
    return in_plane(1000.0, ((0, 0), (100, 50)), flow, optimum, 150.0, 5.0)


def linear_shear() -> Case:
    """Return Zermelo's case: u grows with y, and the way bulges into it."""
    flow = lambda t, x, y: (0.5 * y, 0 * x)  # noqa: E731
    return in_plane(10_000.0, ((0, 0), (10, 0)), flow, 9.63889113, 13.0, 1.0)


def solid_vortex() -> Case:
    """Return the case of a solid vortex: a straight line in the rotating frame."""
    flow = lambda t, x, y: (-2.0 * y, 2.0 * x)  # noqa: E731
    return in_plane(20_000.0, ((2, -1), (-1, 1.5)), flow, 2.78402370, 3.0, 0.4)


def moving_vortex() -> Case:
    """Return the case of a vortex whose centre moves by 0.3 of the ship's speed."""

    def flow(t, x, y):
        dx = x - 0.3 * t * 5.0 / 20_000.0
        return -y, dx

    return in_plane(20_000.0, ((-3, 0), (3, 0)), flow, 5.36960792, 5.0, 0.6)


def tidal_bar() -> Case:
    """Return the case of a bar that opens on the rising tide, with the ship at its edge."""
    goal, speed = (51.77, 3.70), 10.0 * 1852.0 / 3600.0
    opens = math.acos(-1.0 / 3.0) / (2.0 * math.pi) * M2  # a clearance of 1 m over 7 m

    def depth(t, lat, lon):
        return np.where((lon > 3.55) & (lon < 3.60), 7.0, 15.0) + 0.0 * lat

    def level(t, lat, lon):
        return -1.5 * np.cos(2 * np.pi * (t - LOW_WATER) / M2) + 0.0 * lat

    sea = Sea.from_functions(
        {
            "sea_floor_depth_below_geoid": depth,
            "sea_surface_height_above_geopotential_datum": level,
        }
    )
    voyage = Voyage(start=(51.71, 3.45), goal=goal, depart="2026-01-01T03:00Z", min_ukc_m=1.0)
    given = {
        "sea": sea,
        "ship": Ship.simple(speed_kn=10.0, draught_m=6.5),
        "chart": Chart.open_water(51.6, 51.9, 3.40, 3.75),
        "resolution": 1000.0,
    }
    edge = np.linspace(goal[0] - 0.01, goal[0] + 0.01, 201)
    beyond = float(np.min(distance(edge, 3.55, *goal)))
    return voyage, given, opens + beyond / speed


def storm() -> Case:
    """Return the demonstration: Danielle of 1998 between Halifax and Bishop Rock."""
    voyage = Voyage(start=(44.5, -63.0), goal=(49.7, -6.5), depart="1998-08-31T12:00Z")
    return voyage, {"sea": Sea.storm(), "ship": Ship.load("handysize-bulker")}, math.nan


def blizzard(folder: Path) -> Case:
    """Return a voyage through the analysis of the blizzard of January 1996."""
    sea = Sea.open(folder / BLIZZARD).filled(wind=0.0, waves="wind", currents=0.0)
    voyage = Voyage(start=(45.0, -50.0), goal=(41.5, -66.0), depart="1996-01-08T00:00Z")
    return voyage, {"sea": sea, "ship": Ship.load("handysize-bulker")}, math.nan


WORLDS: dict[str, Callable[[], Case]] = {
    "constant current": constant_current,
    "linear shear": linear_shear,
    "solid vortex": solid_vortex,
    "moving vortex": moving_vortex,
    "tidal bar": tidal_bar,
    "demo storm": storm,
}


def print_row(name: str, proof: float, found: Plan, optimum: float, seconds: float) -> None:
    """Print one row of a table in Markdown."""
    hours, best = found.best.time_h, optimum / 3600.0
    true = "" if math.isnan(best) else f"{100.0 * (1.0 - best / hours):.2f} %"
    stated = 100.0 * (1.0 - found.lower_bound / hours)
    over = "" if math.isnan(best) else f"{found.lower_bound / best:.4f}"
    print(
        f"| {name} | {proof:g} s | {hours:.4f} h | {stated:.2f} % | {true} | {over} | "
        f"{seconds:.0f} s |",
        flush=True,
    )


def main() -> None:
    """Plan in each world, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--proof", type=float, nargs="+", default=[30.0, 120.0])
    parser.add_argument("--world", nargs="+")
    parser.add_argument("--data", type=Path)
    chosen = parser.parse_args()
    worlds = dict(WORLDS)
    if chosen.data is not None:
        worlds["blizzard of 1996"] = lambda: blizzard(chosen.data)
    for module in (time_certificate, departure_certificate):
        module.clock = SimpleNamespace(perf_counter=time.process_time)
    print("| world | proof | route | stated gap | true gap | bound / optimum | processor time |")
    print("|---|---|---|---|---|---|---|")
    for name in chosen.world or worlds:
        voyage, given, optimum = worlds[name]()
        for proof in chosen.proof:
            began = time.process_time()
            found = plan(voyage, **given, proof=proof)
            print_row(name, proof, found, optimum, time.process_time() - began)


if __name__ == "__main__":
    main()
