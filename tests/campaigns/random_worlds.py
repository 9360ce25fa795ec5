"""Random worlds of islands and currents, planned and checked again by a plain referee.

``python -m tests.campaigns.random_worlds --count 500 --seed 1``
"""

from __future__ import annotations

import sys
import time

import numpy as np
import shapely

from tests.campaigns.plain_referee import (
    arguments,
    legs_on_land,
    random_islands,
    sailing_time,
)
from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.units import KNOT

EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"


def main() -> int:
    """Run the campaign; return 1 if a plan is wrong."""
    chosen = arguments(500)
    rng = np.random.default_rng(chosen.seed)
    begin = time.process_time()
    planned = refused = wrong = above_bound = 0
    worst = 0.0
    for number in range(chosen.count):
        land = random_islands(rng, int(rng.integers(0, 10)))
        p = rng.uniform(-1.2, 1.2, 4)

        def current(t, lat, lon, p=p):
            swing = np.cos(2.0 * np.pi * np.asarray(t) / 44712.0)
            return (
                p[0] * np.sin(3.0 * lat) + p[1] * swing + 0.0 * lon,
                p[2] * np.cos(4.0 * lon) + p[3] * swing + 0.0 * lat,
            )

        sea = Sea.from_functions(
            {
                EAST: lambda t, y, x, f=current: f(t, y, x)[0],
                NORTH: lambda t, y, x, f=current: f(t, y, x)[1],
            }
        )
        chart = Chart.from_geojson(shapely.geometry.mapping(land)) if not land.is_empty else None
        chart = chart or Chart.open_water(-2.0, 2.0, -2.0, 2.0)
        ends = rng.uniform(-0.9, 0.9, (2, 2))
        speed = float(rng.uniform(3.0, 8.0))
        try:
            found = plan(
                Voyage(start=tuple(ends[0]), goal=tuple(ends[1]), depart="2026-01-01"),
                ship=Ship.simple(speed_kn=speed / KNOT, draught_m=5.0),
                sea=sea,
                chart=chart,
                resolution=5000.0,
            )
        except (InputError, NoRouteError):
            refused += 1
            continue
        planned += 1
        track = found.best.track
        touches, sure = legs_on_land(
            track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:], land
        )
        own = sailing_time(
            track.lat, track.lon, speed=speed, current=current, depart=track.depart, steps=100
        )
        waits = float(np.sum(track.wait))
        error = abs(found.best.time_h * 3600.0 - waits - own) / own if waits == 0.0 else 0.0
        worst = max(worst, error)
        if (touches & sure).any() or not found.best.feasible or not error < 1e-3:
            wrong += 1
            print(f"world {number}: land {int((touches & sure).sum())}, time off {error:.2e}")
        above_bound += int(found.gap < -1e-9) if found.gap is not None else 0
    print(
        f"{chosen.count} worlds, seed {chosen.seed}: {planned} planned, {refused} refused, {wrong} "
        f"wrong, {above_bound} bounds above the answer; time off by at most {worst:.2e}; "
        f"{time.process_time() - begin:.0f} s CPU"
    )
    return int(wrong + above_bound > 0)


if __name__ == "__main__":
    sys.exit(main())
