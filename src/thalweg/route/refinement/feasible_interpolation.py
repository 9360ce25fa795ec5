"""Between a route that can be sailed and a better one that cannot quite."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thalweg.core.geodesy import unwrap_longitude
from thalweg.core.types import FloatArray
from thalweg.route.route import Route
from thalweg.route.track import Track

_BISECTIONS = 7


def bisect_to_feasible(sound: Route, wished: Track, score: Callable[[Track], Route]) -> Route:
    """Return the route nearest to a wished track that the referee still allows.

    Rasters blur edges: round a bank with a steep rim the smoothed track can cut a corner by less
    than a cell. Both tracks are walked at equal shares of their lengths, and the share of the
    sound one is halved as long as the referee agrees.

    Parameters
    ----------
    sound : Route
        A route within every limit.
    wished : Track
        A better track that breaks one.
    score : callable
        The referee.
    """
    if sound.track.wait.any() or wished.wait.any() or np.ptp(sound.track.setting):
        return sound
    best, too_little, enough = sound, 0.0, 1.0
    for _ in range(_BISECTIONS):
        share = 0.5 * (too_little + enough)
        route = score(_interpolated_track(sound.track, wished, share))
        if route.feasible:
            enough = share
            best = min(best, route, key=lambda item: item.arrive)
        else:
            too_little = share
    return best


def _interpolated_track(sound: Track, wished: Track, share: float) -> Track:
    """Return the track that lies ``share`` of the way from the wished one to the sound one."""
    at = np.union1d(_length_fractions(sound), _length_fractions(wished))
    at = at[np.concatenate([[True], np.diff(at) > 1e-9])]
    lat = (1 - share) * _values_at_fractions(wished, wished.lat, at) + share * _values_at_fractions(
        sound, sound.lat, at
    )
    lon = unwrap_longitude(np.concatenate([wished.lon, sound.lon]))
    wished_lon, sound_lon = lon[: len(wished.lon)], lon[len(wished.lon) :]
    sound_lon = sound_lon + 360.0 * np.round((wished_lon[0] - sound_lon[0]) / 360.0)
    lon = (1 - share) * _values_at_fractions(wished, wished_lon, at) + share * _values_at_fractions(
        sound, sound_lon, at
    )
    lat[[0, -1]], lon[[0, -1]] = sound.lat[[0, -1]], sound.lon[[0, -1]]
    return Track(lat, lon, sound.depart, None, np.full(len(at) - 1, sound.setting[0]))  # type: ignore[arg-type]


def _length_fractions(track: Track) -> FloatArray:
    """Return how much of the length lies before each waypoint."""
    along = np.concatenate([[0.0], np.cumsum(track.lengths)])
    return np.asarray(along / along[-1])


def _values_at_fractions(track: Track, values: FloatArray, at: FloatArray) -> FloatArray:
    return np.asarray(np.interp(at, _length_fractions(track), values))
