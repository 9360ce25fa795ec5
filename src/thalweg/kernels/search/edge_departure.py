"""Time of departure on an edge: ships that may wait, and edges that open."""

import math
from typing import NamedTuple

from thalweg.kernels.codes import NO_DATA, OK, OUTSIDE_PERIOD
from thalweg.kernels.compilation.decorators import allocation_free, inlined_by_numba, kernel_only
from thalweg.kernels.leg.edge_sailing import (
    MarchCutoff,
    interval_near,
    interval_of,
    march_edge,
    pass_canal,
    sail_edge,
    sample_station,
)
from thalweg.kernels.search.sample_openings import opening_of_sample

OPENING_TOLERANCE = 0.1  # accuracy of opening times [s]
_SLOW = 3.0  # times the least time of an edge: slower ships may gain by a short wait
_MOST_MARCHES = 2000  # of one edge in one call
#: Between departures of a ship that may be overtaken [s]: in the first steps it is, at most, and so
#: many; in the second where passing a sample gets later again.
_SHORT_STEP, _LONG_STEP, _MOST_STEPS = 20.0, 50.0, 400
_PROBES = 7  # before the first of these, each at half the distance of the one before
_GOLDEN = 0.6180339887498949
_CLOSE = 0.2  # accuracy of the best departure between openings [s]


class EdgeDeparture(NamedTuple):
    """One departure along an edge.

    Attributes
    ----------
    departure, arrival : [s]; the arrival is inf if the edge cannot be sailed to any use.
    status : `OK`, or why the edge is blocked.
    """

    departure: float
    arrival: float
    status: int


class WaitingTerms(NamedTuple):
    """What a wait for an edge is worth.

    Attributes
    ----------
    may_wait : Whether the ship may wait at the tail at all.
    until : How long it may wait there [s].
    factor : Weight of the time under way; waiting weighs 1.
    least_time : Lower bound of the time under way on the edge [s].
    enough : A departure is useful only if waiting plus ``factor`` times sailing is below this [s].
    """

    may_wait: bool
    until: float
    factor: float
    least_time: float
    enough: float


@kernel_only
def _march_at(world, edge, tail_node, k, t, work):
    """Sail an edge at any departure of interval k: return (arrival, status, blocking sample)."""
    network, sea = world.network, world.sea
    fixed = network.fixed_time[edge]
    if fixed == fixed:
        arrival, status = pass_canal(network, edge, t, sea.times[-1])
        return arrival, status, network.via_ptr[edge + 1] + 1
    sample_station(sea, tail_node, k, t, work[1])
    cutoff = MarchCutoff(math.inf, 0.0)
    arrival, _, status, sample = march_edge(
        world, world.ship, None, edge, k, t, cutoff, (work[1], work[2], work[3])
    )
    return arrival, status, sample


@kernel_only
def _opening_on_edge(world, where, passed, blocked, useless, work):
    """Return from when on a blocking sample is open; ``where`` is (edge, tail, interval).

    ``passed`` is when the ship is at the sample, ``blocked`` is (status, sample).
    """
    network, sea = world.network, world.sea
    edge, tail_node, k = where
    status, sample = blocked
    if sample > network.via_ptr[edge + 1]:  # afloat at the head, but at another tide
        opens = network.opens[network.target[edge]]
        return opens if passed < opens else math.inf
    place = (edge, tail_node, sample)
    k = interval_near(sea.times, k, passed)
    if k < 0:
        return math.inf
    return opening_of_sample(network, sea, world.ship, place, k, passed, (status, useless), work)


@kernel_only
def _first_past(world, where, since, closed, step, work):
    """Return (departure, time, status, sample) of the first departure that a sample does not block.

    ``closed`` is (sample, when it is passed by a departure at ``since``, when it opens). A
    departure that still reaches it before it opens is returned as well, as progress. ``step`` is
    a guess of how much later the ship leaves.
    """
    edge, tail_node, k = where
    times = world.sea.times
    sample, passed, opens = closed
    low, high, found = since, math.inf, (since, passed, OK, sample)
    for _ in range(_MOST_MARCHES):
        departure = low + step
        near = interval_near(times, k, departure)
        then, status, at = _march_at(world, edge, tail_node, near, departure, work)
        blocks = at == sample and status not in (OK, OUTSIDE_PERIOD)
        if blocks and then <= opens + OPENING_TOLERANCE:
            if high == math.inf:
                return departure, then, status, at
            low = departure
        else:  # past the opening: what is open between must not be passed over
            high, found = departure, (departure, then, status, at)
            before = departure - 0.9 * OPENING_TOLERANCE
            if before > low:
                near = interval_near(times, k, before)
                then, status, at = _march_at(world, edge, tail_node, near, before, work)
                blocks = at == sample and status not in (OK, OUTSIDE_PERIOD)
                if blocks and then <= opens + OPENING_TOLERANCE:
                    break
        if high - low <= OPENING_TOLERANCE:
            break
        step = 0.5 * (high - low)
    return found


@kernel_only
def _push(status):
    """Return how much later than an opening a ship aims at [s]: data begin at their times."""
    return 0.0 if status == NO_DATA else 0.5 * OPENING_TOLERANCE


@inlined_by_numba
def _share_to_sample(network, edge, sample):
    """Return the share of an edge up to one of its samples, which are evenly spaced."""
    first, last = network.via_ptr[edge], network.via_ptr[edge + 1]
    return min(sample - first + 1, last - first + 1) / (last - first + 1)


@kernel_only
def _next_open_departure(world, where, since, latest, bounds, work):
    """Return (departure, arrival, status, interval) of the first departure that is open.

    ``since`` is a blocked departure, ``bounds`` are the time from which passing a sample is of no
    use and the least time of the edge. All departures that reach the blocking sample before it
    opens are blocked, since a later ship is not there before an earlier one; only ships that are
    very slow at first may be overtaken, and are followed in small steps.
    """
    edge, tail_node, k = where
    times, network = world.sea.times, world.network
    useless, least_time = bounds
    then, status, sample = _march_at(world, edge, tail_node, k, since, work)
    push, rate, crawl = _push(status), 1.0, 1.0
    for _ in range(_MOST_MARCHES):
        if status in (OK, OUTSIDE_PERIOD):
            return since, then, status, k
        blocked = (status, sample)
        opens = _opening_on_edge(world, (edge, tail_node, k), then, blocked, useless, work)
        slow = then - since > _SLOW * least_time * _share_to_sample(network, edge, sample)
        if since >= latest or not (opens < math.inf or slow):
            break
        step = max((opens - then) / rate, 0.0) + push
        if slow:
            step = min(step, crawl)
        step = min(step, latest - since)
        before, at, moment = since, sample, then
        since, then, status, sample = _first_past(
            world, (edge, tail_node, k), before, (at, moment, opens), step, work
        )
        k = interval_near(times, k, since)
        rate, same = 1.0, sample == at and status == blocked[0]
        crawl = min(2.0 * crawl, _SHORT_STEP if then < moment else _LONG_STEP)
        crawl = crawl if same else 1.0
        if not same:
            push = _push(status)
        elif then < opens - push:
            rate = min(max((then - moment) / (since - before), 0.1), 10.0)
        elif status != NO_DATA:
            push = min(2.0 * push, 60.0)  # rounding of the root
    return since, math.inf, status, k


@kernel_only
def _cost_at(world, where, since, factor, departure, work):
    """Return (waiting plus weighted sailing [s], arrival) of a departure; inf where blocked."""
    edge, tail_node, k = where
    times = world.sea.times
    k = interval_near(times, k, departure)
    arrival, status, _ = _march_at(world, edge, tail_node, k, departure, work)
    if status != OK:
        return math.inf, math.inf
    return departure - since + factor * (arrival - departure), arrival


@kernel_only
def _best_in_stretch(world, where, since, factor, stretch, work):
    """Return (departure, arrival, cost) of the best of a stretch of departures that begins open.

    Departures every 20 s and, near its begin, at halved distances to it are tried, then a golden
    section round the best.
    """
    begin, end = stretch
    best, at, found = math.inf, end, math.inf
    low, high = begin, end
    length = end - begin
    count = max(min(math.ceil(length / _SHORT_STEP), _MOST_STEPS), 1)
    for probe in range(1, count + _PROBES + 1):
        share = probe / count
        earlier, later = (probe - 1) / count, (probe + 1) / count
        if probe > count:
            share = 0.5 ** (probe - count) / count
            earlier, later = 0.5 * share, 2.0 * share
        departure = begin + length * share
        cost, arrival = _cost_at(world, where, since, factor, departure, work)
        if cost < best:
            best, at, found = cost, departure, arrival
            low, high = begin + length * earlier, min(begin + length * later, end)
    if best == math.inf:
        return at, found, best
    one, two = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_one, first = _cost_at(world, where, since, factor, one, work)
    at_two, second = _cost_at(world, where, since, factor, two, work)
    while high - low > _CLOSE:
        if at_one < best:
            best, at, found = at_one, one, first
        if at_two < best:
            best, at, found = at_two, two, second
        earlier = at_one <= at_two
        if at_one == math.inf and at_two == math.inf:  # the best is beside closed departures
            earlier = at <= two
        if earlier:
            high, two, at_two, second = two, one, at_one, first
            one = high - _GOLDEN * (high - low)
            at_one, first = _cost_at(world, where, since, factor, one, work)
        else:
            low, one, at_one, first = one, two, at_two, second
            two = low + _GOLDEN * (high - low)
            at_two, second = _cost_at(world, where, since, factor, two, work)
    return at, found, best


@kernel_only
def wait_for_edge(world, edge, tail, k, at_once, terms, work):
    """Find the best departure of an edge for a ship that may wait at its tail.

    Parameters
    ----------
    world : ShipOnEdges
    edge, tail : int
        The edge and the station it leaves.
    k : int
        Interval of the times that holds the arrival at the tail.
    at_once : EdgeDeparture
        What `sail_edge` gives for departing at the arrival at the tail.
    terms : WaitingTerms
    work : float64[4, CHANNELS]
        Work space; the first row is left alone.

    Returns
    -------
    EdgeDeparture : With the status of ``at_once`` if the edge is blocked throughout.

    Notes
    -----
    Candidates are the arrival at the tail, every moment at which the edge opens (to 0.1 s; see
    `opening_of_sample`), every later time of the data, and where the cost falls after one of
    these, the least one before the next. A later ship is taken to pass each sample later than an
    earlier one.
    """
    t, arrival, status = at_once
    _, until, factor, least_time, enough = terms
    sea = world.sea
    departure, best, found = t, math.inf, status
    latest = min(until, sea.times[-1])
    s, then, now = t, arrival, status
    if now == OK:  # the arrival may be a lower bound only, of an edge that is blocked further on
        then, now, _ = _march_at(world, edge, tail, k, t, work)
    for _ in range(_MOST_MARCHES):
        useless = t + min(best, enough) - factor * least_time
        if s >= useless or s > latest:
            break
        if now not in (OK, OUTSIDE_PERIOD):
            passed = t + min(best, enough) / min(factor, 1.0)
            s, then, now, k = _next_open_departure(
                world, (edge, tail, k), s, latest, (passed, least_time), work
            )
            if now not in (OK, OUTSIDE_PERIOD) or s >= useless:
                break
        cost = math.inf
        now_slow = now == OK and then - s > _SLOW * least_time
        if now == OK:
            cost = s - t + factor * (then - s)
        if cost < best:
            departure, arrival, best, found = s, then, cost, OK
        useless = t + min(best, enough) - factor * least_time
        end = min(sea.times[k + 1], latest, useless)
        if not end > s:
            break
        then, now, _ = _march_at(world, edge, tail, interval_near(sea.times, k, end), end, work)
        at_end = end - t + factor * (then - end) if now == OK else math.inf
        soon = s + min(max(0.002 * (end - s), 1.0), end - s)
        where = (edge, tail, k)
        nearby = _cost_at(world, where, t, factor, soon, work)[0]
        slow = now_slow or (cost == math.inf and best == math.inf)
        if nearby < cost - 1e-6 or at_end < cost or slow:
            one, two, three = _best_in_stretch(world, where, t, factor, (s, end), work)
            if three < best:
                departure, arrival, best, found = one, two, three, OK
        s, k = end, interval_near(sea.times, k, end)
        if s in (latest, useless):
            break
    return EdgeDeparture(departure, arrival if best < math.inf else math.inf, found)


@inlined_by_numba
def _waiting_is_useless(sea, k, at_once, terms):
    """Return whether a ship that may leave at once gains nothing by a wait."""
    t, arrival, status = at_once
    sailing, least = arrival - t, terms.least_time
    if status != OK or sailing > _SLOW * least:
        return False
    pause = sea.times[k + 1] - t  # until the next time of the data
    return pause + terms.factor * least >= min(terms.enough, terms.factor * sailing)


@inlined_by_numba
def best_edge_departure(world, edge, tail, k, time, cutoff, terms, work):
    """Return the best use of an edge since a time: an `EdgeDeparture` at once or after a wait.

    Parameters
    ----------
    world : ShipOnEdges
    edge, tail : int
        The edge and the station it leaves.
    k : int
        Interval of the times that holds the time.
    time : float
        Arrival at the tail [s].
    cutoff : MarchCutoff
        For a departure at once.
    terms : WaitingTerms
    work : float64[4, CHANNELS]
        Work space; the first row holds the sea at the tail at the time.
    """
    arrival, status = sail_edge(world, edge, k, time, cutoff, (work[0], work[2], work[3]))
    at_once = EdgeDeparture(time, arrival, status)
    if terms.may_wait and not _waiting_is_useless(world.sea, k, at_once, terms):
        return wait_for_edge(world, edge, tail, k, at_once, terms, work)
    useless = status == OK and arrival >= cutoff.latest
    return EdgeDeparture(time, math.inf if useless else arrival, status)


@allocation_free
def edge_arrivals(world, edges, tails, departures, arrivals, statuses, work):
    """Sail edges at many departures, without waiting.

    Parameters
    ----------
    world : ShipOnEdges
    edges, tails : int64[E]
        Edges and the nodes they leave.
    departures : float64[D]
        [s].
    arrivals : float64[E, D]
        Filled with arrivals [s], inf where blocked.
    statuses : int64[E, D]
        Filled with status codes.
    work : float64[4, CHANNELS]
        Work space.
    """
    for i in range(edges.shape[0]):
        for j in range(departures.shape[0]):
            k = interval_of(world.sea.times, departures[j])
            if k < 0:
                arrivals[i, j] = math.inf
                statuses[i, j] = OUTSIDE_PERIOD if departures[j] == departures[j] else NO_DATA
                continue
            arrivals[i, j], statuses[i, j], _ = _march_at(
                world, edges[i], tails[i], k, departures[j], work
            )
            if statuses[i, j] != OK:
                arrivals[i, j] = math.inf
