"""When a sample of an edge opens: roots of limits on fields that are linear between data times."""

import math

from thalweg.kernels.codes import (
    BED_DEPTH,
    CURRENT,
    CURRENT_EAST,
    CURRENT_NORTH,
    DEPTH,
    LIMIT_REQUIRED_DEPTH,
    LIMIT_WAVE_HEIGHT,
    LIMIT_WIND_SPEED,
    NO_DATA,
    OK,
    WATER_LEVEL,
    WAVE_HEIGHT,
    WAVE_HEIGHT_CHANNEL,
    WIND_EAST,
    WIND_NORTH,
    WIND_SPEED,
)
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.leg.edge_sailing import course_vector, sample_between, sample_station
from thalweg.kernels.leg.point_speed import point_speed_from_guess

_PARTS = 16  # of an interval of the data, where a root has no closed form
_GOLDEN = 0.6180339887498949
_CLOSE = 0.01  # accuracy of roots without a closed form [s]


@kernel_only
def _sample_at(network, sea, place, k, moment, out, spare):
    """Fill ``out`` with the sea at a sample of an edge; ``place`` is (edge, tail, sample)."""
    edge, tail, p = place
    first, last = network.via_ptr[edge], network.via_ptr[edge + 1]
    if p < first:
        sample_station(sea, tail, k, moment, out)
    elif p >= last:
        sample_station(sea, network.station[network.target[edge]], k, moment, out)
    else:
        a, b, weight = network.via_a[p], network.via_b[p], float(network.via_w[p])
        sample_between(sea, a, b, weight, k, moment, out, spare)


@kernel_only
def _share_above(before, after):
    """Return the shares (first, last) of an interval with a linear function >= 0; (2, -1): none."""
    if before >= 0.0 and after >= 0.0:
        return 0.0, 1.0
    if before < 0.0 <= after:
        return before / (before - after), 1.0
    if after < 0.0 <= before:
        return 0.0, before / (before - after)
    return 2.0, -1.0


@kernel_only
def _share_of_depth(index, before, after, charted, required):
    """Return the shares of an interval with enough water, below charted depth and bed alike."""
    low, high = 0.0, 0.0
    if index[WATER_LEVEL] >= 0:
        low, high = before[WATER_LEVEL], after[WATER_LEVEL]
    first, last = 0.0, 1.0
    if charted < math.inf:
        first, last = _share_above(charted + low - required, charted + high - required)
    if index[BED_DEPTH] >= 0:
        low, high = low + before[BED_DEPTH], high + after[BED_DEPTH]
        one, two = _share_above(low - required, high - required)
        first, last = max(first, one), min(last, two)
    return first, last


@kernel_only
def _share_of_wind(before, after, most):
    """Return the shares of an interval with a wind speed of at most ``most`` [m/s]."""
    east, north = before[WIND_EAST], before[WIND_NORTH]
    by_east, by_north = after[WIND_EAST] - east, after[WIND_NORTH] - north
    a = by_east * by_east + by_north * by_north
    b = by_east * east + by_north * north
    c = east * east + north * north - most * most
    if a == 0.0:
        return (0.0, 1.0) if c <= 0.0 else (2.0, -1.0)
    root = b * b - a * c
    if not root >= 0.0:
        return 2.0, -1.0
    root = math.sqrt(root)
    return max((-b - root) / a, 0.0), min((-b + root) / a, 1.0)


@kernel_only
def _has_data(network, sea, ship, place, k, work):
    """Return whether the sea is known at a sample during interval k of the times."""
    middle = 0.5 * (sea.times[k] + sea.times[k + 1])
    _sample_at(network, sea, place, k, middle, work[2], work[3])
    course = course_vector(float(network.course[place[0]]))
    depth = float(network.depth[place[0]])
    status = point_speed_from_guess(work[2], sea.channel_index, course, ship, depth, math.inf)[1]
    return status != NO_DATA


@kernel_only
def _margin(network, sea, ship, place, k, moment, work):
    """Return the speed over ground [m/s] at a sample; not positive where it is closed."""
    _sample_at(network, sea, place, k, moment, work[2], work[3])
    sample, index = work[2], sea.channel_index
    east, north = course_vector(float(network.course[place[0]]))
    speed, status, through = point_speed_from_guess(
        sample, index, (east, north), ship, float(network.depth[place[0]]), math.inf
    )
    if status == OK:
        return speed
    if status != CURRENT or not through > 0.0:
        return -math.inf
    along = sample[CURRENT_EAST] * east + sample[CURRENT_NORTH] * north
    across = sample[CURRENT_EAST] * north - sample[CURRENT_NORTH] * east  # positive to starboard
    spare = through * through - across * across
    return min(along + (math.sqrt(spare) if spare > 0.0 else spare / through), 0.0)


@kernel_only
def _first_above(network, sea, ship, place, k, span, work):
    """Return when a sample opens in a span of one interval, by its margin at parts of the span.

    Where it is closed at all of them, the greatest margin is looked for between them.
    """
    begin, end = span
    step = (end - begin) / _PARTS
    best, at = -math.inf, begin
    closed, found = begin, math.inf
    for part in range(_PARTS + 1):
        moment = begin + part * step
        value = _margin(network, sea, ship, place, k, moment, work)
        if value > 0.0:
            found = moment
            break
        closed = moment
        if value > best:
            best, at = value, moment
    if found == math.inf and best > -math.inf:
        low, high = max(at - step, begin), min(at + step, end)
        closed = low
        while high - low > _CLOSE:
            one, two = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
            at_one = _margin(network, sea, ship, place, k, one, work)
            at_two = _margin(network, sea, ship, place, k, two, work)
            if at_one > 0.0 or at_two > 0.0:
                found = one if at_one > 0.0 else two
                break
            if at_one >= at_two:
                high = two
            else:
                low = one
    while found < math.inf and found - closed > _CLOSE:
        middle = 0.5 * (found + closed)
        if _margin(network, sea, ship, place, k, middle, work) > 0.0:
            found = middle
        else:
            closed = middle
    return found


@kernel_only
def opening_of_sample(network, sea, ship, place, k, moment, blocked, work):
    """Return from when on what blocks a sample does so no longer.

    Parameters
    ----------
    network, sea, ship : NetworkArrays, SeaArrays, ShipArrays
    place : tuple of int
        Edge, station at its tail, and sample: the index of a sample inside the edge, less than
        all of them for the tail, more for the head.
    k : int
        Interval of the times that holds the moment.
    moment : float
        When the sample is closed [s].
    blocked : tuple of int and float
        Status that blocks it, and the time from which an opening is of no use [s].
    work : float64[4, CHANNELS]
        Work space; the first two rows are left alone.

    Returns
    -------
    float : [s]; inf if it does not open before it is of no use.

    Notes
    -----
    Depths and wave heights are linear between the times of the data, squared wind speeds are
    quadratic: their roots are solved for. The speed over ground against a current and the limits
    of the ship are halved to the root, after a search at 17 moments of each interval and, against
    a current, for the greatest speed between these.
    """
    status, useless = blocked
    before, after, index = work[2], work[3], sea.channel_index
    charted, required = float(network.depth[place[0]]), ship.limits[LIMIT_REQUIRED_DEPTH]
    last = sea.times.shape[0] - 1
    for j in range(k, last):
        begin, end = max(moment, sea.times[j]), sea.times[j + 1]
        if begin >= useless:
            break
        if status == NO_DATA:
            if j + 1 < last and _has_data(network, sea, ship, place, j + 1, work):
                return end
            continue
        if status not in (DEPTH, WAVE_HEIGHT, WIND_SPEED):
            found = _first_above(network, sea, ship, place, j, (begin, end), work)
            if found < math.inf:
                return found
            continue
        _sample_at(network, sea, place, j, sea.times[j], work[2], work[1])
        _sample_at(network, sea, place, j, end, work[3], work[1])
        if status == DEPTH:
            first, final = _share_of_depth(index, before, after, charted, required)
        elif status == WAVE_HEIGHT:
            most = ship.limits[LIMIT_WAVE_HEIGHT]
            first, final = _share_above(
                most - before[WAVE_HEIGHT_CHANNEL], most - after[WAVE_HEIGHT_CHANNEL]
            )
        else:
            first, final = _share_of_wind(before, after, ship.limits[LIMIT_WIND_SPEED])
        span = end - sea.times[j]
        if first <= final and sea.times[j] + final * span > begin:
            return max(sea.times[j] + first * span, begin)
    return math.inf
