"""NSGA-II (Deb, Pratap, Agarwal & Meyarivan 2002)."""

from __future__ import annotations

import numpy as np

from thalweg.evolution.algorithm import EvolutionaryAlgorithm, ScoreRequests
from thalweg.evolution.ranking import select_survivors


class Nsga2(EvolutionaryAlgorithm):
    """Parents and children together are sorted into fronts; the last to fit by crowding."""

    def _search(self) -> ScoreRequests:
        scores = yield self.population
        chosen, rank, crowding = select_survivors(scores, self.size)
        self.population, self.scores = self.population.take(chosen), scores[chosen]
        rank, crowding = rank[chosen], crowding[chosen]
        while True:
            place = np.empty(len(rank), dtype=np.int64)
            place[np.lexsort((-crowding, rank))] = np.arange(len(rank))
            pairs = self._binary_tournament(place, 2 * ((self.size + 1) // 2)).reshape(-1, 2)
            offspring = self._children(pairs)
            scores = yield offspring
            chosen, rank, crowding = select_survivors(
                np.concatenate([self.scores, scores]), self.size
            )
            self._keep(chosen, offspring, scores)
            rank, crowding = rank[chosen], crowding[chosen]
