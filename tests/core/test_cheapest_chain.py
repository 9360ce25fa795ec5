"""The cheapest chain of ascending indices."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thalweg.core.cheapest_chain import cheapest_chain


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 6), st.randoms(use_true_random=False))
def test_against_all_chains(count, random):
    price = np.array([[random.uniform(0.5, 5.0) for _ in range(count)] for _ in range(count)])
    price[np.array([[random.random() < 0.2 for _ in range(count)] for _ in range(count)])] = np.inf

    def steps(here, previous):
        there = np.arange(here + 1, count)
        return there, price[here, there]

    def cost(chain):
        return sum(price[a, b] for a, b in itertools.pairwise(chain))

    between = range(1, count - 1)
    ends = (0, count - 1) if count > 1 else (0,)
    chains = [
        (ends[0], *inner, *ends[1:])
        for size in range(count)
        for inner in itertools.combinations(between, size)
    ]
    best = min(map(cost, chains))
    found = cheapest_chain(count, steps)
    if not np.isfinite(best):
        assert found is None
    else:
        assert cost(found.tolist()) == pytest.approx(best, rel=1e-12)


def test_prices_may_depend_on_the_index_before():
    arrive = {(-1, 0): 0.0}

    def steps(here, previous):
        there = np.arange(here + 1, 3)
        time = arrive[previous, here]
        duration = np.array([1.0, 5.0])[: len(there)] if time < 1.0 else np.array([2.0])
        arrive.update({(here, int(k)): time + d for k, d in zip(there, duration)})
        return there, duration

    assert cheapest_chain(3, steps).tolist() == [0, 1, 2]


def test_a_tolerance_keeps_the_chain_that_was_found_first():
    def steps(here, previous):
        return np.arange(here + 1, 3), np.array([[1.0, 2.0], [1.0 - 1e-6]][here])

    assert cheapest_chain(3, steps).tolist() == [0, 1, 2]
    assert cheapest_chain(3, steps, tolerance=1e-5).tolist() == [0, 2]
