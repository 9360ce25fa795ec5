"""Sideways directions and displacements of batches of tracks."""

from __future__ import annotations

import numpy as np

from thalweg.core.geodesy import METRES_PER_DEGREE
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
