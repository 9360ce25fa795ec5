"""Friction lines, Froude and Reynolds numbers that several methods share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, SEA_WATER_DENSITY

SEA_WATER_VISCOSITY: Final = 1.1883e-6  #: kinematic viscosity at 15 degC, 3.5 % salt [m2/s]
_LEAST_REYNOLDS: Final = 1.0e5


@dataclass(frozen=True)
class Water:
    """Properties of the water; the defaults are those of the sea at 15 degC.

    Attributes
    ----------
    density : float [kg/m3]
    viscosity : Kinematic viscosity [m2/s].
    gravity : float [m/s2]
    """

    density: float = SEA_WATER_DENSITY
    viscosity: float = SEA_WATER_VISCOSITY
    gravity: float = GRAVITY


def ship_speed(speed: ArrayLike) -> FloatArray:
    """Return speeds as floats; a negative speed (astern) is unknown to every method: NaN."""
    values = np.asarray(speed, dtype=float)
    return np.where(values < 0.0, np.nan, values)


def froude_number(speed: ArrayLike, *, length: ArrayLike, gravity: float = GRAVITY) -> FloatArray:
    """Froude number V / sqrt(g L).

    Parameters
    ----------
    speed : Speed through the water [m/s].
    length : Length [m]; the water depth gives the depth Froude number.
    gravity : float [m/s2]
    """
    return np.asarray(speed, dtype=float) / np.sqrt(gravity * np.asarray(length, dtype=float))


def reynolds_number(
    speed: ArrayLike, *, length: ArrayLike, viscosity: ArrayLike = SEA_WATER_VISCOSITY
) -> FloatArray:
    """Reynolds number V L / nu, not below 1e5.

    With the bound the friction lines, which have a pole near Re = 100, are finite for a ship that
    hardly moves; the resistance still goes to zero with the square of the speed.

    Parameters
    ----------
    speed : array_like [m/s]
    length : array_like [m]
    viscosity : Kinematic viscosity [m2/s].
    """
    raw = np.asarray(speed, dtype=float) * np.asarray(length, dtype=float) / np.asarray(viscosity)
    return np.asarray(np.maximum(raw, _LEAST_REYNOLDS))


def ittc_1957(reynolds: ArrayLike) -> FloatArray:
    r"""ITTC 1957 model-ship correlation line, C_F = 0.075 / (log10 Re - 2)^2.

    .. math:: C_F = \frac{0.075}{(\log_{10} Re - 2)^2}

    Source: 8th ITTC (1957), Madrid.

    References
    ----------
    8th ITTC (1957), Madrid.
    """
    return np.asarray(0.075 / (np.log10(np.asarray(reynolds, dtype=float)) - 2.0) ** 2)


def dynamic_force(
    coefficient: ArrayLike, *, speed: ArrayLike, area: ArrayLike, density: ArrayLike
) -> FloatArray:
    """Force 0.5 rho V^2 A C [N].

    Parameters
    ----------
    coefficient : Force coefficient C [-].
    speed : Speed V [m/s].
    area : Reference area A [m2].
    density : Density rho of the fluid [kg/m3].

    Returns
    -------
    ndarray : Force [N].

    References
    ----------
    Definition of the force coefficients.
    """
    velocity = np.asarray(speed, dtype=float)
    force = 0.5 * np.asarray(density) * velocity**2 * np.asarray(area) * np.asarray(coefficient)
    return np.asarray(force)
