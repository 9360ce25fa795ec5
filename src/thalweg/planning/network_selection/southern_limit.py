"""How far south a voyage goes by default: not into the icebergs of the Southern Ocean for miles."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from thalweg.chart.passage_crossings import crossing_place
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import densify, line_length
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.ice_limits import HORN_LATITUDE, ICEBERG_LATITUDE
from thalweg.planning.report.ice_report import SOUTH_LEFT_OUT
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals

#: A way that crosses this line goes round South America, by the Horn, Le Maire or Magellan.
_SOUTH_OF_AMERICA: Final = ((-50.0, -67.28), (-65.0, -67.28))
_MARGIN: Final = 3.0  # of ends [deg]
_FAR_SOUTH: Final = -15.0  # voyages without an end south of this do not come near it [deg]
_PIECE: Final = 60.0 * NAUTICAL_MILE


def southern_limit(
    ends: Sequence[Endpoint], seas: Callable[[], Seaways], lowest: float
) -> tuple[float, list[str]]:
    """Return the latitude that a voyage does not pass, and a note where that makes it longer.

    It is `ICEBERG_LATITUDE` where the shortest way passes that latitude in the open ocean: great
    circles between the southern capes lead through icebergs, in the worst of the weather. A voyage
    round Cape Horn keeps north of `HORN_LATITUDE`, and one by a canal of America, whose other way
    that is, the usual limit.

    Parameters
    ----------
    ends : With via points between them.
    seas : Called only for voyages that may come so far south: what the voyage may use.
    lowest : The usual limit [deg].
    """
    if lowest < -60.0 or all(end.lat > _FAR_SOUTH for end in ends):
        return lowest, []
    if any(end.lat < ICEBERG_LATITUDE + _MARGIN for end in ends):
        return lowest, []
    waters = seas()
    try:
        paths = [waters.graph_path(a, b) for a, b in pairwise(ends)]
    except NoRouteError:
        return lowest, []
    canals = [name for path in paths for name in path_length_and_canals(waters.chart, path)[1]]
    corners = np.array([place for path in paths for place in path], float)
    lat, lon, _ = densify(corners[:, 0], corners[:, 1], _PIECE)
    round_horn = crossing_place(lat, lon, *_SOUTH_OF_AMERICA) is not None
    limit = HORN_LATITUDE if round_horn else ICEBERG_LATITUDE
    if not (lat < limit).any() or "Panama Canal" in canals:
        return lowest, []
    within = replace(waters, south=limit)
    try:
        others = [within.graph_path(a, b) for a, b in pairwise(ends)]
    except NoRouteError:
        return lowest, []
    longer = sum(map(line_length, others)) - sum(map(line_length, paths))
    return limit, [
        f"{SOUTH_LEFT_OUT}{-limit:g} S is left out: the shortest way goes beyond and is about "
        f"{longer / NAUTICAL_MILE:.0f} nm shorter; icebergs are usual there and the weather is "
        "worst. Give a via point there to go that way."
    ]
