"""Sailing one edge of a network through frozen, time-dependent fields."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import (
    DEPTH,
    OK,
    OUTSIDE_PERIOD,
    SHIP_RANGE,
)
from thalweg.kernels.compilation.decorators import inlined, kernel_only
from thalweg.kernels.leg.point_speed import (
    ShipArrays,
    fuel_rate_at_speed,
    point_speed_from_guess,
)


class NetworkArrays(NamedTuple):
    """The arrays of a network that searches read (meanings as in `thalweg.network.Network`).

    A node that falls dry between tides is several states here, one for each time it is afloat: the
    indices of ``indptr``, ``target``, ``can_wait`` and of the following are states.

    Attributes
    ----------
    station : int32[M]
        Station (and node) of each state.
    opens, closes : float64[M]
        An arrival belongs to the state if ``opens <= arrival < closes`` [s].
    until : float64[M]
        A ship may wait until then [s].
    fixed_time : float64[E]
        Time of edges that do not depend on the sea [s]; NaN for those that are sailed.
    """

    indptr: np.ndarray
    target: np.ndarray
    length: np.ndarray
    course: np.ndarray
    depth: np.ndarray
    factor: np.ndarray
    via_ptr: np.ndarray
    via_a: np.ndarray
    via_b: np.ndarray
    via_w: np.ndarray
    via_s: np.ndarray
    can_wait: np.ndarray
    station: np.ndarray
    opens: np.ndarray
    closes: np.ndarray
    until: np.ndarray
    fixed_time: np.ndarray


class SeaArrays(NamedTuple):
    """Fields at stations.

    Attributes
    ----------
    times : float64[T]
        Strictly increasing, at least two [s].
    values : float32[S, T, K]
        NaN where unknown.
    channel_index : int64[CHANNELS]
        Column of each channel, -1 if absent.
    channels : int64[K]
        Channel of each column.
    highest, deepest : float32[S]
        Highest water level and greatest depth (bed plus level) ever, see `tidal_extremes`; may be
        empty when no depth is required.
    """

    times: np.ndarray
    values: np.ndarray
    channel_index: np.ndarray
    channels: np.ndarray
    highest: np.ndarray
    deepest: np.ndarray


class ShipOnEdges(NamedTuple):
    """What edges are sailed with: a network, the sea at its stations, and a ship at one setting."""

    network: NetworkArrays
    sea: SeaArrays
    ship: ShipArrays


class MarchCutoff(NamedTuple):
    """When to stop sailing an edge that is not useful.

    Attributes
    ----------
    latest : An arrival from this time on is not useful [s].
    least : Lower bound of the time per metre [s/m].
    """

    latest: float
    least: float


@inlined
def course_vector(course):
    """Return the unit vector (east, north) of a course [rad], |course| < 100, within 3e-9."""
    quarter = math.floor(course * (2.0 / math.pi) + 0.5)
    r = course - quarter * (0.5 * math.pi)
    s = r * r
    sine = 1.0 + s * (-1.0 / 6.0 + s * (1.0 / 120.0 + s * (-1.0 / 5040.0 + s / 362880.0)))
    sine *= r
    cosine = -1.0 / 720.0 + s * (1.0 / 40320.0 - s / 3628800.0)
    cosine = 1.0 + s * (-0.5 + s * (1.0 / 24.0 + s * cosine))
    turn = int(quarter) & 3
    if turn == 0:
        return sine, cosine
    if turn == 1:
        return cosine, -sine
    if turn == 2:
        return -sine, -cosine
    return -cosine, sine


@kernel_only
def interval_of(times, t):
    """Return k with ``times[k] <= t <= times[k + 1]``, or -1 outside the period (or NaN)."""
    if not times[0] <= t <= times[-1]:
        return -1
    low, high = 0, times.shape[0] - 1
    while high - low > 1:
        middle = (low + high) >> 1
        if times[middle] <= t:
            low = middle
        else:
            high = middle
    return low


@inlined
def interval_near(times, k, t):
    """Do as `interval_of`, for a time near interval k."""
    last = times.shape[0] - 1
    if not times[0] <= t <= times[last]:
        return -1
    while k < last - 1 and times[k + 1] <= t:
        k += 1
    while times[k] > t:
        k -= 1
    return k


@inlined
def sample_station(sea, station, k, t, out):
    """Interpolate a station's channels linearly at time t of interval k, into ``out``."""
    start = sea.times[k]
    f = (t - start) / (sea.times[k + 1] - start)
    values = sea.values
    channels = sea.channels
    if f <= 0.0:
        for j in range(channels.shape[0]):
            out[channels[j]] = values[station, k, j]
    elif f >= 1.0:
        for j in range(channels.shape[0]):
            out[channels[j]] = values[station, k + 1, j]
    else:
        for j in range(channels.shape[0]):
            low = values[station, k, j]
            out[channels[j]] = low + f * (values[station, k + 1, j] - low)


@inlined
def sample_between(sea, a, b, weight, k, t, out, spare):
    """Interpolate between two stations: ``(1 - weight) * a + weight * b``, into ``out``."""
    if weight >= 1.0:
        sample_station(sea, b, k, t, out)
        return
    sample_station(sea, a, k, t, out)
    if weight <= 0.0:
        return
    sample_station(sea, b, k, t, spare)
    for channel in sea.channels:
        out[channel] += weight * (spare[channel] - out[channel])


@inlined
def pass_canal(network, edge, t, last_time):
    """Pass an edge of fixed time, departing at t: return (arrival, status)."""
    t += network.fixed_time[edge]
    if t > last_time:
        return math.inf, OUTSIDE_PERIOD
    head = network.target[edge]
    if not network.opens[head] <= t < network.closes[head]:
        return t, DEPTH
    return t, OK


@inlined
def least_time(network, edge, slowness):
    """Return a lower bound of the time of an edge [s], given that of a metre under way [s/m]."""
    fixed = network.fixed_time[edge]
    return fixed if fixed == fixed else network.length[edge] * slowness


@inlined
def march_edge(world, ship, fuel, edge, k, t, cutoff, work):
    """Sail one edge that is not a canal: return (arrival, fuel burnt, status, blocking sample).

    Parameters
    ----------
    world : ShipOnEdges or FrontArrays
        Network and sea.
    ship : ShipArrays
    fuel : FuelTable or None
        None if the fuel is not needed; its code is then not compiled.
    edge : int
    k : int
        Interval of the times that holds the departure.
    t : float
        Departure [s].
    cutoff : MarchCutoff or None
        None if every arrival is useful.
    work : tuple of three float64[CHANNELS]
        The sea at the tail of the edge at the departure, and two arrays of work space.

    Returns
    -------
    arrival : [s]; of one that is not useful a lower bound that is not useful either. When the
        status is not `OK`: when the ship was to pass the sample that blocks the edge.
    burnt : Fuel [kg]; 0 without a fuel table.
    status : int
    sample : Index of the sample that blocks the edge: less than those inside the edge for the tail,
        the one after them for the head, the next where the head is not open.

    Notes
    -----
    Heun's method, of second order in the piece. A piece of length d between two samples takes
    ``d (1/G0 + 1/G1) / 2`` with the speeds over ground G0 at its start and G1 at its end, that
    at the time predicted with G0. Its fuel is ``d (r0/G0 + r1/G1) / 2`` with the fuel rates r0 and
    r1. Any blocked sample blocks the edge.
    """
    network, sea = world.network, world.sea
    course = course_vector(float(network.course[edge]))
    # float32 would make numba compile a second version of `point_speed_from_guess`
    depth = np.float64(network.depth[edge])
    index = sea.channel_index
    tail, sample, spare = work
    slowness, rate, burnt, at, here, guess, then = 0.0, 0.0, 0.0, 0.0, tail, math.inf, t
    first, last = network.via_ptr[edge], network.via_ptr[edge + 1]
    for p in range(first - 1, last + 1):
        piece = 0.0
        if p >= first:
            to = float(network.via_s[p]) if p < last else 1.0
            piece = network.length[edge] * (to - at)
            at = to
            if cutoff is not None:
                remaining = network.length[edge] * (1.0 - to) * cutoff.least
                least = 0.5 * piece * (slowness + cutoff.least) + remaining
                if t + least >= cutoff.latest:
                    return t + least, 0.0, OK, p
            then = t + piece * slowness
            k = interval_near(sea.times, k, then)
            if k < 0:
                return math.inf, 0.0, OUTSIDE_PERIOD, p
            a = b = network.station[network.target[edge]]
            weight = 0.0
            if p < last:
                a, b, weight = network.via_a[p], network.via_b[p], float(network.via_w[p])
            sample_between(sea, a, b, weight, k, then, sample, spare)
            here = sample
        speed, status, guess = point_speed_from_guess(here, index, course, ship, depth, guess)
        if status != OK:
            return then, 0.0, status, p
        before = slowness
        slowness = 1.0 / speed
        if fuel is not None:
            used, known = fuel_rate_at_speed(here, index, course, fuel, ship, depth, guess)
            if not known:
                return then, 0.0, SHIP_RANGE, p
            burnt += 0.5 * piece * (rate * before + used * slowness)
            rate = used
        t += 0.5 * piece * (before + slowness)
    if t > sea.times[-1]:
        return math.inf, 0.0, OUTSIDE_PERIOD, last + 1
    head = network.target[edge]
    if not network.opens[head] <= t < network.closes[head]:
        return t, 0.0, DEPTH, last + 1  # afloat there, but at another tide
    return t, burnt, OK, last + 1


@inlined
def sail_edge(world, edge, k, t, cutoff, work):
    """Sail one edge, or pass it if it is a canal: return (arrival, status).

    ``world`` is a `ShipOnEdges`; other arguments and results as in `march_edge`. An edge of fixed
    time is passed in that time, whatever the sea is.
    """
    fixed = world.network.fixed_time[edge]
    if fixed == fixed:
        return pass_canal(world.network, edge, t, world.sea.times[-1])
    arrival, _, status, _ = march_edge(world, world.ship, None, edge, k, t, cutoff, work)
    return arrival, status
