"""The rate of the squared motion sickness dose as a table, for searches that minimise it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.ship.comfort.onboard_motions import OnboardMotions, required_motions
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_parts import TablePart
from thalweg.ship.tables.tabulate import table_error

if TYPE_CHECKING:
    from thalweg.ship.ship import Ship

_HIGHEST: Final = 24.0  # significant wave height of the table [m]
_LEAST_HEIGHT: Final = 0.05  # stands for a flat sea, where the rate over the squared height is 0/0
_GRID_SIZES: Final = {"wave_height": 25, "wave_angle": 19, "wave_period": 31}
_AXES: Final = (codes.AXIS_WAVE_HEIGHT, codes.AXIS_WAVE_ANGLE, codes.AXIS_WAVE_PERIOD)
_SAMPLES: Final = 500
_SAMPLED_HEIGHTS: Final = (0.2, 8.0)
_SAMPLED_PERIODS: Final = (3.0, 20.0)
_STILL: Final = {"wind_speed": 0.0, "wind_angle": 0.0, "depth": 1e4}


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
        measured at random conditions between 0.2 and 8 m and 3 and 20 s.

    Raises
    ------
    InputError : If the ship has no places, or not the particulars for her motions.
    """
    own = required_motions(ship)
    own = replace(own, places={own.first_place: own.places[own.first_place]}, tasks={})
    ends = ((0.0, _HIGHEST), (0.0, math.pi), (0.0, 30.0))
    grids = [np.linspace(*end, size) for end, size in zip(ends, _GRID_SIZES.values())]
    height, angle, period = np.meshgrid(*grids, indexing="ij", sparse=True)
    height = np.maximum(height, _LEAST_HEIGHT)
    values = _rates(ship, own, height, angle, period) / (height**2)[..., None]
    part = TablePart(_AXES, tuple(grids), values.astype(np.float32), _HIGHEST)
    draw = np.random.default_rng(0)
    where = {
        "wave_height": draw.uniform(*_SAMPLED_HEIGHTS, _SAMPLES),
        "wave_angle": draw.uniform(0.0, math.pi, _SAMPLES),
        "wave_period": draw.uniform(*_SAMPLED_PERIODS, _SAMPLES),
    }
    error = table_error(part.lookup_all(where), _rates(ship, own, *where.values()))
    return PerformanceTable((part,), ship.speeds, ship.fingerprint(), error)


def _rates(
    ship: Ship, own: OnboardMotions, height: FloatArray, angle: FloatArray, period: FloatArray
) -> FloatArray:
    """Return the squared weighted acceleration [m2/s4] of every setting, on the last axis."""
    height, angle, period = (x[..., None] for x in (height, angle, period))
    given = {"wave_height": height, "wave_angle": angle, "wave_period": np.maximum(period, 2.0)}
    speed = np.asarray(ship.speeds, float)
    if ship.speed_field is None:
        found = ship.tabulate().lookup({**_STILL, **given}, np.arange(len(speed)))
        speed = np.where(np.isfinite(found), found, speed)  # too rough: the speed table refuses
    state = own.at(speed, wave_angle=angle, wave_height=height, wave_period=period)
    return np.asarray(state.places[own.first_place].weighted ** 2)
