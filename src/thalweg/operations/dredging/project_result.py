"""Result of a dredging project: runs, totals, and the table of van Halem's study."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.chart.chart import control_areas_in_force
from thalweg.core.file_writing import write_text
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.time import duration_text
from thalweg.core.units import DAY, TONNE
from thalweg.operations.dredging.cycle_records import DredgingCycle, SailedLeg, cycle_record
from thalweg.operations.dredging.project import Project
from thalweg.planning.report.squat_report import SQUAT_UNCOUNTED, water_left_text
from thalweg.planning.report.waiting_report import WAITS, waiting_weather_texts
from thalweg.ship import Ship

if TYPE_CHECKING:
    from thalweg.operations.dredging.project_environment import ProjectEnvironment

WEEK = 7.0 * DAY
_ROUNDING = 0.005  # clearances are written to so much [m]
_SHORT = 2.0  # [d]: durations below it are written to the minute


def _days_text(days: float) -> str:
    """Return a duration to the hour, or to the minute for a short one."""
    if days < _SHORT:
        return duration_text(days * DAY)
    return "{} d {} h".format(*divmod(round(24 * days), 24))


#: Rows of the table: key, label, format.
TABLE_ROWS = (
    ("production_m3_week", "production [1000 m3/week]", lambda v: f"{v / 1000:.1f}"),
    ("duration_days", "duration", _days_text),
    ("cycles", "cycles", lambda v: f"{v:d}"),
    ("distance_m", "sailed distance [1000 km]", lambda v: f"{v / 1e6:.2f}"),
    ("mean_load_factor", "mean load factor", lambda v: f"{v:.2f}"),
    ("loading_share", "time loading", lambda v: f"{100 * v:.0f} %"),
    ("unloading_share", "time unloading", lambda v: f"{100 * v:.0f} %"),
    ("sailing_full_share", "time sailing full", lambda v: f"{100 * v:.0f} %"),
    ("sailing_empty_share", "time sailing empty", lambda v: f"{100 * v:.0f} %"),
    ("waiting_share", "of which waiting", lambda v: f"{100 * v:.1f} %"),
    ("least_clearance_m", "least clearance [m]", lambda v: f"{v:.2f}"),
    ("least_clearance_with_squat_m", "least clearance with squat [m]", lambda v: f"{v:.2f}"),
    ("energy_gj", "energy [GJ]", lambda v: f"{v:,.0f}"),
    ("hotel_gj", "of which hotel load [GJ]", lambda v: f"{v:,.0f}"),
    ("fuel_t", "fuel [t]", lambda v: f"{v:,.1f}"),
    ("co2_t", "CO2 [t]", lambda v: f"{v:,.1f}"),
    ("co2_kg_m3", "CO2 per volume [kg/m3]", lambda v: f"{v:.2f}"),
    ("cost", "cost of time and propulsion", lambda v: f"{v:,.0f}"),
    ("currency", "currency of the cost", str),
    ("production_gain", "gain in production", lambda v: f"{100 * v:+.0f} %"),
    ("time_saved", "time saved", lambda v: f"{100 * v:+.0f} %"),
    ("distance_saved", "distance saved", lambda v: f"{100 * v:+.0f} %"),
)


@dataclass(frozen=True, eq=False)
class ProjectRun:
    """The project sailed to its end with one strategy.

    Attributes
    ----------
    name : str
    cycles : tuple of DredgingCycle
    totals : mapping of str to float or None
        By the keys of `TABLE_ROWS`; None where unknown.
    notes : tuple of str
    """

    name: str
    cycles: tuple[DredgingCycle, ...]
    totals: Mapping[str, float | int | None]
    notes: tuple[str, ...] = ()

    @property
    def feasible(self) -> bool:
        """Whether the referee finds no limit broken on any leg."""
        return all(leg.route.feasible for cycle in self.cycles for leg in cycle.legs)


@dataclass(frozen=True, eq=False)
class ProjectResult:
    """A project with the optimised run and the base case.

    Attributes
    ----------
    project : Project
        The definition of the project.
    environment : ProjectEnvironment
        Ship, sea and chart.
    optimised : ProjectRun
    base : ProjectRun or None
    provenance : mapping
    """

    project: Project
    environment: ProjectEnvironment
    optimised: ProjectRun
    base: ProjectRun | None = None
    provenance: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def runs(self) -> tuple[ProjectRun, ...]:
        """The base case, if there is one, and the optimised project."""
        return (self.optimised,) if self.base is None else (self.base, self.optimised)

    def gains(self) -> dict[str, float]:
        """Return the gains over the base case.

        Returns
        -------
        dict of str to float
            ``production_gain``, ``time_saved`` and ``distance_saved``, as shares of the
            base case; empty without one.
        """
        if self.base is None:
            return {}
        old, new = self.base.totals, self.optimised.totals

        def ratio(key: str) -> float:
            return float(new[key] or 0.0) / float(old[key] or math.nan)

        return {
            "production_gain": ratio("production_m3_week") - 1.0,
            "time_saved": 1.0 - ratio("duration_days"),
            "distance_saved": 1.0 - ratio("distance_m"),
        }

    def table(self) -> list[list[str]]:
        """Return the table of van Halem (2019), Table 5.1, as text.

        Returns
        -------
        list of list of str
            A header, then a row for each quantity that is known.
        """
        columns = [dict(run.totals) for run in self.runs]
        columns[-1].update(self.gains())
        rows = [["", *(run.name for run in self.runs)]]
        for key, label, text_of in TABLE_ROWS:
            values = [column.get(key) for column in columns]
            if any(value is not None for value in values):
                rows.append([label, *("" if v is None else text_of(v) for v in values)])
        return rows

    def as_dict(self) -> dict[str, Any]:
        """Return the result as plain data for JSON.

        Returns
        -------
        dict
            ``project``, ``runs`` by name, ``gains``, ``prices`` of the cost with their sources, and
            ``provenance``.
        """
        return {
            "project": self.project.to_dict(),
            "runs": {run.name: _run_data(run) for run in self.runs},
            "gains": self.gains(),
            "prices": self.environment.ship.fuel_terms.prices(),
            "provenance": dict(self.provenance),
        }

    def to_json(self, path: str | Path | None = None) -> str:
        """Return the result as JSON, and write it if a path is given.

        Parameters
        ----------
        path : path-like, optional
            File to write; a file of that name is replaced.

        Returns
        -------
        str
            JSON text of `as_dict`.
        """
        text = json.dumps(self.as_dict(), indent=2, allow_nan=False)
        if path is not None:
            write_text(path, text + "\n")
        return text


def summarise_run(
    name: str,
    cycles: list[DredgingCycle],
    *,
    project: Project,
    ship: Ship,
    required: float = 0.0,
    notes: tuple[str, ...] = (),
) -> ProjectRun:
    """Return a run with the totals of its cycles.

    Parameters
    ----------
    required : Least clearance under the keel [m].
    """
    duration = cycles[-1].end - cycles[0].start
    legs = [leg for cycle in cycles for leg in cycle.legs]
    volume = sum(cycle.volume for cycle in cycles)
    shares = {
        "loading_share": sum(c.loading for c in cycles),
        "unloading_share": sum(c.unloading for c in cycles),
        "sailing_full_share": sum(c.out.duration for c in cycles),
        "sailing_empty_share": sum(c.back.duration for c in cycles),
        "waiting_share": sum(c.waiting for c in cycles),
    }
    totals: dict[str, Any] = {
        "production_m3_week": volume / duration * WEEK,
        "volume_m3": volume,
        "duration_days": duration / DAY,
        "cycles": len(cycles),
        "distance_m": sum(leg.distance for leg in legs),
        "mean_load_factor": volume / (len(cycles) * project.work.hopper),
        **{key: value / duration for key, value in shares.items()},
        "least_clearance_m": finite_or_none(float(np.min([leg.clearance for leg in legs]))),
        "least_clearance_with_squat_m": finite_or_none(
            float(np.fmin.reduce([leg.clearance_with_squat for leg in legs]))
        ),
        **_energy_and_fuel(cycles, project, ship),
    }
    broken = sum(not leg.route.feasible for leg in legs)
    if broken:
        notes += (f"The referee finds a limit broken on {broken} of {len(legs)} legs.",)
    notes += _waiting_notes(name, cycles, ship) + _squat_notes(name, legs, required)
    return ProjectRun(name, tuple(cycles), MappingProxyType(totals), notes)


def _waiting_notes(name: str, cycles: list[DredgingCycle], ship: Ship) -> tuple[str, ...]:
    """Return a note where the ship waits at sea in weather above her limits, or unknown."""
    found = [
        (leg.waiting, f"cycle {cycle.number}, {texts[0]}")
        for cycle in cycles
        for leg in cycle.legs
        if (texts := waiting_weather_texts(leg.route, ship))
    ]
    if not found:
        return ()
    return (
        f"{WAITS} on {len(found)} of {2 * len(cycles)} legs ({name}) in weather above the limits "
        f"of the ship, or unknown; the longest: {max(found)[1]}. Weather is checked under way "
        "only. Wait at the site in place of the open sea: then the cycle ends later, and the "
        "production is lower.",
    )


def _squat_notes(name: str, legs: list[SailedLeg], required: float) -> tuple[str, ...]:
    """Return a note where squat takes the clearance below the required one [m]."""
    left = [leg.clearance_with_squat for leg in legs]
    short = sum(clearance < required - _ROUNDING for clearance in left)
    if not short:
        return ()
    least = (f", less than the {required:g} m required" if required > 0.0 else "") + "."
    return (
        f"{SQUAT_UNCOUNTED}: with squat, {water_left_text(float(np.fmin.reduce(left)))} on "
        f"{short} of {len(legs)} legs ({name}){least} The production is that of a ship that does "
        "not squat. Give 'models: {squat: barrass_2004}' in the ship file, and she goes slower or "
        "waits there; or ask for more clearance (min_ukc_m).",
    )


def _energy_and_fuel(cycles: list[DredgingCycle], project: Project, ship: Ship) -> dict[str, Any]:
    """Return energy, fuel, CO2 and cost; None where the ship file lacks data."""
    hotel = ship.hotel_power * (cycles[-1].end - cycles[0].start)
    at_work = sum(cycle.site_fuel for cycle in cycles)
    energy, fuel = (sum(getattr(cycle, x) for cycle in cycles) for x in ("energy", "fuel"))
    co2 = at_work * ship.fuel_terms.carbon_outside + sum(leg.co2 for c in cycles for leg in c.legs)
    volume = sum(c.volume for c in cycles)
    return {
        "energy_gj": finite_or_none(energy / 1e9),
        "hotel_gj": None if math.isnan(energy) else finite_or_none(hotel / 1e9),
        "fuel_t": finite_or_none(fuel / TONNE),
        "co2_t": finite_or_none(co2 / TONNE),
        "co2_kg_m3": finite_or_none(co2 / volume),
        "cost": finite_or_none(_cost(cycles, project, ship, at_work)),
        "currency": ship.fuel_terms.currency or "USD",
    }


def _cost(cycles: list[DredgingCycle], project: Project, ship: Ship, at_work: float) -> float:
    """Return the cost of time and of fuel, sailing and at work; NaN if a price is not known.

    Where fuel has no price but speed has, sailing counts lambda_f t V^3 (van Halem 2019), and work
    at a site counts by its time alone. ``at_work`` is the fuel burnt at the sites [kg]; half of it
    is taken as burnt at each.
    """
    terms = ship.fuel_terms
    if not terms.any_price:
        return math.nan
    total = terms.time_price * (cycles[-1].end - cycles[0].start)
    if terms.by_speed or not math.isnan(terms.price_outside):
        legs = [leg for cycle in cycles for leg in cycle.legs]
        total += sum(float(leg.route.legs["cost_of_fuel"].sum()) for leg in legs)
    if not terms.by_speed and at_work > 0.0 and not math.isnan(terms.price_outside):
        areas = control_areas_in_force()
        inside = areas.in_eca(*np.transpose([project.sites.load, project.sites.unload]))
        total += float(terms.of_fuel("cost", at_work, float(inside.mean()))[0])
    return float(total)


def _run_data(run: ProjectRun) -> dict[str, Any]:
    return {
        "totals": dict(run.totals),
        "feasible": run.feasible,
        "notes": list(run.notes),
        "cycles": [cycle_record(cycle) for cycle in run.cycles],
    }
