"""`PlanData`: the routes found, their proof, and what is needed to repeat the plan."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from thalweg.core.objective import Objective
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.planning.pareto.plan_front import ParetoFront
from thalweg.planning.voyage import Voyage
from thalweg.route import Route


@dataclass(frozen=True)
class Proof:
    """How good the answer is.

    Attributes
    ----------
    lower_bound : float
        No route is better than this, in the objective's unit (h or nm).
    kind : str
        How the bound was found, and what it rests on.
    certain : float
        The bound in free space, which holds whatever the network: the geodesic at the greatest
        speed over ground in the data.
    solver_total : float
        What the search on the network said, before refinement and before the referee.
    """

    lower_bound: float
    kind: str
    certain: float
    solver_total: float


@dataclass(frozen=True)
class PlotContext:
    """What the pictures need: the arrival times over the network, the chart, the sea and ship."""

    lat: np.ndarray
    lon: np.ndarray
    arrival: np.ndarray
    chart: Any
    sea: Any
    ship: Any


@dataclass(frozen=True)
class PlanData:
    """The answer to a voyage, as data; `thalweg.planning.plan.Plan` also plots and writes it.

    Attributes
    ----------
    voyage : Voyage
        What was asked.
    routes : tuple of Route
        The routes found, each scored by the referee; the first is the best.
    proof : Proof
        The lower bound and the solver's own total.
    rejections : mapping of str to int
        How many legs were refused, for each reason.
    notes : tuple of str
        Assumptions and warnings the user must know.
    provenance : mapping
        What is needed to repeat the plan: version, data fingerprints, ship, network, seed.
    plot_context : Surroundings
        For drawing; not part of the JSON.
    front : FrontOfPlan, optional
        The trade of time for fuel, energy, cost or CO2, where one was asked; its routes are all of
        `routes` when the whole front was asked, ordered by time.
    ensemble : tuple of mappings
        With a forecast of several members: how each of the routes fares over them.
    cancelled : bool
        Whether it was stopped by Ctrl-C: the routes are the best so far; the notes tell more.
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
        return self._objective.value(self.best)

    @property
    def unit(self) -> str:
        """The unit of the objective: ``"h"``, ``"nm"``, ``"t"``, ``"MWh"`` or the currency."""
        return self._objective.unit

    @property
    def _objective(self) -> Objective:
        name: str = self.voyage.objective
        currency = "USD" if self.front is None else self.front.unit
        return Objective.of("time" if name == "front" else name, currency=currency)

    @property
    def lower_bound(self) -> float:
        """No route is better than this, in `unit`."""
        return self.proof.lower_bound

    @property
    def solver_total(self) -> float:
        """The total of the search on its network, in `unit`."""
        return self.proof.solver_total

    @property
    def gap(self) -> float:
        """How far from the best possible the answer may be, as a fraction of its own value."""
        value = self.objective_value
        return max(0.0, (value - self.lower_bound) / value) if value > 0 else 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as plain data, ready for JSON (unknown numbers are None)."""
        more: dict[str, Any] = {"cancelled": True} if self.cancelled else {}
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
            "lower_bound": _finite_or_none(self.lower_bound),
            "lower_bound_kind": self.proof.kind,
            "lower_bound_certain": _finite_or_none(self.proof.certain),
            "gap": _finite_or_none(self.gap),
            "solver_total": _finite_or_none(self.solver_total),
            "rejections": dict(self.rejections),
            "notes": list(self.notes),
            **more,
            "provenance": dict(self.provenance),
        }

    def to_json(self, path: str | Path | None = None) -> str:
        """Return the plan as JSON text, and write it to a file when a path is given."""
        text = json.dumps(self.to_dict(), indent=2, allow_nan=False)
        if path is not None:
            Path(path).write_text(text + "\n", encoding="utf-8")
        return text


def route_dict(route: Route, objective: str) -> dict[str, Any]:
    """Return one refereed route as plain data with the units in the names."""
    return {
        "objective": objective,
        "depart": format_time(route.depart),
        "arrive": format_time(route.arrive),
        "time_h": _finite_or_none(route.time_h),
        "distance_nm": _finite_or_none(route.distance_nm),
        "fuel_t": _finite_or_none(route.fuel_t),
        "energy_mwh": _finite_or_none(route.energy_mwh),
        "co2_t": _finite_or_none(route.co2_t),
        route.cost_name: _finite_or_none(route.cost),
        "fuel_eca_t": _finite_or_none(route.fuel_eca_t),
        "waiting_h": _finite_or_none(route.waiting_h),
        "min_ukc_m": _finite_or_none(route.min_ukc_m),
        "referee_tolerance_h": _finite_or_none(route.tolerance_s / HOUR),
        "feasible": route.feasible,
        "violations": [violation.as_dict() for violation in route.violations],
        "waypoints": route.waypoints(),
    }


def in_objective_unit(value: float, objective: str) -> float:
    """Turn seconds or metres into the unit of an objective."""
    return value / (NAUTICAL_MILE if objective == "distance" else HOUR)


def _finite_or_none(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else float(value)
