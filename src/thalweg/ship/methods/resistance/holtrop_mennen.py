"""Calm-water resistance of Holtrop and Mennen (1982) and Holtrop (1984).

Sources: J. Holtrop and G.G.J. Mennen, "An approximate power prediction method", International
Shipbuilding Progress 29 (1982) 166-170; J. Holtrop, "A statistical re-analysis of resistance and
propulsion data", International Shipbuilding Progress 31 (1984) 272-276.

Both worked examples of the papers are among the tests. Symbols: L length of the waterline, B
breadth, T mean draught, T_F draught at the fore perpendicular, V displaced volume, C_P = C_B / C_M
prismatic coefficient, lcb position of the centre of buoyancy in percent of L, positive forward of
half of L.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, SEA_WATER_DENSITY
from thalweg.ship.methods.resistance.friction_lines import (
    SEA_WATER_VISCOSITY,
    dynamic_force,
    froude_number,
    ittc_1957,
    reynolds_number,
    ship_speed,
)
from thalweg.ship.methods.resistance.holtrop_form import (
    HullForm,
    form_factor_1982,
    form_factor_1984,
    half_angle_of_entrance,
    wetted_surface,
)
from thalweg.ship.methods.resistance.holtrop_wave import (
    HIGHEST_BULB_CENTRE,
    bulb_height,
    bulb_wave_factor,
    transom_wave_factor,
    wave_resistance,
)
from thalweg.ship.methods.validity import RangeNote, range_notes


@dataclass(frozen=True)
class HoltropResistance:
    """Resistance by component [N], arrays of one shape.

    Attributes
    ----------
    friction : R_F, flat-plate friction on the wetted surface.
    form_factor : k1 R_F, what the form of the hull adds to it.
    appendage : R_APP.
    wave_making : R_W.
    bulb : R_B, pressure resistance of a bulbous bow near the surface.
    transom : R_TR, pressure resistance of an immersed transom.
    correlation : R_A, model-ship correlation.
    total : Sum.
    """

    friction: FloatArray
    form_factor: FloatArray
    appendage: FloatArray
    wave_making: FloatArray
    bulb: FloatArray
    transom: FloatArray
    correlation: FloatArray
    total: FloatArray


def bulb_resistance(
    speed: ArrayLike,
    *,
    draught_fore: ArrayLike,
    bulb_area: ArrayLike,
    bulb_centre_height: ArrayLike,
    density: float = SEA_WATER_DENSITY,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Pressure resistance R_B of a bulbous bow near the surface [N]; 0 without a bulb.

    .. math::
        R_B = 0.11\, e^{-3 P_B^{-2}} Fn_i^3 A_{BT}^{1.5} \rho g / (1 + Fn_i^2), \quad P_B =
            0.56 \sqrt{A_{BT}} / (T_F - 1.5 h_B) \\
        Fn_i = V / \sqrt{g (T_F - h_B - 0.25 \sqrt{A_{BT}}) + 0.15 V^2}

    The centre of the bulb h_B counts at most 0.6 T_F, the limit of the method, and the immersion
    T_F - h_B - 0.25 sqrt(A_BT) at least zero.

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    Schless (2023), eqs. 3.35 to 3.37.
    """
    velocity = np.asarray(speed, dtype=float)
    area, fore = np.asarray(bulb_area, dtype=float), np.asarray(draught_fore, dtype=float)
    height = bulb_height(bulb_centre_height, fore)
    root = np.sqrt(np.where(area > 0.0, area, np.where(np.isnan(area), np.nan, 1.0)))
    emergence = 0.56 * root / (fore - 1.5 * height)
    immersion = np.maximum(fore - height - 0.25 * root, 0.0)
    below = gravity * immersion + 0.15 * velocity**2
    froude = velocity / np.sqrt(np.where(below == 0.0, 1.0, below))
    force = 0.11 * np.exp(-3.0 / emergence**2) * froude**3 / (1.0 + froude**2)
    return np.where(area == 0.0, 0.0 * velocity, force * area**1.5 * density * gravity)


def transom_resistance(
    speed: ArrayLike,
    hull: HullForm,
    *,
    transom_area: ArrayLike,
    density: float = SEA_WATER_DENSITY,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Pressure resistance R_TR of an immersed transom [N]; 0 when it runs dry (Fn_T >= 5).

    .. math::
        R_{TR} = \frac{1}{2} \rho V^2 A_T c_6, \quad c_6 = 0.2 (1 - 0.2 Fn_T)\ (\ge 0),
            \quad Fn_T = V / \sqrt{2 g A_T / (B + B C_{WP})}

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    Schless (2023), eq. 3.40, without the limit at Fn_T = 5.
    """
    area = np.asarray(transom_area, dtype=float)
    wet = np.where(area == 0.0, 1.0, area)
    depth = 2.0 * gravity * wet / (hull.breadth * (1.0 + hull.waterplane_coefficient))
    c6 = 0.2 * np.maximum(1.0 - 0.2 * np.asarray(speed, dtype=float) / np.sqrt(depth), 0.0)
    return dynamic_force(c6, speed=speed, area=area, density=density)


def correlation_coefficient(
    hull: HullForm, *, draught_fore: ArrayLike, bulb_factor: ArrayLike = 1.0
) -> FloatArray:
    r"""Model-ship correlation allowance C_A for a hull in trial condition.

    .. math::
        C_A = 0.006 (L + 100)^{-0.16} - 0.00205 + 0.003 \sqrt{L / 7.5}\, C_B^4 c_2 (0.04 -
            c_4), \quad c_4 = \min(T_F / L, 0.04)

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170.
    """
    c4 = np.minimum(np.asarray(draught_fore) / hull.length, 0.04)
    slender = 0.003 * np.sqrt(hull.length / 7.5) * hull.block_coefficient**4
    slim = 0.006 * (hull.length + 100.0) ** -0.16 - 0.00205
    return np.asarray(slim + slender * np.asarray(bulb_factor) * (0.04 - c4))


@dataclass(frozen=True)
class BulbTransomAppendages:
    """Bulb, transom, appendages and shape of the stern.

    Attributes
    ----------
    bulb_area, bulb_centre_height : array_like
        A_BT [m2] and its height above the keel h_B [m]; at most 0.6 T_F is used.
    transom_area : Immersed transom A_T [m2].
    appendage_area, appendage_factor : array_like
        Wetted area [m2] and 1 + k2 (1.5 for a rudder behind a skeg up to 4 for bossings).
    stern_shape : C_stern, see `form_factor_1982`.
    """

    bulb_area: ArrayLike = 0.0
    bulb_centre_height: ArrayLike = 0.0
    transom_area: ArrayLike = 0.0
    appendage_area: ArrayLike = 0.0
    appendage_factor: ArrayLike = 1.5
    stern_shape: ArrayLike = 0.0


def holtrop(
    speed: ArrayLike,
    hull: HullForm,
    *,
    year: Literal[1982, 1984] = 1982,
    bulb_transom_appendages: BulbTransomAppendages | None = None,
    draught_fore: ArrayLike | None = None,
    wetted_surface_area: ArrayLike | None = None,
    entrance_angle_deg: ArrayLike | None = None,
    friction_coefficient: ArrayLike | None = None,
    wave_speed: ArrayLike | None = None,
    correlation_area: Literal["hull_and_appendages", "hull"] = "hull_and_appendages",
    density: float = SEA_WATER_DENSITY,
    viscosity: float = SEA_WATER_VISCOSITY,
    gravity: float = GRAVITY,
) -> HoltropResistance:
    """Calm-water resistance.

    .. math:: R = R_F (1 + k_1) + R_{APP} + R_W + R_B + R_{TR} + R_A

    Parameters
    ----------
    speed : Speed through the water [m/s]; negative gives NaN.
    hull : Main particulars, from `hull_form`.
    year : {1982, 1984}
        Holtrop and Mennen (1982), for Fn up to about 0.4, or Holtrop (1984), for all Fn.
    bulb_transom_appendages : Bulb, transom and appendages; none by default.
    draught_fore : T_F [m]; the mean draught by default.
    wetted_surface_area : S [m2]; by `wetted_surface` by default.
    entrance_angle_deg : i_E [deg]; by `half_angle_of_entrance` by default.
    friction_coefficient : array_like, optional
        Replaces the ITTC 1957 line, for example by `shallow_water.zeng_2019_friction`.
    wave_speed : Speed that enters R_W, R_TR and R_A in place of `speed` [m/s], for Karpov's
        shallow-water method.
    correlation_area : {"hull_and_appendages", "hull"}
        Area of R_A. The papers print S; both worked examples come out with S + S_APP: R_A of 1982
        as 222.07 instead of 220.57 (printed 221.98), and the totals of 1984, which are else 0.4 to
        0.5 % low. Schless (2023) uses S.
    density, viscosity, gravity : [kg/m3], [m2/s], [m/s2].

    Returns
    -------
    HoltropResistance : Components [N].

    References
    ----------
    J. Holtrop and G.G.J. Mennen, International Shipbuilding Progress 29 (1982) 166-170. J.
    Holtrop, International Shipbuilding Progress 31 (1984) 272-276.
    """
    velocity = ship_speed(speed)
    waves = velocity if wave_speed is None else ship_speed(wave_speed)
    ends = bulb_transom_appendages or BulbTransomAppendages()
    fore = hull.draught if draught_fore is None else np.asarray(draught_fore, dtype=float)
    area = wetted_surface_area
    if area is None:
        area = wetted_surface(hull, bulb_area=ends.bulb_area)
    line = friction_coefficient
    if line is None:
        line = ittc_1957(reynolds_number(velocity, length=hull.length, viscosity=viscosity))
    form = form_factor_1982 if year == 1982 else form_factor_1984
    plate = dynamic_force(line, speed=velocity, area=area, density=density)
    wetted = np.asarray(ends.appendage_area, dtype=float) * np.asarray(ends.appendage_factor)
    parts = np.broadcast_arrays(
        plate,
        plate * (form(hull, stern_shape=ends.stern_shape) - 1.0),
        dynamic_force(line, speed=velocity, area=wetted, density=density),
        _wave_making_resistance(
            waves, hull, ends, fore, entrance_angle_deg, year, density, gravity
        ),
        bulb_resistance(
            velocity,
            draught_fore=fore,
            bulb_area=ends.bulb_area,
            bulb_centre_height=ends.bulb_centre_height,
            density=density,
            gravity=gravity,
        ),
        transom_resistance(
            waves, hull, transom_area=ends.transom_area, density=density, gravity=gravity
        ),
        dynamic_force(
            correlation_coefficient(
                hull, draught_fore=fore, bulb_factor=_bulb_factor(hull, ends, fore)
            ),
            speed=waves,
            area=_correlation_area(area, ends, correlation_area),
            density=density,
        ),
    )
    return HoltropResistance(*(*parts, np.sum(parts, axis=0)))


def _correlation_area(area: ArrayLike, ends: BulbTransomAppendages, which: str) -> FloatArray:
    own = np.asarray(area, dtype=float)
    return own if which == "hull" else own + np.asarray(ends.appendage_area, dtype=float)


def _bulb_factor(hull: HullForm, ends: BulbTransomAppendages, fore: FloatArray) -> FloatArray:
    return bulb_wave_factor(
        hull,
        draught_fore=fore,
        bulb_area=ends.bulb_area,
        bulb_centre_height=ends.bulb_centre_height,
    )


def _wave_making_resistance(
    speed: FloatArray,
    hull: HullForm,
    ends: BulbTransomAppendages,
    fore: FloatArray,
    angle: ArrayLike | None,
    year: Literal[1982, 1984],
    density: float,
    gravity: float,
) -> FloatArray:
    return wave_resistance(
        speed,
        hull,
        entrance_angle_deg=half_angle_of_entrance(hull) if angle is None else angle,
        bulb_factor=_bulb_factor(hull, ends, fore),
        transom_factor=transom_wave_factor(hull, transom_area=ends.transom_area),
        year=year,
        density=density,
        gravity=gravity,
    )


def holtrop_validity(
    speed: ArrayLike,
    hull: HullForm,
    *,
    year: Literal[1982, 1984] = 1982,
    draught_fore: ArrayLike | None = None,
    bulb_centre_height: ArrayLike = 0.0,
) -> list[RangeNote]:
    """Return which quantities are outside the usual range of the method.

    Ranges 0.55 < C_P < 0.85, 3.9 < L/B < 15, 2.1 < B/T < 4.0 and Fn < 0.45 (1982) or 1.0 (1984)
    are those quoted in handbooks (unverified: the papers only describe the data).

    Parameters
    ----------
    speed : array_like [m/s]
    hull : Main particulars.
    year : {1982, 1984}
        Which method.
    draught_fore, bulb_centre_height : T_F and h_B [m], for the limit h_B <= 0.6 T_F.
    """
    fore = hull.draught if draught_fore is None else np.asarray(draught_fore, dtype=float)
    fastest = 0.45 if year == 1982 else 1.0
    height = np.asarray(bulb_centre_height) / fore
    ranges: dict[str, tuple[ArrayLike, float, float]] = {
        "Froude number": (froude_number(speed, length=hull.length), 0.0, fastest),
        "prismatic coefficient": (hull.prismatic_coefficient, 0.55, 0.85),
        "length to breadth": (hull.length / hull.breadth, 3.9, 15.0),
        "breadth to draught": (hull.breadth / hull.draught, 2.1, 4.0),
        "bulb centre height to draught": (height, 0.0, HIGHEST_BULB_CENTRE),
    }
    return range_notes("holtrop_mennen_1982" if year == 1982 else "holtrop_1984", ranges)
