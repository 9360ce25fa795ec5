"""Evolution from seeds to a front: the loop, its stopping criteria and its result."""

from __future__ import annotations

import time as clock
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.interrupt import cancel_on_interrupt
from thalweg.core.types import FloatArray
from thalweg.evolution.algorithm import EvolutionaryAlgorithm, check_size, check_whole_number
from thalweg.evolution.indicators import generational_distance
from thalweg.evolution.initial_population import initial_population
from thalweg.evolution.mpaes import Mpaes
from thalweg.evolution.nsga2 import Nsga2
from thalweg.evolution.ranking import least_crowded_front
from thalweg.evolution.spea2 import Spea2
from thalweg.evolution.variation import VariationSettings
from thalweg.kernels.leg import population_sailing
from thalweg.route.evaluators.population import Genome, Population
from thalweg.route.evaluators.population_evaluator import Evaluator
from thalweg.route.refinement.scored_tracks import feasible_front
from thalweg.route.track import Track

METHODS: dict[str, type[EvolutionaryAlgorithm]] = {"nsga2": Nsga2, "spea2": Spea2, "mpaes": Mpaes}
SETTLING_WINDOW = 33  #: generations over which the generational distance must have settled
#: Its variance below which it has, in units of the front's mean spacing squared.
SETTLED_VARIANCE = 3e-4
MAX_GENERATIONS = 500  #: if nothing else limits a run
DEFAULT_OPERATORS = VariationSettings()  #: variation operators unless others are given
_VERIFICATION_REFINEMENT = 4.0  # the front is verified with pieces shorter by this factor

Cancel: TypeAlias = Callable[[], bool]


@dataclass(frozen=True)
class EvolutionProgress:
    """Progress of an evolution.

    Attributes
    ----------
    generation, evaluations : int
    seconds : float
        Since it began.
    front : float64 array (n, 2)
        Time [s] and cost of the best so far.
    """

    generation: int
    evaluations: int
    seconds: float
    front: FloatArray


@dataclass(frozen=True)
class StoppingCriteria:
    """Criteria that end an evolution, whichever is met first; None: not used.

    Attributes
    ----------
    generations, evaluations : int or None
    seconds : float or None
        A run that ends by seconds is not repeatable.
    settled : float or None
        Variance of the last 33 generational distances (each new front to the one before,
        objectives as shares of its range, times the number of points: in units of the mean spacing
        of the front).

    Raises
    ------
    InputError
        If a limit is negative or NaN.
    """

    generations: int | None = None
    evaluations: int | None = None
    seconds: float | None = None
    settled: float | None = SETTLED_VARIANCE

    def __post_init__(self) -> None:
        for name in ("generations", "evaluations", "seconds", "settled"):
            value = getattr(self, name)
            number = isinstance(value, (int, float, np.number))
            if value is not None and not (number and value >= 0):
                raise InputError(
                    f"An evolution cannot end after {value!r} {name}.",
                    "Limits are zero or more.",
                    "Correct it or leave it out.",
                    field=name,
                )

    def with_generations(self, most: int) -> StoppingCriteria:
        """Return these criteria, with a limit of generations if there is no other limit.

        Parameters
        ----------
        most : int
            Greatest number of generations, 0 or more.

        Returns
        -------
        StoppingCriteria
            Unchanged if there is a limit already.
        """
        limits = (self.generations, self.evaluations, self.seconds)
        return self if any(x is not None for x in limits) else replace(self, generations=most)

    def reached(self, generation: int, evaluations: int, seconds: float) -> str:
        """Return the name of the limit that is reached; empty if none is.

        Parameters
        ----------
        generation, evaluations : int
            Counts so far.
        seconds : float
            Time so far [s].

        Returns
        -------
        str
            ``generations``, ``evaluations``, ``seconds``, or empty.
        """
        counted = {"generations": generation, "evaluations": evaluations, "seconds": seconds}
        for name, value in counted.items():
            most = getattr(self, name)
            if most is not None and value >= most:
                return name
        return ""


SETTLED_STOPPING = StoppingCriteria()  #: end when the front has settled


@dataclass(frozen=True)
class EvolutionSettings:
    """Method and parameters of an evolution.

    Attributes
    ----------
    method : {"nsga2", "spea2", "mpaes"}
    size : int
        Tracks in the population or archive, at least 4.
    seed : int
        Of the random numbers: equal seeds give equal runs, to the bit.
    operators : VariationSettings
        Variation operators and their probabilities.

    Raises
    ------
    InputError
        If the method is unknown, the population too small or the seed not a whole number.
    """

    method: str = "nsga2"
    size: int = 100
    seed: int = 0
    operators: VariationSettings = DEFAULT_OPERATORS

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise unknown_name_error("evolutionary method", self.method, METHODS)
        check_size(self.size)
        check_whole_number("seed", self.seed)


@dataclass(frozen=True, eq=False)
class EvolutionResult:
    """The front of an evolution.

    Attributes
    ----------
    genomes : tuple of Genome
        Feasible tracks that no other one dominates, by ascending time.
    time, cost : float64 array (n,)
        As compared: by the kernel, not the referee [s, unit of the prices].
    origin : tuple of str
        Origin of each: the method, or the stage of `refine_front`.
    generations, evaluations : int
    seconds : float
    stopped : str
        Its criterion: "generations", "evaluations", "seconds", "settled" or "cancelled".
    """

    genomes: tuple[Genome, ...]
    time: FloatArray
    cost: FloatArray
    origin: tuple[str, ...]
    generations: int
    evaluations: int
    seconds: float
    stopped: str

    @property
    def objectives(self) -> FloatArray:
        """Time and cost, shape (n, 2)."""
        return np.column_stack([self.time, self.cost])

    @property
    def cancelled(self) -> bool:
        """Whether it was cancelled; the front is then the best so far."""
        return self.stopped == "cancelled"

    def __len__(self) -> int:
        return len(self.genomes)


@cancel_on_interrupt
def evolve(
    evaluator: Evaluator,
    seeds: Sequence[Genome | Track],
    *,
    settings: EvolutionSettings = EvolutionSettings(),
    stopping: StoppingCriteria = SETTLED_STOPPING,
    progress: Callable[[EvolutionProgress], None] | None = None,
    cancel: Cancel | None = None,
) -> EvolutionResult:
    """Evolve tracks until the front settles or a limit is reached.

    Parameters
    ----------
    evaluator : Evaluator
    seeds : sequence of Genome or Track
        First tracks, preferably one for each alternative route.
    settings : EvolutionSettings, optional
    stopping : StoppingCriteria, optional
        500 generations at most if it has no limit of generations, evaluations or seconds.
    progress : callable, optional
        Called with an `EvolutionProgress` after every generation.
    cancel : callable, optional
        Called after every generation; true ends the run with the best front so far. Without it
        Ctrl-C does so, with a warning; pressed again it interrupts.

    Returns
    -------
    EvolutionResult
        Its front is empty if no feasible track was found.

    Raises
    ------
    InputError
        If there are no seeds.
    """
    rng, size = np.random.default_rng(settings.seed), settings.size
    first = initial_population(
        evaluator, seeds, size=size, variation_settings=settings.operators, rng=rng
    )
    strategy = METHODS[settings.method](
        evaluator,
        first,
        size=size,
        variation_settings=with_wait_mutations(settings.operators, first),
        rng=rng,
    )
    begun = clock.perf_counter()
    limits = stopping.with_generations(MAX_GENERATIONS)
    work = run_algorithm(strategy, evaluator, limits, progress=progress, cancel=cancel)
    names = [settings.method] * len(strategy.scores)
    population, scores, origin = verified_at_finer_spacing(
        evaluator, strategy.population, strategy.scores, names
    )
    return evolution_result(
        population, scores, origin, work=work, seconds=clock.perf_counter() - begun, size=size
    )


@dataclass(frozen=True)
class RunSummary:
    """Work of a run and the criterion that ended it (see `EvolutionResult`)."""

    generations: int
    evaluations: int
    stopped: str


def run_algorithm(
    strategy: EvolutionaryAlgorithm,
    evaluator: Evaluator,
    limits: StoppingCriteria,
    *,
    progress: Callable[[EvolutionProgress], None] | None = None,
    cancel: Cancel | None = None,
) -> RunSummary:
    """Run an algorithm until it has settled, a limit is reached or it is cancelled.

    Parameters
    ----------
    progress : Called with an `EvolutionProgress` after every generation.
    cancel : Called after every generation; true ends the run.
    """
    begun, settling = clock.perf_counter(), ConvergenceTest(limits.settled)
    generation = evaluations = 0
    while True:
        requested = strategy.ask()
        strategy.tell(evaluator.score(requested))
        evaluations += len(requested)
        now = clock.perf_counter() - begun
        front = strategy.scores[feasible_front(strategy.scores)][:, :2]
        if progress is not None:
            progress(EvolutionProgress(generation, evaluations, now, front))
        stopped = "cancelled" if cancel is not None and cancel() else ""
        stopped = stopped or limits.reached(generation, evaluations, now)
        stopped = stopped or ("settled" if settling.settled(front) else "")
        if stopped:
            return RunSummary(generation, evaluations, stopped)
        generation += 1


def with_wait_mutations(
    variation_settings: VariationSettings, population: Population
) -> VariationSettings:
    """Return settings that vary waits too, if a population has any."""
    waits = bool((population.genes[:, :, population_sailing.WAITING_TIME] > 0.0).any())
    if not waits or variation_settings.mix.pause > 0.0:
        return variation_settings
    return replace(variation_settings, mix=replace(variation_settings.mix, pause=0.5))


class ConvergenceTest:
    """Whether the front has settled: the variance of its last generational distances."""

    def __init__(self, variance: float | None) -> None:
        self._variance = variance
        self._before = np.empty((0, 2))
        self._distances: deque[float] = deque(maxlen=SETTLING_WINDOW)

    def settled(self, front: FloatArray) -> bool:
        """Return whether the fronts have settled, the front of a new generation being the last."""
        if len(front) and len(self._before):
            apart = generational_distance(front, self._before)
            self._distances.append(apart * len(front))
        self._before = front
        if self._variance is None or len(self._distances) < SETTLING_WINDOW:
            return False
        return float(np.var(self._distances)) < self._variance


def verified_at_finer_spacing(
    evaluator: Evaluator, population: Population, scores: FloatArray, origin: Sequence[str]
) -> tuple[Population, FloatArray, list[str]]:
    """Return the tracks that stay feasible when they are sailed in shorter pieces.

    Parameters
    ----------
    scores : float64 array (N, 3)
    origin : Of each track.
    """
    still = np.flatnonzero(scores[:, 2] == 0.0)
    if len(still):
        closer = evaluator.finer(_VERIFICATION_REFINEMENT).score(population.take(still))
        still = still[closer[:, 2] == 0.0]
    return population.take(still), scores[still], [origin[int(k)] for k in still]


def evolution_result(
    population: Population,
    scores: FloatArray,
    origin: Sequence[str],
    *,
    work: RunSummary,
    seconds: float,
    size: int,
) -> EvolutionResult:
    """Return the front of scored tracks, at most ``size`` of it, as an `EvolutionResult`."""
    front = least_crowded_front(scores, size)
    return EvolutionResult(
        tuple(population.take(front).genomes()),
        scores[front, 0].copy(),
        scores[front, 1].copy(),
        tuple(origin[int(k)] for k in front),
        work.generations,
        work.evaluations,
        seconds,
        work.stopped,
    )
