"""Evolution from seeds to a front: the loop, when it ends, and what it hands back."""

from __future__ import annotations

import time as clock
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from thalweg.core.errors import InputError, unknown_name
from thalweg.core.geodesy import FloatArray
from thalweg.core.interrupt import stoppable
from thalweg.evolution.algorithm import Strategy
from thalweg.evolution.indicators import generational_distance
from thalweg.evolution.initial_population import first_population
from thalweg.evolution.mpaes import Mpaes
from thalweg.evolution.nsga2 import Nsga2
from thalweg.evolution.ranking import front_of, thinned
from thalweg.evolution.spea2 import Spea2
from thalweg.evolution.variation import Habits
from thalweg.kernels.leg import population_sailing
from thalweg.route.refinement.population import Genome, Population
from thalweg.route.refinement.population_evaluator import Evaluator
from thalweg.route.track import Track

METHODS: dict[str, type[Strategy]] = {"nsga2": Nsga2, "spea2": Spea2, "mpaes": Mpaes}
N_STOP = 33  #: generations over which the generational distance must have settled
SETTLED = 3e-4  #: its variance below which it has, in units of the front's mean spacing squared
MOST_GENERATIONS = 500  #: if nothing else limits a run
_PROOF = 4.0  # the front is looked at again with pieces so many times shorter

Cancel: TypeAlias = Callable[[], bool]


@dataclass(frozen=True)
class Progress:
    """How far an evolution is.

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
class Limits:
    """When an evolution ends, whichever comes first; None: not by that.

    Attributes
    ----------
    generations, evaluations : int or None
    seconds : float or None
    settled : float or None
        Variance of the last 33 generational distances, each times the number of points.
    """

    generations: int | None = None
    evaluations: int | None = None
    seconds: float | None = None
    settled: float | None = SETTLED

    def __post_init__(self) -> None:
        for name in ("generations", "evaluations", "seconds", "settled"):
            value = getattr(self, name)
            if value is not None and not value >= 0:
                raise InputError(
                    f"An evolution cannot end after {value!r} {name}.",
                    "Limits are zero or more.",
                    "Correct it or leave it out.",
                    field=name,
                )

    def reached(self, generation: int, evaluations: int, seconds: float) -> str:
        """Return which of the counted limits is reached, or nothing."""
        counted = {"generations": generation, "evaluations": evaluations, "seconds": seconds}
        for name, value in counted.items():
            most = getattr(self, name)
            if most is not None and value >= most:
                return name
        return ""


@dataclass(frozen=True, eq=False)
class Evolution:
    """The front of an evolution.

    Attributes
    ----------
    genomes : tuple of Genome
        Feasible tracks that nothing found dominates, by ascending time.
    time, cost : float64 array (n,)
        As compared: by the kernel, not the referee [s, unit of the prices].
    origin : tuple of str
        What each comes from: the method, or the stage of `refine_front`.
    generations, evaluations : int
    seconds : float
    stopped : str
        What ended it: "generations", "evaluations", "seconds", "settled" or "cancelled".
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


@stoppable
def evolve(
    evaluator: Evaluator,
    seeds: Sequence[Genome | Track],
    *,
    method: str = "nsga2",
    size: int = 100,
    generations: int | None = None,
    evaluations: int | None = None,
    seconds: float | None = None,
    settled: float | None = SETTLED,
    seed: int = 0,
    progress: Callable[[Progress], None] | None = None,
    cancel: Cancel | None = None,
    operators: Habits | None = None,
) -> Evolution:
    """Evolve tracks until the front settles or a limit is reached.

    Parameters
    ----------
    evaluator : Evaluator
    seeds : sequence of Genome or Track
        To begin with, best one for each way round.
    method : {"nsga2", "spea2", "mpaes"}
    size : int
        Tracks in the population or archive, at least 4.
    generations, evaluations : int, optional
    seconds : float, optional
        Limits; 500 generations if none is given. A run that ends by seconds is not repeatable.
    settled : float or None
        The run ends when the variance of the last 33 generational distances (each new front to
        the one before, objectives as shares of its range, times the number of points: in units
        of the mean spacing of the front) is below this; None: never.
    seed : int
        Of the random numbers: the same run again, to the bit.
    progress : callable, optional
        Called with a `Progress` after every generation.
    cancel : callable, optional
        Asked after every generation; true ends the run with the best so far. Without it, Ctrl-C
        does so, with a warning; pressed again it interrupts.
    operators : Habits, optional
        How children are made.

    Returns
    -------
    Evolution
        Its front is empty if nothing feasible was found.

    Raises
    ------
    InputError
        For an unknown method, no seeds or a population that is too small.
    """
    if method not in METHODS:
        raise unknown_name("evolutionary method", method, METHODS)
    if generations is None and evaluations is None and seconds is None:
        generations = MOST_GENERATIONS
    limits = Limits(generations, evaluations, seconds, settled)
    rng = np.random.default_rng(seed)
    habits = operators or Habits()
    first = first_population(evaluator, seeds, size=size, habits=habits, rng=rng)
    strategy = METHODS[method](evaluator, first, size=size, habits=paused(habits, first), rng=rng)
    begun = clock.perf_counter()
    work = run(strategy, evaluator, limits, progress=progress, cancel=cancel)
    names = [method] * len(strategy.scores)
    population, scores, origin = proved(evaluator, strategy.population, strategy.scores, names)
    return evolution_of(
        population, scores, origin, work=work, seconds=clock.perf_counter() - begun, size=size
    )


@dataclass(frozen=True)
class Work:
    """What a run took and why it ended (see `Evolution`)."""

    generations: int
    evaluations: int
    stopped: str


def run(
    strategy: Strategy,
    evaluator: Evaluator,
    limits: Limits,
    *,
    progress: Callable[[Progress], None] | None = None,
    cancel: Cancel | None = None,
) -> Work:
    """Drive a strategy until it has settled, a limit is reached or it is cancelled."""
    begun, settling = clock.perf_counter(), Settling(limits.settled)
    generation = evaluations = 0
    while True:
        asked = strategy.ask()
        strategy.tell(evaluator.score(asked))
        evaluations += len(asked)
        now = clock.perf_counter() - begun
        front = strategy.scores[front_of(strategy.scores)][:, :2]
        if progress is not None:
            progress(Progress(generation, evaluations, now, front))
        stopped = "cancelled" if cancel is not None and cancel() else ""
        stopped = stopped or limits.reached(generation, evaluations, now)
        stopped = stopped or ("settled" if settling.settled(front) else "")
        if stopped:
            return Work(generation, evaluations, stopped)
        generation += 1


def paused(habits: Habits, population: Population) -> Habits:
    """Return habits that change waits too, if a population has any."""
    waits = bool((population.genes[:, :, population_sailing.WAIT] > 0.0).any())
    if not waits or habits.mix.pause > 0.0:
        return habits
    return replace(habits, mix=replace(habits.mix, pause=0.5))


class Settling:
    """Whether the front has settled: the variance of its last generational distances."""

    def __init__(self, variance: float | None) -> None:
        self._variance = variance
        self._before = np.empty((0, 2))
        self._distances: deque[float] = deque(maxlen=N_STOP)

    def settled(self, front: FloatArray) -> bool:
        """Take the front of a generation and return whether it has settled."""
        if len(front) and len(self._before):
            apart = generational_distance(front, self._before)
            self._distances.append(apart * len(front))
        self._before = front
        if self._variance is None or len(self._distances) < N_STOP:
            return False
        return float(np.var(self._distances)) < self._variance


def proved(
    evaluator: Evaluator, population: Population, scores: FloatArray, origin: Sequence[str]
) -> tuple[Population, FloatArray, list[str]]:
    """Return the tracks that stay feasible when looked at in shorter pieces."""
    still = np.flatnonzero(scores[:, 2] == 0.0)
    if len(still):
        closer = evaluator.finer(_PROOF).score(population.take(still))
        still = still[closer[:, 2] == 0.0]
    return population.take(still), scores[still], [origin[int(k)] for k in still]


def evolution_of(
    population: Population,
    scores: FloatArray,
    origin: Sequence[str],
    *,
    work: Work,
    seconds: float,
    size: int,
) -> Evolution:
    """Return the front of scored tracks, at most ``size`` of it, as an `Evolution`."""
    front = thinned(scores, size)
    return Evolution(
        tuple(population.take(front).genomes()),
        scores[front, 0].copy(),
        scores[front, 1].copy(),
        tuple(origin[int(k)] for k in front),
        work.generations,
        work.evaluations,
        seconds,
        work.stopped,
    )
