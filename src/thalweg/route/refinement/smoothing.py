"""From the staircase of a network to a route: pulled taut, then bent to the sea."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.route.canal_legs import canal_legs, sea_stretches
from thalweg.route.refinement.compass_search import feel
from thalweg.route.refinement.corner_cutting import merge_close, tighten
from thalweg.route.refinement.cost_evaluator import Purse
from thalweg.route.refinement.newton_offsets import bend
from thalweg.route.refinement.polyline import Line, line_of, track_of_line
from thalweg.route.refinement.string_pulling import pull
from thalweg.route.refinement.time_evaluator import Sailor, make_sailor, rough_lengths
from thalweg.route.track import Track

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import GridFields
    from thalweg.ship import PerformanceTable

FINEST = 160  #: legs are split until they are shorter than the track divided by this at most
THINNING = 5e-5  #: share of the cost that may be lost by leaving waypoints out at the end
_SETTLED = 5e-5  # relative gain of a level below which no finer one is tried: a third of it is left
_HOPEFUL = 1.02  # a coarse resampling is refined too if it costs no more than this times the track
_WAITS_TRIED = 48
_SHORTEST = 2e-5  # legs below this share of the track are merged with a neighbour


def smooth(
    track: Track,
    *,
    table: PerformanceTable | TableArrays,
    fields: GridFields,
    limits: ArrayLike,
    chart: Chart | None = None,
    objective: str = "time",
    wait: bool | None = None,
    finest: int = FINEST,
) -> Track:
    """Return a better track than a given one, in the same water.

    Parameters
    ----------
    track : Track
        One that can be sailed, such as a path on a network.
    table : PerformanceTable or TableArrays
        Speed through water.
    fields : GridFields
        The sea frozen around the track.
    limits : array_like of float
        Required depth, wave height and wind speed, in the order of `thalweg.kernels.codes`.
    chart : Chart, optional
        Land, zones and charted depth to keep clear of.
    objective : {"time", "distance"}
    wait : bool, optional
        Whether the ship may wait where it did not before; by default only if it waits somewhere.
    finest : int
        Legs are split until they are shorter than the track divided by this.

    Returns
    -------
    Track
        The given track if nothing better is found or it cannot be sailed through these fields. It
        was compared on frozen fields: let the referee score both (see `better_route`).

    Notes
    -----
    String pulling over the waypoints; then, level by level, legs are halved and the waypoints
    bent sideways by Newton's method, feeling their way where obstacles bind. At last
    waypoints that bring less than a 5e-5 share of the cost together are left out.
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
        return _between_canals(track, chart, smoothed, _clock(table, fields, limits))
    sailor = make_sailor(
        table=table,
        chart=chart,
        fields=fields,
        limits=limits,
        origin=track.depart,
        by_length=objective == "distance",
        total=float(track.lengths.sum()),
        wait=bool(track.wait.any()) if wait is None else wait,
    )
    first = line_of(track, sailor)
    if not math.isfinite(_cost(first, sailor)):
        first = _made_sailable(first, sailor)
        if not math.isfinite(_cost(first, sailor)):
            return track
    line = pull(first, sailor)
    if _is_bound(line, sailor):
        line = tighten(line, sailor)
    line = _settled_waits(line, sailor)
    if sailor.by_length:  # a taut line cannot be bent any shorter
        best = _thinned(feel(line, sailor), sailor)
    else:
        lines = [_levels(start, sailor, finest) for start in _starts(first, line, sailor)]
        best = min(lines, key=lambda item: _cost(item, sailor))
    if not _cost(best, sailor) <= _cost(first, sailor):
        return track
    return track_of_line(best, sailor)


def _clock(
    table: PerformanceTable | TableArrays, fields: GridFields, limits: ArrayLike
) -> Callable[[Track], float]:
    """Return a function that tells how long a track at sea takes [s]; inf if it cannot sail."""

    def duration(track: Track) -> float:
        sailor = make_sailor(
            table=table,
            chart=None,
            fields=fields,
            limits=limits,
            origin=track.depart,
            by_length=False,
            total=float(track.lengths.sum()),
        )
        return _cost(line_of(track, sailor), sailor)

    return duration


def _between_canals(
    track: Track,
    chart: Chart | None,
    smoothed: Callable[[Track], Track],
    duration: Callable[[Track], float],
) -> Track:
    """Return the track with its stretches between canals smoothed; from a loss of time on as is."""
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


def _made_sailable(line: Line, sailor: Sailor | Purse) -> Line:
    """Return the line with longer waits, or with those the quick sailor finds of itself."""
    longer = _settled_waits(line, sailor, longer=3600.0)
    if math.isfinite(_cost(longer, sailor)):
        return longer
    return replace(line, leave=np.full(len(line), -math.inf))


def _starts(first: Line, pulled: Line, sailor: Sailor | Purse) -> list[Line]:
    """Return the lines to refine: the pulled one, and a coarse resampling if it can be sailed."""
    starts = [pulled]
    one_setting = not np.ptp(first.setting)
    if len(pulled) > 6 and one_setting and not np.isfinite(first.leave).any():
        coarse = resampled(first, 5)
        if _spent(coarse, sailor) <= _HOPEFUL * _spent(pulled, sailor):
            starts.append(coarse)
    return starts


def resampled(line: Line, count: int) -> Line:
    """Return points at equal shares of the length of a line without waits."""
    along = np.concatenate([[0.0], np.cumsum(rough_lengths(line.lat, line.lon))])
    at = np.linspace(0.0, along[-1], count)
    index = np.minimum(np.searchsorted(along, at[:-1], side="right") - 1, len(line.setting) - 1)
    lat, lon = np.interp(at, along, line.lat), np.interp(at, along, line.lon)
    return Line(lat, lon, np.full(count, -math.inf), line.setting[index], line.depart)


def _levels(line: Line, sailor: Sailor | Purse, finest: int) -> Line:
    """Refine a line level by level, and thin it at the end."""
    total = float(rough_lengths(line.lat, line.lon).sum())
    longest, idle = total / 2.0, 0
    bound = _is_bound(line, sailor)
    line = _refined(line, sailor, bound)
    while longest > total / finest and (idle < 2 or longest > total / 16.0):
        before = _spent(line, sailor)
        finer = line.split(longest)
        if len(finer) > len(line):
            finer = _settled_waits(_refined(finer, sailor, False), sailor)
            if _spent(finer, sailor) < before:
                line = finer
            gained = before - _spent(finer, sailor)
            idle = idle + 1 if gained < _SETTLED * before else 0
        longest *= 0.5
    if bound:
        line = tighten(_refined(line, sailor, True), sailor)
    return _thinned(line, sailor)


def _refined(line: Line, sailor: Sailor | Purse, bound: bool) -> Line:
    """Bend a line, and feel along obstacles where they may bind."""
    bent = bend(line, sailor)
    if not bound:
        return bent
    smallest = max(1.0, 1e-6 * float(rough_lengths(line.lat, line.lon).sum()))
    return bend(feel(bent, sailor, smallest=smallest), sailor, rounds=3)


def _is_bound(line: Line, sailor: Sailor | Purse) -> bool:
    """Return whether any obstacle could bind a line: land on the chart, or limits of any kind."""
    limited = np.isfinite(sailor.limits).any()
    return bool(limited) or sailor.chart is not None


def _thinned(line: Line, sailor: Sailor | Purse) -> Line:
    """Leave out waypoints that bring almost nothing, and bend what is left once more."""
    spent = _spent(line, sailor)
    if not math.isfinite(spent) or len(line) < 3:
        return line
    shortest = _SHORTEST * float(rough_lengths(line.lat, line.lon).sum())
    thin = merge_close(line, sailor, shortest=shortest)
    thin = pull(thin, sailor, penalty=THINNING * spent / len(line))
    thin = bend(thin, sailor, rounds=3)
    return thin if _spent(thin, sailor) <= spent * (1.0 + 2.0 * THINNING) else line


def _settled_waits(line: Line, sailor: Sailor | Purse, *, longer: float = 0.0) -> Line:
    """Return the line with every moment of leaving as early as serves the arrival best.

    Parameters
    ----------
    longer : float
        How much longer [s] than now a wait may become.
    """
    if isinstance(sailor, Purse):
        return line
    sailor = replace(sailor, patience=np.zeros(3))
    for index in np.flatnonzero(np.isfinite(line.leave)):
        arrive, _ = sailor.sail(line.bundle(), check=False)
        low, high = float(arrive[0, index]), float(line.leave[index]) + longer
        if not math.isfinite(low):
            break
        if high <= low:
            continue
        for _ in range(3):
            tried = np.linspace(low, high, _WAITS_TRIED)
            bundle = line.bundle(
                np.repeat(line.lat[None], _WAITS_TRIED, 0),
                np.repeat(line.lon[None], _WAITS_TRIED, 0),
            )
            leave = np.array(bundle.leave)
            leave[:, index] = tried
            ends, cost = sailor.sail(replace(bundle, leave=leave))
            score = (
                ends[:, -1] if not sailor.by_length else np.where(np.isfinite(cost), tried, cost)
            )
            if not np.isfinite(score).any():
                break
            pick = int(np.argmin(score))
            chosen = line.leave.copy()
            chosen[index] = tried[pick]
            line = replace(line, leave=chosen)
            low, high = tried[max(pick - 1, 0)], tried[pick]
    return line


def _cost(line: Line, sailor: Sailor | Purse) -> float:
    return float(sailor.sail(line.bundle())[1][0])


def _spent(line: Line, sailor: Sailor | Purse) -> float:
    """Return the cost from departure: seconds or metres."""
    return _cost(line, sailor) - (0.0 if sailor.by_length else line.depart)
