"""Passages found on a network, and those for every departure of a period."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.types import FloatArray, IntArray

_SAME_ARRIVAL = 0.25  # arrivals closer than this are one tide's opening (found to 0.1 s) [s]


@dataclass(frozen=True, eq=False)
class NetworkPassage:
    """One departure and the path it sails.

    Attributes
    ----------
    depart, arrive : float
        [s]; ``arrive`` is inf when the goal is not reached.
    nodes : int64[P]
        From start to goal; empty when not reached.
    node_arrive, node_depart : float64[P]
        Arrival at and departure from each node [s]; a later departure is waiting.
    settled : int
        Nodes settled to find it.
    """

    depart: float
    arrive: float
    nodes: IntArray
    node_arrive: FloatArray
    node_depart: FloatArray
    settled: int = 0

    @property
    def found(self) -> bool:
        """Whether the goal is reached."""
        return len(self.nodes) > 0

    @property
    def waiting(self) -> float:
        """Waiting time [s]."""
        return float(np.sum(self.node_depart - self.node_arrive))


@dataclass(frozen=True, eq=False)
class Profile:
    """The passages of many departures.

    Attributes
    ----------
    passages : tuple of NetworkPassage
        By departure, ascending.
    searched : int
        How many of them were searched; the others wait for the next one of these and sail with it.
    """

    passages: tuple[NetworkPassage, ...]
    searched: int

    @property
    def departures(self) -> FloatArray:
        """Departures [s]."""
        return np.array([p.depart for p in self.passages])

    @property
    def arrivals(self) -> FloatArray:
        """Earliest arrivals [s]; inf where there is none."""
        return np.array([p.arrive for p in self.passages])


def arrive_together(first: NetworkPassage, second: NetworkPassage) -> bool:
    """Whether two departures arrive at one moment, or the first not at all."""
    if not first.found:
        return True  # a later departure does not arrive either
    return second.found and abs(second.arrive - first.arrive) <= _SAME_ARRIVAL


def with_earlier_departure(passage: NetworkPassage, depart: float) -> NetworkPassage:
    """Return a passage whose ship waits at the start since an earlier moment."""
    if not passage.found:
        return replace(passage, depart=depart, settled=0)
    arrive = passage.node_arrive.copy()
    arrive[0] = depart
    return replace(passage, depart=depart, node_arrive=arrive, settled=0)


def passage_not_found(depart: float) -> NetworkPassage:
    """Return the passage of a departure from which none arrives."""
    none = np.empty(0)
    return NetworkPassage(depart, math.inf, np.empty(0, np.int64), none, none)
