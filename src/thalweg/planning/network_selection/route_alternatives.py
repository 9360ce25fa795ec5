"""The ways round that a plan looks at: a network for each."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from thalweg.chart import Chart
from thalweg.core.errors import NoRouteError
from thalweg.network import Network, lattice, shortest
from thalweg.network.network_concatenation import joined
from thalweg.planning.network_selection.network_choice import build_network, lattice_between
from thalweg.planning.request.voyage_endpoints import End
from thalweg.planning.single.passage import Task

#: Fronts are searched on networks of about this many nodes, unless a resolution is given.
MOST_NODES = 3_000
#: Ways round longer than this multiple of the shortest are not looked at.
LONGEST_WAY = 1.8
_COAST_LEVELS = 2


@dataclass(frozen=True)
class Way:
    """One way round, and the network it is searched on.

    Attributes
    ----------
    name : str
        By its canals, such as ``"suez"``; ``"open sea"`` without any.
    network : Network
        From the first end to the last, by all places between.
    """

    name: str
    network: Network


def find_ways(task: Task, ends: Sequence[End]) -> list[Way]:
    """Return the ways round between the ends of a voyage.

    The shortest way comes first. Where it takes n canals there are up to 2^n - 1 more, one for
    every set of them that is closed; those over `LONGEST_WAY` times as long are left out, and so
    are those that turn out to be the same.
    """
    task.tell(f"building the network from {ends[0].name} to {ends[-1].name}")
    first = _way(task, ends, task.chart)
    ways, used = {first.name: first}, canals_used(first.network, task.chart)
    longest = LONGEST_WAY * _length(first.network)
    for count in range(1, len(used) + 1):
        for closed in itertools.combinations(used, count):
            task.tell(f"looking for a way without {' and '.join(closed)}")
            try:
                way = _way(task, ends, task.chart.without_canals(*closed))
            except NoRouteError:
                continue
            if _length(way.network) <= longest:
                ways.setdefault(way.name, way)
    return list(ways.values())


def canals_used(network: Network, chart: Chart) -> tuple[str, ...]:
    """Return the names of the canals on the shortest way over a network."""
    _, path = shortest(network, network.meta.start, network.meta.goal)
    lat, lon = network.lat[path], network.lon[path]
    which = chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])
    return tuple(dict.fromkeys(chart.canals[i].name for i in which if i >= 0))


def _length(network: Network) -> float:
    return float(shortest(network, network.meta.start, network.meta.goal)[0][network.meta.goal])


def _way(task: Task, ends: Sequence[End], chart: Chart) -> Way:
    task = replace(task, chart=chart)
    stretches = [_network(task, a, b) for a, b in itertools.pairwise(ends)]
    network = joined(stretches, [None] * (len(stretches) - 1))
    return Way(" and ".join(canals_used(network, chart)) or "open sea", network)


def _network(task: Task, start: End, goal: End) -> Network:
    """Return a network that is not too large for the search of a whole front."""
    choice = task.choice
    period = task.voyage.earliest_departure, task.last
    if choice.network not in ("auto", "lattice") or choice.spacing is not None:
        return build_network(choice, task.chart, task.sea, (start, goal), period=period)
    if choice.network == "auto" and task.sea.mesh() is not None:
        network = build_network(choice, task.chart, task.sea, (start, goal), period=period)
        if network.meta.kind == "mesh":
            return network
    places = (start.lat, start.lon), (goal.lat, goal.lon)
    for levels in range(_COAST_LEVELS, -1, -1):
        network = lattice_between(task.chart, *places, coast_levels=levels)
        if network.n_nodes <= MOST_NODES:
            return network
    return _along(task.chart, network, places)


def _along(
    chart: Chart, wide: Network, places: tuple[tuple[float, float], tuple[float, float]]
) -> Network:
    """Return a lattice of a corridor about the shortest way over a network that is too large."""
    _, path = shortest(wide, wide.meta.start, wide.meta.goal)
    way = list(zip(wide.lat[path], wide.lon[path]))
    length = _length(wide)
    width = min(max(length / 10.0, 40_000.0), 400_000.0)
    spacing = max(math.sqrt(2.5 * length * width / (0.5 * MOST_NODES)), length / 150.0)
    for _ in range(6):
        network = lattice(chart, *places, along=way, width=width, spacing=spacing, coast_levels=1)
        if network.n_nodes <= MOST_NODES:
            break
        spacing *= 1.3
    return network
