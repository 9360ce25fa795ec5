"""Paths of late departures on the network of a stretch, and their routes from the berth."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.limits import Limits
from thalweg.network import Network
from thalweg.planning.frozen_sea import LastFrozenSea
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.single.isochrones import ship_for_search
from thalweg.planning.single.lane_keeping import by_lanes_of_traffic
from thalweg.planning.single.route_candidates import refine_track, track_from_result
from thalweg.route import Route, Track
from thalweg.search import SearchResult, ShipOnNetwork
from thalweg.search.earliest_arrival import ArrivalQuery
from thalweg.search.latest_departure import departures_without_waits, latest_departure


@dataclass(frozen=True)
class LatePaths:
    """Paths of late departures on the network of a stretch.

    Attributes
    ----------
    ship : On the network, within the limits of the search.
    query : With the earliest departure.
    arrive : Earliest arrival on the network [s since 1970-01-01T00:00Z].
    refine : Refines the path of a search; returns its route as evaluated.
    sail : Returns the route of the path of a search as evaluated, without refinement.
    ship_until : Returns the ship with the sea until a time at least [s since 1970]; the search may
        have known a shorter period.
    """

    ship: ShipOnNetwork
    query: ArrivalQuery
    arrive: float
    refine: Callable[[SearchResult], Route]
    sail: Callable[[SearchResult], Route]
    ship_until: Callable[[float], ShipOnNetwork]

    def lasting(self, time: float) -> LatePaths:
        """Return the paths in a sea that is known until a time [s since 1970] at least."""
        return replace(self, ship=self.ship_until(time))

    def search(self, arrive_by: float, no_later: float = math.inf) -> SearchResult | None:
        """Return the path of the latest departure that arrives by a time, as `latest_departure`."""
        return latest_departure(self.ship, self.query, arrive_by, no_later)

    def search_without_waits(self, arrive_by: float) -> list[SearchResult]:
        """Return the paths without waits of departures that arrive by a time [s since 1970].

        The earliest arrival comes first, within half an hour the shortest time under way.
        """
        return departures_without_waits(self.ship, self.query, arrive_by)


def late_paths_of(
    context: PlanningContext,
    network: Network,
    limits: Limits,
    found: tuple[SearchResult, Route],
    seas: LastFrozenSea,
) -> LatePaths:
    """Return the paths of later departures than that of a route, and of the search it is from."""
    result, route = found
    start, end = seas.period
    ends = network.meta.start, network.meta.goal
    query = ArrivalQuery(*ends, route.depart, wait=context.voyage.wait)

    def refine(late: SearchResult) -> Route:
        track = track_from_result(network, late, context.setting)
        return by_lanes_of_traffic(context, network, refine_track(context, track, limits))

    def sail(late: SearchResult) -> Route:
        return context.evaluate(track_from_result(network, late, context.setting))

    def ship_until(time: float) -> ShipOnNetwork:
        sea = seas.freeze(context, network, start, max(end, min(time, context.data_end)))
        return ship_for_search(context, network, sea, limits)

    return LatePaths(ship_until(end), query, result.arrive, refine, sail, ship_until)


def waiting_at_berth(track: Track, depart: float) -> Track:
    """Return a track that waits at its first waypoint since a departure [s since 1970]."""
    wait = np.array(track.wait, float)
    wait[0] += track.depart - depart
    return track.replaced(depart=depart, wait=wait)


def after_wait_at_berth(
    context: PlanningContext, late: Route, route: Route, last_departure: float
) -> Route:
    """Return a late route, evaluated with the wait at the berth since another one departs.

    Parameters
    ----------
    late : Of a late departure.
    route : The other one.
    last_departure : The ship waits from then on, at the latest [s since 1970-01-01T00:00Z].
    """
    depart = min(max(route.depart, last_departure), late.track.depart)
    return context.evaluate(waiting_at_berth(late.track, depart))
