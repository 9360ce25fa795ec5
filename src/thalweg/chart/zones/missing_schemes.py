"""Seas with charted traffic separation schemes that the table of schemes does not have.

The table is ``data/seas_with_other_schemes.csv``, one row a sea: name, south, north, west and east
[deg] of a box, source. A plan names the seas that its route leads through.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from thalweg.core.file_reading import table_rows
from thalweg.core.types import FloatArray


@cache
def _seas() -> tuple[tuple[str, tuple[float, float, float, float]], ...]:
    """Return the names and boxes (south, north, west, east) [deg] of the table."""
    rows = table_rows("thalweg.chart", "seas_with_other_schemes.csv")
    sides = ("south", "north", "west", "east")
    return tuple((r["name"], tuple(float(r[side]) for side in sides)) for r in rows)  # type: ignore[misc]


def seas_with_other_schemes(lat: FloatArray, lon: FloatArray) -> list[str]:
    """Return the seas with other schemes in which some positions are, in order of the positions.

    Parameters
    ----------
    lat, lon : float64 array (n,)
        Positions along a route [deg], closer than the seas are wide.

    Returns
    -------
    list of str
    """
    found = {}
    for name, (south, north, west, east) in _seas():
        inside = (lat >= south) & (lat <= north) & (lon >= west) & (lon <= east)
        if inside.any():
            found[name] = int(np.argmax(inside))
    return sorted(found, key=lambda name: found[name])
