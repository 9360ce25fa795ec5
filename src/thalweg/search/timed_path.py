"""Timed paths on a network, and those of every departure of a period."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.types import FloatArray, IntArray
from thalweg.deprecated_names import renamed_attributes

_SAME_ARRIVAL = 0.25  # arrivals closer than this are one tide's opening (found to 0.1 s) [s]


@dataclass(frozen=True, eq=False)
class TimedPath:
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
    """The paths of many departures.

    Attributes
    ----------
    paths : tuple of TimedPath
        By departure, ascending.
    searched : int
        How many of them were searched; the others wait for the next one of these and sail with it.
    """

    paths: tuple[TimedPath, ...]
    searched: int

    if not TYPE_CHECKING:
        __getattr__ = renamed_attributes(passages="paths")

    @property
    def departures(self) -> FloatArray:
        """Departures [s]."""
        return np.array([p.depart for p in self.paths])

    @property
    def arrivals(self) -> FloatArray:
        """Earliest arrivals [s]; inf where there is none."""
        return np.array([p.arrive for p in self.paths])


def arrive_together(first: TimedPath, second: TimedPath) -> bool:
    """Whether two departures arrive at one moment, or the first not at all."""
    if not first.found:
        return True  # a later departure does not arrive either
    return second.found and abs(second.arrive - first.arrive) <= _SAME_ARRIVAL


def with_earlier_departure(path: TimedPath, depart: float) -> TimedPath:
    """Return a path whose ship waits at the start since an earlier moment."""
    if not path.found:
        return replace(path, depart=depart, settled=0)
    arrive = path.node_arrive.copy()
    arrive[0] = depart
    return replace(path, depart=depart, node_arrive=arrive, settled=0)


def path_not_found(depart: float) -> TimedPath:
    """Return the path of a departure from which none arrives."""
    none = np.empty(0)
    return TimedPath(depart, math.inf, np.empty(0, np.int64), none, none)
