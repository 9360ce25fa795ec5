"""A route in every member of an ensemble: what it may cost, and what it costs in the worst of them.

Every member is taken as likely as the others. The tail is that of Rockafellar, R.T. & Uryasev, S.
(2000), "Optimization of conditional value-at-risk", *Journal of Risk* 2(3), 21-41: the mean of the
worst ``1 - alpha`` of the members, of which one may count in part.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.route.referee.evaluation import RouteLike, evaluate
from thalweg.route.route import Route
from thalweg.ship.condition_variables import WAVE_HEIGHT

if TYPE_CHECKING:
    from thalweg.sea import Sea
    from thalweg.ship import Ship

ALPHA: Final = 0.9
QUANTITIES: Final = ("time_h", "fuel_t", "cost", "co2_t", "energy_mwh")
MEASURES: Final = ("mean", "p10", "p90", "cvar")
_NEVER: Final = 1e-12  # shares of a member below this are rounding


def cvar(values: ArrayLike, alpha: float = ALPHA) -> float:
    """Return the mean of the largest ``1 - alpha`` of equally likely values.

    Parameters
    ----------
    values : array_like
        One number per member; the larger the worse.
    alpha : float, optional
        Share of the members that is left out: from 0 (the mean of all) to less than 1.

    Returns
    -------
    float
        Where ``(1 - alpha) n`` is not a whole number, the last member of the tail counts in part;
        a tail of less than one member is the worst one. NaN without values.

    Raises
    ------
    InputError
        If alpha is not in [0, 1).

    Examples
    --------
    >>> cvar([3.0, 1.0, 2.0, 10.0], 0.5)
    6.5
    >>> round(cvar(range(1, 26), 0.9), 6)  # (25 + 24 + 23 / 2) / 2.5
    24.2
    """
    if not 0.0 <= alpha < 1.0:
        raise InputError(
            f"A tail beyond {alpha!r} is not possible.",
            "alpha is in [0, 1).",
            "Use 0.9.",
        )
    ordered = np.sort(np.asarray(values, float))[::-1]
    if not ordered.size:
        return math.nan
    tail = max((1.0 - alpha) * ordered.size, 1.0)
    share = np.clip(tail - np.arange(ordered.size), 0.0, 1.0)
    share[share < _NEVER] = 0.0
    used = share > 0.0
    return float((ordered[used] * share[used]).sum() / share.sum())


@dataclass(frozen=True)
class MemberStatistics:
    """How a number varies over the members that could be sailed.

    Attributes
    ----------
    mean, p10, p90 : float
        Mean, 10th and 90th percentile (linear between members).
    cvar : float
        Mean of the worst tail (see `cvar`).
    count : int
        Number of members.
    """

    mean: float
    p10: float
    p90: float
    cvar: float
    count: int

    @classmethod
    def of(cls, values: FloatArray, alpha: float) -> MemberStatistics:
        """Return the statistics of values.

        Parameters
        ----------
        values : float64 array (n,)
            One value or more, all finite.
        alpha : float
            Share of the members outside the worst tail, from 0 to less than 1.

        Returns
        -------
        MemberStatistics
            In the unit of the values.
        """
        low, high = np.percentile(values, [10.0, 90.0])
        return cls(
            float(np.mean(values)), float(low), float(high), cvar(values, alpha), int(values.size)
        )

    def as_dict(self) -> dict[str, float | int]:
        """Return plain data, ready for JSON.

        Returns
        -------
        dict
            ``mean``, ``p10``, ``p90``, ``cvar`` and ``members``.
        """
        return {**{name: getattr(self, name) for name in MEASURES}, "members": self.count}


@dataclass(frozen=True, eq=False)
class EnsembleResult:
    """A route as evaluated by the referee in every member of an ensemble.

    Attributes
    ----------
    routes : tuple of Route
        One per member, in their order, the infeasible ones too.
    alpha : float
        Share of the members that the tail of `MemberStatistics.cvar` leaves out.
    """

    routes: tuple[Route, ...]
    alpha: float = ALPHA

    @property
    def infeasible(self) -> tuple[int, ...]:
        """Numbers of the members in which the route violates a limit or cannot be completed."""
        return tuple(k for k, route in enumerate(self.routes) if not route.feasible)

    @property
    def time_h(self) -> MemberStatistics | None:
        """Spread of the time [h]; None if no member is feasible."""
        return self.spread("time_h")

    @property
    def fuel_t(self) -> MemberStatistics | None:
        """Spread of the fuel [t]; None if unknown."""
        return self.spread("fuel_t")

    @property
    def cost(self) -> MemberStatistics | None:
        """Spread of the cost, in the currency of the prices; None without prices."""
        return self.spread("cost")

    @property
    def co2_t(self) -> MemberStatistics | None:
        """Spread of the carbon dioxide [t]; None if unknown."""
        return self.spread("co2_t")

    def spread(self, quantity: str) -> MemberStatistics | None:
        """Return the statistics of a quantity over the feasible members.

        Infeasible members have no value; `infeasible` and `notes` list them and `risk` counts them.

        Parameters
        ----------
        quantity : {"time_h", "fuel_t", "cost", "co2_t", "energy_mwh"}
            Attribute of `Route`.

        Returns
        -------
        MemberStatistics or None
            None if no feasible member has a value.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        values = self.values(quantity)
        values = values[np.isfinite(values)]
        return MemberStatistics.of(values, self.alpha) if values.size else None

    def values(self, quantity: str) -> FloatArray:
        """Return a quantity in every member.

        Parameters
        ----------
        quantity : {"time_h", "fuel_t", "cost", "co2_t", "energy_mwh"}
            Attribute of `Route`.

        Returns
        -------
        float64 array (members,)
            inf where the route is infeasible, NaN where the quantity is unknown.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        if quantity not in QUANTITIES:
            raise unknown_name_error("quantity of a distribution", quantity, QUANTITIES)
        found = [
            (getattr(route, quantity, None) if route.feasible else math.inf)
            for route in self.routes
        ]
        return np.array([math.nan if value is None else value for value in found], float)

    def risk(self, quantity: str = "time_h", measure: str = "cvar") -> float:
        """Return one number by which routes can be compared, the smaller the better.

        Parameters
        ----------
        quantity : {"time_h", "fuel_t", "cost", "co2_t", "energy_mwh"}
        measure : {"mean", "p10", "p90", "cvar"}

        Returns
        -------
        float
            inf where an infeasible member has part in it (always in the mean); NaN if unknown.
        """
        if measure not in MEASURES:
            raise unknown_name_error("measure of risk", measure, MEASURES)
        values = self.values(quantity)
        if np.isnan(values).any():
            return math.nan
        if measure == "cvar":
            return cvar(values, self.alpha)
        if measure == "mean":
            return float(np.mean(values))
        return _quantile(values, 0.1 if measure == "p10" else 0.9)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences about what is not in the numbers."""
        if not self.infeasible:
            return ()
        return (
            f"In {len(self.infeasible)} of {len(self.routes)} members the route cannot be sailed "
            f"within its limits ({_listed(self.infeasible)}): {self._first_reason()}. Mean, "
            "quantiles and tail are of the others.",
        )

    @property
    def highest_waves_m(self) -> tuple[float | None, ...]:
        """Highest waves on the way in each member [m], of infeasible ones as far as they come.

        None where the ship model reads no waves or none are known.
        """
        found = (route.samples.get(WAVE_HEIGHT) for route in self.routes)
        highest = [
            math.nan if waves is None else float(np.fmax.reduce(waves, initial=np.nan))
            for waves in found
        ]
        return tuple(value if math.isfinite(value) else None for value in highest)

    def _first_reason(self) -> str:
        broken = self.routes[self.infeasible[0]].violations
        return str(broken[0]) if broken else "it never arrives"

    def as_dict(self) -> dict[str, Any]:
        """Return plain data, ready for JSON.

        Returns
        -------
        dict
            Number of members, infeasible ones with the first reason, statistics of each
            quantity (None if unknown), the highest waves in each member and notes.
        """
        spreads = {name: self.spread(name) for name in QUANTITIES}
        return {
            "members": len(self.routes),
            "infeasible": list(self.infeasible),
            "first_reason": self._first_reason() if self.infeasible else None,
            "alpha": self.alpha,
            **{name: None if s is None else s.as_dict() for name, s in spreads.items()},
            "highest_waves_m": list(self.highest_waves_m),
            "notes": list(self.notes),
        }

    def __str__(self) -> str:
        time = self.time_h
        if time is None:
            return f"Distribution: infeasible in all {len(self.routes)} members"
        text = (
            f"Distribution over {len(self.routes)} members: {time.mean:.3f} h, p10 {time.p10:.3f}, "
            f"p90 {time.p90:.3f}, worst {100 * (1 - self.alpha):.0f} % {time.cvar:.3f}"
        )
        return text + (f"; infeasible in {len(self.infeasible)}" if self.infeasible else "")


def evaluate_members(
    route: RouteLike,
    *,
    ship: Ship,
    sea: Sea,
    terms: Any = None,
    alpha: float = ALPHA,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> EnsembleResult:
    """Evaluate one route in every member of an ensemble with the referee.

    Parameters
    ----------
    route : Track, Route, path, or iterable of (lat, lon)
        As in `evaluate`.
    ship : Ship
    sea : Sea
        An ensemble.
    terms : FuelTerms, optional
        Prices, as in `evaluate`.
    alpha : float, optional
        Share of the members outside the worst tail.
    progress : callable, optional
        Called with the number of members done and of all members.
    **options
        ``chart``, ``depart``, ``min_ukc``, ``step``, ``load_factor`` and ``speed_kn`` of
        `evaluate`. Data that end before the route does make a member infeasible.

    Returns
    -------
    EnsembleResult

    Raises
    ------
    InputError
        If the sea is not an ensemble, alpha is not in [0, 1), or an option of `evaluate` is wrong.
    """
    count = _checked_member_count(sea, alpha)
    if "strict" in options:
        raise InputError(
            "The argument strict is given.",
            "Members whose data end too early are always reported.",
            "Leave it out.",
        )
    evaluation_options: Mapping[str, Any] = (
        options if terms is None else {**options, "terms": terms}
    )
    routes: list[Route] = []
    for index in range(count):
        routes.append(
            evaluate(route, ship=ship, sea=sea.member(index), strict=False, **evaluation_options)
        )
        if progress is not None:
            progress(index + 1, count)
    return EnsembleResult(tuple(routes), alpha)


def _checked_member_count(sea: Sea, alpha: float) -> int:
    cvar((), alpha)
    if sea.members:
        return sea.members
    raise InputError(
        "The sea is not an ensemble: it has one member only.",
        "Ensembles come from files with a dimension such as number or realization, or from "
        "Sea.ensemble.",
        "Use evaluate for one sea.",
        field="sea",
    )


def _quantile(values: FloatArray, share: float) -> float:
    """Return a quantile, linear between members; inf where an infinite value is part of it."""
    ordered = np.sort(values)
    place = share * (ordered.size - 1)
    low = int(place)
    part = place - low
    if part == 0.0 or low + 1 == ordered.size:
        return float(ordered[low])
    if not math.isfinite(ordered[low + 1]):
        return math.inf
    return float(ordered[low] + part * (ordered[low + 1] - ordered[low]))


def _listed(numbers: tuple[int, ...]) -> str:
    text = ", ".join(map(str, numbers[:8]))
    return text + (", ..." if len(numbers) > 8 else "")
