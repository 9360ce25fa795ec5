"""Roll of a ship in waves, as one degree of freedom."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY
from thalweg.ship.methods.array_conversion import as_float_array
from thalweg.ship.methods.seakeeping.ship_motions import MotionHull, encounter_ratio
from thalweg.ship.methods.seakeeping.wave_spectra import (
    jonswap,
    quadrature,
    spectral_moment,
    with_flat_seas,
)

#: r of the IS Code for a centre of gravity at the waterline.
EFFECTIVE_WAVE_SLOPE: Final = 0.73
ROLL_DAMPING: Final = 0.08  #: share of the critical damping where it is not given; our choice


def roll_amplitude(
    frequency: ArrayLike,
    *,
    speed: ArrayLike,
    wave_angle: ArrayLike,
    hull: MotionHull,
    natural_period: float,
    damping: float = ROLL_DAMPING,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Return the amplitude of roll per wave amplitude.

    .. math::

        \frac{\varphi}{\zeta} = \frac{r k |\sin\beta| \;
        \mathrm{sinc}(\tfrac12 k L \cos\beta) \, \mathrm{sinc}(\tfrac12 k B \sin\beta)}
        {\sqrt{(1 - \Lambda^2)^2 + (2 \nu \Lambda)^2}}, \quad \Lambda = \omega_e T_\varphi / 2 \pi

    Parameters
    ----------
    frequency : Wave frequency [rad/s]; the last axis runs over frequency.
    speed : Speed through the water [m/s].
    wave_angle : Angle between bow and where the waves come from [rad], 0 head to pi following.
    natural_period : Natural roll period [s].
    damping : Share of the critical damping, nu.
    gravity : float [m/s2]

    Returns
    -------
    ndarray [rad/m]

    Notes
    -----
    The moment is that of the wave slope, averaged over the length and breadth of a box (sinc) and
    times the effective wave slope r of the IS Code. Damping is linear and without the effect of
    speed, so that large angles are overestimated.

    References
    ----------
    2008 IS Code (MSC.267(85)), part A, 2.3.4: r = 0.73 + 0.6 OG/d, here with OG = 0. One degree
    of freedom with linear damping is the form of all text books on seakeeping.
    """
    w = as_float_array(frequency)
    angle = as_float_array(wave_angle)[..., None]
    k = w**2 / gravity
    ratio = w * encounter_ratio(w, speed=speed, wave_angle=wave_angle, gravity=gravity)
    tuning = np.abs(ratio) * natural_period / (2.0 * np.pi)
    along = np.sinc(0.5 * k * hull.length * np.cos(angle) / np.pi)
    across = np.sinc(0.5 * k * hull.breadth * np.sin(angle) / np.pi)
    slope = EFFECTIVE_WAVE_SLOPE * k * np.abs(np.sin(angle) * along * across)
    return np.asarray(slope / np.hypot(1.0 - tuning**2, 2.0 * damping * tuning))


def roll_rms(
    *,
    height: ArrayLike,
    period: ArrayLike,
    wave_angle: ArrayLike,
    speed: ArrayLike,
    hull: MotionHull,
    natural_period: float,
    damping: float = ROLL_DAMPING,
) -> FloatArray:
    """Return the root mean square of roll in long-crested JONSWAP seas.

    Parameters
    ----------
    height, period : Significant height [m] and peak period [s].
    wave_angle : Angle between bow and where the waves come from [rad], 0 head to pi following.
    speed : Speed through the water [m/s].
    natural_period : Natural roll period [s].
    damping : Share of the critical damping.

    Returns
    -------
    ndarray : [rad], in the broadcast shape; zero without waves, NaN where a value is unknown.
    """
    hs, tp, angle, v = np.broadcast_arrays(
        *(as_float_array(values) for values in (height, period, wave_angle, speed))
    )
    tp, angle = with_flat_seas(hs, period=tp, wave_angle=angle)
    w, weights = quadrature(tp)
    waves = jonswap(w, height=hs, period=tp)
    amplitude = roll_amplitude(
        w, speed=v, wave_angle=angle, hull=hull, natural_period=natural_period, damping=damping
    )
    meeting = np.abs(w * encounter_ratio(w, speed=v, wave_angle=angle))
    return np.sqrt(spectral_moment(amplitude**2 * waves, weights, frequency=meeting, order=0))
