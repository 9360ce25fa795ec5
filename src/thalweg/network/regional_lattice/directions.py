"""Directions of a lattice: all coprime offsets up to a size."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import IntArray

LARGEST_OFFSETS = {
    8: 1,
    16: 2,
    32: 3,
    48: 4,
    80: 5,
    96: 6,
}  #: largest offset by number of directions


def unique_offsets(directions: int) -> tuple[IntArray, IntArray]:
    """Return offsets (di, dj), one of each opposite pair, for a number of directions.

    Raises
    ------
    InputError : For a number that is not 8, 16, 32, 48, 80 or 96.
    """
    if directions not in LARGEST_OFFSETS:
        raise InputError(
            f"A lattice cannot have {directions!r} directions.",
            f"Possible: {', '.join(map(str, LARGEST_OFFSETS))}.",
            "Choose one of these.",
            value=directions,
        )
    size = LARGEST_OFFSETS[directions]
    offsets = [
        (i, j)
        for i in range(0, size + 1)
        for j in range(-size, size + 1)
        if math.gcd(i, j) == 1 and (i > 0 or j > 0)
    ]
    di, dj = np.array(offsets, np.int64).T.copy()
    return di, dj


def largest_angle_gap(di: IntArray, dj: IntArray) -> float:
    """Return the largest angle [rad] between neighbouring directions of offsets and opposites."""
    angles = np.sort(np.concatenate([np.arctan2(dj, di), np.arctan2(-dj, -di)]))
    return float(np.diff(np.append(angles, angles[0] + 2.0 * np.pi)).max())
