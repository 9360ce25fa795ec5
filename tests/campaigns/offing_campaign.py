"""Random voyages, each route checked against the polygons of GSHHG for water within its offing.

Run ``python tests/campaigns/offing_campaign.py --count 100 --seed 1``. The check uses shapely on
the rings of the coastline and none of the package's tests of legs: land within reach of every leg
is projected (azimuthal equidistant, about the middle of a piece of it) and its distance is
measured. ``--ports --network globe`` takes pairs of ports only and one network for all of them;
``--minutes`` is the limit of processor time, and ``--proof 0`` leaves out the bounds, which take
most of it. Pieces in the corridors of passages, in the discs of
the ends and on approaches or canals are not held against a route. The exit code is the number of
routes with breaches, at most 100.
"""

from __future__ import annotations

import argparse
import re
import sys
import time

import numpy as np
import shapely

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.ports import PORTS
from thalweg.core.errors import ThalwegError
from thalweg.core.geodesy import densify, distance

NM = 1852.0
PIECE = 2.0 * NM
TOLERANCE = 0.98  # legs are tested to 1 %, projections are true to 0.1 %
NEAR_END = 2.0  # discs reach so many offings from an end, where these are not larger


def land_tree(chart):
    """Return short edges of the coastline as shapely lines (lon, lat) in a tree."""
    rings = chart.coastline.rings
    last = np.zeros(len(rings.lat), bool)
    last[rings.start[1:] - 1] = True
    first = np.flatnonzero(~last[:-1])
    ends = np.stack(
        [rings.lon[first], rings.lat[first], rings.lon[first + 1], rings.lat[first + 1]]
    )
    lines = shapely.linestrings(np.moveaxis(ends.reshape(2, 2, -1), -1, 0))
    return shapely.STRtree(lines)


def project(points, lat0, lon0):
    """Project (lon, lat) [deg] near a place to metres on an osculating sphere."""
    lon = np.radians((points[:, 0] - lon0 + 180.0) % 360.0 - 180.0)
    lat, mid = np.radians(points[:, 1]), np.radians(lat0)
    square = 1.0 - 0.00669438 * np.sin(mid) ** 2
    meridian = 6378137.0 * (1.0 - 0.00669438) / square**1.5
    parallel = 6378137.0 / np.sqrt(square)
    x = parallel * np.cos(lat) * np.sin(lon)
    y = meridian * (lat - mid) + 0.5 * parallel * np.sin(mid) * np.cos(mid) * lon**2
    return np.stack([x, y], -1)


def nearest_land(tree, a, b, reach):
    """Return the distance [m] of a short piece from land, at most ``reach``."""
    lat0, lon0 = 0.5 * (a[0] + b[0]), a[1] + 0.5 * ((b[1] - a[1] + 180.0) % 360.0 - 180.0)
    north = 1.2 * (reach + PIECE) / 111e3
    east = min(north / max(np.cos(np.radians(lat0)), 0.05), 179.0)
    lon0 = (lon0 + 180.0) % 360.0 - 180.0
    box = shapely.box(lon0 - east, lat0 - north, lon0 + east, lat0 + north)
    found = tree.geometries[tree.query(box)]
    if not len(found):
        return reach
    lines = shapely.transform(found, lambda points: project(points, lat0, lon0))
    piece = shapely.LineString(project(np.array([[a[1], a[0]], [b[1], b[0]]]), lat0, lon0))
    return min(reach, float(shapely.distance(lines, piece).min()))


def in_corridor(chart, lat, lon, offing):
    """Return which positions lie within the offing of the line of an open passage."""
    inside = np.zeros(len(lat), bool)
    for passage in chart.passages:
        y, x, _ = densify(*passage.positions, 0.5 * NM)
        if passage.half_width > 1.3 * offing:
            continue
        close = np.flatnonzero(np.abs(lat - y.mean()) < np.ptp(y) + 0.2)
        for k in close:
            if not inside[k]:
                inside[k] = distance(lat[k], lon[k], y, x).min() < 2.1 * offing
    return inside


def notes(found):
    """Return the notes of a plan as one text."""
    return " ".join(found.notes)


def kept_offing(found):
    """Return the offing [m] that a plan says it keeps."""
    stated = re.search(r"[Kk]eeps ([\d.]+) nm", notes(found))
    return float(stated[1]) * NM if stated else 0.0


def breaches(found, tree, wanted):
    """Return (distance, lat, lon) of pieces of the best route nearer to land than its offing."""
    chart, track = found.plot_context.chart, found.best.track
    offing = kept_offing(found)
    if offing <= 0.0:
        return []
    legs = np.stack([track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:]])
    fixed = np.asarray(chart.canal_of_legs(*legs)) >= 0
    fixed |= np.asarray(found.best.legs["leg_kind"]) != 0  # canals and approaches
    lat, lon, leg = densify(track.lat, track.lon, PIECE)
    ends = [(track.lat[0], track.lon[0]), (track.lat[-1], track.lon[-1]), *wanted]
    spared = np.zeros(len(lat), bool)
    for disc in (*chart.offing.discs, *chart.offing.canal_discs):
        reach = (
            disc.radius + 2.0 * (offing - disc.least) + PIECE
        )  # it grows by half a metre a metre
        spared |= distance(lat, lon, disc.lat, disc.lon) < reach
    for canal in chart.canals:
        ends += list(canal.ends)
    for place in ends:
        spared |= distance(lat, lon, *place) < NEAR_END * offing + PIECE
    spared |= in_corridor(chart, lat, lon, offing)
    bad = []
    for k in np.flatnonzero(~(spared[:-1] | spared[1:] | fixed[leg])):
        away = nearest_land(tree, (lat[k], lon[k]), (lat[k + 1], lon[k + 1]), 1.1 * offing)
        if away < TOLERANCE * offing:
            bad.append((away / NM, float(lat[k]), float(lon[k])))
    return bad


def approach_ends(chart, place):
    """Return the line of the approach of a port, every position of which is spared."""
    if not isinstance(place, str) or chart.approaches is None:
        return []
    from thalweg.planning.request.voyage_endpoints import resolve_endpoint

    end = resolve_endpoint(place, chart, "start")
    return list(end.approach.line) if end.approach else [(end.lat, end.lon)]


def random_place(rng, chart, codes):
    """Return a port, or a position on water between 60 S and 68 N."""
    if rng.random() < 0.5:
        return str(rng.choice(codes))
    while True:
        lat = float(np.degrees(np.arcsin(rng.uniform(-0.85, 0.92))))
        lon = float(rng.uniform(-180.0, 180.0))
        if chart.is_navigable(lat, lon) and chart.coastline.shore_distance(lat, lon) > 5e3:
            return round(lat, 3), round(lon, 3)


def random_pairs(rng, chart, codes, given):
    """Yield pairs of places at a great-circle distance between the limits given."""
    found = 0
    while found < given.count:
        if given.ports:
            pair = tuple(str(code) for code in rng.choice(codes, 2, replace=False))
            berths = [PORT_APPROACHES.of(PORTS.lookup(code)).sea_end for code in pair]
        else:
            pair = random_place(rng, chart, codes), random_place(rng, chart, codes)
            berths = [
                PORT_APPROACHES.of(PORTS.lookup(end)).sea_end if isinstance(end, str) else end
                for end in pair
            ]
        if given.shortest * NM <= float(distance(*berths[0], *berths[1])) <= given.longest * NM:
            found += 1
            yield pair


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--ports", action="store_true", help="from port to port only")
    parser.add_argument("--network", default="auto", help="globe: one network for all voyages")
    parser.add_argument("--proof", type=float, help="seconds for the bound of each plan; 0: none")
    parser.add_argument("--shortest", type=float, default=0.0, help="skip nearer pairs [nm]")
    parser.add_argument("--longest", type=float, default=1e9, help="skip pairs farther apart [nm]")
    given = parser.parse_args()
    chart = Chart.gshhg("i")
    tree, rng = land_tree(chart), np.random.default_rng(given.seed)
    codes = sorted({a.port.locode for a in chart.approaches.all if a.port.locode})
    ship = Ship.simple(speed_kn=14.0, draught_m=9.0, length_m=180.0)
    options = {} if given.proof is None else {"proof": given.proof}
    wrong = done = relaxed = 0
    for number, (start, goal) in enumerate(random_pairs(rng, chart, codes, given)):
        if time.process_time() > 60.0 * given.minutes:
            break
        try:
            voyage = Voyage(start=start, goal=goal, depart="2026-01-01", objective="distance")
            found = plan(
                voyage, ship=ship, sea=Sea.calm(), chart=chart, network=given.network, **options
            )
        except ThalwegError as error:
            print(
                f"{number} {start} {goal}: {type(error).__name__}: {str(error)[:100]}", flush=True
            )
            continue
        done += 1
        relaxed += kept_offing(found) < 2.0 * NM - 1.0
        spared = approach_ends(chart, start) + approach_ends(chart, goal)
        bad = breaches(found, tree, spared)
        late = found.lower_bound > found.objective_value * (1.0 + 1e-9)
        wrong += bool(bad) or late or not found.best.feasible
        state = "ok" if not bad else f"BREACH {bad[:3]}"
        state += " BOUND ABOVE" if late else ""
        state += "" if found.best.feasible else f" NOT FEASIBLE {found.best.violations[0]}"
        print(f"{number} {start} {goal}: {found.best.distance_nm:.0f} nm {state}", flush=True)
    print(f"{time.process_time() / 60.0:.1f} minutes of processor time")
    print(f"{done} planned, {relaxed} at a smaller offing, {wrong} with faults")
    return min(wrong, 100)


if __name__ == "__main__":
    sys.exit(main())
