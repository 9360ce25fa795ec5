"""Route alternatives of a plan by closed canals, with a network for each."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from thalweg.chart import Chart
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import Position
from thalweg.network import Network, lattice, shortest_path
from thalweg.network.alternatives.path_search import without_each_set_of_canals
from thalweg.network.network_concatenation import concatenate_networks
from thalweg.planning.network_selection.bed_along_edges import with_bed_along_edges
from thalweg.planning.network_selection.network_builder import LatticeBetween, build_network
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.voyage_endpoints import Endpoint

#: Greatest number of nodes of networks for fronts, unless a resolution is given.
MAX_FRONT_NODES = 3_000
#: Alternatives longer than this multiple of the shortest are left out of plans.
MAX_LENGTH_RATIO = 1.8
_COAST_LEVELS = 2
OPEN_SEA: Final = "open sea"  #: name of the alternative without canals


@dataclass(frozen=True)
class RouteAlternative:
    """A route alternative and the network on which it is searched.

    Attributes
    ----------
    name : Its canals, such as ``"suez"``; ``"open sea"`` without canals.
    network : From start to goal through all via points.
    lattices : Of which the network is the finest small one, if it is one.
    """

    name: str
    network: Network
    lattices: LatticeBetween | None = None


def find_route_alternatives(
    context: PlanningContext,
    ends: Sequence[Endpoint],
    worth: Mapping[str, float],
    longest_ratio: float = MAX_LENGTH_RATIO,
) -> list[RouteAlternative]:
    """Return the route alternatives between the ends of a voyage.

    Parameters
    ----------
    worth : Length [m] that costs as much as a canal, by its name: so much longer may the way round
        it be.
    longest_ratio : Alternatives longer than this multiple of the shortest, beyond what the canals
        are worth, are left out.

    Notes
    -----
    The shortest one comes first. If it passes n canals there are up to 2^n - 1 more, one for every
    set of them that is closed. Repeated ones are left out. A network is built for each;
    `thalweg.network.paths_without_canals` compares paths on one given network.
    """
    context.report_progress(f"building the network from {ends[0].name} to {ends[-1].name}")
    first = _route_alternative(context, ends, context.chart)
    alternatives, used = {first.name: first}, canals_used(first.network, context.chart)
    longest = longest_ratio * _shortest_length(first.network)
    longest += sum(worth.get(name, 0.0) for name in used)

    def find(closed: tuple[str, ...]) -> RouteAlternative | None:
        context.report_progress(f"building the network without {' and '.join(closed)}")
        try:
            return _route_alternative(context, ends, context.chart.without_canals(*closed))
        except NoRouteError:
            return None

    for other in without_each_set_of_canals(used, find):
        if _shortest_length(other.network) <= longest:
            alternatives.setdefault(other.name, other)
    return list(alternatives.values())


def network_of_all_ways(
    alternative: RouteAlternative, chart: Chart, ends: Sequence[Endpoint]
) -> Network:
    """Return a network with the ways round large islands that the one of an alternative lacks.

    A small network may cover only the water along the shortest path, and a layered one leads
    round land on one side only.

    Parameters
    ----------
    alternative : Its own network is returned where it has all ways, and with via points.
    """
    lattices, own = alternative.lattices, alternative.network
    if lattices is None and len(ends) == 2 and own.meta.kind == "layered":
        start, goal = ends
        lattices = LatticeBetween(chart, (start.lat, start.lon), (goal.lat, goal.lon))
    if lattices is None:
        return own
    try:
        wide = lattices.network(coast_levels=0)
    except NoRouteError:  # straits narrower than the spacing
        return own
    return own if wide.n_nodes <= MAX_FRONT_NODES and own.meta.kind != "layered" else wide


def canals_used(network: Network, chart: Chart) -> tuple[str, ...]:
    """Return the names of the canals on the shortest path over a network."""
    _, path = shortest_path(network, network.meta.start, network.meta.goal)
    lat, lon = network.lat[path], network.lon[path]
    which = chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])
    return tuple(dict.fromkeys(chart.canals[i].name for i in which if i >= 0))


def _shortest_length(network: Network) -> float:
    return float(
        shortest_path(network, network.meta.start, network.meta.goal)[0][network.meta.goal]
    )


def _route_alternative(
    context: PlanningContext, ends: Sequence[Endpoint], chart: Chart
) -> RouteAlternative:
    context = replace(context, chart=chart)
    places = [(end.lat, end.lon) for end in ends]
    choices = [context.choice.of_section(places, i) for i in range(len(ends) - 1)]
    found = [
        _network(replace(context, choice=choice), a, b)
        for choice, (a, b) in zip(choices, itertools.pairwise(ends))
    ]
    network = concatenate_networks([one for one, _ in found], [None] * (len(found) - 1))
    network = with_bed_along_edges(network, context.sea, context.needs.limits.required_depth)
    name = " and ".join(canals_used(network, chart)) or OPEN_SEA
    return RouteAlternative(name, network, found[0][1] if len(found) == 1 else None)


def _network(
    context: PlanningContext, start: Endpoint, goal: Endpoint
) -> tuple[Network, LatticeBetween | None]:
    """Return a network that is small enough for the search of a front, and its lattices."""
    choice = context.choice
    period = context.voyage.earliest_departure, context.data_end
    if choice.network not in ("auto", "lattice") or choice.spacing is not None:
        return build_network(choice, context.chart, context.sea, (start, goal), period=period), None
    if choice.network == "auto" and context.sea.mesh() is not None:
        network = build_network(choice, context.chart, context.sea, (start, goal), period=period)
        if network.meta.kind == "mesh":
            return network, None
    lattices = LatticeBetween(context.chart, (start.lat, start.lon), (goal.lat, goal.lon))
    return _finest_small_lattice(lattices), lattices


def _finest_small_lattice(lattices: LatticeBetween) -> Network:
    """Return the lattice with the finest coasts that is small enough, else one in a corridor.

    The coarsest comes first: where it is too large, finer ones are too.
    """
    found: Network | None = None
    refusal: NoRouteError | None = None
    for levels in range(_COAST_LEVELS + 1):
        try:
            network = lattices.network(coast_levels=levels)
        except NoRouteError as error:  # straits narrower than the spacing
            refusal = error
            continue
        if network.n_nodes > MAX_FRONT_NODES:
            return found or _corridor_lattice(lattices.chart, network, lattices.places)
        found = network
    if found is None:
        assert refusal is not None  # no lattice was built
        raise refusal
    return found


def _corridor_lattice(chart: Chart, wide: Network, places: tuple[Position, Position]) -> Network:
    """Return a lattice in a corridor around the shortest path over a network that is too large."""
    _, path = shortest_path(wide, wide.meta.start, wide.meta.goal)
    centre_line = list(zip(wide.lat[path], wide.lon[path]))
    length = _shortest_length(wide)
    width = min(max(length / 10.0, 40_000.0), 400_000.0)
    spacing = max(math.sqrt(2.5 * length * width / (0.5 * MAX_FRONT_NODES)), length / 150.0)
    for _ in range(6):
        network = lattice(
            chart, *places, along=centre_line, width=width, spacing=spacing, coast_levels=1
        )
        if network.n_nodes <= MAX_FRONT_NODES:
            break
        spacing *= 1.3
    return network
