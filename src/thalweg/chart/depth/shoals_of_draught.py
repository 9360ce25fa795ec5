"""Shoal water for a draught, with the channels that the depth layer lacks.

These are the lines of narrow passages and of passages with a largest draught, and the table
``data/deep_channels.csv``: name, largest draught, source, line. The table has routes of deep ships
in which the layer has sills that are not there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.depth.shoals import Shoals, safety_contour
from thalweg.chart.passages import Passage, read_line
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position, densify
from thalweg.core.units import NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.coast.coastline import Coastline

_STEP: Final = 1.0 * NAUTICAL_MILE
_NARROW: Final = 3.0 * NAUTICAL_MILE  # half width of passages that the depth layer does not show


@dataclass(frozen=True)
class DeepChannel:
    """A route of deep ships that the depth layer shows too shallow; largest draught [m]."""

    name: str
    max_draught: float
    line: tuple[Position, ...]
    source: str


@cache
def deep_channels() -> tuple[DeepChannel, ...]:
    """Return the table of deep channels."""
    found = []
    for row in table_rows("thalweg.chart", "deep_channels.csv"):
        line = read_line(row["line"])
        found.append(DeepChannel(row["name"], float(row["max_draught_m"]), line, row["source"]))
    return tuple(found)


def shoals_of_draught(
    chart: Chart, draught: float, least: float, harbours: Sequence[Position]
) -> Shoals:
    """Return the shoal water for a draught.

    Parameters
    ----------
    chart : With the passages that may be used.
    draught : [m], above 0.
    least : Depth that the ship requires [m].
    harbours : (lat, lon) [deg]: round them the layer does not count.
    """
    contour = safety_contour(draught)
    lines = list(_passage_channels(chart.coastline, tuple(chart.passages)))
    lines += [channel.line for channel in deep_channels() if draught <= channel.max_draught]
    return Shoals(contour, min(least, 0.9 * contour), tuple(lines), tuple(harbours))


@lru_cache(maxsize=2)  # the same for all draughts
def _passage_channels(
    coastline: Coastline, passages: tuple[Passage, ...]
) -> tuple[tuple[Position, ...], ...]:
    return tuple(line for passage in passages for line in _channels(coastline, passage))


def _channels(coastline: Coastline, passage: Passage) -> list[tuple[Position, ...]]:
    """Return the parts of the line of a passage that count as deep.

    Its line is the widest way between coasts and may lead over banks far from land. It counts as a
    whole where the passage has a largest draught, else near land, where the layer shows no channel.
    """
    if passage.use == "never":
        return []
    if passage.max_draught < math.inf:
        return [passage.line]
    if passage.half_width >= _NARROW:
        return []
    lat, lon, _ = densify(*passage.positions, _STEP)
    near = np.asarray(coastline.shore_distance(lat, lon, cap=2.0 * _NARROW)) < _NARROW
    starts = np.flatnonzero(near & ~np.append(False, near[:-1]))
    ends = np.flatnonzero(near & ~np.append(near[1:], False))
    return [
        tuple(zip(lat[a : b + 1].tolist(), lon[a : b + 1].tolist()))
        for a, b in zip(starts, ends)
        if b > a
    ]
