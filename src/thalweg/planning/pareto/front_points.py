"""Tracks of the points of a network front."""

from __future__ import annotations

from typing import Any

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.network import Network
from thalweg.route import Track
from thalweg.route.refinement.track_geometry import course_changes

#: Course changes below this [rad] are ignored: 1 m of cross-track error on a leg of 100 km.
_MIN_COURSE_CHANGE = 2e-5


def track_from_front_point(network: Network, point: Any) -> Track:
    """Return a point of a network front as a track.

    Parameters
    ----------
    network : The network of the front.

    Returns
    -------
    Track : With waits and settings.
    """
    path = np.asarray(point.path)
    track = Track.along_path(
        network.stations.lat[path],
        network.stations.lon[path],
        arrive=point.path_arrive,
        depart=point.path_depart,
        setting=point.setting,
    )
    keep = essential_nodes(track.lat, track.lon, track.setting, track.wait)
    return track.kept(np.flatnonzero(keep))


def essential_nodes(lat: FloatArray, lon: FloatArray, setting: Any, wait: FloatArray) -> Any:
    """Return at which points of a path the ship turns, waits or changes its speed.

    Parameters
    ----------
    lat, lon : float64 array (points,) [deg]
    setting : Of the legs, (points - 1,).
    wait : float64 array (points,) [s]

    Returns
    -------
    bool array (points,) : The ends included.
    """
    keep = np.ones(len(lat), bool)
    turn = course_changes(lat, lon)
    same = (np.abs(turn) < _MIN_COURSE_CHANGE) & (setting[1:] == setting[:-1]) & (wait[1:-1] == 0.0)
    keep[1:-1] = ~same
    return keep
