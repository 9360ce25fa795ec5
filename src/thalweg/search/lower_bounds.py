"""Lower bounds of the time and cost of all routes, with the assumptions of each bound."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import distance
from thalweg.core.limits import Limits
from thalweg.core.objective import SingleSettingObjective
from thalweg.search.earliest_arrival import ArrivalQuery, solve_earliest_arrival
from thalweg.search.search_problem import (
    ROUNDING_FACTOR,
    SearchProblem,
    ShipOnNetwork,
    canal_speed,
    make_search_problem,
)

if TYPE_CHECKING:
    from thalweg.network.network import Network

_LIMIT_RELAXATION = 0.02  # limits are loosened by this share for the bound on the network
_FREE_SPACE_TIME_NOTE = (
    "free space: geodesic distance over the largest speed over ground in the data (rigorous)"
)
_FREE_SPACE_DISTANCE_NOTE = "free space: geodesic distance (rigorous)"
_NETWORK_BOUND_NOTE = (
    "network: search with lengths times {kappa:.4f} for the directions between edges, limits "
    "loosened by 2 %, waiting everywhere (exact for routes among the network's nodes in locally "
    "uniform water, indicative otherwise)"
)


@dataclass(frozen=True)
class LowerBound:
    """A lower bound of a voyage.

    Attributes
    ----------
    value : float
        Time from departure to arrival [s], or distance [m].
    kind : str
        How it was found and what it rests on.
    kappa : float
        Factor on the lengths of the network; 1 for the bound in free space.
    path : int64[P]
        Nodes of the path that attains the bound on the network: a hint at a good route, since it
        is timed as a ship in open water would be. Empty where there is none.
    """

    value: float
    kind: str
    kappa: float = 1.0
    path: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64))


def direction_factor(gap: float, current_ratio: float = 0.0) -> float:
    """Return the least ratio of a path in open water to the shortest path on the network.

    Parameters
    ----------
    gap : float
        Largest angle between neighbouring directions of the network [rad], 0 <= gap < pi.
    current_ratio : float
        Largest strength of current over speed through water, 0 <= ratio < 1.

    Returns
    -------
    float
        kappa in (0, 1]: least time in open water over least time by edges; 0 where none holds
        (current as strong as the ship).

    Notes
    -----
    With speed V through water and current rho V at the angle phi from the course, the speed over
    ground is ``g(phi) = V (rho cos phi + sqrt(1 - rho^2 sin^2 phi))``: the ground velocities form a
    circle of radius V round the tip of the current vector. A course delta beyond the first of two
    directions phi and phi + gap is mixed from them in the parts ``a = sin(gap - delta) / sin gap``
    and ``b = sin delta / sin gap``, and

        kappa = min over phi, delta of (1 / g(phi + delta)) / (a / g(phi) + b / g(phi + gap)).

    For rho = 0 this is cos(gap / 2). The minimum is found on a grid that is refined three times;
    it falls with gap and with rho, so the largest of each covers the smaller ones.
    """
    if gap <= 0.0:
        return 1.0
    if gap >= math.pi or not current_ratio < 1.0:
        return 0.0
    if current_ratio <= 0.0:
        return math.cos(0.5 * gap)
    phi, delta = np.linspace(-math.pi, math.pi, 181), np.linspace(0.0, gap, 33)
    least = 1.0
    for _ in range(4):
        kappa = _mixed(phi[:, None], delta[None, :], gap, current_ratio)
        i, j = np.unravel_index(np.argmin(kappa), kappa.shape)
        least = min(least, float(kappa[i, j]))
        width, depth = phi[1] - phi[0], delta[1] - delta[0]
        phi = np.linspace(phi[i] - width, phi[i] + width, 33)
        delta = np.clip(np.linspace(delta[j] - depth, delta[j] + depth, 33), 0.0, gap)
    return least


def _mixed(
    phi: NDArray[np.float64], delta: NDArray[np.float64], gap: float, rho: float
) -> NDArray[np.float64]:
    def over_ground(angle: NDArray[np.float64]) -> NDArray[np.float64]:
        speed = rho * np.cos(angle) + np.sqrt(1.0 - (rho * np.sin(angle)) ** 2)
        return np.asarray(speed)

    first = np.sin(gap - delta) / over_ground(phi)
    second = np.sin(delta) / over_ground(phi + gap)
    ratio = math.sin(gap) / over_ground(phi + delta) / (first + second)
    return np.asarray(ratio)


@dataclass(frozen=True)
class Penalties:
    """Penalty zones of a chart, and their effect on a known route.

    Attributes
    ----------
    added : Added to the time [s] or distance [m] of the known route.
    factors : Factors of the zones.
    graded : Whether there are shoals, in which the factor follows the depth, or traffic lanes, in
        which it follows the course: then those of all edges count as they are.
    """

    added: float
    factors: tuple[float, ...] = ()
    graded: bool = False


def _least_factors(factor: NDArray[np.float32], penalties: Penalties | None) -> NDArray[np.float32]:
    """Return the factors of edges that are wholly inside a penalty zone, and 1 for all others."""
    if penalties is not None and penalties.graded:
        return factor
    least = np.ones_like(factor)
    for value in sorted(penalties.factors if penalties is not None else ()):
        least[np.abs(factor - value) <= 1e-4 * value] = value
    return least


def lower_bound(
    ship_on_network: ShipOnNetwork,
    *,
    start: int,
    goal: int,
    depart: float,
    objective: SingleSettingObjective = "time",
    known: float | None = None,
    penalties: Penalties | None = None,
    any_departure: bool = False,
) -> LowerBound:
    """Bound the time (or distance) of every route between two nodes from below.

    Parameters
    ----------
    ship_on_network, start, goal, depart, objective
        As in `thalweg.search.earliest_arrival`.
    known : float, optional
        Time or distance of a route that exists, in open water rather than on the network. A
        network bound above it is disproved by it (edges that pass a bank at a distance) and is
        not used.
    penalties : Penalties, optional
        The penalty zones, with what they add to the known route. The network bound is then that of
        the sum with the penalties of every route, less what they add to this one.
    any_departure : bool
        Bound every departure inside the fields, not ``depart`` alone: free space only.

    Returns
    -------
    LowerBound
        The larger of `free_space_bound` and `network_bound`, as far as both hold.
    """
    network, given = ship_on_network.network, make_search_problem(ship_on_network)
    free = free_space_bound(network, given, start=start, goal=goal, objective=objective)
    if any_departure:
        return free
    query = ArrivalQuery(start, goal, depart, objective)
    net = network_bound(network, given, query, penalties=penalties)
    if penalties is not None:
        net = replace(net, value=net.value - penalties.added)
    disproved = known is not None and net.value > known
    return net if net.value > free.value and not disproved else replace(free, path=net.path)


def free_space_bound(
    network: Network,
    given: SearchProblem,
    *,
    start: int,
    goal: int,
    objective: SingleSettingObjective = "time",
) -> LowerBound:
    """Bound by the geodesic at the largest speed over ground that the data allow anywhere.

    Rigorous for the given fields: no route is shorter than the geodesic and none is sailed faster
    than the top speed through water plus the strongest current, or than canals are passed.
    """
    lat, lon = network.stations.lat, network.stations.lon
    geodesic = ROUNDING_FACTOR * float(distance(lat[start], lon[start], lat[goal], lon[goal]))
    if objective == "distance":
        return LowerBound(geodesic, _FREE_SPACE_DISTANCE_NOTE)
    return LowerBound(geodesic / max(given.fastest, canal_speed(network)), _FREE_SPACE_TIME_NOTE)


def network_bound(
    network: Network,
    given: SearchProblem,
    query: ArrivalQuery,
    *,
    penalties: Penalties | None = None,
) -> LowerBound:
    """Bound by the same search with every length shortened by `direction_factor`.

    In water that is uniform over a cell of the network, open to the sides, and for a ship whose
    speed does not depend on its heading, a free route is at most ``1 / kappa`` times faster than
    the one mixed from the directions of the edges. Variation of the water inside a cell, coasts
    and depth limits that fall between nodes, and speeds that depend on the heading are outside
    that argument: there the bound is indicative, not certain. The ratio of current to speed is
    taken with the largest current in the data and the ship's top speed.

    Parameters
    ----------
    query : Ends, departure and objective.
    penalties : Zones that the bound counts; edges that are partly inside one count as outside.

    Returns
    -------
    LowerBound
        Of the cost with penalty factors. Value 0 when the network shows no path or no factor holds.
    """
    gap = float(network.meta.gap_rad)
    rho = 0.0 if query.objective == "distance" else given.top_current / given.top_speed
    kappa = direction_factor(gap, rho)
    kind = _NETWORK_BOUND_NOTE.format(kappa=kappa)
    if kappa <= 0.0:
        return LowerBound(0.0, kind, 0.0)
    arrays = given.network
    shorter = arrays._replace(
        length=np.where(np.isnan(arrays.fixed_time), kappa, 1.0) * arrays.length,
        factor=_least_factors(arrays.factor, penalties),
        can_wait=np.ones_like(arrays.can_wait),
    )
    ship = given.ship._replace(limits=Limits(*given.ship.limits).relaxed(_LIMIT_RELAXATION).array)
    relaxed = given._replace(network=shorter, ship=ship)
    result = solve_earliest_arrival(network, relaxed, query, shortened=kappa)
    return LowerBound(result.cost if result.found else 0.0, kind, kappa, result.path)
