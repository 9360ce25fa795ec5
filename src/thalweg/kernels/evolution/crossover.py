"""Children of tracks: crossover, and the operators of `thalweg.kernels.evolution.mutation`.

Every child has a stream of random numbers of its own (SplitMix64), so that a population is the same
to the bit in any number of threads.
"""

import math

from thalweg.kernels.codes import OK
from thalweg.kernels.compilation.decorators import bare, inner
from thalweg.kernels.evolution.mutation import (
    CROSSOVER,
    MUTATION,
    RADIANS,
    copy_genes,
    mutate,
    plane,
)
from thalweg.kernels.evolution.random_numbers import below, uniform
from thalweg.kernels.geometry.coast_index import leg_code
from thalweg.kernels.leg.population_sailing import (
    COLUMNS,
    FIXED_TIME,
    HELD,
    KNOWN,
    LAT,
    LON,
    PIECES,
)

_NEAREST = 3  # points of the other parent that a crossover tries
_CROSSINGS = 8  # points of the first parent that it tries


@inner
def _held(genes, first, last):
    total = 0
    for p in range(first, last):
        total += genes[p, HELD] != 0.0
    return total


@inner
def _nearest(a, genes, count, weight, tried):
    """Return the nearest interior point of a track that is not tried yet, or -1."""
    best, least = -1, math.inf
    scale = math.cos(a[LAT] * RADIANS)
    for j in range(1, count - 1):
        fresh = True
        for k in range(tried):
            fresh &= weight[k] != j
        x, y = plane(a, genes[j], scale)
        if fresh and x * x + y * y < least:
            best, least = j, x * x + y * y
    return best


@inner
def _joint(a, b, coast):
    """Return whether a leg between points of two parents has a length and is clear."""
    if abs(a[LAT] - b[LAT]) + abs(a[LON] - b[LON]) < 1e-9:
        return False
    return leg_code(coast, a[LAT], a[LON], b[LAT], b[LON])[0] == OK


@inner
def _spliced(head, i, tail, j, count, target):
    """Write head[..i - 1] + tail[j..] and return its number of points."""
    copy_genes(head, i, target)
    for p in range(j, count):
        for c in range(COLUMNS):
            target[i + p - j, c] = tail[p, c]
    target[i - 1, KNOWN], target[i - 1, PIECES] = 0.0, 0.0
    target[i - 1, FIXED_TIME] = math.nan
    return i + count - j


@inner
def cross(a, na, b, nb, coast, c, d, state, weight):
    """Cross two tracks at neighbouring waypoints; return points of the children, or (0, 0)."""
    room = c.shape[0]
    if na < 3 or nb < 3:
        return 0, 0
    for _ in range(_CROSSINGS):
        i = 1 + below(state, na - 2)
        for tried in range(min(_NEAREST, nb - 2)):
            j = _nearest(a[i], b, nb, weight, tried)
            weight[tried] = j
            if i + nb - j > room or j + na - i > room:
                continue
            if _held(a, 0, i) != _held(b, 0, j) or _held(a, i, na) != _held(b, j, nb):
                continue
            if _joint(a[i - 1], b[j], coast) and _joint(b[j - 1], a[i], coast):
                return _spliced(a, i, b, j, nb, c), _spliced(b, j, a, i, na, d)
    return 0, 0


@bare
def breed(count, genes, pairs, coast, settings, habits, states, born, young, work, weights):
    """Make two children of each pair of parents.

    Parameters
    ----------
    count : int64[N]
    genes : float64[N, M, COLUMNS]
        The parents.
    pairs : int64[K, 2]
        Which of them meet.
    coast : CoastArrays
        Land and no-go zones. New legs keep clear of them if a few tries find a way.
    settings : int
        Number of settings of the ship.
    habits : float64[HABITS]
    states : uint64[K, 1]
        A seed for each pair.
    born : int64[K, 2]
        Points of the children; filled.
    young : float64[K, 2, M, COLUMNS]
        The children; filled.
    work : float64[K, M, COLUMNS]
    weights : float64[K, 2 * M]
        Room to work in.
    """
    for k in range(pairs.shape[0]):
        first, second = pairs[k, 0], pairs[k, 1]
        state, weight, spare = states[k], weights[k], work[k]
        c, d = young[k, 0], young[k, 1]
        nc, nd = 0, 0
        if uniform(state) < habits[CROSSOVER]:
            nc, nd = cross(
                genes[first], count[first], genes[second], count[second], coast, c, d, state, weight
            )
        crossed = nc > 0
        if not crossed:
            nc, nd = count[first], count[second]
            copy_genes(genes[first], nc, c)
            copy_genes(genes[second], nd, d)
        if not crossed or uniform(state) < habits[MUTATION]:
            nc = mutate(c, nc, coast, settings, habits, state, weight, spare)
        if not crossed or uniform(state) < habits[MUTATION]:
            nd = mutate(d, nd, coast, settings, habits, state, weight, spare)
        born[k, 0], born[k, 1] = nc, nd
