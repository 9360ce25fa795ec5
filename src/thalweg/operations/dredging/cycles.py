"""Cycles of a project as the referee found them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thalweg.core.units import HOUR, NAUTICAL_MILE, TONNE
from thalweg.route import Route


@dataclass(frozen=True, eq=False)
class SailedLeg:
    """One way between the sites.

    Attributes
    ----------
    route : Route
        As the referee sailed it.
    energy : float
        Brake energy under way, without hotel load [J]; NaN if the ship's power is unknown.
    """

    route: Route
    energy: float

    @property
    def depart(self) -> float:
        """When the ship is ready to leave [s since 1970-01-01T00:00Z]."""
        return self.route.depart

    @property
    def arrive(self) -> float:
        """Arrival [s since 1970-01-01T00:00Z]."""
        return self.route.arrive

    @property
    def duration(self) -> float:
        """Time from being ready to arrival [s]."""
        return self.arrive - self.depart

    @property
    def waiting(self) -> float:
        """Time lain still [s]."""
        return self.route.waiting_h * HOUR

    @property
    def distance(self) -> float:
        """Length of the way [m]."""
        return self.route.distance_nm * NAUTICAL_MILE

    @property
    def clearance(self) -> float:
        """Least under-keel clearance [m]; NaN where no depth is known."""
        least = self.route.min_ukc_m
        return math.nan if least is None else least

    @property
    def fuel(self) -> float:
        """Fuel burnt under way, waits and hotel load included [kg]; NaN if unknown."""
        tonnes = self.route.fuel_t
        return math.nan if tonnes is None else TONNE * tonnes

    @property
    def co2(self) -> float:
        """Carbon dioxide of that fuel [kg]; NaN if unknown."""
        tonnes = self.route.co2_t
        return math.nan if tonnes is None else TONNE * tonnes


@dataclass(frozen=True, eq=False)
class DredgingCycle:
    """Load, sail full, unload, sail empty.

    Attributes
    ----------
    number : int
        From 1.
    start : float
        When loading begins [s since 1970-01-01T00:00Z].
    load_factor : float
    volume : float
        Moved [m3].
    loading, unloading : float
        [s].
    out, back : Leg
    """

    number: int
    start: float
    load_factor: float
    volume: float
    loading: float
    unloading: float
    out: SailedLeg
    back: SailedLeg

    @property
    def end(self) -> float:
        """When the ship is back at the loading site [s since 1970-01-01T00:00Z]."""
        return self.back.arrive

    @property
    def production(self) -> float:
        """Volume per time of the whole cycle [m3/s]."""
        return self.volume / (self.end - self.start)

    @property
    def legs(self) -> tuple[SailedLeg, SailedLeg]:
        """Both ways."""
        return self.out, self.back


def leg_energy(route: Route) -> float:
    """Return the brake energy of a route [J]: power at the referee's samples over their time.

    NaN if the ship's power is unknown anywhere.
    """
    power, time = route.samples["power"], route.samples["time"]
    if np.isnan(power).any():
        return math.nan
    same = np.diff(route.samples["leg"]) == 0
    return float(np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(time), where=same))
