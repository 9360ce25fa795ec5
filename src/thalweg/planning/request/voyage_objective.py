"""The objective of a voyage with the prices of its ship."""

from __future__ import annotations

from dataclasses import dataclass

from thalweg.core.objective import LegPrices, Objective
from thalweg.core.units import DAY, HOUR
from thalweg.planning.voyage import Voyage
from thalweg.route import Route
from thalweg.ship import Ship
from thalweg.ship.consumption import leg_prices
from thalweg.ship.fuel_prices import FuelTerms


@dataclass(frozen=True)
class PricedObjective:
    """What is traded against time in a voyage with a choice of speed.

    Attributes
    ----------
    terms : Prices and carbon factors, for the referee.
    prices : The objective on legs, for searches and refinement.
    """

    objective: Objective
    terms: FuelTerms
    prices: LegPrices

    @property
    def name(self) -> str:
        """The key figure that is minimised: fuel, energy, cost or co2."""
        return self.objective.name

    @property
    def unit(self) -> str:
        """Its unit: t, MWh, or the currency of the prices."""
        return self.objective.unit

    def value(self, route: Route) -> float:
        """Return the value of a refereed route [`unit`]; infinite where it is not known."""
        return self.objective.value(route)


def with_voyage_prices(ship: Ship, voyage: Voyage) -> Ship:
    """Return a ship with the prices that a voyage gives.

    Raises
    ------
    InputError : For prices in two currencies, or a factor without a price.
    """
    if not voyage.any_price:
        return ship
    hourly = voyage.time_price_usd_per_h
    return ship.with_prices(
        voyage.fuel_price_usd,
        voyage.eca_price_factor,
        time_usd_per_day=None if hourly is None else hourly * DAY / HOUR,
    )


def priced_objective(voyage: Voyage, ship: Ship) -> PricedObjective:
    """Return what a voyage trades against time, with prices where they are needed.

    The objective ``"front"`` is that of cost where the voyage or the ship file gives a price, else
    that of fuel.

    Parameters
    ----------
    voyage : With an objective that needs a choice of speed.

    Raises
    ------
    InputError : If a price or a carbon factor is needed and not known.
    """
    terms = with_voyage_prices(ship, voyage).fuel_terms
    name: str = voyage.objective
    if name == "front":
        name = "cost" if terms.any_price else "fuel"
    currency = terms.currency or "USD"
    if name == "weighted":  # not yet normalised: the network is not known
        objective = Objective(**voyage.weights, currency=currency)
    else:
        objective = Objective.of(name, currency=currency)
    return PricedObjective(objective, terms, leg_prices(objective, ship, terms))
