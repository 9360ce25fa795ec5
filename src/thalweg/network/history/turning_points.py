"""Turning points of many tracks at once: where a track leaves the great circle between others."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.history.voyage_tracks import VoyageTracks

_BLOCK: Final = 2_000_000  # positions that are worked on together


def turning_points(tracks: VoyageTracks, tolerance: float) -> BoolArray:
    """Return the positions that are needed to keep every track within a tolerance.

    Parameters
    ----------
    tracks : Tracks of voyages, n positions.
    tolerance : Greatest distance of a position from the simplified track [m].

    Returns
    -------
    bool ndarray (n,) : The first and last position of every track, and its turning points.

    References
    ----------
    Douglas and Peucker (1973), Cartographica 10 (2), on great circles; all parts of all tracks are
    divided together, level by level.
    """
    keep = np.zeros(len(tracks.lat), bool)
    keep[tracks.ptr[:-1]] = True
    keep[tracks.ptr[1:] - 1] = True
    begin = 0
    while begin < len(tracks):
        end = int(np.searchsorted(tracks.ptr, tracks.ptr[begin] + _BLOCK))
        end = min(max(end, begin + 1), len(tracks))
        _divide(tracks.vectors, tracks.ptr[begin:end], tracks.ptr[begin + 1 : end + 1] - 1,
                tolerance, keep)  # fmt: skip
        begin = end
    return keep


def stretch_turning_points(
    tracks: VoyageTracks, begin: FloatArray, end: FloatArray, tolerance: float
) -> BoolArray:
    """Return the positions that are needed to keep some stretches of tracks within a tolerance.

    Parameters
    ----------
    tracks : Tracks of voyages, n positions.
    begin, end : Where stretches begin and end, as `VoyageTracks.along` [m], (m,).
    tolerance : Greatest distance of a position from the simplified stretch [m].

    Returns
    -------
    bool ndarray (n,) : The turning points of the stretches, and the positions next to their ends.
    """
    keep = np.zeros(len(tracks.lat), bool)
    first = np.searchsorted(tracks.along, begin)
    last = np.searchsorted(tracks.along, end, side="right") - 1
    some = last >= first
    first, last = first[some], last[some]
    keep[first] = keep[last] = True
    _divide(tracks.vectors, first, last, tolerance, keep)
    return keep


def _divide(
    vectors: FloatArray, first: IntArray, last: IntArray, tolerance: float, keep: BoolArray
) -> None:
    """Mark the turning points between first and last positions."""
    while True:
        inside = last - first > 1
        first, last = first[inside], last[inside]
        if not len(first):
            return
        count = last - first - 1
        begins = np.cumsum(count) - count
        part = np.repeat(np.arange(len(first)), count)
        index = np.arange(len(part)) - begins[part] + first[part] + 1
        away = _distance_from_arcs(vectors, index, first, last, part)
        most = np.maximum.reduceat(away, begins)
        reached = np.flatnonzero(away == most[part])
        _, where = np.unique(part[reached], return_index=True)
        at = index[reached[where]]
        split = most > tolerance
        at, first, last = at[split], first[split], last[split]
        keep[at] = True
        first, last = np.concatenate([first, at]), np.concatenate([at, last])


def _distance_from_arcs(
    vectors: FloatArray, index: IntArray, first: IntArray, last: IntArray, part: IntArray
) -> FloatArray:
    """Return the distances of positions from the great circles between ends of their parts [m].

    Beyond the ends of the arc the distance to the nearer end counts.
    """
    a, b = vectors[first], vectors[last]
    normal = np.cross(a, b)
    size = np.sqrt(np.sum(normal**2, axis=1))
    normal /= np.where(size > 0.0, size, 1.0)[:, None]
    chord = b - a
    squared = np.sum(chord**2, axis=1)
    away = np.empty(len(index))
    along = np.empty(len(index))
    p = vectors[index]
    np.einsum("ij,ij->i", p, normal[part], out=away)
    np.abs(away, out=away)
    p -= a[part]
    np.einsum("ij,ij->i", p, chord[part], out=along)
    along /= np.where(squared > 0.0, squared, 1.0)[part]
    beyond = np.flatnonzero((along < 0.0) | (along > 1.0) | (squared[part] <= 0.0))
    if len(beyond):
        at, to = index[beyond], part[beyond]
        near = [np.sqrt(np.sum((vectors[at] - end[to]) ** 2, axis=1)) for end in (a, b)]
        away[beyond] = np.minimum(*near)
    return away
