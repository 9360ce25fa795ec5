"""M-PAES: local search by many hill climbers, then recombination (Knowles & Corne 2000)."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.types import FloatArray, IntArray
from thalweg.evolution.algorithm import EvolutionaryAlgorithm, ScoreRequests
from thalweg.evolution.indicators import crowding_distance
from thalweg.evolution.ranking import dominates, select_survivors
from thalweg.route.evaluators.population import Population, concatenated_populations

MAX_FAILURES = 5  #: successive dominated mutants that end a local search
MAX_MOVES = 20  #: largest number of mutants of a local search
RECOMBINATION_TRIALS = 20  #: pairs of parents tried until the population is filled
_ARCHIVE_PER_CLIMBER = 5  # size of the archive over the number of hill climbers


@dataclass
class HillClimber:
    """One local search: its current score, its archive and its counts.

    Attributes
    ----------
    score : Score of its current track, (3,).
    near : Its own archive H, (h, 3).
    """

    score: FloatArray
    near: FloatArray
    failures: int = 0
    moves: int = 0

    @property
    def is_active(self) -> bool:
        """Whether the local search continues."""
        return self.failures < MAX_FAILURES and self.moves < MAX_MOVES

    def judge(self, tried: FloatArray, most: int) -> bool:
        """Return whether a mutant is accepted, and make it the current track if so."""
        self.moves += 1
        if dominates(self.score, tried):
            self.failures += 1
            return False
        if dominates(tried, self.score):
            self.failures = 0
            self._remember(tried, most)
            self.score = tried
            return True
        if dominates(self.near, tried).any():
            return False
        return self._test(tried, most)

    def _test(self, tried: FloatArray, most: int) -> bool:
        """Archive a non-dominated mutant; make it the current track if it is less crowded."""
        both = np.vstack([_scores_without(self.near, self.score[None]), self.score, tried])
        crowding = crowding_distance(both[:, :2])
        self._remember(tried, most)
        if crowding[-1] > crowding[-2]:
            self.score = tried
            return True
        return False

    def _remember(self, tried: FloatArray, most: int) -> None:
        near = self.near[~dominates(tried[None], self.near)]
        self.near = np.vstack([near, tried])
        if len(self.near) > most:
            self.near = np.delete(self.near, np.argmin(crowding_distance(self.near[:, :2])), axis=0)


def _scores_without(scores: FloatArray, some: FloatArray) -> FloatArray:
    """Return scores (n, 3) without those among others; duplicates distort crowding distances."""
    return scores[(scores[:, None] != some[None]).any(axis=2).all(axis=1)]


class Mpaes(EvolutionaryAlgorithm):
    """A global archive and hill climbers; the mutants of all climbers are scored in one batch.

    The population is the archive G followed by the current tracks of the climbers.
    """

    def _search(self) -> ScoreRequests:
        self.scores = yield self.population
        self._take(select_survivors(self.scores, self.size)[0])
        count = max(2, self.size // _ARCHIVE_PER_CLIMBER)
        base = self._spread_over_archive(count)
        while True:
            yield from self._climb_from(base)
            base = yield from self._recombine(count)

    def _spread_over_archive(self, count: int) -> IntArray:
        """Return tracks spread evenly over the archive, one for each climber."""
        return np.unique(np.linspace(0, len(self.scores) - 1, count).round().astype(np.int64))

    def _climb_from(self, base: IntArray) -> ScoreRequests:
        """Run the local search of every climber until it fails too often."""
        archive = self.scores[self._archive()]
        climbers = []
        for index in base:
            score = self.scores[index]
            near = archive[~dominates(archive, score[None])]
            climbers.append(HillClimber(score, np.vstack([score[None], near])[: self.size]))
        track = np.array(base)  # of each climber, in the population
        mutation_only = replace(self.variation_settings, crossover=0.0)
        while True:
            active = np.flatnonzero([climber.is_active for climber in climbers])
            if not len(active):
                return
            pairs = np.resize(track[active], 2 * ((len(active) + 1) // 2)).reshape(-1, 2)
            offspring = self._children(pairs, mutation_only)
            scores = yield offspring
            before = len(self.scores)
            for place, k in enumerate(active):
                if climbers[k].judge(scores[place], self.size):
                    track[k] = before + place
            self._append(offspring, scores)
            track = self._keep_with(select_survivors(self.scores, self.size)[0], track)

    def _take(self, chosen: IntArray) -> None:
        self.population, self.scores = self.population.take(chosen), self.scores[chosen]

    def _append(self, offspring: Population, scores: FloatArray) -> None:
        self.population = concatenated_populations(self.population, offspring)
        self.scores = np.concatenate([self.scores, scores])

    def _keep_with(self, archive: IntArray, track: IntArray) -> IntArray:
        """Keep the archive, then the tracks of climbers; return where these are then."""
        chosen = np.concatenate([archive, np.setdiff1d(track, archive)])
        where = np.full(len(self.scores), -1, dtype=np.int64)
        where[chosen] = np.arange(len(chosen))
        self._take(chosen)
        return where[track]

    def _archive(self) -> IntArray:
        """Return the non-dominated tracks, at most ``size``."""
        chosen, rank, _ = select_survivors(self.scores, self.size)
        return chosen[rank[chosen] == 0]

    def _recombine(self, count: int) -> Generator[Population, FloatArray, IntArray]:
        """Return the climbers of the next round: accepted children, or tournament winners of G."""
        crossover_only = replace(self.variation_settings, crossover=1.0, mutation=0.0)
        base: list[int] = []
        for _ in range(RECOMBINATION_TRIALS):
            missing = count - len(base)
            pairs = self.rng.integers(0, len(self.scores), size=((missing + 1) // 2, 2))
            offspring = self._children(pairs, crossover_only)
            scores = yield offspring
            archive = self.scores[self._archive()]
            fit = [
                k for k in range(len(scores)) if self._can_join(scores[k], archive, pairs[k // 2])
            ]
            before = len(self.scores)
            self._append(offspring, scores)
            base += [before + k for k in fit[:missing]]
            if len(base) == count:
                break
        best = self._archive()
        remaining = count - len(base)
        if remaining:
            crowding = crowding_distance(self.scores[best, :2])
            place = np.empty(len(best), dtype=np.int64)
            place[np.argsort(-crowding, kind="stable")] = np.arange(len(best))
            base += best[self._binary_tournament(place, remaining)].tolist()
        return self._keep_with(best, np.array(base, dtype=np.int64))

    def _can_join(self, child: FloatArray, archive: FloatArray, parents: IntArray) -> bool:
        """Return whether a child is accepted: not dominated by G, and better or less crowded."""
        if dominates(archive, child[None]).any():
            return False
        if dominates(child[None], archive).any():
            return True
        parent_scores = self.scores[parents]
        both = np.vstack([_scores_without(archive, parent_scores), parent_scores, child])
        crowding = crowding_distance(both[:, :2])
        return bool(crowding[-1] > crowding[-3:-1].min())
