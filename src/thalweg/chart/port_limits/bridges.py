"""Bridges over the approaches of ports, by their clearance.

The table ``data/bridges.csv`` has for each bridge its clearance under the main span, mostly at high
water, and a position on each bank. Bridges over named passages, such as that of the Great Belt, are
in the table of passages.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from thalweg.chart.passage_crossings import crossing_place
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position, densify
from thalweg.core.units import NAUTICAL_MILE

_STEP = 1.0 * NAUTICAL_MILE  # of lines of approaches


@dataclass(frozen=True)
class Bridge:
    """A bridge over an approach.

    Attributes
    ----------
    clearance : float
        Greatest air draught [m].
    source : str
        Of the clearance.
    ends : (lat, lon) and (lat, lon)
        A position on each bank [deg].
    """

    name: str
    clearance: float
    source: str
    ends: tuple[Position, Position]


@cache
def every_bridge() -> tuple[Bridge, ...]:
    """Return the bridges of the table."""
    return tuple(
        Bridge(row["name"], float(row["clearance_m"]), row["source"], _ends(row["ends"]))
        for row in table_rows("thalweg.chart", "bridges.csv")
    )


def _ends(text: str) -> tuple[Position, Position]:
    (a, b), (c, d) = (map(float, pair.split(",")) for pair in text.split())
    return (a, b), (c, d)


@cache
def bridges_over(line: tuple[Position, ...]) -> tuple[Bridge, ...]:
    """Return the bridges that a line of positions [deg] leads under, in order."""
    corners = np.array(line, float)
    lat, lon, _leg = densify(corners[:, 0], corners[:, 1], _STEP)
    places = [(crossing_place(lat, lon, *bridge.ends), bridge) for bridge in every_bridge()]
    found = [(at, bridge) for at, bridge in places if at is not None]
    return tuple(bridge for _at, bridge in sorted(found, key=lambda pair: pair[0]))
