"""From resistance to brake power: hull, propeller, shaft and gear.

Sources: wake fraction, thrust deduction and relative rotative efficiency of J. Holtrop and G.G.J.
Mennen (1982) and J. Holtrop (1984), as in `thalweg.ship.methods.resistance.holtrop_mennen`;
constant efficiencies of Schless (2023), Table 3.1, after Segers (2021).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import SEA_WATER_DENSITY
from thalweg.ship.methods.propulsion.b_series import Propeller, operating_point


@dataclass(frozen=True)
class Efficiencies:
    """Constant efficiencies; the defaults are those of Schless (2023) with a hull efficiency of 1.

    Attributes
    ----------
    open_water, relative_rotative, hull, transmission, gear : float
        eta_0, eta_R, eta_H (0.97 to 1.03 there), eta_T and eta_G.
    """

    open_water: float = 0.60
    relative_rotative: float = 0.98
    hull: float = 1.0
    transmission: float = 0.98
    gear: float = 0.96

    @property
    def total(self) -> float:
        """Effective over brake power."""
        propulsive = self.open_water * self.relative_rotative * self.hull
        return propulsive * self.transmission * self.gear


@dataclass(frozen=True)
class PropulsionState:
    """State of the propulsion; arrays of one shape.

    Attributes
    ----------
    thrust : Of all propellers [N].
    rate : Of the propellers [1/s].
    open_water_efficiency : eta_0.
    effective_power, brake_power : ndarray
        R V, power of the engines [W].
    """

    thrust: FloatArray
    rate: FloatArray
    open_water_efficiency: FloatArray
    effective_power: FloatArray
    brake_power: FloatArray


def effective_power(speed: ArrayLike, resistance: ArrayLike) -> FloatArray:
    """P_E = R V [W]."""
    return np.asarray(np.asarray(speed, dtype=float) * np.asarray(resistance, dtype=float))


def constant_efficiency_power(
    speed: ArrayLike, resistance: ArrayLike, *, efficiencies: Efficiencies | None = None
) -> FloatArray:
    """Brake power R V / (eta_0 eta_R eta_H eta_T eta_G) [W]; zero where wind or waves push.

    Parameters
    ----------
    speed : array_like [m/s]
    resistance : array_like [N]
    efficiencies : `Efficiencies` as it comes by default.
    """
    share = (efficiencies or Efficiencies()).total
    return np.asarray(np.maximum(effective_power(speed, resistance), 0.0) / share)


def propulsion(
    speed: ArrayLike,
    resistance: ArrayLike,
    propeller: Propeller,
    *,
    wake_fraction: ArrayLike,
    thrust_deduction: ArrayLike,
    relative_rotative: ArrayLike = 1.0,
    shaft_efficiency: ArrayLike = 0.99,
    gear_efficiency: ArrayLike = 1.0,
    propellers: int = 1,
    density: float = SEA_WATER_DENSITY,
    reynolds: float | None = None,
) -> PropulsionState:
    r"""Find the powers that overcome a resistance, with propellers of the B-series.

    .. math::
        P_B = \frac{2 \pi n Q N}{\eta_R \eta_S \eta_G}, \quad T = \frac{R}{N (1 - t)}, \quad
            V_A = V (1 - w)

    Parameters
    ----------
    speed, resistance : Speed through the water [m/s] and total resistance [N]. A ship that is
        pushed (negative resistance) needs no thrust.
    propeller : One of them.
    wake_fraction, thrust_deduction, relative_rotative : w, t and eta_R.
    shaft_efficiency, gear_efficiency : Of the shaft line and of the gear (1 without one).
    propellers : How many share the thrust.
    density : float [kg/m3]
    reynolds : See `thalweg.ship.methods.propulsion.b_series.b_series_polynomials`.

    References
    ----------
    Definitions of the ITTC; the propeller by `operating_point`.
    """
    velocity, drag = np.broadcast_arrays(
        np.asarray(speed, dtype=float), np.asarray(resistance, dtype=float)
    )
    thrust = np.maximum(drag, 0.0) / (1.0 - np.asarray(thrust_deduction, dtype=float))
    inflow = velocity * (1.0 - np.asarray(wake_fraction, dtype=float))
    state = operating_point(
        thrust / propellers, inflow, propeller, density=density, reynolds=reynolds
    )
    delivered = propellers * state.power / np.asarray(relative_rotative)
    losses = np.asarray(shaft_efficiency, dtype=float) * np.asarray(gear_efficiency, dtype=float)
    return PropulsionState(
        thrust,
        state.rate,
        state.efficiency,
        effective_power(velocity, drag),
        np.asarray(delivered / losses),
    )
