"""Nodes and arcs of a history network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from thalweg.chart.canals import CANALS
from thalweg.core.geodesy import Position, densify, distance
from thalweg.core.types import FloatArray, IntArray
from thalweg.network.history.arc_lines import ArcLines
from thalweg.network.history.arc_statistics import ArcEvidence
from thalweg.network.history.voyage_tracks import HistoryPort

#: How an arc is known: sailed in this direction, sailed in the other direction only, or a shortest
#: way over the globe where no track is known.
ARC_KINDS: Final = ("sailed", "reversed", "globe")
SAILED, REVERSED, GLOBE = range(3)
MOSTLY: Final = 0.5  #: an arc with more of its line over land than this is hardly a track


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


def canal_arcs(nodes: HistoryNodes, arcs: HistoryArcs) -> IntArray:
    """Return the arcs from one end of a canal to the other."""
    canals = {canal.name for canal in CANALS}
    name = np.array([one if one in canals else "" for one in nodes.names])
    return np.flatnonzero((name[arcs.tail] == name[arcs.head]) & (name[arcs.tail] != ""))


def usual_lengths(nodes: HistoryNodes, arcs: HistoryArcs, radius: float) -> FloatArray:
    """Return the length of each arc (A,) [m]: of its line, or of the voyages beside a canal.

    The line leads straight from one end of a canal to the other, and ships may turn into it before
    its end. Of lines that were repaired the longer of both counts, but not of ports beside a canal,
    within the radius [m].
    """
    canals = {canal.name for canal in CANALS}
    at_canal = np.array([name in canals for name in nodes.names], bool)
    median = np.where(np.isfinite(arcs.evidence.length[:, 1]), arcs.evidence.length[:, 1],
                      arcs.length)  # fmt: skip
    longer = np.where(arcs.repaired > 0.0, np.maximum(median, arcs.length), median)
    voyage = np.where(median <= radius, median, longer)
    return np.where(at_canal[arcs.tail] | at_canal[arcs.head], voyage, arcs.length)


def names_on_way(nodes: HistoryNodes, way: Sequence[int]) -> tuple[str, ...]:
    """Return the corridors and canals of a way over nodes; of a canal it has both ends in turn."""
    names, canals = [nodes.names[node] for node in way], {canal.name for canal in CANALS}
    after = [*names[1:], ""]
    passed = [name for name, then in zip(names, after) if name == then or name not in canals]
    return tuple(dict.fromkeys(name for name in passed if name))


def named_beside(nodes: HistoryNodes, line: Sequence[Position], radius: float) -> list[int]:
    """Return the named junctions within a radius [m] of a line, in the order along it."""
    places = np.array(line)
    lat, lon, _ = densify(places[:, 0], places[:, 1], 0.25 * radius)
    named = [k for k, name in enumerate(nodes.names) if name]
    away = {k: distance(nodes.lat[k], nodes.lon[k], lat, lon) for k in named}
    near = [k for k in named if away[k].min() <= radius]
    return sorted(near, key=lambda k: int(np.argmin(away[k])))
