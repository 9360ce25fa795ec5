"""The dangerous situations in waves of IMO MSC.1/Circ.1228."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import KNOT
from thalweg.ship.methods.array_conversion import as_float_array

#: Half width of the sector of following and quartering seas [rad]: 135 to 225 degrees.
SURF_RIDING_SECTOR: Final = float(np.radians(45.0))
#: Encounter over wave period where successive high waves are met.
HIGH_WAVE_RATIOS: Final = (1.8, 3.0)
HIGH_WAVE_SHARE: Final = 0.04  #: of the ship's length, from which waves are high
_WAVELENGTH: Final = 1.56  # g / (2 pi), as the circular rounds it [m/s2]


@dataclass(frozen=True)
class DangerousSituationMargins:
    """Margin to each dangerous situation; negative inside it.

    Parameters
    ----------
    surf_riding : Critical speed minus speed [m/s]; infinite outside following and quartering seas.
    high_waves : Largest relative distance from the three limits that must all be passed [-].
    synchronous_roll, parametric_roll : Relative distance of the encounter period from resonance,
        less the tolerance [-]; NaN when no roll period was given.
    """

    surf_riding: FloatArray
    high_waves: FloatArray
    synchronous_roll: FloatArray
    parametric_roll: FloatArray


@dataclass(frozen=True)
class DangerousSituations:
    """Warnings of MSC.1/Circ.1228.

    Parameters
    ----------
    encounter_period : [s]; infinite where the ship has the speed of the waves.
    surf_riding : Surf-riding and broaching-to may occur.
    marginal_surging : Large surging motion, 1.4 to 1.8 times the root of length.
    successive_high_waves : Zone of successive high waves.
    synchronous_roll, parametric_roll : ndarray of bool
        Encounter period near the roll period; near it or half of it. False without roll period.
    margins : Distances from the first and the last three.
    known : Whether all data were known. Where they were not every flag is False, which is not an
        all-clear: use `safe`.
    """

    encounter_period: FloatArray
    surf_riding: BoolArray
    marginal_surging: BoolArray
    successive_high_waves: BoolArray
    synchronous_roll: BoolArray
    parametric_roll: BoolArray
    margins: DangerousSituationMargins
    known: BoolArray

    @property
    def dangerous(self) -> BoolArray:
        """Whether any of the dangerous situations is met (marginal surging is not one)."""
        return (
            self.surf_riding
            | self.successive_high_waves
            | self.synchronous_roll
            | self.parametric_roll
        )

    @property
    def safe(self) -> BoolArray:
        """Whether all data were known and nothing dangerous is met."""
        return self.known & ~self.dangerous


def roll_period(
    breadth: ArrayLike,
    draught: ArrayLike,
    *,
    length_waterline: ArrayLike,
    metacentric_height: ArrayLike,
) -> FloatArray:
    """Return the natural roll period 2 C B / sqrt(GM), C = 0.373 + 0.023 B/T - 0.043 L/100.

    Parameters
    ----------
    breadth, draught, length_waterline : array_like [m]
    metacentric_height : GM corrected for free surfaces [m].

    Returns
    -------
    ndarray : [s]; NaN where GM is not positive.

    References
    ----------
    2008 IS Code (MSC.267(85)), part A, 2.3.4.
    """
    b, gm = as_float_array(breadth), as_float_array(metacentric_height)
    coefficient = (
        0.373
        + 0.023 * b / as_float_array(draught)
        - 0.043 * as_float_array(length_waterline) / 100.0
    )
    value: FloatArray = 2.0 * coefficient * b / np.sqrt(np.where(gm > 0.0, gm, np.nan))
    return value


def encounter_period(
    wave_period: ArrayLike, *, speed: ArrayLike, wave_angle: ArrayLike
) -> FloatArray:
    """Return the encounter period 3 T^2 / (3 T + V cos(angle)), V in knots in the formula.

    Parameters
    ----------
    wave_period : array_like [s]
    speed : Through the water [m/s].
    wave_angle : Angle between bow and where the waves come from [rad], 0 head to pi following.

    Returns
    -------
    ndarray : [s], without sign; infinite where the ship has the speed of the waves.

    References
    ----------
    MSC.1/Circ.1228, 1.6. The 3 approximates g / (2 pi) in knots per second, 3.03.
    """
    t = as_float_array(wave_period)
    t = np.where(t > 0.0, t, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (
            3.0
            * t**2
            / np.abs(3.0 * t + as_float_array(speed) / KNOT * np.cos(as_float_array(wave_angle)))
        )


def surf_riding_speed(
    wave_angle: ArrayLike, *, length: ArrayLike, factor: float = 1.8
) -> FloatArray:
    """Return the speed above which a ship may surf-ride: 1.8 sqrt(L) / cos(180 - angle) knots.

    Parameters
    ----------
    wave_angle : Angle between bow and where the waves come from [rad], 0 head to pi following.
    length : Ship length [m].
    factor : 1.8 for surf-riding, 1.4 for the marginal zone of large surging (1.4 was not compared
        with the source).

    Returns
    -------
    ndarray : [m/s]; infinite outside 135 to 225 degrees.

    References
    ----------
    MSC.1/Circ.1228, 4.2.1 and figure 2. The sector and the limits of 4.2.2 were read in the
    published text; 1.8 agrees in two secondary sources; 1.4 was not seen in print.
    """
    following = -np.cos(as_float_array(wave_angle))
    limit = np.cos(SURF_RIDING_SECTOR)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = KNOT * factor * np.sqrt(as_float_array(length)) / following
    return np.where(following > limit, speed, np.where(np.isnan(following), np.nan, np.inf))


def _roll_resonance_margins(
    encounter: FloatArray, period: FloatArray, tolerance: float
) -> tuple[FloatArray, FloatArray]:
    """Return relative distances from synchronous and parametric roll, less the tolerance."""
    with np.errstate(invalid="ignore", divide="ignore"):
        once = np.abs(encounter / period - 1.0)
        twice = np.abs(2.0 * encounter / period - 1.0)
    return once - tolerance, np.minimum(once, twice) - tolerance


def dangerous_situations(
    *,
    speed: ArrayLike,
    wave_angle: ArrayLike,
    wave_height: ArrayLike,
    wave_period: ArrayLike,
    length: ArrayLike,
    roll_period: ArrayLike | None = None,
    roll_tolerance: float = 0.1,
    harmless_wave_height: float = 0.0,
) -> DangerousSituations:
    r"""Return the warnings of MSC.1/Circ.1228 in given waves.

    .. math::
        V > 1.8 \sqrt{L} / \cos(180^\circ - \alpha); \quad \lambda > 0.8 L\ \text{and}\ H_s
            > 0.04 L; \quad T_E \approx T_R; \quad T_E \approx T_R / 2

    Parameters
    ----------
    speed : Through the water [m/s].
    wave_angle : Angle between bow and where the waves come from [rad], 0 head to pi following;
        either side.
    wave_height : Significant height [m].
    wave_period : Mean wave period [s].
    length : Ship length [m].
    roll_period : Natural roll period [s]; without it the roll checks are not made.
    roll_tolerance : "Nearly equal" of the circular: relative difference of periods, 0.1 to 0.2.
    harmless_wave_height : Waves up to this height raise no flag [m]. The circular sets no height
        for surf-riding and roll; without one a ripple of the right period counts.

    Returns
    -------
    StabilityChecks
        Flags and margins. A flat sea raises no flag, whatever its period and direction.

    Notes
    -----
    Surf-riding: 135 to 225 degrees and above `surf_riding_speed`. Successive high waves:
    wave length above 0.8 L, height above 0.04 L and encounter period 1.8 to 3.0 wave periods.

    References
    ----------
    IMO MSC.1/Circ.1228, sections 1.5, 1.6 and 4.2.
    """
    v, angle, hs, tw, size = np.broadcast_arrays(
        *(as_float_array(x) for x in (speed, wave_angle, wave_height, wave_period, length))
    )
    rolls = np.full(v.shape, np.nan) if roll_period is None else as_float_array(roll_period)
    hs = np.where(hs >= 0.0, hs, np.nan)
    flat = hs <= harmless_wave_height
    met = encounter_period(tw, speed=v, wave_angle=angle)
    surf = surf_riding_speed(angle, length=size) - v
    surge = surf_riding_speed(angle, length=size, factor=1.4) - v
    ratio = met / tw
    low, high = HIGH_WAVE_RATIOS
    high_waves = np.maximum.reduce(
        [
            1.0 - _WAVELENGTH * tw**2 / (0.8 * size),
            1.0 - hs / (HIGH_WAVE_SHARE * size),
            np.maximum(low - ratio, ratio - high),
        ]
    )
    once, any_roll = _roll_resonance_margins(met, rolls, roll_tolerance)
    seen = ~np.isnan(met) & ((roll_period is None) | ~np.isnan(rolls))
    known = ~np.isnan(v + hs + size) & (flat | seen)
    calm = [np.where(flat, np.inf, x) for x in (surf, high_waves, once, any_roll)]
    return DangerousSituations(
        encounter_period=met,
        surf_riding=known & ~flat & (surf < 0.0),
        marginal_surging=known & ~flat & (surge < 0.0) & (surf >= 0.0),
        successive_high_waves=known & ~flat & (high_waves < 0.0),
        synchronous_roll=known & ~flat & (once < 0.0),
        parametric_roll=known & ~flat & (any_roll < 0.0),
        margins=DangerousSituationMargins(*(np.where(known, x, np.nan) for x in calm)),
        known=known,
    )
