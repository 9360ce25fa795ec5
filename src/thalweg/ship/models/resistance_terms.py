"""What wind, waves and depth add to the resistance, each on its own axes of conditions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.ship.models.added_resistance_model import AddedWaveResistance
from thalweg.ship.models.force_balance import CALM_CONDITIONS, ForceBalance
from thalweg.ship.ship_limits import ShipLimits
from thalweg.ship.tables.table_parts import TablePart
from thalweg.ship.tables.tabulate import AxisRange, random_conditions

#: first grids
_INITIAL_AXES: Final = {
    "wind_speed": AxisRange(codes.AXIS_WIND_SPEED, 0.0, 40.0, 26),
    "wind_angle": AxisRange(codes.AXIS_WIND_ANGLE, 0.0, np.pi, 37),
    "wave_height": AxisRange(codes.AXIS_WAVE_HEIGHT, 0.0, 12.0, 2),
    "wave_angle": AxisRange(codes.AXIS_WAVE_ANGLE, 0.0, np.pi, 97),
    "wave_period": AxisRange(codes.AXIS_WAVE_PERIOD, 0.0, 30.0, 61),
}
_SECTOR_ANGLES: Final = 1537  #: angles of methods that end at the edge of a sector
_DEPTH_POINTS: Final = 129


@dataclass(frozen=True, eq=False)
class ResistanceTerm:
    """One part of the resistance that depends on conditions.

    Attributes
    ----------
    force : ``f(speed, *axis values)`` [N], arrays that broadcast; over the square of the wave
        height for waves.
    squared_height_limit : See `TablePart`.
    """

    axes: tuple[AxisRange, ...]
    force: Callable[..., FloatArray]
    squared_height_limit: float = np.nan

    def part(self, speeds: FloatArray) -> TablePart:
        """Tabulate the force [N] at speeds [m/s], per squared wave height if proportional."""
        mesh = np.meshgrid(*(axis.grid for axis in self.axes), indexing="ij", sparse=True)
        at = [values[..., None] for values in mesh]
        shape = (*(axis.size for axis in self.axes), len(speeds))
        force = np.array(np.broadcast_to(self.force(speeds, *at), shape), np.float32)
        force[np.isnan(force).any(axis=-1)] = np.nan
        axes = tuple(axis.axis for axis in self.axes)
        return TablePart(
            axes, tuple(axis.grid for axis in self.axes), force, self.squared_height_limit
        )

    def refined(self, part: TablePart, scale: FloatArray) -> ResistanceTerm:
        """Return the term with steps of half the length on the axis with the largest curvature."""
        weight = (
            1.0 if np.isnan(self.squared_height_limit) else (0.5 * self.squared_height_limit) ** 2
        )
        bends = [
            float(np.nanquantile(np.abs(np.diff(part.values, 2, axis=k)) * weight / scale, 0.995))
            for k in range(len(self.axes))
        ]
        worst = int(np.argmax(bends))
        axes = tuple(a.refined() if k == worst else a for k, a in enumerate(self.axes))
        return replace(self, axes=axes)


def resistance_terms(balance: ForceBalance, limits: ShipLimits) -> list[ResistanceTerm]:
    """Return what wind, waves and depth add to the resistance, up to the limits.

    Parameters
    ----------
    balance : Forces of the ship at one draught.
    limits : Greatest wave height and wind speed.
    """
    axes, terms = condition_axes(balance, limits), []
    wind, waves, calm = balance.wind, balance.waves, balance.calm
    if wind is not None:

        def wind_force(v: FloatArray, speed: FloatArray, angle: FloatArray) -> FloatArray:
            still = wind.force(v, np.zeros(()), np.zeros(()))
            return wind.force(v, speed, angle) - still

        terms.append(ResistanceTerm((axes["wind_speed"], axes["wind_angle"]), wind_force))
    if waves is not None:
        terms.append(_wave_term(waves, axes))
    if "depth" in axes:

        def depth_force(v: FloatArray, depth: FloatArray) -> FloatArray:
            return calm.total(v, depth) - calm.total(v, np.asarray(np.inf))

        terms.append(ResistanceTerm((axes["depth"],), depth_force))
    return terms


def _wave_term(waves: AddedWaveResistance, axes: Mapping[str, AxisRange]) -> ResistanceTerm:
    stop = axes["wave_height"].stop
    if waves.method in ("stawave_1", "stawave_2"):
        axes = {**axes, "wave_angle": replace(axes["wave_angle"], size=_SECTOR_ANGLES)}
    if "wave_period" in waves.reads:

        def wave_force(v: FloatArray, angle: FloatArray, period: FloatArray) -> FloatArray:
            return waves.force(v, np.ones(()), period, angle)

        return ResistanceTerm((axes["wave_angle"], axes["wave_period"]), wave_force, stop)

    def wave_force_by_angle(v: FloatArray, angle: FloatArray) -> FloatArray:
        return waves.force(v, np.ones(()), np.asarray(10.0), angle)

    return ResistanceTerm((axes["wave_angle"],), wave_force_by_angle, stop)


def condition_axes(balance: ForceBalance, limits: ShipLimits) -> dict[str, AxisRange]:
    """Return the axes a balance has, by condition: up to the limits, from just below the keel.

    Parameters
    ----------
    balance : Forces of the ship at one draught.
    limits : Greatest wave height and wind speed.
    """
    axes = {name: axis for name, axis in _INITIAL_AXES.items() if name in balance.reads}
    for name, limit in (("wind_speed", limits.wind_speed), ("wave_height", limits.wave_height)):
        if name in axes:
            axes[name] = replace(axes[name], stop=min(axes[name].stop, 1.0001 * limit))
    if "depth" in balance.reads:
        draught = float(balance.calm.hull.values["draught_m"])
        length = float(balance.calm.hull.values["length_waterline_m"])
        stop = draught + 1.1 * length
        axes["depth"] = AxisRange(codes.AXIS_DEPTH, 1.05 * draught, stop, _DEPTH_POINTS)
    return axes


def random_term_conditions(
    terms: list[ResistanceTerm], count: int, seed: int
) -> dict[str, FloatArray]:
    """Return random conditions over the ranges of terms, by name."""
    axes = [axis for term in terms for axis in term.axes]
    axes += [
        replace(_INITIAL_AXES["wave_height"], stop=term.squared_height_limit)
        for term in terms
        if not np.isnan(term.squared_height_limit)
    ]
    return random_conditions(axes, count, seed)


def conditions_per_setting(
    where: Mapping[str, FloatArray], count: int
) -> tuple[dict[str, FloatArray], FloatArray, tuple[int, ...]]:
    """Return flat conditions for every setting, the settings, and the shape of the answer."""
    shape = np.broadcast_shapes(*(np.shape(values) for values in where.values()))
    at = {
        name: np.repeat(np.broadcast_to(where.get(name, calm), shape).ravel(), count)
        for name, calm in CALM_CONDITIONS.items()
    }
    which = np.tile(np.arange(float(count)), int(np.prod(shape)))
    return at, which, (*shape, count)
