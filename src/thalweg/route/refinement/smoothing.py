"""Smoothing: from a path on a network to a track that is free of it, and faster."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import rough_lengths
from thalweg.core.limits import Limits
from thalweg.deprecated_names import limits_as_array
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.route.canal_legs import canal_legs, sea_stretches
from thalweg.route.evaluators.cost_evaluator import CostEvaluator
from thalweg.route.evaluators.polyline import (
    Polyline,
    PolylineEvaluator,
    polyline_of_track,
    track_of_polyline,
)
from thalweg.route.evaluators.time_evaluator import (
    make_time_evaluator,
)
from thalweg.route.refinement.corner_cutting import cut_corners, merge_short_legs
from thalweg.route.refinement.sailed_polyline import optimise_line_offsets, search_line_positions
from thalweg.route.refinement.string_pulling import string_pull
from thalweg.route.refinement.track_geometry import turning_losses
from thalweg.route.track import Track

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import GridFields
    from thalweg.ship import PerformanceTable

MAX_LEGS = 160  #: legs are split until they are shorter than the track divided by this at most
SIMPLIFICATION_LOSS = (
    2e-6  #: share of the cost that may be lost by leaving waypoints out at the end
)
_SIMPLIFICATION_SKIP = 16  # waypoints at most that one leg replaces at the end
_TURNING_LOSS = 3e-6  # share of the cost that straight legs may lose to a curve
_FINER_LEVELS = 4  # levels at most that halve the legs of turns only
_FINER_GAIN_TOLERANCE = 5e-7  # relative gain of such a level below which no finer one is tried
_LEVEL_GAIN_TOLERANCE = (
    5e-5  # relative gain of a level below which no finer one is tried: a third of it is left
)
_COARSE_START_TOLERANCE = (
    1.02  # a coarse resampling is refined too if it costs no more than this times the track
)
_MAX_WAITS_TRIED = 48
_MIN_LEG_SHARE = 2e-5  # legs below this share of the track are merged with a neighbour


@limits_as_array
def smooth(
    track: Track,
    *,
    table: PerformanceTable | TableArrays,
    fields: GridFields,
    limits: Limits,
    chart: Chart | None = None,
    objective: str = "time",
    wait: bool | None = None,
    finest: int = MAX_LEGS,
) -> Track:
    """Return a better track than a given one, with the same passages between obstacles.

    Parameters
    ----------
    track : Track
        One that can be sailed, such as a path on a network.
    table : PerformanceTable or TableArrays
        Speed through water.
    fields : GridFields
        The sea frozen around the track.
    limits : Limits
        Limits along the route (`thalweg.core.limits.Limits`).
    chart : Chart, optional
        Land, zones and charted depth that the track must avoid.
    objective : {"time", "distance"}
    wait : bool, optional
        Whether the ship may wait where it did not before; by default only if it waits somewhere.
    finest : int
        Legs are split until they are shorter than the track divided by this.

    Returns
    -------
    Track
        The given track if no better one is found, or if it cannot be sailed through these fields.
        Tracks are compared on frozen fields; the referee evaluates them (see `better_route`).

    Notes
    -----
    First string pulling over the waypoints. Then, level by level, legs are halved and the waypoints
    moved sideways by Newton's method, and by compass search where obstacles bind. Then the legs
    of turns are halved until straight legs lose less than 3e-6 of the cost, and at last waypoints
    are removed that together lower the cost by less than a share of 2e-6.
    """
    if canal_legs(track, chart).any:
        smoothed = partial(
            smooth,
            table=table,
            fields=fields,
            limits=limits,
            chart=chart,
            objective=objective,
            wait=wait,
            finest=finest,
        )
        return _smooth_between_canals(
            track, chart, smoothed, _duration_function(table, fields, limits)
        )
    evaluator = make_time_evaluator(
        table=table,
        chart=chart,
        fields=fields,
        limits=limits,
        origin=track.depart,
        by_length=objective == "distance",
        total=float(track.lengths.sum()),
        wait=bool(track.wait.any()) if wait is None else wait,
    )
    first = polyline_of_track(track, evaluator)
    if not math.isfinite(_cost(first, evaluator)):
        first = _made_feasible(first, evaluator)
        if not math.isfinite(_cost(first, evaluator)):
            return track
    line = string_pull(first, evaluator)
    if _may_be_constrained(evaluator):
        line = cut_corners(line, evaluator)
    line = _shortened_waits(line, evaluator)
    if evaluator.by_length:  # sideways moves cannot shorten it
        best = _simplified(search_line_positions(line, evaluator), evaluator)
    else:
        lines = [
            _refine_by_levels(start, evaluator, finest)
            for start in _initial_polylines(first, line, evaluator)
        ]
        best = min(lines, key=lambda item: _cost(item, evaluator))
        best = _simplified(_with_finer_turns(best, evaluator), evaluator)
    if not _cost(best, evaluator) <= _cost(first, evaluator):
        return track
    return track_of_polyline(best, evaluator)


def _duration_function(
    table: PerformanceTable | TableArrays, fields: GridFields, limits: Limits
) -> Callable[[Track], float]:
    """Return a function of the duration of a track at sea [s]; inf if it cannot be sailed."""

    def duration(track: Track) -> float:
        evaluator = make_time_evaluator(
            table=table,
            chart=None,
            fields=fields,
            limits=limits,
            origin=track.depart,
            by_length=False,
            total=float(track.lengths.sum()),
        )
        return _cost(polyline_of_track(track, evaluator), evaluator)

    return duration


def _smooth_between_canals(
    track: Track,
    chart: Chart | None,
    smoothed: Callable[[Track], Track],
    duration: Callable[[Track], float],
) -> Track:
    """Return the track with its stretches between canals smoothed, as far as it can be sailed."""
    depart, at = track.depart, 0
    for number in range(len(sea_stretches(track, chart))):
        first, last = sea_stretches(track, chart)[number]
        canals = canal_legs(track, chart)
        depart += sum(canals.of(leg).transit_time + track.wait[leg] for leg in range(at, first))
        if not math.isfinite(depart):
            break
        part = smoothed(track.part(first, last, depart))
        track = track.with_part(first, last, part)
        depart, at = depart + duration(part), first + len(part) - 1
    return track


def _made_feasible(line: Polyline, evaluator: PolylineEvaluator) -> Polyline:
    """Return the line with longer waits, or with those that the evaluator finds."""
    longer = _shortened_waits(line, evaluator, longer=3600.0)
    if math.isfinite(_cost(longer, evaluator)):
        return longer
    return replace(line, leave=np.full(len(line), -math.inf))


def _initial_polylines(
    first: Polyline, pulled: Polyline, evaluator: PolylineEvaluator
) -> list[Polyline]:
    """Return the lines to refine: the pulled one, and a coarse resampling if it can be sailed."""
    starts = [pulled]
    one_setting = not np.ptp(first.setting)
    if len(pulled) > 6 and one_setting and not np.isfinite(first.leave).any():
        coarse = resampled_polyline(first, 5)
        if _elapsed_cost(coarse, evaluator) <= _COARSE_START_TOLERANCE * _elapsed_cost(
            pulled, evaluator
        ):
            starts.append(coarse)
    return starts


def resampled_polyline(line: Polyline, count: int) -> Polyline:
    """Return points at equal shares of the length of a line without waits.

    Parameters
    ----------
    line : Without waits.
    count : Number of points.
    """
    along = cumulative_sums(rough_lengths(line.lat, line.lon))
    at = np.linspace(0.0, along[-1], count)
    index = np.minimum(np.searchsorted(along, at[:-1], side="right") - 1, len(line.setting) - 1)
    lat, lon = np.interp(at, along, line.lat), np.interp(at, along, line.lon)
    return Polyline(lat, lon, np.full(count, -math.inf), line.setting[index], line.depart)


def _refine_by_levels(line: Polyline, evaluator: PolylineEvaluator, finest: int) -> Polyline:
    """Refine a line level by level."""
    total = float(rough_lengths(line.lat, line.lon).sum())
    longest, idle = total / 2.0, 0
    constrained = _may_be_constrained(evaluator)
    line = _refined(line, evaluator, constrained)
    while longest > total / finest and (idle < 2 or longest > total / 16.0):
        before = _elapsed_cost(line, evaluator)
        finer = line.split(longest)
        if len(finer) > len(line):
            finer = _shortened_waits(_refined(finer, evaluator, False), evaluator)
            if _elapsed_cost(finer, evaluator) < before:
                line = finer
            gained = before - _elapsed_cost(finer, evaluator)
            idle = idle + 1 if gained < _LEVEL_GAIN_TOLERANCE * before else 0
        longest *= 0.5
    if constrained:
        line = cut_corners(_refined(line, evaluator, True), evaluator)
    return line


def _with_finer_turns(line: Polyline, evaluator: PolylineEvaluator) -> Polyline:
    """Halve legs where the line turns and move all points, until straight legs lose almost nothing.

    Corners at obstacles stay: to halve the legs beside them gains nothing.
    """
    for _ in range(_FINER_LEVELS):
        loss = turning_losses(line.lat, line.lon)
        if not loss.sum() > _TURNING_LOSS:
            break
        finer = line.split(0.0, loss > _TURNING_LOSS / len(loss))
        finer = _shortened_waits(optimise_line_offsets(finer, evaluator, rounds=4), evaluator)
        spent = _elapsed_cost(line, evaluator)
        gained = spent - _elapsed_cost(finer, evaluator)
        if gained > 0.0:
            line = finer
        if not gained > _FINER_GAIN_TOLERANCE * spent:
            break
    return line


def _refined(line: Polyline, evaluator: PolylineEvaluator, constrained: bool) -> Polyline:
    """Move the waypoints by Newton's method, and by compass search where obstacles may bind."""
    moved = optimise_line_offsets(line, evaluator)
    if not constrained:
        return moved
    smallest = max(1.0, 1e-6 * float(rough_lengths(line.lat, line.lon).sum()))
    return optimise_line_offsets(
        search_line_positions(moved, evaluator, smallest=smallest), evaluator, rounds=3
    )


def _may_be_constrained(evaluator: PolylineEvaluator) -> bool:
    """Return whether an obstacle may bind a line: a chart, or limits of any kind."""
    limited = np.isfinite(evaluator.limits).any()
    return bool(limited) or evaluator.chart is not None


def _simplified(line: Polyline, evaluator: PolylineEvaluator) -> Polyline:
    """Remove waypoints that gain almost nothing, and move the others once more."""
    spent = _elapsed_cost(line, evaluator)
    if not math.isfinite(spent) or len(line) < 3:
        return line
    shortest = _MIN_LEG_SHARE * float(rough_lengths(line.lat, line.lon).sum())
    thin = merge_short_legs(line, evaluator, shortest=shortest)
    thin = string_pull(
        thin,
        evaluator,
        penalty=SIMPLIFICATION_LOSS * spent / len(line),
        skip=_SIMPLIFICATION_SKIP,
    )
    thin = optimise_line_offsets(thin, evaluator, rounds=3)
    return (
        thin
        if _elapsed_cost(thin, evaluator) <= spent * (1.0 + 2.0 * SIMPLIFICATION_LOSS)
        else line
    )


def _shortened_waits(
    line: Polyline, evaluator: PolylineEvaluator, *, longer: float = 0.0
) -> Polyline:
    """Return the line with every departure from a wait as early as is best for the arrival.

    Parameters
    ----------
    longer : Longest extension of a wait [s].
    """
    if isinstance(evaluator, CostEvaluator):
        return line
    evaluator = replace(evaluator, waiting_parameters=np.zeros(3))
    for index in np.flatnonzero(np.isfinite(line.leave)):
        arrive, _ = evaluator.sail(line.batch(), check=False)
        low, high = float(arrive[0, index]), float(line.leave[index]) + longer
        if not math.isfinite(low):
            break
        if high <= low:
            continue
        for _ in range(3):
            tried = np.linspace(low, high, _MAX_WAITS_TRIED)
            batch = line.batch(
                np.repeat(line.lat[None], _MAX_WAITS_TRIED, 0),
                np.repeat(line.lon[None], _MAX_WAITS_TRIED, 0),
            )
            leave = np.array(batch.leave)
            leave[:, index] = tried
            ends, cost = evaluator.sail(replace(batch, leave=leave))
            score = (
                ends[:, -1] if not evaluator.by_length else np.where(np.isfinite(cost), tried, cost)
            )
            if not np.isfinite(score).any():
                break
            pick = int(np.argmin(score))
            chosen = line.leave.copy()
            chosen[index] = tried[pick]
            line = replace(line, leave=chosen)
            low, high = tried[max(pick - 1, 0)], tried[pick]
    return line


def _cost(line: Polyline, evaluator: PolylineEvaluator) -> float:
    return float(evaluator.sail(line.batch())[1][0])


def _elapsed_cost(line: Polyline, evaluator: PolylineEvaluator) -> float:
    """Return the cost from departure: seconds or metres."""
    return _cost(line, evaluator) - (0.0 if evaluator.by_length else line.depart)
