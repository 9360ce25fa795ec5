"""Tables of the fuel rate: what a setting burns in the weather the ship meets [kg/s]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.ship.conditions import Conditions
from thalweg.ship.ladder import WaveTable, resistance_on_grid
from thalweg.ship.model import ShipModel
from thalweg.ship.powering import Balance, ResistanceModel
from thalweg.ship.propulsion_parts import Plant
from thalweg.ship.table import PerformanceTable, TableError, TablePart
from thalweg.ship.table_store import Kept
from thalweg.ship.tabulate import (
    DEFAULT_AXES,
    constant_part,
    random_conditions,
    table_error,
    tabulate_dense,
)
from thalweg.ship.tabulate_sum import CHECKS, add_up, axes_of, flattened, grouped
from thalweg.ship.variables import AXIS_OF

if TYPE_CHECKING:
    from thalweg.ship.ship import Ship

FloatArray = NDArray[np.float64]
_NODES = 513  # of the power over resistance at one speed


def fuel_table(ship: Ship, tolerance: float) -> PerformanceTable:
    """Tabulate a ship's fuel rate; see `Ship.tabulate_fuel`.

    Raises
    ------
    InputError
        If the fuel is unknown, or the speed is a field.
    """
    if ship.speed_field is not None:
        raise _no_fuel(ship, "its speed is a field of place and time")
    make = getattr(ship.model, "tabulate_fuel", None)
    if make is None:
        make = partial(tabulate_fuel_of_model, ship.model)
    parts, error = make(ship.loading.load_factor, tolerance)
    for part in parts:
        if not np.isfinite(part.values).reshape(-1, part.values.shape[-1]).any(axis=0).all():
            raise _no_fuel(ship, "its fuel rate is unknown")
    return PerformanceTable(parts, ship.speeds, ship.fingerprint(), error)


def _no_fuel(ship: Ship, why: str) -> InputError:
    return InputError(
        f"The fuel of {ship.name!r} cannot be tabulated: {why}.",
        "A fuel model is a table with fuel_t_per_day, fuel.reference_t_per_day, or a resistance "
        "with engine.type, engine.sfoc_g_per_kwh or a curve of it.",
        "Add one to the ship file, or ask for the least time.",
        ship=ship.name,
    )


@dataclass(frozen=True, eq=False)
class FuelGrid:
    """Fuel of a ship that holds its speeds as long as its engines can, over grids of conditions.

    Attributes
    ----------
    balance : Balance
    plant : Plant
    speeds : ndarray
        Ordered speeds [m/s].
    waves : WaveTable, optional
        At the ordered speeds.
    """

    balance: Balance
    plant: Plant
    speeds: FloatArray
    waves: WaveTable | None = None

    @classmethod
    def of(cls, model: ResistanceModel, load_factor: float) -> FuelGrid:
        """Build the grid function of a ship at a load factor."""
        balance, speeds = model.balance(load_factor), model.speeds(load_factor)
        waves = None if balance.waves is None else WaveTable.at_all(balance.waves, speeds)
        return cls(balance, model.plant, speeds, waves)

    def __call__(self, where: Mapping[str, FloatArray]) -> FloatArray:
        """Fuel rates [kg/s] in conditions by name, shape ``(*shape, settings)``.

        Where the engines cannot hold a speed they give what they can.
        """
        columns = []
        for k, speed in enumerate(self.speeds):
            asked = resistance_on_grid(self.balance, self.waves, k, float(speed), where)
            power = np.minimum(self._power(float(speed), asked), self.plant.largest_power)
            columns.append(self.plant.fuel(power))
        return np.stack(np.broadcast_arrays(*columns), axis=-1)

    def _power(self, speed: float, resistance: FloatArray) -> FloatArray:
        """Brake power [W] that overcomes resistances [N] at one speed, between close nodes."""
        known = resistance[np.isfinite(resistance)]
        if not known.size:
            return np.full(np.shape(resistance), np.nan)
        low, high = float(known.min()), float(known.max())
        nodes = low + (high - low) * np.linspace(0.0, 1.0, _NODES) ** 2
        power = self.balance.propulsion.brake_power(np.full(_NODES, speed), nodes)
        found = np.interp(resistance, nodes, power)
        return np.where(np.isnan(resistance), np.nan, found)


def tabulate_fuel_of_balance(model: ResistanceModel, load_factor: float, tolerance: float) -> Kept:
    """Tabulate the fuel rate of every setting of a resistance-based ship.

    A setting of power burns the same in all weather: one constant. A setting of speed burns what
    holding it takes, up to all that the engines give: parts as those of the table of speeds.

    Parameters
    ----------
    model : ResistanceModel
    load_factor : float
    tolerance : float
        See `thalweg.ship.tabulate.table_error`.

    Returns
    -------
    parts : tuple of TablePart
    error : TableError
        Against the methods themselves.
    top : ndarray
        Greatest fuel rate of every setting that was seen [kg/s].
    """
    balance = model.balance(load_factor)
    groups = grouped(axes_of(balance, model.limits))

    def truth(points: Mapping[str, FloatArray]) -> FloatArray:
        at, which, shape = flattened(points, len(model.orders.values))
        power = model.power_of(balance, at, which, load_factor)
        return model.plant.fuel(power).reshape(shape)

    calm = model.plant.fuel(np.array(model.orders.values))
    if model.orders.kind == "speed":
        calm = truth({"depth": np.asarray(np.inf)})
    if model.orders.kind == "power" or not groups:
        parts = [constant_part(calm)]
        points = random_conditions([axis for group in groups for axis in group], CHECKS, 7)
        if not points:
            return tuple(parts), TableError(0.0, 0.0, 0.0, 0), calm
        true = truth(points)
        error = table_error(np.broadcast_to(calm, true.shape), true)
    else:
        grid = FuelGrid.of(model, load_factor)
        shift = calm - grid({"depth": np.asarray(np.inf)})
        parts, error, _, true = add_up(
            lambda where: grid(where) + shift, calm, groups, truth, tolerance
        )
    return tuple(parts), error, np.maximum(calm, np.nanmax(true, axis=0))


def tabulate_fuel_of_model(
    model: ShipModel, load_factor: float, tolerance: float
) -> tuple[tuple[TablePart, ...], TableError]:
    """Tabulate the fuel rate of any model over all conditions it reads, in one part."""
    names = sorted(model.reads & AXIS_OF.keys(), key=AXIS_OF.__getitem__)
    settings = np.arange(len(model.speeds(load_factor)))

    def rates(where: Mapping[str, FloatArray]) -> FloatArray:
        columns = {name: np.asarray(values)[..., None] for name, values in where.items()}
        return model.fuel_rate(Conditions(columns, load_factor=load_factor), settings)

    if not names:
        return (constant_part(rates({})),), TableError(0.0, 0.0, 0.0, 0)
    part, error = tabulate_dense(rates, [DEFAULT_AXES[n] for n in names], tolerance=tolerance)
    return (part,), error
