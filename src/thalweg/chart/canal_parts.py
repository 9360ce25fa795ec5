"""Parts of ship canals: from a port on the banks to the far end, and the legs of tracks there.

A ship from a port on a canal enters it at a gate or on the way, and sails the rest of its line. The
time of a part is its share of the length; the dues are those of the whole canal, once a passage.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.approaches import (
    LONGEST_JOINT,
    ON_LINE,
    PortApproach,
    PortApproaches,
    dense_line,
    line_part,
    place_along_line,
)
from thalweg.chart.canals import Canal
from thalweg.core.geodesy import Position, distance, line_length
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE

_ON_BANKS: Final = 8.0 * NAUTICAL_MILE  # a berth within this of the inner line is on the canal
#: Longest joint of an approach and the inner line: harbours lie beside the charted line.
LONGEST_CANAL_JOINT: Final = 3.5 * NAUTICAL_MILE
_JOINT_FACTOR: Final = 3.0  # what a mile of a joint counts more: it may cross land
_LEAST_PART: Final = 5.0 * NAUTICAL_MILE  # of a canal, or the way is no other than the approach
_CUT_BENDS: Final = 0.25  # share of a line by which a leg from one of its bends to another is short


def ways_through_canals(
    approach: PortApproach, canals: Sequence[Canal]
) -> tuple[PortApproach, ...]:
    """Return the ways from a berth on the banks of canals through them to their ends.

    Parameters
    ----------
    approach : Of the table.
    canals : Of the chart.

    Returns
    -------
    tuple of PortApproach : With `PortApproach.through`; empty for ports that are not on a canal.
    """
    found = []
    for canal in canals:
        middle = np.array(canal.inner_line)
        north = np.abs(middle[:, 0] - approach.berth[0]).min()
        if north > 1.0:  # far from every vertex, in degrees
            continue
        for inner, last in (
            (canal.inner_line, canal.path[-1]),
            (canal.inner_line[::-1], canal.path[0]),
        ):
            way = _way_through(approach, canal, (*inner, last))
            if way is not None:
                found.append(way)
    return tuple(found)


def _way_through(
    approach: PortApproach, canal: Canal, line: tuple[Position, ...]
) -> PortApproach | None:
    """Return the way from a berth along the line of a canal to its end; None if there is none."""
    along, through = dense_line(approach.line), dense_line(line)
    inner = through[through[:, 2] <= through[-1, 2] - float(distance(*line[-2], *line[-1]))]
    if float(np.min(distance(*approach.berth, inner[:, 0], inner[:, 1]))) > _ON_BANKS:
        return None
    apart = np.asarray(distance(along[:, None, 0], along[:, None, 1], inner[:, 0], inner[:, 1]))
    left = through[-1, 2] - inner[:, 2]
    counted = along[:, None, 2] + _JOINT_FACTOR * apart + left
    counted[apart > LONGEST_CANAL_JOINT] = np.inf
    at, first = (int(k) for k in np.unravel_index(np.argmin(counted), counted.shape))
    if not np.isfinite(counted[at, first]) or inner[-1, 2] - inner[first, 2] < _LEAST_PART:
        return None
    rest = tuple(line_part(line[::-1], float(left[first]))[::-1])
    kept = line_part(approach.line, float(along[at, 2]))
    places = (*kept, *rest)
    return replace(
        approach,
        line=tuple(a for k, a in enumerate(places) if k == 0 or a != places[k - 1]),
        way=f"through the {canal.title}",
        source=f"{approach.source}; {canal.source}",
        through=canal.name,
        through_length=line_length(rest),
        through_time=canal.transit_time * line_length(rest) / canal.length,
    )


def part_number_of_legs(
    canals: Sequence[Canal], lat: FloatArray, lon: FloatArray
) -> NDArray[np.int64]:
    """Return along which canal's line each leg of a track runs; -1 for none.

    Parameters
    ----------
    canals : Of the chart.
    lat, lon : Waypoints [deg], (n,).

    Returns
    -------
    int64 array (n - 1,) : Legs from an end of a canal to the other are not meant: they are -1. Legs
        between two bends are, also where a file leaves out one between them.
    """
    number = np.full(len(lat) - 1, -1, np.int64)
    for k, canal in enumerate(canals):
        path = np.array(canal.path)
        low, high = path.min(axis=0) - 0.01, path.max(axis=0) + 0.01
        box = (lat > low[0]) & (lat < high[0]) & (lon > low[1]) & (lon < high[1])
        for leg in np.flatnonzero(box[:-1] & box[1:]).tolist():
            a, b = ((float(lat[i]), float(lon[i])) for i in (leg, leg + 1))
            length = float(distance(*a, *b))
            here, there = place_along_line(canal.path, a), place_along_line(canal.path, b)
            if here is None or there is None or length < 1.0:
                continue
            sailed = abs(there - here)
            whole = sailed >= canal.length - 2.0 * ON_LINE
            slack = 2.0 * ON_LINE + _CUT_BENDS * sailed
            if not whole and abs(sailed - length) <= slack and _is_inside(canal, here, there):
                number[leg] = k
    return number


def joints_to_canals(
    canals: Sequence[Canal], approaches: PortApproaches, number: NDArray[np.int64], line: FloatArray
) -> set[int]:
    """Return the legs that join approaches to the inner lines of canals.

    Parameters
    ----------
    canals : Of the chart.
    approaches : Of the chart.
    number : By `part_number_of_legs`, (n - 1,).
    line : Waypoints (lat, lon) [deg], (n, 2).
    """
    found: set[int] = set()
    for leg in np.flatnonzero(number >= 0).tolist():
        canal = canals[number[leg]]
        for step in (-1, 1):
            sailed, chain, at = 0.0, [], leg + max(step, 0)
            if place_along_line(canal.inner_line, _place(line, at)) is None:
                continue
            while 0 <= at + step < len(line) and number[at + min(step, 0)] < 0:
                here, at = at, at + step
                chain.append(min(here, at))
                sailed += float(distance(*line[here], *line[at]))
                if sailed > LONGEST_CANAL_JOINT + LONGEST_JOINT:
                    break
                if approaches.is_on_line(*_place(line, at)):
                    found.update(chain)
                    break
    return found


def _place(line: FloatArray, at: int) -> Position:
    return float(line[at, 0]), float(line[at, 1])


def _is_inside(canal: Canal, here: float, there: float) -> bool:
    """Return whether a part of a path [m] is the inner line, or the leg from it to an end."""
    margin = 2.0 * ON_LINE
    first = float(distance(*canal.path[0], *canal.path[1]))
    last = canal.length - float(distance(*canal.path[-2], *canal.path[-1]))
    low, high = min(here, there), max(here, there)
    return (
        (low >= first - margin and high <= last + margin)
        or (low <= margin and high <= first + margin)
        or (high >= canal.length - margin and low >= last - margin)
    )


def first_legs_of_transits(number: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return the first leg of each passage of a part of a canal, by `part_number_of_legs`."""
    before = np.concatenate([[-1], number[:-1]])
    return np.asarray((number >= 0) & (number != before))


def canal_part(canal: Canal, start: Position, goal: Position, *, pays: bool) -> Canal:
    """Return the part of a canal between two positions on its line [deg].

    Parameters
    ----------
    pays : Whether the dues count on this leg.
    """
    share = float(distance(*start, *goal)) / canal.length
    return replace(
        canal,
        path=(start, goal),
        transit_time=max(canal.transit_time * share, 1e-3),
        fee=canal.fee if pays else 0.0,
        fee_basis=canal.fee_basis if pays else "",
    )
