"""The compiled kernels give what the published NumPy functions give, at random conditions.

The functions in `thalweg.ship.methods`, `thalweg.ship` and `thalweg.core` are tested against the
figures of their sources; here the kernels that run in searches are held against these functions.
"""

import math

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from tests.search.small import line, make_fields, point_speed_at, steady
from thalweg.core import geodesy
from thalweg.core.limits import Limits
from thalweg.core.objective import FUEL_MASS
from thalweg.kernels import codes
from thalweg.kernels.geometry import cube_sphere
from thalweg.kernels.geometry.depth_sampling import DepthArrays, depths_at_points, least_depths
from thalweg.kernels.leg.table_lookup import table_value
from thalweg.kernels.pareto.edge_tables import sail_departures
from thalweg.search import ShipOnNetwork
from thalweg.search.fifo import sampled_arrivals
from thalweg.search.pareto.front_problem import (
    FrontRequest,
    MultiSettingShipOnNetwork,
    make_front_problem,
    new_edge_workspace,
)
from thalweg.ship import Ship
from thalweg.ship.conditions import Conditions, relative_angle
from thalweg.ship.methods.current_triangle import current_triangle
from thalweg.ship.tables.performance_table import PerformanceTable, TableError, TablePart

WIND, ANGLE = np.linspace(0.0, 30.0, 31), np.linspace(0.0, np.pi, 37)
HEIGHT, DEPTH = np.linspace(0.0, 6.0, 13), np.linspace(5.0, 60.0, 12)
SEA_NAMES = {
    "current_east": "eastward_sea_water_velocity",
    "current_north": "northward_sea_water_velocity",
    "wind_east": "eastward_wind",
    "wind_north": "northward_wind",
}


def performance_table(*parts, settings=(5.0, 8.0)):
    return PerformanceTable(
        tuple(TablePart(*part) for part in parts), np.array(settings), "", TableError(0, 0, 0)
    )


def weather_table():
    """Return two speeds less what wind, waves and shallow water take, smooth in every angle."""
    per_setting = np.array([1.0, 1.4])
    wind = -0.002 * WIND[:, None] ** 2 * (1.2 + np.cos(ANGLE))
    waves = -0.05 * HEIGHT[:, None] ** 2 * (1.2 + np.cos(ANGLE))
    return performance_table(
        ((), (), np.array([5.0, 8.0])),
        (
            (codes.AXIS_WIND_SPEED, codes.AXIS_WIND_ANGLE),
            (WIND, ANGLE),
            wind[..., None] * per_setting,
        ),
        (
            (codes.AXIS_WAVE_HEIGHT, codes.AXIS_WAVE_ANGLE),
            (HEIGHT, ANGLE),
            waves[..., None] * per_setting,
        ),
        ((codes.AXIS_DEPTH,), (DEPTH,), (-3.0 / DEPTH)[:, None] * per_setting),
    )


def random_conditions(rng):
    speed, towards = rng.uniform(0.5, 20.0), rng.uniform(0.0, 2.0 * np.pi)
    waves = rng.uniform(0.0, 2.0 * np.pi)
    return {
        "current_east": rng.uniform(-1.5, 1.5),
        "current_north": rng.uniform(-1.5, 1.5),
        "wind_east": speed * math.sin(towards),
        "wind_north": speed * math.cos(towards),
        "wave_height_channel": rng.uniform(0.0, 5.0),
        "wave_east": math.sin(waves),
        "wave_north": math.cos(waves),
    }


def published_speed_over_ground(table, sea, course, depth, setting):
    """Return the speed over ground by the published functions, the heading found by iteration."""
    heading = course
    given = {SEA_NAMES[name]: sea[name] for name in SEA_NAMES}
    for _ in range(50):
        conditions = Conditions.from_sea(given, heading=heading)
        where = {
            "wind_speed": conditions["wind_speed"],
            "wind_angle": conditions["wind_angle"],
            "wave_height": sea["wave_height_channel"],
            "wave_angle": relative_angle(-sea["wave_east"], -sea["wave_north"], heading),
            "depth": depth,
        }
        found = current_triangle(
            table.lookup(where, setting),
            course,
            current_east=sea["current_east"],
            current_north=sea["current_north"],
        )
        heading = float(found.heading)
    return float(found.speed_over_ground)


@pytest.mark.parametrize("seed", range(40))
def test_point_speed_is_the_current_triangle_on_the_table(seed):
    rng = np.random.default_rng(seed)
    table, sea = weather_table(), random_conditions(rng)
    course, depth = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(8.0, 90.0)
    setting = int(rng.integers(2))
    expected = published_speed_over_ground(table, sea, course, depth, setting)
    found, status = point_speed_at(
        table.kernel_arrays(), course=course, depth=depth, setting=setting, **sea
    )
    if math.isnan(expected):
        assert status == codes.CURRENT
    else:  # the kernel corrects the heading to 0.001 rad
        assert status == codes.OK
        assert found == pytest.approx(expected, rel=5e-4)


def test_point_speed_without_weather_is_the_published_triangle():
    rng = np.random.default_rng(1)
    for _ in range(200):
        speed, course = rng.uniform(1.0, 9.0), rng.uniform(-np.pi, np.pi)
        current = rng.uniform(-6.0, 6.0, 2)
        expected = current_triangle(
            speed, course, current_east=current[0], current_north=current[1]
        )
        found, status = point_speed_at(
            steady(speed), course=course, current_east=current[0], current_north=current[1]
        )
        assert (status == codes.OK) == bool(expected.possible)
        if status == codes.OK:  # tables are in single precision
            assert found == pytest.approx(float(expected.speed_over_ground), rel=2e-6, abs=2e-6)


@pytest.mark.slow
@pytest.mark.parametrize("what", ["tabulate", "tabulate_fuel"])
@pytest.mark.parametrize("name", ["s175", "vox-olympia"])
def test_table_value_is_the_lookup_of_the_table(name, what):
    table = getattr(Ship.load(name), what)()
    arrays, rng, known = table.kernel_arrays(), np.random.default_rng(3), 0
    names = ("wind_speed", "wind_angle", "wave_height", "wave_angle", "wave_period", "depth")
    low = np.array([0.0, 0.0, 0.0, 0.0, 4.0, 10.0])
    high = np.array([25.0, np.pi, 4.0, np.pi, 14.0, 100.0])
    for _ in range(200):
        at = rng.uniform(low, high)
        setting = int(rng.integers(arrays.n_settings))
        expected = float(table.lookup(dict(zip(names, at)), setting))
        value, ok = table_value(arrays, tuple(float(x) for x in at), setting)
        assert ok == math.isfinite(expected)
        if ok:
            known += 1
            assert value == pytest.approx(expected, rel=1e-5, abs=1e-6)
    assert known > 20


def test_refusal_in_waves_is_that_of_the_safety_limits():
    ship = Ship.from_dict(
        {
            "name": "with limits",
            "hull": {
                "length_between_perpendiculars_m": 150.0,
                "breadth_m": 25.0,
                "draught_m": 8.0,
                "block_coefficient": 0.7,
                "roll_period_s": 14.0,
            },
            "speeds_kn": [12, 18, 24],
            "limits": {"msc_circ_1228": ["all"]},
        }
    )
    arrays, rng, refused = ship.tabulate().kernel_arrays(), np.random.default_rng(5), 0
    for _ in range(300):
        setting, course = int(rng.integers(3)), rng.uniform(0.0, 2.0 * np.pi)
        towards, height, period = rng.uniform(0.0, 2 * np.pi), rng.uniform(0, 8), rng.uniform(4, 16)
        east, north = math.sin(towards), math.cos(towards)
        expected = ship.limits.safety.forbids(
            ship.speeds[setting],
            wave_angle=relative_angle(-east, -north, course),
            wave_height=height,
            wave_period=period,
        )
        _, status = point_speed_at(
            arrays,
            course=course,
            setting=setting,
            wave_height_channel=height,
            wave_east=east,
            wave_north=north,
            wave_period=period,
        )
        assert status == (codes.SAFETY if expected else codes.OK)
        refused += bool(expected)
    assert 20 < refused < 280


def test_an_edge_in_a_uniform_current_takes_its_length_over_the_published_speed():
    rng = np.random.default_rng(7)
    for _ in range(20):
        course, current = rng.uniform(-np.pi, np.pi), rng.uniform(-2.0, 2.0, 2)
        network = line(2, 9000.0, course=course, pieces=4)
        fields = make_fields(network, [0.0, 1e6], current_east=current[0], current_north=current[1])
        arrivals, _ = sampled_arrivals(
            ShipOnNetwork(network, fields, steady(5.0), setting=0, limits=Limits(), top_speed=5.0),
            departures=[50.0],
            edges=[0],
        )
        found = current_triangle(
            5.0,
            float(network.edges.course[0]),
            current_east=np.float32(current[0]),
            current_north=np.float32(current[1]),
        )
        expected = network.edges.length[0] / found.speed_over_ground
        assert arrivals[0, 0] - 50.0 == pytest.approx(float(expected), rel=1e-7)


def test_an_edge_burns_the_fuel_rate_of_the_table_at_the_published_heading():
    table, rng = weather_table(), np.random.default_rng(11)
    rate = performance_table(
        ((), (), np.array([0.2, 0.9])),
        ((codes.AXIS_WIND_SPEED, codes.AXIS_WIND_ANGLE), (WIND, ANGLE),
         (1e-3 * WIND[:, None] * (1.2 + np.cos(ANGLE)))[..., None] * np.array([1.0, 2.0])),
    )  # fmt: skip
    for _ in range(10):
        sea = random_conditions(rng)
        network = line(2, 9000.0, course=rng.uniform(-np.pi, np.pi), depth=40.0, pieces=3)
        course = float(network.edges.course[0])
        fields = make_fields(network, [0.0, 1e6], **sea)
        request = FrontRequest(
            0, 1, 0.0, 9e5, np.arange(2), FUEL_MASS, np.ones(network.n_edges), True
        )
        ship = MultiSettingShipOnNetwork(network, fields, table, rate, Limits())
        problem = make_front_problem(ship, request)
        out, edges = np.empty((2, 2)), np.zeros(2, np.int64)
        sail_departures(
            problem.arrays, edges, edges, np.arange(2), np.full(2, 60.0), out, new_edge_workspace()
        )
        for setting in range(2):
            ground = published_speed_over_ground(table, sea, course, 40.0, setting)
            if math.isnan(ground):
                assert np.isnan(out[setting]).all()
                continue
            duration = network.edges.length[0] / ground
            assert out[setting, 0] == pytest.approx(duration, rel=5e-4)
            east = ground * math.sin(course) - sea["current_east"]
            north = ground * math.cos(course) - sea["current_north"]
            conditions = Conditions.from_sea(
                {SEA_NAMES[name]: sea[name] for name in SEA_NAMES}, heading=math.atan2(east, north)
            )
            where = {name: conditions[name] for name in ("wind_speed", "wind_angle")}
            assert out[setting, 1] / out[setting, 0] == pytest.approx(
                float(rate.lookup(where, setting)), rel=1e-3
            )


def test_unit_vectors_are_those_of_geodesy():
    rng = np.random.default_rng(13)
    lat, lon = rng.uniform(-90.0, 90.0, 200), rng.uniform(-180.0, 180.0, 200)
    expected = geodesy.geocentric_unit_vectors(lat, lon)
    for k in range(200):
        vector = cube_sphere.unit_vector(lat[k], lon[k])
        assert vector == pytest.approx(expected[k], abs=1e-14)
        assert cube_sphere.latitude_longitude(*vector) == pytest.approx((lat[k], lon[k]), abs=1e-9)


def test_sampled_depth_is_bilinear_and_the_least_on_a_leg_is_not_above_it():
    rng = np.random.default_rng(17)
    rows, columns, step = 21, 31, 0.05
    lat, lon = 51.0 + step * np.arange(rows), 3.0 + step * np.arange(columns)
    values = rng.uniform(5.0, 50.0, (rows, columns)).astype(np.float32)
    depths = DepthArrays(
        np.array([[lat[0], step, lon[0], step]]),
        np.array([[rows, columns]]),
        np.zeros(1, np.int64),
        values.ravel(),
    )
    bilinear = RegularGridInterpolator((lat, lon), values.astype(float))
    y, x = rng.uniform(lat[0], lat[-1], 300), rng.uniform(lon[0], lon[-1], 300)
    found = np.empty(300)
    depths_at_points(depths, y, x, False, found)
    assert found == pytest.approx(bilinear(np.column_stack([y, x])), rel=1e-6)
    least = np.empty(299, np.float32)
    least_depths(depths, y[:-1], x[:-1], y[1:], x[1:], least)
    for k in range(0, 299, 10):
        along = geodesy.densify(y[k : k + 2], x[k : k + 2], 500.0)
        shallow = bilinear(np.column_stack(along[:2])).min()
        assert least[k] <= shallow + 0.02
