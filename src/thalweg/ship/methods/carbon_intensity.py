"""Carbon indicators of a ship: attained and required CII, rating, EEOI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array


@dataclass(frozen=True)
class ReferenceBand:
    """One line of the reference table: a capacity^-c for capacities from ``least`` on.

    Parameters
    ----------
    least : float
        Smallest capacity of the band.
    a, c : float
        Constants of the line.
    fixed_capacity : float
        Capacity the line is read at, whatever the ship's; NaN for the ship's own.
    verified : bool
        Whether the numbers were checked beyond memory.
    note : str
        What else must be known.
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
    capacity : str
        ``dwt`` or ``gt``.
    bands : tuple of ReferenceBand
        By falling capacity.
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

_LNG_NOTE = (
    "MEPC.353(78) is transcribed with 14779E10 below 65 000 t and 14479E10 above; MEPC.337(76) "
    "with 14479E10 in both, so the first may be a slip of the pen (2 % higher line)"
)


def _single_band_ship_type(
    capacity: str, a: float, c: float, d: tuple[float, float, float, float]
) -> CiiShipType:
    return CiiShipType(capacity, (ReferenceBand(0.0, a, c),), ((0.0, d),))


#: Ship type -> its lines.
SHIP_TYPES: Final[Mapping[str, CiiShipType]] = MappingProxyType(
    {
        "bulk_carrier": CiiShipType(
            "dwt",
            (ReferenceBand(279_000.0, 4745.0, 0.622, 279_000.0), ReferenceBand(0.0, 4745.0, 0.622)),
            ((0.0, (0.86, 0.94, 1.06, 1.18)),),
        ),
        "gas_carrier": CiiShipType(
            "dwt",
            (ReferenceBand(65_000.0, 14405e7, 2.071), ReferenceBand(0.0, 8104.0, 0.639)),
            ((65_000.0, (0.81, 0.91, 1.12, 1.44)), (0.0, (0.85, 0.95, 1.06, 1.25))),
        ),
        "tanker": _single_band_ship_type("dwt", 5247.0, 0.610, (0.82, 0.93, 1.08, 1.28)),
        "container_ship": _single_band_ship_type("dwt", 1984.0, 0.489, (0.83, 0.94, 1.07, 1.19)),
        "general_cargo_ship": CiiShipType(
            "dwt",
            (ReferenceBand(20_000.0, 31948.0, 0.792), ReferenceBand(0.0, 588.0, 0.3885)),
            ((0.0, (0.83, 0.94, 1.06, 1.19)),),
        ),
        "refrigerated_cargo_carrier": _single_band_ship_type(
            "dwt", 4600.0, 0.557, (0.78, 0.91, 1.07, 1.20)
        ),
        "combination_carrier": _single_band_ship_type(
            "dwt", 5119.0, 0.622, (0.87, 0.96, 1.06, 1.14)
        ),
        "lng_carrier": CiiShipType(
            "dwt",
            (
                ReferenceBand(100_000.0, 9.827, 0.0),
                ReferenceBand(65_000.0, 14479e10, 2.673),
                ReferenceBand(0.0, 14779e10, 2.673, 65_000.0, verified=False, note=_LNG_NOTE),
            ),
            ((100_000.0, (0.89, 0.98, 1.06, 1.13)), (0.0, (0.78, 0.92, 1.10, 1.37))),
        ),
        "vehicle_carrier": CiiShipType(
            "gt",
            (
                ReferenceBand(57_700.0, 3627.0, 0.590, 57_700.0),
                ReferenceBand(30_000.0, 3627.0, 0.590),
                ReferenceBand(0.0, 330.0, 0.329),
            ),
            ((0.0, (0.86, 0.94, 1.06, 1.16)),),
        ),
        "ro_ro_cargo_ship": _single_band_ship_type("gt", 1967.0, 0.485, (0.76, 0.89, 1.08, 1.27)),
        "ro_ro_passenger_ship": _single_band_ship_type(
            "gt", 2023.0, 0.460, (0.76, 0.92, 1.14, 1.30)
        ),
        "high_speed_ro_ro_passenger_craft": _single_band_ship_type(
            "gt", 4196.0, 0.460, (0.76, 0.92, 1.14, 1.30)
        ),
        "cruise_passenger_ship": _single_band_ship_type(
            "gt", 930.0, 0.383, (0.87, 0.95, 1.06, 1.16)
        ),
    }
)

#: Reduction Z [%] of the required CII below the 2019 reference line by year.
REDUCTION_PERCENT: Final[Mapping[int, float]] = MappingProxyType(
    {
        2019: 0.0,
        2020: 1.0,
        2021: 2.0,
        2022: 3.0,
        2023: 5.0,
        2024: 7.0,
        2025: 9.0,
        2026: 11.0,
        2027: 13.625,
        2028: 16.25,
        2029: 18.875,
        2030: 21.5,
    }
)


def cii_ship_type(name: str) -> CiiShipType:
    """Return a ship type of the CII guidelines by name.

    Parameters
    ----------
    name : str
        A key of `SHIP_TYPES`.

    Returns
    -------
    CiiShipType
        Its lines.

    Raises
    ------
    InputError
        For an unknown name, with near matches.
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
    co2 : array_like
        CO2 of each voyage [kg]; ballast voyages count with no cargo.
    cargo_t : array_like
        Cargo of each voyage [t].
    distance_nm : array_like
        Distance with that cargo [nm].

    Returns
    -------
    ndarray
        g CO2 per (t nm), summed over the last axis; NaN where no cargo was moved.

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
    ship_type : str
        A key of `SHIP_TYPES`.
    capacity : array_like
        Deadweight [t] or gross tonnage as `SHIP_TYPES` says.

    Returns
    -------
    ndarray
        g CO2 per (t nm); NaN where the capacity is not positive.

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
    year : int
        2019 to 2030.

    Returns
    -------
    float
        Percent below the 2019 line.

    Raises
    ------
    InputError
        For a year without an adopted factor.

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
    ship_type : str
        A key of `SHIP_TYPES`.
    capacity : array_like
        Deadweight [t] or gross tonnage.
    year : int
        2019 to 2030.

    Returns
    -------
    ndarray
        g CO2 per (t nm).

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
    ship_type : str
        A key of `SHIP_TYPES`.
    capacity : array_like
        Deadweight [t] or gross tonnage.
    year : int
        2019 to 2030.

    Returns
    -------
    ndarray
        g CO2 per (t nm); the four boundaries are the last axis.

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
    attained : array_like
        Attained CII [g CO2 per (t nm)].
    ship_type : str
        A key of `SHIP_TYPES`.
    capacity : array_like
        Deadweight [t] or gross tonnage.
    year : int
        2019 to 2030.

    Returns
    -------
    ndarray of str
        ``A`` to ``E``; ``-`` where the attained CII is unknown. A value on a boundary has the
        better rating.

    References
    ----------
    MEPC.354(78) (G4), section 4.
    """
    value = as_float_array(attained)
    limits = rating_boundaries(ship_type, capacity=capacity, year=year)
    above = (value[..., None] > limits).sum(-1)
    letters = np.array(["A", "B", "C", "D", "E"])[above]
    return np.where(np.isnan(value) | np.isnan(limits).any(-1), "-", letters)
