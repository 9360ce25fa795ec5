"""Certified lower bounds: below every known optimum and near it; the check itself, repeated."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest
import xarray as xr

from thalweg.chart import Chart
from thalweg.core.geodesy import direct, distance
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.sea import Sea
from thalweg.search.certificate import barrier_domain, barrier_raster, time_certificate
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import ShipInBarrier, metres_per_degree
from thalweg.search.certificate.time_certificate import BarrierSearch, TimeCertificate
from thalweg.ship import PerformanceTable, Ship, TableError, TablePart

EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"
CURRENTS = (codes.CURRENT_EAST, codes.CURRENT_NORTH)
START, GOAL = (10.0, 20.0), (10.5, 21.5)
SPEED = 5.0


def ship_of_one_speed(speed: float, limits: Limits | None = None) -> ShipInBarrier:
    part = TablePart((), (), np.array([speed], np.float32))
    table = PerformanceTable((part,), np.array([speed]), "", TableError(0.0, 0.0, 0.0))
    return ShipInBarrier(table.kernel_arrays(), 0, (limits or Limits()).array, speed)


def sea_of(east, north, time_step: float = 0.0) -> Sea:
    return Sea.from_functions({EAST: east, NORTH: north}, time_step=time_step)


def bound(
    sea, known, *, chart=None, ship=None, ends=(START, GOAL), cells=120, meshes=1, kept_out=()
) -> TimeCertificate:
    ship = ship or ship_of_one_speed(SPEED)
    channels = CURRENTS if EAST in sea.variables else ()
    stretch = StretchToBound(
        sea, chart, ship, channels, *ends, depart=1e9, known=known, kept_out=kept_out
    )
    return on_meshes(stretch, cells, meshes)


def on_meshes(stretch: StretchToBound, cells: int = 120, meshes: int = 1) -> TimeCertificate:
    """Return the best bound of a number of meshes, whatever time they take."""
    search = BarrierSearch(stretch, BarrierDomain.around(stretch, cells), cells, 3e-4)
    found = [one for one in (search.refine() for _ in range(meshes)) if one is not None]
    return max(found, key=lambda one: one.value)


def test_a_passage_counts_the_sea_until_the_last_departure_has_arrived():
    channels = (codes.BED_DEPTH, *CURRENTS)
    stretch = StretchToBound(
        Sea.calm(), None, ship_of_one_speed(SPEED), channels, START, GOAL, depart=100.0, known=30.0
    )
    assert stretch.period == (100.0, 130.0)
    assert dataclasses.replace(stretch, latest=150.0).period == (100.0, 180.0)
    assert dataclasses.replace(stretch, latest=50.0).period == (100.0, 130.0)
    assert stretch.currents == CURRENTS
    assert dataclasses.replace(stretch, channels=(codes.BED_DEPTH,)).currents == ()


@pytest.mark.slow
def test_in_still_water_the_bound_is_the_geodesic_to_a_per_cent_and_a_half():
    best = float(distance(*START, *GOAL)) / SPEED
    found = bound(Sea.calm(), 1.002 * best, meshes=2)
    assert 0.985 * best < found.value <= best


@pytest.mark.slow
@pytest.mark.parametrize("east, north", [(2.0, 0.0), (-1.5, 1.0), (0.0, -3.0)])
def test_in_a_uniform_current_the_bound_is_that_of_the_current_triangle(east, north):
    length = float(distance(*START, *GOAL))
    lat, lon = (np.array([a, b]) for a, b in zip(START, GOAL))
    course = math.atan2(math.radians(lon[1] - lon[0]) * math.cos(math.radians(lat.mean())),
                        math.radians(lat[1] - lat[0]))  # fmt: skip
    along = east * math.sin(course) + north * math.cos(course)
    across = east * math.cos(course) - north * math.sin(course)
    best = length / (along + math.sqrt(SPEED**2 - across**2))
    sea = sea_of(lambda t, y, x: east + 0 * x, lambda t, y, x: north + 0 * x)
    found = bound(sea, 1.003 * best)
    assert 0.97 * best < found.value <= 1.001 * best  # the course is that of a plane


def test_a_jet_beyond_the_ellipse_of_the_ships_speed_is_in_the_bound():
    """Once no faster than straight on: the region was that of ships that never meet the jet."""
    ends, speed, jet, edge = ((0.0, 0.0), (0.0, 10.0)), 2.0, 2.0, 1.61
    sea = sea_of(lambda t, y, x: np.where(np.abs(y - 1.8) < 0.2, jet, 0.0) + 0 * x,
                 lambda t, y, x: 0 * x)  # fmt: skip
    straight = float(distance(*ends[0], *ends[1]))
    by_jet = 2.0 * float(distance(0.0, 0.0, edge, 0.0)) / speed + straight / (speed + jet)
    stretch = StretchToBound(
        sea, None, ship_of_one_speed(speed), CURRENTS, *ends, depart=1e9, known=straight / speed
    )
    domain = BarrierDomain.around(stretch, 100)
    assert domain.fastest == pytest.approx(speed + jet)
    assert time_certificate.certify_time(stretch, seconds=1.0).value < by_jet < stretch.known


def currents_to_the_east(lat, lon, east):
    names = {"uo": "eastward_sea_water_velocity", "vo": "northward_sea_water_velocity"}
    return xr.Dataset(
        {
            name: (("lat", "lon"), east * (name == "uo"), {"standard_name": names[name]})
            for name in names
        },
        coords={
            "lat": ("lat", lat, {"units": "degrees_north"}),
            "lon": ("lon", lon, {"units": "degrees_east"}),
        },
    )


def passage_beside_a_jet(*data) -> StretchToBound:
    sea, ends = Sea.open(*data), ((0.0, 0.0), (0.0, 2.0))
    return StretchToBound(
        sea, None, ship_of_one_speed(5.0), CURRENTS, *ends, depart=1e9, known=44_550.0
    )


def passage_beside_a_jet_on_one_line() -> StretchToBound:
    lat, lon = np.arange(-50, 51) * 0.05, np.arange(-40, 81) * 0.05
    east = np.zeros((lat.size, lon.size))
    east[57] = 9.0  # 0.35 degrees off
    return passage_beside_a_jet(currents_to_the_east(lat, lon, east))


@pytest.mark.parametrize("rows", [0.01, 0.013])
def test_a_jet_in_the_finer_of_two_files_counts(rows):
    """The finer file had rows closer than columns: its lines were not used, its jet not seen."""
    lat, lon = 0.35 + rows * np.arange(-5, 6), np.arange(5, 36) * 0.05
    east = np.zeros((lat.size, lon.size))
    east[5] = 9.0
    wide = np.arange(-20, 21) * 0.25, np.arange(-16, 33) * 0.25
    calm = currents_to_the_east(*wide, np.zeros((wide[0].size, wide[1].size)))
    stretch = passage_beside_a_jet(currents_to_the_east(lat, lon, east), calm)
    by_jet = 2.0 * float(distance(0.0, 0.0, 0.35, 0.25)) / 5.0
    by_jet += float(distance(0.35, 0.25, 0.35, 1.75)) / 14.0
    found = time_certificate.certify_time(stretch, seconds=10.0)
    assert found.sampling == ""
    assert 0.9 * by_jet < found.value < by_jet


def test_lines_that_are_left_out_count_in_the_greatest_speed(monkeypatch):
    """The jet is on one line of the data, between those of the raster."""
    monkeypatch.setattr(barrier_raster, "_MOST_CELLS", 1200)
    stretch = passage_beside_a_jet_on_one_line()
    domain = BarrierDomain.around(stretch, 60)
    assert domain.fastest >= 14.0 and domain.sampling == ""


def test_data_that_decide_on_the_cells_are_not_read_again_for_finer_ones(monkeypatch):
    monkeypatch.setattr(barrier_raster, "_MOST_CELLS", 1200)
    stretch, frozen = passage_beside_a_jet_on_one_line(), []

    def count(request):
        frozen.append(request.cells)
        return barrier_raster.freeze_barrier_raster(request)

    monkeypatch.setattr(barrier_domain, "freeze_barrier_raster", count)
    domain = BarrierDomain.around(stretch, 60)
    before = len(frozen)  # of the greatest speed, which is kept, and of the domain
    found = time_certificate.certify_time(stretch, seconds=0.0)
    assert len(frozen) - before == 1
    assert found.sampling == ""
    assert found.value == pytest.approx(stretch.length / domain.fastest, rel=1e-6)


@pytest.mark.slow
def test_in_a_current_that_turns_with_the_tide_the_bound_follows_the_times():
    """A uniform current u(t): the ship arrives when the drift and V t together make the way."""
    period, strength = 12.42 * 3600.0, 2.5
    length = float(distance(0.0, 0.0, 0.0, 2.0))

    def drift(t):  # integral of strength * cos(2 pi t / period)
        return strength * period / (2 * np.pi) * np.sin(2 * np.pi * t / period)

    times = np.linspace(0.0, 2e5, 2_000_001)
    best = float(times[np.argmax(drift(times) + SPEED * times >= length)])
    sea = sea_of(
        lambda t, y, x: strength * np.cos(2 * np.pi * (t - 1e9) / period) + 0 * x,
        lambda t, y, x: 0 * x,
        time_step=1800.0,
    )
    found = bound(sea, 1.003 * best, ends=((0.0, 0.0), (0.0, 2.0)))
    assert 0.95 * best < found.value <= 1.0005 * best


def least_time_by_jet(lat, east, wide) -> float:
    """Return the least time [s] along the equator, by way of the strongest of eastward currents.

    The currents (n,) change linearly between latitudes. A ship that rides the strongest one has the
    constant k = 1 / (V + u), and its slowness northward q satisfies V hypot(k, q) + u k = 1.
    """
    y = np.linspace(0.0, float(lat[np.argmax(east)]), 200_001)
    north, across = metres_per_degree(y)
    u = np.interp(y, lat, east)
    k = across[-1] / (u[-1] + SPEED) / across  # the slowness in degrees is the same everywhere
    q = np.sqrt(np.maximum(((1.0 - u * k) / SPEED) ** 2 - k**2, 0.0)) * north
    return float(across[0] * k[0] * wide + 2.0 * np.trapezoid(q, y))


@pytest.mark.slow
def test_a_jet_beside_the_way_is_bounded_from_below():
    """A jet of 4.5 m/s, 1.8 km half-width, 11.1 km off: 9.706 h is the optimum, 8.3 h all jet.

    The optimum is a little later in the sampled sea, whose jet is weaker between the samples.
    """
    wide = math.degrees(300e3 / 6378137.0)
    sea = sea_of(
        lambda t, y, x: 4.5 * np.exp(-(((y * 110574.0 - 11100.0) / 1800.0) ** 2)) + 0 * x,
        lambda t, y, x: 0 * x,
    )
    ship, known = ship_of_one_speed(SPEED), 9.9 * 3600.0
    stretch = StretchToBound(
        sea, None, ship, CURRENTS, (0.0, 0.0), (0.0, wide), depart=1e9, known=known
    )
    raster = BarrierDomain.around(stretch, 400).raster
    lat = raster.corner[0] + raster.corner[1] * np.arange(raster.values.shape[1])
    best = least_time_by_jet(lat, raster.values[0, :, 0, raster.channel_index[0]], wide)
    found = on_meshes(stretch, 400)
    assert best < known
    assert 0.98 * best < found.value <= best


def test_a_jet_outside_of_what_slow_water_lets_a_ship_reach_is_bounded():
    """The ship needs 15 h beside the jet and 9.77 h along it: no bound was once the answer.

    A domain as small as the greatest speed in it suggests left the jet out.
    """
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, y, x: 3 * np.exp(-(((y - 0.1) / 0.02) ** 2)),
            "northward_sea_water_velocity": lambda t, y, x: 0.0 * y,
        },
        time_step=0.0,
    )
    known = 9.7685 * 3600.0
    stretch = StretchToBound(
        sea, None, ship_of_one_speed(8.0 * 1852.0 / 3600.0), CURRENTS, (0.0, 0.0), (0.0, 2.0),
        depart=1e9, known=known,
    )  # fmt: skip
    assert BarrierDomain.around(stretch, 400).fastest > 7.0  # 4.12 m/s and nearly 3 m/s
    found = time_certificate.certify_time(stretch, seconds=2.0)
    assert 0.97 * known < found.value < known
    assert "minutes" not in found.sampling  # the sea never changes


@pytest.mark.slow
def test_land_between_lengthens_the_bound():
    wall = {
        "type": "Polygon",
        "coordinates": [[[20.7, 9.0], [20.8, 9.0], [20.8, 10.6], [20.7, 10.6], [20.7, 9.0]]],
    }
    chart = Chart.from_geojson(wall)
    ends = (10.0, 20.0), (10.0, 21.5)
    corner = [(10.6, 20.7), (10.6, 20.8)]
    legs = [ends[0], *corner, ends[1]]
    best = sum(float(distance(*a, *b)) for a, b in itertools.pairwise(legs)) / SPEED
    straight = float(distance(*ends[0], *ends[1])) / SPEED
    found = bound(Sea.calm(), 1.002 * best, chart=chart, ends=ends)
    assert 1.1 * straight < 0.96 * best < found.value <= best


@pytest.mark.slow
def test_a_limit_of_waves_closes_water_to_the_bound_as_to_the_ship():
    """High waves all over a strip of the way: a ship with a limit goes round, as by land."""
    names = "sea_surface_wave_significant_height"
    sea = Sea.from_functions(
        {names: lambda t, y, x: np.where((abs(x - 20.75) < 0.08) & (y < 10.6), 9.0, 1.0)},
        time_step=0,
    )
    ends = (10.0, 20.0), (10.0, 21.5)
    straight = float(distance(*ends[0], *ends[1])) / SPEED
    limited = ship_of_one_speed(SPEED, Limits(wave_height=5.0))
    passages = [
        StretchToBound(sea, None, ship, (codes.WAVE_HEIGHT_CHANNEL,), *ends, 1e9, 1.4 * straight)
        for ship in (limited, ship_of_one_speed(SPEED))
    ]
    closed, free = (on_meshes(one) for one in passages)
    assert free.value <= straight < 1.1 * straight < closed.value


@pytest.mark.parametrize(("rate", "most"), [(1e-4, 260), (1e-3, 100), (0.1, 0)])
def test_the_first_mesh_fits_into_the_time_for_it(monkeypatch, rate, most):
    sizes = []

    def refine(search):
        sizes.append(max(search.domain.raster.values.shape[1:3]))
        search.expected_seconds = math.inf

    monkeypatch.setattr(time_certificate, "seconds_a_cell", lambda stretch, domain: rate)
    monkeypatch.setattr(BarrierSearch, "refine", refine)
    ship = Ship.load("handysize-bulker").tabulate()
    top = float(ship.largest(0))
    limits = ShipInBarrier(ship.kernel_arrays(), 0, Limits().array, top)
    channels = (codes.WIND_EAST, codes.WIND_NORTH, codes.WAVE_HEIGHT_CHANNEL)
    best = float(distance(*START, *GOAL)) / top
    calm = StretchToBound(Sea.calm(), None, limits, channels, START, GOAL, 1e9, 1.01 * best)
    found = time_certificate.certify_time(calm, seconds=20.0)
    assert (0 < sizes[0] <= most) if most else not sizes
    assert 0.99 * best < found.value <= best


@pytest.mark.slow
def test_no_ship_crosses_the_barrier_backwards_in_wind():
    """The check, repeated: at random points, times from the barrier, headings and the ship's own
    table, the barrier never rises faster than time.
    """
    ship = Ship.load("handysize-bulker")
    table, setting = ship.tabulate().before_closing(), len(ship.speeds) - 1
    depart = 1e9
    sea = Sea.from_functions(
        {
            "eastward_wind": lambda t, y, x: 12.0 * np.sin(x + y / 2.0 + (t - depart) / 20_000.0),
            "northward_wind": lambda t, y, x: 14.0 * np.cos(x / 2.0 - y),
        },
        time_step=10_800.0,
    )
    ends = (46.0, -35.0), (49.0, -20.0)
    top = float(ship.top_speed(setting))
    length = float(distance(*ends[0], *ends[1]))
    names = {codes.WIND_EAST: "eastward_wind", codes.WIND_NORTH: "northward_wind"}
    barrier = ShipInBarrier(table.kernel_arrays(), setting, Limits().array, top)
    stretch = StretchToBound(sea, None, barrier, tuple(names), *ends, depart, 1.15 * length / top)
    found = on_meshes(stretch, cells=80)
    rate = _rates_at_random_points(found, ship=table, setting=setting, count=20_000)
    assert found.value > 0.99 * length / top
    assert np.nanmax(rate) <= 1.0 + 1e-6
    assert np.nanpercentile(rate, 99) > 0.9  # the barrier is steep where it matters


def _rates_at_random_points(found: TimeCertificate, *, ship, setting: int, count: int):
    """Return rates of the barrier along motions, from the raster by NumPy alone."""
    rng = np.random.default_rng(8)
    mesh, barrier, raster = found.mesh, found.barrier, found.mesh.world.raster
    phi, centre = barrier.phi, barrier.centre
    task, corners = found.task, np.stack([phi[:-1, :-1], phi[:-1, 1:], phi[1:, :-1], phi[1:, 1:]])
    # cells that a faster ship may touch, not before the barrier's time there
    early = corners.min(axis=0) + task.other < task.known
    cells = np.argwhere(task.band & early & (corners.max(axis=0) >= task.own))
    j, i = cells[rng.integers(len(cells), size=count)].T
    y, x = rng.uniform(size=(2, count))
    a, b, c, d, m = phi[j, i], phi[j, i + 1], phi[j + 1, i], phi[j + 1, i + 1], centre[j, i]
    u, v = x - 0.5, y - 0.5
    flat = np.abs(v) >= np.abs(u)
    low, high = np.where(v < 0, a, c), np.where(v < 0, b, d)
    left, right = np.where(u < 0, a, b), np.where(u < 0, c, d)
    turn_v, turn_u = np.where(v < 0, -1, 1), np.where(u < 0, -1, 1)
    slope_x = np.where(flat, high - low, 2 * turn_u * (0.5 * (left + right) - m))
    slope_y = np.where(flat, 2 * turn_v * (0.5 * (low + high) - m), right - left)
    value = m + slope_x * u + slope_y * v
    lat = mesh.lat[j] + y * (mesh.lat[1] - mesh.lat[0])
    north_m, east_m = direct(lat, 0.0 * lat, 0.0, 1.0), direct(lat, 0.0 * lat, math.pi / 2, 1.0)
    p_north = slope_y / (mesh.lat[1] - mesh.lat[0]) * (north_m[0] - lat)
    p_east = slope_x / (mesh.lon[1] - mesh.lon[0]) * east_m[1]
    sample = {}
    row, column = (j + y) / mesh.world.refinement, (i + x) / mesh.world.refinement
    for channel in raster.channels:
        sample[channel] = _interpolated(raster, raster.channel_index[channel], value, row, column)
    wind_east, wind_north = sample[codes.WIND_EAST], sample[codes.WIND_NORTH]
    heading = rng.uniform(0.0, 2 * np.pi, count)
    steep = rng.uniform(size=count) < 0.5  # half of the ships steer up the barrier
    heading = np.where(steep, np.arctan2(p_east, p_north) + rng.normal(0, 0.3, count), heading)
    comes_from = np.arctan2(-wind_east, -wind_north)
    angle = np.abs((comes_from - heading + np.pi) % (2 * np.pi) - np.pi)
    where = {"wind_speed": np.hypot(wind_east, wind_north), "wind_angle": angle}
    speed = ship.lookup(where, np.full(count, setting))
    return speed * (p_east * np.sin(heading) + p_north * np.cos(heading))


def _interpolated(raster, k, time, row, column):
    step = np.clip(np.searchsorted(raster.times, time, side="right") - 1, 0, len(raster.times) - 2)
    f = np.clip((time - raster.times[step]) / np.diff(raster.times)[step], 0.0, 1.0)
    j, i = row.astype(int), column.astype(int)
    y, x, values = row - j, column - i, raster.values[..., k].astype(float)

    def plane(t):
        south = values[t, j, i] * (1 - x) + values[t, j, i + 1] * x
        return south * (1 - y) + y * (values[t, j + 1, i] * (1 - x) + values[t, j + 1, i + 1] * x)

    return plane(step) * (1 - f) + plane(step + 1) * f
