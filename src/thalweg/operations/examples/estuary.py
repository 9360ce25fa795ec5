"""A synthetic estuary: a drying bank, a gully behind it, and the tides M2 and S2.

The estuary is not surveyed. The direct route crosses a bank that dries; the detour passes a gully
with a bar that a full ship passes only above a certain water level. Distances and depths are those
of van Halem (2019), section 3.2.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position
from thalweg.core.types import FloatArray
from thalweg.sea import Sea
from thalweg.sea import standard_names as nm
from thalweg.sea.tides.constituents import Constituents

CENTRE: Final = (51.70, 3.55)  #: origin of the local plane [deg]
HALF_WIDTH, HALF_HEIGHT = 12.0, 10.0  # of the domain [km]
_KM_NORTH = 111.25  # of a degree of latitude here
_KM_EAST = 111.41 * math.cos(math.radians(CENTRE[0]))
_RIDGE_Y, _RIDGE_WIDTH, _RIDGE_END = -1.5, 1.2, -7.0  # the bank [km]
_SADDLE_X, _SADDLE_WIDTH, _SADDLE_DEPTH, _CREST_DEPTH = 4.5, 1.2, 4.3, 0.3
_BAR_X, _BAR_WIDTH, BAR_DEPTH = -6.0, 1.0, 7.86  # of the gully, below datum [m]
_OUTSIDE, _INSIDE, _COAST_Y = 14.0, 10.0, -6.6
_LEVEL_CONSTITUENTS: Final = {
    "M2": (1.45, 60.0),
    "S2": (0.36, 118.0),
}  # amplitude [m], phase lag [deg]
_LAG = 20.0  # of the tide from west to east [deg]
_CURRENT_LEAD = 65.0  # of the current before the level [deg]


@dataclass(frozen=True)
class Estuary:
    """A synthetic sea and chart.

    Attributes
    ----------
    sea : Water level and current, at any date, on a mesh.
    chart : Depth below datum; no coastline except the edge of the domain.
    load, unload : (lat, lon)
        A dredging area at sea and a place behind the bank [deg].
    bar : (lat, lon)
        The shallowest place of the charted route from one to the other, through the gully [deg].
    """

    sea: Sea
    chart: Chart
    load: Position
    unload: Position
    bar: Position


def synthetic_estuary(spacing_m: float = 300.0) -> Estuary:
    """Return the estuary on a mesh of triangles.

    Parameters
    ----------
    spacing_m : float
        Side of the triangles [m], 100 to 2000; 300 m gives about 6,300 nodes.

    Returns
    -------
    Estuary

    Raises
    ------
    InputError
        For a spacing out of range.

    Notes
    -----
    The level is M2 of 1.45 m and S2 of 0.36 m, 20 degrees later at the eastern rim than at the
    western; the current turns 65 degrees before the level and is stronger in deeper water. The
    crest of the bank is 0.3 m below datum (it dries), its saddle 4.3 m, and the bar of the gully
    7.86 m.
    """
    if not 100.0 <= spacing_m <= 2000.0:
        raise InputError(f"The spacing is {spacing_m:g} m.", "It is 100 to 2000 m.", "Correct it.")
    lat, lon = _nodes(spacing_m / 1000.0)
    chart = Chart.open_water(*_box()).with_depth(bed_depth, spacing_deg=0.0005)
    gully = ((2.0, 5.0), (-7.8, -0.4), (-7.8, -3.0), (-6.0, -4.3), (0.0, -4.8), (7.0, -4.5))
    places = tuple(_position(x, y) for x, y in gully)
    return Estuary(
        sea=Sea.from_tides(_tidal_constants(lat, lon)),
        chart=chart,
        load=places[0],
        unload=places[-1],
        bar=places[3],
    )


def bed_depth(lat: ArrayLike, lon: ArrayLike) -> FloatArray:
    """Return the depth of the bed [m below datum, positive down] at positions [deg]."""
    x, y = _to_plane(lat, lon)
    inner = y < _RIDGE_Y
    bar = (_INSIDE - BAR_DEPTH) * np.exp(-(((x - _BAR_X) / _BAR_WIDTH) ** 2))
    around = np.where(inner, _INSIDE - bar, _OUTSIDE)
    saddle = np.exp(-(((x - _SADDLE_X) / _SADDLE_WIDTH) ** 2))
    crest = _CREST_DEPTH + (_SADDLE_DEPTH - _CREST_DEPTH) * saddle
    extent = 1.0 / (1.0 + np.exp(-(x - _RIDGE_END) / 0.3))
    ridge = extent * np.exp(-(((y - _RIDGE_Y) / _RIDGE_WIDTH) ** 2))
    # away from the bank the gully and the sea outside join smoothly
    step = 1.0 / (1.0 + np.exp(-(y - _RIDGE_Y) / 0.25))
    around = step * _OUTSIDE + (1.0 - step) * (_INSIDE - bar)
    depth = around - ridge * (around - crest)
    return np.asarray(depth - 16.0 / (1.0 + np.exp((y - _COAST_Y) / 0.12)))


def _tidal_constants(lat: FloatArray, lon: FloatArray) -> Constituents:
    x, _ = _to_plane(lat, lon)
    lag = _LAG * (x + HALF_WIDTH) / (2.0 * HALF_WIDTH)
    strength = 0.62 * np.clip(np.sqrt(np.maximum(bed_depth(lat, lon) + 0.5, 0.0) / 10.0), 0.0, 1.2)
    level = np.array([_LEVEL_CONSTITUENTS[name] for name in _LEVEL_CONSTITUENTS])
    ones = np.ones(lat.size)
    amplitude = level[:, :1] * ones
    phase = level[:, 1:] + lag
    east, north = nm.CURRENT.pair
    stream = amplitude * strength
    return Constituents(
        tuple(_LEVEL_CONSTITUENTS),
        {nm.WATER_LEVEL: amplitude, east: stream, north: 0.15 * stream},
        {nm.WATER_LEVEL: phase, east: phase - _CURRENT_LEAD, north: phase - _CURRENT_LEAD},
        {nm.WATER_LEVEL: 0.0 * ones, east: 0.0 * ones, north: 0.0 * ones},
        lat,
        lon,
        facts={"source": "synthetic estuary (made up)"},
    )


def _nodes(side: float) -> tuple[FloatArray, FloatArray]:
    """Return a triangular lattice over the domain, its rim straight [deg]."""
    rows = math.ceil(2.0 * HALF_HEIGHT / (side * math.sqrt(0.75)))
    columns = math.ceil(2.0 * HALF_WIDTH / side)
    y = np.linspace(-HALF_HEIGHT, HALF_HEIGHT, rows + 1)
    x, places = np.linspace(-HALF_WIDTH, HALF_WIDTH, columns + 1), []
    for number, row in enumerate(y):
        across = x
        if number % 2:
            across = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
        places.append(np.column_stack([across, np.full(across.size, row)]))
    east, north = np.concatenate(places).T
    return _to_degrees(east, north)


def _box() -> tuple[float, float, float, float]:
    lat, lon = _to_degrees(
        np.array([-HALF_WIDTH, HALF_WIDTH]), np.array([-HALF_HEIGHT, HALF_HEIGHT])
    )
    return float(lat[0]), float(lat[1]), float(lon[0]), float(lon[1])


def _to_plane(lat: ArrayLike, lon: ArrayLike) -> tuple[FloatArray, FloatArray]:
    x = (np.asarray(lon, float) - CENTRE[1]) * _KM_EAST
    return x, (np.asarray(lat, float) - CENTRE[0]) * _KM_NORTH


def _to_degrees(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    return CENTRE[0] + y / _KM_NORTH, CENTRE[1] + x / _KM_EAST


def _position(x: float, y: float) -> Position:
    lat, lon = _to_degrees(np.array([x]), np.array([y]))
    return round(float(lat[0]), 4), round(float(lon[0]), 4)
