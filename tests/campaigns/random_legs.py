"""Random legs: land, distance and time of the referee against a plain one.

``python -m tests.campaigns.random_legs --count 1000000 --seed 1``; every 2,000th leg is sailed too.
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
    vincenty,
)
from thalweg import Chart, Sea, Ship
from thalweg.core.geodesy import distance
from thalweg.core.units import KNOT
from thalweg.route import evaluate

LOT = 50_000
EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"


def main() -> int:
    """Run the campaign; return 1 if something differs."""
    chosen = arguments(1_000_000)
    rng = np.random.default_rng(chosen.seed)
    begin = time.process_time()
    wrong_land = unsure = 0
    worst_length = worst_time = 0.0
    sailed = disagree = 0
    for first in range(0, chosen.count, LOT):
        count = min(LOT, chosen.count - first)
        land = random_islands(rng, 12)
        chart = Chart.from_geojson(shapely.geometry.mapping(land))
        lat, lon = rng.uniform(-1.0, 1.0, (2, count))
        course, far = rng.uniform(0.0, 2.0 * np.pi, count), rng.uniform(0.001, 0.5, count)
        lat2, lon2 = lat + far * np.cos(course), lon + far * np.sin(course)
        touches, sure = legs_on_land(lat, lon, lat2, lon2, land)
        blocked = np.asarray(chart.legs_blocked(lat, lon, lat2, lon2))
        wrong_land += int((sure & (touches != blocked)).sum())
        unsure += int((~sure).sum())
        ends = rng.uniform(-85.0, 85.0, (2, count)), rng.uniform(-180.0, 180.0, (2, count))
        near = np.abs(ends[0].sum(axis=0)) > 1.0  # Vincenty fails near antipodes
        a, b, c, d = (x[near] for x in (ends[0][0], ends[1][0], ends[0][1], ends[1][1]))
        gap = np.abs(distance(a, b, c, d) - vincenty(a, b, c, d))
        worst_length = max(worst_length, float(gap.max(initial=0.0)))
        for k in np.flatnonzero(~blocked)[: max(1, count // 2000)]:
            error = _time_error(rng, (lat[k], lon[k], lat2[k], lon2[k]))
            sailed += 1
            disagree += int(np.isnan(error))
            worst_time = max(worst_time, 0.0 if np.isnan(error) else error)
    print(
        f"{chosen.count} legs, seed {chosen.seed}: land wrong {wrong_land} (within 3 m of a shore, "
        f"not counted: {unsure}); length off by {worst_length:.2e} m; {sailed} sailed, time "
        f"off by at most {worst_time:.2e} (relative), {disagree} disagree on whether they can be; "
        f"{time.process_time() - begin:.0f} s CPU"
    )
    # a ship that almost stops may be stopped by one of the two
    stalled = disagree > sailed // 200
    return int(wrong_land > 0 or worst_length > 1e-3 or worst_time > 1e-4 or stalled)


def _time_error(rng: np.random.Generator, ends: tuple[float, ...]) -> float:
    """Return the relative difference of both referees; NaN if only one of them can sail."""
    p, q = rng.uniform(-2.0, 2.0, 2), rng.uniform(-1.5, 1.5, 4)
    speed = rng.uniform(2.0, 8.0)

    def current(t, lat, lon):
        swing = np.sin(2.0 * np.pi * np.asarray(t) / 44712.0)
        u = p[0] * swing + q[0] * np.sin(5.0 * lat) + q[1] * np.cos(4.0 * lon)
        v = p[1] * swing + q[2] * np.cos(3.0 * lat) + q[3] * np.sin(6.0 * lon)
        return u, v

    sea = Sea.from_functions(
        {EAST: lambda t, y, x: current(t, y, x)[0], NORTH: lambda t, y, x: current(t, y, x)[1]}
    )
    depart = float(np.round(rng.uniform(0.0, 1e6)))
    ship = Ship.simple(speed_kn=speed / KNOT, draught_m=5.0)
    track = [(ends[0], ends[1]), (ends[2], ends[3])]
    route = evaluate(track, ship=ship, sea=sea, depart=depart, strict=False)
    own, fine = (
        sailing_time(
            ends[::2], ends[1::2], speed=speed, current=current, depart=depart, steps=steps
        )
        for steps in (400, 1600)
    )
    if np.isnan(own) != np.isnan(fine) or abs(own - fine) > 1e-5 * own:
        return 0.0  # almost no way over ground: the plain referee is not certain itself
    own = fine
    theirs = route.time_h * 3600.0
    if np.isnan(own) != np.isnan(theirs):
        return np.nan
    return 0.0 if np.isnan(own) else abs(theirs - own) / own


if __name__ == "__main__":
    sys.exit(main())
