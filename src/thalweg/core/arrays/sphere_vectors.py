"""Unit vectors on a sphere: arcs between them, and their positions."""

from __future__ import annotations

import numpy as np

from thalweg.core.types import FloatArray


def arc_of_chord(chord: FloatArray) -> FloatArray:
    """Return the arcs [rad] of chords of the unit sphere.

    Parameters
    ----------
    chord : ndarray (...)
        Straight distances between unit vectors [-]; above 2 counts as 2.
    """
    return np.asarray(2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0)))


def spherical_positions(vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return latitude and longitude [deg] of vectors (n, 3), taken for a sphere's.

    Parameters
    ----------
    vectors : ndarray (n, 3)
        From the middle of the sphere, of any length.

    Returns
    -------
    lat, lon : ndarray (n,)
        Positions on the sphere [deg].
    """
    x, y, z = vectors.T
    return np.degrees(np.arctan2(z, np.hypot(x, y))), np.degrees(np.arctan2(y, x))
