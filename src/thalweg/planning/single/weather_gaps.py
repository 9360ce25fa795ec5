"""Water without data on the way: edges that cross it, and the error where it cannot be passed.

The search samples the sea at stations, the referee along every leg, so that a masked cell between
two stations is seen by the referee alone. Where that happens, the edges that cross unknown water
are left out, sampled as closely as the data, and the stretch is searched again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import METRES_PER_DEGREE, direct, distance, format_position, inverse
from thalweg.core.time import format_time
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.route import Route
from thalweg.route.referee.limit_checks import is_data_gap
from thalweg.route.route import Violation
from thalweg.sea import Sea
from thalweg.sea.fill_policies import nearest_fills
from thalweg.sea.standard_names import inseparable_variables

MAX_GAPS: Final = 12  #: gaps that are planned round before finer networks are tried
SAMPLES_PER_CELL: Final = 12.0  # samples of an edge per cell of the data
SHORTEST_STEP: Final = 100.0  # least distance of samples [m]
_NEAR: Final = 2_000.0  # detour by a gap up to which an edge counts as near it [m]
_POINTS_AT_ONCE: Final = 200_000


def data_gaps_on_route(route: Route) -> tuple[Violation, ...]:
    """Return where a route meets water without data, once for each variable and place.

    Parameters
    ----------
    route : Scored by the referee.
    """
    gaps = [v for v in route.violations if is_data_gap(v) and v.reason.endswith("(gap)")]
    return tuple(gaps[:MAX_GAPS])


def without_unknown_edges(
    context: PlanningContext, network: Network, gaps: Sequence[Violation]
) -> Network:
    """Return a network without the edges on which a variable is unknown at the time of a gap.

    Parameters
    ----------
    context : Request and data of the plan.
    network : The network that was searched.
    gaps : Where and when the referee found data missing.
    """
    keep = np.ones(network.n_edges, bool)
    sailed = np.isnan(network.edges.fixed_time)
    # both components of a vector are unknown together: one of them is enough
    wanted = {
        (inseparable_variables(_variable(gap))[0], gap.time, gap.lat, gap.lon): gap for gap in gaps
    }
    for (name, *_), gap in wanted.items():
        step = max(data_spacing(context.sea, name) / SAMPLES_PER_CELL, SHORTEST_STEP)

        def known(lat: np.ndarray, lon: np.ndarray, name: str = name, at: float = gap.time) -> Any:
            return ~np.isnan(context.sea.sample([name], at, lat, lon)[name])

        rows = np.flatnonzero(keep & sailed)
        keep[rows] = edges_where_all(network, rows, known, step)
        rows = np.flatnonzero(keep & sailed & near_edges(network, gap))
        # an edge may clip the corner of a cell
        keep[rows] = edges_where_all(network, rows, known, SHORTEST_STEP)
    return network if keep.all() else network.with_some_edges(keep)


def near_edges(network: Network, place: Violation) -> np.ndarray:
    """Return which edges may pass through a place: it is nearer than their length."""
    apart = distance(network.lat, network.lon, place.lat, place.lon)
    tails, target = network.tails(), network.graph.target
    return np.asarray(apart[tails] + apart[target] <= 1.001 * network.edges.length + _NEAR)


def check_times_known(route: Route, start: Endpoint, goal: Endpoint) -> None:
    """Raise `NoRouteError` if a route ends on the way, in water without data or in a current.

    Parameters
    ----------
    route : The best route found, which the referee refuses.
    start, goal : Its ends.
    """
    if math.isfinite(route.time_h):
        return
    gaps = [v for v in route.violations if is_data_gap(v)]
    if not gaps:
        raise _stopped_error(route, start, goal)
    first = gaps[0]
    names = sorted({_variable(v) for v in gaps if v.time == first.time})
    place = format_position(first.lat, first.lon)
    fills = nearest_fills(names) or ["currents=nearest:25"]
    raise NoRouteError(
        f"No route from {start.name} to {goal.name} was found in known water: "
        f"{', '.join(names)} {'is' if len(names) == 1 else 'are'} unknown at {place} at "
        f"{format_time(first.time)}.",
        "Cells of the data without values next to land, in ice or in a gap in time are not sailed.",
        "Add data that cover it, or fill the values that are unknown by name, from the nearest "
        f"known ones within 25 nm: --fill {' '.join(fills)}.",
        reasons={codes.REASONS[codes.NO_DATA]: len(gaps)},
        nearest=(first.lat, first.lon),
        variables=names,
    )


def _stopped_error(route: Route, start: Endpoint, goal: Endpoint) -> NoRouteError:
    """Return the error for a route on which the ship does not arrive in known water."""
    first = next(iter(route.violations), None)
    return NoRouteError(
        f"No route from {start.name} to {goal.name} was found on which the ship arrives"
        + (f": {first}." if first is not None else "."),
        "The fastest path of the search is refused by the exact calculation, and so are those of "
        "finer networks.",
        "Depart at another time, or choose a higher speed.",
        reasons={} if first is None else {first.reason: 1},
        **({} if first is None else {"nearest": (first.lat, first.lon)}),
    )


def _variable(gap: Violation) -> str:
    """Return the variable that a violation names: "no data: NAME (gap)"."""
    return gap.reason.partition(": ")[2].partition(" (")[0]


def edges_where_all(
    network: Network,
    rows: np.ndarray,
    suits: Callable[[np.ndarray, np.ndarray], np.ndarray],
    step: float,
) -> np.ndarray:
    """Return which edges suit all along.

    Parameters
    ----------
    rows : The edges to test.
    suits : Returns which positions (lat, lon [deg]) suit.
    step : Distance of the samples [m].

    Returns
    -------
    bool ndarray : One value for each of `rows`.
    """

    def values(lat: np.ndarray, lon: np.ndarray) -> np.ndarray:
        return np.where(suits(lat, lon), 1.0, 0.0)

    return np.asarray(least_along_edges(network, rows, values, step) > 0.5)


def least_along_edges(
    network: Network,
    rows: np.ndarray,
    values: Callable[[np.ndarray, np.ndarray], np.ndarray],
    step: float,
) -> np.ndarray:
    """Return the least value along edges, of those that are known; +inf where none is.

    Parameters
    ----------
    rows : The edges.
    values : Returns the values at positions (lat, lon [deg]).
    step : Distance of the samples [m].

    Returns
    -------
    float64 ndarray : One value for each of `rows`.
    """
    tails, target = network.tails(), network.graph.target
    low, high = np.minimum(tails, target)[rows], np.maximum(tails, target)[rows]
    _, one, both = np.unique(
        low.astype(np.int64) * network.n_nodes + high, return_index=True, return_inverse=True
    )
    rows = rows[one]  # there and back is the same water
    least = np.full(len(rows), np.inf)
    count = np.ceil(network.edges.length[rows] / step).astype(np.int64) + 1
    cuts = np.searchsorted(np.cumsum(count), np.arange(0, count.sum(), _POINTS_AT_ONCE))
    for first, last in zip(cuts, [*cuts[1:], len(rows)]):
        edge, number = rows[first:last], count[first:last]
        if not edge.size:
            continue
        part = np.repeat(np.arange(edge.size), number)
        start = np.cumsum(number) - number
        share = (np.arange(part.size) - start[part]) / (number[part] - 1)
        lat, lon = network.stations.lat, network.stations.lon
        a, b = tails[edge][part], target[edge][part]
        there = _between(lat[a], lon[a], lat[b], lon[b], share)
        least[first:last] = np.fmin(np.inf, np.fmin.reduceat(values(*there), start))
    return least[both]


def _between(
    lat1: np.ndarray, lon1: np.ndarray, lat2: np.ndarray, lon2: np.ndarray, share: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions at shares of geodesics between pairs of positions [deg]."""
    length, course, _ = inverse(lat1, lon1, lat2, lon2)
    return direct(lat1, lon1, course, share * length)


def data_spacing(sea: Sea, name: str) -> float:
    """Return the least spacing [m] of the data of a variable; 1.2 km where it has none."""
    rows = [row.spacing_deg for row in sea.coverage() if row.variable == name]
    spacings = [spacing for spacing in rows if spacing]
    return METRES_PER_DEGREE * min(spacings) if spacings else SAMPLES_PER_CELL * SHORTEST_STEP
