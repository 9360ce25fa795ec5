"""Fronts in free space, refined or found by evolutionary search."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import rough_lengths, wrap_longitude
from thalweg.core.pareto_fronts import (
    ROUNDING_TOLERANCE,
    evenly_spaced_subset,
    non_dominated_indices,
)
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.evolution import (
    EvaluationResolution,
    Evaluator,
    EvolutionResult,
    EvolutionSettings,
    FrontRefinementSettings,
    Genome,
    StoppingCriteria,
    TabulatedShip,
    evolve,
    make_evaluator,
    refine_front,
)
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    TrackCandidate,
    TradeOffContext,
)
from thalweg.route import Route, Track
from thalweg.route.sea_raster import RasterSize, freeze_raster

if TYPE_CHECKING:
    from thalweg.sea import GridFields

#: Population and generations of an evolutionary method on its own.
_EVOLUTION_POPULATION, _EVOLUTION_GENERATIONS = 100, 300
#: Share of the time until the latest arrival that is left: tables and referee differ by less.
_TIME_RESERVE = 3e-4
_LATER = 0.1  # share of the voyage by which tracks near routes may arrive later
_RASTER_SIZE = RasterSize(margin=0.15, min_cells=24, max_cells=240, largest=24_000_000)


def evolutionary_candidates(
    trade_off: TradeOffContext, explored: ExploredAlternative, candidates: list[TrackCandidate]
) -> list[TrackCandidate]:
    """Return the candidates that evolutionary search finds for one alternative, from seeds."""
    context, method = trade_off.context, trade_off.context.voyage.method
    detail = trade_off.detail
    seeds = _seeds(trade_off, explored, candidates)
    evaluator = _evaluator(trade_off, explored, seeds)
    genomes = [_genome(trade_off, seed, evaluator.settings) for seed in seeds]
    seed = context.voyage.seed
    if method == "default":
        result = refine_front(
            evaluator,
            genomes,
            settings=FrontRefinementSettings(
                detail.size, detail.time_prices, seed, exploration=detail.exploration
            ),
            stopping=StoppingCriteria(detail.generations),
            cancel=trade_off.interrupt_guard.stopped,
        )
    else:
        ends = [genomes[0], genomes[-1]]
        result = evolve(
            evaluator,
            ends,
            settings=EvolutionSettings(method, _EVOLUTION_POPULATION, seed),
            stopping=StoppingCriteria(_EVOLUTION_GENERATIONS),
            cancel=trade_off.interrupt_guard.stopped,
        )
    found = _candidates(result, explored, context.voyage.earliest_departure)
    if len(trade_off.settings) > 1:
        return found
    return [replace(one, track=_at_setting(one.track, int(trade_off.settings[0]))) for one in found]


def _seeds(
    trade_off: TradeOffContext, explored: ExploredAlternative, candidates: list[TrackCandidate]
) -> list[Track]:
    """Return the fastest refined track and a selection of those found, by ascending time.

    Some are dominated: refinement may improve these more.
    """
    detail = trade_off.detail
    time = np.array([item.time for item in candidates])
    value = np.array([item.value for item in candidates])
    non_dominated = non_dominated_indices(time, value, tolerance=ROUNDING_TOLERANCE)
    dominated = np.setdiff1d(np.arange(len(candidates)), non_dominated)
    chosen = non_dominated[
        evenly_spaced_subset(time[non_dominated], value[non_dominated], detail.seeds)
    ]
    if len(dominated):
        chosen = np.append(
            chosen,
            dominated[
                evenly_spaced_subset(time[dominated], value[dominated], detail.dominated_seeds)
            ],
        )
    chosen = chosen[np.argsort(time[chosen], kind="stable")]
    fastest = explored.fastest
    tracks = [candidates[index].track for index in chosen]
    return [fastest.track, *tracks] if fastest.feasible else tracks


def _genome(trade_off: TradeOffContext, track: Track, settings: int) -> Genome:
    """Return a track as a genome; via points and ends of canals are fixed."""
    if settings == 1:
        track = _at_setting(track, 0)
    held = [(end.lat, end.lon) for end in trade_off.via]
    held = [place for place in held if _passes_through(track, place)]
    return Genome.from_track(track, settings=settings, via=held)


def _at_setting(track: Track, setting: int) -> Track:
    return track.replaced(setting=np.full(len(track) - 1, setting))


def _tabulated_ship(trade_off: TradeOffContext) -> TabulatedShip:
    """Return the ship for an evaluator; of one setting where one speed is ordered."""
    tables = trade_off.context.table, trade_off.consumption
    if len(trade_off.settings) == 1:
        only = int(trade_off.settings[0])
        tables = tables[0].at_setting(only), tables[1].at_setting(only)
    return TabulatedShip(*tables, trade_off.limits)


def _passes_through(track: Track, place: tuple[float, float]) -> bool:
    offset = np.abs(track.lat - place[0]) + np.abs(wrap_longitude(track.lon - place[1]))
    return bool(offset.min() < 1e-9)


def _evaluator(
    trade_off: TradeOffContext, explored: ExploredAlternative, seeds: list[Track]
) -> Evaluator:
    context = trade_off.context
    depart = context.voyage.earliest_departure
    latest = context.data_end
    if math.isfinite(context.latest_arrival):
        latest = depart + (1.0 - _TIME_RESERVE) * (context.latest_arrival - depart)
    assert explored.exact is not None  # an interrupted front is not refined
    slowest = max(point.path_arrive[-1] for point in explored.exact.points)
    until = min(latest, depart + 1.1 * (float(slowest) - depart) + 3600.0)
    total = float(np.median([rough_lengths(track.lat, track.lon).sum() for track in seeds]))
    return make_evaluator(
        _tabulated_ship(trade_off),
        freeze_around_tracks(trade_off, seeds, depart, until),
        depart=depart,
        chart=context.chart,
        latest=until,
        prices=trade_off.objective.prices,
        resolution=EvaluationResolution(total=total),
    )


def evaluator_around_routes(trade_off: TradeOffContext, routes: Sequence[Route]) -> Evaluator:
    """Return an evaluator of tracks near some routes that arrive little later than these."""
    total = float(np.median([route.legs["length"].sum() for route in routes]))
    arrive = max(route.arrive for route in routes)
    return _evaluator_around(trade_off, [route.track for route in routes], arrive, total)


def evaluator_around_candidates(
    trade_off: TradeOffContext, candidates: Sequence[TrackCandidate]
) -> Evaluator:
    """Return an evaluator of tracks near some candidates that arrive little later than these."""
    tracks = [item.track for item in candidates]
    total = float(np.median([track.lengths.sum() for track in tracks]))
    arrive = [item.track.depart + item.time for item in candidates if math.isfinite(item.time)]
    latest = min(trade_off.context.latest_arrival, trade_off.context.data_end)
    return _evaluator_around(trade_off, tracks, max(arrive, default=latest), total)


def _evaluator_around(
    trade_off: TradeOffContext, tracks: list[Track], arrive: float, total: float
) -> Evaluator:
    """Return an evaluator around tracks of a total length [m] that arrive by a time [s]."""
    context = trade_off.context
    depart = min(track.depart for track in tracks)
    until = min(arrive + _LATER * (arrive - depart) + HOUR, context.data_end)
    return make_evaluator(
        TabulatedShip(context.table, trade_off.consumption, trade_off.limits),
        freeze_around_tracks(trade_off, tracks, depart, until),
        depart=depart,
        chart=context.chart,
        prices=trade_off.objective.prices,
        resolution=EvaluationResolution(total=total),
    )


def freeze_around_tracks(
    trade_off: TradeOffContext, tracks: list[Track], start: float, end: float
) -> GridFields:
    """Freeze the sea around tracks; unknown cells beside known ones are extrapolated.

    Parameters
    ----------
    start, end : [s since 1970-01-01T00:00Z].
    """
    sea, channels = trade_off.context.sea, trade_off.context.needs.channels
    frozen = freeze_raster(sea, *_unwrapped_positions(tracks), (start, end), channels, _RASTER_SIZE)
    return replace(frozen, values=_extrapolated_one_cell(frozen.values))


def _extrapolated_one_cell(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return a raster in which unknown cells beside known ones have the mean of these.

    The data may extend to the unknown cell, or end between the two. The referee uses the data
    themselves, so a plan holds no route over unknown water.
    """
    unknown = np.isnan(values)
    if not unknown.any():
        return values
    known, total = np.zeros(values.shape, np.int8), np.zeros_like(values)
    padded = np.pad(values, ((0, 0), (1, 1), (1, 1), (0, 0)), constant_values=np.nan)
    rows, columns = values.shape[1:3]
    for i, j in ((0, 1), (1, 0), (1, 2), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2)):
        neighbours = padded[:, i : i + rows, j : j + columns]
        here = unknown & ~np.isnan(neighbours)
        known += here
        total[here] += neighbours[here]
    reached = np.where(known > 0, total / np.maximum(known, 1), np.nan)
    return np.where(unknown, reached, values).astype(np.float32)


def _unwrapped_positions(seeds: list[Track]) -> tuple[FloatArray, FloatArray]:
    """Return all latitudes, and longitudes without jumps, of tracks with one start."""
    lon = [np.degrees(np.unwrap(np.radians(track.lon))) for track in seeds]
    lon = [line - 360.0 * np.round((line[0] - lon[0][0]) / 360.0) for line in lon]
    return np.concatenate([track.lat for track in seeds]), np.concatenate(lon)


def _candidates(
    evolution: EvolutionResult, explored: ExploredAlternative, depart: float
) -> list[TrackCandidate]:
    return [
        TrackCandidate(
            genome.to_track(depart), origin, explored.alternative.name, float(time), float(cost)
        )
        for genome, origin, time, cost in zip(
            evolution.genomes, evolution.origin, evolution.time, evolution.cost
        )
        if origin != "seed"
    ]
