"""Ships with a resistance: their settings, and speed, power and fuel in weather."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, KNOT
from thalweg.ship.conditions import Conditions
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.model_protocol import setting_index
from thalweg.ship.models.engine_plant import EngineOrders, EnginePlant
from thalweg.ship.models.force_balance import (
    CALM_CONDITIONS,
    FlatConditions,
    ForceBalance,
    calm_conditions,
)
from thalweg.ship.models.resistance_protocol import LARGEST_SPEED_FACTOR
from thalweg.ship.ship_limits import ShipLimits
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.table_cache import TableWithMaxima, cached_table
from thalweg.ship.tables.table_parts import TableError, TablePart

#: parts, their error, and what follows their sum
TabulatedModel: TypeAlias = tuple[tuple[TablePart, ...], TableError, OutputCurve | None]

#: Calm-water speeds of displacement ships at a given power are searched up to this Froude number.
_LARGEST_FROUDE_NUMBER: Final = 0.6


@dataclass(frozen=True, eq=False)
class ResistanceModel:
    """A ship whose speed and fuel follow from resistance, propulsion and engine.

    Attributes
    ----------
    balance_at : Function of a load factor that returns the `ForceBalance`.
    plant : The engines: greatest power, and fuel by power.
    orders : What each setting orders: brake powers [W] or calm-water speeds [m/s].
    facts : The sections of the ship file that the model was built from.
    limits : Greatest wave height and wind speed of the tables.
    """

    balance_at: Callable[[float], ForceBalance]
    plant: EnginePlant
    orders: EngineOrders
    facts: Mapping[str, Any]
    limits: ShipLimits = field(default_factory=ShipLimits)
    _kept: dict[Any, Any] = field(default_factory=dict, repr=False)

    @property
    def reads(self) -> frozenset[str]:
        """Conditions read."""
        return self.balance(1.0).reads

    @property
    def depends_on_crab_angle(self) -> bool:
        """Whether the rudder drags where the heading is not the course."""
        return self.balance(1.0).rudder_area > 0.0

    @property
    def holds_speed(self) -> bool:
        """Whether the settings are speeds."""
        return self.orders.kind == "speed"

    @property
    def identity(self) -> Mapping[str, object]:
        """Data that distinguish this model from others."""
        return {
            "kind": "resistance",
            "orders": repr(self.orders),
            "plant": repr(self.plant),
            "facts": self.facts,
        }

    @property
    def estimated(self) -> tuple[Estimate, ...]:
        """Particulars that were estimated for the full ship."""
        balance = self.balance(1.0)
        hulls = [balance.calm.hull, *(p.hull for p in (balance.waves, balance.wind) if p)]
        found = [e for hull in hulls for e in hull.estimated]
        found += [*balance.propulsion.estimated, *self.plant.estimated]
        return tuple({e.key: e for e in reversed(found)}.values())[::-1]

    def balance(self, load_factor: float) -> ForceBalance:
        """Forces and power at a load factor."""
        key = ("balance", float(load_factor))
        if key not in self._kept:
            self._kept[key] = self.balance_at(float(load_factor))
        found: ForceBalance = self._kept[key]
        return found

    def speeds(self, load_factor: float) -> FloatArray:
        """Speed of every setting in calm, deep water without wind [m/s]."""
        key = ("speeds", float(load_factor))
        if key not in self._kept:
            values = np.array(self.orders.values)
            if self.orders.kind == "power":
                values = self._calm_speeds(load_factor, values)
            self._kept[key] = values
        found: FloatArray = self._kept[key]
        return found

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Speed through water [m/s]."""
        index = setting_index(setting, len(self.orders.values))
        return self._by_loading(conditions, index, self.speed_of)

    def power(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Brake power [W]."""
        index = setting_index(setting, len(self.orders.values))
        return self._by_loading(conditions, index, self.power_of)

    def fuel_rate(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Fuel rate [kg/s], hotel load included."""
        return self.power_and_fuel(conditions, setting)[1]

    def power_and_fuel(
        self, conditions: Conditions, setting: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Brake power [W], without hotel load, and fuel rate [kg/s], with it."""
        power = self.power(conditions, setting)
        return power, self.plant.fuel(power)

    def power_at_speed(self, conditions: Conditions, speed: ArrayLike) -> FloatArray:
        """Brake power [W] at speeds through water [m/s], also beyond the power of the engines."""

        def power(
            balance: ForceBalance, at: FlatConditions, speeds: FloatArray, lf: float
        ) -> FloatArray:
            return balance.brake_power(at, speeds)

        return self._by_loading(conditions, np.asarray(speed, float), power)

    def resistance(self, conditions: Conditions, speed: ArrayLike) -> dict[str, FloatArray]:
        """Resistance by component [N] at speeds through water [m/s]; see
        `ForceBalance.components`.
        """
        names = list(self.balance(1.0).components(calm_conditions(1), np.ones(1)))
        columns = []
        for name in names:

            def one(
                b: ForceBalance, at: FlatConditions, v: FloatArray, lf: float, n: str = name
            ) -> FloatArray:
                return np.broadcast_to(b.components(at, v)[n], v.shape)

            columns.append(self._by_loading(conditions, np.asarray(speed, float), one))
        return dict(zip(names, columns))

    def top_speed(self, setting: int, load_factor: float) -> float:
        """Greatest speed over the table and over random conditions [m/s]."""
        return float(self._table(load_factor, 0.01)[1][setting])

    def tabulate(self, load_factor: float, tolerance: float) -> TabulatedModel:
        """Tabulate the speed; see `thalweg.ship.models.tabulate_resistance`.

        Raises
        ------
        ModelRangeError : If power does not rise with speed.
        """
        table, _ = self._table(load_factor, tolerance)
        return table.parts, table.error, table.finish

    def tabulate_fuel(self, load_factor: float, tolerance: float) -> TabulatedModel:
        """Tabulate the fuel rate [kg/s]; see `thalweg.ship.models.tabulate_fuel`."""
        return self._tabulate_rate("fuel", load_factor, tolerance, self.plant.fuel)

    def tabulate_power(self, load_factor: float, tolerance: float) -> TabulatedModel:
        """Tabulate the brake power [W]; see `thalweg.ship.models.tabulate_fuel`."""
        return self._tabulate_rate("power", load_factor, tolerance, np.asarray)

    def _tabulate_rate(
        self,
        what: str,
        load_factor: float,
        tolerance: float,
        of_power: Callable[[FloatArray], FloatArray],
    ) -> TabulatedModel:
        from thalweg.ship.models.tabulate_fuel import tabulate_rate_of_power

        def build() -> TableWithMaxima:
            return tabulate_rate_of_power(self, float(load_factor), float(tolerance), of_power)

        table, _ = self._stored(what, load_factor, tolerance, build)
        return table.parts, table.error, table.finish

    def _table(self, load_factor: float, tolerance: float) -> TableWithMaxima:
        """The table of speeds and the greatest speeds."""
        from thalweg.ship.models.tabulate_resistance import tabulate_balance

        def build() -> TableWithMaxima:
            return tabulate_balance(self, float(load_factor), float(tolerance))

        return self._stored("table", load_factor, tolerance, build)

    def _stored(
        self,
        what: str,
        load_factor: float,
        tolerance: float,
        build: Callable[[], TableWithMaxima],
    ) -> TableWithMaxima:
        """Return a table that this object holds, from disk, or built."""
        key = (what, float(load_factor), float(tolerance))
        if key not in self._kept:
            self._kept[key] = cached_table([self.identity, repr(self.limits), key], build)
        found: TableWithMaxima = self._kept[key]
        return found

    def notes(self, conditions: Conditions, setting: ArrayLike) -> list[RangeNote]:
        """Where methods are used outside their ranges."""
        index = setting_index(setting, len(self.orders.values))
        found: list[RangeNote] = []

        def note(b: ForceBalance, at: FlatConditions, which: FloatArray, lf: float) -> FloatArray:
            speed = self.speed_of(b, at, which, lf)
            found.extend([*b.notes(at, speed), *self.plant.notes(b.brake_power(at, speed))])
            return speed

        self._by_loading(conditions, index, note)
        return found

    def greatest_speed(self, load_factor: float) -> float:
        """Calm-water speed [m/s] at the largest power of the engines; inf where it is not given."""
        limit = self.plant.largest_power
        if np.isinf(limit):
            return math.inf
        return float(self._calm_speeds(load_factor, np.array([limit]))[0])

    def with_speeds(self, speeds: FloatArray, load_factor: float) -> ResistanceModel:
        """Return the model with other settings, given by calm-water speeds [m/s].

        Raises
        ------
        InputError : If the engine cannot reach a speed in calm water, or it is not positive.
        """
        flat = calm_conditions(len(speeds))
        balance = self.balance(load_factor)
        possible = np.isfinite(speeds) & (speeds > 0.0)
        power = balance.brake_power(flat, np.where(possible, speeds, 1.0))
        limit = self.plant.largest_power
        if not (possible & (power <= limit * (1 + 1e-6))).all():
            raise _unreachable_speed_error(speeds, power, limit)
        values = power if self.orders.kind == "power" else speeds
        orders = EngineOrders(self.orders.kind, tuple(float(v) for v in values))
        return replace(self, orders=orders, _kept={})

    def _calm_speeds(self, load_factor: float, powers: FloatArray) -> FloatArray:
        balance, flat = self.balance(load_factor), calm_conditions(len(powers))
        length = float(balance.calm.hull.values["length_between_perpendiculars_m"])
        highest = np.full(len(powers), _LARGEST_FROUDE_NUMBER * np.sqrt(GRAVITY * length))
        return balance.speed_at_power(flat, powers, highest)

    def speed_of(
        self, balance: ForceBalance, at: FlatConditions, which: FloatArray, lf: float
    ) -> FloatArray:
        """Speed [m/s] in flat conditions, at settings and a load factor."""
        index = which.astype(np.intp)
        calm = self.speeds(lf)[index]
        if self.orders.kind == "power":
            powers = np.array(self.orders.values)[index]
            return balance.speed_at_power(at, powers, LARGEST_SPEED_FACTOR * calm)
        if np.isinf(self.plant.largest_power):
            return np.where(np.isnan(balance.resistance(at, calm)), np.nan, calm)
        required = balance.brake_power(at, calm)
        speed = np.where(np.isnan(required), np.nan, calm)
        weak = np.flatnonzero(required > self.plant.largest_power)
        limit = np.full(weak.size, self.plant.largest_power)
        here = {name: values[weak] for name, values in at.items()}
        speed[weak] = balance.speed_at_power(here, limit, calm[weak])
        return speed

    def power_of(
        self, balance: ForceBalance, at: FlatConditions, which: FloatArray, lf: float
    ) -> FloatArray:
        """Brake power [W] in flat conditions; no more than ordered where weather stops the ship."""
        power = balance.brake_power(at, self.speed_of(balance, at, which, lf))
        ordered: FloatArray = np.asarray(self.plant.largest_power)
        if self.orders.kind == "power":
            ordered = np.array(self.orders.values)[which.astype(np.intp)]
        return np.minimum(power, ordered)

    def _by_loading(
        self,
        conditions: Conditions,
        which: NDArray[Any],
        function: Callable[[ForceBalance, FlatConditions, FloatArray, float], FloatArray],
    ) -> FloatArray:
        """Apply a function of flat conditions, once for every load factor there is."""
        shape = np.broadcast_shapes(conditions.shape, which.shape)
        names = [n for n in (*self.reads, "crab_angle") if n in self.reads or n in conditions]
        at = {name: np.full(int(np.prod(shape)), value) for name, value in CALM_CONDITIONS.items()}
        at |= {name: np.broadcast_to(conditions[name], shape).ravel() for name in names}
        chosen = np.broadcast_to(which, shape).ravel().astype(float)
        load = np.broadcast_to(conditions.load_factor, shape).ravel()
        result = np.full(load.shape, np.nan)
        for factor in np.unique(load[(load >= 0.0) & (load <= 1.0)]):
            here = np.flatnonzero(load == factor)
            part = {name: values[here] for name, values in at.items()}
            balance = self.balance(float(factor))
            result[here] = function(balance, part, chosen[here], float(factor))
        return result.reshape(shape)


def _unreachable_speed_error(speeds: FloatArray, power: FloatArray, limit: float) -> InputError:
    knots = ", ".join(f"{s / KNOT:.4g}" for s in speeds)
    if np.any(speeds <= 0.0):
        return InputError(
            f"The ship cannot be ordered to {knots} kn.",
            "Speeds are above 0.",
            "Order a positive speed.",
            value=knots,
        )
    above = ~(power <= limit)
    knots = ", ".join(f"{s / KNOT:.4g}" for s in speeds[above])
    needed = ", ".join(f"{p / 1000:.0f}" for p in power[above])
    return InputError(
        f"The ship cannot be ordered to {knots} kn: it takes {needed} kW in calm water.",
        f"The engines give {limit / 1000:.0f} kW.",
        "Order a lower, positive speed.",
        value=knots,
    )
