"""Land test of legs, compared with prepared geometries of shapely in the same run.

Run ``python benchmarks/land_test.py [--resolution i] [--legs 100000] [--check 100000]``.

shapely receives the land as one prepared geometry and the legs as lines: geodesics densified every
20 km for the timing (their construction is not timed), every 2 km for the comparison. The edges of
the coast are straight in longitude and latitude in both. Where the results differ, the leg is
densified every 100 m and tested with shapely again: a geodesic densified every 2 km deviates by 8
cm and more from the true one, that of Thalweg by 3 mm (legs above 159 km that pass the coast nearer
than the accuracy of the kernel are divided into segments of the exact geodesic).
"""

from __future__ import annotations

import argparse
import time

import numpy as np
import shapely

from thalweg.chart import Chart
from thalweg.core import geodesy


def legs_of(rng, count, window, low, high):
    """Return random legs that start in a window: lengths and courses uniform."""
    south, north, west, east = window
    lat = np.degrees(np.arcsin(rng.uniform(*np.sin(np.radians([south, north])), count)))
    lon = rng.uniform(west, east, count)
    course, length = rng.uniform(0, 2 * np.pi, count), rng.uniform(low, high, count)
    lat2, lon2 = geodesy.direct(lat, lon, course, length)
    return lat, lon, lat2, lon2, course, length


def densified(legs, spacing):
    """Return the legs as shapely lines, geodesics cut every ``spacing`` metres."""
    lat, lon, lat2, lon2, course, length = legs
    pieces = np.ceil(length / spacing).astype(int)
    leg = np.repeat(np.arange(len(lat)), pieces + 1)
    number = np.arange(len(leg)) - np.repeat(np.cumsum(pieces + 1) - pieces - 1, pieces + 1)
    y, x = geodesy.direct(lat[leg], lon[leg], course[leg], number / pieces[leg] * length[leg])
    first, last = number == 0, number == pieces[leg]
    y[first], x[first], y[last], x[last] = lat, lon, lat2, lon2
    x = lon[leg] + (x - lon[leg] + 180.0) % 360.0 - 180.0
    return shapely.linestrings(x, y, indices=leg)


def median_time(function, repeats=5):
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return float(np.median(times))


def run(resolution, count, check):
    rng = np.random.default_rng(2)
    chart = Chart.gshhg(resolution)
    window = (25.0, 70.0, -45.0, 25.0)
    land = shapely.union_all(chart.coastline.polygons(-89.9, 89.9, -179.999, 179.999))
    parts = shapely.get_parts(land)
    print(f"GSHHG {resolution}: {len(parts)} polygons, {shapely.get_num_coordinates(land)} points")
    shapely.prepare(land)
    for name, low, high in (("20-60 km", 20e3, 60e3), ("500-2500 km", 500e3, 2500e3)):
        legs = legs_of(rng, count, window, low, high)
        ends = legs[:4]
        ours = chart.legs_blocked(*ends)
        seconds = median_time(lambda e=ends: chart.legs_blocked(*e))
        some = tuple(x[:5000] for x in legs)
        lines = densified(some, 20e3)
        peer = median_time(lambda li=lines: shapely.intersects(land, li), 3) / 5000
        each = seconds / count
        print(
            f"{name:>12}: {each * 1e6:7.3f} us per leg, shapely prepared {peer * 1e6:7.2f} us "
            f"(without making lines): {peer / each:5.0f} x; blocked {ours.mean():.0%}"
        )
        agree(chart, land, tuple(x[: check // 2] for x in legs), name)


def agree(chart, land, legs, name):
    ours = chart.legs_blocked(*legs[:4])
    theirs = np.empty(len(ours), bool)
    for k in range(0, len(ours), 2000):
        part = tuple(x[k : k + 2000] for x in legs)
        theirs[k : k + 2000] = shapely.intersects(land, densified(part, 2000.0))
    differ = np.flatnonzero(ours != theirs)
    settled = [k for k in differ if not settles(land, tuple(x[k : k + 1] for x in legs), ours[k])]
    print(
        f"{name:>12}: {len(ours)} legs, {len(differ)} differ from lines densified every 2 km, "
        f"{len(settled)} differ after densifying these every 100 m"
    )
    for k in settled[:5]:
        print("   ", [float(x[k]) for x in legs], "ours", bool(ours[k]))


def settles(land, leg, ours):
    return bool(shapely.intersects(land, densified(leg, 100.0))[0]) == ours


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--resolution", default="i")
    parser.add_argument("--legs", type=int, default=100_000)
    parser.add_argument("--check", type=int, default=100_000)
    options = parser.parse_args()
    run(options.resolution, options.legs, options.check)
