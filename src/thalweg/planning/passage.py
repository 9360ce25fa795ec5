"""One passage between two ends: network, frozen sea, exact search, refinement, referee."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import distance, format_position
from thalweg.core.time import format_time
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.planning.ends import End
from thalweg.planning.needs import Needs
from thalweg.planning.networks import NetworkChoice, build_network
from thalweg.planning.voyage import Voyage
from thalweg.route import Route, Track, evaluate
from thalweg.sea import Sea, StationFields
from thalweg.search import Bound, SearchResult, best_departure, earliest_arrival, lower_bound
from thalweg.ship import PerformanceTable, Ship

#: Frozen fields larger than this are refused before they are taken [bytes].
MEMORY_LIMIT = 3_000_000_000
#: How far ahead the sea is frozen, in multiples of the time the straight way would take.
_HORIZONS = (2.5, 6.0, 20.0)
_ONE_TIDE = 14 * 3600.0


@dataclass(frozen=True)
class Task:
    """What stays the same for every passage of a voyage."""

    voyage: Voyage
    ship: Ship
    sea: Sea
    chart: Chart
    needs: Needs
    table: PerformanceTable
    setting: int
    last: float
    choice: NetworkChoice
    tell: Callable[[str], None] = field(default=lambda text: None)


@dataclass(frozen=True)
class Passage:
    """What came of one passage."""

    route: Route
    result: SearchResult
    bound: Bound
    network: Network
    notes: tuple[str, ...]


def make_passage(
    task: Task, start: End, goal: End, window: tuple[float, float]
) -> Passage:
    """Find the best route between two ends, departing inside a window of times.

    Raises
    ------
    NoRouteError
        If no route exists within the limits and the data.
    """
    task.tell(f"building the network from {start.name} to {goal.name}")
    network = build_network(task.choice, task.chart, task.sea, start, goal)
    for required_margin in (0.0, 0.1, 0.3, 1.0):
        strict = _with_margin(task, required_margin)
        fields, result = _search(strict, network, start, goal, window)
        track = track_of(network, result, task.setting)
        route = _referee(task, track)
        route = _improve(strict, task, network, fields, route)
        if route.feasible:
            break
    task.tell("bounding the answer")
    bound = _bound(task, network, fields, result, window)
    notes = () if route.feasible else ("The referee finds limits broken on this route.",)
    return Passage(route, result, bound, network, notes)
