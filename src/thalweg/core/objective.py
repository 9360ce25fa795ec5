"""`Objective`: the quantity that planning minimises, and the prices on legs that kernels count."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Final, Literal, NamedTuple, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray

#: The key figures of a route that an objective can price.
ObjectiveName: TypeAlias = Literal[
    "time", "distance", "fuel", "energy", "cost", "co2", "comfort", "encounters", "inshore"
]
#: Those that a search at one speed setting minimises; the others need a choice of speed.
SingleSettingObjective: TypeAlias = Literal["time", "distance"]
#: What a ship consumes along a leg: fuel [kg], energy of brake and hotel load [J], or the cube of
#: the ordered speed times time [m3/s2], where that stands for fuel; for comfort, the squared
#: motion sickness dose [m2/s3]; or a weighted sum of these.
Consumption: TypeAlias = Literal["fuel", "energy", "cubed_speed", "squared_dose", "mixed"]

OBJECTIVE_NAMES: Final[tuple[ObjectiveName, ...]] = get_args(ObjectiveName)


class KeyFigure(NamedTuple):
    """Where a route holds a key figure, and the unit of it.

    Attributes
    ----------
    attribute : str
        Attribute of `thalweg.route.Route`.
    unit : str
        Empty where the unit is the currency of the prices.
    """

    attribute: str
    unit: str


KEY_FIGURES: Final[dict[str, KeyFigure]] = {
    "time": KeyFigure("time_h", "h"),
    "distance": KeyFigure("distance_nm", "nm"),
    "fuel": KeyFigure("fuel_t", "t"),
    "energy": KeyFigure("energy_mwh", "MWh"),
    "cost": KeyFigure("cost", ""),
    "co2": KeyFigure("co2_t", "t"),
    "comfort": KeyFigure("comfort", "m2/s3"),
    "encounters": KeyFigure("encounters", "encounters"),
    "inshore": KeyFigure("inshore_nm", "nm"),
}


@dataclass(frozen=True, kw_only=True)
class Objective:
    r"""The weighted sum of key figures that planning minimises.

    .. math:: J = \sum_k p_k K_k

    with the key figures :math:`K_k` of a route in their published units and the prices
    :math:`p_k`, which are zero or more.

    Attributes
    ----------
    time : float
        Price of an hour of passage time [1/h].
    distance : float
        Price of a nautical mile [1/nm].
    fuel : float
        Price of a tonne of fuel burnt [1/t].
    energy : float
        Price of the energy of propulsion and hotel load [1/MWh].
    cost : float
        Price of a unit of ``currency``; the cost is that of fuel (or of cubed speed), time and
        canal dues at the ship's prices (`thalweg.ship.fuel_prices.FuelTerms`).
    co2 : float
        Price of a tonne of CO2 emitted [1/t].
    comfort : float
        Price of the squared motion sickness dose at the first place of the ship file [s3/m2].
    encounters : float
        Price of an expected encounter with another ship.
    inshore : float
        Price of a nautical mile within 3 nm of land [1/nm].
    currency : str
        Unit of the cost.

    Raises
    ------
    InputError
        If a price is negative or not finite, or all prices are zero.
    """

    time: float = 0.0
    distance: float = 0.0
    fuel: float = 0.0
    energy: float = 0.0
    cost: float = 0.0
    co2: float = 0.0
    comfort: float = 0.0
    encounters: float = 0.0
    inshore: float = 0.0
    currency: str = "USD"

    def __post_init__(self) -> None:
        prices = {field.name: getattr(self, field.name) for field in fields(self)[:-1]}
        for name, price in prices.items():
            if not (math.isfinite(price) and price >= 0.0):
                raise InputError(
                    f"The price of {name} in the objective is {price!r}.",
                    "A price is a finite number of zero or more.",
                    "Correct the price.",
                    field=name,
                )
        if not any(prices.values()):
            raise InputError(
                "The objective prices nothing.",
                f"It needs a price above zero for one of {', '.join(prices)}.",
                "Give one.",
            )

    @classmethod
    def of(cls, name: str, *, price: float = 1.0, currency: str = "USD") -> Objective:
        """Return the objective of one key figure.

        Parameters
        ----------
        name : {"time", "distance", "fuel", "energy", "cost", "co2", "comfort", "encounters", \
"inshore"}
        price : float, optional
            Price of one published unit of it.
        currency : str, optional
            Unit of the cost.

        Returns
        -------
        Objective
            With a price of this key figure only.

        Raises
        ------
        InputError
            If there is no such key figure (with near matches).
        """
        if name not in OBJECTIVE_NAMES:
            raise unknown_name_error("objective", str(name), OBJECTIVE_NAMES)
        return cls(**{name: price}, currency=currency)  # type: ignore[arg-type]

    @property
    def prices(self) -> dict[ObjectiveName, float]:
        """The prices above zero, by key figure."""
        return {name: p for name in OBJECTIVE_NAMES if (p := float(getattr(self, name))) > 0.0}

    @property
    def name(self) -> str:
        """The key figure where only one is priced, else ``"weighted sum"``."""
        priced = list(self.prices)
        return priced[0] if len(priced) == 1 else "weighted sum"

    @property
    def unit(self) -> str:
        """Unit of the key figure where only one is priced; ``currency`` for the cost."""
        return KEY_FIGURES[self.name].unit or self.currency if self.name in KEY_FIGURES else ""

    def value(self, route: object) -> float:
        """Return the value of a route.

        Parameters
        ----------
        route : Route
            A route that the referee evaluated (`thalweg.route.Route`).

        Returns
        -------
        float
            Sum of prices times key figures [`unit`]; infinite where a priced one is unknown.
        """
        total = 0.0
        for name, price in self.prices.items():
            figure = getattr(route, KEY_FIGURES[name].attribute)
            if figure is None or not math.isfinite(figure):
                return math.inf
            total += price * float(figure)
        return total


@dataclass(frozen=True)
class LegPrices:
    """Prices of consumption and time along a leg, in SI: an `Objective` as kernels count it.

    .. math:: J = p C + p_t T + p_w T_w + p_d D + p_l L + p_i L_i + p_e E

    with consumption :math:`C`, passage time :math:`T` (waits included), waiting time :math:`T_w`,
    canal dues :math:`D`, length :math:`L`, length near land :math:`L_i` and expected encounters
    :math:`E`. The price of consumption depends on the position:
    :math:`p = (p_{out} + f (p_{in} - p_{out})) z`, with the fraction :math:`f` of the leg inside
    emission control areas and the factor :math:`z` of price zones.
    `thalweg.ship.consumption.leg_prices` makes it for a ship.

    Attributes
    ----------
    inside, outside : float
        Price of one unit of consumption inside and outside emission control areas.
    time : float
        Price of a second, under way or waiting [1/s].
    waiting : float
        Price of the consumption in a second of waiting [1/s], in addition to ``time``.
    dues : float
        Price of a unit of canal dues; 0 where dues and price zones do not count.
    consumption : {"fuel", "energy", "cubed_speed", "squared_dose", "mixed"}
        What ``inside`` and ``outside`` price: [kg], [J], [m3/s2] or [m2/s3]; a mixed one is 1 for
        the sum of ``mix``.
    mix : tuple of (Consumption, float)
        Consumptions and their weights, for a mixed one.
    length, inshore : float
        Price of a metre, and of one near land [1/m]; searches on networks count them.
    encounters : float
        Price of an expected encounter; likewise.

    Raises
    ------
    InputError
        If a price is negative or not finite.
    """

    inside: float = 1.0
    outside: float = 1.0
    time: float = 0.0
    waiting: float = 0.0
    dues: float = 0.0
    consumption: Consumption = "fuel"
    mix: tuple[tuple[Consumption, float], ...] = ()
    length: float = 0.0
    inshore: float = 0.0
    encounters: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name in ("consumption", "mix"):
                continue
            if not (math.isfinite(value) and value >= 0.0):
                raise InputError(
                    f"The price {field.name!r} of legs is {value!r}.",
                    "A price is a finite number of zero or more.",
                    "Correct the price.",
                    field=field.name,
                )

    @property
    def counts_water(self) -> bool:
        """Whether length, land or other ships have a price."""
        return max(self.length, self.inshore, self.encounters) > 0.0

    @property
    def counts_dose(self) -> bool:
        """Whether motion sickness has a price."""
        return "squared_dose" in (self.consumption, *(name for name, _ in self.mix))

    @property
    def differs_in_control_areas(self) -> bool:
        """Whether emission control areas make a difference."""
        return self.inside != self.outside

    def of_legs(self, eca_fraction: ArrayLike, zone_factor: ArrayLike) -> FloatArray:
        """Return the price of one unit of consumption on legs.

        Parameters
        ----------
        eca_fraction : array_like
            Fraction of each leg inside emission control areas, 0 to 1.
        zone_factor : array_like
            Factor of price zones on each leg; not used where ``dues`` is 0.

        Returns
        -------
        float64 array
            Price of one unit of ``consumption`` on each leg, in the broadcast shape.
        """
        inside = np.asarray(eca_fraction, float)
        price = np.asarray(self.outside + inside * (self.inside - self.outside))
        return np.asarray(price * np.asarray(zone_factor, float)) if self.dues > 0.0 else price


#: The mass of fuel [kg], inside and outside emission control areas.
FUEL_MASS: Final = LegPrices()
