"""Wake fraction, thrust deduction and relative rotative efficiency of Holtrop and Mennen.

Sources: J. Holtrop and G.G.J. Mennen (1982) and J. Holtrop (1984), as in
`thalweg.ship.methods.resistance.holtrop_mennen`.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.ship.methods.resistance.holtrop_form import HullForm


def viscous_coefficient(
    friction_coefficient: ArrayLike, *, form_factor: ArrayLike, correlation: ArrayLike
) -> FloatArray:
    """C_V = (1 + k) C_F + C_A, with `form_factor` 1 + k.

    Parameters
    ----------
    friction_coefficient : Friction coefficient C_F [-].
    form_factor : Form factor 1 + k [-].
    correlation : Correlation allowance C_A [-].

    Returns
    -------
    ndarray : Viscous resistance coefficient [-].
    """
    line = np.asarray(friction_coefficient, dtype=float)
    return np.asarray(np.asarray(form_factor) * line + np.asarray(correlation))


def _c_p1(hull: HullForm) -> FloatArray:
    return np.asarray(1.45 * hull.prismatic_coefficient - 0.315 - 0.0225 * hull.lcb_percent)


def _c9(
    hull: HullForm, aft: FloatArray, diameter: ArrayLike, wetted_surface: ArrayLike
) -> FloatArray:
    ratio, size = hull.breadth / aft, np.asarray(diameter, dtype=float)
    area = np.asarray(wetted_surface, dtype=float)
    slim = hull.breadth * area / (hull.length * size * aft)
    broad = area * (7.0 * ratio - 25.0) / (hull.length * size * (np.maximum(ratio, 5.0) - 3.0))
    c8 = np.where(ratio < 5.0, slim, broad)
    return np.asarray(np.where(c8 < 28.0, c8, 32.0 - 16.0 / (np.maximum(c8, 28.0) - 24.0)))


def wake_fraction_single(
    hull: HullForm,
    *,
    draught_aft: ArrayLike,
    propeller_diameter: ArrayLike,
    wetted_surface_area: ArrayLike,
    viscous: ArrayLike,
    stern_shape: ArrayLike = 0.0,
    year: Literal[1982, 1984] = 1982,
) -> FloatArray:
    r"""Wake fraction w of a single-screw ship.

    .. math::
        1982: w = c_9 C_V \frac{L}{T_A} \left(0.0661875 + 1.21756 c_{11} \frac{C_V}{1 -
            C_{P1}}\right) + 0.24558 \sqrt{\frac{B}{L (1 - C_{P1})}} - \frac{0.09726}{0.95 -
            C_P} + \frac{0.11434}{0.95 - C_B} + 0.75 C_{stern} C_V + 0.002 C_{stern} \\
        1984: w = (1 + 0.015 C_{stern}) \left[c_9 C_V \frac{L}{T_A} \left(0.050776 + 0.93405
            c_{11} \frac{C_V}{1 - C_{P1}}\right) + 0.27915 \sqrt{\frac{B}{L (1 - C_{P1})}} +
            c_{19}\right] \\
        c_{11} = T_A/D\ (T_A/D < 2), \quad 0.0833333 (T_A/D)^3 + 1.33333 \\
        c_{19} = \frac{0.12997}{0.95 - C_B} - \frac{0.11056}{0.95 - C_P}\ (C_P < 0.7), \quad
            \frac{0.18567}{1.3571 - C_M} - 0.71276 + 0.38648 C_P

    Parameters
    ----------
    hull : HullForm
        Main particulars.
    draught_aft : array_like
        T_A [m].
    propeller_diameter : array_like
        D [m].
    wetted_surface_area : array_like
        S of hull and appendages [m2]; the worked example of the paper counts both.
    viscous : array_like
        C_V, see `viscous_coefficient`.
    stern_shape : array_like
        C_stern, -25 to +10.
    year : {1982, 1984}
        Holtrop and Mennen (1982) or Holtrop (1984).

    Returns
    -------
    ndarray
        V_A = V (1 - w).

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170. J.
    Holtrop, International Shipbuilding Progress 31 (1984) 272-276.
    """
    aft, size = np.asarray(draught_aft, dtype=float), np.asarray(propeller_diameter, dtype=float)
    cv, stern = np.asarray(viscous, dtype=float), np.asarray(stern_shape, dtype=float)
    prismatic, block, slim = hull.prismatic_coefficient, hull.block_coefficient, 1.0 - _c_p1(hull)
    deep = aft / size
    c11 = np.where(deep < 2.0, deep, 0.0833333 * deep**3 + 1.33333)
    flow = _c9(hull, aft, size, wetted_surface_area) * cv * hull.length / aft
    root = np.sqrt(hull.breadth / (hull.length * slim))
    if year == 1982:
        wake = flow * (0.0661875 + 1.21756 * c11 * cv / slim) + 0.24558 * root
        wake = wake - 0.09726 / (0.95 - prismatic) + 0.11434 / (0.95 - block)
        return np.asarray(wake + 0.75 * stern * cv + 0.002 * stern)
    full = 0.18567 / (1.3571 - hull.midship_coefficient) - 0.71276 + 0.38648 * prismatic
    fine = 0.12997 / (0.95 - block) - 0.11056 / (0.95 - prismatic)
    c19 = np.where(prismatic < 0.7, fine, full)
    wake = flow * (0.050776 + 0.93405 * c11 * cv / slim) + 0.27915 * root + c19
    return np.asarray((1.0 + 0.015 * stern) * wake)


def wake_fraction_twin(
    hull: HullForm, *, propeller_diameter: ArrayLike, viscous: ArrayLike
) -> FloatArray:
    r"""Wake fraction of a twin-screw ship.

    .. math:: w = 0.3095 C_B + 10 C_V C_B - 0.23 D / \sqrt{B T}

    Parameters
    ----------
    hull : Form of the hull [SI].
    propeller_diameter : Diameter D [m].
    viscous : Viscous resistance coefficient C_V [-].

    Returns
    -------
    ndarray : Wake fraction [-].

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    block = hull.block_coefficient
    size = np.asarray(propeller_diameter, dtype=float) / np.sqrt(hull.breadth * hull.draught)
    return np.asarray(0.3095 * block + 10.0 * np.asarray(viscous) * block - 0.23 * size)


def thrust_deduction_single(
    hull: HullForm,
    *,
    propeller_diameter: ArrayLike,
    stern_shape: ArrayLike = 0.0,
    year: Literal[1982, 1984] = 1982,
) -> FloatArray:
    r"""Thrust deduction fraction t of a single-screw ship, T = R / (1 - t).

    .. math::
        1982: t = \frac{0.001979 L}{B (1 - C_{P1})} + 1.0585 c_{10} - 0.00524 - 0.1418
            \frac{D^2}{B T} + 0.0015 C_{stern} \\
        c_{10} = B/L\ (L/B > 5.2), \quad 0.25 - 0.003328402 / (B/L - 0.134615385) \\
        1984: t = 0.25014 (B/L)^{0.28956} (\sqrt{B T} / D)^{0.2624} / (1 - C_P + 0.0225\,
            lcb)^{0.01762} + 0.0015 C_{stern}

    Parameters
    ----------
    hull : HullForm
        Main particulars.
    propeller_diameter : array_like
        D [m].
    stern_shape : array_like
        C_stern, -25 to +10.
    year : {1982, 1984}
        Holtrop and Mennen (1982) or Holtrop (1984).

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170. J.
    Holtrop, International Shipbuilding Progress 31 (1984) 272-276.
    """
    size, stern = np.asarray(propeller_diameter, dtype=float), np.asarray(stern_shape, dtype=float)
    section, slender = hull.breadth * hull.draught, hull.breadth / hull.length
    if year == 1982:
        short = slender - 0.134615385
        c10 = 0.25 - 0.003328402 / np.where(short > 0.0, short, np.inf)
        c10 = np.where(1.0 / slender > 5.2, slender, c10)
        run = 0.001979 * hull.length / (hull.breadth * (1.0 - _c_p1(hull)))
        basic = run + 1.0585 * c10 - 0.00524 - 0.1418 * size**2 / section
    else:
        fine = 1.0 - hull.prismatic_coefficient + 0.0225 * hull.lcb_percent
        basic = 0.25014 * slender**0.28956 * (np.sqrt(section) / size) ** 0.2624 / fine**0.01762
    return np.asarray(basic + 0.0015 * stern)


def thrust_deduction_twin(hull: HullForm, *, propeller_diameter: ArrayLike) -> FloatArray:
    """Thrust deduction of a twin-screw ship, t = 0.325 C_B - 0.1885 D / sqrt(B T).

    Parameters
    ----------
    hull : Form of the hull [SI].
    propeller_diameter : Diameter D [m].

    Returns
    -------
    ndarray : Thrust deduction [-].

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    size = np.asarray(propeller_diameter, dtype=float) / np.sqrt(hull.breadth * hull.draught)
    return np.asarray(0.325 * hull.block_coefficient - 0.1885 * size)


def relative_rotative_single(hull: HullForm, *, area_ratio: ArrayLike) -> FloatArray:
    """eta_R = 0.9922 - 0.05908 A_E/A_0 + 0.07424 (C_P - 0.0225 lcb), single screw.

    Parameters
    ----------
    hull : Form of the hull [SI].
    area_ratio : Expanded blade area ratio A_E/A_0 [-].

    Returns
    -------
    ndarray : Relative rotative efficiency [-].

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    shape = hull.prismatic_coefficient - 0.0225 * hull.lcb_percent
    return np.asarray(0.9922 - 0.05908 * np.asarray(area_ratio) + 0.07424 * shape)


def relative_rotative_twin(hull: HullForm, *, pitch_ratio: ArrayLike) -> FloatArray:
    """eta_R = 0.9737 + 0.111 (C_P - 0.0225 lcb) - 0.06325 P/D, twin screw.

    Parameters
    ----------
    hull : Form of the hull [SI].
    pitch_ratio : Pitch over diameter P/D [-].

    Returns
    -------
    ndarray : Relative rotative efficiency [-].

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    shape = hull.prismatic_coefficient - 0.0225 * hull.lcb_percent
    return np.asarray(0.9737 + 0.111 * shape - 0.06325 * np.asarray(pitch_ratio))


def hull_efficiency(wake_fraction: ArrayLike, thrust_deduction: ArrayLike) -> FloatArray:
    """eta_H = (1 - t) / (1 - w).

    Parameters
    ----------
    wake_fraction : Wake fraction w [-].
    thrust_deduction : Thrust deduction t [-].

    Returns
    -------
    ndarray : Hull efficiency [-].
    """
    deduction = np.asarray(thrust_deduction, dtype=float)
    return np.asarray((1.0 - deduction) / (1.0 - np.asarray(wake_fraction, dtype=float)))
