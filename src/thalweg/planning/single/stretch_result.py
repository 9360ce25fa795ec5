"""The result of planning one stretch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thalweg.network import Network
from thalweg.route import Route
from thalweg.search import SearchResult


@dataclass(frozen=True)
class StretchResult:
    """Result of one stretch.

    Attributes
    ----------
    route : The best route, scored by the referee.
    result : Result of the search on the network.
    network : The network searched.
    isochrones : Earliest arrival at every node [s since 1970], for the map; inf where not reached.
    notes : Notes for the user.
    """

    route: Route
    result: SearchResult
    network: Network
    isochrones: np.ndarray
    notes: tuple[str, ...]
