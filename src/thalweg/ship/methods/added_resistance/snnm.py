"""Added resistance in waves from any direction: the SNNM formula.

Sources: S. Liu and A. Papanikolaou, "Regression analysis of experimental data for added resistance
in waves of arbitrary heading and development of a semi-empirical formula", Ocean Engineering 206
(2020) 107357; adopted as "SNNM" by ITTC Recommended Procedure 7.5-04-01-01.1 (2021), whose form of
the following-sea coefficients is used here.

How sure the coefficients are: they agree between four independent public programs of the ITTC and
of the 2020 form; the printed procedure itself was not seen, so they are *unverified* in that sense.

The force jumps where waves pass the angle of entrance E1 off the bow (27 degrees for the tanker
KVLCC2, by a seventh), since the factor for the reflection at the bow changes there from a power of
cos(angle) to one. That is the published formula's own; nothing is smoothed here.

Angles are zero for waves from ahead and pi for waves from astern, as in the procedure.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, SEA_WATER_DENSITY
from thalweg.ship.methods.added_resistance.snnm_hull import SnnmHull
from thalweg.ship.methods.resistance.friction_lines import froude_number, ship_speed
from thalweg.ship.methods.validity import RangeNote, range_notes

#: Wave length over ship length beyond which nothing is reflected.
LONGEST_REFLECTED_WAVE: Final = 2.5


def frequency_scale(
    angle: FloatArray,
    froude: FloatArray,
    hull: tuple[FloatArray, ...],
    gravity: float,
) -> FloatArray:
    r"""Dimensionless frequency for w = 1 rad/s.

    .. math::
        \bar{\omega} / \omega = 2.142 \sqrt[3]{k_{yy}} \sqrt{\frac{L}{2 \pi g}}
            \left(\frac{C_B}{0.65}\right)^{0.17} \left[1 - \frac{0.111}{C_B}
            \left(\ln\frac{B}{T} - \ln 2.75\right)\right] \\
        \left[(1.157 Fr - 1.377 Fr^2) |\cos\alpha| + 0.618 \frac{13 + \cos
            2\alpha}{14}\right]

    References
    ----------
    S. Liu and A. Papanikolaou, Ocean Engineering 206 (2020) 107357, as adopted by ITTC
    Recommended Procedure 7.5-04-01-01.1 (2021); unverified: see the text of this module.
    """
    length, breadth, draught, _, block, gyration, _, _ = hull
    heading = (1.157 * froude - 1.377 * froude**2) * np.abs(np.cos(angle))
    heading = heading + 0.618 * (13.0 + np.cos(2.0 * angle)) / 14.0
    fullness = (block / 0.65) ** 0.17
    fullness = fullness * (1.0 - 0.111 / block * (np.log(breadth / draught) - np.log(2.75)))
    scale = 2.142 * np.cbrt(gyration) * np.sqrt(length / (2.0 * np.pi * gravity))
    return np.asarray(scale * fullness * heading)


def motion_shape(frequency: FloatArray, hull: tuple[FloatArray, ...]) -> FloatArray:
    r"""w^b1 exp{b1/d1 (1 - w^d1)}; NaN for a trim at which d1 changes its sign.

    .. math::
        \bar{\omega}^{b_1} \exp\left[\frac{b_1}{d_1} (1 - \bar{\omega}^{d_1})\right], \quad
            b_1 = 11\ (\bar{\omega} < 1),\ -8.5, \\
        d_1 = 566 (L C_B / B)^{-2.66}\ (\bar{\omega} < 1),\ -566 (L / B)^{-2.66} (4 - 125
            \tan^{-1}(|T_A - T_F| / L))

    References
    ----------
    S. Liu and A. Papanikolaou, Ocean Engineering 206 (2020) 107357, as adopted by ITTC
    Recommended Procedure 7.5-04-01-01.1 (2021); unverified: see the text of this module.
    """
    length, breadth, _, trim, block, _, _, _ = hull
    steep = 4.0 - 125.0 * trim
    steep = np.where(steep > 0.0, steep, np.nan)
    slow = frequency < 1.0
    below = 566.0 * (length * block / breadth) ** -2.66
    d1 = np.where(slow, below, -566.0 * (length / breadth) ** -2.66 * steep)
    b1 = np.where(slow, 11.0, -8.5)
    log = np.log(frequency)
    return np.asarray(np.exp(b1 * log + b1 / d1 * (1.0 - np.exp(d1 * log))))


def speed_factor(froude: FloatArray) -> FloatArray:
    """a2 of waves from ahead over the Froude number."""
    fast = np.maximum(froude, 0.0)
    quick = fast * np.sqrt(fast) * np.exp(-3.5 * fast)
    return np.where(froude < 0.12, 0.0072 + 0.1676 * froude, quick)


def ahead_factors(
    angle: FloatArray, froude: FloatArray, hull: tuple[FloatArray, ...]
) -> tuple[FloatArray, FloatArray]:
    r"""a1 and a2 for waves from ahead to abeam.

    .. math::
        a_1 = \left(\frac{0.87}{C_B}\right)^{(1 + Fr) \cos\alpha} \frac{1 + 2 \cos\alpha}{3
            \ln(B/T)}, \quad a_2 = 0.0072 + 0.1676 Fr\ (Fr < 0.12),\ Fr^{1.5} e^{-3.5 Fr}

    References
    ----------
    S. Liu and A. Papanikolaou, Ocean Engineering 206 (2020) 107357, as adopted by ITTC
    Recommended Procedure 7.5-04-01-01.1 (2021); unverified: see the text of this module.
    """
    _, breadth, draught, _, block, _, _, _ = hull
    ahead = np.maximum(np.cos(angle), 0.0)
    first = (0.87 / block) ** ((1.0 + froude) * ahead) * (1.0 + 2.0 * ahead) / 3.0
    return np.asarray(first / np.log(breadth / draught)), speed_factor(froude)


def _heading_factors(
    angle: FloatArray,
    froude: FloatArray,
    group: FloatArray,
    hull: tuple[FloatArray, ...],
) -> FloatArray:
    """a1 a2, interpolated over the angle from beam to following waves.

    `group` is V over the group speed of the waves.
    """
    _, breadth, draught, _, block, _, _, _ = hull
    full, slim = 0.87 / block, 1.0 / np.log(breadth / draught)
    first, second = ahead_factors(angle, froude, hull)
    overtakes = group > 1.0
    relative = froude * (1.0 - 1.0 / np.where(overtakes, group, 1.0))
    power = np.where(overtakes & (relative >= 0.12), 1.0 + relative, 1.0)
    behind_first = np.exp(power * np.log(full)) * slim
    behind_second = np.where(overtakes, speed_factor(relative), 0.0072 * (2.0 * group - 1.0))
    part = np.clip(2.0 * angle / np.pi - 1.0, 0.0, 1.0)
    mixed = (first + part * (behind_first - first)) * (second + part * (behind_second - second))
    return np.asarray(mixed)


def reflection_terms(
    speed: FloatArray,
    angle: FloatArray,
    froude: FloatArray,
    hull: tuple[FloatArray, ...],
    gravity: float,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    r"""Constant and linear (in w) terms of the bow, the same of the stern, and T* of the stern.

    .. math::
        R_{AWR} \propto \left(\frac{0.87}{C_B}\right)^{(1 + 4 \sqrt{Fr}) f(\alpha)}
            \left[\sin^2(E \pm \alpha) + \frac{2 \omega V}{g} (\cos\alpha - \cos E \cos(E
            \pm \alpha))\right] \\
        T^* = T_{max} \frac{4 + \sqrt{|\cos\alpha|}}{5}\ (C_B \le 0.75),\ T_{max} \frac{2 +
            \sqrt{|\cos\alpha|}}{3}

    References
    ----------
    S. Liu and A. Papanikolaou, Ocean Engineering 206 (2020) 107357, as adopted by ITTC
    Recommended Procedure 7.5-04-01-01.1 (2021); unverified: see the text of this module.
    """
    draught, block, bow, stern = hull[2], hull[4], hull[6], hull[7]
    ahead, sine_of_angle = np.cos(angle), np.sin(angle)

    def pair(end: FloatArray, side: float, inside: Any) -> tuple[FloatArray, FloatArray]:
        """Terms of one side of an end; sine and cosine of its angle plus or less that of waves."""
        sine = np.sin(end) * ahead + side * np.cos(end) * sine_of_angle
        cosine = np.cos(end) * ahead - side * np.sin(end) * sine_of_angle
        square = np.where(inside, sine * sine, 0.0)
        return square, np.where(inside, ahead - np.cos(end) * cosine, 0.0)

    first = pair(bow, 1.0, angle <= np.pi - bow)
    second = pair(bow, -1.0, angle <= bow)
    third = pair(stern, -1.0, angle >= stern)
    fourth = pair(stern, 1.0, angle >= np.pi - stern)
    front = (0.87 / block) ** ((1.0 + 4.0 * np.sqrt(froude)) * np.where(angle <= bow, ahead, 0.0))
    root = np.sqrt(np.abs(ahead))
    deep = draught * np.where(block <= 0.75, (4.0 + root) / 5.0, (2.0 + root) / 3.0)
    doppler = 2.0 * speed / gravity
    return (
        (first[0] + second[0]) * front,
        (first[1] + second[1]) * front * doppler,
        third[0] + fourth[0],
        (third[1] + fourth[1]) * doppler,
        deep,
    )


def fold_angle(wave_angle: ArrayLike) -> FloatArray:
    """Return angles folded into 0 to pi [rad]."""
    return np.asarray(np.arccos(np.clip(np.cos(wave_angle), -1.0, 1.0)))


def snnm_transfer(
    frequency: ArrayLike,
    speed: ArrayLike,
    wave_angle: ArrayLike,
    hull: SnnmHull,
    *,
    density: float = SEA_WATER_DENSITY,
    gravity: float = GRAVITY,
) -> tuple[FloatArray, FloatArray]:
    r"""Added resistance in regular waves for an amplitude of one metre.

    .. math::
        R_{AWM} / \zeta_A^2 = 3859.2\, \rho g \frac{B^2}{L} C_B^{1.34} k_{yy}^2 (1 + 28.7
            \tau) a_1 a_2\, \bar{\omega}^{b_1} e^{\frac{b_1}{d_1} (1 - \bar{\omega}^{d_1})}
            \\
        R_{AWR} / \zeta_A^2 = \frac{2.25}{4} \rho g B \sum_{bow} (1 - e^{-2 k' T}) r_{bow} -
            \frac{2.25}{4} \rho g B \sum_{stern} (1 - e^{-2 k' T^*}) r_{stern} \\
        k' = \omega^2 / g - 2 \pi / (2.5 L)\ (\ge 0), \quad \tau = \tan^{-1}(|T_A - T_F| /
            L)

    Parameters
    ----------
    frequency : array_like
        Wave frequency [rad/s], above zero.
    speed : array_like [m/s]
    wave_angle : array_like
        [rad], 0 from ahead.
    hull : SnnmHull
        Particulars.
    density, gravity : float
        [kg/m3], [m/s2].

    Returns
    -------
    motion, reflection : ndarray
        R_AWM and R_AWR over the square of the amplitude [N/m2]. Both can be negative in waves
        from astern. The reflection at the bow jumps at the angle E1, as published.

    References
    ----------
    S. Liu and A. Papanikolaou, Ocean Engineering 206 (2020) 107357, as adopted by ITTC
    Recommended Procedure 7.5-04-01-01.1 (2021); unverified: see the text of this module.
    """
    particulars = hull.arrays()
    length, breadth, draught, trim, block, gyration = particulars[:6]
    omega, velocity = np.asarray(frequency, dtype=float), ship_speed(speed)
    angle = fold_angle(wave_angle)
    fn = froude_number(velocity, length=length, gravity=gravity)
    scale = frequency_scale(angle, fn, particulars, gravity)
    group = 2.0 * velocity * omega / gravity
    motion = 3859.2 * breadth**2 / length * block**1.34 * gyration**2 * (1.0 + 28.7 * trim)
    motion = motion * _heading_factors(angle, fn, group, particulars)
    motion = motion * motion_shape(omega * scale, particulars)
    excess = np.maximum(
        2.0 * (omega**2 / gravity - 2.0 * np.pi / (LONGEST_REFLECTED_WAVE * length)), 0.0
    )
    b0, b1, s0, s1, deep = reflection_terms(velocity, angle, fn, particulars, gravity)
    bow = -np.expm1(-draught * excess) * (b0 + b1 * omega)
    stern = -np.expm1(-deep * excess) * (s0 + s1 * omega)
    weight = density * gravity
    return weight * motion, 0.5625 * weight * breadth * (bow - stern)


def snnm_validity(speed: ArrayLike, hull: SnnmHull) -> list[RangeNote]:
    """Return what is outside the range of the formula (not compared with the source).

    L_PP > 75 m, 4 < L_PP/B < 9, 2.2 < B/T < 9, 0.05 < Fr < 0.30, 0.50 < C_B < 0.90, and a trim of
    at most 0.03 L_PP, beyond which the formula has no value.

    Parameters
    ----------
    speed : Speed through water [m/s].
    hull : Particulars of the hull [SI].

    Returns
    -------
    list of RangeNote : Empty inside the range.
    """
    length, breadth, draught, trim, block, _, _, _ = hull.arrays()
    ranges: dict[str, tuple[ArrayLike, float, float]] = {
        "length between perpendiculars": (length, 75.0, np.inf),
        "length to breadth": (length / breadth, 4.0, 9.0),
        "breadth to draught": (breadth / draught, 2.2, 9.0),
        "block coefficient": (block, 0.50, 0.90),
        "trim to length": (np.tan(trim), 0.0, 0.03),
        "Froude number": (froude_number(speed, length=length), 0.05, 0.30),
    }
    return range_notes("snnm", ranges)
