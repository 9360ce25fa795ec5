"""Geodesic grids: an icosahedron halved again and again, more often along coasts.

Seuren (2020), "Multi-objective weather routing", section 4.2.1: vertices of eq. 4.13, faces of
4.14, children ``(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)`` of a face (a, b, c) with its
normalised midpoints (his 4.15 and 4.16 agree only if each midpoint is named after the corner
opposite). Level L has ``10 * 4**L + 2`` vertices, ``30 * 4**L`` edges and ``20 * 4**L`` faces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import BoolArray, FloatArray, Int32Array, IntArray
from thalweg.kernels.geometry import triangle_subdivision as kernels

_PHI = (1.0 + np.sqrt(5.0)) / 2.0
_VERTICES = [
    (-1, _PHI, 0), (1, _PHI, 0), (-1, -_PHI, 0), (1, -_PHI, 0),
    (0, -1, _PHI), (0, 1, _PHI), (0, -1, -_PHI), (0, 1, -_PHI),
    (_PHI, 0, -1), (_PHI, 0, 1), (-_PHI, 0, -1), (-_PHI, 0, 1),
]  # fmt: skip
_FACES = [
    (1, 12, 6), (1, 6, 2), (1, 2, 8), (1, 8, 11), (1, 11, 12),
    (2, 6, 10), (6, 12, 5), (12, 11, 3), (11, 8, 7), (8, 2, 9),
    (4, 10, 5), (4, 5, 3), (4, 3, 7), (4, 7, 9), (4, 9, 10),
    (5, 10, 6), (3, 5, 12), (7, 3, 11), (9, 7, 8), (10, 9, 2),
]  # fmt: skip

#: Which of some edges, given by the unit vectors of their ends, call for halving.
CrossingTest: TypeAlias = Callable[[FloatArray, FloatArray], BoolArray]


@dataclass(frozen=True)
class RefinementRule:
    """Refinement of faces beyond the level of the grid: those with a crossed edge.

    Attributes
    ----------
    crossed : Returns which edges (unit vectors of their ends) are crossed.
    levels : Number of extra levels of such faces.
    """

    crossed: CrossingTest
    levels: int


@dataclass(frozen=True)
class Icosphere:
    """A geodesic grid.

    Attributes
    ----------
    vertices : float64[V, 3]
        Unit vectors.
    faces : int64[F, 3]
        Leaf faces, counter-clockwise seen from outside.
    keys, middles : int64[H]
        Halved edges ``smaller * 2**31 + larger``, ascending, and the vertex in their middle.
    """

    vertices: FloatArray
    faces: IntArray
    keys: IntArray
    middles: IntArray

    def pairs(self) -> tuple[Int32Array, Int32Array]:
        """Return the pairs of vertices, each once, that join the leaf faces without holes.

        Neighbours along the boundary of every leaf, vertices that hang on it included, and every
        two vertices of a leaf's boundary that do not lie on one side.
        """
        none = np.empty(0, np.int32)
        table = (self.keys, self.middles, self.faces)
        _, longest = kernels.leaf_face_pairs(*table, 0, none, none)
        count, _ = kernels.leaf_face_pairs(*table, longest, none, none)
        first, second = np.empty(count, np.int32), np.empty(count, np.int32)
        kernels.leaf_face_pairs(*table, longest, first, second)
        return edge_vertices(sorted_unique(edge_keys(first, second)))

    def across(self) -> tuple[Int32Array, Int32Array]:
        """Return the pairs of vertices that face each other across the common side of two leaves.

        They double the directions of a grid: twelve instead of six.
        """
        faces = self.faces
        sides = np.concatenate([edge_keys(faces[:, s], faces[:, (s + 1) % 3]) for s in range(3)])
        opposite = np.concatenate([faces[:, (s + 2) % 3] for s in range(3)])
        order = np.argsort(sides, kind="stable")
        sides, opposite = sides[order], opposite[order]
        twice = np.flatnonzero(sides[1:] == sides[:-1])
        return edge_vertices(sorted_unique(edge_keys(opposite[twice], opposite[twice + 1])))


def icosphere(level: int, *rules: RefinementRule) -> Icosphere:
    """Return the geodesic grid of a level, with extra levels where edges cross a coast.

    Parameters
    ----------
    level : Halvings of the whole grid.
    *rules : Where it is halved further.
    """
    grid = _Subdivision(np.array(_VERTICES) / np.hypot(1.0, _PHI))
    faces = np.array(_FACES, np.int64) - 1
    for _ in range(level):
        faces = grid.halved(faces)
    leaves: list[IntArray] = []
    depth = level
    while len(faces):
        split = np.zeros(len(faces), bool)
        for rule in rules:
            candidates = np.flatnonzero(~split)
            if depth - level < rule.levels and len(candidates):
                split[candidates] = grid.crossed_faces(faces[candidates], rule.crossed)
        leaves.append(faces[~split])
        faces = grid.halved(faces[split])
        depth += 1
    return Icosphere(grid.vertices, np.concatenate(leaves), *grid.table())


class _Subdivision:
    """A grid while it is halved: vertices, and edges halved so far."""

    def __init__(self, vertices: FloatArray) -> None:
        self.vertices = vertices
        self._keys = np.empty(0, np.int64)
        self._middles = np.empty(0, np.int64)

    def table(self) -> tuple[IntArray, IntArray]:
        """Return the halved edges, ascending, and their middles."""
        return self._keys, self._middles

    def halved(self, faces: IntArray) -> IntArray:
        """Return the four children of every face; neighbours share their midpoints."""
        if not len(faces):
            return faces
        a, b, c = faces.T
        ab, bc, ca = self._middle(np.stack([edge_keys(a, b), edge_keys(b, c), edge_keys(c, a)]))
        children = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        return np.concatenate([np.stack(child, axis=-1) for child in children])

    def _middle(self, keys: IntArray) -> IntArray:
        wanted, which = np.unique(keys, return_inverse=True)
        place = np.searchsorted(self._keys, wanted)
        inside = place < len(self._keys)
        known = np.zeros(len(wanted), bool)
        known[inside] = self._keys[place[inside]] == wanted[inside]
        fresh = wanted[~known]
        first, second = edge_vertices(fresh)
        sums = self.vertices[first] + self.vertices[second]
        numbers = len(self.vertices) + np.arange(len(fresh))
        self.vertices = np.concatenate(
            [self.vertices, sums / np.linalg.norm(sums, axis=1, keepdims=True)]
        )
        self._keys = np.concatenate([self._keys, fresh])
        order = np.argsort(self._keys, kind="stable")
        self._keys = self._keys[order]
        self._middles = np.concatenate([self._middles, numbers])[order]
        middles = self._middles[np.searchsorted(self._keys, wanted)]
        return np.asarray(middles[which.ravel()].reshape(keys.shape))

    def crossed_faces(self, faces: IntArray, crossed: CrossingTest) -> BoolArray:
        """Return which faces have a crossed edge; every edge is tested once."""
        keys = np.concatenate([edge_keys(faces[:, s], faces[:, (s + 1) % 3]) for s in range(3)])
        edges, which = np.unique(keys, return_inverse=True)
        first, second = edge_vertices(edges)
        answer = crossed(self.vertices[first], self.vertices[second])
        return np.asarray(answer[which.ravel()].reshape(3, -1).any(axis=0))


def edge_keys(a: NDArray[np.integer], b: NDArray[np.integer]) -> IntArray:
    """Return one number for each edge, the same for both directions."""
    return (np.minimum(a, b).astype(np.int64) << 31) + np.maximum(a, b)


def sorted_unique(keys: IntArray) -> IntArray:
    """Return ascending numbers, each once (`numpy.unique` hashes, ten times slower on these)."""
    ordered = np.sort(keys)
    return ordered[np.append(True, ordered[1:] != ordered[:-1])] if len(keys) else ordered


def edge_vertices(keys: IntArray) -> tuple[Int32Array, Int32Array]:
    """Return the two vertices of edges given by number, the smaller first."""
    return (keys >> 31).astype(np.int32), (keys & (2**31 - 1)).astype(np.int32)
