"""The result of a search on a network."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from thalweg.kernels.codes import REASONS
from thalweg.kernels.search.label_setting import RELAXED, SAILED, SETTLED


@dataclass(frozen=True)
class SearchWork:
    """How much work a search was.

    Attributes
    ----------
    settled : int
        Nodes settled.
    relaxed : int
        Edges that left them.
    sailed : int
        Edges that could be useful and were therefore sailed.
    refused : dict of str to int
        How many of the sailed ones were refused, by reason.
    """

    settled: int
    relaxed: int
    sailed: int
    refused: dict[str, int] = field(default_factory=dict)

    @classmethod
    def of(cls, counts: NDArray[np.int64], refused: NDArray[np.int64]) -> SearchWork:
        """Return the work by the counts of a kernel.

        Parameters
        ----------
        counts : int64 array (3,)
            Nodes settled, edges relaxed, edges sailed.
        refused : int64 array (STATUS_COUNT,)
            How many edges were refused, by status.

        Returns
        -------
        SearchWork
        """
        return cls(
            int(counts[SETTLED]),
            int(counts[RELAXED]),
            int(counts[SAILED]),
            counts_by_reason(refused),
        )


def counts_by_reason(refused: NDArray[np.int64]) -> dict[str, int]:
    """Return how many edges were refused by reason.

    Parameters
    ----------
    refused : How many, by status, (STATUS_COUNT,).

    Returns
    -------
    dict of str to int : Without the reasons that do not occur.
    """
    return {REASONS[code]: int(n) for code, n in enumerate(refused) if n > 0 and code > 0}


@dataclass(frozen=True)
class SearchResult:
    """The answer of a search on a network.

    Attributes
    ----------
    path : int64[P]
        Nodes from start to goal; empty when the goal was not reached.
    path_arrive, path_depart : float64[P]
        Arrival at and departure from each node of the path [s]; a later departure is waiting. The
        two are equal at the goal.
    cost : float
        Time [s] or distance [m] with penalty factors; inf when there is no path.
    node_arrival : float64[N]
        Arrival at every settled node [s] (for isochrones); inf elsewhere.
    nearest_node : int
        The settled node nearest to the goal; -1 without a goal.
    work : SearchWork
    departures : tuple of (departure, duration)
        Of a window: the departures that were tried in it, and how long the voyage takes with waits
        [s]; inf without a path.
    """

    path: NDArray[np.int64]
    path_arrive: NDArray[np.float64]
    path_depart: NDArray[np.float64]
    cost: float
    node_arrival: NDArray[np.float64]
    nearest_node: int
    work: SearchWork
    departures: tuple[tuple[float, float], ...] = ()

    @property
    def found(self) -> bool:
        """Whether the goal was reached."""
        return len(self.path) > 0

    @property
    def depart(self) -> float:
        """Time at the start [s]; NaN when there is no path."""
        return float(self.path_arrive[0]) if self.found else float("nan")

    @property
    def arrive(self) -> float:
        """Arrival at the goal [s]; inf when there is no path."""
        return float(self.path_arrive[-1]) if self.found else float("inf")

    @property
    def duration(self) -> float:
        """Arrival minus time at the start [s]; inf when there is no path."""
        return self.arrive - self.depart if self.found else float("inf")

    @property
    def waiting(self) -> float:
        """Total time waited [s]."""
        return float(np.sum(self.path_depart - self.path_arrive))

    @property
    def settled(self) -> int:
        """Nodes settled."""
        return self.work.settled

    @property
    def relaxed(self) -> int:
        """Edges that left the settled nodes."""
        return self.work.relaxed

    @property
    def refused(self) -> dict[str, int]:
        """How many edges were refused, by reason."""
        return self.work.refused
