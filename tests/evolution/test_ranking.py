"""Ranking: worked examples of NSGA-II and SPEA2, and pymoo as an independent check."""

import numpy as np
import pytest

from thalweg.evolution.mpaes import HillClimber
from thalweg.evolution.ranking import (
    least_crowded_front,
    ranks_and_crowding,
    select_survivors,
    strength_fitness,
)
from thalweg.evolution.spea2 import environmental_selection
from thalweg.kernels.evolution.dominance import truncate
from thalweg.route.refinement.scored_tracks import feasible_front

WORKED = [(1, 5), (2, 3), (4, 1), (3, 4), (5, 5), (4, 4)]


def scores(points, violation=0.0):
    points = np.asarray(points, float)
    return np.column_stack([points, np.broadcast_to(violation, len(points))])


def test_worked_crowding_within_a_front():
    rank, crowding = ranks_and_crowding(scores([(5, 0.5), (1, 5), (4, 1), (2, 3), (6, 6)]))
    assert rank.tolist() == [0, 0, 0, 0, 1]
    assert crowding == pytest.approx([np.inf, np.inf, 1.305556, 1.638889, np.inf], abs=5e-7)


def test_worked_strength_raw_fitness_and_density():
    strength, raw, fitness = strength_fitness(scores(WORKED))
    assert strength.tolist() == [1, 3, 2, 2, 0, 1]
    assert raw.tolist() == [0, 0, 0, 3, 9, 7]
    expected = [0.236068, 0.236068, 0.2, 3.292893, 9.236068, 7.292893]
    assert fitness == pytest.approx(expected, abs=5e-7)


def test_feasibility_comes_first():
    given = scores([(1, 1), (9, 9), (2, 2), (0, 0)], [0.2, 0.0, 0.1, 0.3])
    rank, _ = ranks_and_crowding(given)
    assert rank.tolist() == [2, 0, 1, 3]
    assert select_survivors(given, 2)[0].tolist() == [1, 2]
    assert feasible_front(given).tolist() == [1]
    _, raw, _ = strength_fitness(given)
    assert np.argsort(raw).tolist() == [1, 2, 0, 3]


def test_of_equal_tracks_one_is_the_better():
    rank, _ = ranks_and_crowding(scores([(1, 1), (1, 1), (1, 1), (2, 0)]))
    assert sorted(rank.tolist()) == [0, 0, 1, 2]


def test_fronts_are_those_of_pymoo():
    pytest.importorskip("pymoo")
    from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting

    rng = np.random.default_rng(3)
    for _ in range(20):
        points = rng.random((120, 2))
        rank, _ = ranks_and_crowding(scores(points))
        for number, front in enumerate(NonDominatedSorting().do(points)):
            assert np.flatnonzero(rank == number).tolist() == sorted(front)


def test_truncation_removes_the_lexicographically_nearest_as_written_out():
    rng = np.random.default_rng(11)
    x = np.sort(rng.random(30))
    points = np.column_stack([x, 1.0 - x])
    left = list(range(30))
    while len(left) > 12:
        apart = np.linalg.norm(points[left][:, None] - points[left][None], axis=2)
        near = np.sort(apart, axis=1)[:, 1:]
        left.pop(min(range(len(left)), key=lambda k: near[k].tolist()))
    assert np.flatnonzero(truncate(points[:, 0].copy(), points[:, 1].copy(), 12)).tolist() == left


def test_archive_is_filled_with_the_fittest_or_thinned():
    chosen, place = environmental_selection(scores(WORKED), 4)
    assert sorted(chosen.tolist()) == [0, 1, 2, 3]
    assert chosen[place == 3].tolist() == [3]
    chosen, _ = environmental_selection(scores(WORKED), 2)
    assert set(chosen.tolist()) <= {0, 1, 2}


def test_thinning_removes_the_least_contribution_and_no_ends():
    given = scores([(1, 5), (2, 3), (2.1, 2.9), (4, 1), (5, 0.5), (6, 6)])
    assert least_crowded_front(given, 4).tolist() == [0, 1, 3, 4]  # (2.1, 2.9) adds 1.9 x 0.1
    assert least_crowded_front(given, 2).tolist() == [0, 4]
    assert least_crowded_front(given, 9).tolist() == [0, 1, 2, 3, 4]


def test_a_climber_moves_as_published_for_m_paes():
    def point(t, c):
        return np.array([t, c, 0.0])

    climber = HillClimber(point(5, 5), np.array([[5, 5, 0.0], [1, 9, 0.0], [9, 1, 0.0]]))
    assert not climber.judge(point(6, 6), 10)  # dominated: a failure
    assert climber.failures == 1
    assert climber.judge(point(4, 4), 10)  # dominates: moves, failures forgotten
    assert climber.failures == 0
    assert len(climber.near) == 3
    assert not climber.judge(point(2, 9.5), 10)  # something in its archive dominates it
    crowded = HillClimber(point(3, 3), np.array([[3, 3, 0.0], [0, 9, 0.0], [2.9, 3.1, 0.0]]))
    assert crowded.judge(point(6, 0.5), 10)  # it is not dominated and less crowded
    assert crowded.near.shape[0] == 4
    # (5, 5) is less crowded than (6.9, 3.1); a point is not a neighbour of itself
    alone = HillClimber(point(5, 5), np.array([[5, 5, 0.0], [0, 10, 0.0], [10, 0, 0.0]]))
    assert not alone.judge(point(6.9, 3.1), 10)
    full = HillClimber(
        point(3, 3), np.array([[3, 3, 0.0], [0, 9, 0.0], [9, 0, 0.0], [3.1, 2.9, 0.0]])
    )
    full.judge(point(1, 6), 4)
    assert full.near.shape[0] == 4  # the most crowded had to go
    assert [0, 9, 0.0] in full.near.tolist()
