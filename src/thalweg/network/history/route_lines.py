"""Lines of several arcs in turn: the ends of neighbouring arcs are moved to one place between them.

The line of an arc begins and ends where its voyage passed the junctions. The next arc is of another
voyage, which passed the junction beside. Near the junction both lines are moved, the farther from
it the less, so that they meet half way: the whole has neither a gap nor a corner, and the length of
a voyage.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.geodesy import Position, distance, geocentric_positions
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.history.arc_lines import ArcLines
from thalweg.network.history.voyage_tracks import sphere_vectors

_NEAR: Final = 100.0  # waypoints nearer than this to a new one are left out [m]
_APART: Final = 1.0  # ends nearer than this are one place [m]


def joined_line(lines: ArcLines, arcs: IntArray, at_junction: BoolArray, radius: float
                ) -> list[Position]:  # fmt: skip
    """Return the line along arcs in turn.

    Parameters
    ----------
    lines : Of all arcs.
    arcs : Arcs in order, (k,).
    at_junction : Whether an arc and the next meet at a junction, (k - 1,); at ports both lines stay
        as they are.
    radius : Within this distance of a junction lines are moved [m].

    Returns
    -------
    list of (lat, lon) : [deg].
    """
    some = lines.take(arcs)
    follows = np.flatnonzero(at_junction)
    moved = moved_to_each_other(some, follows, follows + 1, radius)
    lat, lon = moved.lat.tolist(), moved.lon.tolist()
    again = np.zeros(len(lat), bool)
    first = moved.ptr[1:-1]
    again[first] = (
        distance(moved.lat[first - 1], moved.lon[first - 1], moved.lat[first], moved.lon[first])
        <= _APART
    )
    return [place for place, same in zip(zip(lat, lon), again.tolist()) if not same]


def moved_to_each_other(
    lines: ArcLines, before: IntArray, after: IntArray, radius: float
) -> ArcLines:
    """Return lines of which some end where others begin: half way between both places.

    Parameters
    ----------
    before, after : Lines that follow each other; each line at most once in either, (m,).
    radius : Farther along than this from their ends lines stay [m]; of short ones a half.
    """
    vectors = sphere_vectors(lines.lat, lines.lon)
    first, last = lines.ptr[:-1], lines.ptr[1:] - 1
    apart = vectors[first[after]] - vectors[last[before]]
    far = np.sqrt(np.sum(apart**2, axis=1)) > _APART
    if not far.any():
        return lines
    before, after, apart = before[far], after[far], apart[far]
    shifts = np.zeros((2, len(lines), 3))
    shifts[0, after], shifts[1, before] = -0.5 * apart, 0.5 * apart
    step = np.concatenate([[0.0], np.ones(len(lines.lat) - 1)])  # between lines [m]
    step[lines.legs + 1] = np.maximum(lines.leg_lengths, 1e-6)
    along = np.cumsum(step)
    begin, end = along[first], along[last]
    reach = np.minimum(radius, 0.5 * (end - begin))
    added = np.concatenate([(begin + reach)[after], (end - reach)[before]])
    places = np.sort(np.concatenate([along, added]))
    line = np.searchsorted(begin, places, side="right") - 1
    found = np.stack([np.interp(places, along, vectors[:, k]) for k in range(3)], axis=-1)
    for shift, away in zip(shifts, (places - begin[line], end[line] - places)):
        found += np.maximum(1.0 - away / reach[line], 0.0)[:, None] * shift[line]
    lat, lon = geocentric_positions(found)
    ptr = np.append(np.searchsorted(line, np.arange(len(lines))), len(line))
    return ArcLines(ptr.astype(np.int64), np.asarray(lat, float), np.asarray(lon, float))


def following_arcs(tail: IntArray, head: IntArray, fixed: BoolArray) -> tuple[IntArray, IntArray]:
    """Return all pairs of arcs of which the second leaves the node where the first ends.

    Parameters
    ----------
    tail, head : Nodes of arcs, (A,).
    fixed : Nodes that are left out, (N,).

    Returns
    -------
    before, after : int64 ndarray (P,) : Arcs; not back to the node from where the first comes.
    """
    order = np.argsort(tail, kind="stable")
    low, high = (np.searchsorted(tail[order], head, side=side) for side in ("left", "right"))
    count = np.where(fixed[head], 0, high - low)
    before, rank = numbered_parts(count)
    after = order[low[before] + rank]
    onward = head[after] != tail[before]
    return before[onward], after[onward]


def attached_line(
    line: tuple[FloatArray, FloatArray], ends: tuple[Position, Position], margins: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return a line that begins and ends at given places.

    Parameters
    ----------
    line : Waypoints (lat, lon) [deg].
    ends : New begin and end [deg].
    margins : Length at the begin and at the end that the legs to these places replace [m], (2,); 0
        replaces the end only.
    """
    lat, lon = line
    along = cumulative_sums(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    low, high = margins[0], along[-1] - margins[1]
    inner = (along > low) & (along < high)
    inner[[0, -1]] = False
    cut = np.array([low, high])[margins > 0.0]
    vectors = sphere_vectors(lat, lon)
    cut_lat, cut_lon = geocentric_positions(
        np.stack([np.interp(cut, along, vectors[:, k]) for k in range(3)], axis=-1)
    )
    inner &= (np.abs(along[:, None] - cut) > _NEAR).all(axis=1)
    places = np.concatenate([along[inner], cut])
    order = np.argsort(places, kind="stable")
    inner_lat = np.concatenate([lat[inner], np.asarray(cut_lat, float)])[order]
    inner_lon = np.concatenate([lon[inner], np.asarray(cut_lon, float)])[order]
    return (
        np.concatenate([[ends[0][0]], inner_lat, [ends[1][0]]]),
        np.concatenate([[ends[0][1]], inner_lon, [ends[1][1]]]),
    )
