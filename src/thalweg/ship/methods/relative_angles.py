"""Angles from the bow: relative angle of waves and wind, and the relative wind.

Angles are those between the bow and where wind or waves come from, 0 ahead, pi astern; port and
starboard are equal.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray


def relative_angle(from_east: ArrayLike, from_north: ArrayLike, heading: ArrayLike) -> FloatArray:
    """Return the angle between the bow and where something comes from.

    Parameters
    ----------
    from_east, from_north : Components of a vector that points where it comes from; of any length.
    heading : Heading of the ship [rad], clockwise from north.

    Returns
    -------
    ndarray : atan2(abs(e cos h - n sin h), e sin h + n cos h) [rad], 0 to pi.
    """
    east, north = np.asarray(from_east, float), np.asarray(from_north, float)
    sine, cosine = np.sin(heading), np.cos(heading)
    ahead = east * sine + north * cosine
    abeam = east * cosine - north * sine
    return np.arctan2(np.abs(abeam), ahead + 0.0)


def relative_wind_from_vectors(
    wind_east: ArrayLike,
    wind_north: ArrayLike,
    *,
    frame_east: ArrayLike,
    frame_north: ArrayLike,
    heading: ArrayLike,
) -> tuple[FloatArray, FloatArray]:
    """Return the wind relative to a moving frame: w = wind - velocity of the frame.

    Parameters
    ----------
    wind_east, wind_north : True wind, towards [m/s].
    frame_east, frame_north : Velocity over ground [m/s] of the frame: of the water for the wind
        relative to the water, of the ship for the wind as measured on board.
    heading : Heading of the ship [rad], clockwise from north.

    Returns
    -------
    speed, angle : Speed [m/s], and angle [rad] as in `relative_angle`.
    """
    east = np.asarray(wind_east, dtype=float) - frame_east
    north = np.asarray(wind_north, dtype=float) - frame_north
    return np.hypot(east, north), relative_angle(-east, -north, heading)


def relative_wind(
    wind_speed: ArrayLike, wind_angle: ArrayLike, *, ship_speed: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return the wind as measured on board, from the true wind and the speed of the ship.

    w^2 = (W cos a + V)^2 + (W sin a)^2; the angle is atan2(W abs(sin a), W cos a + V).

    Parameters
    ----------
    wind_speed : True wind speed [m/s].
    wind_angle : Between the heading and where the true wind comes from [rad], 0 from ahead.
    ship_speed : Along the heading, in the same frame as the wind [m/s].

    Returns
    -------
    speed, angle : ndarray
        Relative wind speed [m/s] and angle 0 to pi from the bow to where it comes from [rad].
    """
    wind = np.asarray(wind_speed, dtype=float)
    angle = np.asarray(wind_angle, dtype=float)
    ahead = wind * np.cos(angle) + np.asarray(ship_speed, dtype=float)
    across = wind * np.abs(np.sin(angle))
    return np.hypot(ahead, across), np.arctan2(across, ahead)
