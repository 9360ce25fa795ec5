"""Modelled against measured speeds: agreement, and calibration of the currents by a factor."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.types import FloatArray
from thalweg.operations.tracks.track_segments import SAILING_KINDS, MeasuredSegments

_MIN_LEGS = 3  # for statistics and for a calibration
_MAX_ITERATIONS = 50
_TOLERANCE = 1e-10
LARGEST_FACTOR = 10.0  #: of the search for a slope of one


@dataclass(frozen=True)
class AgreementStatistics:
    """Agreement of modelled with measured values.

    Attributes
    ----------
    slope, intercept : Of the straight line ``modelled = slope * measured + intercept`` by least
        squares; a perfect model has 1 and 0.
    r2 : Square of the correlation.
    rmse : Root of the mean square of modelled minus measured (Schless 2023, eq. 4.2).
    rmse_rel : The same over the mean of the measured values [%] (eq. 4.1).
    measured, modelled : Means.

    Notes
    -----
    NaN with fewer than three values, or values without any variation. Slope,
    intercept and r2 as in van Halem (2019), section 4.1.2, with measured values on the x-axis.
    """

    count: int
    slope: float
    intercept: float
    r2: float
    rmse: float
    rmse_rel: float
    measured: float
    modelled: float


def agreement_statistics(measured: ArrayLike, modelled: ArrayLike) -> AgreementStatistics:
    """Compare modelled values with measured ones; pairs with NaN are left out."""
    x, y = (np.asarray(v, dtype=np.float64).reshape(-1) for v in (measured, modelled))
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    nan = math.nan
    if not x.size:
        return AgreementStatistics(0, nan, nan, nan, nan, nan, nan, nan)
    rmse, mean = float(np.sqrt(np.mean((y - x) ** 2))), float(x.mean())
    across, up = x - mean, y - float(y.mean())
    wide, high = float(across @ across), float(up @ up)
    slope = intercept = r2 = nan
    if x.size >= _MIN_LEGS and wide > 1e-18 * x.size * max(mean * mean, 1e-300):
        slope = float(across @ up) / wide
        intercept = float(y.mean()) - slope * mean
        r2 = float(across @ up) ** 2 / (wide * high) if high > 1e-24 else nan
    return AgreementStatistics(
        x.size, slope, intercept, r2, rmse, 100.0 * rmse / mean, mean, float(y.mean())
    )


@dataclass(frozen=True)
class Calibration:
    """Speeds through water and the factor on the currents that explain a track best.

    Attributes
    ----------
    factor, factor_error : float
        Factor on the currents of the sea, and its standard error.
    speeds, speed_errors : dict of str to float
        Speed through water [m/s] of "sailing full" and "sailing empty", and standard errors.
    residual : float
        Root mean square of what remains [m/s].
    slope_one : float
        The factor for which the speeds of the legs, modelled over measured, have a slope of one
        (van Halem 2019, section 4.1.2); NaN if there is none up to 10.
    legs : int
        Legs with known currents.
    """

    factor: float
    factor_error: float
    speeds: dict[str, float]
    speed_errors: dict[str, float]
    residual: float
    slope_one: float
    legs: int


def speeds_through_water(segments: MeasuredSegments, factor: float) -> FloatArray:
    """Return speeds through water [m/s]: over ground less ``factor`` times the current."""
    return np.abs(segments.ground - factor * segments.current)


def calibrate(segments: MeasuredSegments) -> Calibration | None:
    """Find the speeds through water and the factor on the currents by least squares.

    Minimises the sum over segments, weighted with their time, of
    ``(|over ground - factor * current| - speed of the activity) ** 2`` (Gauss-Newton).

    Parameters
    ----------
    segments : MeasuredSegments
        Velocity over ground and current [m/s] of the sailed segments.

    Returns
    -------
    Calibration or None
        None if fewer than three legs have known currents, or the currents do not differ enough to
        determine a factor.

    Notes
    -----
    Standard errors take the legs, not the segments, as independent (sandwich estimate by clusters,
    with the usual correction for few of them); wind, waves and a captain's choice act on a whole
    leg alike.
    """
    segments = segments.part(np.isfinite(segments.current))
    legs = np.unique(segments.leg)
    if len(legs) < _MIN_LEGS:
        return None
    used = np.unique(segments.kind)
    groups = (segments.kind[:, None] == used).astype(np.float64)
    weight = segments.duration / segments.duration.mean()
    factor = 1.0
    for _ in range(_MAX_ITERATIONS):
        water = segments.ground - factor * segments.current
        speed = np.abs(water)
        along = -(water.real * segments.current.real + water.imag * segments.current.imag) / speed
        design = np.column_stack([groups, -along])
        normal = design.T @ (weight[:, None] * design)
        if np.linalg.cond(normal) > 1e12:
            return None
        solved = np.linalg.solve(normal, design.T @ (weight * (speed - along * factor)))
        change, factor = float(solved[-1]) - factor, float(solved[-1])
        if abs(change) < _TOLERANCE:
            break
    residual = speed - groups @ solved[:-1]
    errors = _errors(design, weight * residual, np.linalg.inv(normal), segments.leg)
    names = [SAILING_KINDS[k] for k in used]
    return Calibration(
        factor=factor,
        factor_error=float(errors[-1]),
        speeds=dict(zip(names, solved[:-1].tolist())),
        speed_errors=dict(zip(names, errors[:-1].tolist())),
        residual=float(np.sqrt(np.average(residual**2, weights=weight))),
        slope_one=_factor_for_unit_slope(segments),
        legs=len(legs),
    )


def _errors(
    design: FloatArray, score: FloatArray, inverse: FloatArray, leg: NDArray[np.int64]
) -> FloatArray:
    """Return standard errors with legs as clusters."""
    _, index = np.unique(leg, return_inverse=True)
    count = int(index.max()) + 1
    sums = np.zeros((count, design.shape[1]))
    np.add.at(sums, index, design * score[:, None])
    few = count / max(1, count - design.shape[1])
    return np.sqrt(np.diag(inverse @ (sums.T @ sums) @ inverse) * few)


def mean_speeds(segments: MeasuredSegments, factor: float) -> FloatArray:
    """Return the mean speed through water of the activity of every segment [m/s]."""
    speed = speeds_through_water(segments, factor)
    known = np.isfinite(speed)
    duration = np.where(known, segments.duration, 0.0)
    kinds = len(SAILING_KINDS)
    length = np.bincount(segments.kind, np.where(known, speed, 0.0) * duration, minlength=kinds)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = length / np.bincount(segments.kind, duration, minlength=kinds)
    return np.asarray(mean[segments.kind])


def speeds_over_ground(segments: MeasuredSegments, water: ArrayLike, factor: float) -> FloatArray:
    """Return the speed over ground [m/s] on the measured course at a speed through water.

    NaN where the ship cannot hold the course or the current is unknown.
    """
    along_cross = factor * segments.current * np.conj(segments.ground / np.abs(segments.ground))
    speed = np.asarray(water, dtype=np.float64)
    with np.errstate(invalid="ignore"):
        found = np.sqrt(speed**2 - along_cross.imag**2) + along_cross.real
        return np.where(found > 0.0, found, np.nan)


def leg_speeds(segments: MeasuredSegments, speed: ArrayLike) -> FloatArray:
    """Return the speed over each leg [m/s]: its length over its duration at given speeds."""
    lengths = segments.speed * segments.duration
    _, length = segments.sum_by_leg(lengths)
    _, time = segments.sum_by_leg(lengths / np.asarray(speed, dtype=np.float64))
    return np.asarray(length / time)


def _factor_for_unit_slope(segments: MeasuredSegments) -> float:
    """Return the factor on the currents for which the legs' spread has a slope of one."""
    measured = leg_speeds(segments, segments.speed)

    def excess(factor: float) -> float:
        model = speeds_over_ground(segments, mean_speeds(segments, factor), factor)
        return agreement_statistics(measured, leg_speeds(segments, model)).slope - 1.0

    factors = np.linspace(0.0, LARGEST_FACTOR, 101)
    values = np.array([excess(float(f)) for f in factors])
    crossings = np.flatnonzero((values[:-1] <= 0.0) & (values[1:] > 0.0))
    if not crossings.size:
        return math.nan
    low, high = factors[crossings[0]], factors[crossings[0] + 1]
    for _ in range(_MAX_ITERATIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(float(middle)) <= 0.0 else (low, middle)
    return float(0.5 * (low + high))
