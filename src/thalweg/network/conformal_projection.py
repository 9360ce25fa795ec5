"""Conformal projections: lattices are square in them, and angles are true.

The ellipsoid is mapped conformally to a sphere (conformal latitude, Karney 2011, "Transverse
Mercator with an accuracy of a few nanometers", J. Geodesy 85, eqs. 7-9), the sphere is turned
and mapped by Mercator. With the great circle from start to goal as its equator (an oblique
Mercator frame) the lattice is equidistant along the great circle; without turning, its rows and
columns are meridians and parallels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.arrays.sphere_vectors import arc_of_chord
from thalweg.core.ellipsoid import ECCENTRICITY_SQUARED
from thalweg.core.geodesy import MEAN_RADIUS, Position, wrap_longitude
from thalweg.core.types import FloatArray

_E2 = ECCENTRICITY_SQUARED
_E = float(np.sqrt(_E2))
# Series of geodetic latitude in conformal latitude: Snyder (1987), Map Projections, eq. 3-5.
_TO_GEODETIC = (
    _E2 / 2 + 5 * _E2**2 / 24 + _E2**3 / 12 + 13 * _E2**4 / 360,
    7 * _E2**2 / 48 + 29 * _E2**3 / 240 + 811 * _E2**4 / 11520,
    7 * _E2**3 / 120 + 81 * _E2**4 / 1120,
    4279 * _E2**4 / 161280,
)


def conformal_unit_vectors(lat: ArrayLike, lon: ArrayLike) -> FloatArray:
    """Return unit vectors (..., 3) on the conformal sphere of positions [deg].

    Parameters
    ----------
    lat, lon : array_like (...)
        Positions on the ellipsoid [deg].

    Returns
    -------
    ndarray (..., 3) : Unit vectors [-].
    """
    phi, lam = np.radians(np.asarray(lat, float)), np.radians(np.asarray(lon, float))
    sine = np.clip(np.sin(phi), -1.0 + 1e-15, 1.0 - 1e-15)
    tan_chi = np.sinh(np.arctanh(sine) - _E * np.arctanh(_E * sine))
    cos_chi = 1.0 / np.sqrt(1.0 + tan_chi**2)
    return np.stack([cos_chi * np.cos(lam), cos_chi * np.sin(lam), tan_chi * cos_chi], axis=-1)


def conformal_positions(vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return latitude and longitude [deg] of unit vectors (..., 3) on the conformal sphere."""
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    chi = np.arctan2(z, np.hypot(x, y))
    phi = chi + sum(c * np.sin(2 * (k + 1) * chi) for k, c in enumerate(_TO_GEODETIC))
    return np.degrees(phi), wrap_longitude(np.degrees(np.arctan2(y, x)))


def angle_to_point(vectors: FloatArray, point: FloatArray) -> FloatArray:
    """Return the angle [rad] between unit vectors (..., 3) and one point (3,).

    Parameters
    ----------
    vectors : ndarray (..., 3)
        Unit vectors.
    point : Unit vector, (3,).

    Returns
    -------
    ndarray (...) : Angles [rad].
    """
    difference = vectors - point
    chord = np.sqrt(np.einsum("...k,...k->...", difference, difference))
    return arc_of_chord(chord)


@dataclass(frozen=True)
class ConformalProjection:
    """A conformal frame with a unit of length; coordinates (x, y) are in that unit.

    Parameters
    ----------
    turn : ndarray (3, 3)
        Rows are the axes of the frame: (0, 0), a quarter round the equator, and the pole.
    unit : One unit of x or y at the frame's equator [rad].
    y0 : Mercator ordinate [rad] of the line y = 0.
    around : Units of x right round the globe when the frame is closed, else 0.
    """

    turn: FloatArray
    unit: float
    y0: float = 0.0
    around: int = 0

    @property
    def largest_unit(self) -> float:
        """Length [m] of one unit at the frame's equator, where it is largest."""
        return MEAN_RADIUS * self.unit

    @property
    def is_mercator(self) -> bool:
        """Whether rows and columns are meridians and parallels."""
        return bool(self.turn[2, 2] == 1.0)

    def refined(self, halvings: int) -> ConformalProjection:
        """Return the same frame with its unit halved a number of times."""
        parts = 2**halvings
        return replace(self, unit=self.unit / parts, around=self.around * parts)

    def from_vectors(self, vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the coordinates of unit vectors (..., 3)."""
        turned = vectors @ self.turn.T
        x = np.arctan2(turned[..., 1], turned[..., 0])
        level = np.hypot(turned[..., 0], turned[..., 1])
        y = np.arcsinh(turned[..., 2] / np.maximum(level, 1e-12))
        return x / self.unit, (y - self.y0) / self.unit

    def from_positions(self, lat: ArrayLike, lon: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return the coordinates of positions [deg]."""
        return self.from_vectors(conformal_unit_vectors(lat, lon))

    def to_vectors(self, x: ArrayLike, y: ArrayLike) -> FloatArray:
        """Return unit vectors (..., 3) of coordinates."""
        lam = np.asarray(x, float) * self.unit
        tan_phi = np.sinh(np.asarray(y, float) * self.unit + self.y0)
        cos_phi = 1.0 / np.sqrt(1.0 + tan_phi**2)
        turned = np.stack([cos_phi * np.cos(lam), cos_phi * np.sin(lam), tan_phi * cos_phi], -1)
        return np.asarray(turned @ self.turn)

    def to_positions(self, x: ArrayLike, y: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return latitude and longitude [deg] of coordinates."""
        return conformal_positions(self.to_vectors(x, y))

    def metres(self, y: ArrayLike) -> FloatArray:
        """Return the length [m] of one unit at ordinate y, on a sphere of mean radius."""
        return MEAN_RADIUS * self.unit / np.cosh(np.asarray(y, float) * self.unit + self.y0)


def great_circle_projection(start: Position, goal: Position, spacing: float) -> ConformalProjection:
    """Return the frame whose equator runs from start (0, 0) to goal, a whole number of units on.

    Parameters
    ----------
    start, goal : (lat, lon)
        Positions [deg], not the same.
    spacing : Wanted unit [m]; it is adjusted so that it divides the distance.
    """
    first, last = conformal_unit_vectors(*start), conformal_unit_vectors(*goal)
    distance = float(angle_to_point(first, last))
    pole = np.cross(first, last)
    if np.linalg.norm(pole) < 1e-9:  # antipodes: any great circle is as short; take the meridian
        pole = np.cross(first, [0.0, 0.0, 1.0] if abs(first[2]) < 0.9 else [1.0, 0.0, 0.0])
    pole = pole / np.linalg.norm(pole)
    turn = np.stack([first, np.cross(pole, first), pole])
    pieces = max(1, math.ceil(distance * MEAN_RADIUS / spacing - 1e-3))
    return ConformalProjection(turn=turn, unit=distance / pieces)


def mercator_projection(
    start: Position, spacing: float, *, latitude: float, closed: bool = False
) -> ConformalProjection:
    """Return the frame of meridians and parallels with (0, 0) at the start.

    Parameters
    ----------
    start : (lat, lon)
        Position [deg] of the origin.
    spacing : Unit [m] at the given latitude.
    latitude : Latitude [deg] where the unit has that length.
    closed : Close the frame round the globe (the unit is adjusted to divide the parallel).
    """
    east = conformal_unit_vectors(0.0, start[1])
    turn = np.stack([east, np.cross([0.0, 0.0, 1.0], east), [0.0, 0.0, 1.0]])
    vector = conformal_unit_vectors(*start)
    y0 = float(np.arcsinh(vector[2] / np.hypot(vector[0], vector[1])))
    unit = spacing / (MEAN_RADIUS * float(np.cos(np.radians(latitude))))
    if not closed:
        return ConformalProjection(turn=turn, unit=unit, y0=y0)
    pieces = max(8, round(2.0 * np.pi / unit))
    return ConformalProjection(turn=turn, unit=2.0 * np.pi / pieces, y0=y0, around=pieces)
