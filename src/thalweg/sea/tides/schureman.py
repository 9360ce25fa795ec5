"""Tidal arguments and nodal corrections after Schureman (1940), also of compound tides.

Arguments and factors of the basic constituents are those of Schureman, *Manual of Harmonic
Analysis and Prediction of Tides*, Special Publication 98 (US Coast and Geodetic Survey, 1940,
corrected 1958); equation numbers refer to it. Compound (shallow-water) tides are derived from
their names: ``3MNS6`` is three times M2, plus N2, minus S2.

Rijkswaterstaat predicts the Dutch coast with the same arguments, but applies the nodal factor of
some constituents only in part (its empirical "x-factors"), because non-linear friction damps the
18.6-year modulation there. This is the convention ``rws``.
"""

from __future__ import annotations

import itertools
import re
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from typing import Final

import numpy as np

from thalweg.core.errors import unknown_name_error
from thalweg.core.types import ComplexArray, FloatArray
from thalweg.sea.tides.astronomy import argument_rates, mean_longitudes

#: Fraction of the nodal factor that is applied, for stations in the Netherlands (Rijkswaterstaat).
#: The factor is 1 + fraction * (f - 1); S2, which has no nodal factor, uses that of M2.
RWS_NODAL_FRACTIONS: Final[dict[str, float]] = {
    "MU2": 0.0, "N2": 0.0, "NU2": 0.8, "M2": 0.53, "2MN2": 0.2, "S2": -0.82, "M4": 0.7,
    "MS4": 0.0, "M6": 0.75, "2MS6": 0.2, "M8": 0.7, "3MS8": 0.6,
}  # fmt: skip

_Argument = tuple[int, int, int, int, int, float, str]


def _basic_constituents() -> dict[str, _Argument]:
    text = resources.files("thalweg.sea").joinpath("data/basic_constituents.csv").read_text("utf-8")
    rows = (line.split(",") for line in text.splitlines()[1:])
    return {
        name: (int(t), int(s), int(h), int(p), int(p1), float(phase), family)
        for name, t, s, h, p, p1, phase, family in rows
    }


#: By name: multiples of T s h p p1, phase [deg] (T counted from midnight), nodal family.
_BASIC_CONSTITUENTS: Final = _basic_constituents()

_ALIASES: Final[dict[str, str]] = {
    "SIG1": "SIGMA1", "RO1": "RHO1", "RHO": "RHO1", "FI1": "PHI1", "THE1": "THETA1", "E2": "EPS2",
    "LABDA2": "LAMBDA2", "LDA2": "LAMBDA2", "LAM2": "LAMBDA2", "GAM2": "GAMMA2", "MFM": "MTM",
    "H1": "ALPHA2", "KI1": "CHI1", "MNUM": "MSM", "EP2": "EPS2", "SGM": "SIGMA1",
}  # fmt: skip

# Compounds whose names do not follow the rule.
_IRREGULAR_COMPOUNDS: Final[dict[str, dict[str, int]]] = {
    "SM": {"S2": 1, "M2": -1},
    "SNU2": {"S2": 1, "NU2": -1},
    "SN": {"S2": 1, "N2": -1},
    "2SM": {"S2": 2, "M2": -2},
    "2SMN": {"S2": 2, "M2": -1, "N2": -1},
    "K3": {"K2": 1, "K1": 1},
    "M5": {"M2": 2, "M1": 1},
    "M7": {"M2": 3, "M1": 1},
    "M(SK)2": {"M2": 1, "S1": 1, "K1": -1},
    "M(KS)2": {"M2": 1, "K1": 1, "S1": -1},
}
_CONSTITUENTS_BY_LETTER: Final[dict[str, tuple[str, ...]]] = {
    "M": ("M2",), "S": ("S2", "S1"), "N": ("N2",), "K": ("K2", "K1"), "L": ("L2",), "O": ("O1",),
    "P": ("P1",), "Q": ("Q1",), "J": ("J1",), "T": ("T2",), "R": ("R2",), "NU": ("NU2",),
    "LABDA": ("LAMBDA2",), "MU": ("MU2",),
}  # fmt: skip
_TERM_PATTERN = re.compile(r"(\d*)(\((?:[A-Z]+)\)|LABDA|NU|MU|[A-Z])")
_UNIT_PATTERN = re.compile(r"LABDA|NU|MU|[A-Z]")


@dataclass(frozen=True)
class ConstituentDefinition:
    """One constituent: the basic constituents that give its argument and nodal factor.

    Attributes
    ----------
    name : Canonical name.
    parts : tuple of (str, int)
        Basic constituents and multiples; one part for a basic constituent.
    """

    name: str
    parts: tuple[tuple[str, int], ...]

    @property
    def argument(self) -> FloatArray:
        """Multiples (7,) of (T, s, h, p, N', p1) and of a full cycle."""
        total = np.zeros(7)
        for name, count in self.parts:
            t, s, h, p, p1, phase, _ = _BASIC_CONSTITUENTS[name]
            total += count * np.array([t, s, h, p, 0.0, p1, phase / 360.0])
        return total


@lru_cache(maxsize=1024)
def constituent_definition(name: str) -> ConstituentDefinition:
    """Return the constituent of a name, in any usual spelling.

    Parameters
    ----------
    name : Such as ``M2``, ``NU2`` or ``3MNS6``.

    Raises
    ------
    InputError : If the name is neither in the tables nor that of a compound tide.
    """
    plain = name.strip().upper().removesuffix("_KV")
    plain = _ALIASES.get(plain, plain)
    if plain in _BASIC_CONSTITUENTS:
        return ConstituentDefinition(plain, ((plain, 1),))
    if plain in _IRREGULAR_COMPOUNDS:
        return ConstituentDefinition(plain, tuple(_IRREGULAR_COMPOUNDS[plain].items()))
    parts = _compound_parts(plain)
    if parts is None:
        raise unknown_name_error(
            "tidal constituent", name, [*_BASIC_CONSTITUENTS, "M4", "MS4", "2MS6", "3MS8"]
        )
    return ConstituentDefinition(plain, parts)


def _compound_parts(name: str) -> tuple[tuple[str, int], ...] | None:
    """Return the constituents of the name of a compound tide; None if it is not one."""
    found = re.fullmatch(r"(.*?[A-Z)])(\d+)", name)
    if found is None:
        return None
    body, cycles = found.group(1), int(found.group(2))
    if re.fullmatch(r"\(?(?:\d*\(?(?:LABDA|NU|MU|[MSNKLOPQJTR])+\)?)+", body) is None:
        return None
    terms = [
        (unit, int(count or 1))
        for count, group in _TERM_PATTERN.findall(body)
        for unit in _UNIT_PATTERN.findall(group)
    ]
    if any(unit not in _CONSTITUENTS_BY_LETTER for unit, _ in terms) or body == "ST":
        return None
    if len(terms) == 1:
        whole = _CONSTITUENTS_BY_LETTER[terms[0][0]][0]
        if terms[0][1] > 1 or cycles % 2 or not whole.endswith("2"):
            return None
        return ((whole, cycles // 2),)
    return _signed_terms(terms, cycles) or _signed_terms([*terms[:-1], (terms[-1][0], 2)], cycles)


def _signed_terms(terms: list[tuple[str, int]], cycles: int) -> tuple[tuple[str, int], ...] | None:
    """Return the terms with signs such that the cycles per day add up.

    Semidiurnal constituents have priority over diurnal ones, few minus signs over many, and minus
    signs at the end over others.
    """
    best: tuple[tuple[int, ...], tuple[tuple[str, int], ...]] | None = None
    meanings = itertools.product(*(_CONSTITUENTS_BY_LETTER[unit] for unit, _ in terms))
    signings = list(itertools.product((1, -1), repeat=len(terms) - 1))
    for meaning in meanings:
        diurnal = sum(m in ("S1", "K1") for m in meaning)
        odd = sum(m == "S1" for m in meaning)
        for rest in signings:
            signs = (1, *rest)
            parts = tuple((m, s * c) for m, s, (_, c) in zip(meaning, signs, terms))
            if sum(n * _BASIC_CONSTITUENTS[m][0] for m, n in parts) != cycles:
                continue
            rank = (odd, diurnal, sum(s < 0 for s in signs), *(s < 0 for s in signs))
            if best is None or rank < best[0]:
                best = rank, parts
    return best[1] if best else None


def frequency(name: str) -> float:
    """Return the frequency [cycles per hour] of a constituent."""
    return float(constituent_definition(name).argument[:6] @ argument_rates())


def equilibrium_arguments(names: tuple[str, ...], times: FloatArray) -> FloatArray:
    r"""Return the equilibrium arguments at Greenwich.

    .. math:: V = i_1 T + i_2 s + i_3 h + i_4 p + i_6 p_1 + \text{phase}

    with the multiples of Schureman (1958), Table 2, and T counted from midnight.

    Parameters
    ----------
    names : C constituents.
    times : Seconds since 1970-01-01T00:00Z, (T,).

    Returns
    -------
    float64 array (T, C) : V [cycles], 0 to 1.

    References
    ----------
    P. Schureman, "Manual of harmonic analysis and prediction of tides", Coast and Geodetic
    Survey Special Publication 98 (1958), Table 2.
    """
    matrix = np.array([constituent_definition(n).argument for n in names]).reshape(-1, 7)
    return (mean_longitudes(times).T @ matrix[:, :6].T + matrix[:, 6]) % 1.0


def nodal_corrections(
    names: tuple[str, ...], times: FloatArray, *, rws: bool = False
) -> ComplexArray:
    r"""Return the nodal corrections :math:`f e^{i u}`.

    They depend on the inclination I of the moon's orbit to the equator, on :math:`\xi` and
    :math:`\nu` (Schureman, 1958, eqs. 191 ff.); for M2, for example (eq. 78):

    .. math:: f = \cos^4(I / 2) / 0.9154, \qquad u = 2 (\xi - \nu)

    Parameters
    ----------
    names : C constituents.
    times : Seconds since 1970-01-01T00:00Z, (T,).
    rws : Whether the factors are applied only by the fractions `RWS_NODAL_FRACTIONS`.

    Returns
    -------
    complex128 array (T, C) : f exp(i u).

    References
    ----------
    P. Schureman (1958), eqs. 73 to 79, 144, 191 to 197, 207 to 215, 227 and 235.
    """
    family = _nodal_families(times)
    one = np.ones(times.size, np.complex128)
    columns = []
    for name in names:
        kind, value = constituent_definition(name), one
        for part, count in kind.parts:
            factor = family[_BASIC_CONSTITUENTS[part][6]]
            value = value * np.abs(factor) ** abs(count) * np.exp(1j * count * np.angle(factor))
        share = RWS_NODAL_FRACTIONS.get(kind.name) if rws else None
        if share is not None:
            source = family["M2"] if kind.name == "S2" else value
            size = 1.0 + share * (np.abs(source) - 1.0)
            value = size * np.exp(1j * np.angle(value))
        columns.append(value)
    return np.stack(columns, axis=1) if columns else np.empty((times.size, 0), np.complex128)


def _nodal_families(times: FloatArray) -> dict[str, ComplexArray]:
    """Return f exp(i u) of each nodal family (eqs. 73-79, 144, 191-197, 207-215, 227, 235)."""
    longitude = mean_longitudes(times) * 2.0 * np.pi
    node, perigee = -longitude[4], longitude[3]
    tilt = np.arccos(0.91370 - 0.03569 * np.cos(node))
    half_node = np.arctan2(np.sin(0.5 * node), np.cos(0.5 * node))
    plus = np.arctan2(1.01883 * np.sin(half_node), np.cos(half_node))
    minus = np.arctan2(0.64412 * np.sin(half_node), np.cos(half_node))
    xi, nu = node - plus - minus, plus - minus
    sin1, sin2 = np.sin(tilt), np.sin(2.0 * tilt)
    cos_half, sin_half = np.cos(0.5 * tilt), np.sin(0.5 * tilt)
    p = perigee - xi
    o1 = sin1 * cos_half**2 / 0.3800
    m2 = cos_half**4 / 0.9154
    m2_phase, o1_phase = 2.0 * (xi - nu), 2.0 * xi - nu
    k1 = np.sqrt(0.8965 * sin2**2 + 0.6001 * sin2 * np.cos(nu) + 0.1006)
    k1_phase = -np.arctan2(sin2 * np.sin(nu), sin2 * np.cos(nu) + 0.3347)
    k2 = np.sqrt(19.0444 * sin1**4 + 2.7702 * sin1**2 * np.cos(2.0 * nu) + 0.0981)
    k2_phase = -np.arctan2(sin1**2 * np.sin(2.0 * nu), sin1**2 * np.cos(2.0 * nu) + 0.0727)
    tangent = (sin_half / cos_half) ** 2
    l2 = m2 * np.sqrt(1.0 - 12.0 * tangent * np.cos(2.0 * p) + 36.0 * tangent**2)
    r = np.arctan2(np.sin(2.0 * p), 1.0 / (6.0 * tangent) - np.cos(2.0 * p))
    ratio = np.cos(tilt) / cos_half**2
    m1 = o1 * np.sqrt(0.25 + 1.5 * ratio * np.cos(2.0 * p) + 2.25 * ratio**2)
    qu = np.arctan2(np.sin(2.0 * p), 3.0 * ratio + np.cos(2.0 * p))
    m1c = (1.0 - 10.0 * sin_half**2 + 15.0 * sin_half**4) * cos_half**2 / 0.5873
    oo1 = sin1 * sin_half**2 / 0.0164
    still = np.zeros(times.size)
    made = {
        "": (still + 1.0, still),
        "MM": ((2.0 / 3.0 - sin1**2) / 0.5021, still),
        "MF": (sin1**2 / 0.1578, -2.0 * xi),
        "O1": (o1, o1_phase),
        "J1": (sin2 / 0.7214, -nu),
        "OO1": (oo1, -2.0 * xi - nu),
        "M2": (m2, m2_phase),
        "M3": (m2**1.5, 1.5 * m2_phase),
        "KJ": (sin1**2 / 0.1565, -2.0 * nu),
        "K1": (k1, k1_phase),
        "K2": (k2, k2_phase),
        "L2": (l2, m2_phase - r),
        "M1": (m1, -nu - qu),
        "M1C": (m1c, xi - nu),
    }
    return {name: f * np.exp(1j * u) for name, (f, u) in made.items()}
