"""`PlanData`: the routes found, their proof, and what is needed to repeat the plan."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from thalweg.core.file_writing import write_text
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.objective import Objective
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.planning.plan_front import ParetoFront
from thalweg.planning.voyage import Voyage
from thalweg.route import Route


@dataclass(frozen=True)
class Proof:
    """The lower bound of the objective, and the total of the search.

    Attributes
    ----------
    certain : float
        Lower bound of the objective that holds for every route in open water [its unit]; NaN
        where there is none.
    kind : str
        How the bound was found and what it counts; why there is none.
    solver_total : float
        Total of the search on the network, before refinement and referee.
    """

    certain: float
    kind: str
    solver_total: float


@dataclass(frozen=True)
class PlotContext:
    """Data of the plots: arrival times over the network, chart, sea and ship.

    Attributes
    ----------
    lat, lon : ndarray (n,)
        Nodes of the networks [deg].
    arrival : ndarray (n,)
        Earliest arrival at the nodes [s since 1970]; inf where not reached.
    stages : tuple of (int, float)
        Of each stage of a voyage with via points: how many of the nodes are its own, and when the
        route reaches its end [s since 1970]; empty without via points.
    """

    lat: np.ndarray
    lon: np.ndarray
    arrival: np.ndarray
    chart: Any
    sea: Any
    ship: Any
    stages: tuple[tuple[int, float], ...] = ()


@dataclass(frozen=True)
class PlanData:
    """The answer to a voyage, as data; `thalweg.planning.plan.Plan` also plots and writes it.

    Attributes
    ----------
    voyage : The request.
    routes : The routes found, each scored by the referee; the first is the best.
    proof : The lower bound and the solver's own total.
    rejections : mapping of str to int
        Number of legs rejected, by reason.
    notes : Assumptions and warnings for the user.
    provenance : mapping
        What is needed to repeat the plan: version, data fingerprints, ship, network, seed.
    plot_context : For plots; not part of the JSON.
    front : ParetoFront, optional
        Time against fuel, energy, cost or CO2, for objectives with a choice of speed. Its points
        are `routes`; with the objective ``"front"`` they are in order of time.
    ensemble : tuple of mappings
        With an ensemble forecast: the distribution of each route over the members.
    cancelled : Whether Ctrl-C ended planning: the routes are the best so far, as the notes state.
    passage_alternatives : tuple of mappings
        Other ways by distance, where they were asked for (`thalweg.planning.plan.Plan`).
    """

    voyage: Voyage
    routes: tuple[Route, ...]
    proof: Proof
    rejections: Mapping[str, int]
    notes: tuple[str, ...]
    provenance: Mapping[str, Any]
    plot_context: PlotContext | None = field(default=None, repr=False, compare=False)
    front: ParetoFront | None = None
    ensemble: tuple[Mapping[str, Any], ...] = ()
    cancelled: bool = False
    passage_alternatives: tuple[Mapping[str, Any], ...] = ()

    @property
    def best(self) -> Route:
        """The best route."""
        return self.routes[0]

    @property
    def objective_value(self) -> float:
        """Value of the best route as scored by the referee, in `unit`.

        With the objective ``"front"`` the hours of the fastest route; the other points are in
        `front`.
        """
        return self.objective.value(self.best)

    @property
    def unit(self) -> str:
        """The unit of the objective: ``"h"``, ``"nm"``, ``"t"``, ``"MWh"`` or the currency."""
        return self.objective.unit

    @property
    def objective(self) -> Objective:
        """What the plan minimises, with its prices; the time for the objective ``"front"``."""
        name: str = self.voyage.objective
        if name == "weighted" and self.front is not None and self.front.objective is not None:
            return self.front.objective
        currency = "USD" if self.front is None else self.front.unit
        return Objective.of("time" if name == "front" else name, currency=currency)

    @property
    def lower_bound(self) -> float:
        """Lower bound of the objective, in `unit`; NaN where there is none."""
        return self.proof.certain

    @property
    def solver_total(self) -> float:
        """The total of the search on its network, in `unit`."""
        return self.proof.solver_total

    @property
    def gap(self) -> float:
        """Excess of the best route over the lower bound, as a fraction of its value.

        NaN without a bound. A bound above the value, beyond the tolerance of the referee, is an
        error of the program.
        """
        value = self.objective_value
        if not (math.isfinite(value) and math.isfinite(self.lower_bound)):
            return math.nan
        if value <= 0.0:
            return 0.0
        gap = (value - self.lower_bound) / value
        known = self._referee_share
        assert gap >= -known, f"bound {self.lower_bound} above the value {value} {self.unit}"
        return max(gap, 0.0)

    @property
    def _referee_share(self) -> float:
        """Tolerance of the referee, as a share of the value."""
        best = self.best
        share = best.tolerance_s / HOUR / best.time_h if best.time_h > 0.0 else 0.0
        return 1e-6 + (share if math.isfinite(share) else 0.0)

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as plain data, ready for JSON (unknown numbers are None)."""
        more: dict[str, Any] = {"cancelled": True} if self.cancelled else {}
        if self.passage_alternatives:
            more["passage_alternatives"] = [dict(row) for row in self.passage_alternatives]
        if self.ensemble:
            more["ensemble"] = [dict(row) for row in self.ensemble]
        if self.front is not None:
            more["front"] = self.front.as_dict(self.routes)
            if self.front.comparison is not None:
                more["comparison"] = [dict(row) for row in self.front.comparison.rows]
        return {
            "voyage": self.voyage.to_dict(),
            "objective": self.voyage.objective,
            "objective_unit": self.unit,
            "routes": [route_dict(route, self.voyage.objective) for route in self.routes],
            "lower_bound": finite_or_none(self.lower_bound),
            "lower_bound_kind": self.proof.kind,
            "lower_bound_certain": finite_or_none(self.proof.certain),
            "gap": finite_or_none(self.gap),
            "solver_total": finite_or_none(self.solver_total),
            "rejections": dict(self.rejections),
            "notes": list(self.notes),
            **more,
            "provenance": dict(self.provenance),
        }

    def to_json(self, path: str | Path | None = None) -> str:
        """Return the plan as JSON text.

        Parameters
        ----------
        path : path, optional
            Where to write it as well.
        """
        text = json.dumps(self.to_dict(), indent=2, allow_nan=False)
        if path is not None:
            write_text(path, text + "\n")
        return text


def route_dict(route: Route, objective: str) -> dict[str, Any]:
    """Return one refereed route as plain data with the units in the names."""
    return {
        "objective": objective,
        "depart": format_time(route.depart),
        "arrive": format_time(route.arrive),
        "time_h": finite_or_none(route.time_h),
        "distance_nm": finite_or_none(route.distance_nm),
        "fuel_t": finite_or_none(route.fuel_t),
        "energy_mwh": finite_or_none(route.energy_mwh),
        "co2_t": finite_or_none(route.co2_t),
        route.cost_name: finite_or_none(route.cost),
        **route.pricing_dict(),
        "engine_order": route.engine_order,
        "fuel_eca_t": finite_or_none(route.fuel_eca_t),
        "waiting_h": finite_or_none(route.waiting_h),
        "min_ukc_m": finite_or_none(route.min_ukc_m),
        "referee_tolerance_h": finite_or_none(route.tolerance_s / HOUR),
        "feasible": route.feasible,
        "violations": [violation.as_dict() for violation in route.violations],
        "indicators": route.indicators,
        "waypoints": route.waypoints(),
    }


def in_objective_unit(value: float, objective: str) -> float:
    """Convert seconds or metres to the unit of an objective."""
    return value / (NAUTICAL_MILE if objective == "distance" else HOUR)
