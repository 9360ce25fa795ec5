"""Certificates of random made worlds against routes of a plain search: none may be above one.

``python -m tests.campaigns.certificate_campaign --count 200 --seed 1``; with ``--first 60`` the
worlds before number 60 are left out.

The sea is a grid of currents, linear in time and space, with a jet, vortices that move and a tide;
islands lie beside the best route. The truth is the best of a fan of extremals (Zermelo), integrated
here without any part of the package: each is a track that a ship can sail.
"""

from __future__ import annotations

import math
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
import xarray as xr

from tests.campaigns.plain_referee import arguments
from thalweg import Chart, Sea
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import ShipInBarrier
from thalweg.search.certificate.time_certificate import BarrierSearch
from thalweg.ship import PerformanceTable, TableError, TablePart

DIVISIONS = 2, 4, 3, 6, 5  # of the cells of the data: five resolutions for each world
_DEPART = 1.6e9
_STEP, _TIMES = 0.08, 6  # of the grid [deg] and number of times, three hours apart
_FAN, _FANS, _PARTS = 160, 4, 700
_A, _E2 = 6378137.0, 6.69437999014e-3


@dataclass(frozen=True)
class World:
    """A grid of currents with a ship of one speed and two ends."""

    axis: np.ndarray
    times: np.ndarray
    flow: np.ndarray  # (time, lat, lon, 2)
    speed: float
    start: np.ndarray
    goal: np.ndarray

    @classmethod
    def random(cls, rng: np.random.Generator) -> World:
        axis = np.arange(-2.0, 2.0 + 0.5 * _STEP, _STEP)
        times = 10800.0 * np.arange(_TIMES)
        t, y, x = np.meshgrid(times, axis, axis, indexing="ij")
        speed = float(rng.uniform(3.0, 8.0))
        flow = np.zeros((*t.shape, 2))
        for _ in range(int(rng.integers(1, 4))):  # vortices that move
            at, drift = rng.uniform(-0.9, 0.9, 2), rng.uniform(-1e-5, 1e-5, 2)
            size, turn = rng.uniform(0.15, 0.6), rng.uniform(-0.5, 0.5) * speed
            v, u = y - at[0] - drift[0] * t, x - at[1] - drift[1] * t
            shape = turn * np.exp(0.5 - (v**2 + u**2) / size**2) / size
            flow += np.stack([-v * shape, u * shape], -1)
        if rng.uniform() < 0.6:  # a jet
            off, wide = rng.uniform(-0.5, 0.5), rng.uniform(0.08, 0.3)
            flow[..., 0] += rng.uniform(-0.5, 0.5) * speed * np.exp(-(((y - off) / wide) ** 2))
        swing = rng.uniform(-0.15, 0.15, 2) * speed  # a tide
        flow += swing * np.cos(2.0 * np.pi * t / 44712.0)[..., None]
        largest = np.hypot(flow[..., 0], flow[..., 1]).max()
        flow *= min(1.0, 0.85 * speed / largest)
        y0, y1 = rng.uniform(-0.5, 0.5, 2)
        start, goal = np.array([y0, -rng.uniform(0.3, 0.7)]), np.array([y1, rng.uniform(0.3, 0.7)])
        return cls(axis, times, flow.astype(np.float32), speed, start, goal)

    def current(self, t: np.ndarray, lat: np.ndarray, lon: np.ndarray) -> np.ndarray:
        """Return the currents (n, 2) [m/s], linear in time and space."""
        k = np.clip(t / 10800.0, 0.0, len(self.times) - 1.0 - 1e-9)
        j = np.clip((lat - self.axis[0]) / _STEP, 0.0, len(self.axis) - 1.001)
        i = np.clip((lon - self.axis[0]) / _STEP, 0.0, len(self.axis) - 1.001)
        a, b, c = (one.astype(int) for one in (k, j, i))
        size = self.flow.shape[1:3]
        at = (a * size[0] + b) * size[1] + c
        corner = np.array([0, 1, size[1], size[1] + 1])
        corner = np.concatenate([corner, corner + size[0] * size[1]])
        cells = self.flow.reshape(-1, 2)[at[:, None] + corner].reshape(-1, 2, 2, 2, 2)
        cells = cells[:, 0] + (k - a)[:, None, None, None] * (cells[:, 1] - cells[:, 0])
        rows = cells[:, 0] + (j - b)[:, None, None] * (cells[:, 1] - cells[:, 0])
        total: np.ndarray = rows[:, 0] + (i - c)[:, None] * (rows[:, 1] - rows[:, 0])
        return total

    def best_track(self) -> tuple[float, np.ndarray]:
        """Return the time [s] and positions (n, 2) [deg] of the best extremal, to the goal."""
        toward = np.arctan2(*(self.goal - self.start)[::-1])
        middle, width = toward, 2.4
        best, track = np.inf, np.empty((0, 2))
        for _ in range(_FANS):
            headings = middle + np.linspace(-0.5, 0.5, _FAN) * width
            seconds, tracks = self._sail(headings)
            at = int(np.argmin(seconds))
            if seconds[at] < best:
                best, track = float(seconds[at]), tracks[at]
            middle, width = headings[at], width * 6.0 / _FAN
        return best, track

    def _sail(self, heading: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
        """Sail extremals of first headings; return their times to the goal and their positions."""
        fastest = self.speed + np.hypot(*np.moveaxis(self.flow, -1, 0)).max()
        slowest = 2.0 * self.speed - fastest
        length = _metres(self.start, self.goal)
        step = 2.2 * length / self.speed / _PARTS
        lat, lon = (np.full(len(heading), one) for one in self.start)
        heading, t = heading.copy(), np.zeros(len(heading))
        best, where = np.full(len(heading), np.inf), np.zeros(len(heading), int)
        passed = [np.stack([lat, lon], -1)]
        for part in range(_PARTS):
            k1 = self._rates(t, lat, lon, heading)
            half = 0.5 * step
            k2 = self._rates(
                t + half, lat + half * k1[0], lon + half * k1[1], heading + half * k1[2]
            )
            # the track is sailed with the rates of the middle; its heading may be any
            lat, lon, heading = lat + step * k2[0], lon + step * k2[1], heading + step * k2[2]
            t = t + step
            passed.append(np.stack([lat, lon], -1))
            rest = _metres(np.stack([lat, lon], -1), self.goal)
            total = t + rest / slowest
            better = total < best
            best[better], where[better] = total[better], part + 1
            if t[0] > best.min():
                break
        places = np.array(passed)
        tracks = [np.append(places[: n + 1, k], self.goal[None], 0) for k, n in enumerate(where)]
        return best * (1.0 + 2e-5), tracks  # the error of the integration, by halving the steps

    def _rates(self, t, lat, lon, heading):
        """Return rates of latitude and longitude [deg/s] and of the heading [rad/s]."""
        d, n = 0.5 * _STEP, len(lat)
        rows = np.concatenate([lat, lat + d, lat - d, lat, lat])
        columns = np.concatenate([lon, lon, lon, lon + d, lon - d])
        flows = self.current(np.tile(t, 5), rows, columns).reshape(5, n, 2)
        current, by_north, by_east = flows[0], flows[1] - flows[2], flows[3] - flows[4]
        by_north, by_east = by_north / (2.0 * d), by_east / (2.0 * d)
        east, north = np.sin(heading), np.cos(heading)
        north_m, east_m = _metres_per_degree(lat)
        by_north, by_east = by_north / north_m[:, None], by_east / east_m[:, None]
        # the covector (east, north) turns with -grad(c).p; heading is clockwise from north
        p_east = -(east * by_east[:, 0] + north * by_east[:, 1])
        p_north = -(east * by_north[:, 0] + north * by_north[:, 1])
        turn = p_east * north - p_north * east
        velocity_east = current[:, 0] + self.speed * east
        velocity_north = current[:, 1] + self.speed * north
        return velocity_north / north_m, velocity_east / east_m, turn

    def sea(self, folder: str) -> Sea:
        """Return the sea of a file with these currents."""
        stamps = (np.datetime64(int(_DEPART), "s") + self.times.astype("timedelta64[s]")).astype(
            "datetime64[ns]"
        )
        names = "eastward_sea_water_velocity", "northward_sea_water_velocity"
        data = {
            short: (("time", "latitude", "longitude"), self.flow[..., k], {"standard_name": name})
            for k, (short, name) in enumerate(zip(("uo", "vo"), names))
        }
        for row in data.values():
            row[2]["units"] = "m s-1"
        axes = {"time": stamps, "latitude": self.axis, "longitude": self.axis}
        file = Path(folder) / "sea.nc"
        xr.Dataset(data, coords=axes).to_netcdf(file)
        return Sea.open(file)


def _metres_per_degree(lat):
    w = np.sqrt(1.0 - _E2 * np.sin(np.radians(lat)) ** 2)
    north = np.radians(1.0) * _A * (1.0 - _E2) / w**3
    return north, np.radians(1.0) * _A * np.cos(np.radians(lat)) / w


def _metres(one, other):
    """Return an upper bound of the distance between positions near the equator [m]."""
    away = np.asarray(other) - np.asarray(one)
    return 111_320.0 * np.hypot(away[..., 0], away[..., 1])


def islands_beside(rng: np.random.Generator, world: World, track: np.ndarray) -> Chart | None:
    """Return a chart with round islands that the track does not touch."""
    line = shapely.LineString(track[:, ::-1])
    found = []
    for _ in range(int(rng.integers(0, 4))):
        disc = shapely.Point(*rng.uniform(-0.8, 0.8, 2)).buffer(rng.uniform(0.03, 0.2))
        if disc.distance(line) > 0.004:
            found.append(disc)
    if not found:
        return None
    return Chart.from_geojson(shapely.geometry.mapping(shapely.union_all(found)))


def certified(world: World, sea: Sea, chart: Chart | None, known: float) -> list[float]:
    """Return values of barriers at the goal [s], not cut off at the known time; 0 for none.

    The meshes of 4 and 6 divisions begin with what those of 2 and 3 found, as in plans.
    """
    part = TablePart((), (), np.array([world.speed], np.float32))
    table = PerformanceTable((part,), np.array([world.speed]), "", TableError(0.0, 0.0, 0.0))
    ship = ShipInBarrier(table.kernel_arrays(), 0, Limits().array, float(np.float32(world.speed)))
    stretch = StretchToBound(
        sea, chart, ship, (codes.CURRENT_EAST, codes.CURRENT_NORTH), tuple(world.start),
        tuple(world.goal), _DEPART, 1.01 * known,
    )  # fmt: skip
    domain = BarrierDomain.around(stretch, 1)
    assert domain is not None and domain.sampling == "", domain
    cells = stretch.length / domain.cell_height
    searches = [BarrierSearch(stretch, domain, math.floor(n * cells), 3e-4) for n in (2, 3, 5)]
    found = [searches[k].refine() for k in (0, 0, 1, 1, 2)]
    for number, one in zip(DIVISIONS, found):
        assert one is None or one.mesh is None or one.mesh.world.refinement == number
    return [0.0 if one is None else one.reached for one in found]


def main() -> int:
    """Run the campaign; return 1 if a certificate is above a track that can be sailed."""
    chosen = arguments(200)
    begin = time.process_time()
    worlds = violations = checked = missing = 0
    ratios: dict[int, list[float]] = {cells: [] for cells in DIVISIONS}
    for number in range(chosen.first, chosen.first + chosen.count):
        rng = np.random.default_rng([chosen.seed, number])
        world = World.random(rng)
        known, track = world.best_track()
        if not known < world.times[-1] or np.abs(track).max() > 1.2:
            continue
        worlds += 1
        with tempfile.TemporaryDirectory() as folder:
            sea = world.sea(folder)
            chart = islands_beside(rng, world, track)
            for cells, value in zip(DIVISIONS, certified(world, sea, chart, known)):
                checked += 1
                missing += value == 0.0
                ratios[cells].append(value / known)
                if value > known:
                    violations += 1
                    print(f"world {number}, {cells} divisions: {value:.1f} s above {known:.1f} s")
            latest = ", ".join(f"{found[-1]:.4f}" for found in ratios.values())
            print(f"world {number}: {latest}", flush=True)
    for cells, found in sorted(ratios.items()):
        share = np.percentile(found, [0, 10, 50, 90, 100])
        text = ", ".join(f"{one:.4f}" for one in share)
        print(f"cells divided by {cells}: bound over best track (0, 10, 50, 90, 100 %): {text}")
    print(
        f"{worlds} worlds, seed {chosen.seed}: {checked} certificates, {missing} not found, "
        f"{violations} violations; {time.process_time() - begin:.0f} s CPU"
    )
    return int(violations > 0)


if __name__ == "__main__":
    sys.exit(main())
