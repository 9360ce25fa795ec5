"""The front of two additive key figures on a network, with a certificate."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Final

import numpy as np

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.objective import KEY_FIGURES, OBJECTIVE_NAMES, Objective
from thalweg.core.pareto_fronts import evenly_spaced_subset, lower_hull, non_dominated_indices
from thalweg.core.types import FloatArray
from thalweg.network import Network
from thalweg.planning.pareto.exploration import front_search
from thalweg.planning.pareto.front_points import track_from_front_point
from thalweg.planning.pareto.search_horizon import (
    FastestPaths,
    SearchHorizon,
    extend_horizon,
    searched_water,
)
from thalweg.planning.pareto.trade_off_context import TradeOffContext
from thalweg.planning.pareto.weighted_sums import key_figure, with_objective
from thalweg.planning.single.no_route_diagnosis import no_route_error, unreached_goal_error
from thalweg.route import Route
from thalweg.route.indicator_columns import indicator_table
from thalweg.search import FrontPoint, FrontQuery, pareto_front, path_costs

_MOST_SEARCHES: Final = 24
_MOST_ROUTES: Final = 12  # of a front that the referee scores
_CLOSED: Final = 2e-3  # a gap below this share of the value needs no further search
#: Time bins of a search: as many as its work allows, since bounds lose up to one bin on each edge.
_LEAST_BINS, _MOST_BINS, _EDGE_BINS = 300, 6000, 3.6e7


@dataclass(frozen=True, eq=False)
class IndicatorFront:
    """The front of two key figures on one network.

    Attributes
    ----------
    names : (str, str)
        The two key figures, of `thalweg.core.objective.KEY_FIGURES`.
    routes : tuple of Route
        Scored by the referee, by ascending first key figure.
    values : float64 array (n, 2)
        Key figures of the paths on the network [their units].
    bounds : float64 array (m, 3)
        Weights a, b and bounds c: no path on the network that arrives in time has ``a x + b y``
        below c, with the key figures x and y.
    searches : How many searches of the network it took.
    """

    names: tuple[str, str]
    routes: tuple[Route, ...]
    values: FloatArray
    bounds: FloatArray
    searches: int

    def lower_at(self, first: float) -> float:
        """Return the least second key figure that a path with this first one may have."""
        a, b, c = self.bounds[self.bounds[:, 1] > 0.0].T
        return float(np.max((c - a * first) / b, initial=0.0))

    @property
    def gaps(self) -> FloatArray:
        """How far each point may be above the true front, as a share of its weighted value."""
        a, b, c = self.bounds.T
        own = np.outer(self.values[:, 0], a) + np.outer(self.values[:, 1], b)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.maximum(np.where(own > 0.0, (own - c) / own, 0.0), 0.0)
        both = (a > 0.0) & (b > 0.0)  # a bound of one figure does not tell of the other
        return np.asarray(share[:, both].min(axis=1) if both.any() else share.max(axis=1))

    def to_dict(self) -> dict[str, Any]:
        """Return the front as plain data, ready for JSON."""
        rows = []
        for route, values, gap in zip(self.routes, self.values, self.gaps):
            figures = {name: key_figure(route, name) for name in dict.fromkeys(self.names)}
            known = {k: v if math.isfinite(v) else None for k, v in figures.items()}
            rows.append({
                "time_h": route.time_h,
                **{f"{name}": known[name] for name in self.names},
                **{f"network_{name}": float(v) for name, v in zip(self.names, values)},
                "gap": float(gap),
                "indicators": indicator_table(route),
                "waypoints": route.waypoints(),
            })  # fmt: skip
        units = [KEY_FIGURES[name].unit for name in self.names]
        bounds = [[float(x) for x in row] for row in self.bounds]
        return {
            "names": list(self.names),
            "units": units,
            "points": rows,
            "bounds": bounds,
            "searches": self.searches,
        }


def search_indicator_front(
    trade_off: TradeOffContext, network: Network, names: tuple[str, str]
) -> IndicatorFront:
    r"""Search the front of two additive key figures on a network.

    Parameters
    ----------
    network : From start to goal.
    names : Two different key figures.

    Returns
    -------
    IndicatorFront

    Raises
    ------
    InputError
        If a name is unknown or both are the same.
    NoRouteError
        If there is no route within the limits.

    Notes
    -----
    Weighted sums are searched one after the other (Aneja and Nair 1979): between two neighbours
    (x1, y1) and (x2, y2) of the lower hull the weights are ``y1 - y2`` and ``x2 - x1``, until no
    path is below the line that joins them. Each search gives a path and a bound of its sum; so the
    hull is exact to the accuracy of the searches, and the bounds hold for every path. Points above
    the hull are those that the searches met, the true front may have more of them. Each key figure
    of a path is its own cost, sailed again edge by edge. Ships do not wait.
    """
    search = _WeightedSearches(trade_off, network, names)
    search.run(1.0, 0.0)
    search.run(0.0, 1.0)
    search.refine()
    return search.result()


class _WeightedSearches:
    """Searches of weighted sums on one network over one period."""

    def __init__(
        self, trade_off: TradeOffContext, network: Network, names: tuple[str, str]
    ) -> None:
        if len(names) != 2 or names[0] == names[1] or set(names) - set(OBJECTIVE_NAMES):
            raise InputError(
                f"A front of {' and '.join(names)} was requested.",
                f"It has two different key figures of {', '.join(OBJECTIVE_NAMES)}.",
                "Give two of these.",
                field="of",
            )
        self.trade_off, self.network, self.names = trade_off, network, names
        self.currency = trade_off.objective.terms.currency or "USD"
        singles = [Objective.of(name, currency=self.currency) for name in names]
        self.single = [with_objective(trade_off, one) for one in singles]
        self.horizon = self._horizon()
        self.points: list[FrontPoint] = []
        self.values = np.empty((0, 2))
        self.bounds: list[tuple[float, float, float]] = []
        self.scale = np.ones(2)

    def _horizon(self) -> SearchHorizon:
        """Return the longer of the periods of the two key figures."""
        paths = FastestPaths()
        found = [extend_horizon(own, self.network, paths) for own in self.single]
        horizon = max(found, key=lambda one: one.latest)
        if not horizon.first.found:
            ends = self.trade_off.ends
            raise no_route_error(
                self.network,
                horizon.first,
                (ends[0], ends[-1]),
                depart=self.trade_off.context.voyage.earliest_departure,
                last=self.trade_off.context.data_end,
                water=searched_water(self.trade_off, horizon),
            )
        return horizon

    def _query(self, own: TradeOffContext) -> tuple[Any, FrontQuery]:
        ship, query = front_search(own, self.network, self.horizon.frozen, self.horizon.latest)
        return ship, replace(query, wait=False)

    def run(self, first: float, second: float) -> None:
        """Search one weighted sum, with weights of normalised key figures; keep what it finds."""
        weights = np.array([first, second]) / self.scale
        count = len(self.bounds) + 1
        self.trade_off.context.report_progress(
            f"searching the front of {' and '.join(self.names)}: {count}"
        )
        objective = Objective(**dict(zip(self.names, weights.tolist())), currency=self.currency)
        ship, query = self._query(with_objective(self.trade_off, objective))
        work = self.network.n_edges * len(self.trade_off.context.ship.speeds)
        bins = min(max(_EDGE_BINS / work, _LEAST_BINS), _MOST_BINS)
        bin_s = (query.latest - query.depart) / bins
        try:
            front = pareto_front(ship, query, bin_s=bin_s)
        except NoRouteError as error:
            raise unreached_goal_error(
                error, self.trade_off.ends, query.depart, wait=False
            ) from error
        if not front.points:
            raise NoRouteError(
                "No route arrives within the period of the front.",
                "The limits, or the end of the data, leave none.",
                "Relax the limits, or extend the data.",
                reasons=front.refused,
            )
        values = np.stack(
            [path_costs(*self._query(own), front.points) for own in self.single], axis=1
        )
        known = np.isfinite(values).all(axis=1)
        self.points += [front.points[k] for k in np.flatnonzero(known)]
        self.values = np.concatenate([self.values, values[known]])
        bound = float(np.min(front.lower_cost, initial=front.cheapest.cost))
        self.bounds.append((float(weights[0]), float(weights[1]), bound))
        if count == 1:  # from here on both key figures count alike
            self.scale = np.maximum(np.abs(self.values).max(axis=0), 1e-12)

    def refine(self) -> None:
        """Search between neighbours of the lower hull until the bounds meet it."""
        done: set[tuple[int, int]] = set()
        while len(self.bounds) < _MOST_SEARCHES:
            hull = self._hull()
            open_pairs = [pair for pair in pairwise(hull) if pair not in done]
            open_pairs = [pair for pair in open_pairs if self._slack(*pair) > _CLOSED]
            if not open_pairs:
                return
            i, j = max(open_pairs, key=lambda pair: self._slack(*pair))
            done.add((i, j))
            weights = self._weights(i, j) * self.scale
            self.run(*(weights / weights.sum()).tolist())

    def _weights(self, i: int, j: int) -> FloatArray:
        (x1, y1), (x2, y2) = self.values[i], self.values[j]
        return np.array([y1 - y2, x2 - x1])

    def _slack(self, i: int, j: int) -> float:
        """Return how far the line between two points may be above the front, as a share."""
        middle = 0.5 * (self.values[i] + self.values[j])
        a, b, c = np.array(self.bounds).T
        own = a * middle[0] + b * middle[1]
        return float(np.min((own - c) / np.where(own > 0.0, own, 1.0)))

    def _hull(self) -> list[int]:
        """Return the points of the lower hull of the non-dominated ones, by the first figure."""
        order = np.asarray(non_dominated_indices(self.values[:, 0], self.values[:, 1]))
        return order[lower_hull(*self.values[order].T)].tolist()

    def result(self) -> IndicatorFront:
        """Return the front, with routes scored by the referee."""
        order = np.asarray(non_dominated_indices(self.values[:, 0], self.values[:, 1]))
        x, y = self.values[order].T
        wanted = {*self._hull(), *order[evenly_spaced_subset(x, y, _MOST_ROUTES)].tolist()}
        chosen = [k for k in order.tolist() if k in wanted]
        context, terms = self.trade_off.context, self.trade_off.objective.terms
        context.report_progress(f"evaluating {len(chosen)} routes")
        routes = [
            context.evaluate(track_from_front_point(self.network, self.points[k]), terms)
            for k in chosen
        ]
        kept = [n for n, route in enumerate(routes) if route.feasible]
        return IndicatorFront(
            self.names,
            tuple(routes[n] for n in kept),
            self.values[[chosen[n] for n in kept]],
            np.array(self.bounds),
            len(self.bounds),
        )
