"""NSGA-II (Deb, Pratap, Agarwal & Meyarivan 2002)."""

from __future__ import annotations

import numpy as np

from thalweg.evolution.algorithm import Steps, Strategy
from thalweg.evolution.ranking import best_of


class Nsga2(Strategy):
    """Parents and children together are sorted into fronts; the last to fit by crowding."""

    def _search(self) -> Steps:
        told = yield self.population
        chosen, rank, crowding = best_of(told, self.size)
        self.population, self.scores = self.population.take(chosen), told[chosen]
        rank, crowding = rank[chosen], crowding[chosen]
        while True:
            place = np.empty(len(rank), dtype=np.int64)
            place[np.lexsort((-crowding, rank))] = np.arange(len(rank))
            pairs = self._tournament(place, 2 * ((self.size + 1) // 2)).reshape(-1, 2)
            young = self._children(pairs)
            told = yield young
            chosen, rank, crowding = best_of(np.concatenate([self.scores, told]), self.size)
            self._keep(chosen, young, told)
            rank, crowding = rank[chosen], crowding[chosen]
