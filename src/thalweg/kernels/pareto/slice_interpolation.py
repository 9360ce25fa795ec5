"""Least durations and costs between two slices of edge tables, with the errors of interpolation."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import OK
from thalweg.kernels.compilation.decorators import inlined, kernel_only
from thalweg.kernels.leg.edge_sailing import interval_of, sample_station
from thalweg.kernels.pareto.edge_tables import (
    FILLED,
    UNFILLED,
    EdgeTables,
    FrontArrays,
    fill_edge_table,
    sail_edge_priced,
)
from thalweg.kernels.pareto.label_arrays import ActiveNodes, LabelTarget, TimeBins

_SAFETY_FACTOR = 2.0  # of the difference met midway between two slices
_ROUNDING = 1e-6  # of tables in single precision
_LARGEST_USEFUL_ERROR = (
    0.25  # with larger errors the bound that is independent of the sea may be larger
)
_HALVINGS = 4  # to find when an edge closes
_CLOSING_ERROR = 0.01  # relative error of an edge after the last time at which it is open


class LowerLabels(NamedTuple):
    """The least reduced cost (less ``waiting_cost_rate`` times time) at every node in every bin of
    time.

    Attributes
    ----------
    first, last : int32[N]
        First and last bin of a node; none when last < first.
    place : int64[N]
        Where the bins of a node start.
    cost : float64[L]
    best : float64[N]
        Least up to the bin being processed.
    dead : float64[N]
        Sailing on is not useful from this value on.
    """

    first: np.ndarray
    last: np.ndarray
    place: np.ndarray
    cost: np.ndarray
    best: np.ndarray
    dead: np.ndarray


class InterpolationBounds(NamedTuple):
    """Bounds of the interpolation error between successive slices, by block and edge of the node.

    Attributes
    ----------
    start : int64[N]
        Where a node's first block starts.
    state : uint8[B]
        By block: `UNFILLED` or `FILLED`.
    off : float32[:, 3]
        How much shorter the time on the edge may be, how much cheaper without the price of time,
        and how much longer; each as a share.
    gains : uint8[:]
        Whether leaving later may be useful; 2 where the edge is closed at one of the two slices.
    along : float64[E]
        Largest current along an edge [m/s].
    fastest, least_rate : float64[S]
        Greatest speed through water [m/s], least fuel rate [kg/s].
    """

    start: np.ndarray
    state: np.ndarray
    off: np.ndarray
    gains: np.ndarray
    along: np.ndarray
    fastest: np.ndarray
    least_rate: np.ndarray


class ScalarisedLabelTarget(NamedTuple):
    """A search of the least cost plus a shadow price of time.

    Attributes
    ----------
    rate : Price of a second.
    known : Cost plus priced time of a real path; labels that are not below it are not extended.
    time_to_go : float64[N]
        Lower bound of the time to the goal [s].
    floor : float64[N]
        Lower bound of cost plus priced time to the goal.
    """

    goal: int
    rate: float
    known: float
    time_to_go: np.ndarray
    floor: np.ndarray


class LowerSearch(NamedTuple):
    """All that a lower bound is searched with.

    Attributes
    ----------
    work : float64[4, CHANNELS]
        Work space.
    """

    world: FrontArrays
    labels: LowerLabels
    target: LabelTarget | ScalarisedLabelTarget
    time_bins: TimeBins
    tables: EdgeTables
    error_bounds: InterpolationBounds
    active_nodes: ActiveNodes
    work: np.ndarray


@inlined
def _widened_errors(errors, estimate, time, cost, price):
    """Return errors widened by a time and a cost that differ from the estimates of both."""
    duration, spent = estimate
    own = spent - price * duration
    excess_cost = (cost - price * time) / own - 1.0 if own > 0.0 else 0.0
    slower = time / duration - 1.0
    return max(errors[0], -slower), max(errors[1], -excess_cost), max(errors[2], slower)


@inlined
def _midpoint_errors(search, edge, at, span, k, t):
    """Return the errors of the mean of two slices for departures midway between them."""
    tables, price = search.tables, search.world.prices.time_price
    values, errors = tables.values, (0.0, 0.0, 0.0)
    count = search.world.ship.settings.shape[0]
    for s in range(0, count, max(count - 1, 1)):
        d0, d1 = np.float64(values[at + s]), np.float64(values[at + span + s])
        c0, c1 = np.float64(values[at + count + s]), np.float64(values[at + span + count + s])
        if not (d0 + d1 < math.inf):
            continue
        then, cost, status = sail_edge_priced(search.world, edge, s, k, t, search.work)
        tables.sailed[0] += 1
        if status == OK:
            estimate = (0.5 * (d0 + d1), 0.5 * (c0 + c1))
            errors = _widened_errors(errors, estimate, then - t, cost, price)
    return errors


@inlined
def _errors_until_closed(search, node, edge, s, interval, estimate):
    """Return the errors of a slice for departures until an edge that is open then closes.

    ``interval`` is a time at which the edge is open and one at which it is closed, ``estimate`` the
    duration and cost at the slice.
    """
    world, errors = search.world, (0.0, 0.0, 0.0)
    sea, price = world.sea, world.prices.time_price
    open_at, closed_at = interval
    for _ in range(_HALVINGS):
        t = world.depart + 0.5 * (open_at + closed_at)
        k, status, then, cost = interval_of(sea.times, t), -1, t, 0.0
        if k >= 0:
            sample_station(sea, world.network.station[node], k, t, search.work[1])
            then, cost, status = sail_edge_priced(world, edge, s, k, t, search.work)
            search.tables.sailed[0] += 1
        if status == OK:
            open_at = t - world.depart
            errors = _widened_errors(errors, estimate, then - t, cost, price)
        else:
            closed_at = t - world.depart
    return errors


@kernel_only
def bound_interpolation_errors(search, node, i):
    """Find the errors of interpolation between a slice and the next."""
    world, tables, bounds = search.world, search.tables, search.error_bounds
    for j in (i, i + 1):
        if tables.state[tables.place[node] + j] == UNFILLED:
            fill_edge_table(world, tables, node, j, search.work)
    network, count = world.network, world.ship.settings.shape[0]
    rate = world.prices.waiting_cost_rate
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    span = (e1 - e0) * 2 * count
    at, here = tables.offset[node] + i * span, bounds.start[node] + i * (e1 - e0)
    k0 = tables.first[node] + i
    before, after = tables.times[k0], tables.times[k0 + 1]
    length = after - before
    t = world.depart + before + 0.5 * length
    k = interval_of(world.sea.times, t)
    if k >= 0:
        sample_station(world.sea, network.station[node], k, t, search.work[1])
    values = tables.values
    for edge in range(e0, e1):
        errors, gains = (0.0, 0.0, 0.0), 0
        if k >= 0:
            errors = _midpoint_errors(search, edge, at, span, k, t)
        for s in range(count):
            d0, d1 = values[at + s], values[at + span + s]
            if d0 < math.inf and d1 < math.inf:
                r0 = values[at + count + s] - rate * d0
                r1 = values[at + span + count + s] - rate * d1
                if (r1 < r0 - _ROUNDING * abs(r0) or d1 - d0 < -length) and gains == 0:
                    gains = 1
            elif d0 < math.inf or d1 < math.inf:
                gains = 2
                row, begin, end = (
                    (at, before, after) if d0 < math.inf else (at + span, after, before)
                )
                estimate = (np.float64(values[row + s]), np.float64(values[row + count + s]))
                more = _errors_until_closed(search, node, edge, s, (begin, end), estimate)
                errors = (max(errors[0], more[0]), max(errors[1], more[1]), max(errors[2], more[2]))
        least = _CLOSING_ERROR if gains == 2 else _ROUNDING
        for j in range(3):
            bounds.off[here, j] = _SAFETY_FACTOR * errors[j] + least
        bounds.gains[here] = gains
        here += 1
        at += 2 * count
    bounds.state[tables.place[node] + i] = FILLED


@inlined
def _least_in_any_sea(search, edge, s, rate, longest):
    """Return the least duration and reduced cost of an edge in any conditions."""
    world, bounds = search.world, search.error_bounds
    prices = world.prices
    duration = prices.fixed_time[edge]
    if duration == duration:
        fuel = prices.fixed_fuel[edge] * prices.weight[edge]
        return duration, prices.fee[edge] + fuel + duration * (prices.time_price - rate)
    speed = bounds.fastest[s] + bounds.along[edge]
    duration = world.network.length[edge] / speed if speed > 0.0 else math.inf
    net = bounds.least_rate[s] * prices.weight[edge] + prices.time_price - rate
    return duration, prices.fee[edge] + net * (duration if net > 0.0 else longest)


@inlined
def interpolation_errors(search, here):
    """Return the bounds of errors at a place, in double precision."""
    off = search.error_bounds.off
    return np.float64(off[here, 0]), np.float64(off[here, 1]), np.float64(off[here, 2])


@inlined
def interpolate_slices(d0, d1, c0, c1, f, g):
    """Return durations and costs at two shares of the time between two slices.

    An edge that is closed at one of the slices is as at the other.
    """
    if not d0 < math.inf:
        return d1, d1, c1, c1
    if not d1 < math.inf:
        return d0, d0, c0, c0
    return d0 + f * (d1 - d0), d0 + g * (d1 - d0), c0 + f * (c1 - c0), c0 + g * (c1 - c0)


@inlined
def least_between_slices(search, edge, s, rates, interval, pair, errors):
    """Return the earliest and latest arrival, and the least reduced cost, between two slices.

    ``rates`` are the price of a second that is deducted and the longest useful duration, ``pair``
    durations and costs at begin and end by the tables, ``errors`` the bounds of their errors.
    """
    rate, longest = rates
    begin, end = interval
    da, db, ca, cb = pair
    shorter, cheaper, longer = errors
    price = search.world.prices.time_price
    left = max(1.0 - shorter, 0.0)
    net, share = price - rate, max(1.0 - cheaper, 0.0)
    slow = net * (left if net > 0.0 else 1.0 + longer)
    least = min(share * (ca - price * da) + slow * da, share * (cb - price * db) + slow * db)
    least = max(least - _ROUNDING * max(ca, cb), 0.0)
    earliest = min(begin + da * left, end + db * left)
    if (
        shorter > _LARGEST_USEFUL_ERROR
        or cheaper > _LARGEST_USEFUL_ERROR
        or (longer > _LARGEST_USEFUL_ERROR and net < 0.0)
    ):
        duration, in_any_sea = _least_in_any_sea(search, edge, s, rate, longest)
        earliest, least = max(earliest, begin + duration), max(least, in_any_sea)
    return earliest, max(begin + da * (1.0 + longer), end + db * (1.0 + longer)), least
