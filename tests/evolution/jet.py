"""A meandering jet, two moving eddies and a tide: 500 x 500 nm, shrunk 100 times, on the equator.

Speeds and fuel are Table 5.3 of Seuren (2020). Times in hours and fuel in tonnes are given at the
scale before shrinking.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from thalweg.chart import Chart
from thalweg.core.limits import Limits
from thalweg.evolution import (
    EvaluationResolution,
    Evaluator,
    Genome,
    TabulatedShip,
    make_evaluator,
)
from thalweg.kernels import codes
from thalweg.route import evaluate
from thalweg.sea import Sea
from thalweg.ship import PerformanceTable, Ship, TableError, TablePart

SHRINK = 100.0
METRES_PER_LON = 111319.49079327358  # on the equator, WGS 84
METRES_PER_LAT = 110574.27582159436
NM = 1852.0
KNOT = NM / 3600.0
T0 = 1_767_225_600.0
LATEST_H = 32.0
NO_LIMITS = Limits()
REFERENCE = (32.0, 32.0)  # of the hypervolume: hours, tonnes

SPEED_KN = (8.8, 9.5, 9.9, 10.3, 10.6, 10.8, 14.1, 14.3, 14.5, 14.8, 15.0, 15.2)
FUEL_T_DAY = (14.3, 15.5, 16.4, 17.6, 18.9, 20.1, 28.9, 30.3, 32.0, 34.4, 36.8, 39.0)


def position(x: float, y: float) -> tuple[float, float]:
    """Return (lat, lon) [deg] of a place of the plane [nm]."""
    scale = NM / SHRINK
    return y * scale / METRES_PER_LAT, x * scale / METRES_PER_LON


START, GOAL = position(100.0, 200.0), position(400.0, 300.0)


def current(t, x, y):
    """Return (u, v) [kn] at hours and nautical miles."""
    wave = 2.0 * math.pi * (x / 320.0 - t / 260.0)
    middle = 250.0 + 45.0 * np.sin(wave)
    slope = 45.0 * (2.0 * math.pi / 320.0) * np.cos(wave)
    length = np.sqrt(1.0 + slope**2)
    jet = 2.6 * np.exp(-(((y - middle) / 28.0) ** 2) / 2.0)
    u, v = jet / length, jet * slope / length
    for k in (0, 1):
        sign = 1 - 2 * k
        cx, cy = 160.0 + 180.0 * k + 0.6 * t * sign, 330.0 - 170.0 * k
        e = np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / (2.0 * 55.0**2))
        u, v = u - 0.045 * sign * (y - cy) * e, v + 0.045 * sign * (x - cx) * e
    tide = 0.5 * np.cos(2.0 * math.pi * t / 12.42)
    return u + 0.6 * tide, v + 0.8 * tide


def _component(index):
    def value(time, lat, lon):
        scale = SHRINK / NM
        t = (np.asarray(time) - T0) * SHRINK / 3600.0
        x, y = np.asarray(lon) * METRES_PER_LON * scale, np.asarray(lat) * METRES_PER_LAT * scale
        return KNOT * current(t, x, y)[index]

    return value


@cache
def sea() -> Sea:
    return Sea.from_functions(
        {
            "eastward_sea_water_velocity": _component(0),
            "northward_sea_water_velocity": _component(1),
        }
    )


@cache
def ship() -> Ship:
    table = {
        "engines": [1] * 6 + [2] * 6,
        "power_percent": [75, 80, 85, 90, 95, 100] * 2,
        "speed_kn": list(SPEED_KN),
        "fuel_t_per_day": list(FUEL_T_DAY),
    }
    hull = {"draught_m": 9.5}
    models = {"calm_water": "table", "speed_loss": "none"}
    return Ship.from_dict({"name": "table 5.3", "hull": hull, "table": table, "models": models})


def constant_table(values) -> PerformanceTable:
    part = TablePart((), (), np.asarray(values, np.float32))
    return PerformanceTable((part,), np.asarray(values, float), "", TableError(0.0, 0.0, 0.0))


def speed_table() -> PerformanceTable:
    return constant_table([s * KNOT for s in SPEED_KN])


def fuel_table() -> PerformanceTable:
    return constant_table([1000.0 * f / 86400.0 for f in FUEL_T_DAY])


@cache
def chart() -> Chart:
    (south, west), (north, east) = position(0.0, 0.0), position(500.0, 500.0)
    return Chart.open_water(south, north, west, east)


@cache
def fields(cells: int = 200):
    (south, west), (north, east) = position(0.0, 0.0), position(500.0, 500.0)
    end = T0 + 1.05 * LATEST_H * 3600.0 / SHRINK
    channels = [codes.CURRENT_EAST, codes.CURRENT_NORTH]
    return sea().freeze_grid(
        south, north, west, east, T0, end, channels, spacing_deg=(north - south) / cells
    )


def evaluator(*, fuel=None, limits=NO_LIMITS, **more) -> Evaluator:
    ship = TabulatedShip(speed_table(), fuel_table() if fuel is None else fuel, limits)
    given = {
        "fields": fields(),
        "depart": T0,
        "chart": chart(),
        "latest": T0 + LATEST_H * 3600.0 / SHRINK,
        "resolution": EvaluationResolution(spacing=5.0 * NM / SHRINK),
    }
    return make_evaluator(ship, **{**given, **more})


def straight(setting: int, points: int = 12) -> Genome:
    """Return the straight track at one setting."""
    share = np.linspace(0.0, 1.0, points)
    lat = START[0] + share * (GOAL[0] - START[0])
    lon = START[1] + share * (GOAL[1] - START[1])
    return Genome(lat, lon, np.full(points - 1, setting))


def refereed(genome: Genome, water: Chart | None = None) -> tuple[float, float, int]:
    """Return hours and tonnes by the referee, and how many limits are broken."""
    given = {"ship": ship(), "sea": sea(), "chart": water or chart(), "min_ukc": None}
    route = evaluate(genome.to_track(T0), **given)
    return route.time_h * SHRINK, route.fuel_t * SHRINK, len(route.violations)


def objectives(front) -> np.ndarray:
    """Return hours and tonnes of an array of seconds and kilograms."""
    values = np.asarray(front, float)
    return np.column_stack([values[:, 0] * SHRINK / 3600.0, values[:, 1] * SHRINK / 1000.0])
