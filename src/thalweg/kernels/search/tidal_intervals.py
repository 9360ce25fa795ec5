"""Safe intervals of tidal nodes: one state for each interval with sufficient depth.

As `thalweg.search.tidal_states`, but without a copy of the edges for each state.
"""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import BED_DEPTH, WATER_LEVEL
from thalweg.kernels.compilation.decorators import allocation_free, inlined_by_numba

_ROUNDING = 1e-3  # depths are in single precision [m]


class TidalStates(NamedTuple):
    """Intervals with sufficient depth of all nodes; those of node n are ``ptr[n]:ptr[n + 1]``.

    Attributes
    ----------
    ptr : int64[N + 1]
    node : int32[S]
    opens, closes : float64[S]
        An arrival belongs to the state if ``opens <= arrival < closes`` [s].
    until : float64[S]
        A ship may wait until then [s].
    """

    ptr: np.ndarray
    node: np.ndarray
    opens: np.ndarray
    closes: np.ndarray
    until: np.ndarray


@allocation_free
def count_tidal_states(sea, charted, can_wait, required, counts):
    """Fill the number of intervals of each node; 1 if always the same or without waiting."""
    least = np.float32(required - _ROUNDING)
    for n in range(counts.shape[0]):
        counts[n] = 1
        if not can_wait[n]:
            continue
        before, found, always = False, 0, True
        for t in range(sea.times.shape[0]):
            afloat = _depth(sea, charted, n, t) >= least
            if afloat and not before:
                found += 1
            always &= afloat
            before = afloat
        if not always:
            counts[n] = max(found, 1)


@inlined_by_numba
def _depth(sea, charted, n, t):
    i, j = sea.channel_index[WATER_LEVEL], sea.channel_index[BED_DEPTH]
    depth = charted[n]
    if j >= 0:
        bed = sea.values[n, t, j]
        if not depth <= bed:
            depth = bed if depth == depth else depth
    if i >= 0:
        depth = depth + sea.values[n, t, i]
    return depth


@allocation_free
def fill_tidal_states(sea, charted, can_wait, required, states):
    """Fill the intervals of every node; depth is linear between the times of the data."""
    least = np.float32(required - _ROUNDING)
    last = sea.times.shape[0] - 1
    for n in range(states.ptr.shape[0] - 1):
        s = states.ptr[n]
        states.node[s] = n
        states.opens[s], states.closes[s], states.until[s] = -math.inf, math.inf, math.inf
        if not can_wait[n]:
            continue
        before, any_dry, open_now = False, False, False
        for t in range(last + 1):
            afloat = _depth(sea, charted, n, t) >= least
            if afloat and not before:
                if open_now:  # a later interval: it begins in the middle of the dry period
                    begin = _threshold_time(sea, charted, n, t - 1, t, required)
                    middle = 0.5 * (states.until[s] + begin)
                    states.closes[s] = middle
                    s += 1
                    states.node[s] = n
                    states.opens[s], states.closes[s], states.until[s] = middle, math.inf, math.inf
                open_now = True
            if before and not afloat:
                states.until[s] = _threshold_time(sea, charted, n, t, t - 1, required)
            any_dry |= not afloat
            before = afloat
        if any_dry and not open_now:
            states.until[s] = -math.inf


@inlined_by_numba
def _threshold_time(sea, charted, n, dry, wet, required):
    """Return when a node falls dry or floats between two times of the data [s]."""
    bound = np.float32(required)
    low, high = (
        float(_depth(sea, charted, n, dry) - bound),
        float(_depth(sea, charted, n, wet) - bound),
    )
    share = 0.0
    if abs(low) < math.inf and abs(high) < math.inf and high > low:
        share = high / (high - low)
    return sea.times[wet] + share * (sea.times[dry] - sea.times[wet])
