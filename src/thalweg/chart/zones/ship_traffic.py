"""Traffic of other ships: rates of encounters from a density raster or from zones.

A raster holds ships per square kilometre by position, and perhaps by month and hour (UTC). A
GeoJSON feature has one of the properties ``encounters_per_h``, ``encounters_per_nm`` and
``ships_per_km2``, and perhaps ``name``, ``months`` (1 to 12) and ``hours`` (0 to 23, UTC) in which
it holds. Water without a zone and a value of the raster is unknown, unless the collection has a
member ``elsewhere`` with such a property.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import shortened_repr, to_number
from thalweg.core.time import to_datetime64
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE

#: Ships that pass nearer than half of this are encounters [m].
ENCOUNTER_WIDTH: Final = 1.0 * NAUTICAL_MILE
TRAFFIC_SPEED: Final = 10.0 * KNOT  #: of the other ships [m/s]
TRAFFIC_RATES: Final = ("encounters_per_h", "encounters_per_nm", "ships_per_km2")
SQUARE_KILOMETRE: Final = 1e6  #: [m2]


def mean_relative_speed(speed: ArrayLike, traffic_speed: float = TRAFFIC_SPEED) -> FloatArray:
    r"""Return the mean speed of a ship relative to others that sail in all directions alike.

    .. math:: \bar v = \frac{1}{2\pi} \int_0^{2\pi} \sqrt{v^2 + u^2 - 2 v u \cos\theta}\, d\theta
              = \frac{2}{\pi} (v + u)\, E\!\left(\frac{4 v u}{(v + u)^2}\right)

    with the complete elliptic integral of the second kind E of the parameter m.

    Parameters
    ----------
    speed : array_like
        Speed over ground v [m/s].
    traffic_speed : float
        Speed of the others u [m/s].

    Returns
    -------
    float64 array
        [m/s].
    """
    from scipy.special import ellipe

    v = np.asarray(speed, float)
    total = v + traffic_speed
    with np.errstate(divide="ignore", invalid="ignore"):
        m = np.where(total > 0.0, 4.0 * v * traffic_speed / total**2, 0.0)
    return np.asarray(2.0 / math.pi * total * ellipe(np.minimum(m, 1.0)))


@dataclass(frozen=True)
class TrafficRate:
    """A rate of encounters: per second, per metre, and a density of ships [1/m2]; they add up."""

    per_second: float = 0.0
    per_metre: float = 0.0
    density: float = 0.0

    @classmethod
    def of_properties(cls, given: Mapping[str, Any]) -> TrafficRate:
        """Return the rate that the properties of a feature state.

        Raises
        ------
        InputError
            If there is not exactly one, or it is not a number of zero or more.
        """
        stated = [name for name in TRAFFIC_RATES if name in given]
        value = to_number(given[stated[0]]) if len(stated) == 1 else math.nan
        if not (math.isfinite(value) and value >= 0.0):
            raise InputError(
                f"A traffic zone{named_text(given)} has the properties "
                f"{shortened_repr(dict(given))}.",
                f"It has one of {', '.join(TRAFFIC_RATES)}, a number of zero or more.",
                "Give the zone such a rate.",
                field="traffic",
            )
        rates = {
            "encounters_per_h": cls(per_second=value / HOUR),
            "encounters_per_nm": cls(per_metre=value / NAUTICAL_MILE),
            "ships_per_km2": cls(density=value / SQUARE_KILOMETRE),
        }
        return rates[stated[0]]

    def at_speed(self, speed: FloatArray) -> FloatArray:
        """Return encounters per second of a ship at a speed over ground [m/s]."""
        meeting = self.density * ENCOUNTER_WIDTH * mean_relative_speed(speed)
        return np.asarray(self.per_second + self.per_metre * speed + meeting)


@dataclass(frozen=True, eq=False)
class TrafficZone:
    """An area with a rate of encounters, in some months and hours (UTC)."""

    name: str
    shape: Any
    rate: TrafficRate
    months: tuple[int, ...]
    hours: tuple[int, ...]

    def covers(
        self, lat: FloatArray, lon: FloatArray, month: IntArray, hour: IntArray
    ) -> BoolArray:
        """Return which positions [deg] are inside, in these months and hours."""
        import shapely

        inside = np.zeros(len(lat), bool)
        for turn in (-360.0, 0.0, 360.0):
            inside |= shapely.contains_xy(self.shape, lon + turn, lat)
        return np.asarray(inside & np.isin(month, self.months) & np.isin(hour, self.hours))


@dataclass(frozen=True, eq=False)
class TrafficGrid:
    """Density of ships in cells: values (months, hours, lat, lon) [1/m2]; NaN unknown.

    Axes of months and hours of length 1 hold for all.
    """

    name: str
    lat: FloatArray
    lon: FloatArray
    values: FloatArray

    def at(self, lat: FloatArray, lon: FloatArray, month: IntArray, hour: IntArray) -> FloatArray:
        """Return the density of the cells that hold positions [deg]; NaN outside."""
        row, inside = _cells(self.lat, lat)
        offset = np.mod(lon - (self.lon[0] - 180.0), 360.0) + self.lon[0] - 180.0
        offset = np.where(offset < self.lon[0] - _half_step(self.lon), offset + 360.0, offset)
        column, within = _cells(self.lon, offset)
        month = np.minimum(month - 1, self.values.shape[0] - 1)
        hour = np.minimum(hour, self.values.shape[1] - 1)
        found = self.values[month, hour, row, column]
        return np.asarray(np.where(inside & within, found, math.nan))


@dataclass(frozen=True, eq=False)
class ShipTraffic:
    """Where other ships are met, and how often.

    Attributes
    ----------
    zones : tuple of TrafficZone
        Where they overlap the greatest rate counts; they come before the grids.
    grids : tuple of TrafficGrid
        The first with a value counts.
    elsewhere : TrafficRate, optional
        In all other water; without it the rate there is unknown.
    """

    zones: tuple[TrafficZone, ...] = ()
    grids: tuple[TrafficGrid, ...] = ()
    elsewhere: TrafficRate | None = None

    def rate(self, lat: ArrayLike, lon: ArrayLike, time: ArrayLike, speed: ArrayLike) -> FloatArray:
        """Return the expected encounters per second.

        Parameters
        ----------
        lat, lon : array_like (n,)
            Positions [deg].
        time : array_like (n,)
            [s since 1970].
        speed : array_like (n,)
            Over ground [m/s].

        Returns
        -------
        float64 array (n,)
            Density times `ENCOUNTER_WIDTH` times `mean_relative_speed`, or the rate of the zone;
            NaN where it is not known.
        """
        arrays = (np.asarray(x, float).reshape(-1) for x in (lat, lon, time, speed))
        y, x, when, v = np.broadcast_arrays(*arrays)
        found = np.full(y.shape, math.nan)
        if self.elsewhere is not None:
            found = self.elsewhere.at_speed(v)
        known = np.isfinite(y + x + when + v)
        month, hour = months_and_hours(np.where(known, when, 0.0))
        meeting = ENCOUNTER_WIDTH * mean_relative_speed(np.where(known, v, 0.0))
        for grid in reversed(self.grids):
            density = grid.at(y, x, month, hour)
            found = np.where(np.isfinite(density), density * meeting, found)
        dense = np.full(y.shape, -math.inf)
        for zone in self.zones:
            inside = zone.covers(y, x, month, hour)
            dense = np.where(inside, np.fmax(dense, zone.rate.at_speed(v)), dense)
        found = np.where(np.isfinite(dense), dense, found)
        return np.where(known, found, math.nan)

    def in_zones(self, lat: FloatArray, lon: FloatArray, time: FloatArray) -> BoolArray:
        """Return which positions [deg] are inside a zone at a time [s since 1970]."""
        month, hour = months_and_hours(np.where(np.isfinite(time), time, 0.0))
        inside = np.zeros(len(lat), bool)
        for zone in self.zones:
            inside |= zone.covers(lat, lon, month, hour)
        return inside

    def joined(self, other: ShipTraffic) -> ShipTraffic:
        """Return this traffic and another's; the rate elsewhere is the first that is known."""
        elsewhere = self.elsewhere if self.elsewhere is not None else other.elsewhere
        return ShipTraffic(self.zones + other.zones, self.grids + other.grids, elsewhere)

    def fingerprint(self) -> str:
        """Return a short digest of zones and grids."""
        digest = hashlib.sha256(repr(self.elsewhere).encode())
        for zone in self.zones:
            text = f"{zone.name} {zone.rate} {zone.months} {zone.hours} {zone.shape.wkb_hex}"
            digest.update(text.encode())
        for grid in self.grids:
            for array in (grid.lat, grid.lon, grid.values):
                digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()[:16]


def months_and_hours(time: FloatArray) -> tuple[IntArray, IntArray]:
    """Return the month (1 to 12) and the hour (0 to 23) of times [s since 1970], UTC."""
    stamps = np.asarray(to_datetime64(time))
    month = stamps.astype("datetime64[M]").astype(np.int64) % 12 + 1
    hour = stamps.astype("datetime64[h]").astype(np.int64) % 24
    return month, hour


def _half_step(axis: FloatArray) -> float:
    return 0.5 * float(np.median(np.diff(axis)))


def _cells(axis: FloatArray, at: FloatArray) -> tuple[IntArray, BoolArray]:
    """Return the cell of each coordinate, by nearest middle, and whether it is inside the axis."""
    middles = 0.5 * (axis[1:] + axis[:-1])
    half = _half_step(axis)
    inside = (at >= axis[0] - half) & (at <= axis[-1] + half)
    return np.searchsorted(middles, at), inside


def named_text(given: Mapping[str, Any]) -> str:
    """Return the name of a feature for a message; empty without one."""
    return f" {str(given['name'])[:60]!r}" if given.get("name") else ""
