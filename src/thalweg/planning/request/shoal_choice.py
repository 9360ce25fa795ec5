"""Shoal water of a voyage: whether a mile in it counts more, and from which contour on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.depth.global_depth import NAME
from thalweg.chart.depth.shoals import Shoals, safety_contour
from thalweg.chart.passages import Passage
from thalweg.core.geodesy import Position, densify
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.offing_choice import chosen_offing
from thalweg.planning.request.requirements import required_under_keel_clearance
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.voyage import Voyage
from thalweg.sea import Sea, standard_names
from thalweg.ship import Ship

_STEP: Final = 1.0 * NAUTICAL_MILE
_NARROW: Final = 3.0 * NAUTICAL_MILE  # half width of passages that the depth layer does not show


def add_shoals(
    chart: Chart, voyage: Voyage, ship: Ship, sea: Sea, ends: Sequence[Endpoint]
) -> tuple[Chart, list[str]]:
    """Return the chart with the shoal water of a ship, and a note.

    Charts of the world's coasts get it, where neither they nor the sea provide depth, for voyages
    that keep an offing. Narrow passages that the ship may use count as deep along their lines.

    Parameters
    ----------
    chart : With the passages that the ship may use.
    ends : Round them the layer does not count.

    Returns
    -------
    chart : Chart
    notes : list of str
    """
    draught = float(ship.draught)
    depth_known = chart.has_depth or standard_names.BED_DEPTH in sea.variables
    near_land = chosen_offing(voyage, ship) <= 0.0
    if voyage.ignore_shoals or depth_known or chart.approaches is None or near_land:
        return chart, []
    if not draught > 0.0:
        return chart, ["Shoals were not avoided: the draught of the ship is not known."]
    least = draught + required_under_keel_clearance(voyage, ship)
    shoals = shoals_of_draught(chart, draught, least, ends)
    note = (
        f"Keeps out of water shallower than {shoals.contour:g} m where it can: a mile there counts "
        f"up to 20 by the {NAME} and the named shoal areas; not near the ends and in narrow "
        "passages."
    )
    return replace(chart, zones=replace(chart.zones, shoals=shoals)), [note]


def shoals_of_draught(
    chart: Chart, draught: float, least: float, ends: Sequence[Endpoint]
) -> Shoals:
    """Return the shoal water for a draught.

    Parameters
    ----------
    chart : With the passages that may be used.
    draught : [m], above 0.
    least : Depth that the ship requires [m].
    ends : Round them the layer does not count.
    """
    contour = safety_contour(draught)
    lines = tuple(line for passage in chart.passages for line in _channels(chart, passage))
    harbours = tuple((float(end.lat), float(end.lon)) for end in ends)
    return Shoals(contour, min(least, 0.9 * contour), lines, harbours)


def _channels(chart: Chart, passage: Passage) -> list[tuple[Position, ...]]:
    """Return the parts of the line of a passage that count as deep.

    Its line is the widest way between coasts and may lead over banks far from land. It counts as a
    whole where the passage has a largest draught, else near land, where the layer shows no channel.
    """
    if passage.use != "trade" or passage.half_width >= _NARROW:
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
