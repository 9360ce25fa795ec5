"""Planar worlds laid on the equator, shrunk so far that the ellipsoid is flat to a few 1e-6.

Lengths and times are divided by ``shrink``; speeds stay.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thalweg.core.units import KNOT
from thalweg.sea import Sea
from thalweg.ship import Ship

EAST = 111319.49079327358  # metres per degree of longitude on the equator, WGS 84
NORTH = 110574.27582159436  # metres per degree of latitude there


@dataclass(frozen=True)
class Plane:
    """A plane of ``unit`` metres to the length unit of a problem, at true scale ``speed``."""

    unit: float

    def place(self, x: float, y: float) -> tuple[float, float]:
        return y * self.unit / NORTH, x * self.unit / EAST

    def xy(self, lat, lon):
        return np.asarray(lon) * EAST / self.unit, np.asarray(lat) * NORTH / self.unit

    def sea(self, u: Callable, v: Callable, speed: float = 1.0, **more) -> Sea:
        """Currents ``speed * u(t, x, y)`` m/s, t in units of ``unit / speed`` seconds."""

        def component(f):
            def current(time, lat, lon):
                return speed * f(time * speed / self.unit, *self.xy(lat, lon)) + 0.0 * lat

            return current

        return Sea.from_functions(
            {
                "eastward_sea_water_velocity": component(u),
                "northward_sea_water_velocity": component(v),
            },
            **more,
        )


def ship(speed: float, draught: float = 5.0) -> Ship:
    """A ship that always makes ``speed`` m/s through the water."""
    return Ship.simple(speed_kn=speed / KNOT, draught_m=draught)
