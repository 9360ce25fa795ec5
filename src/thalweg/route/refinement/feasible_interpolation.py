"""Bisection between a feasible route and a better track that is not quite feasible."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import unwrap_longitude
from thalweg.core.types import FloatArray
from thalweg.route.route import Route
from thalweg.route.track import Track

_BISECTIONS = 7


def bisect_to_feasible(feasible: Route, better: Track, score: Callable[[Track], Route]) -> Route:
    """Return the feasible route nearest to a better track that violates a limit.

    Rasters blur edges: around a bank with a steep slope the smoothed track may cut a corner by less
    than a cell. Both tracks are interpolated at equal shares of their lengths, and the share of the
    feasible one is bisected.

    Parameters
    ----------
    feasible : A route within every limit.
    better : A better track that violates one.
    score : The referee: a track to its route.
    """
    if feasible.track.wait.any() or better.wait.any() or np.ptp(feasible.track.setting):
        return feasible
    best, too_little, enough = feasible, 0.0, 1.0
    for _ in range(_BISECTIONS):
        share = 0.5 * (too_little + enough)
        route = score(_interpolated_track(feasible.track, better, share))
        if route.feasible:
            enough = share
            best = min(best, route, key=lambda item: item.arrive)
        else:
            too_little = share
    return best


def _interpolated_track(feasible: Track, better: Track, share: float) -> Track:
    """Return the track at a share between the better one (0) and the feasible one (1)."""
    at = np.union1d(_length_fractions(feasible), _length_fractions(better))
    at = at[np.concatenate([[True], np.diff(at) > 1e-9])]
    lat = (1 - share) * _values_at_fractions(better, better.lat, at) + share * _values_at_fractions(
        feasible, feasible.lat, at
    )
    lon = unwrap_longitude(np.concatenate([better.lon, feasible.lon]))
    better_lon, feasible_lon = lon[: len(better.lon)], lon[len(better.lon) :]
    feasible_lon = feasible_lon + 360.0 * np.round((better_lon[0] - feasible_lon[0]) / 360.0)
    lon = (1 - share) * _values_at_fractions(better, better_lon, at) + share * _values_at_fractions(
        feasible, feasible_lon, at
    )
    lat[[0, -1]], lon[[0, -1]] = feasible.lat[[0, -1]], feasible.lon[[0, -1]]
    return Track(lat, lon, feasible.depart, None, np.full(len(at) - 1, feasible.setting[0]))  # type: ignore[arg-type]


def _length_fractions(track: Track) -> FloatArray:
    """Return the share of the length before each waypoint."""
    along = cumulative_sums(track.lengths)
    return np.asarray(along / along[-1])


def _values_at_fractions(track: Track, values: FloatArray, at: FloatArray) -> FloatArray:
    return np.asarray(np.interp(at, _length_fractions(track), values))
