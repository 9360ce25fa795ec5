"""Added resistance in waves by STAwave-1 and STAwave-2.

Sources: ITTC Recommended Procedure 7.5-04-01-01.2 (2014) and ISO 15016:2015, Annex D; van den Boom,
Huisman and Mennen (2013). Wave angles are zero for waves from ahead and pi for waves from astern.

Both methods are made for waves from within 45 degrees of the bow. Outside that sector they say
nothing; the functions return zero there, so that no resistance is invented and following seas
never push. Use `thalweg.ship.methods.added_resistance.snnm_table` for every heading.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, SEA_WATER_DENSITY
from thalweg.ship.methods.added_resistance.mean_wave_force import (
    LOG_FREQUENCY_STEP,
    REFLECTION_STEP,
    Spectrum,
    in_blocks,
    log_spaced_nodes,
    spectral_shape,
)
from thalweg.ship.methods.resistance.friction_lines import froude_number, ship_speed
from thalweg.ship.methods.validity import RangeNote, range_notes

HEAD_SECTOR: Final = np.pi / 4.0  #: half width of the sector of STAwave-1 and STAwave-2 [rad]
WAVE_HEIGHT_RANGE: Final = "wave height"  #: the quantity of notes on wave heights
_LEAST_FROUDE_NUMBER: Final = 1e-3
_LOG_PEAK_FREQUENCIES: Final = np.linspace(
    np.log(0.02), np.log(20.0), 2001
)  #: where the means are tabulated


def in_head_sector(wave_angle: ArrayLike) -> FloatArray:
    """1 for waves from within 45 degrees of the bow, 0 for others, NaN where unknown."""
    ahead = np.cos(np.asarray(wave_angle, dtype=float))
    inside = np.where(ahead >= np.cos(HEAD_SECTOR) - 1e-12, 1.0, 0.0)
    return np.where(np.isnan(ahead), np.nan, inside)


def head_sector_validity(wave_angle: ArrayLike, *, method: str) -> list[RangeNote]:
    """Return which waves come from outside the sector, where the resistance is taken as zero.

    Parameters
    ----------
    wave_angle : Direction from which waves come, relative to the bow [rad].
    method : Name of the method, for the note.

    Returns
    -------
    list of RangeNote : Empty inside the sector.
    """
    degrees = np.degrees(np.abs(np.asarray(wave_angle, dtype=float)))
    outside = np.where(in_head_sector(wave_angle) == 1.0, 0.0, degrees)
    return range_notes(method, {"wave angle": (outside, 0.0, np.degrees(HEAD_SECTOR))})


def stawave1(
    wave_height: ArrayLike,
    wave_angle: ArrayLike,
    *,
    breadth: ArrayLike,
    bow_length: ArrayLike,
    density: float = SEA_WATER_DENSITY,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""STAwave-1.

    .. math:: R_{AWL} = \frac{1}{16} \rho g H_s^2 B \sqrt{B / L_{BWL}}

    Parameters
    ----------
    wave_height : Significant wave height Hs [m].
    wave_angle : [rad], 0 from ahead; zero resistance outside the sector of 45 degrees.
    breadth : array_like [m]
    bow_length : L_BWL [m], on the waterline from the bow to 95 % of the largest breadth.
    density, gravity : [kg/m3], [m/s2].

    Returns
    -------
    ndarray : [N]; zero where the wave height is zero, NaN where height or angle is unknown.

    Notes
    -----
    Meant for small motions: Hs <= 2.25 sqrt(L_PP / 100) (not compared with the source).

    References
    ----------
    ITTC Recommended Procedure 7.5-04-01-01.2 (2014); ISO 15016:2015, Annex D.
    """
    height = np.asarray(wave_height, dtype=float)
    wide = np.asarray(breadth, dtype=float)
    force = height**2 * density * gravity / 16.0 * wide * np.sqrt(wide / np.asarray(bow_length))
    return np.where(height == 0.0, 0.0, force * in_head_sector(wave_angle))


def _reflection_shape(wave_draught: ArrayLike) -> FloatArray:
    """pi^2 I1^2 / (pi^2 I1^2 + K1^2) at 1.5 k T, given k T; scaled so that nothing overflows."""
    from scipy.special import i1e, k1e

    x = 1.5 * np.asarray(wave_draught, dtype=float)
    ratio = k1e(x) / (np.pi * i1e(x)) * np.exp(-2.0 * x)
    return np.asarray(1.0 / (1.0 + ratio**2))


def _reflection_speed(
    speed: FloatArray, draught: ArrayLike, block_coefficient: ArrayLike, gravity: float
) -> FloatArray:
    """f1 = 0.692 (V / sqrt(T g))^0.769 + 1.81 C_B^6.95, V in m/s."""
    ratio = speed / np.sqrt(np.asarray(draught, dtype=float) * gravity)
    return np.asarray(0.692 * ratio**0.769 + 1.81 * np.asarray(block_coefficient) ** 6.95)


def _motion_shape(frequency: FloatArray, slenderness: float) -> FloatArray:
    """w^b1 exp{b1/d1 (1 - w^d1)} of the dimensionless frequency w."""
    slow = frequency < 1.0
    b1 = np.where(slow, 11.0, -8.50)
    d1 = np.where(slow, 14.0, -566.0 * slenderness**-2.66)
    return np.asarray(frequency**b1 * np.exp(b1 / d1 * (1.0 - frequency**d1)))


def _motion_speed(froude: FloatArray, block_coefficient: ArrayLike) -> FloatArray:
    """a1 Fr^1.5 exp(-3.5 Fr), a1 = 60.3 C_B^1.34."""
    a1 = 60.3 * np.asarray(block_coefficient, dtype=float) ** 1.34
    return np.asarray(a1 * froude**1.5 * np.exp(-3.5 * froude))


def _frequency_scale(
    froude: FloatArray, length: ArrayLike, gyration: ArrayLike, gravity: float
) -> FloatArray:
    """Dimensionless frequency for w = 1 rad/s: sqrt(L/g) k_yy^(1/3) Fr^0.143 / 1.17."""
    scale = np.sqrt(np.asarray(length) / gravity) * np.cbrt(gyration)
    return np.asarray(scale * np.maximum(froude, _LEAST_FROUDE_NUMBER) ** 0.143 / 1.17)


def stawave2_transfer(
    frequency: ArrayLike,
    speed: ArrayLike,
    *,
    length_between_perpendiculars: float,
    breadth: float,
    draught: ArrayLike,
    block_coefficient: ArrayLike,
    pitch_gyration: ArrayLike = 0.25,
    density: float = SEA_WATER_DENSITY,
    gravity: float = GRAVITY,
) -> tuple[FloatArray, FloatArray]:
    r"""STAwave-2 in regular head waves, for an amplitude of one metre.

    .. math::
        R_{AWML} / \zeta_A^2 = 4 \rho g \frac{B^2}{L_{PP}} 60.3\, C_B^{1.34} Fr^{1.5}
            e^{-3.5 Fr}\, \bar{\omega}^{b_1} e^{\frac{b_1}{d_1} (1 - \bar{\omega}^{d_1})} \\
        \bar{\omega} = \omega \sqrt{L_{PP} / g}\, \sqrt[3]{k_{yy}}\, Fr^{0.143} / 1.17,
            \quad b_1 = 11\ (\bar{\omega} < 1),\ -8.5, \quad d_1 = 14\ (\bar{\omega} < 1),\
            -566 (L_{PP} / B)^{-2.66} \\
        R_{AWRL} / \zeta_A^2 = \frac{1}{2} \rho g B \frac{\pi^2 I_1^2(1.5 k T)}{\pi^2
            I_1^2(1.5 k T) + K_1^2(1.5 k T)} \left[0.692 \left(\frac{V}{\sqrt{T
            g}}\right)^{0.769} + 1.81 C_B^{6.95}\right]

    Parameters
    ----------
    frequency : array_like
        Wave frequency [rad/s].
    speed : array_like [m/s]
    length_between_perpendiculars, breadth : float [m]
    draught : array_like [m]
    block_coefficient : array_like
        C_B.
    pitch_gyration : array_like
        k_yy as a part of the length.
    density, gravity : float
        [kg/m3], [m/s2].

    Returns
    -------
    motion, reflection : ndarray
        R_AWML and R_AWRL divided by the square of the amplitude [N/m2].

    References
    ----------
    ITTC Recommended Procedure 7.5-04-01-01.2 (2014); ISO 15016:2015, Annex D.
    """
    omega = np.asarray(frequency, dtype=float)
    velocity = ship_speed(speed)
    length = length_between_perpendiculars
    fn = froude_number(velocity, length=length, gravity=gravity)
    reduced = omega * _frequency_scale(fn, length, pitch_gyration, gravity)
    weight = density * gravity
    motion = 4.0 * weight * breadth**2 / length * _motion_speed(fn, block_coefficient)
    speed_factor = _reflection_speed(velocity, draught, block_coefficient, gravity)
    reflection = 0.5 * weight * breadth * speed_factor
    shape = _reflection_shape(omega**2 / gravity * np.asarray(draught))
    return motion * _motion_shape(reduced, length / breadth), reflection * shape


@lru_cache(maxsize=32)
def _motion_mean(slenderness: float, spectrum: Spectrum, gamma: float) -> FloatArray:
    """Mean of the motion shape over the spectrum, for each dimensionless peak frequency."""
    frequency = log_spaced_nodes(0.3, 5.0, step=LOG_FREQUENCY_STEP[spectrum])
    shape = LOG_FREQUENCY_STEP[spectrum] * _motion_shape(frequency, slenderness)
    return _mean(frequency, shape, spectrum, gamma)


@lru_cache(maxsize=32)
def _reflection_mean(spectrum: Spectrum, gamma: float) -> FloatArray:
    """Mean of the reflected part over the spectrum, for each w_p sqrt(T / g)."""
    frequency = log_spaced_nodes(0.02, 120.0, step=REFLECTION_STEP[spectrum])
    shape = REFLECTION_STEP[spectrum] * _reflection_shape(frequency**2)
    return _mean(frequency, shape, spectrum, gamma)


def _mean(frequency: FloatArray, shape: FloatArray, spectrum: Spectrum, gamma: float) -> FloatArray:
    def block(peak: FloatArray) -> FloatArray:
        ratio = frequency / peak[:, None]
        energy = spectral_shape(ratio, spectrum=spectrum, gamma=gamma)
        return np.asarray(energy @ shape)

    return in_blocks(block, np.exp(_LOG_PEAK_FREQUENCIES))


def _look_up(peak: FloatArray, means: FloatArray) -> FloatArray:
    """Interpolate between means; beyond the table nothing moves, or all is reflected."""
    known = np.where(peak > 0.0, peak, np.where(np.isnan(peak), np.nan, 1e-9))
    return np.asarray(np.interp(np.log(known), _LOG_PEAK_FREQUENCIES, means))


def stawave2(
    speed: ArrayLike,
    wave_height: ArrayLike,
    wave_period: ArrayLike,
    wave_angle: ArrayLike,
    *,
    length_between_perpendiculars: float,
    breadth: float,
    draught: ArrayLike,
    block_coefficient: ArrayLike,
    pitch_gyration: ArrayLike = 0.25,
    spectrum: Spectrum = "bretschneider",
    gamma: float = 3.3,
    density: float = SEA_WATER_DENSITY,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""STAwave-2: mean added resistance in a long-crested head sea.

    .. math::
        R_{AW} = 2 \int_0^\infty \frac{R_{AWML}(\omega) + R_{AWRL}(\omega)}{\zeta_A^2}
            E(\omega) \, d\omega

    Parameters
    ----------
    speed : Speed through the water [m/s].
    wave_height : Significant wave height [m].
    wave_period : Peak period [s].
    wave_angle : [rad], 0 from ahead; zero resistance outside the sector of 45 degrees.
    length_between_perpendiculars, breadth : float [m]
    draught, block_coefficient, pitch_gyration : T [m], C_B, and k_yy as a part of the length.
    spectrum, gamma
        See `thalweg.ship.methods.added_resistance.mean_wave_force.spectral_shape`.
    density, gravity : [kg/m3], [m/s2].

    Returns
    -------
    ndarray : [N]; zero where the wave height is zero, NaN where something is unknown.

    Notes
    -----
    Range: `stawave2_validity`. The mean over the spectrum depends on one dimensionless peak
    frequency for the motions and one for the reflection; both means are tabulated once for each
    slenderness and spectrum (relative error about 1e-4). Two errors of public programs are
    avoided: the speed in the reflection term is in m/s, and the dimensionless frequency has
    Fr^-0.143, not Fr.

    References
    ----------
    ITTC Recommended Procedure 7.5-04-01-01.2 (2014); ISO 15016:2015, Annex D.
    """
    length = float(length_between_perpendiculars)
    velocity = ship_speed(speed)
    fn = froude_number(velocity, length=length, gravity=gravity)
    period = np.asarray(wave_period, dtype=float)
    peak = 2.0 * np.pi / np.where(period > 0.0, period, np.nan)
    height = np.asarray(wave_height, dtype=float)
    deep = np.asarray(draught, dtype=float)
    tuned = peak * _frequency_scale(fn, length, pitch_gyration, gravity)
    motion = _look_up(tuned, _motion_mean(length / float(breadth), spectrum, gamma))
    motion = motion * 4.0 * breadth / length * _motion_speed(fn, block_coefficient)
    tuned = peak * np.sqrt(deep / gravity)
    reflection = _look_up(tuned, _reflection_mean(spectrum, gamma))
    reflection = 0.5 * reflection * _reflection_speed(velocity, deep, block_coefficient, gravity)
    force = 2.0 * density * gravity * breadth * height**2 * (motion + reflection)
    return np.where((height == 0.0) & ~np.isnan(fn), 0.0, force * in_head_sector(wave_angle))


def stawave2_validity(
    speed: ArrayLike,
    *,
    length_between_perpendiculars: ArrayLike,
    breadth: ArrayLike,
    draught: ArrayLike,
    block_coefficient: ArrayLike,
    gravity: float = GRAVITY,
) -> list[RangeNote]:
    """Return what is outside the range of STAwave-2 (ITTC 7.5-04-01-01.2).

    75 < L_PP < 350 m, 4 < L_PP/B < 9, 2.2 < B/T < 9, 0.10 < Fr < 0.30, 0.39 < C_B < 0.90.

    Parameters
    ----------
    speed : Speed through water [m/s].
    length_between_perpendiculars, breadth, draught : L_PP, B and T [m].
    block_coefficient : C_B [-].
    gravity : Acceleration of gravity [m/s2].

    Returns
    -------
    list of RangeNote : Empty inside the range.
    """
    length, wide = np.asarray(length_between_perpendiculars), np.asarray(breadth)
    ranges: dict[str, tuple[ArrayLike, float, float]] = {
        "length between perpendiculars": (length, 75.0, 350.0),
        "length to breadth": (length / wide, 4.0, 9.0),
        "breadth to draught": (wide / np.asarray(draught), 2.2, 9.0),
        "block coefficient": (block_coefficient, 0.39, 0.90),
        "Froude number": (froude_number(speed, length=length, gravity=gravity), 0.10, 0.30),
    }
    return range_notes("stawave2", ranges)


def stawave1_validity(
    wave_height: ArrayLike, *, length_between_perpendiculars: float
) -> list[RangeNote]:
    """Return which wave heights exceed 2.25 sqrt(L_PP / 100) (not compared with the source).

    Parameters
    ----------
    wave_height : Significant wave height [m].
    length_between_perpendiculars : L_PP [m].

    Returns
    -------
    list of RangeNote : Empty inside the range.
    """
    highest = 2.25 * float(np.sqrt(length_between_perpendiculars / 100.0))
    return range_notes("stawave1", {WAVE_HEIGHT_RANGE: (wave_height, 0.0, highest)})
