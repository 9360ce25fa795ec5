"""The ways between a berth and the sea: the approach, its branches, and where canals meet it.

A branch (`thalweg.chart.approach_branches`) is open to every port whose approach comes within
`LONGEST_JOINT` of it. The ends of canals are branches as well, and those of named passages that the
approach does not follow. A port on a canal has ways through it (`thalweg.chart.canal_parts`).

Approaches lead to open sea on one side. A voyage to the other side, or to a port on the same bay,
leaves the line before its sea end (`may_leave_early`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.approach_branches import ApproachBranch, approach_branches
from thalweg.chart.approaches import (
    JOINT_SPACING,
    LONGEST_JOINT,
    PortApproach,
    dense_line,
    line_part,
)
from thalweg.chart.canal_parts import ways_through_canals
from thalweg.chart.canals import Canal
from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.coast.snapping import LegTest
from thalweg.chart.passages import Passage
from thalweg.core.geodesy import METRES_PER_DEGREE, Position, distance, longitude_difference
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE

_FAR_IN_LATITUDE = 4.0  # branches farther from the berth than this are not tested [deg]
_CANAL_REACH = 2.0 * NAUTICAL_MILE  # between an approach and the end of a canal in open water
#: A line is left before its sea end at least so far from charted land [m].
LEAST_OFF_LAND: Final = 0.5 * NAUTICAL_MILE
_LEAST_BEYOND = 3.0 * NAUTICAL_MILE  # of the line beyond the first such place
_LEAST_LEFT_OUT = 1_000.0  # of the main line by leaving it, or the way is not one of its own [m]
_SAME_WATER: Final = 0.15 * NAUTICAL_MILE  # lines so close are joined without a test
_BLOCK: Final = 10  # places of dense lines that are first tested by one of them
_JOINTS_AT_ONCE: Final = 200  # joints tested against land at once


def approach_choices(
    approach: PortApproach, canals: Sequence[Canal] = (), passages: Sequence[Passage] = ()
) -> tuple[PortApproach, ...]:
    """Return the ways between a berth and the waters that its approach leads to.

    Parameters
    ----------
    approach : Of the table.
    canals : Of the chart; a way ends where the approach passes the end of one.
    passages : The same.

    Returns
    -------
    tuple of PortApproach : The approach itself, then those by branches, with `PortApproach.way`.
    """
    ends = (
        ApproachBranch(canal.title, (end,), approach.source, canal.name)
        for canal in canals
        for end in canal.ends
    )
    through = ways_through_canals(approach, canals)
    mouths = _passage_mouths(approach, passages)
    near = [
        branch
        for branch in (*approach_branches(), *ends, *mouths)
        if abs(branch.line[0][0] - approach.berth[0]) < _FAR_IN_LATITUDE
    ]
    if not near:
        return (approach, *through)
    along = dense_line(approach.line)
    others = (_by_branch(approach, along, branch) for branch in near)
    return (approach, *(other for other in others if other is not None), *through)


def may_leave_early(approach: PortApproach, coastline: Coastline) -> bool:
    """Return whether much of an approach lies beyond the first place at `LEAST_OFF_LAND`.

    Parameters
    ----------
    approach : Of the table.
    coastline : Of the chart.
    """
    if approach.length < _LEAST_BEYOND:
        return False
    along = dense_line(approach.line)
    off = coastline.shore_distance(along[:, 0], along[:, 1], cap=LEAST_OFF_LAND)
    first = int(np.argmax(np.asarray(off) >= LEAST_OFF_LAND))
    return bool(off[first] >= LEAST_OFF_LAND and along[-1, 2] - along[first, 2] >= _LEAST_BEYOND)


def _passage_mouths(
    approach: PortApproach, passages: Sequence[Passage]
) -> Iterator[ApproachBranch]:
    """Return the ends of passages that an approach meets, without those it leads through."""
    lat, lon = (part[:, None] for part in dense_line(approach.line).T[:2])
    for passage in passages:
        ends = passage.line[0], passage.line[-1]
        if abs(ends[0][0] - approach.berth[0]) < _FAR_IN_LATITUDE:
            met = distance(lat, lon, *np.array(ends, float).T).min(axis=0) <= LONGEST_JOINT
            if met.sum() == 1:
                end = ends[int(np.argmax(met))]
                yield ApproachBranch(f"the entrance of {passage.name}", (end,), passage.source)


def _by_branch(
    approach: PortApproach, along: FloatArray, branch: ApproachBranch
) -> PortApproach | None:
    """Return the way that leaves an approach for a branch, the shortest one; None if not near."""
    places = np.array(branch.line, float)
    apart = np.asarray(distance(along[:, None, 0], along[:, None, 1], *places.T[:, None, :]))
    reach = _CANAL_REACH if branch.canal else LONGEST_JOINT
    if apart.min() > reach:
        return None
    left = np.append(np.cumsum(distance(*places[:-1].T, *places[1:].T)[::-1])[::-1], 0.0)
    total = np.where(apart <= reach, along[:, None, 2] + apart + left, np.inf)
    at, first = (int(k) for k in np.unravel_index(np.argmin(total), total.shape))
    if len(branch.line) == 1:  # off the place itself
        at = int(np.argmin(apart[:, 0]))
        if along[-1, 2] - along[at, 2] < _LEAST_LEFT_OUT:
            return None
    if _is_main(approach, branch, float(total[at, first])):
        return None
    kept = line_part(approach.line, float(along[at, 2]))
    more = branch.line[first:] if len(branch.line) > 1 else ()
    way = f"to the {branch.name}" if branch.canal else f"by {branch.name}"
    source = approach.source if branch.canal else f"{approach.source}; {branch.source}"
    line = tuple(a for k, a in enumerate((*kept, *more)) if k == 0 or a != (*kept, *more)[k - 1])
    return replace(
        approach,
        line=line,
        way=way,
        source=source,
        canal=branch.canal,
        way_draught=branch.max_draught,
        way_length=branch.max_length,
    )


def _is_main(approach: PortApproach, branch: ApproachBranch, length: float) -> bool:
    """Return whether a way of a length [m] by a branch is no other than the approach itself."""
    same_end = float(distance(*approach.sea_end, *branch.line[-1])) < _LEAST_LEFT_OUT
    return same_end and length > approach.length - _LEAST_LEFT_OUT


def line_between(
    start: PortApproach, goal: PortApproach, *, legs_blocked: LegTest
) -> tuple[Position, ...] | None:
    """Return the line from one berth to another along their approaches, where these meet.

    Parameters
    ----------
    legs_blocked : Test of legs (lat1, lon1, lat2, lon2) [deg], as of `thalweg.chart.Chart`.

    Returns
    -------
    tuple of (lat, lon), or None : None where the two approaches do not meet before the open sea.
    """
    if _far_apart(start.line, goal.line):
        return None
    i, j, apart = _close_pairs(first := dense_line(start.line), second := dense_line(goal.line))
    order = np.argsort(first[i, 2] + apart + second[j, 2], kind="stable")
    for some in np.array_split(order, len(order) // _JOINTS_AT_ONCE + 1):
        far = apart[some] > _SAME_WATER
        free = ~far
        free[far] = ~legs_blocked(*first[i[some[far]], :2].T, *second[j[some[far]], :2].T)
        if free.any():
            best = some[np.argmax(free)]
            end = line_part(goal.line, second[j[best], 2])[::-1]
            line = [*line_part(start.line, first[i[best], 2]), *end]
            return tuple(
                a for k, a in enumerate(line) if k == 0 or float(distance(*a, *line[k - 1])) > 1.0
            )
    return None


def _close_pairs(
    first: FloatArray, second: FloatArray
) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
    """Return the pairs of places of two dense lines that a joint can join, and how far apart [m].

    Every tenth place is tested first: lines of rivers are long.
    """
    reach = LONGEST_JOINT + 2.0 * _BLOCK * JOINT_SPACING
    rough = _metres_apart(first[::_BLOCK, None], second[None, ::_BLOCK])
    blocks = _BLOCK * np.argwhere(rough <= reach)
    i, j = np.moveaxis(blocks[:, None, :] + np.argwhere(np.ones((_BLOCK, _BLOCK))), -1, 0)
    inside = (i < len(first)) & (j < len(second))
    i, j = i[inside], j[inside]
    apart = _metres_apart(first[i], second[j])
    close = apart <= LONGEST_JOINT
    return i[close], j[close], apart[close]


def _metres_apart(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return distances [m] of places (lat, lon, ...) [deg] near each other."""
    east = longitude_difference(a[..., 1], b[..., 1]) * np.cos(np.radians(a[..., 0]))
    return np.asarray(np.hypot(a[..., 0] - b[..., 0], east) * METRES_PER_DEGREE)


def _far_apart(first: tuple[Position, ...], second: tuple[Position, ...]) -> bool:
    """Return whether the latitudes of two lines are farther apart than any joint."""
    a, b = ([place[0] for place in line] for line in (first, second))
    gap = max(min(a) - max(b), min(b) - max(a))
    return gap * METRES_PER_DEGREE > 1.01 * LONGEST_JOINT
