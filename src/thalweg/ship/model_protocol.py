"""The protocol of ship models: required methods and optional capabilities.

`ShipModel` is required of built-in and third-party models alike. The other protocols are optional
capabilities: `Ship` uses them where a model offers them, by ``isinstance``. The capability of
models with a resistance is `thalweg.ship.models.resistance_protocol.ResistanceBased`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.ship.conditions import Conditions
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.table_parts import TableError, TablePart

#: The parts of a table, their error, and the output curve where there is one.
ModelTables: TypeAlias = (
    tuple[tuple[TablePart, ...], TableError]
    | tuple[tuple[TablePart, ...], TableError, OutputCurve | None]
)


class Tabulation(NamedTuple):
    """What ``tabulate`` of a model returns, with names: ``Tabulation(*model.tabulate(...))``.

    Attributes
    ----------
    curve : Applied to the sum of the parts.
    """

    parts: tuple[TablePart, ...]
    error: TableError
    curve: OutputCurve | None = None


@runtime_checkable
class ShipModel(Protocol):
    """Speed, power and fuel of a ship in given conditions.

    All arrays are SI. A model does not change after construction and reads only the conditions
    that it declares. It returns arrays of the shape of the conditions; NaN conditions give NaN.
    """

    @property
    def reads(self) -> frozenset[str]:
        """Names of the conditions it reads, except ``load_factor`` (see `Conditions`)."""
        ...

    @property
    def identity(self) -> Mapping[str, object]:
        """Plain data that distinguish this model from others; part of the ship's fingerprint."""
        ...

    def speeds(self, load_factor: float) -> FloatArray:
        """Return the calm-water speed of every setting.

        Parameters
        ----------
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        float64 array (settings,)
            Speeds [m/s], ascending.
        """
        ...

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Return the speed through water.

        Parameters
        ----------
        conditions : Conditions
            Conditions that broadcast together.
        setting : array_like of int
            Index into `speeds`.

        Returns
        -------
        float64 array
            Speed [m/s], at least 0; NaN where a condition is NaN or out of range.
        """
        ...

    def power(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Return the brake power, without the hotel load.

        Parameters
        ----------
        conditions : Conditions
            Conditions that broadcast together.
        setting : array_like of int
            Index into `speeds`.

        Returns
        -------
        float64 array
            Power [W]; NaN where the model does not know it.
        """
        ...

    def fuel_rate(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Return the fuel rate, the hotel load included.

        Parameters
        ----------
        conditions : Conditions
            Conditions that broadcast together.
        setting : array_like of int
            Index into `speeds`.

        Returns
        -------
        float64 array
            Fuel rate [kg/s]; NaN where the model does not know it.
        """
        ...

    def top_speed(self, setting: int, load_factor: float) -> float | None:
        """Return an upper bound of the speed through water in any conditions.

        Parameters
        ----------
        setting : int
            Index into `speeds`.
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        float or None
            Speed [m/s]; None when unknown.
        """
        ...

    def tabulate(self, load_factor: float, tolerance: float) -> ModelTables:
        """Tabulate the speed through water [m/s].

        Parameters
        ----------
        load_factor : float
            0 empty to 1 full.
        tolerance : float
            Relative error that 99 % of random conditions should meet.

        Returns
        -------
        tuple
            Parts whose sum is the speed, the measured error, and optionally the `OutputCurve` that
            turns the sum into the speed.
        """
        ...

    def notes(self, conditions: Conditions, setting: ArrayLike) -> list[RangeNote]:
        """Return where a method is used outside its range.

        Parameters
        ----------
        conditions : Conditions
            Conditions that broadcast together.
        setting : array_like of int
            Index into `speeds`.

        Returns
        -------
        list of RangeNote
            Empty if all methods are within their range.
        """
        ...


@runtime_checkable
class DraughtModel(Protocol):
    """Capability: a model of a plug-in that gives its own draught."""

    @property
    def draught(self) -> float:
        """Draught [m]."""
        ...


@runtime_checkable
class EstimatingModel(Protocol):
    """Capability: a model that estimated particulars which the ship file does not give."""

    @property
    def estimated(self) -> tuple[Estimate, ...]:
        """The estimates."""
        ...


@runtime_checkable
class AdjustableModel(Protocol):
    """Capability: a model whose settings can be replaced."""

    def with_speeds(self, speeds: FloatArray, load_factor: float) -> ShipModel:
        """Return the model with other settings.

        Parameters
        ----------
        speeds : float64 array
            Calm-water speeds [m/s], ascending.
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        ShipModel
            With these settings.
        """
        ...


@runtime_checkable
class GreatestSpeedModel(Protocol):
    """Capability: a model that knows the greatest calm-water speed that can be ordered."""

    def greatest_speed(self, load_factor: float) -> float:
        """Return the greatest calm-water speed [m/s]; inf where nothing limits it.

        Parameters
        ----------
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        float
            Above it the ship has no power, or its power is not known.
        """
        ...


@runtime_checkable
class CrabAngleModel(Protocol):
    """Capability: a model that may depend on the angle between heading and course."""

    @property
    def depends_on_crab_angle(self) -> bool:
        """Whether it does, as with rudder drag."""
        ...


@runtime_checkable
class SpeedHoldingModel(Protocol):
    """Capability: a model whose settings may be speeds that the engines hold."""

    @property
    def holds_speed(self) -> bool:
        """Whether they are; otherwise the power is constant and weather changes the speed."""
        ...


@runtime_checkable
class JointPowerAndFuelModel(Protocol):
    """Capability: a model that finds brake power and fuel rate in one computation."""

    def power_and_fuel(
        self, conditions: Conditions, setting: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Return the brake power and the fuel rate.

        Parameters
        ----------
        conditions : Conditions
            Conditions that broadcast together.
        setting : array_like of int
            Index into `speeds`.

        Returns
        -------
        power, fuel : float64 array
            Power [W] and fuel rate [kg/s]; NaN where unknown.
        """
        ...


@runtime_checkable
class FuelTableModel(Protocol):
    """Capability: a model that tabulates its fuel rate itself."""

    def tabulate_fuel(self, load_factor: float, tolerance: float) -> ModelTables:
        """Tabulate the fuel rate [kg/s], the hotel load included.

        Parameters
        ----------
        load_factor : float
            0 empty to 1 full.
        tolerance : float
            Relative error that 99 % of random conditions should meet.

        Returns
        -------
        tuple
            As `ShipModel.tabulate` returns it.
        """
        ...


@runtime_checkable
class PowerTableModel(Protocol):
    """Capability: a model that tabulates its brake power itself."""

    def tabulate_power(self, load_factor: float, tolerance: float) -> ModelTables:
        """Tabulate the brake power [W], without the hotel load.

        Parameters
        ----------
        load_factor : float
            0 empty to 1 full.
        tolerance : float
            Relative error that 99 % of random conditions should meet.

        Returns
        -------
        tuple
            As `ShipModel.tabulate` returns it.
        """
        ...


def setting_index(setting: ArrayLike, count: int) -> NDArray[np.intp]:
    """Return settings as an index array, or raise `InputError` for one that does not exist.

    Parameters
    ----------
    setting : Indices of settings.
    count : Number of settings of the ship.

    Returns
    -------
    int array : In the shape of ``setting``.
    """
    index = np.asarray(setting)
    if not np.issubdtype(index.dtype, np.integer):
        raise InputError(
            f"A setting is an index, not {index.dtype}.",
            f"The ship has settings 0 to {count - 1}.",
            "Give the index of an ordered speed.",
        )
    if index.size and (index.min() < 0 or index.max() >= count):
        raise InputError(
            f"There is no setting {int(index.max() if index.max() >= count else index.min())}.",
            f"The ship has settings 0 to {count - 1}.",
            "Give the index of an ordered speed.",
        )
    return index.astype(np.intp)


def does_hold_speed(model: object) -> bool:
    """Return whether a ship model holds the speed that is ordered, up to the largest power."""
    return isinstance(model, SpeedHoldingModel) and bool(model.holds_speed)
