"""Weighted sums of normalised key figures: from the best to the worst of the single optima."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.objective import KEY_FIGURES, Objective
from thalweg.network import Network
from thalweg.planning.pareto.exploration import network_pareto_front
from thalweg.planning.pareto.front_points import track_from_front_point
from thalweg.planning.pareto.search_horizon import FastestPaths, extend_horizon, searched_water
from thalweg.planning.pareto.trade_off_context import TradeOffContext
from thalweg.planning.request.voyage_objective import PricedObjective
from thalweg.planning.single.no_route_diagnosis import no_route_error
from thalweg.route import Route
from thalweg.ship.consumption import consumption_table, leg_prices
from thalweg.ship.fuel_prices import FuelTerms


@dataclass(frozen=True)
class KeyFigureRange:
    """A key figure over the routes that are each the best of one network in one key figure.

    Attributes
    ----------
    weight : As given.
    best, worst : Its least and greatest value (utopia and nadir of the payoff table), in its unit.
    """

    weight: float
    best: float
    worst: float

    @property
    def price(self) -> float:
        """Weight over the range; 0 where all routes have the same value."""
        span = self.worst - self.best
        return self.weight / span if span > 1e-9 * max(abs(self.worst), 1e-9) else 0.0


def with_objective(trade_off: TradeOffContext, objective: Objective) -> TradeOffContext:
    """Return a trade-off of the same ship and limits with another objective."""
    terms: FuelTerms = trade_off.objective.terms
    prices = leg_prices(objective, trade_off.context.ship, terms)
    table = consumption_table(trade_off.context.ship, prices.consumption, prices.mix)
    return replace(
        trade_off, objective=PricedObjective(objective, terms, prices), consumption=table
    )


def best_route_on_network(
    trade_off: TradeOffContext,
    network: Network,
    objective: Objective,
    paths: FastestPaths | None = None,
) -> Route:
    """Return the best route of a network for an objective, scored by the referee.

    Parameters
    ----------
    paths : Of this network and these limits, found for other objectives.

    Raises
    ------
    NoRouteError
        If there is no route within the limits.
    """
    own = with_objective(trade_off, objective)
    horizon = extend_horizon(own, network, paths)
    if not horizon.first.found:
        raise no_route_error(
            network,
            horizon.first,
            (own.ends[0], own.ends[-1]),
            depart=own.context.voyage.earliest_departure,
            last=own.context.data_end,
            water=searched_water(own, horizon),
        )
    front = network_pareto_front(own, network, horizon.frozen, horizon.latest)
    point = front.fastest if objective.name == "time" else front.cheapest
    return own.context.evaluate(track_from_front_point(network, point), own.objective.terms)


def key_figure_ranges(
    trade_off: TradeOffContext, network: Network, weights: Mapping[str, float]
) -> dict[str, KeyFigureRange]:
    """Return the range of each weighted key figure over the single optima of a network.

    Raises
    ------
    NoRouteError
        If there is no route within the limits, or a key figure of it is not known.
    """
    counted = {name: weight for name, weight in weights.items() if weight > 0.0}
    currency = trade_off.objective.terms.currency or "USD"
    routes, paths = [], FastestPaths()
    for name in counted:
        trade_off.context.report_progress(f"searching the route of least {name}")
        routes.append(
            best_route_on_network(trade_off, network, Objective.of(name, currency=currency), paths)
        )
    found = {}
    for name, weight in counted.items():
        values = np.array([key_figure(route, name) for route in routes])
        if np.isnan(values).any():
            raise NoRouteError(
                f"The {name} of a route of this voyage is not known.",
                "A weighted sum needs every key figure that it counts.",
                "Add the data that it needs, or leave it out of the weights.",
                reasons={},
            )
        found[name] = KeyFigureRange(weight, float(values.min()), float(values.max()))
    return found


def normalised_trade_off(trade_off: TradeOffContext, network: Network) -> TradeOffContext:
    """Return a trade-off whose objective is the weighted sum of its voyage, normalised.

    Parameters
    ----------
    network : Whose single optima give the ranges.
    """
    ranges = key_figure_ranges(trade_off, network, trade_off.context.voyage.weights)
    trade_off.notes.extend(key_figure_notes(ranges))
    currency = trade_off.objective.terms.currency or "USD"
    return with_objective(trade_off, normalised_objective(ranges, currency))


def key_figure(route: Route, name: str) -> float:
    """Return a key figure of a route in its unit; NaN where it is not known."""
    value = getattr(route, KEY_FIGURES[name].attribute)
    return math.nan if value is None else float(value)


def normalised_objective(ranges: Mapping[str, KeyFigureRange], currency: str) -> Objective:
    """Return the weighted sum of key figures, each over its range.

    Where no key figure has a range, all routes of the network are the same and time decides.
    """
    prices = {name: one.price for name, one in ranges.items() if one.price > 0.0}
    return Objective(**(prices or {"time": 1.0}), currency=currency)


def key_figure_notes(ranges: Mapping[str, KeyFigureRange]) -> list[str]:
    """Return a note with the weights and the ranges, in words."""
    parts = [
        f"{name} {one.weight:g} ({one.best:.4g} to {one.worst:.4g})" for name, one in ranges.items()
    ]
    text = "Weights over the range from the best to the worst of the single optima of the network: "
    notes = [text + ", ".join(parts) + "."]
    same = [name for name, one in ranges.items() if one.price == 0.0]
    if same:
        notes.append(f"No route differs in {', '.join(same)}: it does not count.")
    return notes
