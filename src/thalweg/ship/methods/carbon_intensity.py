"""Carbon indicators of a ship: attained and required CII, rating, EEOI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import TypeAdapter

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array


@dataclass(frozen=True)
class ReferenceBand:
    """One line of the reference table: a capacity^-c for capacities from ``least`` on.

    Parameters
    ----------
    least : Smallest capacity of the band.
    a, c : Constants of the line.
    fixed_capacity : Capacity the line is read at, whatever the ship's; NaN for the ship's own.
    verified : Whether the numbers were compared with the source.
    note : What else must be known.
    """

    least: float
    a: float
    c: float
    fixed_capacity: float = float("nan")
    verified: bool = True
    note: str = ""


@dataclass(frozen=True)
class CiiShipType:
    """A ship type of the CII guidelines.

    Parameters
    ----------
    capacity : ``dwt`` or ``gt``.
    bands : By falling capacity.
    boundaries : tuple of (float, tuple of float)
        Smallest capacity and exp(d1) to exp(d4), by falling capacity.
    """

    capacity: str
    bands: tuple[ReferenceBand, ...]
    boundaries: tuple[tuple[float, tuple[float, float, float, float]], ...]


#: Where the numbers come from and how far they were checked.
SOURCES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "reference": "MEPC.353(78) (G2), as transcribed by at least three independent programs",
        "boundaries": "MEPC.354(78) (G4), read as published text of a classification society",
        "reduction_to_2026": "MEPC.338(76) (G3), as transcribed by two independent programs",
        "reduction_from_2027": "MEPC.400(83), read as published by Lloyd's Register",
    }
)


def _ship_types() -> Mapping[str, CiiShipType]:
    file = resources.files("thalweg.ship.methods").joinpath("data", "cii_ship_types.json")
    return TypeAdapter(dict[str, CiiShipType]).validate_json(file.read_bytes())


#: Ship type -> its lines.
SHIP_TYPES: Final[Mapping[str, CiiShipType]] = MappingProxyType(_ship_types())

#: Reduction Z [%] of the required CII below the 2019 reference line by year.
REDUCTION_PERCENT: Final[Mapping[int, float]] = MappingProxyType(
    dict(
        zip(
            range(2019, 2031),
            (0.0, 1.0, 2.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.625, 16.25, 18.875, 21.5),
            strict=True,
        )
    )
)


def cii_ship_type(name: str) -> CiiShipType:
    """Return a ship type of the CII guidelines by name.

    Parameters
    ----------
    name : A key of `SHIP_TYPES`.

    Returns
    -------
    CiiShipType : Its lines.

    Raises
    ------
    InputError : For an unknown name, with near matches.
    """
    if name not in SHIP_TYPES:
        raise unknown_name_error("CII ship type", name, SHIP_TYPES)
    return SHIP_TYPES[name]


def _carbon_intensity(co2: ArrayLike, work: FloatArray) -> FloatArray:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(work > 0.0, as_float_array(co2) * 1000.0 / work, np.nan)


def attained_cii(co2: ArrayLike, *, capacity: ArrayLike, distance_nm: ArrayLike) -> FloatArray:
    r"""Return the attained annual CII: CO2 over capacity times distance.

    .. math::
        CII = \frac{10^3\, m_{CO_2}}{capacity \cdot D}, \quad m_{CO_2}\ \text{in kg},\ D\
            \text{in nm}

    Parameters
    ----------
    co2 : array_like
        CO2 of the year [kg].
    capacity : array_like
        Deadweight [t] or gross tonnage, by ship type.
    distance_nm : array_like
        Distance of the year [nm].

    Returns
    -------
    ndarray
        g CO2 per (t nm); NaN where capacity or distance is not positive.

    References
    ----------
    MEPC.352(78) (G1), section 4.
    """
    return _carbon_intensity(co2, as_float_array(capacity) * as_float_array(distance_nm))


def eeoi(co2: ArrayLike, *, cargo_t: ArrayLike, distance_nm: ArrayLike) -> FloatArray:
    r"""Return the operational indicator: sum of CO2 over sum of cargo times distance.

    .. math:: EEOI = \frac{10^3 \sum m_{CO_2}}{\sum m_{cargo} D}

    Parameters
    ----------
    co2 : CO2 of each voyage [kg]; ballast voyages count with no cargo.
    cargo_t : Cargo of each voyage [t].
    distance_nm : Distance with that cargo [nm].

    Returns
    -------
    ndarray : g CO2 per (t nm), summed over the last axis; NaN where no cargo was moved.

    References
    ----------
    MEPC.1/Circ.684, appendix, section 4.
    """
    emitted = np.atleast_1d(as_float_array(co2))
    work = np.atleast_1d(as_float_array(cargo_t) * as_float_array(distance_nm))
    shape = np.broadcast_shapes(emitted.shape, work.shape)
    return _carbon_intensity(
        np.broadcast_to(emitted, shape).sum(-1), np.broadcast_to(work, shape).sum(-1)
    )


def reference_cii(ship_type: str, *, capacity: ArrayLike) -> FloatArray:
    """Return the 2019 reference line a capacity^-c of a ship type.

    Parameters
    ----------
    ship_type : A key of `SHIP_TYPES`.
    capacity : Deadweight [t] or gross tonnage as `SHIP_TYPES` says.

    Returns
    -------
    ndarray : g CO2 per (t nm); NaN where the capacity is not positive.

    References
    ----------
    MEPC.353(78) (G2), Table 1; what was checked is in `SOURCES` and in each `ReferenceBand`.
    """
    size = as_float_array(capacity)
    line = np.full(size.shape, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        for band in reversed(cii_ship_type(ship_type).bands):
            at = size if np.isnan(band.fixed_capacity) else np.full_like(size, band.fixed_capacity)
            line = np.where((size >= band.least) & (size > 0.0), band.a * at**-band.c, line)
    return line


def reduction_factor(year: int) -> float:
    """Return the reduction Z [%] of a year.

    Parameters
    ----------
    year : 2019 to 2030.

    Returns
    -------
    float : Percent below the 2019 line.

    Raises
    ------
    InputError : For a year without an adopted factor.

    References
    ----------
    MEPC.338(76) (G3) to 2026; MEPC.400(83) for 2027 to 2030.
    """
    if year not in REDUCTION_PERCENT:
        raise InputError(
            f"There is no CII reduction factor for {year}.",
            f"Factors are adopted for {min(REDUCTION_PERCENT)} to {max(REDUCTION_PERCENT)}.",
            "Give a year in that range.",
            year=year,
        )
    return REDUCTION_PERCENT[year]


def required_cii(ship_type: str, *, capacity: ArrayLike, year: int) -> FloatArray:
    r"""Return the required annual CII: (1 - Z/100) times the reference line.

    .. math:: CII_{req} = (1 - Z / 100)\, a\, capacity^{-c}

    Parameters
    ----------
    ship_type : A key of `SHIP_TYPES`.
    capacity : Deadweight [t] or gross tonnage.
    year : 2019 to 2030.

    Returns
    -------
    ndarray : g CO2 per (t nm).

    References
    ----------
    MARPOL Annex VI, regulation 28.4.
    """
    return (1.0 - reduction_factor(year) / 100.0) * reference_cii(ship_type, capacity=capacity)


def rating_boundaries(ship_type: str, *, capacity: ArrayLike, year: int) -> FloatArray:
    r"""Return the four boundaries between ratings A, B, C, D and E.

    .. math:: CII_k = \exp(d_k)\, CII_{req}, \quad k = 1, \ldots, 4

    Parameters
    ----------
    ship_type : A key of `SHIP_TYPES`.
    capacity : Deadweight [t] or gross tonnage.
    year : 2019 to 2030.

    Returns
    -------
    ndarray : g CO2 per (t nm); the four boundaries are the last axis.

    References
    ----------
    MEPC.354(78) (G4), Table 1.
    """
    size = as_float_array(capacity)
    factors = np.full((*size.shape, 4), np.nan)
    for least, row in reversed(cii_ship_type(ship_type).boundaries):
        factors = np.where((size >= least)[..., None], np.array(row), factors)
    return required_cii(ship_type, capacity=size, year=year)[..., None] * factors


def cii_rating(
    attained: ArrayLike, *, ship_type: str, capacity: ArrayLike, year: int
) -> NDArray[np.str_]:
    """Return the rating A to E of an attained CII.

    Parameters
    ----------
    attained : Attained CII [g CO2 per (t nm)].
    ship_type : A key of `SHIP_TYPES`.
    capacity : Deadweight [t] or gross tonnage.
    year : 2019 to 2030.

    Returns
    -------
    ndarray of str : ``A`` to ``E``; ``-`` where the attained CII is unknown. A value on a boundary
        has the better rating.

    References
    ----------
    MEPC.354(78) (G4), section 4.
    """
    value = as_float_array(attained)
    limits = rating_boundaries(ship_type, capacity=capacity, year=year)
    above = (value[..., None] > limits).sum(-1)
    letters = np.array(["A", "B", "C", "D", "E"])[above]
    return np.where(np.isnan(value) | np.isnan(limits).any(-1), "-", letters)
