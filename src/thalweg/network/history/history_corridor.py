"""The water that ships usually use between two places, as a network for searches and as a zone."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core import geodesy
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError, NoPathError
from thalweg.core.geodesy import METRES_PER_DEGREE, Position, format_position
from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.codes import NO_GO, REASONS
from thalweg.network.assembly import (
    DirectedEdges,
    Pairs,
    allowed_legs,
    assemble,
    evenly_spaced_samples,
    measured_pairs,
)
from thalweg.network.history.arc_lines import GlobeWays
from thalweg.network.history.corridor_ways import (
    LANES,
    CorridorWays,
    arcs_between,
    strip_polygons,
)
from thalweg.network.history.history_arcs import canal_arcs
from thalweg.network.history.history_network import HistoryNetwork
from thalweg.network.history.history_route import no_arcs_text
from thalweg.network.history.missing_arcs import globe_arcs, joined_arcs
from thalweg.network.history.voyage_tracks import sphere_vectors
from thalweg.network.network import Graph, Network, NetworkMeta, Stations
from thalweg.network.shortest_paths import shortest_path

if TYPE_CHECKING:
    from thalweg.chart import Chart

_AT_NODE: Final = 2.0 * NAUTICAL_MILE  # ends this near to a node are that node
_LINKS: Final = 3  # nodes to which another end is joined
_REACH: Final = 2  # lanes that an edge may cross
_STATIONS: Final = 150.0  # along the whole way, at least
_LEAST_SPACING: Final = 5.0 * NAUTICAL_MILE
_PIECES_PER_EDGE: Final = 2  # pieces in which every edge is sampled
_TOUCH: Final = 1e-5  # by which parts of the tube overlap [deg]
_AT_END: Final = 10.0  # of a canal [m]
_SELDOM: Final = 0.2  # of the voyages of the usual way: other ways of fewer are left out
_APPROACH_WIDTH: Final = 1.0 * NAUTICAL_MILE


@dataclass(frozen=True, eq=False)
class HistoryCorridor:
    """Plan in the water that ships usually use.

    Parameters
    ----------
    network : HistoryNetwork
        The usual routes.
    gain : float, optional
        A route outside the corridor is taken if it is better by more than this share of the
        objective, above 0. By default the plan stays inside.
    longest : float
        Ways up to this multiple of the usual length belong to the corridor.
    month : int, optional
        1 to 12; arcs closed in it do not belong to the corridor.
    draught : float, optional
        [m].
    """

    network: HistoryNetwork
    gain: float | None = None
    longest: float = 1.1
    month: int | None = None
    draught: float | None = None

    def __post_init__(self) -> None:
        if self.gain is not None and not 0.0 <= self.gain < 1.0:
            raise InputError(
                f"The gain for which a plan leaves the corridor is {self.gain!r}.",
                "It is a share of the objective, 0 to 1 (on the command line 0 to 100 %).",
                "Correct it, or leave it out to stay in the corridor.",
            )

    def ways_between(self, chart: Chart, start: Position, goal: Position) -> CorridorWays:
        """Return the arcs of the corridor between two places.

        Parameters
        ----------
        chart : Chart
            Gives the ways by sea that join places beside the network.
        start, goal : (lat, lon)
            [deg].

        Returns
        -------
        CorridorWays

        Raises
        ------
        NoPathError
            If no way is open in this month and for this draught.
        """
        network = self.network
        lat, lon = network.nodes.lat.copy(), network.nodes.lon.copy()
        arcs, weight = network.arcs, network.weights(month=self.month, draught=self.draught)
        open_here = {canal.name for canal in chart.canals}
        for canal in canal_arcs(network.nodes, arcs).tolist():
            if network.nodes.names[arcs.tail[canal]] not in open_here:
                weight[canal] = np.inf
        ends: list[int] = []
        links = []
        vectors = sphere_vectors(lat, lon)
        ways = GlobeWays(chart)
        apart = [
            np.sqrt(np.sum((vectors - sphere_vectors(*np.array([place]).T)) ** 2, axis=1))
            for place in (start, goal)
        ]
        busiest = self._busiest_ports(*apart)
        for place, outward in ((start, True), (goal, False)):
            away = apart[0 if outward else 1]
            nearest = int(np.argmin(away)) if busiest is None else busiest[0 if outward else 1]
            end_of_canal = any(
                float(geodesy.distance(lat[nearest], lon[nearest], *end)) <= _AT_END
                for canal in chart.canals
                for end in canal.ends
            )  # stays where the canal begins
            if away[nearest] <= _AT_NODE and not end_of_canal:
                lat[nearest], lon[nearest] = place
                ends.append(nearest)
                continue
            ends.append(len(lat))
            for node in np.argsort(away)[:_LINKS].tolist():
                way = ways.between(place, (float(lat[node]), float(lon[node])))
                if way is not None:
                    links.append((ends[-1], node, way) if outward else (node, ends[-1], way[::-1]))
            lat, lon = np.append(lat, place[0]), np.append(lon, place[1])
        if max(ends) < len(network.nodes):
            network.whole.check_draught(network.nodes, (ends[0], ends[1]), self.draught, weight)
        if links:
            more = globe_arcs(chart, links, np.zeros(len(lat)))
            arcs, weight = joined_arcs([arcs, more]), np.append(weight, more.length)
        kept = self._whole_voyages(ends[0], ends[1], weight)
        if not len(kept):
            kept = arcs_between(len(lat), arcs, weight, (ends[0], ends[1]), self.longest)
        if not len(kept):
            raise NoPathError(
                f"The history network has no way from {format_position(*start)} to "
                f"{format_position(*goal)}.",
                no_arcs_text(self.month, self.draught),
                "Plan on another network, or build the history network with more tracks.",
            )
        return CorridorWays(
            (lat, lon), arcs, kept, (ends[0], ends[1]), weight, network.nodes.first_port,
            network.radius,
        )  # fmt: skip

    def _busiest_ports(self, *apart: FloatArray) -> tuple[int, int] | None:
        """Return the ports at two places between which most ships sailed; None if none did.

        Several ports may have one sea end, such as those on a river.

        Parameters
        ----------
        *apart : Distances of all nodes from the two places [m].
        """
        network = self.network
        first = network.nodes.first_port
        near = [first + np.flatnonzero(away[first:] <= _AT_NODE) for away in apart]
        count = {
            (a, b): network.whole.count_between(a, b) + network.pairs.voyages(a, b, None)[1]
            for a in near[0].tolist()
            for b in near[1].tolist()
        }
        best = max(count, key=lambda pair: count[pair], default=None)
        return best if best is not None and count[best] > 0 else None

    def _whole_voyages(self, start: int, goal: int, weight: FloatArray) -> IntArray:
        """Return the arcs of whole voyages between two nodes that are not too long."""
        network, evidence = self.network, self.network.arcs.evidence
        whole = network.whole_ways(start, goal, weight)
        usual = network.usual_way(start, goal, weight, month=self.month) if whole else []
        if len(usual) != 1 or usual[0] not in whole:
            return np.empty(0, np.int64)
        seen = evidence.count if self.month is None else evidence.months[:, self.month - 1]
        seen = seen if seen[usual[0]] > 0 else evidence.count
        length, least = network.lengths, max(1.0, _SELDOM * float(seen[usual[0]]))
        most = self.longest * length[usual[0]]
        return np.array([arc for arc in whole if length[arc] <= most and seen[arc] >= least])

    def network_between(
        self, chart: Chart, start: Position, goal: Position, *, spacing: float | None = None
    ) -> Network:
        """Return the corridor between two places as a network for searches.

        Along every arc lie stations, and at each of them five nodes from p5 to p95 of the tracks.

        Parameters
        ----------
        chart : Chart
            Tests every edge.
        start, goal : (lat, lon)
            [deg].
        spacing : float, optional
            Greatest distance between stations [m]; by default a 150th of the usual length, at
            least 5 nm.

        Returns
        -------
        Network
            Its edges lead along the arcs, in their direction.

        Raises
        ------
        NoPathError
            If no way is left.
        """
        ways = self.ways_between(chart, start, goal)
        spacing = spacing or max(_LEAST_SPACING, ways.shortest() / _STATIONS)
        (lat, lon), tail, head = ways.places, ways.arcs.tail[ways.kept], ways.arcs.head[ways.kept]
        in_canal = np.asarray(chart.canal_of_legs(lat[tail], lon[tail], lat[head], lon[head])) >= 0
        lanes = [
            (np.empty((0, LANES)),) * 2 if is_canal else ways.lanes(arc, spacing)
            for arc, is_canal in zip(ways.kept.tolist(), in_canal.tolist())
        ]
        network = _assembled(chart, ways, lanes, spacing)
        known, path = shortest_path(network, network.meta.start, network.meta.goal)
        if not path:
            reached = np.flatnonzero(np.isfinite(known))
            shoal = " or shoal water" if chart.zones.closed_shoals is not None else ""
            words = {REASONS[NO_GO]: f"{REASONS[NO_GO]}{shoal}"}
            counts = network.meta.rejected.items()
            reasons = " and ".join(f"{n:,} by {words.get(why, why)}" for why, n in counts)
            raise NoPathError(
                f"The usual water has no way from {format_position(*start)} to "
                f"{format_position(*goal)} on this chart.",
                f"Of its edges the chart refuses {reasons or 'none'}.",
                "Allow a smaller distance from land (--offing), shoals (--ignore-shoals), "
                "or leave the corridor (corridor gain).",
                reasons=network.meta.rejected,
                nearest=(float(network.lat[reached[-1]]), float(network.lon[reached[-1]])),
            )
        return network

    def restricted(
        self, chart: Chart, places: Sequence[Position], approaches: Sequence[Sequence[Position]]
    ) -> Chart:
        """Return a chart on which only the corridor through some places is open.

        Parameters
        ----------
        chart : Chart
        places : sequence of (lat, lon)
            Start, via points and goal [deg].
        approaches : sequence of sequence of (lat, lon)
            Lines of approaches that stay open [deg].

        Returns
        -------
        Chart
            With a no-go zone around the corridor.
        """
        import shapely

        from thalweg.chart.zones.zone_set import Zones

        shapes = []
        for a, b in itertools.pairwise(places):
            ways = self.ways_between(chart, a, b)
            for arc in ways.kept.tolist():
                shapes += ways.tube(arc, self.network.radius)
            for canal in ways.canals_on_way(chart, self.network.radius):
                shapes += strip_polygons(np.array(canal.path), _APPROACH_WIDTH)
        for place in places:
            shapes += strip_polygons(np.array([place, place]), self.network.radius)
        for line in approaches:
            if len(line) > 1:
                shapes += strip_polygons(np.array(line), _APPROACH_WIDTH)
        turned = [_turned(shape, places[0][1]) for shape in shapes]
        tube = _without_narrow_holes(shapely.union_all(turned), self.network.radius)
        west, south, east, north = tube.bounds
        south, north = max(south - 1.0, -89.0), min(north + 1.0, 89.0)
        west, east = west - 1.0, min(east + 1.0, west + 358.0)
        outside = shapely.segmentize(shapely.box(west, south, east, north), 1.0).difference(tube)
        zones = tuple(p for p in shapely.get_parts(outside) if p.geom_type == "Polygon")
        ends = (np.array([west, east]) + 180.0) % 360.0 - 180.0
        inside = chart if chart.area.width < 360.0 else chart.within(south, north, *ends.tolist())
        return replace(inside, zones=inside.zones.joined(Zones(no_go=zones)))


def _without_narrow_holes(tube: Any, radius: float) -> Any:
    """Return a tube with water between its lanes that is narrower than the radius [m] filled."""
    import shapely

    tube, half = tube.buffer(_TOUCH), 0.5 * radius / METRES_PER_DEGREE
    filled = []
    for part in shapely.get_parts(tube):
        holes = [shapely.Polygon(hole) for hole in part.interiors]
        wide = [hole.exterior for hole in holes if not hole.buffer(-half).is_empty]
        filled.append(shapely.Polygon(part.exterior, wide))
    return shapely.union_all(filled)


def _turned(shape: Any, lon: float) -> Any:
    """Return a polygon on the turn of longitude that is nearest to a longitude [deg]."""
    import shapely.affinity

    middle = 0.5 * (shape.bounds[0] + shape.bounds[2])
    return shapely.affinity.translate(shape, -360.0 * round((middle - lon) / 360.0))


def _assembled(
    chart: Chart, ways: CorridorWays, lanes: list[tuple[FloatArray, FloatArray]], spacing: float
) -> Network:
    """Return the network of the nodes and lanes of a corridor."""
    used = np.unique(np.concatenate([ways.arcs.tail[ways.kept], ways.arcs.head[ways.kept]]))
    number = np.full(len(ways.places[0]), -1)
    number[used] = np.arange(len(used))
    lat, lon = [ways.places[0][used]], [ways.places[1][used]]
    first, second, count = [], [], len(used)
    for arc, (y, x) in zip(ways.kept.tolist(), lanes):
        ids = count + np.arange(y.size).reshape(y.shape)
        count += y.size
        lat.append(y.ravel())
        lon.append(x.ravel())
        ends = [np.array([[number[node[arc]]]]) for node in (ways.arcs.tail, ways.arcs.head)]
        layers = [ends[0], *ids[:, None, :], ends[1]]
        for one, other in itertools.pairwise(layers):
            a, b = (grid.ravel() for grid in np.meshgrid(one, other, indexing="ij"))
            inner = one.size > 1 and other.size > 1
            keep = np.abs(a - one[0, 0] - b + other[0, 0]) <= _REACH if inner else a >= 0
            first.append(a[keep])
            second.append(b[keep])
    places = np.concatenate(lat), np.concatenate(lon)
    tails, heads = np.concatenate(first).astype(np.int32), np.concatenate(second).astype(np.int32)
    return _network(chart, ways, places, (tails, heads), number, spacing)


def _network(
    chart: Chart, ways: CorridorWays, places: tuple[FloatArray, FloatArray],
    joined: tuple[Any, Any], number: IntArray, spacing: float,
) -> Network:  # fmt: skip
    """Return the network of tested edges; canals keep their own lengths."""
    lat, lon = places
    a, b = joined
    which = np.asarray(chart.canal_of_legs(lat[a], lon[a], lat[b], lon[b]))
    free, rejected = allowed_legs(chart, lat, lon, a, b)
    keep = (free | (which >= 0)) & (geodesy.distance(lat[a], lon[a], lat[b], lon[b]) > 1.0)
    order = np.flatnonzero(keep)
    order = order[np.argsort(a[order], kind="stable")]
    a, b, which = a[order], b[order], which[order]
    stations = Stations(lat, lon, len(lat))
    pairs = measured_pairs(lat, lon, a, b)
    pieces = np.where(which >= 0, np.inf, np.maximum(pairs.length, 1.0) / _PIECES_PER_EDGE)
    stations, samples = evenly_spaced_samples(stations, pairs, pieces)
    through = np.array([chart.canals[k].length if k >= 0 else np.nan for k in which.tolist()])
    pairs = Pairs(
        a, b, np.where(which >= 0, through, pairs.length),
        np.where(which >= 0, np.nan, pairs.course).astype(np.float32),
    )  # fmt: skip
    leaving = np.bincount(a, minlength=stations.n_nodes)
    graph = Graph(cumulative_sums(leaving), b)
    directed = DirectedEdges(graph, np.arange(len(a), dtype=np.int32), np.zeros(len(a), bool))
    meta = NetworkMeta(
        kind="history", spacing_m=spacing, directions=LANES, gap_rad=2.0 * np.pi,
        rejected=rejected, start=int(number[ways.ends[0]]), goal=int(number[ways.ends[1]]),
    )  # fmt: skip
    return assemble(chart, stations, pairs, samples, meta=meta, directed=directed)
