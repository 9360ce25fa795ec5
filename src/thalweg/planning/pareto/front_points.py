"""Points of a front: which are not dominated, an even selection, and their tracks."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from thalweg.core.geodesy import inverse
from thalweg.core.types import FloatArray
from thalweg.network import Network
from thalweg.route import Track

#: Course changes below this [rad] are ignored: 1 m of cross-track error on a leg of 100 km.
_MIN_COURSE_CHANGE = 2e-5


def non_dominated_indices(time: FloatArray, value: FloatArray) -> list[int]:
    """Return the indices of the points that are not dominated, by ascending time."""
    kept: list[int] = []
    least = math.inf
    for index in np.lexsort((value, time)):
        if value[index] * (1.0 + 1e-9) < least:
            kept.append(int(index))
            least = float(value[index])
    return kept


def evenly_spaced_subset(time: FloatArray, value: FloatArray, count: int) -> np.ndarray:
    """Return the indices of at most ``count`` points of a front: its ends, and evenly between."""
    order = np.argsort(time, kind="stable")
    if len(order) <= count:
        return order
    x = (time[order] - time[order[0]]) / max(float(np.ptp(time)), 1e-12)
    y = (value[order] - value.min()) / max(float(np.ptp(value)), 1e-12)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    wanted = np.linspace(0.0, along[-1], count)
    picked = np.unique(np.abs(along[None, :] - wanted[:, None]).argmin(axis=1))
    return np.asarray(order[picked])


def track_from_front_point(network: Network, point: Any) -> Track:
    """Return a point of a network front as a track."""
    path = np.asarray(point.path)
    wait = np.maximum(0.0, np.asarray(point.path_depart) - np.asarray(point.path_arrive))
    wait[-1] = 0.0
    wait = np.where(wait < 1.0, 0.0, wait)
    setting = np.asarray(point.setting)
    lat, lon = network.station_lat[path], network.station_lon[path]
    kept = np.flatnonzero(_essential_nodes(lat, lon, setting, wait))
    return Track(lat[kept], lon[kept], float(point.path_arrive[0]), wait[kept], setting[kept[:-1]])


def _essential_nodes(lat: FloatArray, lon: FloatArray, setting: Any, wait: FloatArray) -> Any:
    """Return at which points of a path the ship turns, waits or changes its speed."""
    keep = np.ones(len(lat), bool)
    _, course, back = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
    turn = np.angle(np.exp(1j * (course[1:] - back[:-1])))
    same = (np.abs(turn) < _MIN_COURSE_CHANGE) & (setting[1:] == setting[:-1]) & (wait[1:-1] == 0.0)
    keep[1:-1] = ~same
    return keep
