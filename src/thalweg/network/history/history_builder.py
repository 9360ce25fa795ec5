"""The builder of history networks: from tracks of voyages to nodes and arcs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.history.arc_lines import GlobeWays, LinesOffLand, lines_off_land
from thalweg.network.history.arc_statistics import ArcEvidence, FoundArcs, arcs_of_occurrences
from thalweg.network.history.history_arcs import MOSTLY, SAILED, HistoryArcs, HistoryNodes
from thalweg.network.history.history_network import HistoryNetwork
from thalweg.network.history.junction_visits import arc_occurrences
from thalweg.network.history.junctions import CorridorLine, Junctions, find_junctions
from thalweg.network.history.missing_arcs import connected_arcs
from thalweg.network.history.sailed_lines import LineRules, lines_as_sailed
from thalweg.network.history.stretch_ends import EndFinder
from thalweg.network.history.turning_points import turning_points
from thalweg.network.history.voyage_tracks import HistoryPort, VoyageTracks
from thalweg.network.history.whole_voyages import with_whole_voyages

if TYPE_CHECKING:
    from thalweg.chart import Chart

_LEAST_RADIUS: Final = 0.1 * NAUTICAL_MILE
_LARGEST_RADIUS: Final = 100.0 * NAUTICAL_MILE


@dataclass(frozen=True)
class HistoryRules:
    """Rules by which a history network is made.

    Attributes
    ----------
    radius : float
        Radius of a junction [m].
    tolerance : float
        Turning points keep tracks within this distance [m].
    least : int
        Fewest voyages that make a junction. Of the arcs between two nodes, those with fewer
        voyages are left out, except the one with the most.
    """

    radius: float = 10.0 * NAUTICAL_MILE
    tolerance: float = 2.0 * NAUTICAL_MILE
    least: int = 3

    def __post_init__(self) -> None:
        good = _LEAST_RADIUS <= self.radius <= _LARGEST_RADIUS
        if not (good and 0.0 < self.tolerance <= self.radius and self.least >= 1):
            raise InputError(
                f"The radius of junctions is {self.radius / NAUTICAL_MILE:g} nm, the tolerance "
                f"{self.tolerance / NAUTICAL_MILE:g} nm and the least number of voyages "
                f"{self.least}.",
                "The radius is 0.1 to 100 nm, the tolerance above 0 and at most the radius, and "
                "the least number of voyages at least 1.",
                "Correct them.",
            )


def build_history(
    chart: Chart,
    tracks: VoyageTracks,
    ports: Sequence[HistoryPort],
    *,
    rules: HistoryRules | None = None,
    corridors: Sequence[CorridorLine] = (),
    progress: Callable[[str], None] | None = None,
) -> HistoryNetwork:
    """Return the network of the routes of voyages.

    Nodes are the ports, the ends of canals, the corridors, and clusters of turning points. Every
    track is divided where it passes a node. Of the parts between the same two nodes in the same
    direction the medoid is the line of the arc; its counts, percentiles of length and time, months
    and sizes of ships are those of all parts. Whole voyages between the same two ports are arcs as
    well. Every leg of every line is tested against land.

    Parameters
    ----------
    chart : Chart
        Land, canals and emission control areas.
    tracks : VoyageTracks
        At least one voyage.
    ports : sequence of HistoryPort
        Those that the tracks count; ports without a voyage are joined by ways over the globe.
    rules : HistoryRules, optional
    corridors : sequence of CorridorLine, optional
        Lines across straits or other places that ships pass.
    progress : callable, optional
        Called with a short text at each stage.

    Returns
    -------
    HistoryNetwork
        In which every port reaches every other, as far as the chart allows.

    Raises
    ------
    InputError
        If there is no voyage, or no arc is left.

    References
    ----------
    Seuren (2020), appendix G, with clusters of turning points for nodes, directed arcs, and exact
    land tests.
    """
    rules = rules or HistoryRules()
    report = progress or (lambda text: None)
    if not len(tracks):
        raise InputError(
            "There is no voyage between two ports in the tracks.",
            "A voyage begins and ends with a stop at a port, or with the end of a track near one.",
            "Check the ports, and the rules for stops.",
        )
    report("finding turning points and junctions")
    turning = turning_points(tracks, rules.tolerance)
    junctions = find_junctions(
        chart, tracks, turning, radius=rules.radius, least=rules.least, corridors=corridors
    )
    report("dividing the tracks at the junctions")
    occurrences, by_canal = arc_occurrences(tracks, junctions, ports, radius=rules.radius)
    occurrences, pairs = with_whole_voyages(
        tracks, occurrences, len(junctions), by_canal, least=rules.least
    )
    sailed = arcs_of_occurrences(
        tracks, occurrences, radius=rules.radius, least=rules.least, first_port=len(junctions)
    )
    report("testing the arcs against land")
    places = (
        np.append(junctions.lat, [port.lat for port in ports]),
        np.append(junctions.lon, [port.lon for port in ports]),
    )
    ways = GlobeWays(chart)
    finder = EndFinder(chart, tracks, places, ports, junctions.canal_ends)
    tested = lines_off_land(
        chart, tracks, occurrences, sailed.candidates, finder=finder, turning=turning,
        radius=rules.radius, ways=ways,
    )  # fmt: skip
    approach = finder.ends(occurrences.take(tested.source)).approach
    number = np.arange(len(junctions) + len(ports))
    fixed = (number < junctions.canal_ends) | (number >= len(junctions))
    tested = lines_as_sailed(
        chart, tracks, occurrences, tested, finder=finder, fixed=fixed,
        rules=LineRules(rules.radius, rules.tolerance), ways=ways,
    )  # fmt: skip
    at_port = sailed.tail >= len(junctions), sailed.head >= len(junctions)
    lost = (at_port[0] & at_port[1])[tested.arc] & (tested.repaired > MOSTLY)  # as in canals
    arcs = _sailed_arcs(chart, sailed, tested.take(~lost), approach[~lost])
    pairs = pairs.with_arcs(sailed, tested.arc[lost])
    report("connecting the network")
    nodes = HistoryNodes(*places, (*junctions.names, *([""] * len(ports))), tuple(ports))
    used = range(nodes.first_port, len(nodes))
    arcs, alone = connected_arcs(
        chart, arcs, places, used, ways, node_approach=finder.node_approach, radius=rules.radius
    )
    notes = [f"{ports[k - nodes.first_port].name} cannot be reached by sea."
             for k in alone if k >= nodes.first_port]  # fmt: skip
    summary = _summary(tracks, sailed, tested, junctions) | {"notes": notes}
    return _without_unused(HistoryNetwork(nodes, arcs, rules.radius, rules.least, summary, pairs))


def _sailed_arcs(
    chart: Chart, sailed: FoundArcs, tested: LinesOffLand, approach: FloatArray
) -> HistoryArcs:
    """Return the arcs whose lines are allowed."""
    arc = tested.arc
    evidence = ArcEvidence(
        *(getattr(sailed.evidence, column.name)[arc] for column in fields(ArcEvidence))
    )
    return HistoryArcs(
        sailed.tail[arc],
        sailed.head[arc],
        np.full(len(arc), SAILED, np.int64),
        tested.lines,
        evidence,
        sailed.tube[arc],
        tested.lines.control_area_shares(chart),
        tested.repaired,
        approach,
    )


def _summary(
    tracks: VoyageTracks, sailed: FoundArcs, tested: LinesOffLand, junctions: Junctions
) -> dict[str, Any]:
    return {
        "voyages": len(tracks),
        "positions": len(tracks.lat),
        "first": format_time(float(tracks.time.min())),
        "last": format_time(float(tracks.time.max())),
        "junctions": len(junctions),
        "outliers": sailed.outliers,
        "arcs_repaired": int((tested.repaired > 0.0).sum()),
        "arcs_without_a_line": int(len(sailed.tail) - len(tested.arc)),
    }


def _without_unused(network: HistoryNetwork) -> HistoryNetwork:
    """Return a network without junctions that no arc uses."""
    nodes, arcs = network.nodes, network.arcs
    keep = np.zeros(len(nodes), bool)
    keep[arcs.tail] = keep[arcs.head] = True
    keep[nodes.first_port :] = True
    number: IntArray = np.cumsum(keep) - 1
    names = tuple(name for name, good in zip(nodes.names, keep.tolist()) if good)
    left = HistoryNodes(nodes.lat[keep], nodes.lon[keep], names, nodes.ports)
    new = HistoryArcs(
        number[arcs.tail], number[arcs.head], arcs.kind, arcs.lines, arcs.evidence, arcs.tube,
        arcs.eca_share, arcs.repaired, arcs.approach,
    )  # fmt: skip
    of = network.pairs
    pairs = replace(of, tail=number[of.tail], head=number[of.head])
    return HistoryNetwork(left, new, network.radius, network.least, network.summary, pairs)
