"""Compass search: points try steps in eight directions, where derivatives do not help.

Direct search by patterns (Kolda, Lewis & Torczon 2003, "Optimization by direct search", SIAM Review
45, 385-482). It needs no derivatives, so coasts, closed cells and depth contours may bind.
"""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.geodesy import METRES_PER_DEGREE, rough_lengths, wrap_longitude
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.leg import population_sailing as columns
from thalweg.kernels.leg.population_sailing import LAT, LON
from thalweg.route.evaluators.polyline import Polyline, PolylineEvaluator
from thalweg.route.evaluators.population import concatenated_populations
from thalweg.route.evaluators.time_evaluator import (
    TrackBatch,
)
from thalweg.route.refinement.point_edits import isolated_maxima, trial_subsets
from thalweg.route.refinement.scored_tracks import (
    ScoredTracks,
    delay_effects,
    legs_as_tracks,
    sail_legs_alone,
)
from thalweg.route.refinement.track_geometry import displaced_positions

_DIRECTIONS = 8
_INITIAL_STEP_SHARE = 0.3  # first step, as a share of the shorter adjacent leg
_GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))  # by which the directions turn every round


def compass_search(
    line: Polyline,
    evaluator: PolylineEvaluator,
    *,
    rounds: int = 30,
    smallest: float = 1.0,
) -> Polyline:
    """Return a line with waypoints moved where that lowers the cost.

    Parameters
    ----------
    line : Polyline
        One that can be sailed; any other is returned unchanged.
    evaluator : TimeEvaluator or CostEvaluator
    rounds : int
        Rounds over all waypoints at most.
    smallest : float
        The search ends when all steps are shorter than this [m].

    Notes
    -----
    Every second waypoint moves at a time, each compared on its two adjacent legs alone: an earlier
    arrival at the next waypoint is never worse at the goal. Steps grow by 1.3 after a gain and
    halve otherwise.
    """
    if len(line) < 3 or not math.isfinite(evaluator.sail(line.batch())[1][0]):
        return line
    lengths = rough_lengths(line.lat, line.lon)
    step = np.zeros(len(line))
    step[1:-1] = _INITIAL_STEP_SHARE * np.minimum(lengths[:-1], lengths[1:])
    step[line.required_points(evaluator)] = 0.0
    for number in range(rounds):
        for colour in (1, 2):
            moving = np.arange(colour, len(line) - 1, 2)
            moving = moving[step[moving] >= max(smallest, 1e-9)]
            if moving.size:
                line, moved = _try_steps(line, evaluator, moving, step, number)
                step[moving] *= np.where(moved, 1.3, 0.5)
        if step.max() < smallest:
            break
    return line


def _try_steps(
    line: Polyline,
    evaluator: PolylineEvaluator,
    moving: np.ndarray,
    step: FloatArray,
    number: int,
) -> tuple[Polyline, np.ndarray]:
    """Move each of some waypoints to the best of its trial positions; return also which moved."""
    angle = number * _GOLDEN_ANGLE + np.arange(_DIRECTIONS) * (2.0 * math.pi / _DIRECTIONS)
    east = np.concatenate([[0.0], np.sin(angle)])
    north = np.concatenate([[0.0], np.cos(angle)])
    trials = len(east)
    arrive, _ = evaluator.sail(line.batch())
    lat = np.repeat(_adjacent_triples(line.lat, moving), trials, axis=0)
    lon = np.repeat(_adjacent_triples(line.lon, moving), trials, axis=0)
    size = np.repeat(step[moving], trials)
    lat[:, 1] += size * np.tile(north, len(moving)) / METRES_PER_DEGREE
    scale = METRES_PER_DEGREE * np.cos(np.radians(lat[:, 0]))
    lon[:, 1] += size * np.tile(east, len(moving)) / scale
    batch = TrackBatch(
        lat,
        lon,
        np.repeat(_adjacent_triples(line.leave, moving), trials, axis=0),
        np.repeat(np.stack([line.setting[moving - 1], line.setting[moving]], 1), trials, axis=0),
        np.repeat(arrive[0, moving - 1], trials),
    )
    _, cost = evaluator.sail(batch)
    cost = cost.reshape(len(moving), trials)
    pick = np.argmin(cost, axis=1)
    row = np.arange(len(moving))
    with np.errstate(invalid="ignore"):  # a line that cannot be sailed never arrives
        spent = cost[:, 0] - (0.0 if evaluator.by_length else arrive[0, moving - 1])
    slack = 1e-10 * np.where(np.isfinite(spent), np.abs(spent), 0.0)
    moved = cost[row, pick] + slack < cost[:, 0]
    chosen = (row * trials + pick)[moved]
    new_lat, new_lon = line.lat.copy(), line.lon.copy()
    new_lat[moving[moved]], new_lon[moving[moved]] = lat[chosen, 1], lon[chosen, 1]
    return line.moved(new_lat, new_lon), moved


def _adjacent_triples(values: FloatArray, moving: np.ndarray) -> FloatArray:
    return np.stack([values[moving - 1], values[moving], values[moving + 1]], axis=1)


def compass_search_of_tracks(lines: ScoredTracks, *, radius: float) -> ScoredTracks:
    """Return tracks after a trial step of each of their points in eight directions.

    Parameters
    ----------
    lines : ScoredTracks
    radius : float
        Step as a share of the mean length of the two adjacent legs.

    Returns
    -------
    ScoredTracks
        With costs that are not higher than before.
    """
    row, place = np.nonzero(lines.free)
    if not len(row):
        return lines
    lengths = lines.lengths()
    reach = radius * 0.5 * (lengths[row, place - 1] + lengths[row, place])
    angle = 2.0 * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    point = lines.population.genes[row, place][:, None, :]
    lat, lon = displaced_positions(
        point[..., LAT],
        point[..., LON],
        reach[:, None] * np.sin(angle),
        reach[:, None] * np.cos(angle),
    )
    lat, lon = np.clip(lat, -90.0, 90.0), wrap_longitude(lon)
    value, base = _moved_values(lines, row, place, lat, lon)
    best = np.argmin(value, axis=1)
    every = np.arange(len(row))
    gain = np.zeros(lengths.shape)
    gain[row, place] = np.where(np.isfinite(base), base, 0.0) - value[every, best]
    gain[~np.isfinite(gain)] = 0.0
    target = np.zeros((*lengths.shape, 2))
    target[row, place] = np.stack([lat[every, best], lon[every, best]], axis=1)
    trials, rows = [], []
    for chosen, index in trial_subsets(isolated_maxima(gain)):
        copy = lines.population.take(index)
        copy.genes[:, :, LAT][chosen] = target[index, :, 0][chosen]
        copy.genes[:, :, LON][chosen] = target[index, :, 1][chosen]
        touched = chosen.copy()
        touched[:, :-1] |= chosen[:, 1:]
        copy.genes[:, :, columns.IS_LOOKED_UP][touched] = 0.0
        trials.append(copy)
        rows.append(index)
    return (
        lines.chosen(concatenated_populations(*trials), np.concatenate(rows)) if trials else lines
    )


@np.errstate(invalid="ignore")  # infinite where a leg cannot be sailed
def _moved_values(
    lines: ScoredTracks, row: IntArray, place: IntArray, lat: FloatArray, lon: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the value of the legs beside points (P,) at trial positions (P, D), and unmoved."""
    late = delay_effects(lines).priced(lines.price)
    times = lat.shape[1]
    total, base = np.zeros(lat.shape), np.zeros(len(row))
    for first, end in ((place - 1, 1), (place, 0)):
        pairs, depart = legs_as_tracks(lines, row, first)
        still = sail_legs_alone(lines.evaluator, pairs, depart)
        base += still[1] + late[row, first + 1] * still[0]
        every = np.repeat(pairs, times, axis=0)
        every[:, end, LAT], every[:, end, LON] = lat.ravel(), lon.ravel()
        every[:, 0, columns.IS_LOOKED_UP] = 0.0
        time, cost = sail_legs_alone(lines.evaluator, every, np.repeat(depart, times))
        value = cost + np.repeat(late[row, first + 1], times) * time
        total += value.reshape(lat.shape)
    return total, base
