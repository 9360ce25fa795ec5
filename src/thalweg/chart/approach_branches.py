"""Channels that leave the approaches of ports: second entrances, and places to leave them.

The table ``data/approach_branches.csv`` has channels that leave the approaches of ports: a second
entrance of a fjord or bay, or, with one position, a place where a ship is free to leave for other
parts of the same inland sea. They are for planning and are not surveyed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position


@dataclass(frozen=True)
class ApproachBranch:
    """A channel that leaves the approaches of ports.

    Attributes
    ----------
    name : Such as "Fedjeosen".
    line : tuple of (lat, lon)
        From inner waters to sea [deg]; one position where the ship leaves the approach there.
    source : Of the line.
    canal : Name of the canal that begins there, or empty.
    max_draught, max_length : Of ships that use it [m]; inf without a limit.
    """

    name: str
    line: tuple[Position, ...]
    source: str
    canal: str = ""
    max_draught: float = math.inf
    max_length: float = math.inf


@cache
def approach_branches() -> tuple[ApproachBranch, ...]:
    """Return the branches of the table."""
    return tuple(
        ApproachBranch(
            row["name"],
            tuple((float(lat), float(lon)) for lat, lon in
                  (pair.split(",") for pair in row["line"].split())),
            row["source"],
            max_draught=float(row["max_draught_m"] or "inf"),
            max_length=float(row["max_length_m"] or "inf"),
        )
        for row in table_rows("thalweg.chart", "approach_branches.csv")
    )  # fmt: skip
