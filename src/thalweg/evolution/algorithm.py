"""The common interface of NSGA-II, SPEA2 and M-PAES: they request and accept scores."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Generator

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray, IntArray
from thalweg.evolution.variation import VariationSettings, reproduce
from thalweg.route.evaluators.population import Population, concatenated_populations
from thalweg.route.evaluators.population_evaluator import Evaluator

MIN_SIZE = 4  #: tracks in a population
ScoreRequests = Generator[Population, FloatArray, None]


class EvolutionaryAlgorithm(ABC):
    """An evolutionary algorithm whose steps are called from outside.

    Parameters
    ----------
    evaluator : Its chart and settings are used; it is not called.
    first : The first population; only its best tracks are used if it is larger than ``size``.
    size : Tracks in the population (and the archive), at least 4.

    Examples
    --------
    ``asked = strategy.ask()`` returns the tracks that are to be scored next;
    ``strategy.tell(evaluator.score(asked))`` continues with their scores.
    """

    def __init__(
        self,
        evaluator: Evaluator,
        first: Population,
        *,
        size: int,
        variation_settings: VariationSettings,
        rng: np.random.Generator,
    ) -> None:
        check_size(size)
        self.evaluator, self.size = evaluator, size
        self.variation_settings, self.rng = variation_settings, rng
        self.population, self.scores = first, np.empty((0, 3))
        self._steps = self._search()
        self._unscored = next(self._steps)

    def ask(self) -> Population:
        """Return the tracks that are to be scored next."""
        return self._unscored

    def tell(self, scores: FloatArray) -> None:
        """Accept the scores (N, 3) of the requested tracks; see `Evaluator.score`."""
        self._unscored = self._steps.send(scores)

    @abstractmethod
    def _search(self) -> ScoreRequests:
        """Yield populations and receive their scores; update ``population`` and ``scores``."""

    def _children(
        self, pairs: IntArray, variation_settings: VariationSettings | None = None
    ) -> Population:
        return reproduce(
            self.population,
            pairs,
            evaluator=self.evaluator,
            variation_settings=variation_settings or self.variation_settings,
            rng=self.rng,
        )

    def _keep(self, chosen: IntArray, offspring: Population, scores: FloatArray) -> None:
        """Keep the chosen tracks of the population followed by its offspring."""
        both = np.concatenate([self.scores, scores])
        self.population = concatenated_populations(self.population, offspring).take(chosen)
        self.scores = both[chosen]

    def _binary_tournament(self, better: IntArray, count: int) -> IntArray:
        """Return winners (count,) of binary tournaments; ``better`` is the rank of each track."""
        drawn = self.rng.integers(0, len(better), size=(count, 2))
        first, second = better[drawn[:, 0]], better[drawn[:, 1]]
        return np.where(first <= second, drawn[:, 0], drawn[:, 1])


def check_whole_number(name: str, value: object) -> None:
    """Raise `InputError` if a setting of a run is not a whole number of zero or more."""
    if not isinstance(value, (int, np.integer)) or isinstance(value, bool) or value < 0:
        raise InputError(
            f"The {name} of an evolution cannot be {value!r}.",
            "It is a whole number, zero or more.",
            "Correct it or leave it out.",
            field=name,
        )


def check_size(size: int) -> None:
    """Raise `InputError` if a population is too small."""
    check_whole_number("size", size)
    if size < MIN_SIZE:
        raise InputError(
            f"A population of {size} is too small.",
            f"It has at least {MIN_SIZE} tracks; 100 or more make a good front.",
            "Give a larger size.",
            field="size",
            value=size,
        )
