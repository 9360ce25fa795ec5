"""The latest departure that still arrives by a time: what is left is a ship without time to spare.

Of all paths that arrive at the same time a search for the earliest arrival returns any one: a ship
that is early at every node waits often and zigzags. One that leaves as late as possible cannot.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.core.geodesy import distance
from thalweg.search.earliest_arrival import ArrivalQuery, earliest_arrival
from thalweg.search.search_problem import ShipOnNetwork
from thalweg.search.search_result import SearchResult

_MOST_SEARCHES: Final = 10
_ACCURACY: Final = 60.0  # of the departure [s]
_DEPARTURE_STEP: Final = 3600.0  # between departures of paths without waits [s]
_MOST_DEPARTURES: Final = 60
_SAME_ARRIVAL: Final = 1800.0  # [s]
_ROUNDING: Final = 0.1  # of sums of times along a path [s]


def latest_departure(
    ship_on_network: ShipOnNetwork,
    query: ArrivalQuery,
    arrive_by: float,
    no_later: float = math.inf,
) -> SearchResult | None:
    """Find the path of least time of the latest departure that arrives by a time.

    Parameters
    ----------
    ship_on_network : ShipOnNetwork
        The network, the sea frozen at its stations, and the ship at one setting.
    query : ArrivalQuery
        By time, with a goal; ``depart`` is the earliest departure.
    arrive_by, no_later : float
        Latest arrival and departure [s since 1970-01-01T00:00Z].

    Returns
    -------
    SearchResult or None
        None where no departure is found that is later than the earliest and arrives by the time.

    Notes
    -----
    The first departure tried would arrive in time along the geodesic at the top speed. Each next
    one is earlier by as much as the last was late, and twice the step before at least. Where the
    ship still waits under way, the departure is then found by halving, to a minute.
    """
    network, goal = ship_on_network.network, query.goal_node
    ends = [query.start, goal]
    lat, lon = network.lat[ends], network.lon[ends]
    quickest = float(distance(lat[0], lon[0], lat[1], lon[1])) / ship_on_network.top_speed
    if not math.isfinite(quickest):
        quickest = 0.5 * (arrive_by - query.depart)
    departure, step = min(arrive_by - quickest - _ROUNDING, no_later), _ACCURACY
    in_time, too_late = query.depart, departure + _ACCURACY
    found: SearchResult | None = None
    for _ in range(_MOST_SEARCHES):
        if departure <= in_time + _ACCURACY:
            break
        result = _search(ship_on_network, replace(query, depart=departure))
        late = result.arrive - arrive_by
        if late <= 0.0:
            in_time, found = departure, result
        else:
            too_late = departure
        if found is not None and (found.waiting < _ACCURACY or too_late - in_time < _ACCURACY):
            break
        step = 2.0 * step
        back = max(late, step)
        halved = found is not None or not too_late - back > in_time
        departure = 0.5 * (in_time + too_late) if halved else too_late - back
    return found


def departures_without_waits(
    ship_on_network: ShipOnNetwork,
    query: ArrivalQuery,
    arrive_by: float,
    most: int = _MOST_DEPARTURES,
) -> list[SearchResult]:
    """Find the paths of least time without waits, of departures an hour apart or more.

    Parameters
    ----------
    ship_on_network, query : As of `latest_departure`.
    arrive_by : float
        Latest arrival [s since 1970-01-01T00:00Z].
    most : int
        Most departures that are searched.

    Returns
    -------
    list of SearchResult
        Those that arrive by the time: the earliest arrival first, of arrivals within
        half an hour the shortest time under way.
    """
    step = max(_DEPARTURE_STEP, (arrive_by - query.depart) / most)
    found = []
    for depart in np.arange(query.depart, arrive_by, step).tolist():
        one = replace(query, depart=depart, wait=False, arrive_by=arrive_by)
        result = _search(ship_on_network, one)
        if result.found and result.arrive <= arrive_by:
            found.append(result)
    earliest = min((result.arrive for result in found), default=0.0)

    def key(result: SearchResult) -> tuple[int, float]:
        return round((result.arrive - earliest) / _SAME_ARRIVAL), result.duration

    return sorted(found, key=key)


def _search(ship_on_network: ShipOnNetwork, query: ArrivalQuery) -> SearchResult:
    return earliest_arrival(
        ship_on_network,
        start=query.start,
        goal=query.goal,
        depart=query.depart,
        objective=query.objective,
        wait=query.wait,
        arrive_by=query.arrive_by,
    )
