"""Division of time for a front: bins, slices of edge tables, windows of nodes, and memory."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.codes import STATUS_COUNT
from thalweg.kernels.pareto.edge_tables import EdgeTables, sail_departures
from thalweg.kernels.pareto.label_arrays import COUNTER_COUNT as ACTIVE_NODE_COUNTS
from thalweg.kernels.pareto.label_arrays import (
    ActiveNodes,
    BinLabels,
    LabelTarget,
    TimeBins,
)
from thalweg.search.pareto.front_problem import FrontProblem, FrontRequest, new_edge_workspace
from thalweg.search.pareto.goal_bounds import BoundsToGoal

#: What the tables of edges may be off from the legs, as a share of their duration or cost.
TABLE_TOLERANCE = 1e-3
_FINE, _CHEAP = 0.02, 3e7  # share of the tolerance; [bytes]
_MAX_BINS = 2000
_MIN_BINS = 250
_MAX_RELAXATIONS = 4e9  # that bins chosen here may allow for; a good third of them come about
_MAX_BYTES_OF_FINER_SLICES = (
    1e9  # tables are not made larger than that for the sake of finer slices [bytes]
)
_END_SHARE = 0.05  # of the horizon: longer than edges take
_MAX_ERROR_RATIO = (
    0.4  # of the error left by halving steps, at most, if the sea is smooth: a quarter is due
)
PROGRESS_CHUNKS = 50  #: how often the progress of a search over the bins is reported
_SAMPLED_EDGES = 400  # edges considered to choose the slices
_LABEL_BYTES = 20
_ROUND_BIN_WIDTHS = [
    0.1,
    0.2,
    0.5,
    1.0,
    2.0,
    5.0,
    10.0,
    15.0,
    20.0,
    30.0,
    60.0,
    90.0,
    120.0,
    180.0,
    240.0,
]
_ROUND_BIN_WIDTHS += [300.0, 450.0, 600.0, 900.0, 1200.0, 1800.0, 3600.0]


class BinWindows(NamedTuple):
    """Bins of every state between which a label may be useful; none when last < first."""

    first: NDArray[np.int32]
    last: NDArray[np.int32]

    @property
    def bins(self) -> int:
        """Number of labels."""
        return int(np.maximum(self.last.astype(np.int64) - self.first + 1, 0).sum())


class Discretisation(NamedTuple):
    """A division of time that fits the memory.

    Attributes
    ----------
    time_bins : Bins of the labels.
    windows : Bins of each state in which a label may be useful.
    slices : float64[K] [s after departure]
    table_error : 95th percentile of the difference to the legs, as a share.
    memory : [bytes]
    """

    time_bins: TimeBins
    windows: BinWindows
    slices: FloatArray
    table_error: float
    memory: int


def choose_discretisation(
    front_problem: FrontProblem,
    request: FrontRequest,
    bounds: BoundsToGoal,
    earliest: FloatArray,
    *,
    bin_s: float | None,
    memory_limit: float,
    table_tolerance: float = TABLE_TOLERANCE,
) -> Discretisation:
    """Choose bins and slices within the memory.

    Parameters
    ----------
    earliest : float64[N]
        Earliest arrival at every state [s].
    bin_s : Width of the bins [s]; by default the horizon is divided into at most 2000, into fewer
        where the memory does not allow that or the relaxations would be too many.
    memory_limit : [bytes]
    table_tolerance : What the tables of edges may be off from the legs, as a share.

    Raises
    ------
    InputError : If the bins do not fit the memory; it says what they would take.
    """
    width = _round_bin_width(request.horizon / _MAX_BINS) if bin_s is None else float(bin_s)
    while True:
        time_bins = _time_bins(request, width)
        windows = _windows(time_bins, bounds, earliest - request.depart)
        coarsest = time_bins.count <= _MIN_BINS
        if (
            bin_s is None
            and not coarsest
            and _relaxations(front_problem, windows) > _MAX_RELAXATIONS
        ):
            width = _round_bin_width(width * 1.5)
            continue
        slices, error, memory = _slices(
            front_problem, request, time_bins, windows, memory_limit, table_tolerance
        )
        if memory <= memory_limit:
            return Discretisation(time_bins, windows, slices, error, memory)
        if bin_s is not None or coarsest:
            raise _memory_error(front_problem, time_bins, memory, memory_limit)
        width = _round_bin_width(width * 1.5)


def _round_bin_width(width: float) -> float:
    fitting = [nice for nice in _ROUND_BIN_WIDTHS if nice >= width * (1 - 1e-9)]
    return fitting[0] if fitting else math.ceil(width / 3600.0) * 3600.0


def _time_bins(request: FrontRequest, width: float) -> TimeBins:
    count = int(request.horizon / width) + 1
    return TimeBins(
        width, request.horizon, count, max(1, round(math.sqrt(count / 2))), request.wait
    )


def _windows(time_bins: TimeBins, bounds: BoundsToGoal, earliest: FloatArray) -> BinWindows:
    """Return the bins of each state; the tables may be early by a little."""
    early = np.maximum(0.995 * earliest - 0.5 * time_bins.width, 0.0)
    late = time_bins.latest - bounds.time
    known = np.isfinite(early) & np.isfinite(late) & (late >= early)
    first = np.where(known, np.where(known, early, 0.0) // time_bins.width, 1).astype(np.int32)
    last = np.where(known, np.where(known, late, 0.0) // time_bins.width, 0).astype(np.int32)
    return BinWindows(first, np.minimum(last, time_bins.count - 1))


def _slices(
    front_problem: FrontProblem,
    request: FrontRequest,
    time_bins: TimeBins,
    windows: BinWindows,
    memory_limit: float,
    tolerance: float,
) -> tuple[FloatArray, float, int]:
    """Return the coarsest slices that are exact enough, finer ones where they cost little.

    If none that fit the memory and take a bearable time are exact enough, the finest that do, or
    the sea's own times where finer ones help little: jumps are not known better for them.
    """
    ladder = _slice_candidates(front_problem.arrays.sea.times - request.depart, time_bins.latest)
    most, own = (
        min(memory_limit, _MAX_BYTES_OF_FINER_SLICES),
        len(front_problem.arrays.sea.times) + 2,
    )
    chosen, error, memory, fine = ladder[0], math.inf, 0, False
    for slices in ladder:
        needed = _memory(front_problem, time_bins, windows, slices)
        if error <= tolerance and (fine or needed > _CHEAP):
            break
        if error < math.inf and needed > most:
            break
        before = error
        error, closes = _table_error(front_problem, request, windows, time_bins, slices)
        if len(slices) > own and error > _MAX_ERROR_RATIO * before and needed > _CHEAP:
            error = before
            break
        chosen, memory = slices, needed
        fine = error <= _FINE * tolerance and not closes
    return chosen, error, memory


def _slice_candidates(times: FloatArray, horizon: float) -> list[FloatArray]:
    """Return slices from coarse to fine: every n-th time of the sea, then parts of its steps."""
    inside = times[(times > 0.0) & (times < horizon)]
    # edges left at the end of the data cannot be sailed; those before are not judged by them
    own = np.unique(np.concatenate(([0.0], inside, [(1.0 - _END_SHARE) * horizon, horizon])))
    candidates = []
    stride = 1 << max(0, int(math.log2(max(len(own) / 8.0, 1.0))))
    while stride > 1:
        candidates.append(np.append(own[:-1:stride], horizon))
        stride //= 2
    candidates.append(own)
    for parts in (2, 4, 8):
        within = own[:-1, None] + np.diff(own)[:, None] * (np.arange(parts) / parts)
        candidates.append(np.append(within.ravel(), horizon))
    return candidates


def _relaxations(front_problem: FrontProblem, windows: BinWindows) -> float:
    """Return how many relaxations the windows allow for."""
    bins = np.maximum(windows.last.astype(np.int64) - windows.first + 1, 0)
    return float((bins * np.diff(front_problem.arrays.network.indptr)).sum()) * len(
        front_problem.arrays.ship.settings
    )


def slice_windows(
    time_bins: TimeBins, windows: BinWindows, slices: FloatArray
) -> tuple[IntArray, IntArray]:
    """Return the first slice of each state and how many it has."""
    begin = np.minimum(windows.first * time_bins.width, time_bins.latest)
    end = np.minimum((windows.last + 1) * time_bins.width, time_bins.latest)
    first = np.searchsorted(slices, begin, side="right") - 1
    last = np.minimum(np.searchsorted(slices, end, side="right"), len(slices) - 1)
    first = np.minimum(first, len(slices) - 2)
    count = np.where(windows.last >= windows.first, last - first + 1, 0)
    return first.astype(np.int64), count.astype(np.int64)


def _memory(
    front_problem: FrontProblem, time_bins: TimeBins, windows: BinWindows, slices: FloatArray
) -> int:
    _, count = slice_windows(time_bins, windows, slices)
    degree = np.diff(front_problem.arrays.network.indptr)
    values = int((count * degree).sum()) * 2 * len(front_problem.arrays.ship.settings) * 4
    slack = int((count * degree).sum()) * 13
    return values + slack + int(count.sum()) * 2 + windows.bins * _LABEL_BYTES + 200 * len(degree)


def _table_error(
    front_problem: FrontProblem,
    request: FrontRequest,
    windows: BinWindows,
    time_bins: TimeBins,
    slices: FloatArray,
) -> tuple[float, bool]:
    """Return how far legs midway between two slices are from the mean of the two, as a share.

    Also whether any is closed at one of the slices or midway between them, and open at another.
    """
    rng = np.random.default_rng(0)
    usable = windows.last >= windows.first
    usable &= np.diff(front_problem.arrays.network.indptr) > 0
    nodes = np.flatnonzero(usable)
    if len(nodes) == 0:
        return 0.0, False
    nodes = rng.choice(nodes, _SAMPLED_EDGES)
    net = front_problem.arrays.network
    degree = np.diff(net.indptr)[nodes]
    edges = net.indptr[nodes] + rng.integers(0, degree)
    choices = rng.integers(0, len(front_problem.arrays.ship.settings), _SAMPLED_EDGES)
    span = (windows.last - windows.first + 1)[nodes]
    when = (windows.first[nodes] + rng.random(_SAMPLED_EDGES) * span) * time_bins.width
    k = np.clip(np.searchsorted(slices, when, side="right") - 1, 0, len(slices) - 2)
    begin, end = slices[k], slices[k + 1]
    errors = []
    for t in (begin, 0.5 * (begin + end), end):
        out = np.empty((_SAMPLED_EDGES, 2))
        departures = np.ascontiguousarray(request.depart + t)
        sail_departures(
            front_problem.arrays, edges, nodes, choices, departures, out, new_edge_workspace()
        )
        errors.append(out)
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.abs(0.5 * (errors[0] + errors[2]) / errors[1] - 1.0)
    open_ = [np.isfinite(out[:, 0]) for out in errors]
    closes = bool(((open_[0] | open_[1] | open_[2]) & ~(open_[0] & open_[1] & open_[2])).any())
    off = off[np.isfinite(off).all(axis=1)]
    return (float(np.quantile(off, 0.95)) if off.size else 0.0), closes


def _memory_error(
    front_problem: FrontProblem, time_bins: TimeBins, memory: int, limit: float
) -> InputError:
    net = front_problem.arrays.network
    return InputError(
        f"A front over {len(net.station):,} nodes and {len(net.target):,} edges with "
        f"{len(front_problem.arrays.ship.settings)} settings in bins of {time_bins.width:g} s "
        "would take "
        f"{memory / 1e9:.3g} GB of memory.",
        f"At most {limit / 1e9:.3g} GB may be taken.",
        "Take a coarser network, fewer settings, a wider bin_s or an earlier latest arrival, or "
        "raise memory_limit.",
        memory=memory,
        limit=float(limit),
    )


def new_edge_tables(front_problem: FrontProblem, plan: Discretisation) -> EdgeTables:
    """Return tables of edges, not filled yet."""
    first, count = slice_windows(plan.time_bins, plan.windows, plan.slices)
    degree = np.diff(front_problem.arrays.network.indptr)
    size = count * degree * 2 * len(front_problem.arrays.ship.settings)
    return EdgeTables(
        times=plan.slices,
        first=first,
        count=count,
        place=cumulative_sums(count)[:-1],
        offset=cumulative_sums(size)[:-1],
        state=np.zeros(int(count.sum()), np.uint8),
        values=np.empty(int(size.sum()), np.float32),
        refused=np.zeros(STATUS_COUNT, np.int64),
        sailed=np.zeros(1, np.int64),
    )


def new_bin_labels(windows: BinWindows) -> BinLabels:
    """Return labels of which none is set."""
    bins = np.maximum(windows.last.astype(np.int64) - windows.first + 1, 0)
    total, count = int(bins.sum()), len(bins)
    return BinLabels(
        first=windows.first,
        last=windows.last,
        place=cumulative_sums(bins)[:-1],
        cost=np.full(total, np.inf, np.float32),
        when=np.empty((total, 2), np.float32),
        source=np.empty((total, 2), np.int32),
        best=np.full(count, np.inf),
        best_at=np.full((count, 2), np.inf),
        done=np.full((count, 2), -1.0),
    )


def new_target(goal: int, bounds: BoundsToGoal, time_bins: TimeBins) -> LabelTarget:
    """Return the goal with nothing known of arriving there."""
    return LabelTarget(
        goal, np.full(time_bins.count + 1, np.inf), bounds.time, bounds.rates,
        np.ascontiguousarray(bounds.floor),
    )  # fmt: skip


def new_active_nodes(windows: BinWindows) -> ActiveNodes:
    """Return the nodes in the order in which their bins begin."""
    used = np.flatnonzero(windows.last >= windows.first)
    order = used[np.argsort(windows.first[used], kind="stable")].astype(np.int32)
    return ActiveNodes(
        order, np.empty(len(order), np.int32), np.zeros(ACTIVE_NODE_COUNTS, np.int64)
    )
