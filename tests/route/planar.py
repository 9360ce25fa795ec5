"""Planar worlds on the equator, scaled down so that the ellipsoid is flat to a few 1e-6.

Lengths and times are divided by ``shrink``; speeds stay.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import shapely

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


class Islands:
    """A chart of polygons near the equator, where geodesics are straight in degrees.

    It replaces a Chart: the same tests, by shapely.
    """

    has_depth = False
    zones = SimpleNamespace(has_penalty=False, penalty=(), price=(), eca=(), lanes=())
    canals = ()

    def __init__(self, *polygons):
        self.land = shapely.union_all(list(polygons))
        shapely.prepare(self.land)

    def legs_blocked(self, lat1, lon1, lat2, lon2):
        ends = np.stack([np.stack([lon1, lat1], -1), np.stack([lon2, lat2], -1)], -2)
        return shapely.intersects(self.land, shapely.linestrings(ends))

    def leg_status(self, lat1, lon1, lat2, lon2):
        return self.legs_blocked(lat1, lon1, lat2, lon2).astype(np.int8)


def rectangle(plane: Plane, x0: float, y0: float, x1: float, y1: float):
    (south, west), (north, east) = plane.place(x0, y0), plane.place(x1, y1)
    return shapely.box(west, south, east, north)
