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
    goal : int
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
    """How time is divided: width of the bins [s], latest arrival [s], bins; whether one waits."""

    width: float
    latest: float
    count: int
    group: int
    wait: bool


class ActiveNodes(NamedTuple):
    """Nodes by first bin, those whose bins have begun and not ended, and counts."""

    order: np.ndarray
    active: np.ndarray
    counts: np.ndarray


class LabelSearch(NamedTuple):
    """All that labels are set with.

    Attributes
    ----------
    world : FrontArrays
    labels : BinLabels
    target : LabelTarget
    clock : TimeBins
    tables : EdgeTables
    agenda : ActiveNodes
    work : float64[4, CHANNELS]
        Work space.
    at_settings : float32[2 S]
        Work space: durations and costs of an edge at all settings.
    """

    world: FrontArrays
    labels: BinLabels
    target: LabelTarget
    clock: TimeBins
    tables: EdgeTables
    agenda: ActiveNodes
    work: np.ndarray
    at_settings: np.ndarray


class LabelDeparture(NamedTuple):
    """A departure from the node of a label.

    Attributes
    ----------
    time, cost : float
        Then [s after departure of the voyage], and spent so far.
    slot : int
        The label.
    left : float
        ``time``, or NaN if the ship departs on arrival.
    bin : int
        Bin that is being processed.
    """

    time: float
    cost: float
    slot: int
    left: float
    bin: int


@inlined
def activate_nodes(agenda, first, b):
    """Add the nodes whose first bin is b or before to the active ones."""
    counts = agenda.counts
    while counts[STARTED] < agenda.order.shape[0]:
        node = agenda.order[counts[STARTED]]
        if first[node] > b:
            break
        agenda.active[counts[ACTIVE]] = node
        counts[ACTIVE] += 1
        counts[STARTED] += 1


@inlined
def deactivate_node(agenda, n):
    """Replace the n-th active node by the last one."""
    agenda.counts[ACTIVE] -= 1
    agenda.active[n] = agenda.active[agenda.counts[ACTIVE]]
