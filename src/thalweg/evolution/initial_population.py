"""Populations to begin with: seeds at their own, the fastest and the thriftiest speed, mutants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from thalweg.core.errors import InputError
from thalweg.evolution.variation import FIRST_MIX, Habits, children
from thalweg.kernels.leg import population_sailing
from thalweg.route.refinement.calm_water_rates import calm_speeds
from thalweg.route.refinement.population import Genome, IntArray, Population, joined
from thalweg.route.refinement.population_evaluator import Evaluator
from thalweg.route.track import Track

MOST_POINTS = 400  #: of a track
_LEAST_ROOM = 48
_ROUNDS = 3  # mutants of mutants


def as_genomes(evaluator: Evaluator, seeds: Sequence[Genome | Track]) -> list[Genome]:
    """Return seeds as genomes."""
    if not len(seeds):
        raise InputError(
            "There is no track to begin with.",
            "Evolution starts from at least one, such as the shortest on a network.",
            "Give one for each way round.",
        )
    return [
        seed if isinstance(seed, Genome) else Genome.from_track(seed, settings=evaluator.settings)
        for seed in seeds
    ]


def first_population(
    evaluator: Evaluator,
    seeds: Sequence[Genome | Track],
    *,
    size: int,
    habits: Habits,
    rng: np.random.Generator,
) -> Population:
    """Return seeds, each also at the fastest and at the thriftiest setting, and their mutants.

    At least ``size`` tracks (more if there are more seeds). Room is left for points to come.
    """
    genomes = as_genomes(evaluator, seeds)
    top, thrifty = evaluator.settings - 1, thriftiest(evaluator)
    fast = [_at_setting(genome, top) for genome in genomes]
    slow = [_at_setting(genome, thrifty) for genome in genomes]
    population = evaluator.population([*genomes, *fast, *slow], room=room_for(genomes))
    base, missing = population, size - len(population)
    mix = replace(
        FIRST_MIX, pause=float((population.genes[:, :, population_sailing.WAIT] > 0.0).any())
    )
    first = replace(habits, crossover=0.0, mix=mix)
    for _ in range(_ROUNDS):
        if missing <= 0:
            break
        wanted = -(-missing // (2 * _ROUNDS))
        pairs = rng.integers(0, len(base), size=(wanted, 2))
        young = children(base, pairs, evaluator=evaluator, habits=first, rng=rng)
        population, base = joined(population, young), joined(base, young)
    return population


def room_for(tracks: Sequence[Genome] | IntArray) -> int:
    """Return the room for points that tracks (or tracks of so many points) need to grow."""
    if isinstance(tracks, np.ndarray):
        longest = int(tracks.max())
    else:
        longest = max(len(track) for track in tracks)
    return max(longest + 8, min(MOST_POINTS, max(_LEAST_ROOM, 2 * longest)))


def thriftiest(evaluator: Evaluator) -> int:
    """Return the setting of least cost a metre in calm water."""
    prices, fuel = evaluator.prices, calm_speeds(evaluator.world.fuel)
    speeds = calm_speeds(evaluator.world.table)
    with np.errstate(invalid="ignore", divide="ignore"):
        cost = (fuel * prices.outside + prices.time) / speeds
    return int(np.nanargmin(cost)) if np.isfinite(cost).any() else 0


def _at_setting(genome: Genome, setting: int) -> Genome:
    return replace(genome, setting=np.full(len(genome) - 1, setting, dtype=np.int64))
