"""Time histories of irregular waves by deterministic and by random amplitudes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array

SCHEMES = ("deterministic", "random")


@dataclass(frozen=True)
class WaveComponents:
    """Sinusoids that add up to an irregular wave.

    Parameters
    ----------
    frequency : ndarray
        [rad/s], evenly spaced.
    amplitude : ndarray of complex
        The elevation is the real part of the sum of amplitude exp(i w t) [m].
    """

    frequency: FloatArray
    amplitude: NDArray[np.complex128]

    @property
    def repeat(self) -> float:
        """Time after which the history repeats itself, 2 pi over the spacing [s]."""
        return float(2.0 * np.pi / (self.frequency[1] - self.frequency[0]))


@dataclass(frozen=True)
class WaveHistory:
    """Elevation of a point of the surface with its derivatives.

    Parameters
    ----------
    time : ndarray
        [s].
    elevation, velocity, acceleration : ndarray
        [m], [m/s], [m/s2].
    """

    time: FloatArray
    elevation: FloatArray
    velocity: FloatArray
    acceleration: FloatArray


def wave_components(
    frequency: ArrayLike,
    spectrum: ArrayLike,
    *,
    generator: np.random.Generator,
    scheme: str = "deterministic",
) -> WaveComponents:
    r"""Return sinusoids with the energy of a spectrum.

    .. math::
        \eta(t) = \sum_j \sqrt{2 S(\omega_j) \Delta\omega} \cos(\omega_j t + \phi_j), \quad
            \phi_j\ \text{uniform in}\ [0, 2\pi)

    Parameters
    ----------
    frequency : array_like
        Multiples of one spacing, rising [rad/s], shape (M,).
    spectrum : array_like
        S at the frequencies [m2 s/rad], shape (M,).
    generator : numpy.random.Generator
        Source of the phases; seed it for a history that can be repeated.
    scheme : str
        ``deterministic``: amplitudes sqrt(2 S dw) with random phases, every realisation has the
        variance of the spectrum. ``random``: two normal amplitudes of variance S dw for each
        frequency, as in a real sea, where the variance itself varies.

    Returns
    -------
    WaveComponents
        The sinusoids.

    Raises
    ------
    InputError
        For an unknown scheme, frequencies that are not rising multiples of one spacing, or a
        spectrum that is negative or unknown.

    Notes
    -----
    Prestegårdshus (2020) calls the phase a random integer (it is a real number, even over the
    circle) and draws the normal amplitudes at each time (they belong to the frequency and stay).

    References
    ----------
    A. Merigaud, J. V. Ringwood, "Free-surface time-series generation for wave energy
    applications", IEEE J. Oceanic Eng. 43 (2018).
    """
    if scheme not in SCHEMES:
        raise unknown_name_error("scheme", scheme, SCHEMES)
    w, s = as_float_array(frequency), as_float_array(spectrum)
    if not _multiples(w) or w.shape != s.shape:
        raise InputError(
            "The frequencies of a wave history must be evenly spaced multiples of their spacing, "
            "rising, with one density each.",
            f"Frequencies have shape {w.shape}, densities {s.shape}.",
            "Use, for example, 0.01, 0.02, ... 3.0 rad/s.",
        )
    step = w[1] - w[0]
    if not np.all(s >= 0.0):
        raise InputError(
            "The spectrum of a wave history is negative or unknown somewhere.",
            "Densities must be zero or more at every frequency.",
            "Check height and period of the sea state.",
        )
    root = np.sqrt(s * step)
    if scheme == "deterministic":
        phase = generator.uniform(0.0, 2.0 * np.pi, w.size)
        return WaveComponents(w, np.sqrt(2.0) * root * np.exp(1j * phase))
    draws = generator.standard_normal((2, w.size))
    return WaveComponents(w, root * (draws[0] - 1j * draws[1]))


def _multiples(frequency: FloatArray) -> bool:
    """Whether frequencies are rising multiples of one spacing, so that the history repeats."""
    if frequency.ndim != 1 or frequency.size < 2:
        return False
    step = np.diff(frequency)
    if not (step[0] > 0.0 and np.allclose(step, step[0], rtol=1e-6) and frequency[0] >= 0.0):
        return False
    return bool(abs(frequency[0] / step[0] - np.round(frequency[0] / step[0])) < 1e-3)


def wave_history(components: WaveComponents, time: ArrayLike) -> WaveHistory:
    r"""Return elevation, velocity and acceleration of the surface at times.

    .. math::
        \eta = \Re \sum_j a_j e^{i \omega_j t}, \quad \dot\eta = \Re \sum_j i \omega_j a_j
            e^{i \omega_j t}, \quad \ddot\eta = -\Re \sum_j \omega_j^2 a_j e^{i \omega_j t}

    Parameters
    ----------
    components : WaveComponents
        Sinusoids.
    time : array_like
        [s], shape (N,).

    Returns
    -------
    WaveHistory
        Exact derivatives of the sum.

    References
    ----------
    Prestegårdshus (2020), eqs. 3.17 to 3.20.
    """
    t, w = np.atleast_1d(as_float_array(time)), components.frequency
    turning = np.exp(1j * np.multiply.outer(t, w))
    a = components.amplitude
    return WaveHistory(
        time=t,
        elevation=(turning @ a).real,
        velocity=(turning @ (1j * w * a)).real,
        acceleration=(turning @ (-(w**2) * a)).real,
    )


def expected_height(components: WaveComponents) -> float:
    """Return 4 standard deviations of the history over one full repeat [m].

    Parameters
    ----------
    components : WaveComponents
        Sinusoids.

    Returns
    -------
    float
        [m]: 4 sqrt(sum |amplitude|^2 / 2), exact by Parseval.
    """
    return float(4.0 * np.sqrt(np.sum(np.abs(components.amplitude) ** 2) / 2.0))
