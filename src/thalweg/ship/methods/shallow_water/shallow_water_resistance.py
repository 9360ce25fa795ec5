"""Shallow water: friction after Zeng, wave speed after Karpov, speed loss after Lackenby.

Depth is the depth of the water at the ship, level included. A ship whose draught reaches the depth
has no value (NaN) where the method knows the draught; an infinite depth is deep water.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY
from thalweg.ship.methods.resistance.friction_lines import froude_number, ittc_1957
from thalweg.ship.methods.validity import RangeNote, range_notes

#: Depth Froude number at which the fit of Karpov's curves ends.
LARGEST_KARPOV_FROUDE_NUMBER: Final = 1.0

_BAND_CENTRES: Final = np.array([1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0])
_BAND_EDGES: Final = np.array([1.75, 2.25, 2.75, 3.25, 3.75, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5])
#: From the fourth power down, for depth Froude numbers up to 0.4 (one from D/T = 2.75).
_SLOW_COEFFICIENTS: Final = np.array(
    [
        [0.0, -4e-12, -0.2143, -0.0643, 0.9997],
        [0.0, -0.8333, 0.25, -0.0167, 1.0],
        [-1.25, 0.5833, -0.0375, -0.0108, 1.0],
        *([[0.0, 0.0, 0.0, 0.0, 1.0]] * 9),
    ]
)
#: From the sixth power down, above 0.4 (the last two above 0.6, and one below).
_FAST_COEFFICIENTS: Final = np.array(
    [
        [-0.9274, 9.5953, -37.197, 69.666, -65.391, 28.025, -3.4143],
        [2.2152, -11.852, 21.499, -12.174, -4.7873, 5.8662, -0.2652],
        [1.2205, -5.4999, 5.7966, 6.6491, -16.123, 9.2016, -0.6342],
        [-0.4085, 4.534, -18.443, 35.744, -34.381, 15.042, -1.3807],
        [0.4078, -0.919, -3.8292, 15.738, -19.766, 9.7466, -0.6409],
        [0.3067, -0.3404, -5.0511, 16.892, -20.265, 9.9002, -0.6712],
        [0.3212, -0.3559, -5.1056, 16.926, -20.253, 10.013, -0.7196],
        [0.9252, -4.2574, 5.0363, 3.3282, -10.367, 6.3993, -0.2074],
        [0.8442, -4.0261, 5.313, 1.6442, -8.1848, 5.3209, -0.0267],
        [0.1211, 0.628, -6.5106, 16.7, -18.267, 8.7077, -0.4745],
        [-6.4069, 47.308, -141.93, 220.23, -185.05, 79.25, -12.484],
        [-6.0727, 44.97, -135.21, 210.13, -176.72, 75.728, -11.893],
    ]
)
_FIRST_FROUDE_NUMBERS: Final = np.array([0.4] * 10 + [0.6] * 2)


def _positive(depth: ArrayLike) -> FloatArray:
    """Return depths [m], NaN where there is no water."""
    water = np.asarray(depth, dtype=float)
    return np.where(water > 0.0, water, np.nan)


def bottom_speed_ratio(depth_to_draught: ArrayLike) -> FloatArray:
    r"""Speed under a flat bottom over the ship's speed, V_B / V (Zeng et al. 2019).

    .. math:: V_B / V = \max(1, 0.4277 \exp[(D/T)^{-0.07634}])

    0.4277 exp{(D/T)^-0.07634}, not below one. The paper ends the formula at D/T = 4, where it
    jumps by 5 %; extended, it reaches one at D/T = 8.5 and is continuous.

    References
    ----------
    Q. Zeng, C. Thill, R. Hekkenberg, E. Rotteveel, J. Marine Science and Technology 24 (2019)
    642-657.
    Schless (2023), eq. 3.17.
    """
    ratio = np.asarray(depth_to_draught, dtype=float)
    known = np.where(ratio > 1.0, ratio, np.nan)
    return np.asarray(np.maximum(0.4277 * np.exp(known**-0.07634), 1.0))


def zeng_2019_friction(
    reynolds: ArrayLike,
    *,
    depth: ArrayLike,
    draught: ArrayLike,
    length: ArrayLike,
    wetted_surface: ArrayLike,
    flat_bottom_area: ArrayLike,
) -> FloatArray:
    r"""Friction coefficient of a ship in shallow water.

    .. math::
        C_F = C_{ITTC57} + (C_x - C_{Katsui}) (S_B / S) q, \quad C_{Katsui} =
            \frac{0.0066577}{(\log_{10} Re - 4.3762)^{0.042612 \log_{10} Re + 0.56725}} \\
        \frac{D - T}{L} > 1: C_x = \frac{0.08169}{(\log_{10} Re - 1.717)^2},\ q = 1; \quad
            \text{else}\ C_x = \frac{0.08169}{(\log_{10} Re - 1.717)^2} \left[1 +
            \frac{0.003998}{\log_{10} Re - 4.393} \left(\frac{D -
            T}{L}\right)^{-1.083}\right],\ q = (V_B / V)^2

    C_F = C_ITTC57 + (C_x - C_Katsui) (S_B / S) q. With (D - T) / L above one C_x is the flat-plate
    line of deep water and q = 1; below it the shallow one, and q = (V_B / V)^2.

    Source: Q. Zeng, C. Thill, R. Hekkenberg, E. Rotteveel, "A modification of the ITTC57
    correlation line for shallow water", J. Marine Science and Technology 24 (2019) 642-657. The
    power of (D - T) / L multiplies the fraction.

    Parameters
    ----------
    reynolds : array_like
        V L / nu, above 1e5.
    depth, draught, length : array_like
        D, T and L [m].
    wetted_surface, flat_bottom_area : array_like
        S and S_B [m2].

    Returns
    -------
    ndarray
        NaN where the depth does not exceed the draught.

    References
    ----------
    Q. Zeng, C. Thill, R. Hekkenberg, E. Rotteveel, J. Marine Science and Technology 24 (2019)
    642-657.
    Schless (2023), eq. 3.20, prints the power of (D - T) / L inside the denominator; corrected.
    """
    log = np.log10(np.asarray(reynolds, dtype=float))
    water, deep = np.asarray(depth, dtype=float), np.asarray(draught, dtype=float)
    clearance = (water - deep) / np.asarray(length)
    clearance = np.where(clearance > 0.0, clearance, np.nan)
    plate = 0.08169 / (log - 1.717) ** 2
    near = plate * (1.0 + 0.003998 / (log - 4.393) * clearance**-1.083)
    katsui = 0.0066577 / (log - 4.3762) ** (0.042612 * log + 0.56725)
    speedup = bottom_speed_ratio(water / deep) ** 2
    far = clearance > 1.0
    bottom = np.asarray(flat_bottom_area, dtype=float) / np.asarray(wetted_surface)
    change = np.where(far, plate - katsui, (near - katsui) * speedup)
    return np.asarray(ittc_1957(reynolds) + bottom * np.where(np.isnan(clearance), np.nan, change))


def _curve(index: NDArray[np.intp], froude: FloatArray) -> FloatArray:
    """Return the polynomial of each band at each depth Froude number."""
    slow, fast = np.zeros_like(froude), np.zeros_like(froude)
    for power in range(_SLOW_COEFFICIENTS.shape[1]):
        slow = slow * froude + _SLOW_COEFFICIENTS[index, power]
    for power in range(_FAST_COEFFICIENTS.shape[1]):
        fast = fast * froude + _FAST_COEFFICIENTS[index, power]
    start = _FIRST_FROUDE_NUMBERS[index]
    gap = (froude < start) & (start > 0.4)
    return np.where(froude <= 0.4, slow, np.where(gap, 1.0, fast))


def karpov(
    depth_froude: ArrayLike, depth_to_draught: ArrayLike, *, raw_bands: bool = False
) -> FloatArray:
    r"""Karpov's alpha**: the wave resistance in shallow water is that of the speed V / alpha**.

    .. math:: \alpha^{**}(Fn_h) = \sum_k a_k(D/T) Fn_h^k

    Source: polynomials fitted to Karpov's chart, printed by Schless (2023), Appendix B (after van
    Terwisga 1989 and Rotteveel 2013).

    Parameters
    ----------
    depth_froude : V / sqrt(g D). Above 1.0 the value at 1.0 is used: the fit ends there.
    depth_to_draught : D / T; above one.
    raw_bands : True gives the printed bands with their steps and their values above one. False, the
        default, takes each polynomial as the curve of the centre of its band, interpolates linearly
        in D / T and lets alpha** not exceed one.

    Returns
    -------
    ndarray : NaN where D / T is not above one.

    References
    ----------
    Schless (2023), Appendix B: polynomials by band of D/T, after van Terwisga (1989) and
    Rotteveel (2013).
    """
    froude, ratio = np.broadcast_arrays(
        np.asarray(depth_froude, dtype=float), np.asarray(depth_to_draught, dtype=float)
    )
    froude = np.minimum(froude, LARGEST_KARPOV_FROUDE_NUMBER)
    known = np.where(ratio > 1.0, ratio, np.nan)
    filled = np.where(np.isnan(known), 1.5, known)
    if raw_bands:
        alpha = _curve(np.searchsorted(_BAND_EDGES, filled, side="right"), froude)
    else:
        upper = np.clip(
            np.searchsorted(_BAND_CENTRES, filled, side="right"), 1, _BAND_CENTRES.size - 1
        )
        below, above = _BAND_CENTRES[upper - 1], _BAND_CENTRES[upper]
        part = np.clip((filled - below) / (above - below), 0.0, 1.0)
        alpha = (1.0 - part) * _curve(upper - 1, froude) + part * _curve(upper, froude)
        alpha = np.minimum(alpha, 1.0)
    return np.where(np.isnan(known), np.nan, alpha)


def karpov_speed(
    speed: ArrayLike,
    *,
    depth: ArrayLike,
    draught: ArrayLike,
    raw_bands: bool = False,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Speed V / alpha** [m/s] at which deep-water formulas give the wave resistance.

    .. math:: V_{wave} = V / \alpha^{**}(V / \sqrt{g D}, D / T)

    Parameters
    ----------
    speed : array_like [m/s]
    depth, draught : array_like [m]
    raw_bands : See `karpov`.
    gravity : float [m/s2]

    Returns
    -------
    ndarray : NaN where the depth does not exceed the draught.

    References
    ----------
    Schless (2023), Appendix B.
    """
    water = _positive(depth)
    froude = froude_number(speed, length=water, gravity=gravity)
    alpha = karpov(froude, water / np.asarray(draught), raw_bands=raw_bands)
    return np.asarray(np.asarray(speed, dtype=float) / alpha)


def karpov_validity(speed: ArrayLike, *, depth: ArrayLike) -> list[RangeNote]:
    """Return which depth Froude numbers exceed 1.0, where the fit of the curves ends.

    Parameters
    ----------
    speed : Speed through water [m/s].
    depth : Water depth [m].

    Returns
    -------
    list of RangeNote : Empty inside the range.
    """
    froude = froude_number(speed, length=_positive(depth))
    return range_notes(
        "karpov", {"depth Froude number": (froude, 0.0, LARGEST_KARPOV_FROUDE_NUMBER)}
    )


def lackenby_1963_speed_loss(
    speed: ArrayLike,
    *,
    depth: ArrayLike,
    midship_area: ArrayLike,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Speed loss dV / V = 0.1242 (A_M / h^2 - 0.05) + 1 - sqrt(tanh(g h / V^2)).

    .. math::
        \frac{\Delta V}{V} = 0.1242 \left(\frac{A_M}{h^2} - 0.05\right) + 1 - \sqrt{\tanh(g
            h / V^2)}

    Source: H. Lackenby, "The effect of shallow water on ship speed", Shipbuilder and Marine
    Engine Builder 70 (1963), as in ITTC Recommended Procedure 7.5-04-01-01.1.

    Parameters
    ----------
    speed : V [m/s].
    depth : h [m].
    midship_area : A_M below the water [m2].
    gravity : float [m/s2]

    Returns
    -------
    ndarray
        A part of the speed, not below zero; NaN where the depth is not positive. The procedure
        applies the formula from A_M / h^2 = 0.05; below that the first term is taken as zero, so
        that it fades out. The draught is not known here: the caller checks where the ship grounds.

    References
    ----------
    H. Lackenby, Shipbuilder and Marine Engine Builder 70 (1963), as in ITTC 7.5-04-01-01.1.
    """
    velocity, water = np.asarray(speed, dtype=float), _positive(depth)
    blocked = np.maximum(np.asarray(midship_area) / water**2 - 0.05, 0.0)
    squared = np.where(velocity == 0.0, 1e-12, velocity**2)
    loss = 0.1242 * blocked + 1.0 - np.sqrt(np.tanh(gravity * water / squared))
    return np.asarray(np.where(velocity == 0.0, 0.0 * loss, loss))


def lackenby_1963_deep_speed(
    speed: ArrayLike,
    *,
    depth: ArrayLike,
    midship_area: ArrayLike,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Deep-water speed with the same power, V (1 + dV / V) [m/s], see `lackenby_1963_speed_loss`.

    .. math:: V_{deep} = V (1 + \Delta V / V)

    The resistance in shallow water is that of this speed in deep water, times it over V.

    Parameters
    ----------
    speed : Speed in shallow water V [m/s].
    depth : Water depth [m].
    midship_area : Submerged area of the midship section [m2].
    gravity : Acceleration of gravity [m/s2].

    Returns
    -------
    ndarray : Speed in deep water [m/s].

    References
    ----------
    H. Lackenby, Shipbuilder and Marine Engine Builder 70 (1963), as in ITTC 7.5-04-01-01.1.
    """
    loss = lackenby_1963_speed_loss(speed, depth=depth, midship_area=midship_area, gravity=gravity)
    return np.asarray(np.asarray(speed, dtype=float) * (1.0 + loss))


def lackenby_1963_validity(
    speed: ArrayLike,
    *,
    depth: ArrayLike,
    midship_area: ArrayLike,
) -> list[RangeNote]:
    """Return what exceeds a speed loss of 30 %, the end of Lackenby's chart (unverified).

    Parameters
    ----------
    speed : Speed in shallow water [m/s].
    depth : Water depth [m].
    midship_area : Submerged area of the midship section [m2].

    Returns
    -------
    list of RangeNote : Empty inside the range.
    """
    loss = lackenby_1963_speed_loss(speed, depth=depth, midship_area=midship_area)
    return range_notes("lackenby_1963", {"speed loss": (loss, 0.0, 0.30)})
