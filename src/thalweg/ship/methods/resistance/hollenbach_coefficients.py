"""Coefficients of Hollenbach (1998), one record for each variant.

Source (data file ``hollenbach_coefficients.json``): U. Hollenbach, "Estimating resistance and
propulsion for single-screw and twin-screw ships", Schiffstechnik 45(2), 1998; reprinted in
Schneekluth and Bertram, "Ship Design for Efficiency and Economy" (2nd ed., 1998) and Birk,
"Fundamentals of Ship Hydrodynamics" (2019).

How sure the numbers are: the single-screw design coefficients reproduce a published table of 11
speeds within 0.05 %. The other mean curves and the single-screw minimum agree between at least
two independent reprints. Seen in one reprint only, or not compared with a source, and therefore
*unverified*: the Froude limits of ``single_ballast`` and ``twin_design``, and the lower Froude
limit of ``twin_minimum``.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources
from types import MappingProxyType
from typing import Final, Literal

from pydantic import TypeAdapter

ResistanceVariant = Literal[
    "single_design", "single_ballast", "single_minimum", "twin_design", "twin_minimum"
]
SurfaceVariant = Literal["single_design", "single_ballast", "twin_bulb", "twin_no_bulb"]


@dataclass(frozen=True)
class HollenbachCoefficients:
    """Coefficients of one variant, named as in the paper.

    Attributes
    ----------
    ratios : a1 ... a10, exponents of the hull ratios and appendage counts.
    residuary : b11 ... b33.
    critical : tuple of float or None
        d1, d2, d3 of the critical Froude number; None for the minimum curves, which have none.
    growth : {"ratio", "block", "none"}
        Exponent c1 above the critical Froude number: Fn / Fn_crit, 10 C_B (Fn / Fn_crit - 1), or
        no growth.
    length : e1, e2 of the length factor.
    lower, upper : f1, f2, f3 and g1, g2, g3 of the Froude limits. h1, ratio of the maximum to the
        mean line (unverified); NaN for the minimum curves.
    """

    ratios: tuple[float, ...]
    residuary: tuple[tuple[float, float, float], ...]
    critical: tuple[float, float, float] | None
    growth: Literal["ratio", "block", "none"]
    length: tuple[float, float]
    lower: tuple[float, float, float]
    upper: tuple[float, float, float]


@dataclass(frozen=True)
class _Tables:
    resistance: dict[ResistanceVariant, HollenbachCoefficients]
    surface: dict[SurfaceVariant, tuple[float, ...]]


_FILE = resources.files("thalweg.ship.methods").joinpath("data", "hollenbach_coefficients.json")
_TABLES: Final = TypeAdapter(_Tables).validate_json(_FILE.read_bytes())
RESISTANCE_COEFFICIENTS: Final = MappingProxyType(_TABLES.resistance)
#: s0 ... s11 of the wetted-surface regression. One reprint gives -0.0006 for s6 of ``twin_bulb``.
SURFACE_COEFFICIENTS: Final = MappingProxyType(_TABLES.surface)
