"""Network of a fixed route, for speed optimisation along it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core import geodesy
from thalweg.core.geodesy import Position
from thalweg.core.types import FloatArray
from thalweg.network.assembly import (
    Pairs,
    assemble,
    evenly_spaced_samples,
    measured_pairs,
)
from thalweg.network.network import Network, NetworkMeta, Stations

if TYPE_CHECKING:
    from thalweg.chart import Chart

_PIECES_PER_EDGE: Final = 2  # pieces in which every edge is sampled


def fixed_route(chart: Chart, positions: Sequence[Position], *, spacing: float) -> Network:
    """Return the network of a given route, on which a ship only chooses its speeds.

    Parameters
    ----------
    chart : Chart
        The legs of the route must be allowed on it; those through canals are not divided.
    positions : sequence of (lat, lon)
        Waypoints [deg], at least two.
    spacing : float
        Longest edge [m], above 0. Edges also end at borders of emission control areas.

    Returns
    -------
    Network
        Its start is the first node, its goal the last.
    """
    lat, lon = np.asarray(positions, float).T
    canal = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])) >= 0
    length = np.asarray(geodesy.distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    parts = np.where(canal, 1, np.maximum(1, np.ceil(length / spacing))).astype(int)
    cuts = [np.arange(n) / n for n in parts]
    lat, lon = _split_legs(lat, lon, cuts)
    lat, lon = _split_legs(lat, lon, _cuts_at_borders(chart, lat, lon))
    canal = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])) >= 0
    stations = Stations(lat, lon, len(lat))
    first = np.arange(len(lat) - 1, dtype=np.int32)
    pairs = measured_pairs(lat, lon, first, first + np.int32(1))
    stations, samples = evenly_spaced_samples(
        stations, pairs, np.where(canal, np.inf, np.maximum(pairs.length, 1.0) / _PIECES_PER_EDGE)
    )
    which = chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])
    through = np.array([chart.canals[i].length if i >= 0 else np.nan for i in which])
    pairs = Pairs(
        pairs.first,
        pairs.second,
        np.where(canal, through, pairs.length),
        np.where(canal, np.nan, pairs.course).astype(np.float32),
    )
    meta = NetworkMeta(
        kind="line", spacing_m=spacing, directions=1, gap_rad=2.0 * np.pi, start=0,
        goal=len(lat) - 1,
    )  # fmt: skip
    return assemble(chart, stations, pairs, samples, meta=meta)


def _cuts_at_borders(chart: Chart, lat: FloatArray, lon: FloatArray) -> list[FloatArray]:
    """Return the fractions at which legs are split: 0, and where they cross a border once."""
    share = np.asarray(chart.zones.eca_fraction(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    inside = np.asarray(chart.zones.in_eca(lat[:-1], lon[:-1]))
    crosses = (share > 1e-6) & (share < 1.0 - 1e-6)
    at = np.where(inside, share, 1.0 - share)
    return [np.array([0.0, x] if c else [0.0]) for c, x in zip(crosses, at)]


def _split_legs(
    lat: FloatArray, lon: FloatArray, cuts: Sequence[FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Return a line with its legs split at fractions of their length; 0 is their start."""
    leg = np.repeat(np.arange(len(cuts)), [len(c) for c in cuts])
    share = np.concatenate(cuts)
    length, course, _ = geodesy.inverse(lat[leg], lon[leg], lat[leg + 1], lon[leg + 1])
    new_lat, new_lon = geodesy.direct(lat[leg], lon[leg], course, share * length)
    whole = share == 0.0
    new_lat = np.where(whole, lat[leg], new_lat)
    new_lon = np.where(whole, lon[leg], new_lon)
    return np.append(new_lat, lat[-1]), np.append(new_lon, lon[-1])
