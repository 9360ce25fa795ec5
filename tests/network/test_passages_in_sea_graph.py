"""Named passages in the graph of all seas: they lead on at both ends, and closed ones hold."""

import numpy as np
import pytest

from thalweg.chart.passages import find_passages
from thalweg.core.geodesy import densify, distance, line_length
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.sea_graph import GraphClosures, SeaGraph
from thalweg.network.global_grid.sea_graph_cache import sea_graph
from thalweg.network.passage_nodes import _NODE_SPACING, passage_nodes
from thalweg.planning.sea_distance import sea_distance
from thalweg.planning.seaways import Seaways, small_passages, world_chart

pytestmark = pytest.mark.slow
#: Ends in waters of their own: the Sea of Azov, the bay of Melbourne, three lagoons; and the
#: western Beagle Channel, which ocean ships do not use.
ENDS_IN_SMALL_WATERS = {
    ("Kerch Strait", "last"),
    ("Port Phillip Heads", "last"),
    ("Maracaibo bar", "last"),
    ("Rio Grande bar (Lagoa dos Patos)", "last"),
    ("Beagle", "last"),
    ("Midfjorden (Alesund to Molde)", "last"),
    ("Trikeri, Oreos and North Evoikos Channels", "last"),
    ("Northeast Pass of Chuuk", "first"),
}


def nodes_reached(graph: SeaGraph, start: set[int], without: set[int], most: int = 300) -> int:
    """Return how many nodes are reached from some nodes, counted up to a number."""
    seen, stack = set(start), list(start)
    while stack and len(seen) < most:
        node = stack.pop()
        for head in graph.target[graph.indptr[node] : graph.indptr[node + 1]].tolist():
            if head not in seen and head not in without:
                seen.add(head)
                stack.append(head)
    return len(seen)


def test_both_ends_of_narrow_passages_lead_to_open_water():
    world = world_chart()
    chart = Seaways.of_chart(world, (), opened=sorted(small_passages(world))).chart
    graph = sea_graph(chart)
    places = zip(graph.waters.lat.tolist(), graph.waters.lon.tolist())
    number = {(round(lat, 6), round(lon, 6)): node for node, (lat, lon) in enumerate(places)}
    whole = passage_nodes(chart)
    in_graph = {(round(a, 6), round(b, 6)) for a, b in zip(whole.lat.tolist(), whole.lon.tolist())}
    dead = set()
    for passage in chart.passages:
        if passage.half_width > NAUTICAL_MILE:
            continue
        lat, lon, _ = densify(*passage.positions, _NODE_SPACING)
        keys = [(round(a, 6), round(b, 6)) for a, b in zip(lat.tolist(), lon.tolist())]
        along = np.append(0.0, np.cumsum(distance(lat[:-1], lon[:-1], lat[1:], lon[1:])))
        own = {number[key]: at for key, at in zip(keys, along.tolist()) if key in in_graph}
        near = min(0.3 * along[-1], 15.0 * NAUTICAL_MILE)
        ends = {
            "first": {node for node, at in own.items() if at <= near},
            "last": {node for node, at in own.items() if at >= along[-1] - near},
        }
        dead |= {
            (passage.name, end)
            for end, nodes in ends.items()
            if nodes_reached(graph, nodes, set(own) - nodes) < 300
        }
    assert dead == ENDS_IN_SMALL_WATERS


@pytest.mark.parametrize(
    "name",
    [
        "Sunda",
        "Gelasa (Gaspar)",
        "Durian Strait",
        "Bab el Mandeb (large)",
        "Karimata",
        "Foveaux",
        "Sannikov",
    ],
)
def test_a_closed_passage_has_no_way_beside_an_island_in_it(name):
    chart = world_chart()
    graph = sea_graph(chart)
    (passage,) = find_passages([name])
    ends = passage.line[0], passage.line[-1]
    along = line_length(graph.path(chart, *ends))
    closed = chart.without_passages(name)
    round_it = line_length(graph.path(closed, *ends, GraphClosures(passages=(passage,))))
    assert round_it > along + 40.0 * NAUTICAL_MILE


def test_deep_ships_do_not_pass_sunda_and_other_ships_pass_xiazhimen():
    deep = sea_distance("Ras Tanura", "Ningbo", draught_m=20.8)
    assert "Lombok" in deep.straits
    assert deep.nm == pytest.approx(6930, abs=40)
    small = [sea_distance((29.3, 123.5), "Ningbo", draught_m=m) for m in (None, 8.0, 12.0, 20.0)]
    assert all("Zhoushan: Xiazhimen" in way.straits for way in small)
    assert [way.nm for way in small] == pytest.approx([96.0] * 4, abs=1.5)
