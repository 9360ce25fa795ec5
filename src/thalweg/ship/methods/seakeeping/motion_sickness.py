"""Motion sickness from vertical acceleration."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array

#: Share of people sick per dose, unadapted men and women together (ISO 2631-1, annex D).
MIXED_ADULT_SUSCEPTIBILITY: Final = 1.0 / 3.0


# corner frequencies [Hz] and resonant quality factors of the weighting Wf
_F1, _F2, _F4, _Q4, _F5, _Q5, _F6, _Q6 = 0.08, 0.63, 0.25, 0.86, 0.0625, 0.80, 0.10, 0.80


def wf_weighting(frequency_hz: ArrayLike) -> FloatArray:
    r"""Return the frequency weighting W_f of ISO 2631-1 for motion sickness.

    .. math::
        W_f = |H_h| |H_l| |H_t| |H_s|, \quad |H_h| = \sqrt{\frac{f^4}{f^4 + f_1^4}}, \quad
            |H_l| = \sqrt{\frac{f_2^4}{f^4 + f_2^4}} \\
        |H_t| = \frac{f_4^2 Q_4}{\sqrt{f^4 Q_4^2 + f^2 f_4^2 (1 - 2 Q_4^2) + f_4^4 Q_4^2}}
            \\
        |H_s| = \frac{Q_6}{Q_5} \sqrt{\frac{f^4 Q_5^2 + f^2 f_5^2 (1 - 2 Q_5^2) + f_5^4
            Q_5^2}{f^4 Q_6^2 + f^2 f_6^2 (1 - 2 Q_6^2) + f_6^4 Q_6^2}}

    Parameters
    ----------
    frequency_hz : array_like
        Frequency of the motion (of encounter) [Hz].

    Returns
    -------
    ndarray
        Factor [-], largest 1.006 near 0.16 Hz, 0 at zero frequency.

    References
    ----------
    ISO 2631-1:1997, Table 3 and annex A; reproduces its 18 tabulated one-third-octave factors.
    """
    f = np.abs(as_float_array(frequency_hz))
    f2, f4 = f**2, f**4
    high = f2 / np.sqrt(f4 + _F1**4)
    low = 1.0 / np.sqrt(1.0 + f4 / _F2**4)
    fall = (
        _F4**2 * _Q4 / np.sqrt(f4 * _Q4**2 + f2 * _F4**2 * (1 - 2 * _Q4**2) + (_F4**2 * _Q4) ** 2)
    )
    upper = f4 * _Q5**2 + f2 * _F5**2 * (1 - 2 * _Q5**2) + _F5**4 * _Q5**2
    lower = f4 * _Q6**2 + f2 * _F6**2 * (1 - 2 * _Q6**2) + _F6**4 * _Q6**2
    return high * low * fall * (_Q6 / _Q5) * np.sqrt(upper / lower)


def weighted_acceleration(parts: ArrayLike, encounter_frequency: ArrayLike) -> FloatArray:
    r"""Return the W_f-weighted root mean square of a vertical acceleration.

    .. math:: a_w = \sqrt{\sum_j W_f^2(\omega_{e,j} / 2\pi)\, \sigma_j^2}

    Parameters
    ----------
    parts : Variance by frequency on the last axis [m2/s4], as `ShipResponse.acceleration_parts`.
    encounter_frequency : Encounter frequency of each part [rad/s].

    Returns
    -------
    ndarray : a_w [m/s2].

    References
    ----------
    ISO 2631-1:1997, 6.1.
    """
    factor = wf_weighting(as_float_array(encounter_frequency) / (2.0 * np.pi))
    value: FloatArray = np.sqrt(np.sum(as_float_array(parts) * factor**2, axis=-1))
    return value


def motion_sickness_dose(weighted_rms: ArrayLike, *, duration: ArrayLike) -> FloatArray:
    """Return the motion sickness dose value MSDV_z = a_w sqrt(t) of a steady motion.

    Parameters
    ----------
    weighted_rms : a_w [m/s2].
    duration : Exposure [s].

    Returns
    -------
    ndarray [m/s^1.5]

    References
    ----------
    ISO 2631-1:1997, annex D.
    """
    value: FloatArray = as_float_array(weighted_rms) * np.sqrt(as_float_array(duration))
    return value


def motion_sickness_percent_iso(
    dose: ArrayLike, *, susceptibility: ArrayLike = MIXED_ADULT_SUSCEPTIBILITY
) -> FloatArray:
    """Return the percentage of people who vomit by ISO 2631-1: K_m MSDV_z.

    Parameters
    ----------
    dose : MSDV_z [m/s^1.5].
    susceptibility : K_m, 1/3 for a mixed adult population not used to the sea.

    Returns
    -------
    ndarray : Percent, at most 100. Fitted for exposures of 20 minutes to 6 hours and up to 70 %.

    References
    ----------
    ISO 2631-1:1997, annex D.
    """
    return np.minimum(as_float_array(susceptibility) * as_float_array(dose), 100.0)
