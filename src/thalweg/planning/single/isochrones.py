"""Earliest arrivals at the nodes of the network of a stretch, for maps."""

from __future__ import annotations

import numpy as np

from thalweg.core.limits import Limits
from thalweg.network import Network
from thalweg.planning.frozen_sea import FrozenSea, ship_in_frozen_sea
from thalweg.planning.planning_context import PlanningContext
from thalweg.search import ShipOnNetwork, earliest_arrival


def ship_for_search(
    context: PlanningContext, network: Network, frozen: FrozenSea, limits: Limits
) -> ShipOnNetwork:
    """Return the ship with the sea at the stations of a network, within limits."""
    return ship_in_frozen_sea(context, network, frozen, setting=context.setting, limits=limits)


def isochrones(
    context: PlanningContext,
    network: Network,
    frozen: FrozenSea,
    depart: float,
    until: float | None,
    *,
    wait: bool = True,
) -> np.ndarray:
    """Return the earliest arrival at every node [s since 1970], up to a time if one is given.

    Parameters
    ----------
    context : Request, data and ship of the plan.
    network : With start and goal.
    frozen : The sea at the stations of the network.
    depart : Departure [s since 1970-01-01T00:00Z].
    until : Latest arrival that is computed [s since 1970-01-01T00:00Z].
    wait : Whether the ship may wait where the voyage lets it.

    Returns
    -------
    ndarray (N,) : Arrivals [s since 1970-01-01T00:00Z]; inf where a node is not reached.
    """
    everywhere = earliest_arrival(
        ship_for_search(context, network, frozen, context.needs.limits),
        start=network.meta.start,
        goal=None,
        depart=depart,
        wait=wait and context.voyage.wait,
        arrive_by=until,
    )
    return everywhere.node_arrival
