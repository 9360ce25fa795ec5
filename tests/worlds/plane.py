"""Planar worlds on the equator, where the ellipsoid is flat to about 1e-5."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thalweg import Chart, Plan, Sea, Ship, Voyage, plan

METRES_PER_LON = 111319.490793  # on the equator, WGS 84
METRES_PER_LAT = 110574.2759
T0 = 1_767_225_600.0  # 2026-01-01T00:00Z
KNOT = 1852.0 / 3600.0

Flow = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Plane:
    """A plane with its own unit of length (in metres), its origin at 0N 0E."""

    unit: float = 1.0

    def position(self, x: float, y: float) -> tuple[float, float]:
        return y * self.unit / METRES_PER_LAT, x * self.unit / METRES_PER_LON

    def xy(self, lat, lon):
        return (
            np.asarray(lon) * METRES_PER_LON / self.unit,
            np.asarray(lat) * METRES_PER_LAT / self.unit,
        )

    def sea(self, flow: Flow, **more) -> Sea:
        """A sea whose current is flow(t since T0 [s], x, y) in m/s."""

        def component(index):
            def value(time_s, lat, lon):
                x, y = self.xy(lat, lon)
                return flow(np.asarray(time_s) - T0, x, y)[index]

            return value

        names = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
        return Sea.from_functions({names[0]: component(0), names[1]: component(1), **more})

    def water(self, west: float, east: float, south: float, north: float) -> Chart:
        (low, left), (high, right) = self.position(west, south), self.position(east, north)
        return Chart.open_water(low, high, left, right)

    def plan(self, start, goal, *, sea, ship, chart, spacing=None, **request) -> Plan:
        voyage = Voyage(
            offing_nm=0.0,
            start=self.position(*start),
            goal=self.position(*goal),
            depart=T0,
            **request,
        )
        resolution = None if spacing is None else spacing * self.unit
        return plan(voyage, ship=ship, sea=sea, chart=chart, resolution=resolution)


def simple_ship(speed: float, **more) -> Ship:
    """A ship of one speed through water [m/s]."""
    return Ship.simple(speed_kn=speed / KNOT, draught_m=more.pop("draught_m", 5.0), **more)


def assert_optimal(
    found: Plan, optimum_s: float, within: float = 1e-3, solver_within: float = 5e-3
) -> None:
    """The refereed route is the optimum: never below it by more than the referee's tolerance.

    The solver's own total may lie below by ``solver_within``: its sea is linear between stations
    and between time steps, which opens a bar that opens at once up to one step too early.
    """
    best = found.best
    seconds = best.time_h * 3600.0
    assert best.feasible, best.violations
    assert seconds <= optimum_s * (1 + within)
    assert seconds >= optimum_s * (1 - 1e-4) - best.tolerance_s
    assert not found.lower_bound > best.time_h  # NaN where there is none
    assert not found.lower_bound * 3600.0 > optimum_s * (1 + 1e-4)
    assert found.solver_total * 3600.0 >= optimum_s * (1 - solver_within)
