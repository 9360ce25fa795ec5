"""Bounds of fronts that know when the current is fair: against tracks and a linear programme."""

import math

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import linprog

from tests.worlds.plane import METRES_PER_LON, T0, Plane
from thalweg import Chart, Sea, Ship, Track, Voyage, evaluate, plan
from thalweg.core.limits import Limits
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH
from thalweg.planning.pareto.front_bound.fair_current_lines import greatest_rise, least_costs
from thalweg.planning.plan_front import certain_at
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import ShipInBarrier
from thalweg.search.certificate.fair_currents import heights_along, strongest_fair_currents
from thalweg.ship import PerformanceTable, TableError, TablePart

HOUR, TIDE = 3600.0, 44_714.0
SPEEDS = np.array([2.0, 4.0, 6.0])
COSTS = np.array([1.0, 5.0, 14.0])  # of a second
EASTWARD = {"standard_name": "eastward_sea_water_velocity", "units": "m s-1"}
NORTHWARD = {"standard_name": "northward_sea_water_velocity", "units": "m s-1"}


def gridded(times, lat, lon, east):
    """A file with a current to the east (times, rows, columns)."""
    return Sea.open(
        xr.Dataset(
            {
                "uo": (("time", "latitude", "longitude"), east, EASTWARD),
                "vo": (("time", "latitude", "longitude"), 0.0 * east, NORTHWARD),
            },
            coords={
                "time": (times * 1e9).astype("int64").astype("datetime64[ns]"),
                "latitude": ("latitude", lat, {"units": "degrees_north"}),
                "longitude": ("longitude", lon, {"units": "degrees_east"}),
            },
        )
    )


def flow_of(rng):
    """A random smooth current of up to some 2 m/s that changes over a tide."""
    a, b = rng.normal(0.0, 0.8, (2, 3)), rng.uniform(-1.0, 1.0, (2, 3))
    k, phase = rng.uniform(-1.5, 1.5, (2, 3, 2)), rng.uniform(0.0, 2 * math.pi, (2, 3))

    def part(n, t, x, y):
        turn = 2 * math.pi * (t / TIDE)
        waves = [
            a[n, i] * np.cos(turn + k[n, i, 0] * x + k[n, i, 1] * y + phase[n, i]) + 0.3 * b[n, i]
            for i in range(3)
        ]
        return sum(waves)

    return lambda t, x, y: (part(0, t, x, y), part(1, t, x, y))


def random_track(rng, flow, plane):
    """Sail random courses at random settings; return the end, the time and the cost."""
    x, y, t, cost, step = 0.0, 0.0, 0.0, 0.0, 120.0
    course = rng.uniform(-0.6, 0.6)
    for _ in range(int(rng.integers(4, 9))):
        setting, heading = int(rng.integers(0, 3)), course + rng.normal(0.0, 0.5)
        for _ in range(int(rng.integers(20, 60))):
            u, v = flow(t, x, y)
            x += step * (SPEEDS[setting] * math.cos(heading) + float(u)) / plane.unit
            y += step * (SPEEDS[setting] * math.sin(heading) + float(v)) / plane.unit
            t += step
            cost += step * COSTS[setting]
    return (x, y), t, cost


def bounds_of(sea, start, goal, known) -> tuple[FloatArray, float]:
    """Return the least cost of voyages of the known time, and how much of the way they may come."""
    table = PerformanceTable(
        (TablePart((), (), SPEEDS.astype(np.float32)),), SPEEDS, "", TableError(0.0, 0.0, 0.0)
    )
    ship = ShipInBarrier(table.kernel_arrays(), 2, Limits().array, float(SPEEDS[-1]))
    channels = (CURRENT_EAST, CURRENT_NORTH)
    stretch = StretchToBound(sea, None, ship, channels, start, goal, depart=T0, known=known)
    domain = BarrierDomain.around(stretch, 100)
    assert domain is not None
    rows, columns = (axis.size - 1 for axis in domain.axes)
    everywhere = [np.ones((rows, columns), bool)]
    fastest = float(SPEEDS[-1]) + domain.strongest_current
    costs, shares = [], []
    for height in heights_along(stretch, domain):
        steepest, currents = strongest_fair_currents(
            stretch, domain, fastest, height, everywhere, np.array([known])
        )
        costs.append(least_costs(currents, steepest * SPEEDS, [COSTS], height.rise)[0])
        reached = greatest_rise(currents, steepest * float(SPEEDS[-1]))[0]
        shares.append(reached / height.rise)
    return np.array(costs), min(shares)


def plan_of_one_degree(sea, objective):
    """Return a plan along the equator for a ship that sails 6 or 12 kn."""
    ship = Ship.simple(speed_kn=12.0, speeds_kn=[6.0, 12.0], draught_m=5.0, fuel_t_per_day=24.0)
    voyage = Voyage(
        start=(0.0, 0.0), goal=(0.0, 1.0), depart=T0, objective=objective, offing_nm=0.0,
        method="exact",
    )  # fmt: skip
    chart = Chart.open_water(-0.3, 0.3, -0.2, 1.2)
    return plan(voyage, ship=ship, sea=sea, chart=chart, resolution=20_000.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_no_track_costs_less_than_the_bound_of_its_ends_and_time(seed):
    rng = np.random.default_rng(seed)
    plane = Plane(40_000.0)
    flow = flow_of(rng)
    (x, y), time, cost = random_track(rng, flow, plane)
    if math.hypot(x, y) < 0.2:
        pytest.skip("the track ends where it began")
    costs, share = bounds_of(plane.sea(flow), plane.position(0, 0), plane.position(x, y), time)
    assert costs.max() <= cost * 1.002
    assert share >= 0.998


def tide(t):
    return 1.5 * np.sin(2 * math.pi * t / TIDE)


def least_fuel_in_a_tide(length, hours, speeds, rates):
    """Return the least fuel on a line with a tide that is the same all along it."""
    step = 60.0
    clock = np.arange(0.0, hours * HOUR, step) + 0.5 * step
    made = speeds[None, :] + tide(clock)[:, None]
    found = linprog(
        np.tile(rates * step, clock.size),
        A_ub=[*np.kron(np.eye(clock.size), np.ones(speeds.size)), -(made * step).ravel()],
        b_ub=[*np.ones(clock.size), -length],
        bounds=(0.0, 1.0),
    )
    return found.fun if found.success else math.inf


@pytest.mark.slow
def test_the_front_in_a_uniform_tide_is_bounded_within_a_few_per_cent():
    """The strongest current all the way would leave 26 to 48 %."""
    names = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
    sea = Sea.from_functions(
        {
            names[0]: lambda t, lat, lon: tide(np.asarray(t) - T0) + 0.0 * lat,
            names[1]: lambda t, lat, lon: 0.0 * np.asarray(t) + 0.0 * lat,
        }
    )
    ship = Ship.simple(
        speed_kn=12.0, speeds_kn=[6.0, 8.0, 10.0, 12.0], draught_m=5.0, fuel_t_per_day=24.0
    )
    voyage = Voyage(
        start=(0.0, 0.0), goal=(0.0, 1.0), depart=T0, objective="front", offing_nm=0.0,
        method="exact",
    )  # fmt: skip
    found = plan(voyage, ship=ship, sea=sea, chart=Chart.open_water(-0.3, 0.3, -0.2, 1.2))
    assert "with the strongest fair current of each time" in found.proof.kind
    gaps = [gap for gap in found.front.gaps(found.routes) if gap is not None]
    assert max(gaps) < 0.1
    assert max(found.front.joint_gaps(found.routes)) < 0.05
    speeds = np.array([6.0, 8.0, 10.0, 12.0]) * 1852.0 / HOUR
    rates = 24.0 / 86_400.0 * np.array([0.5, 8 / 12, 10 / 12, 1.0]) ** 3
    for hours in (5.5, 7.0, 8.5):
        truth = least_fuel_in_a_tide(METRES_PER_LON, hours, speeds, rates)
        low = certain_at(found.front.certain, hours)
        assert 0.95 * truth < low <= truth * 1.001


def test_the_bound_of_a_cost_is_the_least_of_its_front_at_all_times():
    """A jet beside the way, which the coarse network does not see, saves time that has a price.

    Routes slower than the known one pay for more time than the cheapest that the bound allows.
    """
    lat, lon = np.arange(-30, 31) * 0.05, np.arange(-20, 71) * 0.05
    times = np.arange(T0, T0 + 40 * HOUR, 900.0)
    east = np.zeros((times.size, lat.size, lon.size), np.float32)
    east[:, 36] = 3.0
    sea = gridded(times, lat, lon, east)
    ship = Ship.simple(speed_kn=10.0, speeds_kn=[6.0, 10.0], draught_m=5.0, fuel_t_per_day=24.0)
    voyage = Voyage(
        start=(0.0, 0.0), goal=(0.0, 2.0), depart=T0, objective="cost", offing_nm=0.0,
        method="exact", fuel_price_usd=10.0, time_price_usd_per_h=1000.0,
    )  # fmt: skip
    chart = Chart.open_water(-1.2, 1.2, -0.8, 3.0)
    found = plan(voyage, ship=ship, sea=sea, chart=chart, resolution=60_000.0)
    by_jet = Track([0.0, 0.3, 0.3, 0.0], [0.0, 0.3, 1.7, 2.0], T0, setting=np.array([1, 1, 1]))
    sailed = evaluate(by_jet, ship=found.plot_context.ship, sea=sea, chart=chart)
    cost = 1000.0 * sailed.time_h + 10.0 * sailed.fuel_t
    assert cost < 0.9 * found.front.values[0]  # the plan misses the jet
    assert found.proof.certain <= found.front.certain[1].min()
    assert found.proof.certain < cost


def test_currents_in_reach_are_read_once_for_a_front(monkeypatch):
    passages, around = [], BarrierDomain.around

    def counted(stretch, cells, **more):
        passages.append((tuple(stretch.channels), stretch.known, cells))
        return around(stretch, cells, **more)

    monkeypatch.setattr(BarrierDomain, "around", counted)
    lat, lon = np.arange(-5, 6) * 0.1, np.arange(-3, 14) * 0.1
    times = T0 + np.arange(21) * HOUR
    sea = gridded(times, lat, lon, np.full((times.size, lat.size, lon.size), 0.5, np.float32))
    found = plan_of_one_degree(sea, "fuel")
    slowest = max(route.time_h for route in found.routes if route.feasible)
    channels = (CURRENT_EAST, CURRENT_NORTH)
    of_currents = [one for one in passages if one[0] == channels]
    assert [known for _, known, _ in of_currents] == pytest.approx([slowest * HOUR])


def test_a_current_that_is_assumed_where_data_are_unknown_holds_between_two_times():
    """The data know a foul current at every second hour, and nothing between: there it is slack."""
    lat, lon = np.arange(-5, 6) * 0.1, np.arange(-3, 14) * 0.1
    times = T0 + np.arange(21) * HOUR
    east = np.full((times.size, lat.size, lon.size), -1.5, np.float32)
    east[1::2] = np.nan
    sea = gridded(times, lat, lon, east).filled(currents=0.0)
    found = plan_of_one_degree(sea, "front")
    for route, value in zip(found.routes, found.front.values, strict=True):
        assert found.front.certain[0, 0] <= route.time_h * 1.0001
        assert certain_at(found.front.certain, route.time_h) <= value * 1.001


@pytest.mark.slow
def test_a_bound_in_overlapping_files_is_not_above_the_routes_of_the_plan():
    """Round one unknown value the file below holds in the whole cell, up to the known corners."""
    lat, lon = np.arange(-6, 7) * 0.125, np.arange(-5, 19) * 0.125
    times = T0 + np.arange(30) * HOUR
    upper = np.zeros((times.size, lat.size, lon.size), np.float32)
    lower = upper + 3.0
    upper[:, 6, 2:8:2], lower[:, 6, 2:8:2] = np.nan, 0.0
    sea = Sea.layered(gridded(times, lat, lon, upper), gridded(times, lat, lon, lower))
    ship = Ship.simple(speed_kn=10.0, speeds_kn=[6.0, 10.0], draught_m=5.0, fuel_t_per_day=24.0)
    voyage = Voyage(
        start=(0.0625, 0.0), goal=(0.0625, 1.0), depart=T0, objective="front", offing_nm=0.0,
    )  # fmt: skip
    chart = Chart.open_water(-0.5, 0.5, -0.4, 1.7)
    found = plan(voyage, ship=ship, sea=sea, chart=chart)
    assert found.lower_bound <= found.best.time_h
    for route, value in zip(found.routes, found.front.values, strict=True):
        assert certain_at(found.front.certain, route.time_h) <= value * 1.001
