r"""Vertical profiles of currents: tides (Prandle, 1982) and density currents (Heaps, 1972).

Both assume an eddy viscosity that is constant over the depth and linear bottom friction. Errors in
printed versions are corrected:

* Prandle, D. (1982). The vertical structure of tidal currents. *Geophysical & Astrophysical Fluid
  Dynamics* 22, 29-49. The depth-mean phasors of a rectilinear current with amplitude U are U/2
  each, not U, and the profiles are complex: their angles rotate the ellipse.
* Heaps, N.S. (1972). Estimation of density currents in the Liverpool Bay area of the Irish Sea.
  *Geophysical Journal of the Royal Astronomical Society* 30, 415-432. The scale is
  ``a = pi H / D_E`` with Ekman's depth ``D_E = pi sqrt(2 N / f)``, not ``pi H / D``.

Schless (2023) combines both as a model of the current along the Dutch coast.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, ModelRangeError
from thalweg.core.types import ComplexArray, FloatArray

GRAVITY: Final = 9.81  #: [m/s2], as in Heaps (1972)
MIN_ROTATION: Final = 1e-6  #: least difference of f from the tidal frequency, relative to it
MAX_HEAPS_DEPTH_RATIO: Final = 300.0  #: largest ``a`` before the functions of Heaps overflow


@dataclass(frozen=True)
class WaterColumn:
    """The water column of both profiles (defaults: Schless 2023, Tables 2.1 and 2.2, neap tide).

    Attributes
    ----------
    depth : Water depth D [m].
    viscosity : Vertical eddy viscosity E [m2/s].
    coriolis : f [rad/s], positive in the north.
    frequency : Angular frequency of the tide [rad/s].
    speed : Amplitude of the depth-mean tidal current [m/s] by which its friction is linearised.
    friction : Quadratic friction coefficient k of Prandle, and linear one of Heaps [m/s].
    """

    depth: float = 25.0
    viscosity: float = 0.0028
    coriolis: float = 1.15e-4
    frequency: float = 1.4e-4
    speed: float = 0.43
    friction: float = 0.0025

    def __post_init__(self) -> None:
        for name in ("depth", "viscosity", "frequency", "speed", "friction"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0.0):
                raise InputError(
                    f"The water column's {name} is {value!r}.",
                    "It must be a positive number in SI units.",
                    "Correct the value.",
                    field=name,
                )
        if not np.isfinite(self.coriolis):
            raise InputError(
                f"The Coriolis parameter is {self.coriolis!r}.",
                "It is a number in rad/s.",
                "For latitude x it is 1.4584e-4 sin x.",
                field="coriolis",
            )

    @property
    def slip(self) -> float:
        r"""Gradient over value of the tide at the bed, :math:`8 k U / (3 \pi E)` [1/m]."""
        return 8.0 * self.friction * self.speed / (3.0 * np.pi * self.viscosity)

    @property
    def rotations(self) -> tuple[complex, complex]:
        r"""The wave numbers :math:`\alpha_\pm` [1/m] of the anticlockwise and clockwise parts.

        :math:`\alpha_\pm = \sqrt{i (f \pm \omega) / E}`, with positive real parts.
        """
        least = MIN_ROTATION * self.frequency
        rates = [self.coriolis + s * self.frequency for s in (1.0, -1.0)]
        safe = [r if abs(r) > least else least for r in rates]
        plus, minus = (np.sqrt(1j * r / self.viscosity) for r in safe)
        return complex(plus), complex(minus)


def tidal_profile(height: ArrayLike, column: WaterColumn) -> tuple[ComplexArray, ComplexArray]:
    r"""Return the profiles of the anticlockwise and clockwise tide, relative to their depth means.

    With height z above the bed, depth D and slip s, the profile of each part is [1]_

    .. math::

        P_\pm(z) \propto 1 + \frac{\alpha_\pm}{s} \tanh \alpha_\pm D
            - \frac{\cosh \alpha_\pm (D - z)}{\cosh \alpha_\pm D},
        \qquad \alpha_\pm = \sqrt{i (f \pm \omega) / E},
        \qquad s = \frac{8 k U}{3 \pi E}

    scaled to a depth mean of 1.

    Parameters
    ----------
    height : Height above the bed [m], 0 to depth.

    Returns
    -------
    plus, minus : ``u + i v = W+ plus exp(i w t) + W- minus exp(-i w t)`` with the phasors W of the
        depth-mean current (Schless, 2023, eq. 2.26); of the shape of ``height``.

    Raises
    ------
    InputError : If a height is outside the water column.

    References
    ----------
    .. [1] Prandle, D. (1982). The vertical structure of tidal currents. *Geophysical &
       Astrophysical Fluid Dynamics* 22, 29-49.
    """
    z = _checked_height(height, column.depth)
    plus, minus = (
        _unscaled_profile(a, z, column) / _unscaled_mean(a, column) for a in column.rotations
    )
    return plus, minus


def tidal_mean(draught: float, column: WaterColumn) -> tuple[complex, complex]:
    r"""Return the mean of `tidal_profile` from the surface down to a draught, in closed form.

    .. math:: \frac{1}{d} \int_{D-d}^{D} \frac{R_\pm(z)}{\langle R_\pm \rangle} dz

    Parameters
    ----------
    draught : Draught [m], 0 to depth; 0 for the surface.

    Returns
    -------
    plus, minus : Means relative to the depth means.

    References
    ----------
    D. Prandle, "The vertical structure of tidal currents", Geophysical and Astrophysical Fluid
    Dynamics 22 (1982) 29-49; Schless (2023), eqs. 3.75 and 3.76.
    """
    d = float(_checked_height(draught, column.depth))
    if d == 0.0:
        plus, minus = tidal_profile(column.depth, column)
        return complex(plus), complex(minus)
    means = []
    for alpha in column.rotations:
        upper = _cosh_ratio(alpha, 0.0, column.depth) * np.sinh(alpha * d) / (alpha * d)
        if not np.isfinite(upper):  # cosh overflows; in water this deep the bed has no influence
            upper = np.exp(alpha * (d - column.depth)) / (alpha * d)
        base = 1.0 + alpha / column.slip * np.tanh(alpha * column.depth)
        means.append(complex((base - upper) / _unscaled_mean(alpha, column)))
    return means[0], means[1]


def _unscaled_profile(alpha: complex, z: FloatArray, column: WaterColumn) -> ComplexArray:
    """Return the profile without its scale, divided by cosh(alpha D) to avoid overflow."""
    base = 1.0 + alpha / column.slip * np.tanh(alpha * column.depth)
    return np.asarray(base - _cosh_ratio(alpha, z - column.depth, column.depth))


def _unscaled_mean(alpha: complex, column: WaterColumn) -> complex:
    """Return the depth mean of `_unscaled_profile`."""
    depth = column.depth
    return complex(1.0 + (alpha / column.slip - 1.0 / (alpha * depth)) * np.tanh(alpha * depth))


def _cosh_ratio(alpha: complex, x: ArrayLike, depth: float) -> ComplexArray:
    """Return cosh(alpha x) / cosh(alpha depth) for |x| <= depth."""
    far = np.abs(np.asarray(x, float))
    top = np.exp(alpha * (far - depth)) * (1.0 + np.exp(-2.0 * alpha * far))
    return np.asarray(top / (1.0 + np.exp(-2.0 * alpha * depth)))


def density_profile(
    eta: ArrayLike,
    column: WaterColumn,
    *,
    density_gradient: float = -2e-4,
    density: float = 1000.0,
    rise: float = 0.2,
) -> tuple[FloatArray, FloatArray]:
    r"""Return the steady density-driven current.

    With :math:`\eta` from 0 at the surface to 1 at the bed [1]_ (Schless, 2023, eqs. 2.28-2.29):

    .. math::

        u &= K (X Q - Y P), \qquad v = K (X P + Y Q + \Lambda + \eta) \\
        K &= \frac{g H}{f \rho} \frac{\partial \rho}{\partial x},
        \qquad a = H \sqrt{\frac{f}{2 N}}, \qquad b = \frac{k H}{N}

    where X, Y, P, Q and :math:`\Lambda` are Heaps' functions of a, b and :math:`\eta`, H is depth
    plus rise, N the eddy viscosity and k the linear friction.

    Parameters
    ----------
    eta : array_like
        Depth below the surface over water depth, 0 at the surface to 1 at the bed.
    column : WaterColumn
        The water column; its frequency and speed are not used.
    density_gradient : float
        Change of density towards the coast [kg/m4], negative where the coast is fresher.
    density : float
        Density of the water [kg/m3].
    rise : float
        Rise of the surface above its undisturbed level [m].

    Returns
    -------
    u, v : float64 array
        Towards the coast and along it (90 degrees anticlockwise from u) [m/s]; u has no
        depth mean. The discharge of the river itself is not included.

    Raises
    ------
    ModelRangeError
        South of or at the equator, or in water deeper than `MAX_HEAPS_DEPTH_RATIO`.

    References
    ----------
    .. [1] Heaps, N.S. (1972). Estimation of density currents in the Liverpool Bay area of the Irish
       Sea. *Geophysical Journal of the Royal Astronomical Society* 30, 415-432.
    """
    share = _checked_height(eta, 1.0)
    height = column.depth + rise
    if not column.coriolis > 0.0:
        raise ModelRangeError(
            f"Heaps' density current has no solution for f = {column.coriolis:g} rad/s.",
            "The solution is valid north of the equator.",
            "Omit the density current (density_gradient=0).",
        )
    a = height * np.sqrt(column.coriolis / (2.0 * column.viscosity))
    b = column.friction * height / column.viscosity
    if a > MAX_HEAPS_DEPTH_RATIO:
        raise ModelRangeError(
            f"The water is {a / np.pi:.0f} Ekman depths deep.",
            f"Heaps' solution can be evaluated up to {MAX_HEAPS_DEPTH_RATIO / np.pi:.0f}.",
            "Check viscosity and depth.",
        )
    scale = GRAVITY * height / column.coriolis * density_gradient / density
    x, y, p, q, offset = _heaps_terms(a, b, share)
    return scale * (x * q - y * p), scale * (x * p + y * q + offset + share)


def _heaps_terms(
    a: float, b: float, eta: FloatArray
) -> tuple[FloatArray, FloatArray, float, float, float]:
    """Return X, Y, P, Q and capital Lambda of Heaps (1972)."""
    sh, ch, sn, cs = np.sinh(a), np.cosh(a), np.sin(a), np.cos(a)
    c = a * (sh * cs - ch * sn) + b * ch * cs
    e = a * (sh * cs + ch * sn) + b * sh * sn
    p, q = c / (c * c + e * e), e / (c * c + e * e)
    r = p * ch * cs + q * sh * sn
    s = 1.0 - r * b
    offset = (r - p - s) / s
    weight = 1.0 + b + b * offset
    a1, a2, half = a * (1.0 - eta), a * eta, b / (2.0 * a)
    sh1, ch1, sn1, cs1 = np.sinh(a1), np.cosh(a1), np.sin(a1), np.cos(a1)
    ch2, sh2, sn2, cs2 = np.cosh(a2), np.sinh(a2), np.sin(a2), np.cos(a2)
    x = ch1 * cs1 + half * (sh1 * cs1 + ch1 * sn1) - weight * ch2 * cs2
    y = sh1 * sn1 + half * (ch1 * sn1 - sh1 * cs1) - weight * sh2 * sn2
    return x, y, float(p), float(q), float(offset)


def density_mean(draught: float, column: WaterColumn, **density: float) -> tuple[float, float]:
    r"""Return the mean of `density_profile` from the surface down to a draught.

    .. math:: \frac{1}{d} \int_0^d (u, v)(Z) \, dZ

    Gauss-Legendre quadrature with 48 points, exact to rounding for the smooth profile.

    Parameters
    ----------
    draught : Draught [m], 0 to depth.
    **density
        ``density_gradient`` [kg/m4], ``density`` [kg/m3] and ``rise`` [m], as `density_profile`.

    Returns
    -------
    u, v : Towards the coast and along it [m/s].

    References
    ----------
    Schless (2023), eqs. 3.75 and 3.76, of the profile of Heaps (1972).
    """
    height = column.depth + density.get("rise", 0.2)
    d = float(_checked_height(draught, column.depth))
    node, weight = np.polynomial.legendre.leggauss(48)
    u, v = density_profile(0.5 * (node + 1.0) * d / height, column, **density)
    return float(0.5 * weight @ u), float(0.5 * weight @ v)


def _checked_height(value: ArrayLike, largest: float) -> FloatArray:
    numbers = np.asarray(value, np.float64)
    if not ((numbers >= -1e-9 * largest) & (numbers <= largest * (1.0 + 1e-9))).all():
        raise InputError(
            f"A height, depth or draught is outside the water column: {value!r}.",
            f"It must be between 0 and {largest:g}.",
            "Correct the value, or give a deeper water column.",
        )
    return np.clip(numbers, 0.0, largest)
