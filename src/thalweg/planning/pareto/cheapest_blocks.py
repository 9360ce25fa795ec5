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


class BlockShift(NamedTuple):
    """A move of the boundary of two blocks into the piece beside it, in favour of the slower one.

    Attributes
    ----------
    piece : That is cut.
    share : Of the piece before the cut.
    setting : Of the parts before and after the cut.
    """

    piece: int
    share: float
    setting: tuple[int, int]


def cheapest_shift(
    setting: IntArray, time: FloatArray, cost: FloatArray, least: float, available: float
) -> BlockShift | None:
    """Return the move of one boundary of blocks that saves most in the time that is left.

    Parameters
    ----------
    setting : Of every piece, in blocks (`cheapest_blocks`).
    time, cost, least, available : As for `cheapest_blocks`.

    Returns
    -------
    BlockShift or None : None where none saves anything, or the faster block would become too short.
    """
    rows = np.arange(len(setting))
    left = available - float(time[rows, setting].sum())
    lasting = block_durations(setting, time[rows, setting])
    best, most = None, 0.0
    for block, k in enumerate(np.flatnonzero(np.diff(setting)).tolist()):
        for piece, other, own in ((k, k + 1, block), (k + 1, k, block + 1)):
            fast, slow = int(setting[piece]), int(setting[other])
            more = time[piece, slow] - time[piece, fast]
            saved = cost[piece, fast] - cost[piece, slow]
            if not (np.isfinite(more) and more > left > 0.0 and saved * left / more > most):
                continue
            share = left / more
            if lasting[own] - share * time[piece, fast] < least:
                continue
            most = saved * share
            before = piece < other  # the slow block follows
            cut = 1.0 - share if before else share
            best = BlockShift(piece, cut, (fast, slow) if before else (slow, fast))
    return best


def block_durations(setting: IntArray, time: FloatArray) -> FloatArray:
    """Return the durations of the runs of equal settings, for the time of each piece."""
    first = np.flatnonzero(np.concatenate([[True], setting[1:] != setting[:-1]]))
    return np.asarray(np.add.reduceat(time, first))


class _Blocks(NamedTuple):
    """The times and costs of blocks, from the start of the track to the ends of its pieces.

    Each has the shape (pieces + 1, settings). Pieces that cannot be sailed add nothing to the
    sums and are counted in ``closed``; ``newest`` is the last piece at which a block that ends
    there may begin, and -1 where the track before is shorter than the least time.
    """

    time: FloatArray
    cost: FloatArray
    closed: IntArray
    newest: IntArray


def _blocks(time: FloatArray, cost: FloatArray, least: float) -> _Blocks:
    """Return the sums of which the blocks of at least the least time are differences."""
    sailable = np.isfinite(time) & np.isfinite(cost)
    zeros = np.zeros((1, time.shape[1]))
    until = np.vstack([zeros, np.cumsum(np.where(sailable, time, 0.0), axis=0)])
    spent = np.vstack([zeros, np.cumsum(np.where(sailable, cost, 0.0), axis=0)])
    closed = np.vstack([zeros, np.cumsum(~sailable, axis=0)]).astype(np.int64)
    latest = [np.searchsorted(u, u - least * _ROUNDING, side="right") - 1 for u in until.T]
    # a block has a piece at least, also where the least time is zero
    newest = np.minimum(np.stack(latest, axis=1), np.arange(len(until))[:, None] - 1)
    return _Blocks(until, spent, closed, newest)


def _blocks_by_price(
    time: FloatArray, cost: FloatArray, least: float, prices: FloatArray
) -> IntArray | None:
    """Return the settings (prices, pieces) of least cost plus price times time; None if none.

    The value of a block is a difference of two sums, so that the best first piece of all blocks
    of one setting is a running minimum: the work grows with pieces times settings.
    """
    blocks = _blocks(time, cost, least)
    count, settings = time.shape
    column = np.arange(settings)
    begun = np.full((count + 1, settings, len(prices)), np.inf)  # least value before a block
    first = np.zeros((count + 1, settings, len(prices)), np.int64)  # piece at which it begins
    chosen = np.zeros((count + 1, len(prices)), np.int64)
    since = np.zeros((count + 1, len(prices)), np.int64)
    best = np.zeros(len(prices))
    for end in range(count + 1):
        sums = blocks.cost[end][:, None] + blocks.time[end][:, None] * prices
        if end:
            newest = blocks.newest[end]
            exists = (newest >= 0) & (blocks.closed[end] == blocks.closed[newest, column])
            value = np.where(exists[:, None], sums + begun[newest, column], np.inf)
            chosen[end] = np.argmin(value, axis=0)
            row = np.arange(len(prices))
            best = value[chosen[end], row]
            since[end] = first[newest[chosen[end]], chosen[end], row]
        here = best - sums
        begun[end], first[end] = here, end
        if end:
            open_here = blocks.closed[end] == blocks.closed[end - 1]
            earlier = open_here[:, None] & (begun[end - 1] <= here)
            begun[end] = np.where(earlier, begun[end - 1], here)
            first[end] = np.where(earlier, first[end - 1], end)
    if not np.isfinite(best).all():
        return None
    found = np.zeros((len(prices), count), np.int64)
    for price in range(len(prices)):
        end = count
        while end > 0:
            start = int(since[end, price])
            found[price, start:end] = chosen[end, price]
            end = start
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
        taken = _sums_of_change(time[rows, before], time[rows, after])
        spent = _sums_of_change(cost[rows, before], cost[rows, after])
        cheaper = np.flatnonzero((spent < least_cost) & (taken <= available))
        for change in cheaper[np.argsort(spent[cheaper], kind="stable")] + 1:
            setting = np.concatenate([before[:change], after[change:]])
            if block_durations(setting, time[rows, setting]).min() >= least * _ROUNDING:
                best, least_cost = setting, float(spent[change - 1])
                break
    return np.asarray(best)


def _sums_of_change(before: FloatArray, after: FloatArray) -> FloatArray:
    """Return the sums of the first values of one array and the last of another, by the change."""
    return np.asarray(np.cumsum(before)[:-1] + np.cumsum(after[::-1])[-2::-1])
