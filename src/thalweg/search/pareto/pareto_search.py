"""The front of time against cost on a network, with a choice of setting on every edge."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.types import FloatArray
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.kernels.pareto.edge_tables import EdgeTables
from thalweg.kernels.pareto.label_arrays import PRUNED, RELAXED, VISITED, WAITED, LabelSearch
from thalweg.kernels.pareto.time_expanded_labels import process_bins
from thalweg.search.pareto.discretisation import (
    PROGRESS_CHUNKS,
    TABLE_TOLERANCE,
    Discretisation,
    choose_discretisation,
    new_active_nodes,
    new_bin_labels,
    new_edge_tables,
    new_target,
)
from thalweg.search.pareto.front_problem import (
    FrontProblem,
    FrontQuery,
    FrontRequest,
    MultiSettingShipOnNetwork,
    earliest_arrivals,
    make_front_problem,
    new_edge_workspace,
    ship_at_setting,
)
from thalweg.search.pareto.front_result import FrontPoint, FrontWork, NetworkFront
from thalweg.search.pareto.goal_bounds import BoundsToGoal, bounds_to_goal
from thalweg.search.pareto.lower_front import LowerFront, lower_front
from thalweg.search.pareto.seed_paths import (
    PlannedPath,
    earliest_arrival_path,
    non_dominated_points,
    path_of_search_result,
    paths_of_goal_labels,
    sail_planned_path,
    seed_paths,
    tighten_target,
)
from thalweg.search.restricted_waiting import (
    earliest_arrival_with_restricted_waiting,
    waiting_is_restricted,
)
from thalweg.search.search_problem import check_two_nodes, distance_bounds
from thalweg.search.search_result import counts_by_reason

if TYPE_CHECKING:
    from thalweg.network.network import Network


MEMORY_LIMIT = 3e9  # [bytes]


def pareto_front(
    ship_on_network: MultiSettingShipOnNetwork,
    query: FrontQuery,
    *,
    bin_s: float | None = None,
    memory_limit: float = MEMORY_LIMIT,
    table_tolerance: float = TABLE_TOLERANCE,
    lower: bool = True,
    progress: Callable[[float], None] | None = None,
) -> NetworkFront:
    """Find the Pareto front of time and cost of the paths between two nodes.

    The cost of a path is the sum over its edges of fuel times its price and of canal dues, plus
    the price of the whole time, plus that of the fuel burnt while waiting
    (`thalweg.core.objective.LegPrices`).

    Parameters
    ----------
    ship_on_network : MultiSettingShipOnNetwork
        The network, the sea frozen at its stations, and the ship with its settings.
    query : FrontQuery
        Start, goal, departure, latest arrival, settings to choose from, and prices.
    bin_s : float, optional
        Width of the bins of time [s] (default: a round number that divides the time into at most
        2000 bins, fewer, but not below 250, where the memory or the work does not allow that).
    memory_limit : float
        Memory that may be taken [bytes].
    table_tolerance : float
        What durations and costs of edges between slices of time may be off, as a share.
    lower : bool
        Whether to search the lower front as well.
    progress : callable, optional
        Called with the share of the bins done.

    Returns
    -------
    NetworkFront

    Raises
    ------
    InputError
        If the latest arrival is before the earliest possible (``details["earliest"]``), if the
        memory does not suffice (``details["memory"]``), or if a value of the request is invalid.
    NoRouteError
        If there is no path at all, with the reasons.

    Notes
    -----
    Time-expanded dynamic programming: every node holds one label, the cheapest, in each bin of
    time; bins are processed in order, and every label is extended along all edges at all
    settings. Exactness:

    * A label has its own time, not that of its bin, and every point of the front is sailed
      again, leg by leg, with the kernel of `earliest_arrival`: its time and cost are those of a
      real path. The fastest point is that of `earliest_arrival` at the highest setting, with the
      same accuracy. With limits in waves a lower setting may be allowed where the highest is not;
      the fastest point is then the fastest path found.
    * One label per bin can be the wrong one: a label of the same bin with a higher cost may be
      earlier by less than the bin and lead to a better path. So the front is on or above the true
      one, and approaches it as the bins narrow.
    * While searching, durations and costs of edges are interpolated linearly between departures at
      slices of time (``work.slices``), within ``table_tolerance`` at 95 % of a sample (see
      ``work.table_error``) unless the tables would be too large. This may affect a choice, but no
      result: all points are sailed again. Where an edge opens or closes between two slices it is
      sailed exactly.
    * Where the ship may wait, a label is dropped if an earlier one costs no more with the waiting
      in between paid: exact, since the earlier ship can wait. A waiting ship leaves at slices, and
      where an edge is closed at all settings at one of the slices around, at the start of any bin.
      At other nodes (and at all nodes with ``wait=False``) labels are compared inside a bin only.
    * The lower front is the larger of two bounds. One lets every arrival count for the start of
      its bin and leaves at any moment of the bin, whatever is earliest and cheapest; it closes as
      the bins narrow. The other is the least cost plus a price of time, for up to 6 prices; it
      has no error from the bins but bounds the lower hull of the front only. Both take an edge at
      the most favourable moment of the bin, less twice the difference to the leg itself midway
      between the two slices around, at the lowest and the highest setting. Both let a ship wait
      without end where it may wait at all; waiting then costs no more than sailing at its cheapest.
      They are certain as far as durations and costs between slices stay within twice that
      difference, and no edge that is closed at both slices opens for a moment between them. An edge
      open at one slice only is considered up to when it closes, less 1 %.
    * Labels are dropped as well when even the largest currents along the edges, the best weather
      and the best prices of every edge do not lead them below the known arrivals at the goal. This
      does not affect the result.
    """
    network, request = ship_on_network.network, _request(ship_on_network, query)
    _check_bin_width(bin_s)
    front_problem = make_front_problem(ship_on_network, request)
    bounds = bounds_to_goal(front_problem, request.goal)
    earliest = earliest_arrivals(front_problem, request, everywhere=True)
    first = _find_seed_paths(network, front_problem, request, bounds)
    plan = choose_discretisation(
        front_problem,
        request,
        bounds,
        earliest.time,
        bin_s=bin_s,
        memory_limit=memory_limit,
        table_tolerance=table_tolerance,
    )
    return _search(front_problem, request, bounds, plan, first, lower=lower, progress=progress)


def path_costs(
    ship_on_network: MultiSettingShipOnNetwork, query: FrontQuery, points: Sequence[FrontPoint]
) -> FloatArray:
    """Return what paths cost at the prices of a query, sailed again edge by edge.

    Parameters
    ----------
    ship_on_network : With the table of what the prices count.
    query : Start, goal, departure and prices; the settings of the paths are among its own.
    points : Paths of the same network and departure, found with any prices.

    Returns
    -------
    float64 array (paths,)
        NaN for a path that is closed.
    """
    request = _request(ship_on_network, query)
    front_problem = make_front_problem(ship_on_network, request)
    found = []
    for point in points:
        path = path_of_search_result(front_problem, point)
        choices = np.searchsorted(request.settings, point.setting).astype(np.int64)
        sailed = sail_planned_path(front_problem, request, path._replace(choices=choices))
        found.append(math.nan if sailed is None else sailed.cost)
    return np.array(found)


def _search(
    front_problem: FrontProblem,
    request: FrontRequest,
    bounds: BoundsToGoal,
    plan: Discretisation,
    first: _SeedPaths,
    *,
    lower: bool,
    progress: Callable[[float], None] | None,
) -> NetworkFront:
    parts = 2 if lower else 1

    def report(share: float, part: int) -> None:
        if progress is not None:
            progress((part + share) / parts)

    blocks = new_edge_tables(front_problem, plan)
    found, dropped, counts = _set_labels(
        front_problem, request, bounds, plan, first.points, blocks, report
    )
    points = non_dominated_points([*first.points, *found])
    if not points and first.refusal is not None:
        raise first.refusal
    below = LowerFront(np.empty(0), np.empty(0), 0, 0, 0)
    if lower:
        below = lower_front(
            front_problem, request, bounds, plan, blocks, points, lambda share: report(share, 1)
        )
    work = FrontWork(
        labels=int(counts[VISITED]) + below.labels,
        relaxed=int(counts[RELAXED] + counts[WAITED]) + below.relaxed,
        sailed=int(blocks.sailed[0]),
        pruned=int(counts[PRUNED]) + below.pruned,
        slices=len(plan.slices),
        table_error=plan.table_error,
        dropped=dropped,
        memory=plan.memory,
    )
    refused = counts_by_reason(blocks.refused)
    return NetworkFront(points, below.time, below.cost, plan.time_bins.width, work, refused)


def _set_labels(
    front_problem: FrontProblem,
    request: FrontRequest,
    bounds: BoundsToGoal,
    plan: Discretisation,
    known: list[FrontPoint],
    blocks: EdgeTables,
    report: Callable[[float, int], None],
) -> tuple[list[FrontPoint], int, NDArray[np.int64]]:
    """Label all nodes bin by bin; return the goal's paths, how many are closed, and counts."""
    target, labels = new_target(request.goal, bounds, plan.time_bins), new_bin_labels(plan.windows)
    for point in known:
        tighten_target(target, plan.time_bins, point)
    begin = int(labels.place[request.start])
    labels.cost[begin], labels.when[begin], labels.source[begin] = 0.0, (0.0, np.nan), -1
    active_nodes = new_active_nodes(plan.windows)
    search = LabelSearch(
        front_problem.arrays,
        labels,
        target,
        plan.time_bins,
        blocks,
        active_nodes,
        new_edge_workspace(),
        np.empty(2 * len(request.settings), np.float32),
    )
    edges = np.unique(np.linspace(0, plan.time_bins.count, PROGRESS_CHUNKS + 1).astype(int))
    for a, b in pairwise(edges.tolist()):
        process_bins(search, a, b)
        report(b / plan.time_bins.count, 0)
    found, dropped = paths_of_goal_labels(front_problem, request, labels)
    return found, dropped, active_nodes.counts


class _SeedPaths(NamedTuple):
    """Seed paths, and the error to raise if the search finds no path."""

    points: list[FrontPoint]
    refusal: InputError | NoRouteError | None


def _find_seed_paths(
    network: Network, front_problem: FrontProblem, request: FrontRequest, bounds: BoundsToGoal
) -> _SeedPaths:
    """Return the seed paths; raise if even the fastest is too late.

    What is forbidden in waves may be allowed at a lower setting: then the search decides.
    """
    table, arrive, fastest = front_problem.arrays.ship.table, math.inf, None
    has_wave_limits = len(table.safety) > 0 or len(table.motions) > 0
    for choice in range(len(request.settings))[::-1]:
        arrive, fastest = _fastest_path(network, front_problem, request, choice)
        if fastest is not None or not has_wave_limits:
            break
    refusal: InputError | NoRouteError | None = None
    if fastest is None:
        refusal = _no_route(network, front_problem, request)
    elif arrive > request.latest:
        refusal = InputError(
            f"No path arrives by {request.latest:.0f} s.",
            f"The earliest arrival is {arrive:.0f} s, {(arrive - request.latest) / 3600:.2f} h "
            "later.",
            "Allow a later arrival, depart earlier, or allow a higher setting.",
            earliest=arrive,
        )
    if refusal is not None and not has_wave_limits:
        raise refusal
    return _SeedPaths(
        [] if fastest is None else seed_paths(front_problem, request, fastest, bounds), refusal
    )


def _fastest_path(
    network: Network, front_problem: FrontProblem, request: FrontRequest, choice: int
) -> tuple[float, PlannedPath | None]:
    """Return the earliest arrival at one of the chosen settings [s], and its path."""
    if request.wait and waiting_is_restricted(network):
        ship = ship_at_setting(front_problem.whole.ship, int(request.settings[choice]))
        found = earliest_arrival_with_restricted_waiting(
            network, front_problem.whole._replace(ship=ship), start=request.start,
        goal=request.goal,
            depart=request.depart,
        )  # fmt: skip
        return found.arrive, path_of_search_result(front_problem, found) if found.found else None
    arrivals = earliest_arrivals(front_problem, request, everywhere=False, choice=choice)
    arrive = float(arrivals.time[request.goal])
    return arrive, earliest_arrival_path(front_problem, request, arrivals) if math.isfinite(
        arrive
    ) else None


def _no_route(network: Network, front_problem: FrontProblem, request: FrontRequest) -> NoRouteError:
    arrivals = earliest_arrivals(front_problem, request, everywhere=False)
    reasons = counts_by_reason(arrivals.refused)
    reached = front_problem.arrays.network.station[np.isfinite(arrivals.time)]
    lat, lon = network.lat, network.lon
    to = float(lat[request.goal]), float(lon[request.goal])
    off = distance_bounds(lat[reached], lon[reached], *to)
    nearest = int(reached[np.argmin(off)])
    return NoRouteError(
        f"There is no path from node {request.start} to node {request.goal}.",
        "Edges were refused: " + ", ".join(f"{n} {why}" for why, n in reasons.items()) + "."
        if reasons else "The network does not link the two.",
        "Relax the limits or take another departure.",
        reasons=reasons,
        nearest=(float(lat[nearest]), float(lon[nearest])),
    )  # fmt: skip


def _check_bin_width(bin_s: float | None) -> None:
    if bin_s is not None and not (math.isfinite(bin_s) and bin_s > 0.0):
        raise InputError(
            f"The bins of {bin_s} s hold no time.", "A bin has a positive width.", "Widen them."
        )


def _request(ship_on_network: MultiSettingShipOnNetwork, query: FrontQuery) -> FrontRequest:
    """Check a query against the network and the ship's settings."""
    network, table, settings = ship_on_network.network, ship_on_network.table, query.settings
    start, goal, depart, latest = query.start, query.goal, query.depart, query.latest
    raw = table if isinstance(table, TableArrays) else table.kernel_arrays()
    count = int(raw.n_settings)
    chosen = np.arange(count) if settings is None else np.unique(np.asarray(settings, np.int64))
    if len(chosen) == 0 or chosen[0] < 0 or chosen[-1] >= count:
        raise InputError(
            f"The settings {chosen.tolist()} are not all the ship's.",
            f"It has settings 0 to {count - 1}.",
            "Give settings of the ship.",
        )
    check_two_nodes(network.n_nodes, start, goal)
    if not (math.isfinite(depart) and math.isfinite(latest) and latest > depart):
        raise InputError(
            f"The latest arrival {latest} is not after the departure {depart}.",
            "Both are times [s since epoch].",
            "Give a later arrival.",
        )
    inside = np.broadcast_to(
        np.asarray(0.0 if query.eca_fraction is None else query.eca_fraction, float),
        (network.n_edges,),
    )
    if not ((inside >= 0.0) & (inside <= 1.0)).all():
        raise InputError(
            "A fraction of an edge inside emission control areas is not between 0 and 1.",
            "Each edge has one, as thalweg.network.eca_fractions returns them.",
            "Correct the fractions.",
        )
    further = _of_edges(network, query.edge_cost, 0.0, "further cost")
    penalty = _of_edges(network, query.penalty_factor, 1.0, "penalty factor")
    return FrontRequest(
        int(start), int(goal), float(depart), float(latest), chosen, query.prices,
        query.prices.of_legs(inside, np.asarray(network.edges.price_factor, float)) * penalty,
        bool(query.wait), further,
    )  # fmt: skip


def _of_edges(network: Network, given: ArrayLike | None, least: float, what: str) -> FloatArray:
    """Return a number for each edge, or one for all; the least one where none is given."""
    values = np.asarray(least if given is None else given, float)
    if values.shape not in ((), (network.n_edges,)) or not (values >= least).all():
        raise InputError(
            f"A {what} of an edge is not a number of {least:g} or more.",
            f"Each of the {network.n_edges} edges has one.",
            "Correct the numbers.",
        )
    return values
