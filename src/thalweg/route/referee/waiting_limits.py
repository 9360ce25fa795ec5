"""Waits where the chart does not allow them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.route.route import Violation
from thalweg.route.track import Track

if TYPE_CHECKING:
    from thalweg.chart import Chart

WAITING_NOT_ALLOWED = "waiting not allowed"


def waiting_violations(chart: Chart | None, track: Track, arrive: FloatArray) -> list[Violation]:
    """Return the waits at waypoints where the chart allows none; the first waypoint is a berth.

    Parameters
    ----------
    arrive : float64 array (legs,)
        When each leg ends [s since 1970]; NaN where the ship does not get.
    """
    waits = np.flatnonzero(track.wait[1:-1]) + 1
    if chart is None or not waits.size:
        return []
    allowed = chart.may_wait(track.lat[waits], track.lon[waits])
    return [
        Violation(
            WAITING_NOT_ALLOWED, float(arrive[k - 1]), float(track.lat[k]), float(track.lon[k])
        )
        for k in waits[~allowed]
        if np.isfinite(arrive[k - 1])
    ]
