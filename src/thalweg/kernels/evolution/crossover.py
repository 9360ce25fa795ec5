"""Children of tracks: crossover, and the operators of `thalweg.kernels.evolution.mutation`.

Every child has a stream of random numbers of its own (SplitMix64), so that a population is the same
to the bit in any number of threads.
"""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import OK
from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.evolution.mutation import (
    CROSSOVER_PROBABILITY,
    MUTATION_PROBABILITY,
    RADIANS,
    copy_genes,
    mutate,
    planar_difference,
)
from thalweg.kernels.evolution.random_numbers import random_below, random_uniform
from thalweg.kernels.geometry.coast_index import leg_code
from thalweg.kernels.leg.population_sailing import (
    FIXED_TIME,
    GENE_COLUMNS,
    IS_LOOKED_UP,
    IS_REQUIRED,
    LAT,
    LON,
    PIECES,
    TrackGenes,
)

_MAX_PARTNER_POINTS = 3  # points of the other parent that a crossover tries
_MAX_CROSSOVER_POINTS = 8  # points of the first parent that it tries


class VariationWorkspace(NamedTuple):
    """Work space of variation.

    Attributes
    ----------
    genes : float64[K, M, GENE_COLUMNS]
    weights : float64[K, 2 * M]
    """

    genes: np.ndarray
    weights: np.ndarray


@kernel_only
def _count_required_points(genes, first, last):
    total = 0
    for p in range(first, last):
        total += genes[p, IS_REQUIRED] != 0.0
    return total


@kernel_only
def _nearest(a, genes, count, weight, tried):
    """Return the nearest interior point of a track that is not tried yet, or -1."""
    best, least = -1, math.inf
    scale = math.cos(a[LAT] * RADIANS)
    for j in range(1, count - 1):
        is_new = True
        for k in range(tried):
            is_new &= weight[k] != j
        x, y = planar_difference(a, genes[j], scale)
        if is_new and x * x + y * y < least:
            best, least = j, x * x + y * y
    return best


@kernel_only
def _is_valid_junction(a, b, coast):
    """Return whether a leg between points of two parents has a length and is clear."""
    if abs(a[LAT] - b[LAT]) + abs(a[LON] - b[LON]) < 1e-9:
        return False
    return leg_code(coast, a[LAT], a[LON], b[LAT], b[LON])[0] == OK


@kernel_only
def _splice(head, i, tail, j, count, target):
    """Write head[..i - 1] + tail[j..] and return its number of points."""
    copy_genes(head, i, target)
    for p in range(j, count):
        for c in range(GENE_COLUMNS):
            target[i + p - j, c] = tail[p, c]
    target[i - 1, IS_LOOKED_UP], target[i - 1, PIECES] = 0.0, 0.0
    target[i - 1, FIXED_TIME] = math.nan
    return i + count - j


@kernel_only
def crossover(first, second, coast, c, d, state, weight):
    """Cross two tracks at neighbouring waypoints; return points of the children, or (0, 0).

    The parents are `TrackGenes`; the genes of the children are written into ``c`` and ``d``.
    """
    na, a = first
    nb, b = second
    room = c.shape[0]
    if na < 3 or nb < 3:
        return 0, 0
    for _ in range(_MAX_CROSSOVER_POINTS):
        i = 1 + random_below(state, na - 2)
        for tried in range(min(_MAX_PARTNER_POINTS, nb - 2)):
            j = _nearest(a[i], b, nb, weight, tried)
            weight[tried] = j
            if i + nb - j > room or j + na - i > room:
                continue
            if _count_required_points(a, 0, i) != _count_required_points(
                b, 0, j
            ) or _count_required_points(a, i, na) != _count_required_points(b, j, nb):
                continue
            if _is_valid_junction(a[i - 1], b[j], coast) and _is_valid_junction(
                b[j - 1], a[i], coast
            ):
                return _splice(a, i, b, j, nb, c), _splice(b, j, a, i, na, d)
    return 0, 0


@allocation_free
def make_offspring(
    parents, pairs, coast, settings, variation_settings, states, offspring, workspace
):
    """Make two children of each pair of parents.

    Parameters
    ----------
    parents : TrackGenes
        Of N tracks.
    pairs : int64[K, 2]
        Indices of the parents of each pair.
    coast : CoastArrays
        Land and no-go zones. New legs avoid them if a few trials succeed.
    settings : int
        Number of settings of the ship.
    variation_settings : float64[VARIATION_SETTING_COUNT]
    states : uint64[K, 1]
        A seed for each pair.
    offspring : TrackGenes
        Of (K, 2) children; filled.
    workspace : VariationWorkspace
    """
    count, genes = parents
    for k in range(pairs.shape[0]):
        first, second = pairs[k, 0], pairs[k, 1]
        state, weight, spare = states[k], workspace.weights[k], workspace.genes[k]
        c, d = offspring.genes[k, 0], offspring.genes[k, 1]
        nc, nd = 0, 0
        if random_uniform(state) < variation_settings[CROSSOVER_PROBABILITY]:
            one = TrackGenes(count[first], genes[first])
            other = TrackGenes(count[second], genes[second])
            nc, nd = crossover(one, other, coast, c, d, state, weight)
        crossed = nc > 0
        if not crossed:
            nc, nd = count[first], count[second]
            copy_genes(genes[first], nc, c)
            copy_genes(genes[second], nd, d)
        if not crossed or random_uniform(state) < variation_settings[MUTATION_PROBABILITY]:
            nc = mutate(c, nc, coast, settings, variation_settings, state, weight, spare)
        if not crossed or random_uniform(state) < variation_settings[MUTATION_PROBABILITY]:
            nd = mutate(d, nd, coast, settings, variation_settings, state, weight, spare)
        offspring.count[k, 0], offspring.count[k, 1] = nc, nd
