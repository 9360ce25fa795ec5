"""Tidal arguments and nodal corrections after Foreman (1977), with the tables of UTide.

Nodal ("satellite") corrections are computed at exact times, as in UTide (Codiga, 2011). The
optional package ``utide`` is needed.

References
----------
.. [1] Foreman, M.G.G. (1977). *Manual for Tidal Heights Analysis and Prediction*. Pacific Marine
   Science Report 77-10, Institute of Ocean Sciences, Victoria.
.. [2] Codiga, D.L. (2011). *Unified Tidal Analysis and Prediction Using the UTide Matlab
   Functions*. Technical Report 2011-01, University of Rhode Island.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import ComplexArray, FloatArray, IntArray
from thalweg.sea.tides.astronomy import mean_longitudes


@dataclass(frozen=True, eq=False)
class ConstituentTable:
    """UTide's tables of constituents.

    Attributes
    ----------
    index : Row of each name.
    frequency : Cycles per hour, (K,).
    separation : Distance [cycles per hour] to the nearest constituent of higher priority, (K,).
    doodson : Multiples of (tau, s, h, p, N', p1) and phase [cycles], (K, 7); NaN for compounds.
    satellites : tuple of arrays
        Constituent, multiples of (p, N', p1), phase, ratio, latitude rule of each satellite.
    compounds : Constituents and multiples of each compound, by row, (int64 array, float64 array).
    """

    index: dict[str, int]
    frequency: FloatArray
    separation: FloatArray
    doodson: FloatArray
    satellites: tuple[IntArray, FloatArray, FloatArray, FloatArray, IntArray]
    compounds: dict[int, tuple[IntArray, FloatArray]]


@lru_cache(maxsize=1)
def constituent_table() -> ConstituentTable:
    """Return the tables of UTide.

    Raises
    ------
    InputError : If ``utide`` is not installed.
    """
    data = _utide_constants()
    const, sat, shallow = data.const, data.sat, data.shallow
    names = [str(n) for n in const.name]
    first = np.asarray(const.ishallow, float)
    count = np.asarray(const.nshallow, float)
    compounds = {}
    for k in np.flatnonzero(np.isfinite(first)):
        rows = int(first[k]) - 1 + np.arange(int(count[k]))
        compounds[int(k)] = (
            np.asarray(shallow.iname)[rows].astype(np.int64) - 1,
            np.asarray(shallow.coef, float)[rows],
        )
    return ConstituentTable(
        {name: k for k, name in enumerate(names)},
        np.asarray(const.freq, float),
        np.asarray(const.df, float),
        np.column_stack([const.doodson, const.semi]).astype(float),
        (
            np.asarray(sat.iconst).astype(np.int64) - 1,
            np.asarray(sat.deldood, float),
            np.asarray(sat.phcorr, float),
            np.asarray(sat.amprat, float),
            np.asarray(sat.ilatfac).astype(np.int64),
        ),
        compounds,
    )


def _utide_constants() -> Any:
    try:
        from utide._ut_constants import ut_constants  # type: ignore[import-untyped]
    except ImportError:
        raise InputError(
            "Tidal analysis, and prediction from an analysis, need the package utide, which is not "
            "installed.",
            "Published constituents can be read and predicted without it.",
            "Install it with: pip install 'thalweg[tides]'.",
            package="utide",
        ) from None
    return ut_constants


def constituent_row(name: str) -> int:
    """Return the row of a constituent in the tables."""
    index = constituent_table().index
    plain = name.strip().upper()
    if plain not in index:
        raise unknown_name_error("tidal constituent", name, index)
    return index[plain]


def frequency(name: str) -> float:
    """Return the frequency [cycles per hour] of a constituent."""
    return float(constituent_table().frequency[constituent_row(name)])


def equilibrium_arguments(names: tuple[str, ...], times: FloatArray) -> FloatArray:
    r"""Return the equilibrium arguments at Greenwich.

    .. math:: V = i_1 \tau + i_2 s + i_3 h + i_4 p + i_5 N' + i_6 p_1 + \text{phase}

    with the Doodson numbers i of the constituent and :math:`\tau = T + h - s` (Foreman, 1977). A
    compound has the sum of the arguments of its constituents.

    Parameters
    ----------
    names : C constituents, as UTide spells them.
    times : Seconds since 1970-01-01T00:00Z, (T,).

    Returns
    -------
    float64 array (T, C) : V [cycles].
    """
    table, longitude = constituent_table(), mean_longitudes(times)
    longitude[0] = longitude[0] + longitude[2] - longitude[1]
    columns = []
    for name in names:
        k = constituent_row(name)
        members, multiples = table.compounds.get(k, (np.array([k]), np.ones(1)))
        value = np.zeros(times.size)
        for member, multiple in zip(members, multiples):
            line = table.doodson[member]
            value += multiple * np.fmod(line[:6] @ longitude + line[6], 1.0)
        columns.append(value)
    return np.stack(columns, axis=1) if columns else np.empty((times.size, 0))


def nodal_corrections(names: tuple[str, ...], times: FloatArray, latitude: float) -> ComplexArray:
    r"""Return the nodal corrections.

    .. math:: f e^{i u} = 1 + \sum_k r_k e^{2 \pi i (\Delta_k \cdot (p, N', p_1) + \phi_k)}

    over the satellites k of a constituent, with amplitude ratio r (corrected for latitude for
    diurnal and semidiurnal satellites), differences of Doodson numbers :math:`\Delta` and phase
    correction :math:`\phi` (Foreman, 1977). A compound has the product of its constituents'
    corrections.

    Parameters
    ----------
    names : C constituents, as UTide spells them.
    times : Seconds since 1970-01-01T00:00Z, (T,).
    latitude : Latitude [deg]; within 5 deg of the equator that of 5 deg is used.

    Returns
    -------
    complex128 array (T, C) : f exp(i u).
    """
    table = constituent_table()
    columns = []
    for name in names:
        k = constituent_row(name)
        members, multiples = table.compounds.get(k, (np.array([k]), np.ones(1)))
        value = np.ones(times.size, np.complex128)
        for member, multiple in zip(members, multiples):
            factor = _satellite_correction(int(member), times, latitude)
            turn = np.exp(1j * multiple * np.angle(factor))
            value *= np.abs(factor) ** abs(multiple) * turn
        columns.append(value)
    return np.stack(columns, axis=1) if columns else np.empty((times.size, 0), np.complex128)


def _satellite_correction(k: int, times: FloatArray, latitude: float) -> ComplexArray:
    constituent, multiples, phase, ratio, rule = constituent_table().satellites
    own = constituent == k
    if not own.any():
        return np.ones(times.size, np.complex128)
    sine = np.sin(np.radians(np.copysign(max(abs(latitude), 5.0), latitude)))
    size = ratio[own] * np.select(
        [rule[own] == 1, rule[own] == 2],
        [0.36309 * (1.0 - 5.0 * sine**2) / sine, 2.59808 * sine],
        1.0,
    )
    turn = multiples[own] @ mean_longitudes(times)[3:6] + phase[own][:, None]
    return 1.0 + (size[:, None] * np.exp(2j * np.pi * turn)).sum(axis=0)
