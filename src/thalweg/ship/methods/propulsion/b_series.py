"""Open-water propellers of the Wageningen B-series.

Source: M.W.C. Oosterveld and P. van Oossanen, "Further computer-analyzed data of the Wageningen
B-screw series", International Shipbuilding Progress 22 (1975) 251-262: polynomials of 39 and 47
terms for Rn = 2e6, and their Reynolds correction (``b_series_coefficients.csv``). The coefficients
agree between several independent reprints; the worked example of Holtrop and Mennen (1982) is among
the tests.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.file_reading import table_rows
from thalweg.core.types import FloatArray
from thalweg.core.units import SEA_WATER_DENSITY
from thalweg.ship.methods.validity import RangeNote, range_notes


@dataclass(frozen=True)
class Propeller:
    """One open propeller.

    Attributes
    ----------
    diameter : D [m].
    pitch_ratio : P / D.
    area_ratio : Expanded blade area ratio A_E / A_0.
    blades : Z.
    """

    diameter: float
    pitch_ratio: float
    area_ratio: float
    blades: int


@dataclass(frozen=True)
class PropellerOperatingPoint:
    """State of a propeller that gives a thrust at a speed of advance; arrays of one shape.

    Attributes
    ----------
    advance : J = V_A / (n D).
    rate : n [1/s].
    torque : Open-water torque [N m].
    power : ndarray
        2 pi n Q [W], in open water; over the relative rotative efficiency it is the delivered one.
    efficiency : Open-water efficiency J K_T / (2 pi K_Q).
    """

    advance: FloatArray
    rate: FloatArray
    torque: FloatArray
    power: FloatArray
    efficiency: FloatArray


def _advance_polynomial(
    terms: FloatArray, propeller: Propeller, log: float | None = None
) -> FloatArray:
    """Return the coefficients of 1, J, J^2 and J^3 of a polynomial for one propeller."""
    weights = (
        terms[:, 0]
        * propeller.pitch_ratio ** terms[:, 2]
        * propeller.area_ratio ** terms[:, 3]
        * float(propeller.blades) ** terms[:, 4]
    )
    if log is not None:
        weights = weights * log ** terms[:, 5]
    powers = terms[:, 1].astype(int)
    return np.array([np.sum(weights[powers == power]) for power in range(4)])


def b_series_polynomials(
    propeller: Propeller, *, reynolds: float | None = None
) -> tuple[FloatArray, FloatArray]:
    r"""Return K_T and K_Q of one propeller as cubics in J, constant term first.

    .. math::

        K_T, K_Q = \sum_n C_n J^{s_n} (P/D)^{t_n} (A_E/A_0)^{u_n} Z^{v_n}

    Parameters
    ----------
    propeller : Diameter does not matter.
    reynolds : Reynolds number of the chord at 0.75 R, above 2e6, for the correction of the source;
        none by default, which is Rn = 2e6.

    Returns
    -------
    thrust, torque : Four coefficients each.

    References
    ----------
    M.W.C. Oosterveld, P. van Oossanen, International Shipbuilding Progress 22 (1975) 251-262.
    """
    thrust = _advance_polynomial(polynomial_terms("thrust"), propeller)
    torque = _advance_polynomial(polynomial_terms("torque"), propeller)
    if reynolds is not None:
        log = float(np.log10(reynolds)) - 0.301
        thrust += _advance_polynomial(polynomial_terms("thrust_reynolds"), propeller, log)
        torque += _advance_polynomial(polynomial_terms("torque_reynolds"), propeller, log)
    return thrust, torque


def _cubic(coefficients: FloatArray, advance: FloatArray) -> FloatArray:
    a, b, c, d = coefficients
    return np.asarray(a + advance * (b + advance * (c + advance * d)))


def b_series(
    advance: ArrayLike, propeller: Propeller, *, reynolds: float | None = None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Open-water characteristics.

    Parameters
    ----------
    advance : J, from zero to where the thrust vanishes.
    propeller : See `Propeller`.
    reynolds : See `b_series_polynomials`.

    Returns
    -------
    thrust, torque, efficiency : K_T, K_Q and eta_0.
    """
    ratio = np.asarray(advance, dtype=float)
    thrust, torque = b_series_polynomials(propeller, reynolds=reynolds)
    kt, kq = _cubic(thrust, ratio), _cubic(torque, ratio)
    return kt, kq, np.asarray(ratio * kt / (2.0 * np.pi * kq))


def largest_advance(propeller: Propeller, *, reynolds: float | None = None) -> float:
    """Return the advance coefficient at which the thrust vanishes.

    Parameters
    ----------
    propeller : See `Propeller`.
    reynolds : See `b_series_polynomials`.

    Returns
    -------
    float : The lowest J above zero at which K_T is zero.

    Raises
    ------
    InputError : For a propeller so far outside the series that its polynomial has no such J, or no
        thrust at the bollard.
    """
    thrust, _ = b_series_polynomials(propeller, reynolds=reynolds)
    roots = np.roots(thrust[::-1])
    real = roots[(np.abs(roots.imag) < 1e-9) & (roots.real > 0.0)].real
    if real.size == 0 or thrust[0] <= 0.0:
        outside = "; ".join(str(note) for note in b_series_validity(propeller))
        raise InputError(
            f"The B-series has no propeller of P/D {propeller.pitch_ratio:g}, A_E/A_0 "
            f"{propeller.area_ratio:g} and {propeller.blades} blades: its polynomials give no "
            "thrust that falls to zero.",
            outside or "The series has Z 2 to 7, A_E/A_0 0.30 to 1.05 and P/D 0.5 to 1.4.",
            "Correct the propeller, or use constant efficiencies.",
            pitch_ratio=propeller.pitch_ratio,
            area_ratio=propeller.area_ratio,
            blades=propeller.blades,
        )
    return float(real.min())


def solve_advance(
    thrust: ArrayLike,
    advance_speed: ArrayLike,
    *,
    polynomial: FloatArray,
    largest: float,
    diameter: float,
    density: float = SEA_WATER_DENSITY,
) -> FloatArray:
    r"""Advance coefficient at which a propeller gives a thrust at a speed of advance.

    .. math:: K_T(J)\, \rho V_A^2 D^2 = T J^2

    The root of K_T(J) rho V_A^2 D^2 = T J^2 is unique between J = 0 (at the bollard) and the J of
    no thrust. Newton's method finds it from a near point; where it does not converge, its steps are
    limited to the bracket.

    Parameters
    ----------
    thrust : T of one propeller [N], not negative.
    advance_speed : V_A [m/s], not negative.
    polynomial : K_T as a cubic in J.
    largest : J of no thrust.
    diameter, density : [m], [kg/m3].

    Returns
    -------
    ndarray : J; NaN for a negative thrust or speed.

    References
    ----------
    M.W.C. Oosterveld, P. van Oossanen, International Shipbuilding Progress 22 (1975) 251-262.
    """
    force, flow = np.broadcast_arrays(
        np.asarray(thrust, dtype=float), np.asarray(advance_speed, dtype=float)
    )
    stream = density * flow**2 * diameter**2
    scale = np.maximum(stream, force)
    share = force / np.where(scale > 0.0, scale, 1.0)
    stream = stream / np.where(scale > 0.0, scale, 1.0)
    ratio = _initial_advance(share, stream, polynomial, largest)
    for _ in range(3):
        step = _newton_step(ratio, share, stream, polynomial)
        ratio = ratio - step
    # Newton's next step would be the square of the last one
    settled = (np.abs(step) < 1e-6) & (ratio >= 0.0) & (ratio <= largest)
    rough = ~settled & np.isfinite(share) & np.isfinite(stream)
    if rough.any():
        sure = _bracketed_advance(share[rough], stream[rough], polynomial, largest)
        ratio = np.array(ratio)
        ratio[rough] = sure
    known = (force >= 0.0) & (flow >= 0.0)
    return np.where(known, np.where(flow == 0.0, 0.0, ratio), np.nan)


def _newton_step(
    ratio: FloatArray, share: FloatArray, stream: FloatArray, polynomial: FloatArray
) -> FloatArray:
    _, b, c, d = polynomial
    value = stream * _cubic(polynomial, ratio) - share * ratio**2
    slope = stream * (b + ratio * (2.0 * c + ratio * 3.0 * d)) - 2.0 * share * ratio
    return np.asarray(value / np.where(slope < 0.0, slope, -1.0))


def _bracketed_advance(
    share: FloatArray, stream: FloatArray, polynomial: FloatArray, largest: float
) -> FloatArray:
    """The same root by Newton steps limited to a bracket: slower, but always converges."""
    low, high = np.zeros_like(share), np.full_like(share, largest)
    ratio = 0.5 * (low + high)
    for _ in range(60):
        above = stream * _cubic(polynomial, ratio) > share * ratio**2
        low, high = np.where(above, ratio, low), np.where(above, high, ratio)
        new = ratio - _newton_step(ratio, share, stream, polynomial)
        new = np.where((new > low) & (new < high), new, 0.5 * (low + high))
        moved = np.max(np.abs(new - ratio), initial=0.0)
        ratio = new
        if moved <= 1e-11:
            break
    return ratio


def _initial_advance(
    share: FloatArray, stream: FloatArray, polynomial: FloatArray, largest: float
) -> FloatArray:
    """Where to start the search for J: between 129 points of K_T / (K_T + J^2), which falls."""
    points = np.linspace(0.0, largest, 129)
    thrust = np.maximum(_cubic(polynomial, points), 0.0)
    loading = thrust / (thrust + points**2)
    both = share + stream
    with np.errstate(invalid="ignore"):
        wanted = share / np.where(both > 0.0, both, np.nan)
    found = np.interp(wanted, loading[::-1], points[::-1])
    return np.where(np.isnan(found), 0.5 * largest, found)


def operating_point(
    thrust: ArrayLike,
    advance_speed: ArrayLike,
    propeller: Propeller,
    *,
    density: float = SEA_WATER_DENSITY,
    reynolds: float | None = None,
) -> PropellerOperatingPoint:
    r"""State of a propeller that gives a thrust at a speed of advance.

    .. math::
        J = \frac{V_A}{n D}, \quad T = K_T \rho n^2 D^4, \quad Q = K_Q \rho n^2 D^5, \quad P
            = 2 \pi n Q, \quad \eta_0 = \frac{J K_T}{2 \pi K_Q}

    Parameters
    ----------
    thrust : Of one propeller [N], not negative.
    advance_speed : V_A = V (1 - w) [m/s].
    propeller : See `Propeller`.
    density : float [kg/m3]
    reynolds : See `b_series_polynomials`.

    Returns
    -------
    OperatingPoint : NaN for a negative thrust or speed.

    References
    ----------
    M.W.C. Oosterveld, P. van Oossanen, International Shipbuilding Progress 22 (1975) 251-262.
    """
    polynomials = b_series_polynomials(propeller, reynolds=reynolds)
    size, largest = propeller.diameter, largest_advance(propeller, reynolds=reynolds)
    advance = solve_advance(
        thrust,
        advance_speed,
        polynomial=polynomials[0],
        largest=largest,
        diameter=size,
        density=density,
    )
    kt, kq = (_cubic(polynomial, advance) for polynomial in polynomials)
    force, flow = np.asarray(thrust, dtype=float), np.asarray(advance_speed, dtype=float)
    loaded = np.sqrt(np.maximum(force, 0.0) / (density * size**4 * np.where(kt > 0.0, kt, 1.0)))
    moving = flow / (np.where(advance > 0.0, advance, 1.0) * size)
    light = advance > 0.5 * largest  # of the two equations for n, the one without cancellation
    rate = np.where(np.isnan(advance), np.nan, np.where(light, moving, loaded))
    torque = kq * density * rate**2 * size**5
    efficiency = advance * kt / (2.0 * np.pi * kq)
    return PropellerOperatingPoint(advance, rate, torque, 2.0 * np.pi * rate * torque, efficiency)


def b_series_validity(propeller: Propeller) -> list[RangeNote]:
    """Return what is outside the series: Z 2 to 7, A_E/A_0 0.30 to 1.05, P/D 0.5 to 1.4."""
    ranges: dict[str, tuple[ArrayLike, float, float]] = {
        "number of blades": (propeller.blades, 2.0, 7.0),
        "blade area ratio": (propeller.area_ratio, 0.30, 1.05),
        "pitch ratio": (propeller.pitch_ratio, 0.5, 1.4),
    }
    return range_notes("b_series", ranges)


SeriesQuantity = Literal["thrust", "torque", "thrust_reynolds", "torque_reynolds"]
_COLUMNS = ("coefficient", "advance_ratio", "pitch_ratio", "area_ratio", "blades", "log_reynolds")


@cache
def polynomial_terms(quantity: SeriesQuantity) -> FloatArray:
    """Return the terms of one polynomial of the B-series.

    Parameters
    ----------
    quantity : {"thrust", "torque", "thrust_reynolds", "torque_reynolds"}
        K_T or K_Q at Rn = 2e6, or the Reynolds correction of one of them.

    Returns
    -------
    ndarray : Shape ``(terms, 6)``: the coefficient, and the powers of J, P/D, A_E/A_0, Z and
        log10(Rn) - 0.301; read-only.
    """
    table = table_rows("thalweg.ship.methods", "b_series_coefficients.csv")
    rows = [row for row in table if row["quantity"] == quantity]
    terms = np.array([[float(row[column]) for column in _COLUMNS] for row in rows])
    terms.flags.writeable = False
    return terms
