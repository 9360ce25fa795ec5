"""The area of a map, and its projection: Mercator up to 75 degrees of latitude."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.geodesy import METRES_PER_DEGREE, unwrap_longitude, wrap_longitude
from thalweg.core.units import NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.route import Route

MERCATOR_LIMIT = 75.0  #: Beyond this latitude degrees have the scale of the middle of the map [deg]
_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0)  # of graticules
_SCALES = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000)  # of the bar [nm]


@dataclass(frozen=True)
class MapExtent:
    """The area of a map [deg]; longitudes continue beyond 180 where needed."""

    south: float
    north: float
    west: float
    east: float

    @classmethod
    def of_routes(cls, routes: Sequence[Route]) -> MapExtent:
        """Return the area round routes, with a margin and not much longer than wide."""
        lat = np.concatenate([route.samples["lat"] for route in routes])
        lon = np.concatenate([unwrap_longitude(route.samples["lon"]) for route in routes])
        high, wide = np.ptp(lat), np.ptp(lon) * math.cos(math.radians(float(np.mean(lat))))
        margin = 0.12 * max(high, wide, 1e-3)
        stretch = math.cos(math.radians(min(80.0, float(np.max(np.abs(lat))))))
        grow = max(0.0, 0.42 * max(wide, high) - high) / 2
        widen = max(0.0, 0.6 * high - wide) / 2
        side_margin = min((margin + widen) / stretch, max(0.0, 0.5 * (359.0 - float(np.ptp(lon)))))
        return cls(
            max(-89.9, float(lat.min()) - margin - grow),
            min(89.9, float(lat.max()) + margin + grow),
            float(lon.min()) - side_margin,
            float(lon.max()) + side_margin,
        )

    def figure_size(self) -> tuple[float, float]:
        """Return the width and height of a figure with one map [inch]."""
        shape = self.height / (self.east - self.west)
        width = min(10.0, 9.0 / shape + 1.6)
        return width, max(3.6, (width - 1.6) * shape + 0.9)

    @property
    def is_mercator(self) -> bool:
        """Whether the map is in Mercator's projection."""
        return max(abs(self.south), abs(self.north)) <= MERCATOR_LIMIT

    @property
    def height(self) -> float:
        """Height of the map in units of a degree of longitude."""
        if self.is_mercator:
            return float(np.diff(mercator([self.south, self.north]))[0])
        return (self.north - self.south) / self._stretch

    @property
    def _stretch(self) -> float:
        """Length of a degree of longitude over that of a degree of latitude, in the middle."""
        return max(0.05, math.cos(math.radians(0.5 * (self.south + self.north))))

    def unwrapped(self, lon: np.ndarray) -> np.ndarray:
        """Return longitudes shifted by multiples of 360 degrees into the area."""
        middle = 0.5 * (self.west + self.east)
        return middle + wrap_longitude(np.asarray(lon) - middle)

    def line(self, lon: np.ndarray) -> np.ndarray:
        """Return the longitudes of a line without jumps, shifted by 360 degrees into the area."""
        lon = unwrap_longitude(lon)
        away = 0.5 * (self.west + self.east) - 0.5 * (float(lon.min()) + float(lon.max()))
        return np.asarray(lon + 360.0 * round(away / 360.0))

    def grid(self, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
        """Return latitudes and longitudes (rows, columns), evenly spaced on the map."""
        if self.is_mercator:
            low, high = mercator([self.south, self.north]).tolist()
            lat = inverse_mercator(np.linspace(low, high, rows))
        else:
            lat = np.linspace(self.south, self.north, rows)
        lon, lat = np.meshgrid(np.linspace(self.west, self.east, columns), lat)
        return lat, lon

    def set_up(self, axes: Any) -> None:
        """Set the projection, the limits and the graticule of axes."""
        if self.is_mercator:
            axes.set_yscale("function", functions=(mercator, inverse_mercator))
            axes.set_aspect(1.0)
        else:
            axes.set_aspect(1.0 / self._stretch)
        axes.set_xlim(self.west, self.east)
        axes.set_ylim(self.south, self.north)
        for axis, low, high, letters in (
            (axes.xaxis, self.west, self.east, "EW"),
            (axes.yaxis, self.south, self.north, "NS"),
        ):
            step = next((s for s in _STEPS if (high - low) / s <= 8.0), _STEPS[-1])
            axis.set_ticks(np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step)
            axis.set_major_formatter(lambda value, _, names=letters: degree_label(value, names))
        axes.minorticks_off()
        axes.tick_params(labelsize=7)
        axes.grid(color="#22303c", alpha=0.18, lw=0.5)

    def draw_scale(self, axes: Any) -> None:
        """Draw a bar of so many nautical miles, true at the latitude where it stands."""
        lat = self.south + 0.04 * (self.north - self.south)
        mile = NAUTICAL_MILE / METRES_PER_DEGREE / max(0.02, math.cos(math.radians(lat)))
        room = 0.25 * (self.east - self.west)
        length = max((s for s in _SCALES if s * mile <= room), default=_SCALES[0])
        west = self.west + 0.03 * (self.east - self.west)
        box = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 1.5}
        axes.plot(
            [west, west + length * mile], [lat, lat], color="#22303c", lw=2.5, zorder=9,
            solid_capstyle="butt",
        )  # fmt: skip
        where = f" at {degree_label(round(lat), 'NS')}" if self.north - self.south > 3.0 else ""
        axes.annotate(
            f"{length} nm{where}", (west, lat), xytext=(0, 4), textcoords="offset points",
            fontsize=7, zorder=9, bbox=box,
        )  # fmt: skip


def mercator(lat: Any) -> np.ndarray:
    """Return the ordinates of latitudes [deg] in Mercator's projection of a sphere [deg]."""
    phi = np.radians(np.clip(np.asarray(lat, float), -89.5, 89.5))
    return np.asarray(np.degrees(np.arcsinh(np.tan(phi))))


def inverse_mercator(ordinate: Any) -> np.ndarray:
    """Return the latitudes [deg] of ordinates in Mercator's projection [deg]."""
    return np.asarray(np.degrees(np.arctan(np.sinh(np.radians(np.asarray(ordinate, float))))))


def degree_label(value: float, letters: str) -> str:
    """Return a latitude (``letters`` NS) or a longitude (EW) with degrees and minutes."""
    if letters == "EW":
        value = float(wrap_longitude(value))
    minutes = round(abs(value) * 600.0) / 10.0
    letter = "" if minutes in (0.0, 10_800.0) else letters[0] if value >= 0 else letters[1]
    degrees, rest = divmod(minutes, 60.0)
    return f"{degrees:.0f}°" + (f"{rest:02.3g}'" if rest else "") + letter
