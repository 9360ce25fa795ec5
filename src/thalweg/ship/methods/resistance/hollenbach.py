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
from thalweg.core.units import GRAVITY
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
from thalweg.ship.methods.validity import RangeNote, range_notes


@dataclass(frozen=True)
class HollenbachHull:
    """Particulars of a hull for Hollenbach's regressions; scalars or arrays that broadcast.

    Attributes
    ----------
    length_between_perpendiculars, length_waterline : array_like
        L and L_WL [m].
    length_over_surface : array_like
        L_OS [m], foremost to aftmost wetted point, bulb included.
    breadth, draught_fore, draught_aft : array_like
        B, T_F and T_A [m].
    block_coefficient : array_like
        C_B on L, B and the mean draught.
    propeller_diameter : array_like
        D_P [m].
    """

    length_between_perpendiculars: ArrayLike
    length_waterline: ArrayLike
    length_over_surface: ArrayLike
    breadth: ArrayLike
    draught_fore: ArrayLike
    draught_aft: ArrayLike
    block_coefficient: ArrayLike
    propeller_diameter: ArrayLike


@dataclass(frozen=True)
class AppendageCounts:
    """Numbers of appendages; they act on the twin-screw mean curves and surfaces only.

    Attributes
    ----------
    rudders, brackets, bosses, thrusters : array_like
        Counts; thrusters are side thrusters.
    """

    rudders: ArrayLike = 1
    brackets: ArrayLike = 0
    bosses: ArrayLike = 0
    thrusters: ArrayLike = 0


_ONE_RUDDER: Final = AppendageCounts()
_SEA_WATER: Final = Water()


@dataclass(frozen=True)
class HollenbachResistance:
    """Resistance by component [N], arrays of one shape.

    Attributes
    ----------
    friction : ndarray
        ITTC 1957 friction on the wetted surface.
    residuary : ndarray
        The remaining resistance: form, waves, appendages.
    correlation : ndarray
        Correlation allowance; zero unless one is given.
    total : ndarray
        Sum of the three.
    """

    friction: FloatArray
    residuary: FloatArray
    correlation: FloatArray
    total: FloatArray


def froude_length(
    length_between_perpendiculars: ArrayLike, *, length_over_surface: ArrayLike
) -> FloatArray:
    """Length that enters the Froude number (Hollenbach 1998, Table 1).

    Parameters
    ----------
    length_between_perpendiculars : array_like
        L [m].
    length_over_surface : array_like
        L_OS [m], foremost to aftmost wetted point, bulb included.

    Returns
    -------
    ndarray
        L_OS below L_OS / L = 1; L + 2/3 (L_OS - L) up to 1.1; 1.0667 L from there on [m].
    """
    length = np.asarray(length_between_perpendiculars, dtype=float)
    over = np.asarray(length_over_surface, dtype=float)
    ratio = over / length
    middle = length + 2.0 / 3.0 * (over - length)
    known = np.where(ratio < 1.0, over, np.where(ratio < 1.1, middle, 1.0667 * length))
    return np.where(np.isnan(ratio), np.nan, known)


def standard_residuary(
    froude: ArrayLike, *, block_coefficient: ArrayLike, variant: ResistanceVariant = "single_design"
) -> FloatArray:
    """Standard residuary coefficient C_R,standard, a quadratic in Fn and C_B."""
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
    """Factor k_F: 1 below the critical Froude number, (Fn / Fn_crit)^c1 above.

    The condition is on Fn, not on the factor: with the ballast exponent
    c1 = 10 C_B (Fn / Fn_crit - 1) the power exceeds one below the critical number as well.
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
    """Residuary coefficient C_R on the area B T (the printed one divided by ten).

    C_R = 0.1 C_R,standard k_F k_L (T/B)^a1 (B/L)^a2 (L_OS/L_WL)^a3 (L_WL/L)^a4
    (1 + (T_A - T_F)/L)^a5 (D_P/T_A)^a6 (1 + N_rudders)^a7 (1 + N_brackets)^a8 (1 + N_bosses)^a9
    (1 + N_thrusters)^a10, with k_L = e1 L^e2.

    Parameters
    ----------
    froude : array_like
        Froude number on `froude_length`.
    hull : HollenbachHull
    appendages : AppendageCounts
    variant : str
        Key of `RESISTANCE_COEFFICIENTS`.

    Returns
    -------
    ndarray
        C_R [-].
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
    """Calm-water resistance, mean or minimum line, R = 0.5 rho V^2 (C_F S + C_R B T).

    Parameters
    ----------
    speed : array_like
        Speed through the water V [m/s]; negative gives NaN.
    hull : HollenbachHull
    wetted_surface : array_like
        S [m2], see `hollenbach_wetted_surface`.
    appendages : AppendageCounts
    variant : str
        Key of `RESISTANCE_COEFFICIENTS`; the ``*_minimum`` keys give the minimum line.
    correlation_allowance : array_like
        C_A on the wetted surface; the method itself has none, see `correlation_allowance`.
    friction_coefficient : array_like, optional
        Replaces the ITTC 1957 line, for example by a shallow-water one.
    water : Water

    Returns
    -------
    HollenbachResistance
        Components [N]. Outside the Froude range (`hollenbach_validity`) the curve is still
        evaluated; the caller decides.
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


def maximum_factor(variant: ResistanceVariant = "single_design") -> float:
    """Ratio h1 of Hollenbach's maximum to his mean line (unverified: quoted from memory)."""
    return RESISTANCE_COEFFICIENTS[variant].maximum


def correlation_allowance(length_between_perpendiculars: ArrayLike) -> FloatArray:
    """C_A = (0.35 - 0.002 L) 1e-3 below L = 175 m, else 0.

    Source: Birk (2019), seen in one reprint only; an option, not part of the 1998 paper.
    """
    length = np.asarray(length_between_perpendiculars, dtype=float)
    return np.maximum((0.35 - 0.002 * length) * 1e-3, 0.0)


def hollenbach_wetted_surface(
    hull: HollenbachHull,
    *,
    appendages: AppendageCounts = _ONE_RUDDER,
    variant: SurfaceVariant = "single_design",
) -> FloatArray:
    """Wetted surface S = k L (B + 2 T) with Hollenbach's regression for k.

    k = s0 + s1 L_OS/L_WL + s2 L_WL/L + s3 C_B + s4 L/B + s5 B/T + s6 L/T + s7 (T_A - T_F)/L
    + s8 D_P/T + s9 N_rudders + s10 N_brackets + s11 N_bosses.

    Parameters
    ----------
    hull : HollenbachHull
    appendages : AppendageCounts
    variant : str
        Key of `SURFACE_COEFFICIENTS`.

    Returns
    -------
    ndarray
        Wetted surface [m2].
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
    gravity: float = GRAVITY,
) -> list[RangeNote]:
    """Return which speeds are outside the Froude range of the data.

    Some limits are unverified, see `thalweg.ship.methods.resistance.hollenbach_coefficients`.

    Parameters
    ----------
    speed : array_like
        [m/s].
    hull : HollenbachHull
        Of scalars.
    variant : str
        Key of `RESISTANCE_COEFFICIENTS`.
    gravity : float
        [m/s2].

    Returns
    -------
    list of RangeNote
    """
    length = froude_length(
        hull.length_between_perpendiculars, length_over_surface=hull.length_over_surface
    )
    low, high = froude_limits(hull.block_coefficient, variant=variant)
    froude = froude_number(speed, length=length, gravity=gravity)
    limits = {"Froude number": (froude, float(low), float(high))}
    return range_notes(f"hollenbach_1998 ({variant})", limits)
