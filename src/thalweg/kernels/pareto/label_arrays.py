"""The arrays that label setting in bins of time reads and writes."""

from typing import NamedTuple

import numpy as np

from thalweg.kernels.compilation.decorators import inlined
from thalweg.kernels.pareto.edge_tables import EdgeTables, FrontArrays

VISITED, RELAXED, PRUNED, WAITED, STARTED, ACTIVE, SLICE = 0, 1, 2, 3, 4, 5, 6
COUNTER_COUNT = 7  # entries of `ActiveNodes.counts`


class BinLabels(NamedTuple):
    """The cheapest known arrival at every node in every bin of time.

    Attributes
    ----------
    first, last : int32[N]
        First and last bin of a node; none when last < first.
    place : int64[N]
        Where the bins of a node start in the following.
    cost : float32[L]
        inf where there is none.
    when : float32[L, 2]
        True time [s after departure]; departure from the previous node, NaN if on arrival.
    source : int32[L, 2]
        Label it comes from, -1 at the start; edge times number of settings plus setting.
    best : float64[N]
        Least cost so far minus ``waiting_cost_rate`` times time.
    best_at : float64[N, 2]
        Time [s after departure] and label of it.
    done : float64[N, 2]
        Bin visited last and the cost then.
    """

    first: np.ndarray
    last: np.ndarray
    place: np.ndarray
    cost: np.ndarray
    when: np.ndarray
    source: np.ndarray
    best: np.ndarray
    best_at: np.ndarray
    done: np.ndarray


class LabelTarget(NamedTuple):
    """Where labels are to lead, and bounds of what is still to come.

    Attributes
    ----------
    upper : float64[B + 1]
        Least cost known of arriving at the goal by the start of each bin; inf for none.
    time_to_go : float64[N]
        Lower bound of the time to the goal [s].
    rates : float64[R]
        Prices of a second, 0 first.
    floor : float64[N, R]
        Lower bound of the cost plus such a price times the time to the goal.
    """

    goal: int
    upper: np.ndarray
    time_to_go: np.ndarray
    rates: np.ndarray
    floor: np.ndarray


class TimeBins(NamedTuple):
    """How time is divided for labels.

    Attributes
    ----------
    width : Width of a bin [s].
    latest : Latest useful arrival [s after departure].
    count : Number of bins B.
    group : Bins whose bounds are tested together first.
    wait : Whether ships wait where the network allows it.
    """

    width: float
    latest: float
    count: int
    group: int
    wait: bool


class ActiveNodes(NamedTuple):
    """The nodes whose bins have begun and not ended.

    Attributes
    ----------
    order : int32[M]
        Nodes that have bins, by their first bin.
    active : int32[M]
        The active nodes, in the first ``counts[ACTIVE]`` entries.
    counts : int64[COUNTER_COUNT]
        See `VISITED` and the constants beside it.
    """

    order: np.ndarray
    active: np.ndarray
    counts: np.ndarray


class LabelSearch(NamedTuple):
    """All that labels are set with.

    Attributes
    ----------
    work : float64[4, CHANNELS]
        Work space.
    at_settings : float32[2 S]
        Work space: durations and costs of an edge at all settings.
    """

    world: FrontArrays
    labels: BinLabels
    target: LabelTarget
    time_bins: TimeBins
    tables: EdgeTables
    active_nodes: ActiveNodes
    work: np.ndarray
    at_settings: np.ndarray


class LabelDeparture(NamedTuple):
    """A departure from the node of a label.

    Attributes
    ----------
    time, cost : Then [s after departure of the voyage], and spent so far.
    slot : The label.
    left : ``time``, or NaN if the ship departs on arrival.
    bin : Bin that is being processed.
    """

    time: float
    cost: float
    slot: int
    left: float
    bin: int


@inlined
def activate_nodes(active_nodes, first, b):
    """Add the nodes whose first bin is b or before to the active ones."""
    counts = active_nodes.counts
    while counts[STARTED] < active_nodes.order.shape[0]:
        node = active_nodes.order[counts[STARTED]]
        if first[node] > b:
            break
        active_nodes.active[counts[ACTIVE]] = node
        counts[ACTIVE] += 1
        counts[STARTED] += 1


@inlined
def deactivate_node(active_nodes, n):
    """Replace the n-th active node by the last one."""
    active_nodes.counts[ACTIVE] -= 1
    active_nodes.active[n] = active_nodes.active[active_nodes.counts[ACTIVE]]
