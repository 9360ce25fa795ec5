"""The cheapest speeds along a track where every speed is held for a least time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thalweg.core.types import FloatArray, IntArray

_PRICES = 24  # shadow prices that are tried, from the least to the greatest useful one
_ROUNDING = 1.0 - 1e-9  # of the least time of a block


def cheapest_blocks(
    time: FloatArray, cost: FloatArray, least: float, available: float
) -> IntArray | None:
    """Return the settings of pieces that cost least in the available time, in blocks.

    Parameters
    ----------
    time, cost : float64 array (pieces, settings)
        Time [s] and cost of each piece at each setting; not finite where it cannot be sailed.
    least : Least time of a block of one setting [s].
    available : Time of the whole track [s].

    Returns
    -------
    int64 array (pieces,) or None : None if no choice of blocks is in time.

    Notes
    -----
    For a shadow price, the cheapest blocks are found by dynamic programming over their ends.
    Between the two prices next to the available time, one choice is followed up to some piece and
    the other from there: the best such pair is taken.
    """
    prices = _prices_of_time(time, cost)
    choices = _blocks_by_price(time, cost, least, prices)
    if choices is None:
        return None
    rows = np.arange(len(time))
    spent = time[rows, choices].sum(axis=1)
    early = np.flatnonzero(spent <= available)
    if not len(early):
        return None
    fast = choices[early[np.argmax(spent[early])]]
    late = np.flatnonzero(spent > available)
    if not len(late):
        return np.asarray(fast)
    slow = choices[late[np.argmin(spent[late])]]
    return _best_pair(time, cost, least, available, fast, slow)


def block_durations(setting: IntArray, time: FloatArray) -> FloatArray:
    """Return the durations of the runs of equal settings, for the time of each piece."""
    first = np.flatnonzero(np.concatenate([[True], setting[1:] != setting[:-1]]))
    return np.asarray(np.add.reduceat(time, first))


class _Blocks(NamedTuple):
    """All blocks that a choice may consist of, by the piece at which they end.

    Each has the shape (pieces + 1, settings, blocks); the first piece of a block is its
    predecessor in the dynamic programme, and blocks that do not exist cost infinitely much.
    """

    first: IntArray
    time: FloatArray
    cost: FloatArray


def _blocks(time: FloatArray, cost: FloatArray, least: float) -> _Blocks:
    """Return the blocks of at least the least time; longer ones are two of these."""
    sailable = np.isfinite(time) & np.isfinite(cost)
    count, settings = time.shape
    zeros = np.zeros((1, settings))
    until = np.vstack([zeros, np.cumsum(np.where(sailable, time, 0.0), axis=0)])
    spent = np.vstack([zeros, np.cumsum(np.where(sailable, cost, 0.0), axis=0)])
    closed = np.vstack([zeros, np.cumsum(~sailable, axis=0)])
    longest = 2.0 * least + float(np.where(sailable, time, 0.0).max())
    low = np.stack(
        [np.searchsorted(u, u - longest) for u in until.T], axis=1
    )  # first pieces of the longest blocks
    high = np.stack(
        [np.searchsorted(u, u - least * _ROUNDING, side="right") for u in until.T], axis=1
    )
    width = int(np.maximum(high - low, 1).max())
    first = low[:, :, None] + np.arange(width)
    exists = first < high[:, :, None]
    first = np.minimum(first, count)
    column = np.arange(settings)[None, :, None]
    exists &= closed[:, :, None] == closed[first, column]
    block_time = until[:, :, None] - until[first, column]
    block_cost = np.where(exists, spent[:, :, None] - spent[first, column], np.inf)
    return _Blocks(first, block_time, block_cost)


def _blocks_by_price(
    time: FloatArray, cost: FloatArray, least: float, prices: FloatArray
) -> IntArray | None:
    """Return the settings (prices, pieces) of least cost plus price times time; None if none."""
    blocks = _blocks(time, cost, least)
    count = len(time)
    width = blocks.first.shape[2]
    best = np.full((count + 1, len(prices)), np.inf)
    best[0] = 0.0
    chosen = np.zeros((count + 1, len(prices)), np.int64)
    for end in range(1, count + 1):
        value = blocks.cost[end].reshape(-1, 1) + blocks.time[end].reshape(-1, 1) * prices
        value += best[blocks.first[end].ravel()]
        chosen[end] = np.argmin(value, axis=0)
        best[end] = np.min(value, axis=0)
    if not np.isfinite(best[-1]).all():
        return None
    found = np.zeros((len(prices), count), np.int64)
    for row in range(len(prices)):
        end = count
        while end > 0:
            setting, place = divmod(int(chosen[end, row]), width)
            first = int(blocks.first[end, setting, place])
            found[row, first:end] = setting
            end = first
    return found


def _prices_of_time(time: FloatArray, cost: FloatArray) -> FloatArray:
    """Return shadow prices from zero to one at which only the time counts."""
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = -(cost[:, 1:] - cost[:, :-1]) / (time[:, 1:] - time[:, :-1])
    slope = slope[np.isfinite(slope) & (slope > 0.0)]
    if not len(slope):
        return np.zeros(1)
    low, high = 0.5 * float(slope.min()), 2.0 * float(slope.max())
    return np.concatenate([[0.0], np.geomspace(low, high, _PRICES - 2), [1e4 * high]])


def _best_pair(
    time: FloatArray,
    cost: FloatArray,
    least: float,
    available: float,
    fast: IntArray,
    slow: IntArray,
) -> IntArray:
    """Return the cheapest choice in time that changes once between two choices."""
    rows = np.arange(len(time))
    best, least_cost = fast, float(cost[rows, fast].sum())
    for before, after in ((fast, slow), (slow, fast)):
        for change in range(1, len(time)):
            setting = np.concatenate([before[:change], after[change:]])
            taken, spent = time[rows, setting], float(cost[rows, setting].sum())
            if spent >= least_cost or not taken.sum() <= available:
                continue
            if block_durations(setting, taken).min() >= least * _ROUNDING:
                best, least_cost = setting, spent
    return np.asarray(best)
