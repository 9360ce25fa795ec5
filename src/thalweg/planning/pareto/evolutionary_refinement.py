"""Free space behind the network: a front refined, or found, by evolution."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import wrap_longitude
from thalweg.evolution import Evaluator, Evolution, Genome, evolve, make_evaluator
from thalweg.evolution.memetic import refine_front
from thalweg.network.network import FloatArray
from thalweg.planning.pareto.exploration import Candidate, Explored, Means, not_dominated, spread
from thalweg.route import Track

if TYPE_CHECKING:
    from thalweg.sea import GridFields

#: Tracks that refinement begins with: of the front, and others.
_MOST_SEEDS, _MOST_DOMINATED = 48, 16
#: Tracks that are kept, and generations, of the refinement and of an evolution of its own.
_SIZE, _GENERATIONS = 140, 26
_OWN_SIZE, _OWN_GENERATIONS = 100, 300
_LARGEST_RASTER = 24_000_000  # numbers in the frozen raster
_ROOM = 0.15  # about the tracks, as a share of their box
_FINEST = 240  # cells along the longer side
_COARSEST = 24


def evolved(means: Means, explored: Explored, found: list[Candidate]) -> list[Candidate]:
    """Return the tracks that evolution finds on one way round, beginning with those found."""
    task, method = means.task, means.task.voyage.method
    seeds = _seeds(means, explored, found)
    evaluator = _evaluator(means, explored, seeds)
    genomes = [_genome(means, seed) for seed in seeds]
    seed = task.voyage.seed
    if method == "default":
        result = refine_front(
            evaluator,
            genomes,
            size=_SIZE,
            generations=_GENERATIONS,
            seed=seed,
            cancel=means.keeper.stopped,
        )
    else:
        ends = [genomes[0], genomes[-1]]
        result = evolve(
            evaluator,
            ends,
            method=method,
            size=_OWN_SIZE,
            generations=_OWN_GENERATIONS,
            seed=seed,
            cancel=means.keeper.stopped,
        )
    return _candidates(result, explored, task.voyage.earliest_departure)


def _seeds(means: Means, explored: Explored, found: list[Candidate]) -> list[Track]:
    """Return the fastest refined track and a selection of those found, by ascending time.

    Most are not dominated; some are though, since refinement may make these the better ones.
    """
    time = np.array([item.time for item in found])
    value = np.array([item.value for item in found])
    kept = np.array(not_dominated(time, value))
    rest = np.setdiff1d(np.arange(len(found)), kept)
    chosen = kept[spread(time[kept], value[kept], _MOST_SEEDS)]
    if len(rest):
        chosen = np.append(chosen, rest[spread(time[rest], value[rest], _MOST_DOMINATED)])
    chosen = chosen[np.argsort(time[chosen], kind="stable")]
    fastest = explored.fastest
    tracks = [found[index].track for index in chosen]
    return [fastest.track, *tracks] if fastest.feasible else tracks


def _genome(means: Means, track: Track) -> Genome:
    """Return a track as a genome; via points and ends of canals are held."""
    held = [(end.lat, end.lon) for end in means.via]
    held = [place for place in held if _on(track, place)]
    return Genome.from_track(track, settings=len(means.task.ship.speeds), via=held)


def _on(track: Track, place: tuple[float, float]) -> bool:
    away = np.abs(track.lat - place[0]) + np.abs(wrap_longitude(track.lon - place[1]))
    return bool(away.min() < 1e-9)


def _evaluator(means: Means, explored: Explored, seeds: list[Track]) -> Evaluator:
    criterion, task = means.criterion, means.task
    depart = task.voyage.earliest_departure
    latest = task.latest if math.isfinite(task.latest) else task.last
    assert explored.exact is not None  # a front that was stopped is not refined
    slowest = max(point.path_arrive[-1] for point in explored.exact.points)
    until = min(latest, depart + 1.1 * (float(slowest) - depart) + 3600.0)
    return make_evaluator(
        table=task.table,
        fuel=means.rate.table,
        fields=_raster(means, seeds, depart, until),
        limits=means.limits,
        depart=depart,
        chart=task.chart,
        latest=until,
        weight_inside=criterion.inside,
        weight_outside=criterion.outside,
        time_price=criterion.time_price,
        waiting_fuel=means.rate.waiting,
        fees=criterion.name == "cost",
        total=float(np.median([_rough_length(track) for track in seeds])),
    )


def _rough_length(track: Track) -> float:
    lat, lon = np.radians(track.lat), np.radians(wrap_longitude(np.diff(track.lon)))
    east = lon * np.cos(0.5 * (lat[:-1] + lat[1:]))
    return float(np.hypot(np.diff(lat), east).sum() * 6371008.8)


def _raster(means: Means, seeds: list[Track], start: float, end: float) -> GridFields:
    """Freeze the sea around all seeds, as fine as the data or a limit of memory allows."""
    sea, channels = means.task.sea, means.task.needs.channels
    lat, lon = _box(seeds)
    extent = max(np.ptp(lat), np.ptp(lon), 1e-4)
    room = _ROOM * extent
    south, north = max(lat.min() - room, -89.9), min(lat.max() + room, 89.9)
    width = min(np.ptp(lon) + 2.0 * room, 359.0)
    west = 0.5 * (lon.min() + lon.max() - width)
    numbers = max(len(sea.times(start, end)), 2) * max(len(channels), 1)
    least = math.sqrt((north - south) * width * numbers / _LARGEST_RASTER)
    native = [row.spacing_deg for row in sea.coverage() if row.spacing_deg]
    spacing = max(min([extent / _FINEST * 2.0, *native]), least, extent / _FINEST)
    spacing = min(spacing, extent / _COARSEST)
    frozen = sea.freeze_grid(
        south, north, west, west + width, start, end, channels, spacing_deg=spacing
    )
    return replace(frozen, values=_reached_out(frozen.values))


def _reached_out(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return a raster with cells beside known ones as the mean of those, where they are unknown.

    Between a known cell and an unknown one a raster knows nothing, where the data may reach on. The
    referee looks at the data themselves, so what is not known there ends no route of a plan.
    """
    unknown = np.isnan(values)
    if not unknown.any():
        return values
    known, total = np.zeros(values.shape, np.int8), np.zeros_like(values)
    padded = np.pad(values, ((0, 0), (1, 1), (1, 1), (0, 0)), constant_values=np.nan)
    rows, columns = values.shape[1:3]
    for i, j in ((0, 1), (1, 0), (1, 2), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2)):
        beside = padded[:, i : i + rows, j : j + columns]
        here = unknown & ~np.isnan(beside)
        known += here
        total[here] += beside[here]
    reached = np.where(known > 0, total / np.maximum(known, 1), np.nan)
    return np.where(unknown, reached, values).astype(np.float32)


def _box(seeds: list[Track]) -> tuple[FloatArray, FloatArray]:
    """Return all latitudes, and longitudes without jumps, of tracks with one start."""
    lon = [np.degrees(np.unwrap(np.radians(track.lon))) for track in seeds]
    lon = [line - 360.0 * np.round((line[0] - lon[0][0]) / 360.0) for line in lon]
    return np.concatenate([track.lat for track in seeds]), np.concatenate(lon)


def _candidates(found: Evolution, explored: Explored, depart: float) -> list[Candidate]:
    return [
        Candidate(genome.to_track(depart), origin, explored.way.name, float(time), float(cost))
        for genome, origin, time, cost in zip(found.genomes, found.origin, found.time, found.cost)
        if origin != "seed"
    ]
