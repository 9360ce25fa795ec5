"""Shoals: water in which a mile counts more, so that deep ships keep out where they can.

Seuren (2020), section 5.5.2, adds penalties in water that is shallower than a contour. Here the
contour follows the draught: one and a half times the draught, and the next contour of a chart. It
agrees with the margins of Swift, Bridge Team Management (Nautical Institute), as others quote it:
the 5, 10 and 20 m contours for draughts below 3, 6 and 10 m. The factors are ours.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, lru_cache
from typing import Any, Final, TypeAlias

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from thalweg.chart.depth.global_depth import global_depth_codes
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS, ShoalArea
from thalweg.core.geodesy import Position, densify, direct
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.geometry.shoal_excess import (
    POINTS_OF_DEGREE,
    POINTS_OF_TILE,
    ShoalArrays,
    shoal_excesses,
)

CONTOURS: Final = (5.0, 10.0, 20.0, 30.0, 40.0, 50.0)  #: depth contours [m]
DRAUGHTS: Final = 1.5  #: depth of the contour over the draught, at least
EXCESS: Final = (0.5, 19.0)  #: excess of a mile at the required depth, and at half of it
_LINE_STEP: Final = 2.0 * NAUTICAL_MILE
#: Points of the grid so near to a channel are changed [m].
_MARGIN: Final = 4.0 * NAUTICAL_MILE
HARBOUR: Final = 8.0 * NAUTICAL_MILE  #: ... as those so near to a harbour [m]
_GENTLE: Final = 3.0  # contours: where the next point is deeper, the slope is steep
#: Areas that points of the layer stand for. Those of exact outline are closed as they are
#: (`thalweg.chart.depth.closed_shoals`): a point would spread them over the channels beside them.
_AREAS_OF_POINTS: Final = tuple(area for area in SHOAL_AREAS if not area.is_exact)
_DEEPEST: Final = np.uint8(255)  # code of a depth
GridPoints: TypeAlias = tuple[NDArray[np.int64], NDArray[np.int64]]  #: rows and columns
_TILES: Final = 10  # tiles farther away than this are not told apart


def safety_contour(draught: float) -> float:
    """Return the depth contour inside which a ship should not sail if it can be avoided.

    Parameters
    ----------
    draught : [m], above 0.

    Returns
    -------
    float : The first of `CONTOURS` that is at least `DRAUGHTS` times the draught [m]; that depth
        itself above the last.
    """
    deep = DRAUGHTS * draught
    return next((contour for contour in CONTOURS if contour >= deep), deep)


@dataclass(frozen=True)
class Shoals:
    """Shoal water for a ship, by the depth layer of the package and the named shoal areas.

    Attributes
    ----------
    contour : Water shallower than this is shoal [m].
    least : Depth that the ship requires [m], below the contour. A mile at this depth counts 1.5, at
        half of it and less 20; between the contour and these depths the factor is linear.
    channels : tuple of tuple of (lat, lon)
        Lines along which water is as deep as the contour, whatever the layer has [deg].
    harbours : tuple of (lat, lon)
        Positions round which it is so within 8 nautical miles, outside named areas that have none
        of them inside: the layer shows no dredged channels.
    drying_only : Whether only the named areas without water count (reefs, rocks, drying sands, wind
        farms, oil fields), and the layer does not.
    """

    contour: float
    least: float
    channels: tuple[tuple[Position, ...], ...] = field(default=(), repr=False)
    harbours: tuple[Position, ...] = ()
    drying_only: bool = False

    @cached_property
    def arrays(self) -> ShoalArrays:
        """The layer and the depths, for kernels."""
        return _arrays(self)

    def excess(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> FloatArray:
        """Return by how much a mile on legs counts more, as the mean along each.

        Parameters
        ----------
        lat1, lon1, lat2, lon2 : Ends of legs [deg]; broadcast together.

        Returns
        -------
        ndarray : 0 or more; NaN where a position is not a number.
        """
        ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
        found = np.empty(ends[0].size)
        shoal_excesses(self.arrays, *(x.flatten() for x in ends), found)
        return found.reshape(ends[0].shape)

    @cached_property
    def elsewhere(self) -> Shoals:
        """The shoal water without harbours, the same for all voyages of a draught."""
        return replace(self, harbours=())

    def text(self) -> str:
        """Return everything as text, for a fingerprint."""
        lines = hashlib.sha256(repr((self.channels, self.harbours)).encode()).hexdigest()[:16]
        drying = " drying" if self.drying_only else ""
        return f"shoals {self.contour} {self.least} {EXCESS} {lines}{drying}"


@lru_cache(maxsize=4)
def _arrays(shoals: Shoals) -> ShoalArrays:
    if shoals.harbours:
        return _with_harbours(_arrays_without_harbours(shoals.elsewhere), shoals)
    return _arrays_without_harbours(shoals)


@lru_cache(maxsize=2)
def _arrays_without_harbours(shoals: Shoals) -> ShoalArrays:
    code = global_depth_codes().copy()
    deep = _deep_code(shoals)
    areas = _areas_of_points(shoals)
    if shoals.drying_only:
        code[code > 0] = _DEEPEST
    _shoal_inside(code, areas)  # so that the points beside the areas are found ...
    code[_beside_shoals(code, shoals)] = deep
    _shoal_inside(code, areas)  # ... and those in them do not become deeper by that
    for channel in shoals.channels:
        _deepen(code, _points_of_channel(channel), deep)
    depths = np.array([shoals.contour, shoals.least])
    return ShoalArrays(code, _free_tiles((code > 0) & (code < deep)), depths, np.array(EXCESS))


def _with_harbours(arrays: ShoalArrays, shoals: Shoals) -> ShoalArrays:
    """Return arrays with deep water round harbours; its tiles still count as having shoals.

    A named area beside a harbour stays shoal, one with a harbour in it does not.
    """
    code = arrays.code.copy()
    ends = np.array(shoals.harbours).reshape(-1, 2)
    areas = [
        _widened(area) for area in _areas_of_points(shoals) if not area.contains(*ends.T).any()
    ]
    for place in shoals.harbours:
        row, column = _points_near((place,), HARBOUR)
        lat, lon = row / POINTS_OF_DEGREE - 90.0, column / POINTS_OF_DEGREE - 180.0
        shoal = np.zeros(len(row), bool)
        for area in areas:
            shoal |= shapely.contains_xy(area, lon, lat)
        _deepen(code, (row[~shoal], column[~shoal]), _deep_code(shoals))
    return arrays._replace(code=code)


def _areas_of_points(shoals: Shoals) -> Sequence[ShoalArea]:
    return [a for a in _AREAS_OF_POINTS if a.dries] if shoals.drying_only else _AREAS_OF_POINTS


def _deep_code(shoals: Shoals) -> np.uint8:
    return np.uint8(min(np.ceil(shoals.contour) + 1.0, 255.0))


def _shoal_inside(code: NDArray[np.uint8], areas: Iterable[ShoalArea]) -> None:
    for area in areas:
        row, column = _points_inside(area)
        code[row, column] = np.minimum(code[row, column], np.uint8(area.depth + 1.0))


def _deepen(code: NDArray[np.uint8], points: GridPoints, deep: np.uint8) -> None:
    code[points] = np.maximum(code[points], deep)


def _beside_shoals(code: NDArray[np.uint8], shoals: Shoals) -> NDArray[np.bool_]:
    """Return the points beside one with less water than the ship requires, on gentle slopes.

    A point says nothing about the water half-way to the next. These points count as no deeper than
    the contour, so that water towards the shoal is shoal.
    """
    least = np.where(code > 0, code, np.uint8(255))  # of each point and the eight beside it
    upper, lower = least[:-1].copy(), least[1:].copy()
    np.minimum(least[:-1], lower, out=least[:-1])
    np.minimum(least[1:], upper, out=least[1:])
    least = np.minimum(least, np.minimum(np.roll(least, 1, axis=1), np.roll(least, -1, axis=1)))
    gentle = (code > shoals.contour + 1.0) & (code <= _GENTLE * shoals.contour + 1.0)
    return gentle & (least < shoals.least + 1.0)


@cache
def _points_inside(area: ShoalArea) -> GridPoints:
    """Return rows and columns of the points of the grid inside an area, or nearly."""
    wide = _widened(area)
    west, south, east, north = (int(edge * POINTS_OF_DEGREE) for edge in wide.bounds)
    y, x = np.mgrid[south - 1 : north + 2, west - 1 : east + 2]
    inside = shapely.contains_xy(wide, x / POINTS_OF_DEGREE, y / POINTS_OF_DEGREE)
    columns = 360 * POINTS_OF_DEGREE
    return y[inside] + 90 * POINTS_OF_DEGREE, (x[inside] + columns // 2) % columns


@cache
def _widened(area: ShoalArea) -> Any:
    return area.polygon.buffer(0.5 / POINTS_OF_DEGREE)


@lru_cache(maxsize=512)  # the same for all draughts
def _points_of_channel(line: tuple[Position, ...]) -> GridPoints:
    return _points_near(line, _MARGIN)


def _points_near(line: tuple[Position, ...], margin: float) -> GridPoints:
    """Return rows and columns of the points of the grid near a line [m]."""
    vertices = np.array(line, float)
    lat, lon = vertices.T
    if len(line) > 1:
        lat, lon, _ = densify(lat, lon, _LINE_STEP)
    turns = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    away = np.linspace(0.0, margin, 4)[:, None, None]
    lat, lon = direct(lat[:, None], lon[:, None], turns, away)
    row = np.rint((lat.ravel() + 90.0) * POINTS_OF_DEGREE).astype(np.int64)
    column = np.rint((lon.ravel() + 180.0) * POINTS_OF_DEGREE).astype(np.int64)
    return row, column % (360 * POINTS_OF_DEGREE)


def _free_tiles(shoal: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return how many tiles away the nearest tile with a shoal point is, up to `_TILES`."""
    side = POINTS_OF_TILE
    rows, columns = (shoal.shape[0] - 1) // side, shoal.shape[1] // side
    # points on the side between two tiles belong to both
    lower, upper = (part.reshape(rows, side, -1) for part in (shoal[:-1], shoal[1:]))
    across = np.any(np.concatenate([lower, upper], axis=1), axis=1)
    near = np.any(across.reshape(rows, columns, side), axis=2)
    near |= np.roll(across[:, ::side], -1, axis=1)
    free = np.full(near.shape, _TILES, np.uint8)
    for tiles in range(_TILES):
        free[near & (free == _TILES)] = tiles
        near = near | np.roll(near, 1, axis=1) | np.roll(near, -1, axis=1)
        grown = near.copy()
        grown[1:] |= near[:-1]
        grown[:-1] |= near[1:]
        near = grown
    return free
