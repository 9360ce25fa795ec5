"""`ParetoFront`: the points of a trade-off, with the lower front and the baseline."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.objective import Objective
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR

if TYPE_CHECKING:
    from thalweg.route import Route


#: Earlier names of stages that saved fronts may have.
_RENAMED_STAGES = {"polish": "local search"}


_HALVINGS = 30  # of a joint gap
#: Words for the least of key figures whose names alone do not say it.
_LEAST: Final = {
    "comfort": "least motion sickness",
    "encounters": "fewest encounters",
    "inshore": "least length near land",
    "weighted": "least weighted sum",
}


@dataclass(frozen=True, eq=False)
class BaselineComparison:
    """The shortest route, sailed at constant settings through the same weather.

    Attributes
    ----------
    routes : Scored by the referee, one per setting that reaches the goal; by ascending time.
    values : Their values, in the unit of the front.
    rows : Savings of the front over each: ``saved_h`` at the same value, ``saved`` (and
        ``saved_percent``) at the same time, which is ``saved_by_route`` (knowing the weather, at a
        constant speed) plus ``saved_by_speed`` (varying the speed); None outside the range of the
        front, and for a route that breaks a limit (``feasible``).
    """

    routes: tuple[Route, ...]
    values: FloatArray
    rows: tuple[dict[str, Any], ...]


@dataclass(frozen=True, eq=False)
class ParetoFront:
    """The Pareto front of time against one other key figure, as scored by the referee.

    Attributes
    ----------
    criterion : The key figure, such as "fuel"; "weighted sum" for several.
    unit : Its unit: t, MWh, or a currency.
    values : Of the routes of the plan, in their order, (n,).
    stages : tuple of str (n,)
        Source of each route: ``"fastest"`` (refined for time), ``"exact"``,
        ``"alternative path"`` (a fixed route past other land or through other canals, with its
        best speeds), ``"one wait"`` (at one or two speeds after a wait at the start),
        ``"local search"``, the evolutionary method, or ``"constant speed"`` (of the weather-blind
        route). The earlier name ``"polish"`` is read as ``"local search"``.
    ways : tuple of str (n,)
        Label of each route: its canals, or ``"open sea"``, and the sides of land where these
        differ (`thalweg.planning.pareto.route_names.route_labels`).
    comparison : The weather-blind route in the same weather.
    certain : Times [h] and values of a front below every route, to be joined by lines, (2, m).
    objective : Objective, optional
        What the values are, with its prices.
    """

    criterion: str
    unit: str
    values: FloatArray
    stages: tuple[str, ...]
    ways: tuple[str, ...]
    comparison: BaselineComparison | None = None
    certain: FloatArray = field(default_factory=lambda: np.empty((2, 0)))
    objective: Objective | None = None

    def __post_init__(self) -> None:
        stages = tuple(_RENAMED_STAGES.get(stage, stage) for stage in self.stages)
        object.__setattr__(self, "stages", stages)

    def gaps(self, routes: tuple[Route, ...]) -> list[float | None]:
        """Return the gap of each route to the certain front at its time [fraction of its value]."""
        found: list[float | None] = []
        for route, value in zip(routes, self.values):
            low = certain_at(self.certain, route.time_h)
            known = math.isfinite(low) and value > 0
            found.append(max(0.0, (float(value) - low) / float(value)) if known else None)
        return found

    def joint_gaps(
        self, routes: tuple[Route, ...], *, least_time_h: float = 0.0
    ) -> list[float | None]:
        """Return for each route the least share by which none is better in both time and value.

        Parameters
        ----------
        least_time_h : No route is faster than this [h], nor than the first time of ``certain``;
            NaN where it is not known.

        Notes
        -----
        The multiplicative epsilon of Zitzler et al. (2003), https://doi.org/10.1109/TEVC.2003.810758,
        of one route against the certain front: the least e for which no route takes less than
        (1 - e) of its time at less than (1 - e) of its value.
        """
        found: list[float | None] = []
        for route, value in zip(routes, self.values):
            known = math.isfinite(certain_at(self.certain, route.time_h)) and value > 0
            found.append(
                self._joint_gap(route.time_h, float(value), least_time_h) if known else None
            )
        return found

    def _joint_gap(self, time_h: float, value: float, least_time_h: float) -> float:
        """Return the share by which no route is better in both time and value."""
        least_time_h = float(np.fmax(least_time_h, self.certain[0, 0]))
        falling = not_rising(self.certain)
        low, high = 0.0, 1.0
        for _ in range(_HALVINGS):
            share = 0.5 * (low + high)
            time = (1.0 - share) * time_h
            better = time > least_time_h and certain_at(falling, time) < (1.0 - share) * value
            low, high = (share, high) if better else (low, share)
        return high

    def rows(self, routes: tuple[Route, ...]) -> list[dict[str, Any]]:
        """Return one plain dictionary per route."""
        rows = []
        joint = self.joint_gaps(routes)
        for number, (route, gap) in enumerate(zip(routes, self.gaps(routes))):
            row = {
                "number": number + 1,
                "time_h": route.time_h,
                "arrive": format_time(route.arrive),
                self.column: float(self.values[number]),
                "fuel_t": route.fuel_t,
                "energy_mwh": route.energy_mwh,
                "distance_nm": route.distance_nm,
                "waiting_h": route.waiting_h,
                "gap": gap,
                "joint_gap": joint[number],
                "stage": self.stages[number],
                "way": self.ways[number],
                "feasible": route.feasible,
                "referee_tolerance_h": route.tolerance_s / HOUR,
            }
            rows.append(row)
        return rows

    @property
    def column(self) -> str:
        """The key figure with its unit, as in files."""
        name = self.criterion.replace(" ", "_")
        return f"{name}_{self.unit.lower().replace('/', '_')}" if self.unit else name

    def as_dict(self, routes: tuple[Route, ...]) -> dict[str, Any]:
        """Return the front as plain data for JSON."""
        prices = {} if self.objective is None else {"prices": self.objective.prices}
        return {
            "criterion": self.criterion,
            "unit": self.unit,
            **prices,
            "points": self.rows(routes),
            "certain": [{"time_h": float(t), self.column: float(v)} for t, v in self.certain.T],
        }


def certain_at(certain: FloatArray, time_h: float) -> float:
    """Return the value of a certain front (2, m) at a time [h]; NaN without one."""
    if not certain.size or math.isnan(time_h):
        return math.nan
    return float(np.interp(time_h, certain[0], certain[1]))


def not_rising(certain: FloatArray) -> FloatArray:
    """Return a certain front (2, m) of routes that take at most as long, not just as long."""
    return np.array([certain[0], np.minimum.accumulate(certain[1])])


def knee(time: FloatArray, value: FloatArray) -> int:
    """Return the index of the point of a front farthest below the line through its ends.

    Parameters
    ----------
    time : Times of the points, ascending, (n,).
    value : Values of the points, descending, (n,).
    """
    if len(time) < 3:
        return 0
    x = (time - time.min()) / max(float(np.ptp(time)), 1e-12)
    y = (value - value.min()) / max(float(np.ptp(value)), 1e-12)
    return int(np.argmin(x + y))


def least_words(criterion: str) -> str:
    """Return the words for the least of a key figure, such as "least fuel"."""
    return _LEAST.get(criterion, f"least {criterion}")


def words_of_points(front: ParetoFront, time: FloatArray) -> dict[int, str]:
    """Return what the ends of a front and its knee are called, by their index.

    Parameters
    ----------
    front : With a value for each route.
    time : Times of its routes, in the same order, (n,).
    """
    if len(time) == 1:
        return {0: "only route"}
    order = np.argsort(time)
    chosen = {int(order[0]): "fastest", int(order[-1]): least_words(front.criterion)}
    chosen.setdefault(int(order[knee(time[order], front.values[order])]), "knee")
    return chosen
