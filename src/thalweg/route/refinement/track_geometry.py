"""Sideways directions, displacements and alterations of course of tracks."""

from __future__ import annotations

import numpy as np

from thalweg.core.geodesy import METRES_PER_DEGREE, inverse, rough_lengths, unit_vectors
from thalweg.core.types import FloatArray, IntArray

_SMALLEST_COSINE = 1e-3  # of the latitude, so that displacements at the poles stay finite


def starboard_vectors(
    lat: FloatArray, lon: FloatArray, count: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return (east, north) of the unit vector to starboard at every point of tracks.

    Parameters
    ----------
    lat, lon : Points [deg], (R, M).
    count : Number of points of each track, (R,); the rest of a row is not used.

    Returns
    -------
    east, north : float64 array (R, M)
        Across the line between the two neighbours of a point, or across the leg at an end.
    """
    last = count[:, None] - 1
    index = np.minimum(np.arange(lat.shape[1])[None, :], last)
    after, before = np.minimum(index + 1, last), np.maximum(index - 1, 0)
    north = np.take_along_axis(lat, after, 1) - np.take_along_axis(lat, before, 1)
    turn = np.take_along_axis(lon, after, 1) - np.take_along_axis(lon, before, 1)
    east = (turn - 360.0 * np.round(turn / 360.0)) * np.cos(np.radians(lat))
    norm = np.hypot(east, north)
    norm[norm == 0.0] = 1.0
    return north / norm, -east / norm


def displaced_positions(
    lat: FloatArray, lon: FloatArray, east: FloatArray, north: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return positions [deg] displaced east and north [m] in their tangent planes.

    Longitudes are not wrapped, so that lines stay without jumps.

    Parameters
    ----------
    lat, lon : float64 array (...) [deg]
    east, north : float64 array (...)
        Displacements [m]; broadcast with the positions.

    Returns
    -------
    lat, lon : float64 array (...) [deg]
    """
    scale = np.maximum(np.cos(np.radians(lat)), _SMALLEST_COSINE)
    return lat + north / METRES_PER_DEGREE, lon + east / (METRES_PER_DEGREE * scale)


def shorter_adjacent_legs(lengths: FloatArray) -> FloatArray:
    """Return the length of the shorter of the two legs beside every point (R, M) [m].

    ``lengths`` (R, M) are those of the leg that starts at each point, 0 after the last; ends of
    tracks have 0.
    """
    shorter = np.zeros_like(lengths)
    shorter[:, 1:] = np.minimum(lengths[:, :-1], lengths[:, 1:])
    return shorter


def turning_losses(lat: FloatArray, lon: FloatArray) -> FloatArray:
    r"""Return what each straight leg loses to the curve that a line stands for (n - 1,).

    A leg of length :math:`h` that replaces an arc of turn :math:`\theta` is longer than the best
    curve by :math:`\theta^2 h / 24`; half of the turns at its two ends is its share.

    Parameters
    ----------
    lat, lon : Points of one line [deg], (n,).

    Returns
    -------
    float64 array (n - 1,) : As shares of the length of the line.
    """
    points = unit_vectors(lat, lon)
    normal = np.cross(points[:-1], points[1:])
    across = np.linalg.norm(np.cross(normal[:-1], normal[1:]), axis=1)
    turn = np.arctan2(across, np.sum(normal[:-1] * normal[1:], axis=1))
    both = np.concatenate([turn[:1], 0.5 * (turn[:-1] + turn[1:]), turn[-1:]])
    lengths = rough_lengths(lat, lon)
    loss: FloatArray = both * both * lengths / (24.0 * lengths.sum())
    return loss


def course_changes(lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return the alterations of course at the inner waypoints of a line of geodesics.

    Parameters
    ----------
    lat, lon : float64 array (n,) [deg]

    Returns
    -------
    float64 array (n - 2,) : To starboard [rad], in [-pi, pi].
    """
    _, start, end = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
    return np.asarray(np.angle(np.exp(1j * (start[1:] - end[:-1]))))
