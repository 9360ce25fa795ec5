"""Turning points of many tracks at once: where a track leaves the great circle between others."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from thalweg.core.arrays.line_thinning import distances_from_arcs, mark_needed_points
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
    distances = partial(distances_from_arcs, vectors)
    mark_needed_points(keep, first, last, tolerance=tolerance, distances=distances)
