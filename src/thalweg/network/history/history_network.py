"""The network of routes that ships have taken, and routes between its ports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np

from thalweg.chart.approaches import line_length
from thalweg.chart.canals import CANALS
from thalweg.core.errors import InputError, NoRouteError, unknown_name_error
from thalweg.core.geodesy import Position, densify, distance
from thalweg.core.types import BoolArray, FloatArray
from thalweg.network.history.arc_search import (
    GLOBE_FACTOR,
    REVERSED_FACTOR,
    ArcGraph,
    doubt_factors,
    longer_if_repaired,
)
from thalweg.network.history.history_arcs import (
    ARC_KINDS,
    GLOBE,
    REVERSED,
    SAILED,
    HistoryArcs,
    HistoryNodes,
)
from thalweg.network.history.history_route import (
    HistoryRoute,
    check_month_and_draught,
    no_arcs_text,
    what_to_leave_out,
)
from thalweg.network.history.route_lines import following_arcs, joined_line
from thalweg.network.history.season_masks import LEAST_SAMPLES, month_notes
from thalweg.network.history.voyage_tracks import HistoryPort, PortNames
from thalweg.network.history.whole_voyages import VoyagePairs, WholeWays

#: A way over arcs of several voyages is usual up to this multiple of the way of few voyages, or of
#: the way back.
_HARDLY_LONGER: Final = 1.1
_DRAUGHT_MARGIN: Final = 1.05  # a ship may be deeper than the deepest that was seen by this factor


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
    pairs : VoyagePairs
        Pairs of ports between which ships sailed.
    """

    nodes: HistoryNodes
    arcs: HistoryArcs
    radius: float
    least: int
    summary: dict[str, Any] = field(default_factory=dict)
    pairs: VoyagePairs = field(default_factory=VoyagePairs.none)

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
        found = self._port_names.find(place)
        if len(found) == 1:
            return self.nodes.first_port + found[0]
        if not found:
            raise unknown_name_error(
                "port of the history network", place, [port.name for port in self.ports]
            )
        names = ", ".join(self.ports[k].name for k in found)
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

        The way of most voyages that sailed from the one to the other, in the month if any did then.
        Where fewer did than make a way believed, the way of least length over the arcs of other
        voyages, unless it is more than a tenth longer than theirs or than the way back; arcs of few
        voyages count 1.25 times their length, arcs sailed in the other direction only 1.5 times,
        and ways over the globe twice. Arcs of the last two kinds are used only where the way over
        sailed arcs is more than one and a half times as long, or none leads there.

        Parameters
        ----------
        start, goal : str
            Ports of the network.
        month : int, optional
            1 to 12: arcs that are closed in this month are not used; none are in a month without
            any voyage in the tracks. By default all are used.
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
        weight = self.weights(month=month, draught=draught)
        arcs = self.usual_way(*ends, weight, month=month)
        if not arcs:
            raise NoRouteError(
                f"The history network has no route from {start} to {goal}.",
                no_arcs_text(month, draught),
                f"{what_to_leave_out(month, draught)}uild the network with more tracks.",
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
        evidence = self.arcs.evidence
        check_month_and_draught(month, draught)
        seen = month if month is not None and self.months_seen[month - 1] else None
        weight = self._weights_in(seen).copy()
        if seen is not None:
            weight[~evidence.open_in[:, seen - 1]] = np.inf
        if draught is not None:
            known = evidence.draughts_known >= LEAST_SAMPLES
            weight[known & (_DRAUGHT_MARGIN * evidence.draught[:, 2] < draught)] = np.inf
        return weight

    def usual_way(
        self, start: int, goal: int, weight: FloatArray, *, month: int | None = None
    ) -> list[int]:
        """Return the arcs of the usual way between two ports; empty if there is none.

        Parameters
        ----------
        start, goal : int
            Nodes of the ports.
        weight : ndarray (A,)
            Of every arc (`weights`).
        month : int, optional
            1 to 12: the way of most voyages in it.

        Returns
        -------
        list of int
            One arc of whole voyages, or several arcs in order.
        """
        whole = self._whole.open_ways((start, goal), weight, SAILED, month)
        count = self.arcs.evidence.count
        believed = [arc for arc in whole if count[arc] >= self.least]
        if believed:
            return believed[:1]
        path = self.path(start, goal, weight)
        other = whole or self._whole.open_ways((start, goal), weight, REVERSED, month)
        if not other:
            return path
        most = _HARDLY_LONGER * self.lengths[other[0]]
        sailed = bool(path) and bool((self.arcs.kind[path] == SAILED).all())
        return path if sailed and self.lengths[path].sum() <= most else other[:1]

    def whole_ways(self, start: int, goal: int, weight: FloatArray) -> list[int]:
        """Return the open arcs of voyages that sailed from one port to another without a call.

        Parameters
        ----------
        start, goal : int
            Nodes; there are none between others than ports.
        weight : ndarray (A,)
            Of every arc, inf for those that are closed.

        Returns
        -------
        list of int
            Arcs, that of most voyages first.
        """
        return self._whole.open_ways((start, goal), weight, SAILED)

    def path(self, start: int, goal: int, weight: FloatArray) -> list[int]:
        """Return the arcs of the shortest way between two nodes; empty if there is none.

        It is the one of least weight, and has only arcs that were sailed in their direction unless
        that is more than one and a half times as long.

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
        return self._graph.path_by_sailed_arcs(
            (start, goal), weight, self.arcs.kind == SAILED, self.lengths, 2.0 * self.radius
        )

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
        index, of, evidence = np.array(arcs), self.arcs, self.arcs.evidence
        length = self.lengths[index]
        sailed = of.kind[index] == SAILED
        total = float(length.sum())
        approaches = float(of.approach[arcs[0], 0] + of.approach[arcs[-1], 1])
        unknown = np.where(of.kind[index] == GLOBE, 1.0, of.repaired[index])
        start, goal = (self.ports[node - self.nodes.first_port] for node in ends)
        at_junction = of.head[index[:-1]] < self.nodes.first_port
        line = tuple(joined_line(of.lines, index, at_junction, self.radius))
        nodes = [int(of.tail[index[0]]), *of.head[index].tolist()]
        p10, p50, p90 = np.where(sailed[:, None], evidence.duration[index], np.nan).sum(axis=0)
        is_whole = len(arcs) == 1 and ends in self._whole.between
        names = self._names_passed(self._named_beside(line) if is_whole else nodes)
        whole = int(evidence.count[arcs[0]])
        if not is_whole:
            whole, duration = self.pairs.of(*ends)
            if whole >= LEAST_SAMPLES:
                p10, p50, p90 = duration
        elif not sailed[0]:
            whole = 0 if of.kind[arcs[0]] == GLOBE else -whole
        return HistoryRoute(
            start,
            goal,
            tuple(arcs),
            line_length(line) + approaches + float((length - of.length[index]).sum()),
            (float(p10), float(p50), float(p90)),
            int(np.where(sailed, evidence.count[index], 0).min()),
            float((unknown * length).sum() / total),
            float((of.eca_share[index] * length).sum() / total),
            line,
            names,
            None if month is None else int(evidence.months[index, month - 1].min()),
            month_notes(self.months_seen, month),
            whole,
        )

    def _named_beside(self, line: Sequence[Position]) -> list[int]:
        """Return the named junctions within the radius of a line, in the order along it."""
        places = np.array(line)
        lat, lon, _ = densify(places[:, 0], places[:, 1], 0.25 * self.radius)
        named = [k for k, name in enumerate(self.nodes.names) if name]
        away = {k: distance(self.nodes.lat[k], self.nodes.lon[k], lat, lon) for k in named}
        near = [k for k in named if away[k].min() <= self.radius]
        return sorted(near, key=lambda k: int(np.argmin(away[k])))

    def _names_passed(self, nodes: Sequence[int]) -> tuple[str, ...]:
        """Return the corridors and canals of a way; of a canal it has both ends in turn."""
        names, canals = [self.nodes.names[node] for node in nodes], {c.name for c in CANALS}
        after = [*names[1:], ""]
        passed = [name for name, then in zip(names, after) if name == then or name not in canals]
        return tuple(dict.fromkeys(name for name in passed if name))

    @cached_property
    def lengths(self) -> FloatArray:
        """Length of each arc (A,) [m]: of its line, or of the voyages where it meets a canal.

        The line leads straight from one end of a canal to the other, and ships may turn into it
        before its end. Of lines that were repaired the longer of both counts.
        """
        arcs, canals = self.arcs, {canal.name for canal in CANALS}
        at_canal = np.array([name in canals for name in self.nodes.names], bool)
        meets = at_canal[arcs.tail] | at_canal[arcs.head]
        return np.where(meets, longer_if_repaired(arcs.evidence, arcs.length, arcs.repaired),
                        arcs.length)  # fmt: skip

    def _weights_in(self, month: int | None) -> FloatArray:
        """Return what arcs count by length, kind, and voyages in a month (None: in all), (A,)."""
        if month not in self._known_weights:
            arcs, evidence = self.arcs, self.arcs.evidence
            factor = doubt_factors(
                (arcs.tail, arcs.head),
                evidence.count if month is None else evidence.months[:, month - 1],
                self.lengths,
                following_arcs(arcs.tail, arcs.head, self._at_port),
                few=evidence.count < self.least,
                slack=2.0 * self.radius,
            )
            factor[arcs.kind == REVERSED] = REVERSED_FACTOR
            factor[arcs.kind == GLOBE] = GLOBE_FACTOR
            self._known_weights[month] = self.lengths * factor + arcs.approach.sum(axis=1)
        return self._known_weights[month]

    @cached_property
    def _known_weights(self) -> dict[int | None, FloatArray]:
        return {}

    @cached_property
    def _whole(self) -> WholeWays:
        return WholeWays.of_arcs(self.arcs, self.nodes.first_port)

    @cached_property
    def _at_port(self) -> BoolArray:
        return np.arange(len(self.nodes)) >= self.nodes.first_port

    @cached_property
    def months_seen(self) -> BoolArray:
        """Whether any voyage was seen in each month, on any arc, (12,)."""
        return np.asarray(self.arcs.evidence.months.any(axis=0))

    @cached_property
    def _graph(self) -> ArcGraph:
        arcs = self.arcs
        return ArcGraph.of_arcs(arcs.tail, arcs.head, arcs.lines, self._at_port)

    @cached_property
    def _port_names(self) -> PortNames:
        return PortNames.of_ports(self.ports)
