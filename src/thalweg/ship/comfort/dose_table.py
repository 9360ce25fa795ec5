"""The rate of the squared motion sickness dose as a table, for searches that minimise it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.ship.comfort.onboard_motions import OnboardMotions, required_motions
from thalweg.ship.methods.seakeeping.wave_spectra import STEEPEST, wave_steepness
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_parts import TablePart
from thalweg.ship.tables.tabulate import table_error

if TYPE_CHECKING:
    from thalweg.ship.ship import Ship

_HIGHEST: Final = 24.0  # significant wave height of the table [m]
_LEAST_HEIGHT: Final = 0.05  # stands for a flat sea, where the rate over the squared height is 0/0
_GRID_SIZES: Final = {"wave_height": 25, "wave_angle": 19, "wave_period": 61}
_AXES: Final = (codes.AXIS_WAVE_HEIGHT, codes.AXIS_WAVE_ANGLE, codes.AXIS_WAVE_PERIOD)
_SAMPLES: Final = 500
_SAMPLED_HEIGHTS: Final = (0.2, 8.0)
_SAMPLED_PERIODS: Final = (3.0, 20.0)
_STILL: Final = {"wind_speed": 0.0, "wind_angle": 0.0, "depth": 1e4}


@lru_cache(maxsize=8)
def squared_dose_table(ship: Ship) -> PerformanceTable:
    r"""Tabulate the squared weighted acceleration at the first place of a ship.

    .. math:: MSDV^2 = \int a_w^2 \, dt

    adds up over the legs of a route, so that it is searched like fuel. The speed through water is
    that in these waves without wind; the referee uses the speed in all weather.

    Parameters
    ----------
    ship : With places in her file.

    Returns
    -------
    PerformanceTable : [m2/s4] by wave height, angle and period, for every setting. Its error is
        measured at random conditions (`sampled_conditions`).

    Raises
    ------
    InputError : If the ship has no places, or not the particulars for her motions.
    """
    own = _first_place(ship)
    ends = ((0.0, _HIGHEST), (0.0, math.pi), (0.0, 30.0))
    grids = [np.linspace(*end, size) for end, size in zip(ends, _GRID_SIZES.values())]
    height, angle, period = np.meshgrid(*grids, indexing="ij", sparse=True)
    where = {"wave_height": np.maximum(height, _LEAST_HEIGHT), "wave_angle": angle}
    where["wave_period"] = period
    speed = _speed_in_waves(ship, where)
    for k in range(1, len(speed)):  # too rough for a setting: go on smoothly, without a step
        speed[k] = np.where(np.isfinite(speed[k]), speed[k], speed[k - 1])
    speed = np.where(np.isfinite(speed), speed, np.asarray(ship.speeds, float))
    values = _rates(own, speed, where) / (where["wave_height"] ** 2)[..., None]
    part = TablePart(_AXES, tuple(grids), values.astype(np.float32), _HIGHEST)
    samples = sampled_conditions(_SAMPLES, 0)
    truth = squared_dose_rates(ship, samples)
    found = np.where(np.isfinite(truth), part.lookup_all(samples), np.nan)
    return PerformanceTable((part,), ship.speeds, ship.fingerprint(), table_error(found, truth))


def sampled_conditions(count: int, seed: int) -> dict[str, FloatArray]:
    """Return random wave heights [m], angles [rad] and peak periods [s] of possible seas.

    Waves are at most a tenth as high as long: h <= 0.1 g T^2 / (2 pi).

    Parameters
    ----------
    count : Draws before those too steep are left out.
    """
    draw = np.random.default_rng(seed)
    height = draw.uniform(*_SAMPLED_HEIGHTS, count)
    angle, period = draw.uniform(0.0, math.pi, count), draw.uniform(*_SAMPLED_PERIODS, count)
    possible = wave_steepness(height, period) <= STEEPEST
    found = {"wave_height": height, "wave_angle": angle, "wave_period": period}
    return {name: values[possible] for name, values in found.items()}


def squared_dose_rates(ship: Ship, where: Mapping[str, FloatArray]) -> FloatArray:
    """Return the squared weighted acceleration at the first place, computed directly.

    Parameters
    ----------
    where : Wave height [m], angle [rad] and peak period [s].

    Returns
    -------
    float64 array (..., settings) : [m2/s4]; NaN where waves are too rough for a setting.
    """
    return _rates(_first_place(ship), _speed_in_waves(ship, where), where)


def _first_place(ship: Ship) -> OnboardMotions:
    own = required_motions(ship)
    return replace(own, places={own.first_place: own.places[own.first_place]}, tasks={})


def _speed_in_waves(ship: Ship, where: Mapping[str, FloatArray]) -> FloatArray:
    """Return the speed of every setting [m/s]; NaN where waves are too rough for it."""
    speed = np.asarray(ship.speeds, float)
    given = {name: values[..., None] for name, values in where.items()}
    shape = np.broadcast_shapes(*(values.shape for values in given.values()), speed.shape)
    if ship.speed_field is not None:
        return np.broadcast_to(speed, shape).copy()
    given["wave_period"] = np.maximum(given["wave_period"], 2.0)
    found = ship.tabulate().lookup({**_STILL, **given}, np.arange(len(speed)))
    return np.broadcast_to(found, shape).copy()


def _rates(own: OnboardMotions, speed: FloatArray, where: Mapping[str, FloatArray]) -> FloatArray:
    """Return the squared weighted acceleration [m2/s4] of every setting, on the last axis."""
    state = own.at(speed, **{name: values[..., None] for name, values in where.items()})
    return np.asarray(state.places[own.first_place].weighted ** 2)
