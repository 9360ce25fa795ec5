"""Shoal water for a draught, with the channels of narrow passages that the depth layer lacks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.depth.shoals import Shoals, safety_contour
from thalweg.chart.passages import Passage
from thalweg.core.geodesy import Position, densify
from thalweg.core.units import NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.chart import Chart

_STEP: Final = 1.0 * NAUTICAL_MILE
_NARROW: Final = 3.0 * NAUTICAL_MILE  # half width of passages that the depth layer does not show


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
    lines = tuple(line for passage in chart.passages for line in _channels(chart, passage))
    return Shoals(contour, min(least, 0.9 * contour), lines, tuple(harbours))


def _channels(chart: Chart, passage: Passage) -> list[tuple[Position, ...]]:
    """Return the parts of the line of a passage that count as deep.

    Its line is the widest way between coasts and may lead over banks far from land. It counts as a
    whole where the passage has a largest draught, else near land, where the layer shows no channel.
    """
    if passage.use == "never" or passage.half_width >= _NARROW:
        return []
    if passage.max_draught < math.inf:
        return [passage.line]
    lat, lon, _ = densify(*passage.positions, _STEP)
    near = np.asarray(chart.coastline.shore_distance(lat, lon, cap=2.0 * _NARROW)) < _NARROW
    starts = np.flatnonzero(near & ~np.append(False, near[:-1]))
    ends = np.flatnonzero(near & ~np.append(near[1:], False))
    return [
        tuple(zip(lat[a : b + 1].tolist(), lon[a : b + 1].tolist()))
        for a, b in zip(starts, ends)
        if b > a
    ]
