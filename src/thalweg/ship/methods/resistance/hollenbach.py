"""Calm-water resistance of Hollenbach (1998), in all its published variants.

Source: U. Hollenbach, "Estimating resistance and propulsion for single-screw and twin-screw
ships", Schiffstechnik 45(2), 1998; reprinted in Schneekluth and Bertram, "Ship Design for
Efficiency and Economy" (2nd ed., 1998) and Birk, "Fundamentals of Ship Hydrodynamics" (2019).

`thalweg.ship.methods.resistance.hollenbach_coefficients` states how certain the coefficients are.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.ship.methods.resistance.friction_lines import (
    Water,
    froude_number,
    ittc_1957,
    reynolds_number,
    ship_speed,
)
from thalweg.ship.methods.resistance.hollenbach_coefficients import (
    RESISTANCE_COEFFICIENTS,
    SURFACE_COEFFICIENTS,
    ResistanceVariant,
    SurfaceVariant,
)
from thalweg.ship.methods.resistance.hollenbach_hull import (
    AppendageCounts,
    HollenbachHull,
    froude_length,
)
from thalweg.ship.methods.validity import RangeNote, range_notes

_ONE_RUDDER: Final = AppendageCounts()
_SEA_WATER: Final = Water()


@dataclass(frozen=True)
class HollenbachResistance:
    """Resistance by component [N], arrays of one shape.

    Attributes
    ----------
    friction : ITTC 1957 friction on the wetted surface.
    residuary : The remaining resistance: form, waves, appendages.
    correlation : Correlation allowance; zero unless one is given.
    total : Sum of the three.
    """

    friction: FloatArray
    residuary: FloatArray
    correlation: FloatArray
    total: FloatArray


def standard_residuary(
    froude: ArrayLike, *, block_coefficient: ArrayLike, variant: ResistanceVariant = "single_design"
) -> FloatArray:
    """Standard residuary coefficient C_R,standard, a quadratic in Fn and C_B.

    .. math::
        C_{R,std} = b_{11} + b_{12} Fn + b_{13} Fn^2 + C_B (b_{21} + b_{22} Fn + b_{23}
            Fn^2) + C_B^2 (b_{31} + b_{32} Fn + b_{33} Fn^2)

    References
    ----------
    U. Hollenbach, Schiffstechnik 45(2) (1998), as in Schneekluth and Bertram (1998) and Birk
    (2019).
    Yu (2021), eq. 5, with misprints.
    """
    fn = np.asarray(froude, dtype=float)
    block = np.asarray(block_coefficient, dtype=float)
    rows = [b1 + b2 * fn + b3 * fn**2 for b1, b2, b3 in RESISTANCE_COEFFICIENTS[variant].residuary]
    return rows[0] + block * rows[1] + block**2 * rows[2]


def critical_froude_number(
    block_coefficient: ArrayLike, *, variant: ResistanceVariant = "single_design"
) -> FloatArray:
    """Fn_crit = d1 + d2 C_B + d3 C_B^2; infinite for the minimum curves, which have none."""
    block = np.asarray(block_coefficient, dtype=float)
    if RESISTANCE_COEFFICIENTS[variant].critical is None:
        return np.where(np.isnan(block), np.nan, np.inf)
    d1, d2, d3 = RESISTANCE_COEFFICIENTS[variant].critical or (np.nan, np.nan, np.nan)
    return d1 + d2 * block + d3 * block**2


def froude_factor(
    froude: ArrayLike, *, block_coefficient: ArrayLike, variant: ResistanceVariant = "single_design"
) -> FloatArray:
    r"""Factor k_F: 1 below the critical Froude number, (Fn / Fn_crit)^c1 above.

    .. math::
        k_F = 1\ (Fn < Fn_{crit}), \quad (Fn / Fn_{crit})^{c_1}\ (Fn \ge Fn_{crit}), \\
        c_1 = Fn / Fn_{crit}, \quad \text{in ballast}\ c_1 = 10 C_B (Fn / Fn_{crit} - 1)

    The condition is on Fn, not on the factor: with the ballast exponent
    c1 = 10 C_B (Fn / Fn_crit - 1) the power exceeds one below the critical number as well.

    References
    ----------
    U. Hollenbach, Schiffstechnik 45(2) (1998), as in Schneekluth and Bertram (1998) and Birk
    (2019).
    Yu (2021), eq. 6, with misprints.
    """
    fn = np.asarray(froude, dtype=float)
    block = np.asarray(block_coefficient, dtype=float)
    ratio = fn / critical_froude_number(block, variant=variant)
    above = np.maximum(ratio, 1.0)
    growth = RESISTANCE_COEFFICIENTS[variant].growth
    exponent = 10.0 * block * (above - 1.0) if growth == "block" else above
    return np.where(np.isnan(ratio), np.nan, above**exponent)


def residuary_coefficient(
    froude: ArrayLike,
    hull: HollenbachHull,
    *,
    appendages: AppendageCounts = _ONE_RUDDER,
    variant: ResistanceVariant = "single_design",
) -> FloatArray:
    r"""Residuary coefficient C_R on the area B T (the printed one divided by ten).

    .. math::
        C_R = \frac{1}{10} C_{R,std} k_F e_1 L^{e_2} (T/B)^{a_1} (B/L)^{a_2}
            (L_{OS}/L_{WL})^{a_3} (L_{WL}/L)^{a_4} \\
        (1 + (T_A - T_F)/L)^{a_5} (D_P/T_A)^{a_6} (1 + N_{rud})^{a_7} (1 + N_{brac})^{a_8}
            (1 + N_{boss})^{a_9} (1 + N_{thr})^{a_{10}}

    C_R = 0.1 C_R,standard k_F k_L (T/B)^a1 (B/L)^a2 (L_OS/L_WL)^a3 (L_WL/L)^a4
    (1 + (T_A - T_F)/L)^a5 (D_P/T_A)^a6 (1 + N_rudders)^a7 (1 + N_brackets)^a8 (1 + N_bosses)^a9
    (1 + N_thrusters)^a10, with k_L = e1 L^e2.

    Parameters
    ----------
    froude : array_like
        Froude number on `froude_length`.
    variant : str
        Key of `RESISTANCE_COEFFICIENTS`.

    Returns
    -------
    ndarray
        C_R [-].

    References
    ----------
    U. Hollenbach, Schiffstechnik 45(2) (1998), as in Schneekluth and Bertram (1998) and Birk
    (2019).
    Yu (2021), eq. 4, with misprints.
    """
    coefficients = RESISTANCE_COEFFICIENTS[variant]
    length = np.asarray(hull.length_between_perpendiculars, dtype=float)
    waterline = np.asarray(hull.length_waterline, dtype=float)
    breadth = np.asarray(hull.breadth, dtype=float)
    fore, aft = np.asarray(hull.draught_fore, float), np.asarray(hull.draught_aft, float)
    block = np.asarray(hull.block_coefficient, dtype=float)
    n = appendages
    counts = (n.rudders, n.brackets, n.bosses, n.thrusters)
    bases = (
        0.5 * (fore + aft) / breadth,
        breadth / length,
        np.asarray(hull.length_over_surface, dtype=float) / waterline,
        waterline / length,
        1.0 + (aft - fore) / length,
        np.asarray(hull.propeller_diameter, dtype=float) / aft,
        *(1.0 + np.asarray(count, dtype=float) for count in counts),
    )
    factor = np.asarray(coefficients.length[0] * length ** coefficients.length[1])
    for base, exponent in zip(bases, coefficients.ratios, strict=True):
        if exponent != 0.0:
            factor = factor * base**exponent
    standard = standard_residuary(froude, block_coefficient=block, variant=variant)
    growth = froude_factor(froude, block_coefficient=block, variant=variant)
    return 0.1 * standard * growth * factor


def hollenbach_1998(
    speed: ArrayLike,
    hull: HollenbachHull,
    *,
    wetted_surface: ArrayLike,
    appendages: AppendageCounts = _ONE_RUDDER,
    variant: ResistanceVariant = "single_design",
    correlation_allowance: ArrayLike = 0.0,
    friction_coefficient: ArrayLike | None = None,
    water: Water = _SEA_WATER,
) -> HollenbachResistance:
    r"""Calm-water resistance, mean or minimum line.

    .. math:: R = \frac{1}{2} \rho V^2 (C_F S + C_R B T + C_A S)

    Parameters
    ----------
    speed : Speed through the water V [m/s]; negative gives NaN.
    wetted_surface : S [m2], see `hollenbach_wetted_surface`.
    variant : Key of `RESISTANCE_COEFFICIENTS`; the ``*_minimum`` keys give the minimum line.
    correlation_allowance : array_like
        C_A on the wetted surface; the method itself has none, see `correlation_allowance`.
    friction_coefficient : Replaces the ITTC 1957 line, for example by a shallow-water one.

    Returns
    -------
    HollenbachResistance : Components [N]. Outside the Froude range (`hollenbach_validity`) the
        curve is still evaluated; the caller decides.

    References
    ----------
    U. Hollenbach, Schiffstechnik 45(2) (1998), as in Schneekluth and Bertram (1998) and Birk
    (2019). C_A is zero in the publication.
    Yu (2021), eq. 13, with misprints.
    """
    velocity = ship_speed(speed)
    length = hull.length_between_perpendiculars
    effective = froude_length(length, length_over_surface=hull.length_over_surface)
    if friction_coefficient is None:
        friction_coefficient = ittc_1957(
            reynolds_number(velocity, length=length, viscosity=water.viscosity)
        )
    froude = froude_number(velocity, length=effective, gravity=water.gravity)
    rest = residuary_coefficient(froude, hull, appendages=appendages, variant=variant)
    draughts = np.asarray(hull.draught_fore) + np.asarray(hull.draught_aft)
    section = np.asarray(hull.breadth) * 0.5 * draughts
    pressure = 0.5 * water.density * velocity**2
    friction, residuary, correlation = np.broadcast_arrays(
        pressure * np.asarray(wetted_surface) * friction_coefficient,
        pressure * section * rest,
        pressure * np.asarray(wetted_surface) * correlation_allowance,
    )
    total = friction + residuary + correlation
    return HollenbachResistance(friction, residuary, correlation, total)


def correlation_allowance(length_between_perpendiculars: ArrayLike) -> FloatArray:
    r"""C_A = (0.35 - 0.002 L) 1e-3 below L = 175 m, else 0.

    .. math:: C_A = \max(0, (0.35 - 0.002 L) \cdot 10^{-3})

    Source: Birk (2019), seen in one reprint only; an option, not part of the 1998 paper.

    References
    ----------
    L. Birk, "Fundamentals of Ship Hydrodynamics" (2019), unverified: seen in one reprint only;
    not part of the 1998 paper.
    """
    length = np.asarray(length_between_perpendiculars, dtype=float)
    return np.maximum((0.35 - 0.002 * length) * 1e-3, 0.0)


def hollenbach_wetted_surface(
    hull: HollenbachHull,
    *,
    appendages: AppendageCounts = _ONE_RUDDER,
    variant: SurfaceVariant = "single_design",
) -> FloatArray:
    r"""Wetted surface S = k L (B + 2 T) with Hollenbach's regression for k.

    .. math::
        S = k L (B + 2 T), \quad k = s_0 + s_1 \frac{L_{OS}}{L_{WL}} + s_2 \frac{L_{WL}}{L}
            + s_3 C_B + s_4 \frac{L}{B} + s_5 \frac{B}{T} + s_6 \frac{L}{T} \\
        + s_7 \frac{T_A - T_F}{L} + s_8 \frac{D_P}{T} + s_9 N_{rud} + s_{10} N_{brac} +
            s_{11} N_{boss}

    k = s0 + s1 L_OS/L_WL + s2 L_WL/L + s3 C_B + s4 L/B + s5 B/T + s6 L/T + s7 (T_A - T_F)/L
    + s8 D_P/T + s9 N_rudders + s10 N_brackets + s11 N_bosses.

    Parameters
    ----------
    variant : str
        Key of `SURFACE_COEFFICIENTS`.

    Returns
    -------
    ndarray
        Wetted surface [m2].

    References
    ----------
    U. Hollenbach, Schiffstechnik 45(2) (1998), as in Schneekluth and Bertram (1998) and Birk
    (2019).
    """
    length = np.asarray(hull.length_between_perpendiculars, dtype=float)
    waterline = np.asarray(hull.length_waterline, dtype=float)
    breadth = np.asarray(hull.breadth, dtype=float)
    fore, aft = np.asarray(hull.draught_fore, float), np.asarray(hull.draught_aft, float)
    draught = 0.5 * (fore + aft)
    counts = (appendages.rudders, appendages.brackets, appendages.bosses)
    terms = (
        1.0,
        np.asarray(hull.length_over_surface, dtype=float) / waterline,
        waterline / length,
        np.asarray(hull.block_coefficient, dtype=float),
        length / breadth,
        breadth / draught,
        length / draught,
        (aft - fore) / length,
        np.asarray(hull.propeller_diameter, dtype=float) / draught,
        *(np.asarray(count, dtype=float) for count in counts),
    )
    shape = sum(
        (s * term for s, term in zip(SURFACE_COEFFICIENTS[variant], terms, strict=True)),
        start=np.float64(0.0),
    )
    return np.asarray(shape * length * (breadth + 2.0 * draught))


def froude_limits(
    block_coefficient: ArrayLike, *, variant: ResistanceVariant = "single_design"
) -> tuple[FloatArray, FloatArray]:
    """Froude range of the data: min(f1, f1 + f2 (f3 - C_B)) to g1 + g2 C_B + g3 C_B^2."""
    block = np.asarray(block_coefficient, dtype=float)
    f1, f2, f3 = RESISTANCE_COEFFICIENTS[variant].lower
    g1, g2, g3 = RESISTANCE_COEFFICIENTS[variant].upper
    return np.minimum(f1, f1 + f2 * (f3 - block)), g1 + g2 * block + g3 * block**2


def hollenbach_validity(
    speed: ArrayLike,
    hull: HollenbachHull,
    *,
    variant: ResistanceVariant = "single_design",
) -> list[RangeNote]:
    """Return which speeds are outside the Froude range of the data.

    Some limits are unverified, see `thalweg.ship.methods.resistance.hollenbach_coefficients`.

    Parameters
    ----------
    speed : array_like [m/s]
    hull : Of scalars.
    variant : Key of `RESISTANCE_COEFFICIENTS`.
    """
    length = froude_length(
        hull.length_between_perpendiculars, length_over_surface=hull.length_over_surface
    )
    low, high = froude_limits(hull.block_coefficient, variant=variant)
    froude = froude_number(speed, length=length)
    limits = {"Froude number": (froude, float(low), float(high))}
    return range_notes(f"hollenbach_1998 ({variant})", limits)
