"""Initial populations: seeds at their own, the highest and the most economical speed; mutants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import IntArray
from thalweg.evolution.variation import INITIAL_OPERATOR_WEIGHTS, VariationSettings, reproduce
from thalweg.kernels.leg import population_sailing
from thalweg.route.evaluators.calm_water_rates import calm_water_values
from thalweg.route.evaluators.population import Genome, Population, concatenated_populations
from thalweg.route.evaluators.population_evaluator import Evaluator
from thalweg.route.track import Track

MAX_POINTS = 400  #: of a track
_MIN_CAPACITY = 48
_MUTATION_ROUNDS = 3  # mutants of mutants


def as_genomes(evaluator: Evaluator, seeds: Sequence[Genome | Track]) -> list[Genome]:
    """Return seeds as genomes."""
    if not len(seeds):
        raise InputError(
            "There is no initial track.",
            "Evolution starts from at least one, such as the shortest on a network.",
            "Give one for each alternative route.",
        )
    return [
        seed if isinstance(seed, Genome) else Genome.from_track(seed, settings=evaluator.settings)
        for seed in seeds
    ]


def initial_population(
    evaluator: Evaluator,
    seeds: Sequence[Genome | Track],
    *,
    size: int,
    variation_settings: VariationSettings,
    rng: np.random.Generator,
) -> Population:
    """Return seeds, each also at the fastest and at the thriftiest setting, and their mutants.

    At least ``size`` tracks (more if there are more seeds). Rows have space for further points.

    Parameters
    ----------
    evaluator : Gives the number of settings and the most economical one.
    seeds : Tracks that the population contains.
    size : Least number of tracks.
    variation_settings : Settings of the mutations.
    rng : Source of random numbers.

    Returns
    -------
    Population : Seeds first, then mutants.
    """
    genomes = as_genomes(evaluator, seeds)
    top, economical = evaluator.settings - 1, least_cost_setting(evaluator)
    fast = [_at_setting(genome, top) for genome in genomes]
    slow = [_at_setting(genome, economical) for genome in genomes]
    population = evaluator.population([*genomes, *fast, *slow], capacity=capacity_for(genomes))
    base, missing = population, size - len(population)
    mix = replace(
        INITIAL_OPERATOR_WEIGHTS,
        pause=float((population.genes[:, :, population_sailing.WAITING_TIME] > 0.0).any()),
    )
    first = replace(variation_settings, crossover=0.0, mix=mix)
    for _ in range(_MUTATION_ROUNDS):
        if missing <= 0:
            break
        wanted = -(-missing // (2 * _MUTATION_ROUNDS))
        pairs = rng.integers(0, len(base), size=(wanted, 2))
        offspring = reproduce(base, pairs, evaluator=evaluator, variation_settings=first, rng=rng)
        population = concatenated_populations(population, offspring)
        base = concatenated_populations(base, offspring)
    return population


def capacity_for(tracks: Sequence[Genome] | IntArray) -> int:
    """Return the capacity for tracks (or numbers of points), with space for further points."""
    if isinstance(tracks, np.ndarray):
        longest = int(tracks.max())
    else:
        longest = max(len(track) for track in tracks)
    return max(longest + 8, min(MAX_POINTS, max(_MIN_CAPACITY, 2 * longest)))


def least_cost_setting(evaluator: Evaluator) -> int:
    """Return the setting with the least cost per metre in calm water."""
    prices, fuel = evaluator.prices, calm_water_values(evaluator.world.fuel)
    speeds = calm_water_values(evaluator.world.table)
    with np.errstate(invalid="ignore", divide="ignore"):
        cost = (fuel * prices.outside + prices.time) / speeds
    return int(np.nanargmin(cost)) if np.isfinite(cost).any() else 0


def _at_setting(genome: Genome, setting: int) -> Genome:
    return replace(genome, setting=np.full(len(genome) - 1, setting, dtype=np.int64))
