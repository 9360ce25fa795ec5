"""The offing of a chart: how far from land ships stay, and where they may come nearer.

Water nearer to charted land than the offing is closed, except in corridors along named passages
(`thalweg.chart.passages`) and in discs round the ends of a voyage or a canal.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Final, TypeVar

import numpy as np

from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.passages import Passage, find_passages
from thalweg.core.errors import InputError
from thalweg.core.geodesy import (
    MEAN_RADIUS,
    Position,
    densify,
    direct,
    geocentric_unit_vectors,
    inverse,
)
from thalweg.core.geodesy import distance as geodesic
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.geometry.offing_along_legs import NO_OFFING, OffingArrays, required_distances

ChartType = TypeVar("ChartType", bound=Any)

MAX_OFFING: Final = 50.0 * NAUTICAL_MILE
GROWTH: Final = 0.5  # metres of required distance for each metre from an end that is near land
_END_SHARE: Final = 0.9  # of the distance to land of an end, or of the line of a passage
_SEGMENT: Final = 0.5 * NAUTICAL_MILE  # centre lines of passages are split into such parts
_MARGIN: Final = 1.3  # wider passages than so many offings need no corridor
_SAMPLE: Final = 0.05 * NAUTICAL_MILE  # distances to land are measured so often along them
_INLAND: Final = 0.7 * NAUTICAL_MILE  # smaller islands do not end a line across a passage
_LONGEST_ARM: Final = 150.0 * NAUTICAL_MILE
_WIDE_LINE: Final = 4.0  # of the distance to land: a line across that is longer misses land
_PLACES: Final = 6  # along a passage where a line across is tried
_TURNS: Final = tuple(np.radians([-60.0, -45.0, -30.0, -15.0, 15.0, 30.0, 45.0, 60.0]))


@dataclass(frozen=True)
class OffingDisc:
    """A disc in which a smaller distance from land is allowed.

    Attributes
    ----------
    lat, lon : Centre [deg].
    least : Least distance from land inside [m].
    radius : Radius [m]; outside, the required distance grows by half a metre a metre.
    """

    lat: float
    lon: float
    least: float
    radius: float = 0.0


@dataclass(frozen=True)
class Offing:
    """The offing of a chart.

    Attributes
    ----------
    distance : float
        Least distance from land [m]; 0 for none.
    discs : tuple of OffingDisc
        Where a smaller one is allowed, round the ends of a voyage.
    canal_discs : tuple of OffingDisc
        The same round the ends of canals.
    """

    distance: float = 0.0
    discs: tuple[OffingDisc, ...] = ()
    canal_discs: tuple[OffingDisc, ...] = ()


def chart_with_offing(
    chart: ChartType, distance: float, *, discs: Iterable[OffingDisc] = ()
) -> ChartType:
    """Return a chart with water near land closed.

    Parameters
    ----------
    distance : float
        Least distance from charted land [m], 0 to 50 nautical miles. In the corridors of the
        chart's `passages` nine tenths of the distance of their line from land are enough.
    discs : iterable of OffingDisc, optional
        Where a smaller distance is allowed, besides the ends of canals.

    Returns
    -------
    Chart
        Another chart.

    Raises
    ------
    InputError
        If the distance is not possible.
    """
    check_offing(distance / NAUTICAL_MILE)
    ends = [end for canal in chart.canals for end in canal.ends]
    canals = tuple(disc_at(chart.coastline, end) for end in ends) if distance else ()
    return replace(chart, offing=Offing(float(distance), tuple(discs), canals))


def check_offing(offing_nm: float) -> None:
    """Raise `InputError` for an offing [nm] that is not possible."""
    if not 0.0 <= offing_nm <= MAX_OFFING / NAUTICAL_MILE:
        raise InputError(
            f"An offing of {offing_nm!r} nm is not possible.",
            f"It is 0 to {MAX_OFFING / NAUTICAL_MILE:.0f} nm.",
            "Correct it, or give 0 to sail as near to land as possible.",
            field="offing_nm",
        )


def chart_without_passages(chart: ChartType, *names: str) -> ChartType:
    """Return a chart with passages closed, by name: at any offing ships do not cross them.

    Parameters
    ----------
    *names : str
        Names of `thalweg.chart.passages.PASSAGES`.

    Returns
    -------
    Chart
        Another chart.

    Raises
    ------
    InputError
        If a name is unknown; the message lists similar names.
    """
    closed = tuple(find_passages(names))
    left = tuple(passage for passage in chart.passages if passage not in closed)
    every = tuple(dict.fromkeys((*chart.closed_passages, *closed)))
    return replace(chart, passages=left, closed_passages=every)


def disc_at(coastline: Coastline, place: Position, *, radius: float = 0.0) -> OffingDisc:
    """Return the disc round an end of a voyage: as near to land as the end is, or as needed.

    Parameters
    ----------
    place : (lat, lon)
        The end [deg].
    radius : Within this distance [m] of the end any distance from land is allowed.
    """
    shore = float(coastline.shore_distance(*place, cap=MAX_OFFING))
    return OffingDisc(*place, 0.0 if radius > 0.0 else _END_SHARE * shore, radius)


def offing_arrays(
    coastline: Coastline,
    offing: Offing,
    passages: Sequence[Passage],
    closed: Sequence[Passage] = (),
) -> OffingArrays:
    """Return an offing as arrays for `thalweg.kernels.geometry.offing_along_legs`.

    Parameters
    ----------
    coastline : Its distances along the passages are those that are required there.
    passages : Open passages.
    closed : Passages that no leg crosses; those that the offing closes need no line across.
    """
    if offing.distance <= 0.0:
        return NO_OFFING._replace(gate=_gates(coastline, tuple(closed)))
    discs = (*offing.discs, *offing.canal_discs)
    disc = np.zeros((len(discs), 6))
    for row, one in zip(disc, discs):
        row[:3] = geocentric_unit_vectors(np.array([one.lat]), np.array([one.lon]))[0]
        row[3:] = one.least, one.radius, GROWTH
    corridors = _corridors(coastline, offing.distance, tuple(passages))
    arrays = OffingArrays(float(offing.distance), disc, *corridors, NO_OFFING.gate)
    crossed = tuple(one for one in closed if not _closed_by_offing(coastline, arrays, one))
    return arrays._replace(gate=_gates(coastline, crossed))


def _closed_by_offing(coastline: Coastline, arrays: OffingArrays, passage: Passage) -> bool:
    """Return whether all water on the line across a passage is too near to land for any ship."""
    if _MARGIN * passage.half_width >= arrays.distance:
        return False
    lat, lon, shore = _water_across(coastline, passage, arrays.distance)
    return bool(np.all(shore < required_offing(arrays, lat, lon)))


@lru_cache(maxsize=1024)
def _water_across(
    coastline: Coastline, passage: Passage, cap: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return positions [deg] on the line across a passage and their distances from land [m]."""
    ends = np.array(closing_line(coastline, passage))
    lat, lon, _ = densify(ends[:, 0], ends[:, 1], _SAMPLE)
    return lat, lon, coastline.shore_distance(lat, lon, cap=cap)


def sea_room(
    coastline: Coastline, arrays: OffingArrays, lat: FloatArray, lon: FloatArray, cap: float
) -> FloatArray:
    """Return by how much positions [deg] are farther from land than required [m], or ``cap``."""
    shore = coastline.shore_distance(lat, lon, cap=cap + arrays.distance)
    room = np.minimum(shore - arrays.distance, cap)
    near = np.flatnonzero(room < 0.0)
    room[near] = shore[near] - required_offing(arrays, lat[near], lon[near])
    return np.maximum(room, 0.0)


def required_offing(arrays: OffingArrays, lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return the distance from land [m] that is required at positions [deg]."""
    required = np.empty(len(lat))
    required_distances(arrays, geocentric_unit_vectors(lat, lon), required)
    return required


@lru_cache(maxsize=16)
def _corridors(
    coastline: Coastline, distance: float, passages: tuple[Passage, ...]
) -> tuple[FloatArray, np.ndarray, FloatArray]:
    """Return boxes, pointers and segments of the corridors where less than a distance is needed."""
    rows, boxes, ptr = [np.zeros((0, 8))], [np.zeros((0, 4))], [0]
    for passage in passages:
        lines = [] if passage.half_width > _MARGIN * distance else [passage.line]
        parts = [
            _segments(coastline, distance, line, passage.half_width)
            for line in (*lines, *passage.lanes)
        ]
        found = np.concatenate([np.zeros((0, 8)), *parts])
        if not len(found):
            continue
        rows.append(found)
        ends = np.concatenate([found[:, :3], found[:, 3:6]])
        centre = ends.mean(axis=0)
        centre /= np.linalg.norm(centre)
        angle = float(np.arccos(np.clip(ends @ centre, -1.0, 1.0)).max())
        reach = angle + 1.01 * (distance + float(found[:, 7].max())) / MEAN_RADIUS
        boxes.append(np.append(centre, math.cos(min(reach, math.pi)))[None])
        ptr.append(ptr[-1] + len(found))
    return np.concatenate(boxes), np.array(ptr, np.int64), np.concatenate(rows)


@lru_cache(maxsize=1024)
def _segments(
    coastline: Coastline, distance: float, line: tuple[Position, ...], half_width: float
) -> FloatArray:
    """Return the segments of a line that are nearer to land than a distance [m].

    Parameters
    ----------
    half_width : Of the passage [m]; segments are sampled by it.
    """
    sample = float(np.clip(0.2 * half_width, 0.2 * _SAMPLE, _SEGMENT))
    latitudes, longitudes = np.array(line, float).T
    lat, lon, _ = densify(latitudes, longitudes, sample)
    shore = coastline.shore_distance(lat, lon, cap=1.2 * distance)
    many = max(round(_SEGMENT / sample), 1)
    first = np.arange(0, len(lat) - 1, many)
    last = np.minimum(first + many, len(lat) - 1)
    least = np.minimum(np.minimum.reduceat(shore, first), shore[last])
    near = np.flatnonzero(_END_SHARE * least < distance)
    vectors = geocentric_unit_vectors(lat, lon)
    found = np.empty((len(near), 8))
    found[:, :3], found[:, 3:6] = vectors[first[near]], vectors[last[near]]
    found[:, 6], found[:, 7] = _END_SHARE * least[near], distance
    return found


@lru_cache(maxsize=64)
def _gates(coastline: Coastline, closed: tuple[Passage, ...]) -> FloatArray:
    """Return lines across passages as pairs of unit vectors (n, 6)."""
    ends = np.array([closing_line(coastline, passage) for passage in closed]).reshape(-1, 2, 2)
    return geocentric_unit_vectors(ends[..., 0].ravel(), ends[..., 1].ravel()).reshape(-1, 6)


@lru_cache(maxsize=256)
def closing_line(coastline: Coastline, passage: Passage) -> tuple[Position, Position]:
    """Return the ends (lat, lon) [deg] of a line across a passage where it is narrowest.

    The ends are on land.
    """
    if passage.closing_line:
        return passage.closing_line[0], passage.closing_line[-1]
    lat, lon, _ = densify(*passage.positions, 4.0 * _SAMPLE)
    shore = coastline.shore_distance(lat, lon, cap=20.0 * NAUTICAL_MILE)
    inner = np.arange(len(lat) // 20, len(lat) - len(lat) // 20)
    best, least = None, math.inf
    places = inner[np.argsort(shore[inner], kind="stable")]
    for at in _spread(places, len(lat) // _PLACES):
        before, after = max(at - 3, 0), min(at + 3, len(lat) - 1)
        _, course, _ = inverse(lat[before], lon[before], lat[after], lon[after])
        place = float(lat[at]), float(lon[at])
        for turn in (0.0, *_TURNS):
            line, length = _line_through(coastline, place, float(course) + np.pi / 2 + turn)
            if length < least:
                best, least = line, length
            if least <= _WIDE_LINE * float(shore[at]):
                break  # it reaches the nearest land on both sides
        if least <= _WIDE_LINE * float(shore[at]):
            break
    assert best is not None  # a line has positions
    return best


def _spread(places: np.ndarray, apart: int) -> list[int]:
    """Return the first of some indices, and those after it that are so far from all before."""
    found: list[int] = []
    for place in places.tolist():
        if all(abs(place - other) >= max(apart, 1) for other in found):
            found.append(place)
    return found[:_PLACES]


def _line_through(
    coastline: Coastline, place: Position, course: float
) -> tuple[tuple[Position, Position], float]:
    """Return the line through a place on a course [rad] from land to land, and its length [m]."""
    line = tuple(_landfall(coastline, place, course + half) for half in (np.pi, 0.0))
    return (line[0], line[1]), sum(float(geodesic(*place, *end)) for end in line)


def _landfall(coastline: Coastline, place: Position, course: float) -> Position:
    """Return the position just inside the land that lies on a course [rad] from a place."""
    away, shore = 0.0, np.inf
    while True:
        lat, lon = direct(*place, course, away)
        shore = float(coastline.shore_distance(lat, lon, cap=20.0 * NAUTICAL_MILE))
        inland = direct(*place, course, away + _INLAND)
        land = shore < 5.0 and float(coastline.shore_distance(*inland)) == 0.0
        if land or away > _LONGEST_ARM:
            return float(inland[0]), float(inland[1])
        away += max(shore, 20.0 if shore > 0.0 else 200.0)
