"""Time of departure on an edge: ships that may wait, and edges that open."""

import math

from thalweg.kernels.codes import DEPTH, LIMIT_REQUIRED_DEPTH, NO_DATA, OK, OUTSIDE_PERIOD
from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.leg.edge_sailing import MarchCutoff, interval_of, sail_edge, sample_station
from thalweg.kernels.leg.point_speed import water_depth

OPENING_TOLERANCE = 0.1  # accuracy of opening times [s]


@kernel_only
def _sail_edge_at(network, sea, ship, edge, tail_node, k, t, work):
    """Sail an edge at any departure of interval k, sampling the tail too."""
    sample_station(sea, tail_node, k, t, work[1])
    cutoff = MarchCutoff(math.inf, 0.0)
    return sail_edge(network, sea, ship, edge, k, t, cutoff, (work[1], work[2], work[3]))


@kernel_only
def _find_opening(
    network, sea, ship, edge, tail_node, k, closed, open_from, arrival, useless, work
):
    """Return the earliest (departure, arrival) of an edge that opens in (closed, open_from].

    Where depth is what lacks, which is linear between the times of the data, two departures
    give the time when it suffices; else by halving. The arrival is inf if no departure before
    ``useless`` is open.
    """
    required, depth = ship.limits[LIMIT_REQUIRED_DEPTH], float(network.depth[edge])
    guess, share, checking = math.nan, 0.001, False
    passed, lacked = math.nan, math.nan
    while open_from - closed > OPENING_TOLERANCE:
        if closed >= useless:
            return open_from, math.inf
        guessed = closed < guess < open_from
        probe = guess if guessed else closed + share * (open_from - closed)
        then, status = _sail_edge_at(network, sea, ship, edge, tail_node, k, probe, work)
        if status == OK:
            open_from, arrival = probe, then
            if guessed:  # once just before it, to see that it is closed there
                guess = math.nan if checking else probe - 0.9 * OPENING_TOLERANCE
                checking = not checking
        else:
            closed, guess, checking = probe, math.nan, False
            if status == DEPTH:
                sample = work[2] if then > probe else work[1]
                lack = required - water_depth(sample, sea.channel_index, depth)
                if 0.0 < lack < lacked and then > passed:
                    opens = then + lack * (then - passed) / (lacked - lack)
                    guess = opens - (then - probe) + 0.5 * OPENING_TOLERANCE
                passed, lacked = then, lack
        if not guessed:
            share = min(60.0 * share, 0.5)
    return open_from, arrival


@kernel_only
def wait_for_edge(
    network, sea, ship, edge, tail, k, t, until, arrival, status, factor, least_time, enough, work
):
    """Find the best departure of an edge for a ship that may wait at its tail since t.

    Parameters
    ----------
    network, sea, ship : NetworkArrays, SeaArrays, ShipArrays
    edge, tail : int
        The edge and the station it leaves.
    k : int
        Interval of the times that holds t.
    t : float
        Arrival at the tail [s].
    until : float
        How long the ship may wait there [s].
    arrival, status : float, int
        What `sail_edge` gives for departing at t.
    factor : float
        Weight of the time under way; waiting weighs 1.
    least_time : float
        Lower bound of the time under way on this edge [s].
    enough : float
        A departure is useful only if waiting plus ``factor`` times sailing is below this [s].
    work : float64[4, CHANNELS]
        Work space; the first row is left alone.

    Returns
    -------
    departure, arrival : float
        [s]; arrival is inf if the edge cannot be sailed to any use.
    status : int
        `OK`, or why the edge is blocked (at t, when it is blocked throughout).

    Notes
    -----
    Candidates are t itself, every later time of the data, where one of these is blocked the
    departure that passes the blocking sample at that time (fields are linear between times, so a
    sample is at its best at one of them: a short window at high water is found), and the opening
    before a candidate that is open (to 0.1 s). Of their arrivals the least is taken: the
    suffix minimum (van Halem 2019, section 3.4, corrected for series that start blocked). A better
    departure between two that are both open is not looked for, and a window between two times can
    be missed where one sample closes as another opens.
    """
    departure, best = t, math.inf
    if status == OK:
        best = factor * (arrival - t)
    before, before_status = t, status
    last = sea.times.shape[0] - 1
    for j in range(k + 1, last + 1):
        s, interval = min(sea.times[j], until), min(j, last - 1)
        if s < sea.times[j]:
            interval = j - 1
        if s <= before:
            if s < until:
                continue
            break
        earliest = s if before_status == OK else before
        if earliest - t + factor * least_time >= min(best, enough):
            break
        then, now = _sail_edge_at(network, sea, ship, edge, tail, interval, s, work)
        if now == OUTSIDE_PERIOD:
            break
        start, found = s, now
        if now != OK and s - (then - s) > before:  # pass the sample that blocks at a time of data
            start = s - (then - s)
            then, found = _sail_edge_at(network, sea, ship, edge, tail, j - 1, start, work)
        if found == OK:
            value = start - t + factor * (then - start)
            if value < best:
                departure, arrival, best, status = start, then, value, OK
            if before_status != OK:
                useless = t + min(best, enough) - factor * least_time
                start, then = _find_opening(
                    network, sea, ship, edge, tail, j - 1, before, start, then, useless, work
                )
                value = start - t + factor * (then - start)
                if value < best:
                    departure, arrival, best, status = start, then, value, OK
        before, before_status = s, now
    return departure, arrival, status


@allocation_free
def edge_arrivals(network, sea, ship, edges, tails, departures, arrivals, statuses, work):
    """Sail edges at many departures, without waiting.

    Parameters
    ----------
    network, sea, ship : NetworkArrays, SeaArrays, ShipArrays
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
            k = interval_of(sea.times, departures[j])
            if k < 0:
                arrivals[i, j] = math.inf
                statuses[i, j] = OUTSIDE_PERIOD if departures[j] == departures[j] else NO_DATA
                continue
            arrivals[i, j], statuses[i, j] = _sail_edge_at(
                network, sea, ship, edges[i], tails[i], k, departures[j], work
            )
            if statuses[i, j] != OK:
                arrivals[i, j] = math.inf
