"""The indexed heap returns its nodes in the order of their last keys."""

import numpy as np
import pytest

from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.search import heap


@jit(cache=False)
def drain(first, second, order):
    """Put every node with its first key, then lower it to the second; take them all."""
    n = first.shape[0]
    nodes, keys, place = np.empty(n, np.int32), np.empty(n), np.full(n, -1, np.int32)
    size = 0
    for node in range(n):
        size = heap.push_or_lower(nodes, keys, place, size, node, first[node])
    for node in order:
        size = heap.push_or_lower(nodes, keys, place, size, node, second[node])
    taken, at = np.empty(n, np.int64), np.empty(n)
    count = 0
    while size > 0:
        taken[count], at[count], size = heap.pop_least(nodes, keys, place, size)
        count += 1
    return count, taken, at, place


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2, 5, 6, 400])
def test_nodes_come_out_once_and_in_order_of_their_lowered_keys(count):
    rng = np.random.default_rng(count)
    first = rng.random(count)
    second = first * rng.uniform(0.2, 1.0, count)
    taken_count, taken, keys, place = drain(first, second, rng.permutation(count))
    assert taken_count == count
    assert np.array_equal(np.sort(taken), np.arange(count))
    assert np.array_equal(keys, np.sort(second))
    assert np.array_equal(second[taken], keys)
    assert np.all(place == -1)
