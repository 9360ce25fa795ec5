"""Which named passages and capes a line leads through, by the lines across them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.offing import closing_line
from thalweg.chart.passages import Passage
from thalweg.core.geodesy import Position, densify, longitude_difference
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE

_STEP: Final = 10.0 * NAUTICAL_MILE
_NEAR: Final = 60.0 * NAUTICAL_MILE  # of the line of a passage; its closing line is shorter
#: Lines from capes towards the pole: a way that crosses one passes the cape.
CAPES: Final[dict[str, tuple[Position, Position]]] = {
    "Cape of Good Hope": ((-34.8, 20.0), (-50.0, 20.0)),
    "Cape Horn": ((-55.95, -67.28), (-65.0, -67.28)),
}


def passages_crossed(
    coastline: Coastline, passages: Iterable[Passage], lat: FloatArray, lon: FloatArray
) -> list[tuple[float, Passage]]:
    """Return the passages whose line across is crossed by a line of positions.

    Parameters
    ----------
    coastline : The lines across passages end on its land.
    lat, lon : Waypoints [deg], joined by geodesics.

    Returns
    -------
    list of (float, Passage)
        A number that grows along the line, and the passage; in the order of the crossings.
    """
    if len(lat) < 2:
        return []
    y, x, _leg = densify(lat, lon, _STEP)
    found = []
    for passage in passages:
        if _is_near(passage, y, x):
            at = crossing_place(y, x, *closing_line(coastline, passage))
            if at is not None:
                found.append((at, passage))
    return sorted(found, key=lambda pair: pair[0])


def names_passed(
    coastline: Coastline, passages: Iterable[Passage], lat: FloatArray, lon: FloatArray
) -> tuple[str, ...]:
    """Return the names of the passages and capes that a line of positions passes, in order.

    Parameters and positions are those of `passages_crossed`.
    """
    if len(lat) < 2:
        return ()
    named = [(at, passage.name) for at, passage in passages_crossed(coastline, passages, lat, lon)]
    y, x, _leg = densify(lat, lon, _STEP)
    for name, line in CAPES.items():
        at = crossing_place(y, x, *line)
        if at is not None:
            named.append((at, name))
    return tuple(name for _, name in sorted(named))


def _is_near(passage: Passage, lat: FloatArray, lon: FloatArray) -> bool:
    """Return whether any position is in the box round the line of a passage."""
    y, x = passage.positions
    margin = _NEAR / 111e3
    inside = (lat >= y.min() - margin) & (lat <= y.max() + margin)
    if not inside.any():
        return False
    turned = longitude_difference(x, x[0])
    wide = margin / max(float(np.cos(np.radians(np.abs(y).max()))), 0.1)
    east = longitude_difference(lon[inside], x[0])
    return bool(((east >= turned.min() - wide) & (east <= turned.max() + wide)).any())


def legs_through(
    coastline: Coastline,
    passages: Iterable[Passage],
    legs: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
) -> dict[str, NDArray[np.bool_]]:
    """Return which short legs cross the line across each passage, by its name.

    Parameters
    ----------
    coastline : The lines across passages end on its land.
    legs : Latitudes and longitudes of the first and the second ends [deg], each (L,).

    Returns
    -------
    dict of str to bool array (L,) : Only passages with such legs.
    """
    lat, lon, to_lat, to_lon = legs
    found = {}
    for passage in passages:
        if _is_near(passage, lat, lon):
            a, b = closing_line(coastline, passage)
            crossed, _ = _pieces_across(np.array([lat, to_lat]), np.array([lon, to_lon]), a, b)
            if crossed.any():
                found[passage.name] = crossed[0]
    return found


def crossing_place(lat: FloatArray, lon: FloatArray, a: Any, b: Any) -> float | None:
    """Return where a line crosses that from a to b, or None; all pieces are short.

    Parameters
    ----------
    lat, lon : Positions of the line [deg].
    a, b : Ends (lat, lon) of the other one [deg].

    Returns
    -------
    float or None : Number of the piece, and the share of it before the crossing.
    """
    crossed, share = _pieces_across(lat, lon, a, b)
    hit = np.flatnonzero(crossed)
    return None if not len(hit) else int(hit[0]) + float(share[hit[0]])


def _pieces_across(
    lat: FloatArray, lon: FloatArray, a: Any, b: Any
) -> tuple[NDArray[np.bool_], FloatArray]:
    """Return which pieces between positions along the first axis cross the line from a to b.

    The second array has the share of each piece before the crossing.
    """
    shift = np.cos(np.radians(a[0]))
    px, py = longitude_difference(lon, a[1]) * shift, lat - a[0]
    qx, qy = longitude_difference(b[1], a[1]) * shift, b[0] - a[0]
    side = qx * py - qy * px  # on which side of a-b each position is
    ex, ey = np.diff(px, axis=0), np.diff(py, axis=0)
    start = ex * (0.0 - py[:-1]) - ey * (0.0 - px[:-1])
    end = ex * (qy - py[:-1]) - ey * (qx - px[:-1])
    near = np.hypot(px[:-1], py[:-1]) < 20.0
    change = side[:-1] - side[1:]
    share = np.divide(side[:-1], change, out=np.zeros_like(change), where=change != 0.0)
    return (side[:-1] * side[1:] <= 0.0) & (start * end <= 0.0) & near, share
