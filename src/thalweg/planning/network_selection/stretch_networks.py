"""The networks on which a stretch is searched, one after the other until a route is feasible."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from thalweg.network import Network
from thalweg.planning.network_selection.bed_along_edges import with_bed_along_edges
from thalweg.planning.network_selection.network_builder import build_network
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.voyage_endpoints import Endpoint


def lattice_may_replace(context: PlanningContext, network: Network) -> bool:
    """Return whether a lattice may replace a mesh that was chosen automatically."""
    return context.choice.network == "auto" and network.meta.kind == "mesh"


def mesh_is_thinned(context: PlanningContext, network: Network) -> bool:
    """Return whether a mesh was thinned because the user set a spacing."""
    return network.meta.kind == "mesh" and context.choice.spacing is not None


def network_of_attempt(
    context: PlanningContext,
    ends: tuple[Endpoint, Endpoint],
    finer: int,
    networks: Mapping[int, Network],
) -> Network:
    """Return the network of a stretch.

    Parameters
    ----------
    finer : How many times finer than asked for.
    networks : Those built before, by their fineness.
    """
    context.report_progress(f"building the network from {ends[0].name} to {ends[1].name}")
    choice, first = context.choice, networks.get(1)
    if first is not None and lattice_may_replace(context, first):
        # The nodes of a model cannot be refined; a lattice over the same water can.
        spacing = networks[2].meta.spacing_m * 2 / finer if 2 in networks else choice.spacing
        choice = replace(choice, network="lattice", spacing=spacing)
    elif first is not None and first.meta.kind == "mesh":
        if not mesh_is_thinned(context, first):
            return first
        choice = replace(choice, spacing=None)  # all nodes, or as many as can be searched
    elif first is not None:
        choice = replace(choice, spacing=first.meta.spacing_m / finer)
    period = context.voyage.earliest_departure, context.data_end
    network = build_network(choice, context.chart, context.sea, ends, period=period)
    return with_bed_along_edges(network, context.sea, context.needs.limits.required_depth)
