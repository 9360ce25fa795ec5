"""Memetic refinement of a front: exploration, local search for shadow prices of time, evolution."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.interrupt import cancel_on_interrupt
from thalweg.core.types import FloatArray
from thalweg.evolution.algorithm import check_size, check_whole_number
from thalweg.evolution.evolve import (
    DEFAULT_OPERATORS,
    SETTLED_STOPPING,
    Cancel,
    EvolutionProgress,
    EvolutionResult,
    RunSummary,
    StoppingCriteria,
    evolution_result,
    run_algorithm,
    verified_at_finer_spacing,
    with_wait_mutations,
)
from thalweg.evolution.initial_population import as_genomes, capacity_for, initial_population
from thalweg.evolution.nsga2 import Nsga2
from thalweg.evolution.ranking import least_crowded_front
from thalweg.evolution.variation import VariationSettings
from thalweg.route.evaluators.population import Genome, Population, concatenated_populations
from thalweg.route.evaluators.population_evaluator import Evaluator
from thalweg.route.refinement.scalarised_search import (
    fill_front,
    scalarised_local_search,
    seeds_with_time_prices,
)
from thalweg.route.refinement.scored_tracks import feasible_front
from thalweg.route.track import Track

TIME_PRICES = 48  #: shadow prices of time of the local search
FRONT_SIZE = 300  #: tracks on the front
DEFAULT_GENERATIONS = 50  #: of evolution after the local search, if no limit is given
_LOCAL_SEARCH_SHARE = 0.6  # share of the seconds that the local search may take
EXPLORATION_SIZE = 200  #: tracks of the first evolution, at most
EXPLORATION_GENERATIONS = 60  #: generations of the first evolution
EXPLORATION_SEEDS = 24  #: tracks of its front that the local search refines


@dataclass(frozen=True)
class FrontRefinementSettings:
    """Parameters of the refinement of a front.

    Attributes
    ----------
    size : int
        Tracks on the front, about; at least 4.
    time_prices : int
        Shadow prices of time for which a track is refined, in addition to every seed at its own.
    seed : int
        Of the random numbers.
    operators : VariationSettings
        Variation operators and their probabilities.
    exploration : int
        Generations of the first evolution; with 0 only the seeds are refined.

    Raises
    ------
    InputError
        If the population is too small, or a number is not a whole one.
    """

    size: int = FRONT_SIZE
    time_prices: int = TIME_PRICES
    seed: int = 0
    operators: VariationSettings = DEFAULT_OPERATORS
    exploration: int = EXPLORATION_GENERATIONS

    def __post_init__(self) -> None:
        check_size(self.size)
        check_whole_number("number of generations", self.exploration)
        check_whole_number("number of time prices", self.time_prices)
        check_whole_number("seed", self.seed)


@cancel_on_interrupt
def refine_front(
    evaluator: Evaluator,
    seeds: Sequence[Genome | Track],
    *,
    settings: FrontRefinementSettings = FrontRefinementSettings(),
    stopping: StoppingCriteria = SETTLED_STOPPING,
    progress: Callable[[EvolutionProgress], None] | None = None,
    cancel: Cancel | None = None,
) -> EvolutionResult:
    """Refine a front from tracks on it, such as those of an exact search on a network.

    Parameters
    ----------
    evaluator : Evaluator
    seeds : sequence of Genome or Track
        With their settings; every relevant alternative route should be among them.
    settings : FrontRefinementSettings, optional
    stopping : StoppingCriteria, optional
        Generations and evaluations are those of NSGA-II after the local search: 50 generations at
        most if there is no limit, none with 0. Seconds are those of the whole run; the local search
        takes at most three fifths of them.
    progress : callable, optional
        Called after every stage of the local search and every generation.
    cancel : callable, optional
        Called between steps; true ends the run with the best front so far. Without it Ctrl-C does
        so.

    Returns
    -------
    EvolutionResult
        ``origin`` is "seed", "local search" or "nsga2" for each track.

    Notes
    -----
    A memetic algorithm: evolution combined with local search (Moscato 1989).

    1. A short run of NSGA-II (200 tracks, 60 generations) explores from the seeds.
    2. Local search. A track that is best for some shadow price is on the lower convex hull of the
       front. For one price the problem is smooth except for the settings: Newton's method moves the
       points sideways (`thalweg.route.refinement.newton_offsets`), settings are chosen per leg,
       points are removed or added, and a compass search moves points at coasts and limits.
    3. Between two such tracks the front is filled evenly: the cheapest seconds are exchanged first
       by changes of settings, the last one on a part of its leg.
    4. NSGA-II finds what this misses, among others tracks above the hull.

    The result is the front of all tracks found, thinned where that loses the least area.
    """
    begun = clock.perf_counter()
    monitor = _LocalSearchMonitor(begun, stopping.seconds, cancel, progress)
    size, variation_settings = settings.size, settings.operators
    rng = np.random.default_rng(settings.seed)
    genomes = as_genomes(evaluator, seeds)
    pool = _CandidatePool(evaluator)
    pool.add("seed", evaluator.population(genomes, capacity=capacity_for(genomes)))
    work = RunSummary(0, 0, "generations")
    if settings.exploration:
        explored = min(size, EXPLORATION_SIZE)
        first = initial_population(
            evaluator, genomes, size=explored, variation_settings=variation_settings, rng=rng
        )
        algorithm = _nsga2(evaluator, first, explored, variation_settings, rng)
        exploration = StoppingCriteria(settings.exploration)
        work = run_algorithm(
            algorithm, evaluator, exploration, progress=progress, cancel=monitor.stop
        )
        pool.add(
            "nsga2",
            algorithm.population.take(least_crowded_front(algorithm.scores, EXPLORATION_SEEDS)),
        )
    if not monitor.stop():
        priced = seeds_with_time_prices(evaluator, pool.population, count=settings.time_prices)
        refined = scalarised_local_search(priced, stop=monitor.stop)
        monitor.report(refined.scores)
        filled = fill_front(refined, size)
        pool.add("local search", concatenated_populations(refined.population, filled))
    limits = _remaining(stopping, begun)
    work = RunSummary(0, work.evaluations, "cancelled" if monitor.cancelled else "generations")
    if not monitor.cancelled and limits.generations != 0:
        whole = pool.population
        whole = whole.with_capacity(capacity_for(whole.count))
        algorithm = _nsga2(evaluator, whole, size, variation_settings, rng)
        last = run_algorithm(algorithm, evaluator, limits, progress=progress, cancel=cancel)
        work = RunSummary(last.generations, work.evaluations + last.evaluations, last.stopped)
        pool.add("nsga2", algorithm.population)
    population, scores, origin = verified_at_finer_spacing(
        evaluator, pool.population, pool.scores, pool.origin
    )
    return evolution_result(
        population, scores, origin, work=work, seconds=clock.perf_counter() - begun, size=size
    )


def _nsga2(
    evaluator: Evaluator,
    first: Population,
    size: int,
    variation_settings: VariationSettings,
    rng: np.random.Generator,
) -> Nsga2:
    """Return NSGA-II for a first population, with mutations of waits if it has any."""
    variation_settings = with_wait_mutations(variation_settings, first)
    return Nsga2(evaluator, first, size=size, variation_settings=variation_settings, rng=rng)


class _CandidatePool:
    """All candidate tracks, with the stage they come from."""

    def __init__(self, evaluator: Evaluator) -> None:
        self._evaluator = evaluator
        self._parts: list[Population] = []
        self._scores: list[FloatArray] = []
        self.origin: list[str] = []

    def add(self, stage: str, population: Population) -> None:
        """Score tracks and add them."""
        self._scores.append(self._evaluator.score(population))
        self._parts.append(population)
        self.origin += [stage] * len(population)

    @property
    def population(self) -> Population:
        """All candidate tracks."""
        return concatenated_populations(*self._parts)

    @property
    def scores(self) -> FloatArray:
        """Their scores (N, 3)."""
        return np.concatenate(self._scores)


class _LocalSearchMonitor:
    """Stopping criteria and progress reports of the local search."""

    def __init__(
        self,
        begun: float,
        seconds: float | None,
        cancel: Cancel | None,
        progress: Callable[[EvolutionProgress], None] | None,
    ) -> None:
        self.begun, self.seconds = begun, seconds
        self.cancel, self.progress = cancel, progress
        self.cancelled = False

    def stop(self) -> bool:
        """Return whether the local search is to end."""
        self.cancelled = self.cancelled or (self.cancel is not None and bool(self.cancel()))
        spent = clock.perf_counter() - self.begun
        return self.cancelled or (
            self.seconds is not None and spent > _LOCAL_SEARCH_SHARE * self.seconds
        )

    def report(self, scores: FloatArray) -> None:
        """Report the front of a stage."""
        if self.progress is not None:
            front = scores[feasible_front(scores)][:, :2]
            spent = clock.perf_counter() - self.begun
            self.progress(EvolutionProgress(0, len(scores), spent, front))


def _remaining(stopping: StoppingCriteria, begun: float) -> StoppingCriteria:
    """Return what is left of the limits after the local search, for the evolution."""
    if stopping.seconds is None:
        return stopping.with_generations(DEFAULT_GENERATIONS)
    left = max(0.0, stopping.seconds - (clock.perf_counter() - begun))
    return replace(stopping, seconds=left)
