"""SPEA2 (Zitzler, Laumanns & Thiele 2001)."""

from __future__ import annotations

import numpy as np

from thalweg.core.types import FloatArray, IntArray
from thalweg.evolution.algorithm import EvolutionaryAlgorithm, ScoreRequests
from thalweg.evolution.ranking import normalised, strength_fitness
from thalweg.kernels.evolution.dominance import truncate


class Spea2(EvolutionaryAlgorithm):
    """An archive of non-dominated tracks, filled with the fittest others or thinned where crowded.

    Distances are between objectives as shares of their ranges.
    """

    def _search(self) -> ScoreRequests:
        scores = yield self.population
        chosen, place = environmental_selection(scores, self.size)
        self.population, self.scores = self.population.take(chosen), scores[chosen]
        while True:
            pairs = self._binary_tournament(place, 2 * ((self.size + 1) // 2)).reshape(-1, 2)
            offspring = self._children(pairs)
            scores = yield offspring
            chosen, place = environmental_selection(
                np.concatenate([self.scores, scores]), self.size
            )
            self._keep(chosen, offspring, scores)


def environmental_selection(scores: FloatArray, size: int) -> tuple[IntArray, IntArray]:
    """Return (indices of the archive, the place of each by fitness, 0 the best)."""
    level = normalised(scores)
    _, _, fitness = strength_fitness(level)
    _, first = np.unique(scores, axis=0, return_index=True)
    again = np.ones(len(scores), dtype=bool)
    again[first] = False
    fitness = np.where(again, fitness + len(scores) ** 2, fitness)  # one of equals is enough
    chosen = np.flatnonzero(fitness < 1.0)
    if len(chosen) > size:
        left = truncate(level[chosen, 0].copy(), level[chosen, 1].copy(), size)
        chosen = chosen[left]
    else:
        chosen = np.argsort(fitness, kind="stable")[:size]
    place = np.empty(len(chosen), dtype=np.int64)
    place[np.argsort(fitness[chosen], kind="stable")] = np.arange(len(chosen))
    return chosen, place
