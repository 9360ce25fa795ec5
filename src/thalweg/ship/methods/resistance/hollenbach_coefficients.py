"""Coefficients of Hollenbach (1998), one record for each variant.

Source: U. Hollenbach, "Estimating resistance and propulsion for single-screw and twin-screw
ships", Schiffstechnik 45(2), 1998; reprinted in Schneekluth and Bertram, "Ship Design for
Efficiency and Economy" (2nd ed., 1998) and Birk, "Fundamentals of Ship Hydrodynamics" (2019).

How sure the numbers are: the single-screw design coefficients reproduce a published table of 11
speeds within 0.05 %. The other mean curves and the single-screw minimum agree between at least
two independent reprints. Seen in one reprint only, or quoted from memory, and therefore
*unverified*: the Froude limits of ``single_ballast`` and ``twin_design``, the lower Froude limit
of ``twin_minimum``, and all factors of the maximum line.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal

ResistanceVariant = Literal[
    "single_design", "single_ballast", "single_minimum", "twin_design", "twin_minimum"
]
SurfaceVariant = Literal["single_design", "single_ballast", "twin_bulb", "twin_no_bulb"]


@dataclass(frozen=True)
class HollenbachCoefficients:
    """Coefficients of one variant, named as in the paper.

    Attributes
    ----------
    ratios : tuple of float
        a1 ... a10, exponents of the hull ratios and appendage counts.
    residuary : tuple of tuple of float
        b11 ... b33.
    critical : tuple of float or None
        d1, d2, d3 of the critical Froude number; None for the minimum curves, which have none.
    growth : {"ratio", "block", "none"}
        Exponent c1 above the critical Froude number: Fn / Fn_crit, 10 C_B (Fn / Fn_crit - 1), or
        no growth.
    length : tuple of float
        e1, e2 of the length factor.
    lower, upper : tuple of float
        f1, f2, f3 and g1, g2, g3 of the Froude limits.
    maximum : float
        h1, ratio of the maximum to the mean line (unverified); NaN for the minimum curves.
    """

    ratios: tuple[float, ...]
    residuary: tuple[tuple[float, float, float], ...]
    critical: tuple[float, float, float] | None
    growth: Literal["ratio", "block", "none"]
    length: tuple[float, float]
    lower: tuple[float, float, float]
    upper: tuple[float, float, float]
    maximum: float


RESISTANCE_COEFFICIENTS: Final = MappingProxyType(
    {
        "single_design": HollenbachCoefficients(
            ratios=(-0.3382, 0.8086, -6.0258, -3.5632, 9.4405, 0.0146, 0.0, 0.0, 0.0, 0.0),
            residuary=(
                (-0.57424, 13.3893, 90.5960),
                (4.6614, -39.721, -351.483),
                (-1.14215, -12.3296, 459.254),
            ),
            critical=(0.854, -1.228, 0.497),
            growth="ratio",
            length=(2.1701, -0.1602),
            lower=(0.17, 0.20, 0.60),
            upper=(0.642, -0.635, 0.150),
            maximum=1.204,
        ),
        "single_ballast": HollenbachCoefficients(
            ratios=(-0.7139, 0.2558, -1.1606, 0.4534, 11.222, 0.4524, 0.0, 0.0, 0.0, 0.0),
            residuary=(
                (-1.50162, 12.9678, -36.7985),
                (5.55536, -45.8815, 121.820),
                (-4.33571, 36.0782, -85.3741),
            ),
            critical=(0.032, 0.803, -0.739),
            growth="block",
            length=(1.9994, -0.1446),
            lower=(0.15, 0.10, 0.50),
            upper=(0.42, -0.20, 0.0),
            maximum=1.194,
        ),
        "single_minimum": HollenbachCoefficients(
            ratios=(-0.3382, 0.8086, -6.0258, -3.5632, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
            residuary=(
                (-0.91424, 13.3893, 90.5960),
                (4.6614, -39.721, -351.483),
                (-1.14215, -12.3296, 459.254),
            ),
            critical=None,
            growth="none",
            length=(1.0, 0.0),
            lower=(0.17, 0.20, 0.60),
            upper=(0.614, -0.717, 0.261),
            maximum=float("nan"),
        ),
        "twin_design": HollenbachCoefficients(
            ratios=(
                *(-0.2748, 0.5747, -6.7610, -4.3834, 8.8158),
                *(-0.1418, -0.1258, 0.0481, 0.1699, 0.0728),
            ),
            residuary=(
                (-5.34750, 55.6532, -114.905),
                (19.2714, -192.388, 388.333),
                (-14.3571, 142.738, -254.762),
            ),
            critical=(0.897, -1.457, 0.767),
            growth="ratio",
            length=(1.8319, -0.1237),
            lower=(0.16, 0.24, 0.60),
            upper=(0.83, -0.66, 0.0),
            maximum=1.206,
        ),
        "twin_minimum": HollenbachCoefficients(
            ratios=(-0.2748, 0.5747, -6.7610, -4.3834, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
            residuary=(
                (3.27279, -44.1138, 171.692),
                (-11.5012, 166.559, -644.456),
                (12.4626, -179.505, 680.921),
            ),
            critical=None,
            growth="none",
            length=(1.0, 0.0),
            lower=(0.15, 0.0, 0.0),
            upper=(0.952, -1.406, 0.643),
            maximum=float("nan"),
        ),
    }
)

#: s0 ... s11 of the wetted-surface regression. One reprint gives -0.0006 for s6 of ``twin_bulb``.
SURFACE_COEFFICIENTS: Final = MappingProxyType(
    {
        "single_design": (
            *(-0.6837, 0.2771, 0.6542, 0.6422, 0.0075, 0.0275),
            *(-0.0045, -0.4798, 0.0376, 0.0, 0.0, 0.0),
        ),
        "single_ballast": (
            *(-0.8037, 0.2726, 0.7133, 0.6699, 0.0243, 0.0265),
            *(-0.0061, 0.2349, 0.0131, 0.0, 0.0, 0.0),
        ),
        "twin_bulb": (
            *(-0.4319, 0.1685, 0.5637, 0.5891, 0.0033, 0.0134),
            *(-0.0005, -2.7932, 0.0072, 0.0131, -0.0030, 0.0061),
        ),
        "twin_no_bulb": (
            *(-0.0887, 0.0, 0.5192, 0.5839, -0.0130, 0.0050),
            *(-0.0007, -0.9486, 0.0506, 0.0076, -0.0036, 0.0049),
        ),
    }
)
