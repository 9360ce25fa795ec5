"""Ways round land and control areas, drawn taut, each with its own front of speeds.

The network of a front has to be coarse. Between islands and along borders of control areas the
best lines are known exactly without weather: they are found on a finer network, pulled taut, and
only their speeds and waits are searched, in the weather. Refinement goes on from them.
"""

from __future__ import annotations

import math

from thalweg.network import Network, Weighing, line, ways_round
from thalweg.network.alternatives.alternative_path import Way as TautWay
from thalweg.planning.interrupt_guard import Stopped
from thalweg.planning.network_selection.network_choice import lattice_between
from thalweg.planning.pareto.exploration import (
    Candidate,
    Means,
    look_ahead,
    network_front,
    track_of_point,
)

_MOST = 5  # ways round
_STRETCH = 0.2  # at most so much longer, or dearer, than the best
_PIECES = 60  # of a way, between which the speed may change
_POINTS = 24  # of the front of each way


def round_candidates(means: Means) -> list[Candidate]:
    """Return routes along the ways round between two ends, with their best speeds.

    Voyages by other places, and networks that are asked for by name, have none.
    """
    task = means.task
    choice = task.choice
    own = choice.network not in ("auto", "lattice") or task.sea.mesh() is not None
    if own or choice.spacing is not None or means.via:
        return []
    task.tell("drawing the ways round land and control areas")
    start, goal = ((end.lat, end.lon) for end in (means.ends[0], means.ends[-1]))
    network = lattice_between(task.chart, start, goal)
    found: list[Candidate] = []
    for way in ways_round(
        network, task.chart, weighings=_weighings(means, network), most=_MOST, stretch=_STRETCH
    ):
        try:
            found += _sped(means, way)
        except Stopped:
            break
    return found


def _weighings(means: Means, network: Network) -> list[Weighing]:
    """Return lengths, and lengths with what control areas and zones cost, in full and by half."""
    inside, outside = means.criterion.inside, means.criterion.outside
    ratio = inside / outside if inside != outside else 1.0
    if ratio == 1.0 and not means.task.chart.zones.price:
        return [Weighing()]
    factors = sorted({math.sqrt(ratio), ratio})
    return [Weighing(), *(Weighing.priced(network, means.task.chart, f) for f in factors)]


def _sped(means: Means, way: TautWay) -> list[Candidate]:
    """Return routes along one way with the best speeds; none if it cannot be sailed in time."""
    task = means.task
    network = line(task.chart, way.waypoints, spacing=max(way.length / _PIECES, 1.0))
    ahead = look_ahead(means, network)
    if not ahead.first.found or ahead.first.arrive > ahead.latest:
        return []
    found = network_front(means, network, ahead.frozen, ahead.latest, lower=False)
    name = " and ".join(way.canals) or "open sea"
    return [
        Candidate(track_of_point(network, point), "way round", name, point.time, point.cost)
        for point in found.spread(_POINTS)
    ]
