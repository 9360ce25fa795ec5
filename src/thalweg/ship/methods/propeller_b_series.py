"""Open-water propellers of the Wageningen B-series.

Source: M.W.C. Oosterveld and P. van Oossanen, "Further computer-analyzed data of the Wageningen
B-screw series", International Shipbuilding Progress 22 (1975) 251-262: polynomials of 39 and 47
terms for Rn = 2e6, and their Reynolds correction. The coefficients agree between several
independent reprints; the worked example of Holtrop and Mennen (1982) is among the tests.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.units import SEA_WATER_DENSITY
from thalweg.ship.methods.friction import FloatArray
from thalweg.ship.methods.notes import RangeNote, range_notes

# Coefficient and powers of J, P/D, A_E/A_0 and Z.
_THRUST: Final = np.array(
    [
        [0.00880496, 0, 0, 0, 0],
        [-0.204554, 1, 0, 0, 0],
        [0.166351, 0, 1, 0, 0],
        [0.158114, 0, 2, 0, 0],
        [-0.147581, 2, 0, 1, 0],
        [-0.481497, 1, 1, 1, 0],
        [0.415437, 0, 2, 1, 0],
        [0.0144043, 0, 0, 0, 1],
        [-0.0530054, 2, 0, 0, 1],
        [0.0143481, 0, 1, 0, 1],
        [0.0606826, 1, 1, 0, 1],
        [-0.0125894, 0, 0, 1, 1],
        [0.0109689, 1, 0, 1, 1],
        [-0.133698, 0, 3, 0, 0],
        [0.00638407, 0, 6, 0, 0],
        [-0.00132718, 2, 6, 0, 0],
        [0.168496, 3, 0, 1, 0],
        [-0.0507214, 0, 0, 2, 0],
        [0.0854559, 2, 0, 2, 0],
        [-0.0504475, 3, 0, 2, 0],
        [0.010465, 1, 6, 2, 0],
        [-0.00648272, 2, 6, 2, 0],
        [-0.00841728, 0, 3, 0, 1],
        [0.0168424, 1, 3, 0, 1],
        [-0.00102296, 3, 3, 0, 1],
        [-0.0317791, 0, 3, 1, 1],
        [0.018604, 1, 0, 2, 1],
        [-0.00410798, 0, 2, 2, 1],
        [-0.000606848, 0, 0, 0, 2],
        [-0.0049819, 1, 0, 0, 2],
        [0.0025983, 2, 0, 0, 2],
        [-0.000560528, 3, 0, 0, 2],
        [-0.00163652, 1, 2, 0, 2],
        [-0.000328787, 1, 6, 0, 2],
        [0.000116502, 2, 6, 0, 2],
        [0.000690904, 0, 0, 1, 2],
        [0.00421749, 0, 3, 1, 2],
        [0.0000565229, 3, 6, 1, 2],
        [-0.00146564, 0, 3, 2, 2],
    ]
)
_TORQUE: Final = np.array(
    [
        [0.00379368, 0, 0, 0, 0],
        [0.00886523, 2, 0, 0, 0],
        [-0.032241, 1, 1, 0, 0],
        [0.00344778, 0, 2, 0, 0],
        [-0.0408811, 0, 1, 1, 0],
        [-0.108009, 1, 1, 1, 0],
        [-0.0885381, 2, 1, 1, 0],
        [0.188561, 0, 2, 1, 0],
        [-0.00370871, 1, 0, 0, 1],
        [0.00513696, 0, 1, 0, 1],
        [0.0209449, 1, 1, 0, 1],
        [0.00474319, 2, 1, 0, 1],
        [-0.00723408, 2, 0, 1, 1],
        [0.00438388, 1, 1, 1, 1],
        [-0.0269403, 0, 2, 1, 1],
        [0.0558082, 3, 0, 1, 0],
        [0.0161886, 0, 3, 1, 0],
        [0.00318086, 1, 3, 1, 0],
        [0.015896, 0, 0, 2, 0],
        [0.0471729, 1, 0, 2, 0],
        [0.0196283, 3, 0, 2, 0],
        [-0.0502782, 0, 1, 2, 0],
        [-0.030055, 3, 1, 2, 0],
        [0.0417122, 2, 2, 2, 0],
        [-0.0397722, 0, 3, 2, 0],
        [-0.00350024, 0, 6, 2, 0],
        [-0.0106854, 3, 0, 0, 1],
        [0.00110903, 3, 3, 0, 1],
        [-0.000313912, 0, 6, 0, 1],
        [0.0035985, 3, 0, 1, 1],
        [-0.00142121, 0, 6, 1, 1],
        [-0.00383637, 1, 0, 2, 1],
        [0.0126803, 0, 2, 2, 1],
        [-0.00318278, 2, 3, 2, 1],
        [0.00334268, 0, 6, 2, 1],
        [-0.00183491, 1, 1, 0, 2],
        [0.000112451, 3, 2, 0, 2],
        [-0.0000297228, 3, 6, 0, 2],
        [0.000269551, 1, 0, 1, 2],
        [0.00083265, 2, 0, 1, 2],
        [0.00155334, 0, 2, 1, 2],
        [0.000302683, 0, 6, 1, 2],
        [-0.0001843, 0, 0, 2, 2],
        [-0.000425399, 0, 3, 2, 2],
        [0.0000869243, 3, 3, 2, 2],
        [-0.0004659, 0, 6, 2, 2],
        [0.0000554194, 1, 6, 2, 2],
    ]
)
# The same for the Reynolds correction, with the power of log10(Rn) - 0.301 last.
_THRUST_REYNOLDS: Final = np.array(
    [
        [0.000353485, 0, 0, 0, 0, 0],
        [-0.00333758, 2, 0, 1, 0, 0],
        [-0.00478125, 1, 1, 1, 0, 0],
        [0.000257792, 2, 0, 1, 0, 2],
        [0.0000643192, 2, 6, 0, 0, 1],
        [-0.0000110636, 2, 6, 0, 0, 2],
        [-0.0000276305, 2, 0, 1, 1, 2],
        [0.0000954, 1, 1, 1, 1, 1],
        [0.0000032049, 1, 3, 1, 2, 1],
    ]
)
_TORQUE_REYNOLDS: Final = np.array(
    [
        [-0.000591412, 0, 0, 0, 0, 0],
        [0.00696898, 0, 1, 0, 0, 0],
        [-0.0000666654, 0, 6, 0, 1, 0],
        [0.0160818, 0, 0, 2, 0, 0],
        [-0.000938091, 0, 1, 0, 0, 1],
        [-0.00059593, 0, 2, 0, 0, 1],
        [0.0000782099, 0, 2, 0, 0, 2],
        [0.0000052199, 2, 0, 1, 1, 1],
        [-0.00000088528, 1, 1, 1, 1, 2],
        [0.0000230171, 0, 6, 0, 1, 1],
        [-0.00000184341, 0, 6, 0, 1, 2],
        [-0.00400252, 0, 0, 2, 0, 1],
        [0.000220915, 0, 0, 2, 0, 2],
    ]
)


@dataclass(frozen=True)
class Propeller:
    """One open propeller.

    Attributes
    ----------
    diameter : float
        D [m].
    pitch_ratio : float
        P / D.
    area_ratio : float
        Expanded blade area ratio A_E / A_0.
    blades : int
        Z.
    """

    diameter: float
    pitch_ratio: float
    area_ratio: float
    blades: int


@dataclass(frozen=True)
class OperatingPoint:
    """State of a propeller that gives a thrust at a speed of advance; arrays of one shape.

    Attributes
    ----------
    advance : ndarray
        J = V_A / (n D).
    rate : ndarray
        n [1/s].
    torque : ndarray
        Open-water torque [N m].
    power : ndarray
        2 pi n Q [W], in open water; over the relative rotative efficiency it is the delivered one.
    efficiency : ndarray
        Open-water efficiency J K_T / (2 pi K_Q).
    """

    advance: FloatArray
    rate: FloatArray
    torque: FloatArray
    power: FloatArray
    efficiency: FloatArray


def _collapse(terms: FloatArray, propeller: Propeller, log: float | None = None) -> FloatArray:
    """Return the coefficients of 1, J, J^2 and J^3 of a polynomial for one propeller."""
    weights = (
        terms[:, 0]
        * propeller.pitch_ratio ** terms[:, 2]
        * propeller.area_ratio ** terms[:, 3]
        * float(propeller.blades) ** terms[:, 4]
    )
    if log is not None:
        weights = weights * log ** terms[:, 5]
    powers = terms[:, 1].astype(int)
    return np.array([np.sum(weights[powers == power]) for power in range(4)])


def b_series_polynomials(
    propeller: Propeller, *, reynolds: float | None = None
) -> tuple[FloatArray, FloatArray]:
    """Return K_T and K_Q of one propeller as cubics in J, constant term first.

    Parameters
    ----------
    propeller : Propeller
        Diameter does not matter.
    reynolds : float, optional
        Reynolds number of the chord at 0.75 R, above 2e6, for the correction of the source; none
        by default, which is Rn = 2e6.

    Returns
    -------
    thrust, torque : ndarray
        Four coefficients each.
    """
    thrust, torque = _collapse(_THRUST, propeller), _collapse(_TORQUE, propeller)
    if reynolds is not None:
        log = float(np.log10(reynolds)) - 0.301
        thrust = thrust + _collapse(_THRUST_REYNOLDS, propeller, log)
        torque = torque + _collapse(_TORQUE_REYNOLDS, propeller, log)
    return thrust, torque


def _cubic(coefficients: FloatArray, advance: FloatArray) -> FloatArray:
    a, b, c, d = coefficients
    return np.asarray(a + advance * (b + advance * (c + advance * d)))


def b_series(
    advance: ArrayLike, propeller: Propeller, *, reynolds: float | None = None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Open-water characteristics.

    Parameters
    ----------
    advance : array_like
        J, from zero to where the thrust vanishes.
    propeller : Propeller
        See `Propeller`.
    reynolds : float, optional
        See `b_series_polynomials`.

    Returns
    -------
    thrust, torque, efficiency : ndarray
        K_T, K_Q and eta_0.
    """
    ratio = np.asarray(advance, dtype=float)
    thrust, torque = b_series_polynomials(propeller, reynolds=reynolds)
    kt, kq = _cubic(thrust, ratio), _cubic(torque, ratio)
    return kt, kq, np.asarray(ratio * kt / (2.0 * np.pi * kq))


def largest_advance(propeller: Propeller, *, reynolds: float | None = None) -> float:
    """Return the advance coefficient at which the thrust vanishes."""
    thrust, _ = b_series_polynomials(propeller, reynolds=reynolds)
    roots = np.roots(thrust[::-1])
    real = roots[(np.abs(roots.imag) < 1e-9) & (roots.real > 0.0)].real
    return float(real.min())


def solve_advance(
    thrust: ArrayLike,
    advance_speed: ArrayLike,
    *,
    polynomial: FloatArray,
    largest: float,
    diameter: float,
    density: float = SEA_WATER_DENSITY,
) -> FloatArray:
    """Advance coefficient at which a propeller gives a thrust at a speed of advance.

    The root of K_T(J) rho V_A^2 D^2 = T J^2 is unique between J = 0 (at the bollard) and the J of
    no thrust; Newton steps are kept inside the bracket.

    Parameters
    ----------
    thrust : array_like
        T of one propeller [N], not negative.
    advance_speed : array_like
        V_A [m/s], not negative.
    polynomial : ndarray
        K_T as a cubic in J.
    largest : float
        J of no thrust.
    diameter, density : float
        [m], [kg/m3].

    Returns
    -------
    ndarray
        J; NaN for a negative thrust or speed.
    """
    force, flow = np.broadcast_arrays(
        np.asarray(thrust, dtype=float), np.asarray(advance_speed, dtype=float)
    )
    stream = density * flow**2 * diameter**2
    scale = np.maximum(stream, force)
    share = force / np.where(scale > 0.0, scale, 1.0)
    stream = stream / np.where(scale > 0.0, scale, 1.0)
    low, high = np.zeros_like(share), np.full_like(share, largest)
    ratio = 0.5 * (low + high)
    _, b, c, d = polynomial
    for _ in range(60):
        value = stream * _cubic(polynomial, ratio) - share * ratio**2
        low, high = np.where(value > 0.0, ratio, low), np.where(value > 0.0, high, ratio)
        slope = stream * (b + ratio * (2.0 * c + ratio * 3.0 * d)) - 2.0 * share * ratio
        step = value / np.where(slope < 0.0, slope, -1.0)
        new = ratio - step
        new = np.where((new > low) & (new < high), new, 0.5 * (low + high))
        moved = np.nanmax(np.abs(new - ratio), initial=0.0)
        ratio = new
        if not moved > 1e-11:  # Newton's next step would be its square
            break
    known = (force >= 0.0) & (flow >= 0.0)
    return np.where(known, np.where(flow == 0.0, 0.0, ratio), np.nan)


def operating_point(
    thrust: ArrayLike,
    advance_speed: ArrayLike,
    propeller: Propeller,
    *,
    density: float = SEA_WATER_DENSITY,
    reynolds: float | None = None,
) -> OperatingPoint:
    """State of a propeller that gives a thrust at a speed of advance.

    Parameters
    ----------
    thrust : array_like
        Of one propeller [N], not negative.
    advance_speed : array_like
        V_A = V (1 - w) [m/s].
    propeller : Propeller
        See `Propeller`.
    density : float
        [kg/m3].
    reynolds : float, optional
        See `b_series_polynomials`.

    Returns
    -------
    OperatingPoint
        NaN for a negative thrust or speed.
    """
    polynomials = b_series_polynomials(propeller, reynolds=reynolds)
    size, largest = propeller.diameter, largest_advance(propeller, reynolds=reynolds)
    advance = solve_advance(
        thrust,
        advance_speed,
        polynomial=polynomials[0],
        largest=largest,
        diameter=size,
        density=density,
    )
    kt, kq = (_cubic(polynomial, advance) for polynomial in polynomials)
    force, flow = np.asarray(thrust, dtype=float), np.asarray(advance_speed, dtype=float)
    loaded = np.sqrt(np.maximum(force, 0.0) / (density * size**4 * np.where(kt > 0.0, kt, 1.0)))
    moving = flow / (np.where(advance > 0.0, advance, 1.0) * size)
    light = advance > 0.5 * largest  # of the two ways to find n, the one that loses no digits
    rate = np.where(np.isnan(advance), np.nan, np.where(light, moving, loaded))
    torque = kq * density * rate**2 * size**5
    efficiency = advance * kt / (2.0 * np.pi * kq)
    return OperatingPoint(advance, rate, torque, 2.0 * np.pi * rate * torque, efficiency)


def b_series_validity(propeller: Propeller) -> list[RangeNote]:
    """Say what lies outside the series: Z 2 to 7, A_E/A_0 0.30 to 1.05, P/D 0.5 to 1.4."""
    ranges: dict[str, tuple[ArrayLike, float, float]] = {
        "number of blades": (propeller.blades, 2.0, 7.0),
        "blade area ratio": (propeller.area_ratio, 0.30, 1.05),
        "pitch ratio": (propeller.pitch_ratio, 0.5, 1.4),
    }
    return range_notes("b_series", ranges)
