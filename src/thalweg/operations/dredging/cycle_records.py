"""Cycles of a dredging project, with legs evaluated by the referee."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.given_numbers import finite_or_none
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE, TONNE
from thalweg.route import Route

if TYPE_CHECKING:
    from thalweg.operations.dredging.project_parts import WorkScope
    from thalweg.ship import Ship

_PRIME_MOVER_SFOC = 195.0  # g/kWh, medium-speed Diesel; default without a value in the ship file


@dataclass(frozen=True, eq=False)
class SailedLeg:
    """One leg between the sites.

    Attributes
    ----------
    route : As evaluated by the referee.
    energy : Brake energy, without hotel load [J]; NaN if the ship's power is unknown.
    clearance_with_squat : Least under-keel clearance, squat taken off [m]; NaN where no depth is
        known, and for ships whose squat limits their speed.
    """

    route: Route
    energy: float
    clearance_with_squat: float = math.nan

    @property
    def depart(self) -> float:
        """Time at which the ship is ready to leave [s since 1970-01-01T00:00Z]."""
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
        """Waiting time at waypoints [s]."""
        return self.route.waiting_h * HOUR

    @property
    def distance(self) -> float:
        """Length of the route [m]."""
        return self.route.distance_nm * NAUTICAL_MILE

    @property
    def clearance(self) -> float:
        """Least under-keel clearance [m]; NaN where no depth is known."""
        least = self.route.min_ukc_m
        return math.nan if least is None else least

    @property
    def fuel(self) -> float:
        """Fuel, waits and hotel load included [kg]; NaN if unknown."""
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
    number : From 1.
    start : Start of loading [s since 1970-01-01T00:00Z].
    volume : Volume moved [m3].
    loading, unloading : Time of work [s].
    loading_pause, unloading_pause : Pauses of that work in waves or wind over the limits [s].
    site_fuel : Of pumps and hotel load at the sites [kg].
    other_energy : Of pumps, and of the hotel load of the whole cycle [J].
    """

    number: int
    start: float
    load_factor: float
    volume: float
    loading: float
    unloading: float
    out: SailedLeg
    back: SailedLeg
    loading_pause: float = 0.0
    unloading_pause: float = 0.0
    site_fuel: float = 0.0
    other_energy: float = 0.0

    @property
    def fuel(self) -> float:
        """Fuel of the whole cycle [kg]; NaN if unknown."""
        return self.site_fuel + sum(leg.fuel for leg in self.legs)

    @property
    def energy(self) -> float:
        """Energy of propulsion, pumps and hotel load [J]; NaN if unknown."""
        return self.other_energy + sum(leg.energy for leg in self.legs)

    @property
    def pauses(self) -> float:
        """Time at the sites without work [s]."""
        return self.loading_pause + self.unloading_pause

    @property
    def waiting(self) -> float:
        """Waits on both legs, and pauses at the sites [s]."""
        return self.pauses + sum(leg.waiting for leg in self.legs)

    @property
    def end(self) -> float:
        """Time at which the ship is back at the loading site [s since 1970-01-01T00:00Z]."""
        return self.back.arrive

    @property
    def production(self) -> float:
        """Volume per time of the whole cycle [m3/s]."""
        return self.volume / (self.end - self.start)

    @property
    def legs(self) -> tuple[SailedLeg, SailedLeg]:
        """The legs out and back."""
        return self.out, self.back


def with_other_consumption(cycle: DredgingCycle, work: WorkScope, ship: Ship) -> DredgingCycle:
    """Return a cycle with what pumps and hotel load take beside the fuel of its legs.

    Parameters
    ----------
    work : With the power of loading and unloading [W].
    ship : With her hotel load; pumps burn as her engine does, or 195 g/kWh where that is unknown.
    """
    own = ship.specific_fuel_consumption
    consumption = _PRIME_MOVER_SFOC / 3.6e9 if math.isnan(own) else own  # kg/J
    pumps = cycle.loading * work.loading.power + cycle.unloading * work.unloading.power
    at_sites = cycle.loading + cycle.unloading + cycle.pauses
    return replace(
        cycle,
        site_fuel=at_sites * ship.waiting_fuel_rate + pumps * consumption,
        other_energy=pumps + ship.hotel_power * (cycle.end - cycle.start),
    )


def leg_energy(route: Route) -> float:
    """Return the brake energy of a route [J], the integral of power over the referee's samples.

    NaN if the ship's power is unknown anywhere.
    """
    power, time = route.samples["power"], route.samples["time"]
    if np.isnan(power).any():
        return math.nan
    same = np.diff(route.samples["leg"]) == 0
    return float(np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(time), where=same))


#: Columns of cycles.csv.
CYCLE_COLUMNS = (
    *("cycle", "start", "load_factor", "volume_m3", "loading_h", "sail_full", "full_h"),
    *("full_waiting_h", "full_distance_km", "full_least_clearance_m", "unloading_h", "sail_empty"),
    *("empty_h", "empty_waiting_h", "empty_distance_km", "empty_least_clearance_m", "end"),
    *("production_m3_h", "mean_speed_kn", "fuel_t", "energy_gj"),
    *("loading_pause_h", "unloading_pause_h"),
)


def cycle_record(cycle: DredgingCycle) -> dict[str, Any]:
    """Return a cycle as one row of cycles.csv, by `CYCLE_COLUMNS`."""
    data: dict[str, Any] = {
        "cycle": cycle.number,
        "start": format_time(cycle.start),
        "load_factor": cycle.load_factor,
        "volume_m3": round(cycle.volume, 3),
        "loading_h": round(cycle.loading / HOUR, 4),
        "unloading_h": round(cycle.unloading / HOUR, 4),
        "loading_pause_h": round(cycle.loading_pause / HOUR, 4),
        "unloading_pause_h": round(cycle.unloading_pause / HOUR, 4),
        "end": format_time(cycle.end),
        "production_m3_h": round(cycle.production * HOUR, 2),
    }
    for name, leg in (("full", cycle.out), ("empty", cycle.back)):
        clearance = finite_or_none(leg.clearance)
        data |= {
            f"sail_{name}": format_time(leg.depart),
            f"{name}_h": round(leg.duration / HOUR, 4),
            f"{name}_waiting_h": round(leg.waiting / HOUR, 4),
            f"{name}_distance_km": round(leg.distance / 1000.0, 3),
            f"{name}_least_clearance_m": None if clearance is None else round(clearance, 3),
        }
    sailing = sum(leg.duration - leg.waiting for leg in cycle.legs)
    fuel, energy = finite_or_none(cycle.fuel), finite_or_none(cycle.energy)
    data["mean_speed_kn"] = round(sum(leg.distance for leg in cycle.legs) / sailing / KNOT, 2)
    data["fuel_t"] = None if fuel is None else round(fuel / TONNE, 3)
    data["energy_gj"] = None if energy is None else round(energy / 1e9, 3)
    return {key: data[key] for key in CYCLE_COLUMNS}
