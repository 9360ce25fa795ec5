"""Where and when a track is closed, with the lines of ships on it, for the browser."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    from thalweg.planning.plots.channel_closures import Closures
    from thalweg.route import Route

PLACES: Final = 90  #: of the diagram of place and time
TIMES: Final = 144


def closure_facts(found: Closures, routes: Iterable[Route]) -> dict[str, Any]:
    """Return the diagram of place and time of a track.

    Returns
    -------
    dict
        ``distance_m`` and ``times``; ``closed`` with a row of digits for each distance (0 open,
        1 too shallow, 2 current too strong, 3 unknown); ``lines`` of the routes, each with
        ``times`` and ``distance_m``.
    """
    codes = np.where(found.unknown, 3, np.where(found.strong, 2, found.shallow.astype(int)))
    return {
        "distance_m": np.round(found.distance, 1).tolist(),
        "times": np.round(found.times).tolist(),
        "closed": ["".join(map(str, row)) for row in codes],
        "lines": [_line(route) for route in routes],
    }


def _line(route: Route) -> dict[str, Any]:
    """Return distance over time of a route, with its waits."""
    samples = route.samples
    return {
        "times": np.round(np.asarray(samples["time"], float)).tolist(),
        "distance_m": np.round(np.asarray(samples["distance"], float), 1).tolist(),
    }
