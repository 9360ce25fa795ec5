"""The network of routes that ships have taken, and routes between its ports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from thalweg.core.errors import InputError, NoRouteError, unknown_name_error
from thalweg.core.geodesy import line_length
from thalweg.core.types import BoolArray, FloatArray
from thalweg.network.history.arc_search import (
    GLOBE_FACTOR,
    REVERSED_FACTOR,
    ArcGraph,
    doubt_factors,
)
from thalweg.network.history.history_arcs import (
    ARC_KINDS,
    GLOBE,
    MOSTLY,
    REVERSED,
    SAILED,
    HistoryArcs,
    HistoryNodes,
    canal_arcs,
    named_beside,
    names_on_way,
    usual_lengths,
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
from thalweg.network.history.whole_voyages import CanalWays, VoyagePairs, WholeWays

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
        Pairs of ports between which ships sailed through a canal.
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
        """Return how many arcs there are of each of `ARC_KINDS`.

        Returns
        -------
        dict of str to int
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

        The way of most voyages that sailed from the one to the other, in the month if any did then;
        through a canal, over the arcs that lead there. Where fewer did than make a way believed,
        the way of least length over the arcs of other voyages, unless it is more than a tenth
        longer than theirs or than the way back; arcs of few voyages count 1.25 times their length,
        arcs sailed in the other direction only 1.5 times, and ways over the globe twice. Arcs of
        the last two kinds are used only where the way over sailed arcs is more than one and a half
        times as long, or none leads there.

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
        self.whole.check_draught(self.nodes, ends, draught, weight)
        arcs = self.usual_way(*ends, weight, month=month)
        if not arcs:
            raise NoRouteError(
                f"The history network has no route from {start} to {goal}.",
                no_arcs_text(month, draught),
                f"{what_to_leave_out(month, draught)}uild the network with more tracks.",
            )
        found = self.route_along(ends, arcs, month=month)
        beside = "" if found.whole > 0 else self.whole.note_beside(self.nodes, ends, self.least)
        return replace(found, notes=(*found.notes, beside)) if beside else found

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
        """
        whole = self.whole.open_ways((start, goal), weight, SAILED, month)
        count = self.arcs.evidence.count
        believed = [arc for arc in whole if count[arc] >= self.least]
        by_canal = self.pairs.voyages(start, goal, month)
        if by_canal[1] >= self.least and (
            not believed or by_canal > self.whole.voyages(believed[0], month)
        ):
            path = self._by_canal.shortest((start, goal), weight)
            if path:
                return path
        if believed:
            return believed[:1]
        path = self.path(start, goal, weight)
        other = whole or self.whole.open_ways((start, goal), weight, REVERSED, month)
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
        return self.whole.open_ways((start, goal), weight, SAILED)

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
        is_whole = len(arcs) == 1 and ends in self.whole.between
        names = names_on_way(
            self.nodes, named_beside(self.nodes, line, self.radius) if is_whole else nodes
        )
        whole = int(evidence.count[arcs[0]])
        if not is_whole:
            whole, duration = (
                self.pairs.of(*ends)
                if set(arcs) & set(canal_arcs(self.nodes, of).tolist())
                else (self.whole.count_between(*ends), None)
            )
            if duration is not None and whole >= LEAST_SAMPLES:
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

    @cached_property
    def lengths(self) -> FloatArray:
        """Usual length of each arc (A,) [m] (`usual_lengths`)."""
        return usual_lengths(self.nodes, self.arcs, self.radius)

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
            factor[(arcs.kind == GLOBE) | (arcs.repaired > MOSTLY)] = GLOBE_FACTOR
            self._known_weights[month] = self.lengths * factor + arcs.approach.sum(axis=1)
        return self._known_weights[month]

    @cached_property
    def _known_weights(self) -> dict[int | None, FloatArray]:
        return {}

    @cached_property
    def _by_canal(self) -> CanalWays:
        canal = canal_arcs(self.nodes, self.arcs)
        enough = self.arcs.evidence.count[canal] >= self.least
        return CanalWays(self.arcs, canal[enough], self.path)

    @cached_property
    def whole(self) -> WholeWays:
        """The arcs from port to port."""
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
