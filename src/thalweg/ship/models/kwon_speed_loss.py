"""Kwon's involuntary speed loss for the particulars of a ship, and where it predicts no speed.

The loss grows with the Beaufort number to the power 6.5. In a gale it leaves a small ship a
hundredth of her speed, which no ship shows. Where it leaves less than half of the speed outside its
range there is no prediction: plans keep out of such weather, and a route in it breaks a limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import GRAVITY
from thalweg.kernels import codes
from thalweg.ship.condition_variables import CONDITION_OF_AXIS
from thalweg.ship.conditions import Conditions
from thalweg.ship.loading_state import Loading
from thalweg.ship.methods.speed_loss import (
    LARGEST_FORM_COEFFICIENT,
    LastTermSign,
    ShipType,
    beaufort_number,
    greatest_kwon_beaufort,
    kwon_form_coefficient,
    kwon_notes,
    kwon_speed_loss,
)
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.tables.table_parts import TableError, TablePart
from thalweg.ship.tables.tabulate import DEFAULT_AXES, AxisRange, tabulate_settings

LEAST_SPEED_SHARE: Final = 0.5  #: of the speed in calm air; below it a loss out of range says none
#: Tables end a little earlier, so that routes of a search do not break the limit between points.
_SHARE_IN_TABLES: Final = 0.52


@dataclass(frozen=True)
class KwonSpeedLoss:
    """Kwon's speed loss for the particulars of a ship (see `kwon_speed_loss`).

    Attributes
    ----------
    length : Between perpendiculars [m].
    loading : Displacement and condition.
    sign, ship_type, classes : Choices of the method.
    """

    length: float
    block_coefficient: float
    loading: Loading
    sign: LastTermSign = "plus"
    ship_type: ShipType = "other"
    classes: bool = False

    @property
    def reads(self) -> frozenset[str]:
        """Conditions read."""
        return frozenset({"wind_speed", "wind_angle"})

    def axes(self, size: int) -> list[AxisRange]:
        """Axes of tables: wind speed and angle."""
        return [replace(DEFAULT_AXES["wind_speed"], size=size), self._angle_axis()]

    def _angle_axis(self) -> AxisRange:
        """Return the wind angle in steps of 15 degrees: the continuous loss is exact on them."""
        return AxisRange(codes.AXIS_WIND_ANGLE, 0.0, np.pi, 13, fixed=not self.classes)

    def share(self, conditions: Conditions, speed: FloatArray) -> FloatArray:
        """Share of the calm-water speed [m/s] that is lost, 0 to 0.99."""
        return kwon_speed_loss(
            conditions.wind_speed,
            conditions.wind_angle,
            speed=speed,
            length=self.length,
            block_coefficient=self.block_coefficient,
            displacement_volume=self.loading.displacement_at(conditions.load_factor),
            loading=self.loading.condition,
            ship_type=self.ship_type,
            sign=self.sign,
            classes=self.classes,
            hold=not self.classes,
        )

    def is_out_of_range(self, conditions: Conditions) -> BoolArray:
        """Return where the wind is stronger than the method is made for."""
        number = beaufort_number(conditions.wind_speed)
        volume = self.loading.displacement_at(conditions.load_factor)
        form = kwon_form_coefficient(
            number,
            displacement_volume=volume,
            loading=self.loading.condition,
            ship_type=self.ship_type,
        )
        return (number > greatest_kwon_beaufort(volume)) | (form > LARGEST_FORM_COEFFICIENT)

    def notes(self, conditions: Conditions, speed: ArrayLike) -> list[RangeNote]:
        """Where the method is used outside its range, at calm-water speeds [m/s]."""
        return kwon_notes(
            conditions.wind_speed,
            froude=np.asarray(speed, float) / np.sqrt(GRAVITY * self.length),
            block_coefficient=self.block_coefficient,
            displacement_volume=self.loading.displacement_at(conditions.load_factor),
            loading=self.loading.condition,
            ship_type=self.ship_type,
        )


class ShipThatLosesSpeed(Protocol):
    """A ship, or a model of one, whose speed may be reduced by an involuntary loss."""

    @property
    def loss(self) -> object:
        """The loss, of any method; None without."""
        ...

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Speed through water [m/s]."""
        ...


def predicted_share(
    model: ShipThatLosesSpeed, conditions: Conditions, setting: ArrayLike, speed: FloatArray
) -> FloatArray:
    """Return the share of the speed in calm air that a loss outside its range leaves.

    Parameters
    ----------
    model : With the loss.
    conditions, setting : Where the speed is asked for.
    speed : What the model gives there [m/s].

    Returns
    -------
    ndarray : 1 where the loss is of another method or within its range; NaN where unknown.
    """
    loss, speed = model.loss, np.asarray(speed, float)
    if not isinstance(loss, KwonSpeedLoss):
        return np.ones(speed.shape)
    outside = np.broadcast_to(loss.is_out_of_range(conditions), speed.shape)
    if not outside.any():
        return np.ones(speed.shape)
    calm = model.speed_through_water(conditions.with_values(wind_speed=0.0), setting)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(outside, speed / calm, 1.0)


def tabulate_predicted_speed(
    model: ShipThatLosesSpeed,
    axes: Sequence[AxisRange],
    settings: int,
    load_factor: float,
    *,
    tolerance: float,
) -> tuple[tuple[TablePart, ...], TableError]:
    """Tabulate the speed through water for searches: NaN where none is predicted.

    Parameters
    ----------
    axes, settings, load_factor, tolerance : As for `tabulate_settings`.

    Returns
    -------
    parts, error : The error is that of the speed of the model, before entries are closed.
    """
    speed = model.speed_through_water
    parts, error = tabulate_settings(speed, axes, settings, load_factor, tolerance=tolerance)
    return tuple(_without_unpredicted(model, part, load_factor) for part in parts), error


def _without_unpredicted(
    model: ShipThatLosesSpeed, part: TablePart, load_factor: float
) -> TablePart:
    """Return a part of a table with NaN where the loss leaves too little to predict the speed."""
    if codes.AXIS_WIND_SPEED not in part.axes:
        return part
    mesh = np.meshgrid(*part.grids, indexing="ij", sparse=True)
    columns = {CONDITION_OF_AXIS[axis]: grid[..., None] for axis, grid in zip(part.axes, mesh)}
    here = Conditions(columns, load_factor=load_factor)
    speed = np.asarray(part.values, float)
    share = predicted_share(model, here, np.arange(speed.shape[-1]), speed)
    closed = np.where(share < _SHARE_IN_TABLES, np.nan, part.values)
    return replace(part, values=closed, before_closing=part.values)
