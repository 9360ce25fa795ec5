"""Wave-making resistance of Holtrop and Mennen (1982) and Holtrop (1984).

Sources as in `thalweg.ship.methods.resistance.holtrop_mennen`.
"""

from __future__ import annotations

from typing import Any, Final, Literal

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, SEA_WATER_DENSITY
from thalweg.ship.methods.resistance.friction_lines import froude_number
from thalweg.ship.methods.resistance.holtrop_form import HullForm

#: Highest place of the bulb centre the method allows, as a part of the draught forward.
HIGHEST_BULB_CENTRE: Final = 0.6
_LEAST_FROUDE_NUMBER: Final = 0.02  #: Froude number below which the wave resistance is not resolved


def bulb_height(bulb_centre_height: ArrayLike, draught_fore: ArrayLike) -> FloatArray:
    """Height of the bulb centre that counts: h_B, at most 0.6 T_F [m].

    Parameters
    ----------
    bulb_centre_height : Height of the centre of the bulb above the keel h_B [m].
    draught_fore : Draught forward T_F [m].

    Returns
    -------
    ndarray : Height [m].
    """
    return np.asarray(
        np.minimum(bulb_centre_height, HIGHEST_BULB_CENTRE * np.asarray(draught_fore))
    )


def bulb_wave_factor(
    hull: HullForm,
    *,
    draught_fore: ArrayLike,
    bulb_area: ArrayLike,
    bulb_centre_height: ArrayLike,
) -> FloatArray:
    """Factor c2 = exp(-1.89 sqrt(c3)): reduction of wave making by a bulb; 1 without a bulb.

    Parameters
    ----------
    hull : Form of the hull [SI].
    draught_fore : Draught forward T_F [m].
    bulb_area : Transverse area of the bulb A_BT [m2].
    bulb_centre_height : Height of its centre above the keel h_B [m].

    Returns
    -------
    ndarray : Factor c2 [-].

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    area = np.asarray(bulb_area, dtype=float)
    height = bulb_height(bulb_centre_height, draught_fore)
    depth = 0.31 * np.sqrt(area) + np.asarray(draught_fore) - height
    c3 = 0.56 * area**1.5 / (hull.breadth * hull.draught * depth)
    return np.asarray(np.exp(-1.89 * np.sqrt(c3)))


def transom_wave_factor(hull: HullForm, *, transom_area: ArrayLike) -> FloatArray:
    """Factor c5 = 1 - 0.8 A_T / (B T C_M).

    Parameters
    ----------
    hull : Form of the hull [SI].
    transom_area : Immersed transom area A_T [m2].

    Returns
    -------
    ndarray : Factor c5 [-].
    """
    section = hull.breadth * hull.draught * hull.midship_coefficient
    return 1.0 - 0.8 * np.asarray(transom_area, dtype=float) / section


def _c15(hull: HullForm) -> FloatArray:
    slender = hull.length**3 / hull.displacement
    middle = -1.69385 + (np.cbrt(slender) - 8.0) / 2.36
    values = np.where(slender < 512.0, -1.69385, np.where(slender > 1726.91, 0.0, middle))
    return np.where(np.isnan(slender), np.nan, values)


def _wave_exponent(hull: HullForm, fn: FloatArray, first: Any, year: int) -> FloatArray:
    """Return first Fn^-0.9 + m4 cos(lambda Fn^-2), the exponent both speed ranges share."""
    ratio = hull.length / hull.breadth
    prismatic = hull.prismatic_coefficient
    wave = 1.446 * prismatic - np.where(ratio < 12.0, 0.03 * ratio, 0.36)
    if year == 1982:
        m4 = _c15(hull) * prismatic**2 * np.exp(-0.1 / fn**2)
    else:
        m4 = 0.4 * _c15(hull) * np.exp(-0.034 * fn**-3.29)
    return np.asarray(first * fn**-0.9 + m4 * np.cos(wave / fn**2))


def _low_speed_wave_resistance(
    hull: HullForm, fn: FloatArray, entrance: Any, year: int
) -> FloatArray:
    """R_W / (c2 c5 V rho g) up to Fn = 0.4."""
    slim = hull.breadth / hull.length
    c7 = np.where(slim < 0.11, 0.229577 * np.cbrt(slim), slim)
    c7 = np.where(slim > 0.25, 0.5 - 0.0625 / slim, c7)
    c1 = 2223105.0 * c7**3.78613 * (hull.draught / hull.breadth) ** 1.07961
    c1 = c1 * (90.0 - entrance) ** -1.37565
    prismatic = hull.prismatic_coefficient
    full = 8.07981 * prismatic - 13.8673 * prismatic**2 + 6.984388 * prismatic**3
    c16 = np.where(prismatic < 0.8, full, 1.73014 - 0.7067 * prismatic)
    m1 = (
        0.0140407 * hull.length / hull.draught
        - 1.75254 * np.cbrt(hull.displacement) / hull.length
        - 4.79323 * slim
        - c16
    )
    return np.asarray(c1 * np.exp(_wave_exponent(hull, fn, m1, year)))


def _high_speed_wave_resistance(hull: HullForm, fn: FloatArray) -> FloatArray:
    """R_W / (c2 c5 V rho g) from Fn = 0.55 (Holtrop 1984)."""
    c17 = (
        6919.3
        * hull.midship_coefficient**-1.3346
        * (hull.displacement / hull.length**3) ** 2.00977
        * (hull.length / hull.breadth - 2.0) ** 1.40692
    )
    m3 = -7.2035 * (hull.breadth / hull.length) ** 0.326869
    m3 = m3 * (hull.draught / hull.breadth) ** 0.605375
    return c17 * np.exp(_wave_exponent(hull, fn, m3, 1984))


def wave_resistance(
    speed: ArrayLike,
    hull: HullForm,
    *,
    entrance_angle_deg: ArrayLike,
    bulb_factor: ArrayLike = 1.0,
    transom_factor: ArrayLike = 1.0,
    year: Literal[1982, 1984] = 1982,
    density: float = SEA_WATER_DENSITY,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Wave-making resistance R_W.

    .. math::
        R_W = c_1 c_2 c_5 \nabla \rho g \exp\left[m_1 Fn^{-0.9} + m_4 \cos(\lambda
            Fn^{-2})\right] \\
        c_1 = 2223105\, c_7^{3.78613} (T/B)^{1.07961} (90 - i_E)^{-1.37565} \\
        c_7 = 0.229577 (B/L)^{1/3}\ (B/L < 0.11), \quad B/L, \quad 0.5 - 0.0625 L/B\ (B/L >
            0.25) \\
        m_1 = 0.0140407 L/T - 1.75254 \nabla^{1/3}/L - 4.79323 B/L - c_{16}, \quad \lambda =
            1.446 C_P - 0.03 L/B\ (L/B < 12),\ 1.446 C_P - 0.36 \\
        c_{16} = 8.07981 C_P - 13.8673 C_P^2 + 6.984388 C_P^3\ (C_P < 0.8), \quad 1.73014 -
            0.7067 C_P \\
        1982: m_4 = c_{15} C_P^2 e^{-0.1 Fn^{-2}}; \quad 1984: m_4 = 0.4 c_{15} e^{-0.034
            Fn^{-3.29}} \\
        Fn > 0.55\ (1984): c_1 \to c_{17} = 6919.3\, C_M^{-1.3346} (\nabla/L^3)^{2.00977}
            (L/B - 2)^{1.40692}, \quad m_1 \to m_3 = -7.2035 (B/L)^{0.326869}
            (T/B)^{0.605375}

    Parameters
    ----------
    speed : array_like [m/s]
    hull : HullForm
        Main particulars.
    entrance_angle_deg : array_like
        i_E [deg], see `half_angle_of_entrance`.
    bulb_factor, transom_factor : array_like
        c2 and c5.
    year : {1982, 1984}
        1982: one formula, meant for Fn <= 0.4. 1984: that formula with another m4 up to 0.4, a
        second one from 0.55, and a straight line between their values at 0.40 and 0.55.
    density, gravity : float
        [kg/m3], [m/s2].

    Returns
    -------
    ndarray [N]

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170. J.
    Holtrop, International Shipbuilding Progress 31 (1984) 272-276.
    Schless (2023), eq. 3.34, for Fn between 0.4 and 0.55.
    """
    fn = froude_number(speed, length=hull.length, gravity=gravity)
    resolved = np.maximum(fn, _LEAST_FROUDE_NUMBER)
    if year == 1982:
        shape = _low_speed_wave_resistance(hull, resolved, entrance_angle_deg, year)
    else:
        shape = _low_speed_wave_resistance(
            hull, np.minimum(resolved, 0.4), entrance_angle_deg, year
        )
        if np.any(fn > 0.4):
            fast = _high_speed_wave_resistance(hull, np.maximum(resolved, 0.55))
            part = np.clip((10.0 * fn - 4.0) / 1.5, 0.0, 1.0)
            shape = np.where(fn > 0.4, shape + part * (fast - shape), shape)
    scale = np.asarray(bulb_factor) * transom_factor * hull.displacement * density * gravity
    return np.where(fn == 0.0, 0.0, scale * shape)
