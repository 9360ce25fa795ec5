"""Ships known by their calm-water speeds: lists, speed-power-fuel tables and the cubic law."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.kernels import codes
from thalweg.ship.conditions import Conditions
from thalweg.ship.methods.displacement import interpolate_loading
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.model_protocol import setting_index
from thalweg.ship.models.kwon_speed_loss import KwonSpeedLoss, tabulate_predicted_speed
from thalweg.ship.models.prestegardshus_speed_loss import PrestegardshusSpeedLoss
from thalweg.ship.models.squat_model import SquatModel
from thalweg.ship.tables.table_parts import TableError, TablePart
from thalweg.ship.tables.tabulate import AxisRange, constant_part

_HIGHEST: Final = 100.0 * KNOT  # ordered speed of a ship whose file sets no other [m/s]


@runtime_checkable
class SpeedLossModel(Protocol):
    """Capability of a ship model: its speed may be reduced by an involuntary speed loss."""

    @property
    def loss(self) -> KwonSpeedLoss | None:
        """The loss."""
        ...


@dataclass(frozen=True, eq=False)
class SpeedPowerLaw:
    """How power and fuel follow the speed.

    Attributes
    ----------
    name : {"none", "cubic", "table"}
    power_to_fuel_rate : callable, optional
        Fuel rate [kg/s] of a power [W], where fuel follows from power and not from the speed.
    rows : Speeds full and empty, fuel rates and powers that the settings were taken from; those of
        the settings themselves when not given.
    hotel_fuel : Fuel of the hotel load [kg/s], the part of given fuel rates that the cubic law does
        not raise.
    """

    name: str = "none"
    power_to_fuel_rate: Callable[[FloatArray], FloatArray] | None = None
    rows: tuple[FloatArray, FloatArray, FloatArray, FloatArray] | None = None
    hotel_fuel: float = 0.0


@dataclass(frozen=True, eq=False)
class KnownSpeedModel:
    """A ship whose engine settings have known calm-water speeds.

    At a setting the engine power and the fuel rate are constant; weather reduces the speed.

    Attributes
    ----------
    speeds_full, speeds_empty : Calm-water speed of each setting, full and empty [m/s], ascending.
    fuel_rates, powers : Of each setting [kg/s], [W]; NaN when unknown.
    law : How fuel and power follow the speed between and beyond the settings.
    loss : Involuntary speed loss.
    squat : Limits the speed in shallow water; power and fuel stay those of the setting.
    """

    speeds_full: FloatArray
    speeds_empty: FloatArray
    fuel_rates: FloatArray
    powers: FloatArray
    law: SpeedPowerLaw = field(default_factory=SpeedPowerLaw)
    loss: KwonSpeedLoss | PrestegardshusSpeedLoss | None = None
    squat: SquatModel | None = None

    @property
    def reads(self) -> frozenset[str]:
        """Conditions read: the weather with a speed loss, the depth with squat."""
        weather = frozenset() if self.loss is None else self.loss.reads
        return weather if self.squat is None else weather | {"depth"}

    @property
    def identity(self) -> Mapping[str, object]:
        """Data that distinguish this model from others."""
        return {
            "kind": "nominal",
            "speeds_full": self.speeds_full.tolist(),
            "speeds_empty": self.speeds_empty.tolist(),
            "fuel_rates": self.fuel_rates.tolist(),
            "powers": self.powers.tolist(),
            "loss": repr(self.loss),
            **({} if self.squat is None else {"squat": repr(self.squat)}),
        }

    def speeds(self, load_factor: float) -> FloatArray:
        """Calm-water speeds at a load factor [m/s]."""
        return interpolate_loading(load_factor, empty=self.speeds_empty, full=self.speeds_full)

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Speed through water [m/s]."""
        index = setting_index(setting, len(self.speeds_full))
        load_factor = conditions.load_factor
        calm = interpolate_loading(
            load_factor, empty=self.speeds_empty[index], full=self.speeds_full[index]
        )
        if self.loss is not None:
            calm = calm * (1.0 - self.loss.share(conditions, calm))
        if self.squat is not None:
            calm = self.squat.allowed(calm, conditions.depth, load_factor)
        return np.array(np.broadcast_to(calm, _shape(conditions, index)))

    def power(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Brake power [W]; that of the setting in all weather."""
        index = setting_index(setting, len(self.speeds_full))
        return np.array(np.broadcast_to(self.powers[index], _shape(conditions, index)))

    def fuel_rate(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Fuel rate [kg/s]; that of the setting in all weather."""
        index = setting_index(setting, len(self.speeds_full))
        return np.array(np.broadcast_to(self.fuel_rates[index], _shape(conditions, index)))

    def top_speed(self, setting: int, load_factor: float) -> float:
        """Calm-water speed [m/s]: weather does not raise it."""
        return float(self.speeds(load_factor)[setting])

    def tabulate(
        self, load_factor: float, tolerance: float
    ) -> tuple[tuple[TablePart, ...], TableError]:
        """One constant, or one part over what is read: wind speed and angle, depth."""
        axes, count = known_speed_axes(self, load_factor), len(self.speeds_full)
        return tabulate_predicted_speed(self, axes, count, load_factor, tolerance=tolerance)

    def tabulate_fuel(
        self, load_factor: float, tolerance: float
    ) -> tuple[tuple[TablePart, ...], TableError]:
        """One constant: the fuel rate of the setting in all weather."""
        return (constant_part(self.fuel_rates),), TableError(0.0, 0.0, 0.0, 0)

    def tabulate_power(
        self, load_factor: float, tolerance: float
    ) -> tuple[tuple[TablePart, ...], TableError]:
        """One constant: the power of the setting in all weather."""
        return (constant_part(self.powers),), TableError(0.0, 0.0, 0.0, 0)

    def notes(self, conditions: Conditions, setting: ArrayLike) -> list[RangeNote]:
        """Where the speed loss is used outside its range."""
        if self.loss is None:
            return []
        index = setting_index(setting, len(self.speeds_full))
        calm = interpolate_loading(
            conditions.load_factor, empty=self.speeds_empty[index], full=self.speeds_full[index]
        )
        return self.loss.notes(conditions, calm)

    def greatest_speed(self, load_factor: float) -> float:
        """Greatest calm-water speed [m/s] whose power or fuel the ship file gives."""
        full, empty = (self.law.rows or (self.speeds_full, self.speeds_empty))[:2]
        known = interpolate_loading(load_factor, empty=empty, full=full)
        return float(max(known[-1], self.speeds(load_factor)[-1]))

    def with_speeds(self, speeds: FloatArray, load_factor: float) -> KnownSpeedModel:
        """Return the model with other settings, given by calm-water speed [m/s] at a load factor.

        Raises
        ------
        InputError
            If a speed is outside the table, or above the highest speed of a ship without law.
        """
        own_rows = (self.speeds_full, self.speeds_empty, self.fuel_rates, self.powers)
        rows, name = self.law.rows or own_rows, self.law.name
        own = interpolate_loading(load_factor, empty=rows[1], full=rows[0])
        low, high = (own[0], own[-1]) if name == "table" else (0.0, _HIGHEST)
        if name == "none":
            high = own[-1] if len(own) > 1 else _HIGHEST
        possible = np.isfinite(speeds) & (speeds > 0)
        if not (possible & (speeds >= low * (1 - 1e-9)) & (speeds <= high * (1 + 1e-9))).all():
            raise _speed_out_of_range_error(speeds, low, high, own)
        full, empty = (np.interp(speeds, own, column) for column in rows[:2])
        if name != "table":  # beyond the settings both grow as the speed does
            beyond = speeds / np.clip(speeds, own[0], own[-1])
            full, empty = full * beyond, empty * beyond
        hotel = self.law.hotel_fuel
        fuel = hotel + _values_by_law(name, rows[0], rows[2] - hotel, full)
        power = _values_by_law(name, rows[0], rows[3], full)
        if self.law.power_to_fuel_rate is not None:
            fuel = self.law.power_to_fuel_rate(power)
        law = replace(self.law, rows=rows)
        return KnownSpeedModel(full, empty, fuel, power, law, self.loss, self.squat)


def _values_by_law(
    law: str, speeds: FloatArray, values: FloatArray, wanted: FloatArray
) -> FloatArray:
    """Fuel rates or powers at other full speeds, by a law."""
    if law == "cubic":
        return np.asarray(values[-1] * (wanted / speeds[-1]) ** 3)
    if law == "table":
        return np.interp(wanted, speeds, values)
    return np.full(len(wanted), np.nan)


def cubic_law(speed: ArrayLike, *, reference_speed: float, reference_value: float) -> FloatArray:
    """Power or fuel rate that grows with the cube of speed, through one reference point.

    Parameters
    ----------
    speed : array_like [m/s]
    reference_speed : [m/s].
    reference_value : Power [W] or fuel rate [kg/s] at the reference speed.

    Returns
    -------
    ndarray : In the unit of the reference value.

    Notes
    -----
    The usual rule of thumb (for example Fagerholt et al. 2010); fair within a few knots of the
    reference speed.
    """
    return reference_value * (np.asarray(speed, float) / reference_speed) ** 3


def check_table_rises(speeds: FloatArray, columns: Mapping[str, Any]) -> None:
    """Refuse a table whose speeds repeat, or whose power or fuel falls while the speed rises.

    Parameters
    ----------
    speeds : Speeds of the table, (n,).
    columns : Power and fuel at the speeds, by name.
    """
    if (np.diff(speeds) <= 0).any():
        raise InputError(
            "The ship's table has a speed twice.",
            "Each row is one engine setting with its own speed.",
            "Remove one of the rows.",
            key="table.speed_kn",
        )
    for name, values in columns.items():
        falls = np.flatnonzero(np.diff(values) < 0)
        if falls.size:
            k = int(falls[0])
            raise InputError(
                f"In the ship's table {name} falls from {values[k]:g} to {values[k + 1]:g} while "
                "the speed rises.",
                "More speed takes more power and fuel.",
                "Correct or remove the row.",
                key=f"table.{name}",
            )


def known_speed_axes(model: KnownSpeedModel, load_factor: float) -> list[AxisRange]:
    """Return the axes of the tables of a ship with known speeds: wind speed and angle, depth."""
    axes: list[AxisRange] = []
    if model.loss is not None:
        axes += model.loss.axes(257 if model.squat is None else 65)
    if model.squat is not None:
        axes.append(_depth_axis(model.squat, load_factor, 1025 if model.loss is None else 257))
    return axes


def _depth_axis(squat: SquatModel, load_factor: float, size: int) -> AxisRange:
    """Depth from the least at which the ship can sail, to twelve draughts."""
    draught = float(squat.loading.draught_at(load_factor))
    low = draught + squat.clearance
    return AxisRange(codes.AXIS_DEPTH, low, max(12.0 * draught, low + 60.0), size)


def _shape(conditions: Conditions, index: NDArray[np.intp]) -> tuple[int, ...]:
    return np.broadcast_shapes(conditions.shape, index.shape)


def _speed_out_of_range_error(
    speeds: FloatArray, low: float, high: float, own: FloatArray
) -> InputError:
    """Return the error for speeds outside what is possible, with the speeds of the ship file."""
    listed = ", ".join(f"{s / KNOT:g}" for s in speeds)
    possible = f"Its calm-water speeds run from {low / KNOT:g} to {high / KNOT:g} kn."
    if low == 0.0:
        ends = dict.fromkeys((f"{own[0] / KNOT:.4g}", f"{own[-1] / KNOT:.4g}"))
        most = f" and at most {high / KNOT:g} kn" if (speeds > high).any() else ""
        possible = f"Speeds are above 0{most}; the ship file gives {' to '.join(ends)} kn."
    return InputError(
        f"The ship cannot be ordered to {listed} kn.",
        possible,
        "Give speeds in that range.",
        value=listed,
    )
