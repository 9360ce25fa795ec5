"""Fuels and prices of a ship, inside and outside emission control areas."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from numbers import Real
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, TONNE
from thalweg.ship.methods.engine.european_charges import EuropeanCharges, european_prices
from thalweg.ship.methods.engine.fuel_properties import Fuel, co2_mass, equal_energy_mass

FUEL_QUANTITIES: Final = ("fuel", "cost", "co2", "allowances", "penalty")
FACTOR_OF_SHIP_FILE: Final = "price of the request, factor of the ship file"
FACTOR_OF_REQUEST: Final = "price of the ship file, factor of the request"
_SHARE_NOISE: Final = 1e-9  #: of shares that are quotients of lengths


@dataclass(frozen=True)
class FuelTerms:
    """Fuels of a ship with their prices and carbon factors by area, and its price of time.

    Data of the ship, not an objective: `thalweg.ship.consumption.leg_prices` combines them with a
    `thalweg.core.objective.Objective`.

    Attributes
    ----------
    outside, inside : Fuel or None
        Burnt outside and inside emission control areas; None when the ship file names none.
    price_outside, price_inside : Per kilogram, in ``currency``; NaN when unknown.
    eca_price_factor : Price inside over price outside; NaN where they are two prices of their own.
    own_carbon_factor : CO2 per fuel [kg/kg] given for the ship itself, of the fuel burnt outside.
    usd_rate : Price of a US dollar [currency/USD]; NaN when unknown. Not used for prices in USD.
    time_price : Price of time (hire) [currency/s].
    replaced_time_price : That of the ship file where a request replaced it; 0: none.
    cubed_speed_price : float
        Price of a second of sailing per cubed ordered speed [currency/s per (m/s)^3], lambda_f of
        van Halem (2019); NaN when unknown. It is used where fuel has no price.
    cubed_speed_co2 : CO2 of a second of sailing per cubed ordered speed [kg/s per (m/s)^3], van
        Halem (2019), eq. 3.5; NaN when unknown. It is used where the CO2 of the fuel is unknown.
    sources : Where the prices of ``fuel`` and ``time``, the ``factor`` inside control areas and the
        price ``fuel_inside`` come from: "request", for the last also of both; else "ship file".
    charges : Emission allowances and FuelEU penalty, which add to the cost of fuel.
    """

    outside: Fuel | None
    inside: Fuel | None
    price_outside: float
    price_inside: float
    eca_price_factor: float = 1.0
    own_carbon_factor: float | None = None
    currency: str = ""
    usd_rate: float = math.nan
    time_price: float = 0.0
    replaced_time_price: float = 0.0
    cubed_speed_price: float = math.nan
    cubed_speed_co2: float = math.nan
    sources: Mapping[str, str] = field(default_factory=dict)
    charges: EuropeanCharges | None = None

    @property
    def by_speed(self) -> bool:
        """Whether the cost of sailing follows the cubed speed, since fuel has no price."""
        return math.isnan(self.price_outside) and not math.isnan(self.cubed_speed_price)

    @property
    def dollar_rate(self) -> float:
        """Price of a US dollar, in which canal dues are [currency/USD]; NaN when unknown."""
        return 1.0 if self.currency in ("", "USD") else self.usd_rate

    @property
    def emits_by_speed(self) -> bool:
        """Whether CO2 follows the cubed speed, since the carbon factor of the fuel is unknown."""
        return math.isnan(self.carbon_outside) and not math.isnan(self.cubed_speed_co2)

    @property
    def any_price(self) -> bool:
        """Whether fuel, time or cubed speed has a price."""
        return not math.isnan(self.price_outside) or self.by_speed or self.time_price > 0.0

    def prices(self) -> dict[str, Any]:
        """Return the prices with their sources as plain data; None where unknown.

        Returns
        -------
        dict : ``currency``, ``usd_rate`` where it is another and the rate is known, and
            ``{"value", "source"}`` of ``fuel_per_t``, ``fuel_in_eca_per_t``, ``time_per_day`` and,
            where it counts, ``per_second_per_cubed_speed``; and ``european_charges``, with what is
            ``not_counted`` for want of a price. A price of time that a request replaced is
            ``replaced`` of ``time_per_day``.
        """
        values = {
            "fuel_per_t": (self.price_outside * TONNE, "fuel"),
            "fuel_in_eca_per_t": (self.price_inside * TONNE, "fuel_inside"),
            "time_per_day": (self.time_price * DAY, "time"),
        }
        if self.by_speed:
            values["per_second_per_cubed_speed"] = (self.cubed_speed_price, "time")
        found: dict[str, Any] = {"currency": self.currency or "USD"}
        if math.isfinite(self.dollar_rate) and found["currency"] != "USD":
            found["usd_rate"] = self.dollar_rate
        found["european_charges"] = european_prices(self.charges)
        for name, (value, kind) in values.items():
            known = math.isfinite(value)
            source = self.sources.get(kind, "ship file") if known else None
            found[name] = {"value": round(value, 9) if known else None, "source": source}
        if self.replaced_time_price not in (0.0, self.time_price):
            found["time_per_day"]["replaced"] = round(self.replaced_time_price * DAY, 9)
        return found

    @property
    def carbon_outside(self) -> float:
        """CO2 per fuel burnt outside control areas [kg/kg]; NaN when unknown."""
        return _carbon_factor(self.outside, self.own_carbon_factor)

    @property
    def carbon_inside(self) -> float:
        """CO2 per fuel burnt inside control areas [kg/kg]; NaN when unknown."""
        return _carbon_factor(
            self.inside, self.own_carbon_factor if self.inside is self.outside else None
        )

    @property
    def relative_mass_inside(self) -> float:
        """Mass burnt inside per mass burnt outside, at the same heat; 1 for one fuel."""
        if self.inside is None or self.outside is None or self.inside is self.outside:
            return 1.0
        return float(equal_energy_mass(1.0, of=self.outside, to=self.inside))

    def per_kg(self, what: str, inside: bool) -> float:
        """Return mass, cost or CO2 per kilogram of fuel.

        Parameters
        ----------
        what : {"fuel", "cost", "co2", "allowances", "penalty"}
            Mass burnt [kg], money [``currency``], CO2 [kg], or the part of the money for emission
            allowances or the FuelEU penalty.
        inside : Inside an emission control area or outside.

        Returns
        -------
        float
            Per kilogram of the ship's model, which gives the fuel burnt outside; inside, the mass
            of another fuel follows from the same heat (`relative_mass_inside`). NaN when unknown.

        Raises
        ------
        InputError : If ``what`` is not one of the five.
        """
        if what not in FUEL_QUANTITIES:
            raise unknown_name_error("sum of fuel", str(what), FUEL_QUANTITIES)
        mass = self.relative_mass_inside if inside else 1.0
        if what in ("allowances", "penalty"):
            return mass * self._charge_per_kg(inside, what)
        if what == "cost":
            price = self.price_inside if inside else self.price_outside
            return mass * (price + self._charge_per_kg(inside))
        if what == "co2":
            factor = self.carbon_inside if inside else self.carbon_outside
            return float(co2_mass(mass, carbon_factor=factor))
        return mass

    def _charge_per_kg(self, inside: bool, part: str = "") -> float:
        """Return the charges of the European Union on a kilogram of fuel; NaN when unknown."""
        if self.charges is None:
            return 0.0
        fuel = self.inside if inside else self.outside
        carbon = self.carbon_inside if inside else self.carbon_outside
        return self.charges.per_kg("" if fuel is None else fuel.name, carbon, part)

    def with_charges(self, charges: EuropeanCharges | None) -> FuelTerms:
        """Return the terms with charges of the European Union on fuel.

        Raises
        ------
        InputError : If fuel has no price, to which they could be added.
        """
        if charges is not None and math.isnan(self.price_outside):
            raise InputError(
                "Charges of the European Union were given, but fuel has no price.",
                "They add to the cost of fuel.",
                "Give the price of fuel, too.",
                field="fuel_price_usd",
            )
        return replace(self, charges=charges)

    def of_fuel(
        self, what: str, fuel_mass: ArrayLike, share_inside: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Return mass, cost or CO2 of fuel burnt partly inside emission control areas.

        x = m ((1 - s) x_outside + s x_inside), with x per kilogram as in `per_kg`.

        Parameters
        ----------
        what : {"fuel", "cost", "co2", "allowances", "penalty"}
        fuel_mass : Fuel m of the ship's model [kg], as if the fuel outside were burnt everywhere.
        share_inside : Share s inside a control area, 0 to 1.

        Returns
        -------
        total, inside : The whole sum, and its part inside; NaN where unknown. A price or a factor
            that is unknown does not matter where nothing is burnt by it.

        Raises
        ------
        InputError : If a share is outside 0 to 1.

        Notes
        -----
        Seuren (2020), Table 5.2, gives one factor for the cost of fuel inside control areas,
        1.5593: the price inside over that outside, for one fuel.
        """
        share = np.asarray(share_inside, dtype=float)
        if np.any((share < -_SHARE_NOISE) | (share > 1.0 + _SHARE_NOISE)):
            raise InputError(
                "The share of a leg inside a control area is outside 0 to 1.",
                f"It runs from {np.nanmin(share):g} to {np.nanmax(share):g}.",
                "Give lengths inside the area divided by leg lengths.",
            )
        mass = np.asarray(fuel_mass, dtype=float)
        within = np.where(share > 0.0, share * self.per_kg(what, True), 0.0)
        beyond = np.where(share < 1.0, (1.0 - share) * self.per_kg(what, False), 0.0)
        return mass * (within + beyond), mass * within

    def with_prices(
        self,
        usd_per_t: float | None = None,
        eca_price_factor: float | None = None,
        *,
        time_usd_per_day: float | None = None,
    ) -> FuelTerms:
        """Return the terms with other prices.

        Parameters
        ----------
        usd_per_t : Price of the fuel burnt outside [USD/t]; prices are in USD then. Without
            ``eca_price_factor`` the price inside follows with the same ratio.
        eca_price_factor : Price inside over price outside.
        time_usd_per_day : Price of time [USD/day].

        Raises
        ------
        InputError : For a price below zero, a factor not above zero, numbers that are not finite, a
            factor without any price, or US dollars beside prices in another currency.
        """
        _check_price("price of fuel", usd_per_t, "USD/t", zero=True)
        _check_price("price factor inside control areas", eca_price_factor, "", zero=False)
        _check_price("price of time", time_usd_per_day, "USD/day", zero=True)
        outside = self.price_outside if usd_per_t is None else usd_per_t / TONNE
        if eca_price_factor is not None and math.isnan(outside):
            raise InputError(
                "A price factor inside control areas was given, but fuel has no price.",
                "The factor multiplies the price of fuel outside them.",
                "Give the price of fuel, too.",
                field="eca_price_factor",
            )
        self._same_currency(usd_per_t, time_usd_per_day)
        factor = self._ratio() if eca_price_factor is None else eca_price_factor
        keeps = usd_per_t is None and eca_price_factor is None
        own = self.replaced_time_price if "time" in self.sources else self.time_price
        dollars = usd_per_t is not None or time_usd_per_day is not None
        return replace(
            self,
            price_outside=outside,
            price_inside=self.price_inside if keeps else outside * factor,
            eca_price_factor=self.eca_price_factor if keeps else factor,
            currency="USD" if dollars else self.currency,
            time_price=self.time_price if time_usd_per_day is None else time_usd_per_day / DAY,
            replaced_time_price=self.replaced_time_price if time_usd_per_day is None else own,
            sources=self._sources_with(
                fuel=usd_per_t is not None,
                factor=eca_price_factor is not None,
                time=time_usd_per_day is not None,
            ),
        )

    def _sources_with(self, *, fuel: bool, factor: bool, time: bool) -> dict[str, str]:
        """Return the sources of the prices where a request gives some of them."""
        given = {"fuel": fuel, "factor": factor, "time": time}
        found = {**self.sources, **{name: "request" for name, new in given.items() if new}}
        if fuel or factor:
            both = "fuel" in found and "factor" in found
            one = FACTOR_OF_SHIP_FILE if "fuel" in found else FACTOR_OF_REQUEST
            found["fuel_inside"] = "request" if both else one
        return found

    def _ratio(self) -> float:
        """Return the price inside over that outside; 1 where it is unknown."""
        if not math.isnan(self.eca_price_factor):
            return self.eca_price_factor
        known = self.price_outside > 0.0 and math.isfinite(self.price_inside)
        return self.price_inside / self.price_outside if known else 1.0

    def _same_currency(self, usd_per_t: float | None, time_usd_per_day: float | None) -> None:
        """Refuse prices in US dollars beside prices in another currency."""
        sailing = not math.isnan(self.price_outside) or self.by_speed
        stays = (usd_per_t is None and sailing) or (
            time_usd_per_day is None and self.time_price > 0.0
        )
        given = usd_per_t is not None or time_usd_per_day is not None
        if given and stays and self.currency not in ("", "USD"):
            raise InputError(
                f"Prices in US dollars were given for a ship with prices in {self.currency}.",
                "All prices of a ship are in one currency.",
                "Give both the price of fuel and the price of time, or change the ship file.",
                currency=self.currency,
            )


def _carbon_factor(fuel: Fuel | None, own: float | None) -> float:
    if own is not None:
        return own
    return math.nan if fuel is None else fuel.carbon_factor


def _check_price(what: str, value: float | None, unit: str, *, zero: bool) -> None:
    if value is None:
        return
    good = isinstance(value, Real) and math.isfinite(value)
    if not good or value < 0.0 or (value == 0.0 and not zero):
        raise InputError(
            f"The {what} is {value!r}{' ' + unit if unit else ''}.",
            f"It is a number {'of zero or more' if zero else 'above zero'}.",
            "Correct it.",
            value=value,
        )
