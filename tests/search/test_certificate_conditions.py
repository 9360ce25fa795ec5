"""What certified bounds count besides the sea: offing, zones, canals, speed fields, departures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.search.test_time_certificate import (
    CURRENTS,
    EAST,
    NORTH,
    SPEED,
    on_meshes,
    sea_of,
    ship_of_one_speed,
)
from thalweg.chart import Chart
from thalweg.chart.canals import Canal
from thalweg.core.geodesy import distance
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.kernels.certificate.barrier_check import closed_throughout
from thalweg.kernels.certificate.cell_conditions import TimeWindows
from thalweg.sea import Sea
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import build_mesh
from thalweg.search.certificate.closed_water import closed_cells
from thalweg.search.certificate.departure_certificate import certify_departures
from thalweg.search.certificate.time_certificate import certify_time

ENDS = (10.0, 20.0), (10.0, 21.0)
STRAIGHT = float(distance(*ENDS[0], *ENDS[1])) / SPEED


def box(west, south, east, north):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    return {"type": "Polygon", "coordinates": [ring]}


def stretch(known, *, chart=None, sea=None, ship=None, channels=()):
    ship = ship or ship_of_one_speed(SPEED)
    return StretchToBound(sea or Sea.calm(), chart, ship, channels, *ENDS, depart=1e9, known=known)


def test_cells_near_land_are_closed_by_the_offing_and_only_by_it():
    chart = Chart.from_geojson(box(20.4, 9.9, 20.6, 10.1))
    lat, lon = np.linspace(9.5, 10.5, 51), np.linspace(20.0, 21.0, 51)
    land = closed_cells(chart, lat, lon)
    off = closed_cells(chart.with_offing(8_000.0), lat, lon)
    y, x = 0.5 * (lat[1:] + lat[:-1]), 0.5 * (lon[1:] + lon[:-1])
    far = np.asarray(
        chart.coastline.shore_distance(*(a.ravel() for a in np.meshgrid(y, x, indexing="ij")))
    ).reshape(land.shape)
    half = 0.01 * 111_195.0 * math.sqrt(2.0)
    assert land.sum() < off.sum() and (off | ~land).all()
    assert far[off].max() < 8_000.0 - half
    assert off[far < 8_000.0 - 4.0 * half].all()


def test_a_no_go_zone_is_closed_inside_and_open_on_its_outline():
    zone = {
        "type": "Feature",
        "properties": {"kind": "no_go"},
        "geometry": box(20.4, 9.9, 20.6, 10.1),
    }
    chart = Chart.open_water(5.0, 15.0, 15.0, 25.0).with_zones(
        {"type": "FeatureCollection", "features": [zone]}
    )
    lat, lon = np.linspace(9.5, 10.5, 41), np.linspace(20.0, 21.0, 41)
    closed = closed_cells(chart, lat, lon)
    row, column = np.nonzero(closed)
    assert closed.sum() > 20
    assert lat[row].min() >= 9.9 - 1e-6 and lat[row + 1].max() <= 10.1 + 1e-3
    assert lon[column].min() >= 20.4 - 1e-6 and lon[column + 1].max() <= 20.6 + 1e-6


def test_a_canal_through_a_wall_is_a_link_of_the_barrier():
    chart = Chart.from_geojson(box(20.48, 9.0, 20.52, 11.0))
    hours = 1800.0
    canal = Canal("cut", "The cut", ((10.0, 20.46), (10.0, 20.54)), transit_time=hours, fee=0.0)
    through = float(distance(10.0, 20.0, 10.0, 20.46) + distance(10.0, 20.54, 10.0, 21.0))
    best = through / SPEED + hours
    with_canal = on_meshes(stretch(1.003 * best, chart=replace(chart, canals=(canal,))), cells=60)
    assert len(with_canal.mesh.links) == 1
    assert 0.95 * best < with_canal.value <= best
    without = on_meshes(stretch(1.3 * best, chart=chart), cells=60)
    assert without.value > 1.1 * best  # round the wall


def test_a_ship_whose_speed_is_a_field_is_bounded_by_the_field():
    """A slow half: V = 5 m/s west of 20.5 E and 2.5 m/s east of it."""

    def field(sampled, t, lat, lon):
        return np.where(lon < 20.5, 5.0, 2.5) + 0.0 * lat

    ship = replace(ship_of_one_speed(5.0), top_speed=math.nan, speed_field=field)
    best = 0.5 * STRAIGHT + STRAIGHT
    found = on_meshes(stretch(1.003 * best, ship=ship), cells=60)
    assert 0.93 * best < found.value <= best
    assert "linear between" in found.sampling


@pytest.mark.slow
def test_in_a_tide_the_bound_holds_for_the_best_departure_of_a_window():
    """A uniform current along the way turns once: the best departure has it ahead of slack."""
    period, strength = 44_712.0, 1.5
    length = float(distance(*ENDS[0], *ENDS[1]))
    times = np.arange(0.0, 80_000.0, 20.0)

    def duration(depart):
        speed = SPEED + strength * np.cos(2 * np.pi * (times + depart) / period)
        return float(times[np.argmax(np.cumsum(speed) * 20.0 >= length)])

    window = 20_000.0
    best = min(duration(depart) for depart in np.arange(0.0, window, 200.0))
    worst = duration(0.5 * window)
    sea = sea_of(
        lambda t, y, x: strength * np.cos(2 * np.pi * (t - 1e9) / period) + 0 * x,
        lambda t, y, x: 0 * x,
        time_step=1800.0,
    )
    asked = stretch(1.003 * best, sea=sea, channels=CURRENTS)
    found = certify_departures(replace(asked, latest=1e9 + window), seconds=60.0, target=0.06)
    assert best < 0.95 * worst
    assert 0.9 * best < found.value <= best + 40.0


def test_the_bound_of_the_geodesic_takes_the_strongest_current_of_the_data():
    sea = sea_of(lambda t, y, x: 2.0 * np.exp(-((y - 10.2) ** 2) * 400.0), lambda t, y, x: 0 * x)
    found = certify_time(stretch(STRAIGHT, sea=sea, channels=CURRENTS), seconds=0.0)
    assert EAST in sea.variables and codes.CURRENT_EAST in CURRENTS
    assert found.cells == 0 and found.barrier is None
    assert 0.98 * STRAIGHT * 5.0 / 7.0 < found.value < 1.02 * STRAIGHT * 5.0 / 7.0


@pytest.mark.slow
def test_the_limit_of_the_wind_is_one_over_the_ground():
    """A wind of 14 m/s against a current of 3 m/s: 17 m/s over the water, and within the limit."""
    winds = {"eastward_wind": lambda t, y, x: 14.0 + 0 * x, "northward_wind": lambda t, y, x: 0 * x}
    flow = {EAST: lambda t, y, x: -3.0 + 0 * x, NORTH: lambda t, y, x: 0 * x}
    sea = Sea.from_functions({**winds, **flow}, time_step=0)
    best = STRAIGHT * SPEED / (SPEED - 3.0)
    channels = (*CURRENTS, codes.WIND_EAST, codes.WIND_NORTH)
    limited = ship_of_one_speed(SPEED, Limits(wind_speed=15.0))
    found = on_meshes(stretch(1.05 * best, sea=sea, ship=limited, channels=channels), cells=60)
    assert found.reached <= 1.001 * best


@pytest.mark.parametrize("by_steps", [False, True])
def test_water_of_functions_may_open_at_any_moment_between_samples(by_steps):
    """It opens 10 s after a sample; linear between samples it would open 9 minutes later."""
    opens = 1e9 + 12 * 1200.0 + 10.0

    def depth(t, y, x):
        return np.where(t < opens, -5.0, 20.0) + 0 * x

    sea = Sea.from_functions({"sea_floor_depth_below_geoid": depth}, time_step=1200.0)
    afloat = ship_of_one_speed(SPEED, Limits(required_depth=6.5))
    where = stretch(1.1 * STRAIGHT, sea=sea, ship=afloat, channels=(codes.BED_DEPTH,))
    domain = BarrierDomain.around(where, 24)
    mesh = build_mesh(domain.raster, 1, domain.ship, None, by_steps=by_steps)
    cells = mesh.lat.size - 1, mesh.lon.size - 1
    step = float(np.diff(domain.raster.times)[0])
    sample = step * math.ceil((opens - 1e9) / step)  # the first one at which it is open
    for moment, expected in ((sample + 5.0, False), (sample - 0.9 * step, not by_steps)):
        closed, window = np.ones(cells, bool), np.full(cells, moment)
        may_close = np.zeros(cells, bool)
        closed_throughout(mesh.world, TimeWindows(window, window + 1.0), closed, may_close)
        assert (closed == expected).all()
        assert (may_close == (by_steps and not expected and moment < sample)).all()


@pytest.mark.slow
@pytest.mark.parametrize("step", [600.0, 100.0])  # of the second, no window holds all moments
def test_a_bar_across_the_whole_way_delays_the_bound_until_it_opens(step):
    """No ship passes the bar before it opens: the bound rises over it by the time of waiting."""
    opens = 18_000.0

    def depth(t, y, x):
        return np.where((abs(x - 20.5) < 0.03) & (t - 1e9 < opens), -5.0, 20.0) + 0 * y

    sea = Sea.from_functions({"sea_floor_depth_below_geoid": depth}, time_step=step)
    afloat = ship_of_one_speed(SPEED, Limits(required_depth=6.5))
    best = opens + 0.53 * STRAIGHT
    bar = stretch(1.002 * best, sea=sea, ship=afloat, channels=(codes.BED_DEPTH,))
    found = on_meshes(bar, 100, 1)
    assert 0.98 * best < found.value <= best


@pytest.mark.parametrize("current", [0.0, 1.0])
def test_a_passage_near_a_pole_is_bounded_by_the_geodesic(current):
    ends = (82.0, 0.0), (82.0, 180.0)
    length = float(distance(*ends[0], *ends[1]))
    sea = sea_of(lambda t, y, x: current + 0 * x, lambda t, y, x: 0 * x) if current else Sea.calm()
    channels = CURRENTS if current else ()
    where = StretchToBound(
        sea, None, ship_of_one_speed(SPEED), channels, *ends, depart=1e9, known=1.1 * length / SPEED
    )
    found = certify_time(where, seconds=1.0)
    best = length / (SPEED + current)
    assert found.cells == 0 and 0.999 * best < found.value <= best
