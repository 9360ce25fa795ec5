"""Hull form estimates of Holtrop and Mennen (1982) and Holtrop (1984).

Sources: J. Holtrop and G.G.J. Mennen, "An approximate power prediction method", International
Shipbuilding Progress 29 (1982) 166-170; J. Holtrop, "A statistical re-analysis of resistance and
propulsion data", International Shipbuilding Progress 31 (1984) 272-276.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray


@dataclass(frozen=True)
class HullForm:
    """Main particulars that most of the formulas need; scalars or arrays that broadcast.

    Attributes
    ----------
    length : Length of the waterline L [m].
    breadth : B [m].
    draught : Mean draught T [m].
    displacement : Displaced volume [m3].
    midship_coefficient : C_M.
    waterplane_coefficient : C_WP.
    lcb_percent : Centre of buoyancy, percent of L forward (+) of half of L.
    """

    length: FloatArray
    breadth: FloatArray
    draught: FloatArray
    displacement: FloatArray
    midship_coefficient: FloatArray
    waterplane_coefficient: FloatArray
    lcb_percent: FloatArray

    @property
    def block_coefficient(self) -> FloatArray:
        """C_B = V / (L B T)."""
        return self.displacement / (self.length * self.breadth * self.draught)

    @property
    def prismatic_coefficient(self) -> FloatArray:
        """C_P = C_B / C_M."""
        return self.block_coefficient / self.midship_coefficient


def hull_form(
    *,
    length_waterline: ArrayLike,
    breadth: ArrayLike,
    draught: ArrayLike,
    displacement: ArrayLike,
    midship_coefficient: ArrayLike,
    waterplane_coefficient: ArrayLike,
    lcb_percent: ArrayLike,
) -> HullForm:
    """Return the particulars as float arrays (see `HullForm`).

    Parameters
    ----------
    length_waterline, breadth, draught : Length L_WL, breadth B and draught T [m].
    displacement : Displaced volume [m3].
    midship_coefficient, waterplane_coefficient : C_M and C_WP [-].
    lcb_percent : Centre of buoyancy forward of L/2 [% of the length].
    """
    given = (
        *(length_waterline, breadth, draught, displacement),
        *(midship_coefficient, waterplane_coefficient, lcb_percent),
    )
    return HullForm(*(np.asarray(value, dtype=float) for value in given))


def wetted_surface(hull: HullForm, *, bulb_area: ArrayLike = 0.0) -> FloatArray:
    r"""Wetted surface S of the bare hull [m2] (Holtrop and Mennen 1982).

    .. math::
        S = L (2 T + B) \sqrt{C_M} (0.453 + 0.4425 C_B - 0.2862 C_M - 0.003467 B/T + 0.3696
            C_{WP}) + 2.38 A_{BT} / C_B

    L (2T + B) sqrt(C_M) (0.453 + 0.4425 C_B - 0.2862 C_M - 0.003467 B/T + 0.3696 C_WP)
    + 2.38 A_BT / C_B, with A_BT the transverse area of the bulb [m2].

    Parameters
    ----------
    hull : Form of the hull [SI].
    bulb_area : Transverse area of the bulb A_BT [m2].

    Returns
    -------
    ndarray : Wetted surface [m2].

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    shape = (
        0.453
        + 0.4425 * hull.block_coefficient
        - 0.2862 * hull.midship_coefficient
        - 0.003467 * hull.breadth / hull.draught
        + 0.3696 * hull.waterplane_coefficient
    )
    girth = (2.0 * hull.draught + hull.breadth) * np.sqrt(hull.midship_coefficient)
    return hull.length * girth * shape + 2.38 * np.asarray(bulb_area) / hull.block_coefficient


def length_of_run(hull: HullForm) -> FloatArray:
    r"""L_R = L (1 - C_P + 0.06 C_P lcb / (4 C_P - 1)) [m].

    .. math:: L_R = L \left(1 - C_P + \frac{0.06 C_P\, lcb}{4 C_P - 1}\right)

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    prismatic = hull.prismatic_coefficient
    return hull.length * (
        1.0 - prismatic + 0.06 * prismatic * hull.lcb_percent / (4.0 * prismatic - 1.0)
    )


def form_factor_1982(hull: HullForm, *, stern_shape: ArrayLike = 0.0) -> FloatArray:
    r"""Form factor 1 + k1 of Holtrop and Mennen (1982).

    .. math::
        1 + k_1 = c_{13} \left[0.93 + c_{12} (B / L_R)^{0.92497} (0.95 - C_P)^{-0.521448} (1
            - C_P + 0.0225\, lcb)^{0.6906}\right] \\
        c_{12} = (T/L)^{0.2228446}\ (T/L > 0.05), \quad 48.20 (T/L - 0.02)^{2.078} +
            0.479948\ (> 0.02), \quad 0.479948; \quad c_{13} = 1 + 0.003 C_{stern}

    `stern_shape` is C_stern: -25 pram with gondola, -10 V-shaped, 0 normal, +10 U-shaped sections.

    Parameters
    ----------
    hull : HullForm
        Form of the hull [SI].
    stern_shape : array_like, optional
        C_stern [-].

    Returns
    -------
    ndarray
        Form factor 1 + k1 [-].

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    ratio = hull.draught / hull.length
    middle = 48.20 * np.maximum(ratio - 0.02, 0.0) ** 2.078 + 0.479948
    c12 = np.where(ratio > 0.05, ratio**0.2228446, np.where(ratio > 0.02, middle, 0.479948))
    c13 = 1.0 + 0.003 * np.asarray(stern_shape)
    prismatic = hull.prismatic_coefficient
    return c13 * (
        0.93
        + c12
        * (hull.breadth / length_of_run(hull)) ** 0.92497
        * (0.95 - prismatic) ** -0.521448
        * (1.0 - prismatic + 0.0225 * hull.lcb_percent) ** 0.6906
    )


def form_factor_1984(hull: HullForm, *, stern_shape: ArrayLike = 0.0) -> FloatArray:
    r"""Form factor 1 + k1 of Holtrop (1984); `stern_shape` as in `form_factor_1982`.

    .. math::
        1 + k_1 = 0.93 + 0.487118\, c_{14} (B/L)^{1.06806} (T/L)^{0.46106}
            (L/L_R)^{0.121563} (L^3/\nabla)^{0.36486} (1 - C_P)^{-0.604247} \\
        c_{14} = 1 + 0.011 C_{stern}

    Parameters
    ----------
    hull : HullForm
        Form of the hull [SI].
    stern_shape : array_like, optional
        C_stern [-].

    Returns
    -------
    ndarray
        Form factor 1 + k1 [-].

    References
    ----------
    J. Holtrop, International Shipbuilding Progress 31 (1984) 272-276.
    Schless (2023), eq. 3.21, prints the exponent -0.60247.
    """
    c14 = 1.0 + 0.011 * np.asarray(stern_shape)
    return 0.93 + 0.487118 * c14 * (
        (hull.breadth / hull.length) ** 1.06806
        * (hull.draught / hull.length) ** 0.46106
        * (hull.length / length_of_run(hull)) ** 0.121563
        * (hull.length**3 / hull.displacement) ** 0.36486
        * (1.0 - hull.prismatic_coefficient) ** -0.604247
    )


def half_angle_of_entrance(hull: HullForm) -> FloatArray:
    r"""Half angle of entrance of the waterline i_E [deg] (Holtrop and Mennen 1982).

    .. math::
        i_E = 1 + 89 \exp\left[-(L/B)^{0.80856} (1 - C_{WP})^{0.30484} (1 - C_P - 0.0225\,
            lcb)^{0.6367} (L_R/B)^{0.34574} (100 \nabla / L^3)^{0.16302}\right]

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    fullness = 1.0 - hull.prismatic_coefficient - 0.0225 * hull.lcb_percent
    return 1.0 + 89.0 * np.exp(
        -((hull.length / hull.breadth) ** 0.80856)
        * (1.0 - hull.waterplane_coefficient) ** 0.30484
        * fullness**0.6367
        * (length_of_run(hull) / hull.breadth) ** 0.34574
        * (100.0 * hull.displacement / hull.length**3) ** 0.16302
    )
