"""From a path on a network to a smooth route, scored by the referee and kept only if better."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from thalweg.route import Route, Track

if TYPE_CHECKING:
    from thalweg.planning.passage import Task


def refine(task: Task, track: Track, scored: Route, limits: np.ndarray, top_speed: float) -> Route:
    return scored
