"""Harmonic analysis: tidal constituents of a record, or of a model run at every node.

Unit phasors (`thalweg.sea.tides.constituents.unit_phasors`, with UTide's arguments and nodal
corrections at exact times) are fitted to the record by least squares, together with a mean and
without trend. This is what ``utide.solve(..., method="ols", trend=False)`` solves for one series;
here all nodes are solved at once, because nodes with values at the same times share their
equations.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import HOUR
from thalweg.sea.tides import foreman
from thalweg.sea.tides.constituents import Constituents, unit_phasors

ProgressCallback = Callable[[int, int], None]

RAYLEIGH: Final = 1.0  #: least separation of two constituents [cycles over the record]
MIN_KNOWN_FRACTION: Final = 0.5  #: fraction of the record that must be known at a node
NODES_PER_BLOCK: Final = 1024  #: nodes whose series are in memory as float64 at a time
MAX_CONDITION_NUMBER: Final = 1e5  #: of the equations, above which the constants are not determined


@dataclass(frozen=True, eq=False)
class TideAnalysis:
    """The result of a harmonic analysis.

    Attributes
    ----------
    constituents : The constants.
    tidal_share : mapping of str to float64 array (N,)
        Fraction of the variance of the record that the tide explains, by variable and node.
    variance : Variance of the record, (N,).
    start, end : First and last time of the record [s since epoch].
    """

    constituents: Constituents
    tidal_share: Mapping[str, FloatArray]
    variance: Mapping[str, FloatArray]
    start: float
    end: float

    def share(self, variable: str | None = None) -> float:
        """Return the tidal fraction of variance over all nodes (and variables, by default)."""
        names = [variable] if variable else list(self.variance)
        total = sum(float(np.nansum(self.variance[n])) for n in names)
        tidal = sum(float(np.nansum(self.variance[n] * self.tidal_share[n])) for n in names)
        return tidal / total if total > 0.0 else float("nan")


def analyse(
    times: ArrayLike,
    series: Mapping[str, ArrayLike],
    *,
    lat: ArrayLike,
    lon: ArrayLike = np.nan,
    constituents: Sequence[str] | None = None,
    rayleigh: float = RAYLEIGH,
    progress: ProgressCallback | None = None,
) -> TideAnalysis:
    r"""Return the tidal constituents of records.

    Amplitudes A and Greenwich phase lags g are those that minimise the sum of squares of

    .. math:: \eta(t) - \bar{\eta} - \sum_c f_c A_c \cos(V_c(t) + u_c - g_c)

    Parameters
    ----------
    times : Strictly increasing [s since 1970-01-01T00:00Z], (T,); steps may differ.
    series : mapping of str to array_like (T,) or (N, T)
        Records by variable, NaN where unknown; nodes known less than half of the time get no tide.
    lat, lon : Positions [deg], (N,); their mean latitude is used for nodal corrections.
    constituents : Names as UTide spells them; by default all that the length and step of the record
        can separate, in the order of priority of Foreman (1977).
    rayleigh : Rayleigh criterion: least difference of two constituents [cycles] over the record.
    progress : Called with the number of nodes done and in total.

    Raises
    ------
    InputError : If the record is too short or too coarse for the constituents named (the message
        gives the pairs and the lengths needed), or if times do not increase.

    References
    ----------
    .. [1] Foreman, M.G.G. (1977). *Manual for Tidal Heights Analysis and Prediction*. Pacific
       Marine Science Report 77-10.
    .. [2] Codiga, D.L. (2011). *Unified Tidal Analysis and Prediction Using the UTide Matlab
       Functions*. Technical Report 2011-01, University of Rhode Island.
    """
    moments = np.asarray(times, np.float64).ravel()
    records = {n: np.atleast_2d(np.asarray(v)) for n, v in series.items()}
    _check_record(moments, records)
    names = select_constituents(moments, constituents, rayleigh)
    nodes = max((v.shape[0] for v in records.values()), default=0)
    place = [np.broadcast_to(np.asarray(a, np.float64), (nodes,)).copy() for a in (lat, lon)]
    blank: dict[str, FloatArray] = {}
    empty = Constituents(names, blank, blank, blank, place[0], place[1], "foreman")
    wave = unit_phasors(names, moments, empty.latitude, "foreman")
    design = np.column_stack([np.ones(moments.size), wave.real, -wave.imag])
    done, total = 0, nodes * len(records)
    components = {}
    for name, values in records.items():

        def report(count: int, before: int = done) -> None:
            if progress is not None:
                progress(before + count, total)

        components[name] = _fit(design, values, report)
        done += nodes
    return _analysis(empty, components, moments)


def _analysis(
    empty: Constituents, components: Mapping[str, tuple[FloatArray, FloatArray, FloatArray]],
    times: FloatArray,
) -> TideAnalysis:  # fmt: skip
    count = len(empty.names)
    waves = {n: f[0][1 : count + 1] + 1j * f[0][count + 1 :] for n, f in components.items()}
    constants = Constituents(
        empty.names,
        {n: np.abs(w) for n, w in waves.items()},
        {n: np.degrees(-np.angle(w)) % 360.0 for n, w in waves.items()},
        {n: f[0][0] for n, f in components.items()},
        empty.lat,
        empty.lon,
        "foreman",
        {"method": "least squares, nodal corrections at exact times, no trend"},
    )
    return TideAnalysis(
        constants,
        {n: f[1] for n, f in components.items()},
        {n: f[2] for n, f in components.items()},
        float(times[0]),
        float(times[-1]),
    )


def _fit(
    design: FloatArray, values: FloatArray, report: Callable[[int], None]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return solutions (columns of the design, N), tidal shares and variances (N,)."""
    nodes = values.shape[0]
    solution = np.full((nodes, design.shape[1]), np.nan)
    share, variance = np.full(nodes, np.nan), np.full(nodes, np.nan)
    whole = design.T @ design
    _check_condition(whole)
    needed = max(MIN_KNOWN_FRACTION * design.shape[0], design.shape[1] + 1)
    with ThreadPoolExecutor(max_workers=min(4, os.cpu_count() or 1)) as pool:
        for first in range(0, nodes, NODES_PER_BLOCK):
            part = slice(first, min(first + NODES_PER_BLOCK, nodes))
            block = np.asarray(values[part], np.float64)
            known = np.isfinite(block)
            groups = list(_rows_by_gaps(known, needed))
            squares = list(pool.map(partial(_normal_matrix, design, whole, known), groups))
            good = [(g, q) for g, q in zip(groups, squares) if q is not None]
            solved = _solve(design, block, known, good)
            solution[part], share[part], variance[part] = solved
            report(part.stop)
    return solution.T, share, variance


def _rows_by_gaps(known: BoolArray, needed: float) -> Iterator[NDArray[np.int64]]:
    """Return groups of rows with values at the same times, without rows with too few values."""
    enough = np.flatnonzero(known.sum(axis=1) >= needed)
    packed = np.packbits(known[enough], axis=1)
    _, group = np.unique(packed, axis=0, return_inverse=True)
    order = np.argsort(group.ravel(), kind="stable")
    ends = np.flatnonzero(np.diff(group.ravel()[order])) + 1
    yield from (enough[rows] for rows in np.split(order, ends) if rows.size)


def _normal_matrix(
    design: FloatArray, whole: FloatArray, known: BoolArray, rows: NDArray[np.int64]
) -> FloatArray | None:
    """Return the normal matrix of rows that share their gaps; None if it is ill-conditioned."""
    there = known[rows[0]]
    if there.all():
        return whole
    if 2 * int(there.sum()) > there.size:
        gaps = design[~there]
        square = whole - gaps.T @ gaps
    else:
        kept = design[there]
        square = kept.T @ kept
    spread = np.linalg.eigvalsh(square)
    return square if spread[0] * MAX_CONDITION_NUMBER**2 > spread[-1] else None


def _solve(
    design: FloatArray,
    block: FloatArray,
    known: BoolArray,
    groups: Sequence[tuple[NDArray[np.int64], FloatArray]],
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return solutions (N, columns), shares and variances of a block of nodes.

    Each solution is refined once to recover the precision that normal equations lose.
    """
    count = np.maximum(known.sum(axis=1), 1)
    start = np.where(known, block, 0.0).sum(axis=1) / count
    left = np.where(known, block - start[:, None], 0.0)
    variance = (left**2).sum(axis=1) / count
    x = np.full((block.shape[0], design.shape[1]), np.nan)
    for rows, _ in groups:
        x[rows] = 0.0
    for _ in range(2):
        right = left @ design
        step = np.zeros_like(x)
        for rows, square in groups:
            step[rows] = np.linalg.solve(square, right[rows].T).T
        x += step
        left -= np.where(known, step @ design.T, 0.0)
    x[:, 0] += start
    spare = (left**2).sum(axis=1) / count - (left.sum(axis=1) / count) ** 2
    solved = np.isfinite(x[:, 0]) & (variance > 0.0)
    share = np.full(block.shape[0], np.nan)
    share[solved] = 1.0 - spare[solved] / variance[solved]
    variance[~np.isfinite(x[:, 0])] = np.nan
    return x, share, variance


def select_constituents(
    times: FloatArray, wanted: Sequence[str] | None, rayleigh: float = RAYLEIGH
) -> tuple[str, ...]:
    """Return the constituents that a record can separate, or check those that are given.

    Parameters
    ----------
    times : Times of the record [s since epoch], (T,).
    wanted : Constituents to check; None to select them.
    rayleigh : Rayleigh criterion [cycles over the record].

    Raises
    ------
    InputError : If the record is too short or too coarse.
    """
    if times.size < 3:
        raise InputError(
            f"{times.size} time(s) are too few for harmonic analysis.",
            "M2 alone needs 13 h, M2 and S2 need 355 h, the usual set 30 days.",
            "Give a longer record.",
        )
    step = float(np.median(np.diff(times))) / HOUR
    length = float(times[-1] - times[0]) / HOUR + step
    fastest = 0.5 / step
    table = foreman.constituent_table()
    if wanted is None:
        fits = (table.separation * length >= rayleigh) & (table.frequency < fastest)
        names = tuple(n for n, k in table.index.items() if fits[k] and n != "Z0")
        if not names:
            raise InputError(
                f"A record of {length:.1f} h is too short to separate tidal constituents.",
                "M2 alone needs 13 h, M2 and S2 need 355 h, the usual set 30 days.",
                "Give a longer record.",
            )
        return names
    names = tuple(dict.fromkeys(n.strip().upper() for n in wanted))
    if not names or "Z0" in names:
        raise InputError(
            "No constituent is named." if not names else "Z0 is the mean, which is always fitted.",
            "Constituents such as M2 and S2 can be named.",
            "Name constituents, or omit the option." if not names else "Omit Z0.",
        )
    check_rayleigh(names, length, rayleigh)
    coarse = [n for n in names if foreman.frequency(n) >= fastest]
    if coarse:
        raise InputError(
            f"Steps of {step:g} h are too coarse for {', '.join(coarse)}.",
            f"Constituents with periods of more than {2.0 * step:g} h can be analysed.",
            "Omit those constituents, or give a record with shorter steps.",
            constituents=coarse,
        )
    return names


def check_rayleigh(names: Sequence[str], length_h: float, rayleigh: float = RAYLEIGH) -> None:
    """Check that a record is long enough to separate constituents from each other and the mean.

    Parameters
    ----------
    length_h : Length of the record [h].
    rayleigh : Least difference of two constituents [cycles over the record].

    Raises
    ------
    InputError : If it is not; the message gives the pairs and the length of record they need.
    """
    known = [(n, foreman.frequency(n)) for n in names]
    known = sorted([("the mean", 0.0), *known], key=lambda pair: pair[1])
    close = []
    for (a, fa), (b, fb) in pairwise(known):
        if (fb - fa) * length_h < rayleigh * (1.0 - 1e-6):
            close.append((a, b, rayleigh / (fb - fa) if fb > fa else np.inf))
    if not close:
        return
    listed = "; ".join(f"{a} and {b} need {need / 24.0:.1f} days" for a, b, need in close)
    raise InputError(
        f"A record of {length_h / 24.0:.1f} days is too short to separate: {listed} "
        f"(Rayleigh criterion {rayleigh:g}).",
        f"For all of them the record must be {max(c[2] for c in close) / 24.0:.1f} days long.",
        "Omit the smaller of each pair, or give a longer record.",
        pairs=[[a, b] for a, b, _ in close],
        needed_h=max(c[2] for c in close),
    )


def _check_record(times: FloatArray, records: Mapping[str, NDArray[np.floating]]) -> None:
    if times.size < 3 or not np.isfinite(times).all() or not (np.diff(times) > 0.0).all():
        raise InputError(
            "The times of the record do not increase, or there are fewer than three.",
            "Each time must be later than the one before.",
            "Sort the record and remove duplicate times.",
        )
    for name, values in records.items():
        if values.ndim != 2 or values.shape[1] != times.size:
            raise InputError(
                f"The record of {name!r} has shape {values.shape} for {times.size} times.",
                "The shape must be (times,) or (nodes, times).",
                "Transpose it, or select the part of equal length.",
                field=name,
            )
        if not np.isfinite(values).any():
            raise InputError(
                f"The record of {name!r} holds no number.",
                "At least half of its values must be numbers.",
                "Check the file.",
                field=name,
            )


def _check_condition(square: FloatArray) -> None:
    worst = float(np.sqrt(np.linalg.cond(square)))
    if not worst < MAX_CONDITION_NUMBER:
        raise InputError(
            "The time steps of the record cannot separate the constituents "
            f"(condition number {worst:.1e}).",
            "For example, steps of a whole number of half days do not resolve the tide.",
            "Give a record with shorter or uneven steps, or fewer constituents.",
        )
