"""The network of routes that ships have taken, and routes between its ports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np

from thalweg.chart.canals import CANALS
from thalweg.chart.port_names import normalised_port_name
from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError, NoRouteError, unknown_name_error
from thalweg.core.geodesy import Position
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.network.static_paths import static_astar
from thalweg.network.history.arc_lines import ArcLines
from thalweg.network.history.arc_statistics import ArcEvidence
from thalweg.network.history.history_route import HistoryRoute
from thalweg.network.history.season_masks import LEAST_SAMPLES
from thalweg.network.history.voyage_tracks import HistoryPort

#: How an arc is known: sailed in this direction, sailed in the other direction only, or a shortest
#: way over the globe where no track is known.
ARC_KINDS: Final = ("sailed", "reversed", "globe")
SAILED, REVERSED, GLOBE = range(3)
#: Arcs of fewer voyages, and arcs of other kinds, count this many times their length in the
#: choice of the way.
_DOUBT: Final = {"few": 1.25, "reversed": 1.5, "globe": 2.0}
_DRAUGHT_MARGIN: Final = 1.05  # a ship may be deeper than the deepest that was seen by this factor


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
        """Usual length (A,) [m]: the median of the voyages; of the line where it was not sailed.

        Of lines that were repaired the longer of both, because tracks with gaps cut over land.
        """
        median, line = self.evidence.length[:, 1], self.lines.lengths
        repaired = np.where(self.repaired > 0.0, np.fmax(median, line), median)
        return np.where(np.isfinite(median), repaired, line)


@dataclass(frozen=True, eq=False)
class HistoryNetwork:
    """A network of the routes that ships have taken.

    Parameters
    ----------
    nodes : HistoryNodes
        Junctions and ports.
    arcs : HistoryArcs
        Directed arcs between them.
    radius : float
        Radius of a junction [m].
    least : int
        Arcs with fewer voyages count as longer when a route is chosen.
    summary : dict
        How it was made: counts of voyages, positions, outliers, repaired arcs; period; notes.
    """

    nodes: HistoryNodes
    arcs: HistoryArcs
    radius: float
    least: int
    summary: dict[str, Any] = field(default_factory=dict)

    @property
    def ports(self) -> tuple[HistoryPort, ...]:
        """The ports."""
        return self.nodes.ports

    def arcs_by_kind(self) -> dict[str, int]:
        """Return how many arcs are sailed, reversed, and ways over the globe.

        Returns
        -------
        dict of str to int
            By the names of `ARC_KINDS`.
        """
        counts = np.bincount(self.arcs.kind, minlength=len(ARC_KINDS)).tolist()
        return dict(zip(ARC_KINDS, counts))

    def port_node(self, place: str) -> int:
        """Return the node of a port.

        Parameters
        ----------
        place : str
            UN/LOCODE, or the name with or without the country.

        Returns
        -------
        int
            Node.

        Raises
        ------
        InputError
            If the network does not have this port, or several of this name.
        """
        found = self._by_name.get(normalised_port_name(place), []) or self._by_other_name(place)
        if len(found) == 1:
            return found[0]
        if not found:
            raise unknown_name_error(
                "port of the history network", place, [port.name for port in self.ports]
            )
        names = ", ".join(self.ports[k - self.nodes.first_port].name for k in found)
        raise InputError(
            f"The name {place!r} fits several ports of the history network.",
            f"They are {names}.",
            "Give the country as well, or the UN/LOCODE.",
        )

    def route(
        self,
        start: str,
        goal: str,
        *,
        month: int | None = None,
        draught: float | None = None,
    ) -> HistoryRoute:
        """Return the usual route between two ports.

        The way of least length over the arcs; arcs of few voyages count 1.25 times their length,
        arcs sailed in the other direction only 1.5 times, and ways over the globe twice.

        Parameters
        ----------
        start, goal : str
            Ports of the network.
        month : int, optional
            1 to 12: arcs that are closed in this month are not used. By default all are.
        draught : float, optional
            [m]. Arcs on which at least ten draughts are known and all are smaller are not used.

        Returns
        -------
        HistoryRoute

        Raises
        ------
        InputError
            For unknown ports and months.
        NoRouteError
            If there is no way.
        """
        ends = self.port_node(start), self.port_node(goal)
        if ends[0] == ends[1]:
            raise InputError(
                f"Start and goal are the same port, {start}.",
                "A route joins two ports.",
                "Give two different ports.",
            )
        arcs = self.path(*ends, self.weights(month=month, draught=draught))
        if not arcs:
            raise NoRouteError(
                f"The history network has no route from {start} to {goal}.",
                no_arcs_text(month, draught),
                f"{_what_to_leave_out(month, draught)}uild the network with more tracks.",
            )
        return self.route_along(ends, arcs, month=month)

    def weights(self, *, month: int | None = None, draught: float | None = None) -> FloatArray:
        """Return what arcs count in the choice of the way; inf for those that are closed.

        Parameters
        ----------
        month : int, optional
            1 to 12.
        draught : float, optional
            [m].

        Returns
        -------
        float64 ndarray (A,)
            [m].
        """
        weight = self._weights.copy()
        evidence = self.arcs.evidence
        if month is not None:
            if not 1 <= month <= 12:
                raise InputError(
                    f"The month is {month!r}.", "Months are 1 to 12.", "Give one of them."
                )
            weight[~evidence.open_in[:, month - 1]] = np.inf
        if draught is not None:
            known = evidence.draughts_known >= LEAST_SAMPLES
            weight[known & (_DRAUGHT_MARGIN * evidence.draught[:, 2] < draught)] = np.inf
        return weight

    def path(self, start: int, goal: int, weight: FloatArray) -> list[int]:
        """Return the arcs of the shortest way between two nodes; empty if there is none.

        Parameters
        ----------
        start, goal : int
            Nodes.
        weight : ndarray (A,)
            Of every arc.

        Returns
        -------
        list of int
            Arcs in order.
        """
        order, indptr = self._by_tail
        count = len(self.nodes)
        known, parent = np.empty(count), np.empty(count, np.int64)
        by_tail = weight[order]
        static_astar(indptr, self._heads, by_tail, np.zeros(count), start, goal, known, parent)
        arcs: list[int] = []
        node = goal
        while node != start:
            before = int(parent[node])
            if before < 0 or not np.isfinite(known[node]):
                return []
            leaving = slice(int(indptr[before]), int(indptr[before + 1]))
            cost = np.where(self._heads[leaving] == node, by_tail[leaving], np.inf)
            arcs.append(int(order[leaving][np.argmin(cost)]))
            node = before
        return arcs[::-1]

    def route_along(
        self, ends: tuple[int, int], arcs: Sequence[int], *, month: int | None = None
    ) -> HistoryRoute:
        """Return the route between two ports along given arcs.

        Parameters
        ----------
        ends : (int, int)
            Nodes of the ports.
        arcs : sequence of int
            From `path`, at least one.
        month : int, optional
            1 to 12, to count the voyages in that month.

        Returns
        -------
        HistoryRoute
        """
        index = np.array(arcs)
        of, evidence = self.arcs, self.arcs.evidence
        length = of.length[index]
        sailed = of.kind[index] == SAILED
        total = float(length.sum())
        approaches = float(of.approach[arcs[0], 0] + of.approach[arcs[-1], 1])
        unknown = np.where(of.kind[index] == GLOBE, 1.0, of.repaired[index])
        start, goal = (self.ports[node - self.nodes.first_port] for node in ends)
        line: list[Position] = []
        for arc in arcs:
            lat, lon = of.lines.of(arc)
            places = list(zip(lat.tolist(), lon.tolist()))
            line += places if not line else places[1:]
        names = self._names_passed([int(of.tail[index[0]]), *of.head[index].tolist()])
        p10, p50, p90 = np.where(sailed[:, None], evidence.duration[index], np.nan).sum(axis=0)
        return HistoryRoute(
            start,
            goal,
            tuple(arcs),
            total + approaches,
            (float(p10), float(p50), float(p90)),
            int(np.where(sailed, evidence.count[index], 0).min()),
            float((unknown * length).sum() / total),
            float((of.eca_share[index] * length).sum() / total),
            tuple(line),
            names,
            None if month is None else int(evidence.months[index, month - 1].min()),
        )

    def _names_passed(self, nodes: Sequence[int]) -> tuple[str, ...]:
        """Return the corridors and canals of a way; of a canal it has both ends in turn."""
        names, canals = [self.nodes.names[node] for node in nodes], {c.name for c in CANALS}
        after = [*names[1:], ""]
        passed = [name for name, then in zip(names, after) if name == then or name not in canals]
        return tuple(dict.fromkeys(name for name in passed if name))

    def _by_other_name(self, place: str) -> list[int]:
        """Return the node of a port that the World Port Index has under another name."""
        try:
            port = PORTS.lookup(place)
        except InputError:
            return []
        return self._by_name.get(normalised_port_name(port.locode), []) or self._by_name.get(
            normalised_port_name(port.label), []
        )

    @cached_property
    def _weights(self) -> FloatArray:
        arcs = self.arcs
        few = arcs.evidence.count < self.least
        factor = np.where(few, _DOUBT["few"], 1.0)
        factor[arcs.kind == REVERSED] = _DOUBT["reversed"]
        factor[arcs.kind == GLOBE] = _DOUBT["globe"]
        return arcs.length * factor + arcs.approach.sum(axis=1)

    @cached_property
    def _by_tail(self) -> tuple[IntArray, IntArray]:
        """Return the arcs in order of their tails, and where those of each node begin."""
        order = np.argsort(self.arcs.tail, kind="stable")
        indptr = np.searchsorted(self.arcs.tail[order], np.arange(len(self.nodes) + 1))
        return order, indptr.astype(np.int64)

    @cached_property
    def _heads(self) -> np.ndarray:
        return self.arcs.head[self._by_tail[0]].astype(np.int32)

    @cached_property
    def _by_name(self) -> dict[str, list[int]]:
        found: dict[str, list[int]] = {}
        for number, port in enumerate(self.ports):
            node = self.nodes.first_port + number
            names = {
                normalised_port_name(port.name),
                normalised_port_name(port.name.rpartition(",")[0]),
                normalised_port_name(port.locode),
            }
            for name in names - {""}:
                found.setdefault(name, []).append(node)
        return found


def no_arcs_text(month: int | None, draught: float | None) -> str:
    """Return that no open arcs join two places, in the month and for the draught [m] in use."""
    limits = [] if month is None else [f"open in month {month}"]
    limits += [] if draught is None else [f"deep enough for a draught of {draught:g} m"]
    return f"No arcs join them that are {' and '.join(limits)}." if limits else "No arcs join them."


def _what_to_leave_out(month: int | None, draught: float | None) -> str:
    given = [name for name, one in (("month", month), ("draught", draught)) if one is not None]
    return f"Leave out the {' or the '.join(given)}, or b" if given else "B"
