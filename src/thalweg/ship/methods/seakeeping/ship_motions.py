"""Heave, pitch and vertical acceleration of a ship in waves by closed forms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY
from thalweg.ship.methods.array_conversion import as_float_array
from thalweg.ship.methods.seakeeping.wave_spectra import (
    jonswap,
    most_probable_maximum,
    quadrature,
    spectral_moment,
    with_flat_seas,
)
from thalweg.ship.methods.validity import RangeNote, range_notes

#: How wave pressure fades with depth in `jensen_motions`.
PRESSURE_DECAYS: Final = ("published", "strip")

#: Ships `jensen_motions` was tried on, our judgement: Froude number, and length over breadth.
_FROUDE: Final = (0.0, 0.35)
_SLENDER: Final = (4.0, 10.0)


@dataclass(frozen=True)
class MotionHull:
    """Particulars of a hull for the closed-form motions.

    Parameters
    ----------
    length : Waterline length [m].
    breadth : Breadth [m].
    draught : Mean draught [m].
    block_coefficient : float
        Block coefficient [-]; the box of the method is ``block_coefficient * breadth`` wide.

    Raises
    ------
    InputError : When a dimension is not positive or the block coefficient is above one.
    """

    length: float
    breadth: float
    draught: float
    block_coefficient: float

    def __post_init__(self) -> None:
        for name in ("length", "breadth", "draught", "block_coefficient"):
            value = getattr(self, name)
            if not value > 0.0 or (name == "block_coefficient" and value > 1.0):
                raise InputError(
                    f"A hull cannot have {name} {value:g}.",
                    "Dimensions are positive and the block coefficient is at most 1.",
                    "Correct the particulars.",
                    field=name,
                    value=value,
                )


def encounter_ratio(
    frequency: ArrayLike, *, speed: ArrayLike, wave_angle: ArrayLike, gravity: float = GRAVITY
) -> FloatArray:
    r"""Return encounter over wave frequency in deep water.

    .. math:: \omega_e / \omega = 1 + \omega V \cos\beta / g

    Parameters
    ----------
    frequency : Wave frequency [rad/s]; the last axis runs over frequency.
    speed : Speed through the water [m/s].
    wave_angle : Angle between bow and where the waves come from [rad], 0 head to pi following;
        either side.
    gravity : float [m/s2]

    Returns
    -------
    ndarray : Ratio [-]; negative where the ship overtakes the waves.

    References
    ----------
    Definition, deep water; MSC.1/Circ.1228, 1.6, has the same for the period.
    """
    ahead = as_float_array(speed) * np.cos(as_float_array(wave_angle))
    return 1.0 + as_float_array(frequency) * ahead[..., None] / gravity


def jensen_motions(
    frequency: ArrayLike,
    *,
    speed: ArrayLike,
    wave_angle: ArrayLike,
    hull: MotionHull,
    decay: str = "published",
    gravity: float = GRAVITY,
) -> tuple[FloatArray, FloatArray]:
    """Return the amplitudes of heave and pitch per wave amplitude.

    With k = w^2/g, a = encounter over wave frequency, B the breadth of the box, T the draught,
    k_e = |k cos(angle)|, s = k_e L / 2:

    A = 2 sin(k B a^2 / 2) exp(-k T a^2);  f^2 = (1 - k T)^2 + (A^2 / (k B a^3))^2
    heave = n f exp(-k_e T) sin(s) / s;  pitch = n f exp(-k_e T) k_e 3 (sin s - s cos s) / s^3
    n = 1 / sqrt((1 - 2 k T a^2)^2 + (A^2 / (k B a^2))^2)

    Parameters
    ----------
    frequency : Wave frequency [rad/s]; the last axis runs over frequency.
    speed : Speed through the water [m/s]; NaN gives NaN.
    wave_angle : Angle between bow and where the waves come from [rad], 0 head to pi following.
    decay : ``published``: exp(-k_e T) as in the paper. ``strip``: exp(-k T), the same in head and
        following seas; see the notes.
    gravity : float [m/s2]

    Returns
    -------
    tuple of ndarray
        Heave [m/m] and pitch [rad/m], both positive; they are a quarter period apart.

    Notes
    -----
    The poles of the printed form at zero encounter frequency and in beam seas are removable and
    are removed: with z = k B a^2 / 2 the two damping terms are k B a (sin z / z)^2 exp(-2 k T a^2)
    and a times that. In long waves heave tends to one and pitch to the wave slope k.

    The published decay uses the wave number along the ship. In beam seas that is zero, pressure
    no longer fades with depth, heave tends to 1/2 (not to 0) in ever shorter waves, and the
    acceleration in a sea depends on where the spectrum is truncated. Pressure under a wave fades
    with its own wave number whatever the heading, which is what ``strip`` uses (as strip theory
    does); this correction is not part of the published method.

    References
    ----------
    J. J. Jensen, A. E. Mansour, A. S. Olsen, "Estimation of ship motions using closed-form
    expressions", Ocean Engineering 31 (2004).
    """
    if decay not in PRESSURE_DECAYS:
        raise unknown_name_error("decay", decay, PRESSURE_DECAYS)
    w = as_float_array(frequency)
    k = w**2 / gravity
    a = encounter_ratio(w, speed=speed, wave_angle=wave_angle, gravity=gravity)
    across = np.abs(np.cos(as_float_array(wave_angle)))[..., None]
    k_e, box = k * across, hull.block_coefficient * hull.breadth
    half = 0.5 * k_e * hull.length
    sway = np.sinc(0.5 * k * box * a**2 / np.pi) * np.exp(-k * hull.draught * a**2)
    damping = k * box * a * sway**2
    fading = np.exp(-hull.draught * (k_e if decay == "published" else k))
    forcing = np.sqrt((1.0 - k * hull.draught) ** 2 + damping**2) * fading
    stiffness = 1.0 - 2.0 * k * hull.draught * a**2
    gain = forcing / np.sqrt(stiffness**2 + (damping * a) ** 2)
    heave = gain * np.abs(np.sinc(half / np.pi))
    return heave, gain * k_e * np.abs(_slope_factor(half))


def _slope_factor(s: FloatArray) -> FloatArray:
    """Return 3 (sin s - s cos s) / s^3, one at s = 0."""
    small = np.abs(s) < 0.02
    safe = np.where(small, 1.0, s)
    return np.where(small, 1.0 - s**2 / 10.0, 3.0 * (np.sin(safe) - safe * np.cos(safe)) / safe**3)


def vertical_motion(heave: ArrayLike, pitch: ArrayLike, *, forward: ArrayLike) -> FloatArray:
    """Return the vertical motion at a point from heave and pitch a quarter period apart.

    Parameters
    ----------
    heave, pitch : Amplitudes per wave amplitude [m/m] and [rad/m].
    forward : Distance of the point ahead of midship [m], negative abaft.

    Returns
    -------
    ndarray : Amplitude [m/m]: sqrt(heave^2 + (x pitch)^2). Roll is not modelled, so the point is
        taken on the centre line.
    """
    return np.hypot(
        as_float_array(heave), as_float_array(forward)[..., None] * as_float_array(pitch)
    )


@dataclass(frozen=True)
class SeaResponse:
    """Statistics of one response in a sea state.

    Parameters
    ----------
    m0, m2 : Variance, and second moment over encounter frequency.
    """

    m0: FloatArray
    m2: FloatArray

    @property
    def significant_amplitude(self) -> FloatArray:
        """Mean of the largest third of the amplitudes, 2 sqrt(m0)."""
        return 2.0 * np.sqrt(self.m0)

    def most_probable_maximum(self, duration: ArrayLike = 10_800.0) -> FloatArray:
        """Return the most probable largest amplitude in a duration [s], 3 h if not given."""
        return most_probable_maximum(self.m0, self.m2, duration=duration)


@dataclass(frozen=True)
class ShipResponse:
    """Responses of a ship in sea states.

    Parameters
    ----------
    heave : At midship [m].
    pitch : SeaResponse [rad]
    motion : Vertical motion at the requested point [m].
    acceleration : Vertical acceleration there [m/s2].
    acceleration_parts : ndarray
        Variance of the acceleration by frequency, last axis [m2/s4]; they add up to its m0.
    encounter_frequency : Encounter frequency of each part [rad/s], not negative.
    """

    heave: SeaResponse
    pitch: SeaResponse
    motion: SeaResponse
    acceleration: SeaResponse
    acceleration_parts: FloatArray
    encounter_frequency: FloatArray


def ship_response(
    *,
    height: ArrayLike,
    period: ArrayLike,
    wave_angle: ArrayLike,
    speed: ArrayLike,
    hull: MotionHull,
    forward: ArrayLike = 0.0,
    peak_factor: ArrayLike | None = None,
    decay: str = "strip",
    gravity: float = GRAVITY,
) -> ShipResponse:
    r"""Return heave, pitch, vertical motion and acceleration in long-crested JONSWAP seas.

    .. math:: m_n = \int_0^\infty |\omega_e|^n |H(\omega)|^2 S(\omega) \, d\omega

    Parameters
    ----------
    height, period : Significant height [m] and peak period [s].
    wave_angle : Angle between bow and where the waves come from [rad], 0 head to pi following.
    speed : Speed through the water [m/s].
    forward : Point on the centre line, ahead of midship [m].
    peak_factor : gamma of the spectrum; without it that of DNV-RP-C205.
    decay : As in `jensen_motions`. ``strip`` by default, since with ``published`` the accelerations
        in beam seas depend on where the spectrum is truncated.
    gravity : float [m/s2]

    Returns
    -------
    ShipResponse : Of the broadcast shape of the conditions. Zero height gives zero, whatever the
        period and direction; unknown data give NaN.

    Notes
    -----
    All conditions are worked at once with 48 frequencies each: a million conditions need about
    400 MB per intermediate array, so give long lists in parts.

    References
    ----------
    J. J. Jensen, A. E. Mansour, A. S. Olsen, Ocean Engineering 31 (2004) 61-85, for the
    response H; see `jensen_motions`.
    """
    hs, tp, angle, v, x = np.broadcast_arrays(
        *(as_float_array(values) for values in (height, period, wave_angle, speed, forward))
    )
    tp, angle = with_flat_seas(hs, period=tp, wave_angle=angle)
    w, weights = quadrature(tp)
    waves = jonswap(w, height=hs, period=tp, peak_factor=peak_factor)
    heave, pitch = jensen_motions(
        w, speed=v, wave_angle=angle, hull=hull, decay=decay, gravity=gravity
    )
    meeting = np.abs(w * encounter_ratio(w, speed=v, wave_angle=angle, gravity=gravity))
    point = vertical_motion(heave, pitch, forward=x)

    def statistics(amplitude: FloatArray) -> SeaResponse:
        density = amplitude**2 * waves
        return SeaResponse(
            spectral_moment(density, weights, frequency=meeting, order=0),
            spectral_moment(density, weights, frequency=meeting, order=2),
        )

    return ShipResponse(
        heave=statistics(heave),
        pitch=statistics(pitch),
        motion=statistics(point),
        acceleration=statistics(meeting**2 * point),
        acceleration_parts=(meeting**2 * point) ** 2 * waves * weights,
        encounter_frequency=meeting,
    )


def motions_validity(speed: ArrayLike, hull: MotionHull) -> list[RangeNote]:
    """Return where `jensen_motions` is used outside the ships it was tried on.

    Parameters
    ----------
    speed : array_like [m/s]

    Returns
    -------
    list of RangeNote
        Empty when all are inside. The ranges are our judgement of the ships in the paper.
    """
    froude = as_float_array(speed) / np.sqrt(GRAVITY * hull.length)
    return range_notes(
        "Jensen-Mansour-Olsen motions",
        {
            "Froude number": (froude, *_FROUDE),
            "length over breadth": (hull.length / hull.breadth, *_SLENDER),
        },
    )
