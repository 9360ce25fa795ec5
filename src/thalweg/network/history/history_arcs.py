"""Nodes and arcs of a history network."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from thalweg.core.types import FloatArray, IntArray
from thalweg.network.history.arc_lines import ArcLines
from thalweg.network.history.arc_statistics import ArcEvidence
from thalweg.network.history.voyage_tracks import HistoryPort

#: How an arc is known: sailed in this direction, sailed in the other direction only, or a shortest
#: way over the globe where no track is known.
ARC_KINDS: Final = ("sailed", "reversed", "globe")
SAILED, REVERSED, GLOBE = range(3)


@dataclass(frozen=True, eq=False)
class HistoryNodes:
    """Nodes: junctions first, then ports.

    Parameters
    ----------
    lat, lon : Positions [deg], (N,).
    names : Names of corridors and canals; empty for clusters of turning points and for ports.
    ports : The last nodes.
    """

    lat: FloatArray
    lon: FloatArray
    names: tuple[str, ...]
    ports: tuple[HistoryPort, ...]

    def __len__(self) -> int:
        return len(self.lat)

    @property
    def approach(self) -> FloatArray:
        """Length of the approach of every node [m], (N,); 0 at junctions."""
        return np.append(np.zeros(self.first_port), [port.approach_m for port in self.ports])

    @property
    def first_port(self) -> int:
        """Node of the first port."""
        return len(self.lat) - len(self.ports)


@dataclass(frozen=True, eq=False)
class HistoryArcs:
    """Directed arcs, A in total.

    Parameters
    ----------
    tail, head : Nodes, (A,).
    kind : Index in `ARC_KINDS`, (A,).
    lines : The line of every arc.
    evidence : What was seen.
    tube : p5 and p95 of the distance of tracks to starboard of the line [m], (A, 9, 2).
    eca_share, repaired : Shares of the line inside emission control areas (NaN: unknown), and of
        ways over the globe in place of tracks over land, (A,).
    approach : Length from the berth of a port to the first place of the line, and from the last one
        to a berth [m], (A, 2); 0 at junctions.
    """

    tail: IntArray
    head: IntArray
    kind: IntArray
    lines: ArcLines
    evidence: ArcEvidence
    tube: FloatArray
    eca_share: FloatArray
    repaired: FloatArray
    approach: FloatArray

    def __len__(self) -> int:
        return len(self.tail)

    @cached_property
    def length(self) -> FloatArray:
        """Length of the line of each arc (A,) [m], which is that of a voyage in the middle."""
        return self.lines.lengths
