"""Layered networks: placing by geodesics, exact tests of segments, refusals in words."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from shapely.geometry import LineString, box

from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoPathError
from thalweg.network import (
    LayeredRequest,
    check_network,
    layered_network,
    shortest_path,
)
from thalweg.network.layered.layered_draft import layered_draft
from thalweg.network.layered.layered_request import missed_straits_note, suggested_shape
from thalweg.network.layered.sections_round_land import layered_section
from thalweg.network.short_legs import positions_on_short_legs

SHAPE = {"layers": 9, "fan": 5, "offset": 4000.0}
#: An island across the line from (65, 0) to (65, 4), open to the north and the south.
ISLAND = box(1.8, 64.9, 2.2, 65.1)


def _chart(*areas):
    return Chart.from_geojson(
        {"type": "MultiPolygon", "coordinates": [
            [[list(p) for p in area.exterior.coords]] for area in areas
        ]}
    )  # fmt: skip


def test_layers_are_evenly_spaced_along_the_geodesic_and_nodes_across_it():
    draft = layered_draft([(65.0, 178.0), (66.5, -178.0)], **SHAPE)
    middle = [np.flatnonzero(draft.layer == k) for k in range(11)]
    centre = np.array([nodes[len(nodes) // 2] for nodes in middle])
    lat, lon = draft.lat[centre], draft.lon[centre]
    steps = geodesy.distance(lat[:-1], lon[:-1], lat[1:], lon[1:])
    assert steps == pytest.approx(float(steps.mean()), rel=1e-6)
    total = float(geodesy.distance(65.0, 178.0, 66.5, -178.0))
    assert float(steps.sum()) == pytest.approx(total, rel=1e-9)
    widest = middle[5]
    ends = widest[[0, -1]]
    across = geodesy.distance(draft.lat[ends], draft.lon[ends], lat[5], lon[5])
    assert across == pytest.approx(5 * 4000.0, rel=1e-9)
    _, along, _ = geodesy.inverse(lat[5], lon[5], lat[6], lon[6])
    _, port, _ = geodesy.inverse(lat[5], lon[5], draft.lat[ends[0]], draft.lon[ends[0]])
    assert np.degrees(along - port) % 360.0 == pytest.approx(90.0, abs=0.01)  # port comes first


def test_network_keeps_the_guarantees_and_leads_forward():
    network = layered_network(Chart.open_water(), [(65.0, 0.0), (65.0, 4.0), (64.0, 6.0)], **SHAPE)
    check_network(network)
    assert (network.meta.start, network.meta.goal) == (0, network.n_nodes - 1)
    assert np.all(network.graph.target > network.tails())


def test_no_segment_crosses_an_island_and_all_nodes_are_on_paths():
    network = layered_network(_chart(ISLAND), [(65.0, 0.0), (65.0, 4.0)], **SHAPE)
    tails, heads = network.tails(), network.graph.target
    for a, b in zip(tails, heads):
        line = geodesy.positions_along(
            network.lat[a], network.lon[a], network.lat[b], network.lon[b], np.linspace(0, 1, 20)
        )
        assert not LineString(np.array(line)[::-1].T).intersects(ISLAND)
    assert network.meta.rejected["land"] > 0
    from_start, _ = shortest_path(network, 0)
    assert np.isfinite(from_start).all()
    assert set(range(network.n_nodes - 1)) == set(tails.tolist())  # no dead end


def test_via_points_may_have_shapes_of_their_own_in_mixed_forms():
    places = [(65.0, 0.0), (65.0, 2.0), (65.0, 6.0)]
    draft = layered_draft(places, layers=[1, 5], fan=3, offset=[1000.0, 3000.0])
    assert [s.layers for s in draft.shapes] == [1, 5]
    assert len(draft.lat) == 1 + sum(s.n_nodes - 1 for s in draft.shapes)
    with pytest.raises(InputError, match="3 values of layers are given for 2 section"):
        layered_draft(places, layers=[1, 2, 3], fan=3, offset=1000.0)


@pytest.mark.parametrize(
    "change", [{"layers": 0}, {"fan": 1}, {"offset": 0.0}, {"layers": 2.5}, {"offset": "wide"}]
)
def test_impossible_shapes_are_refused(change):
    with pytest.raises(InputError):
        layered_draft([(65.0, 0.0), (65.0, 2.0)], **(SHAPE | change))


def test_a_network_without_a_path_names_section_layer_and_the_next_shape():
    wall = box(2.9, 64.0, 3.1, 66.0)
    places = [(65.0, 0.0), (65.0, 2.0), (65.0, 4.0)]
    with pytest.raises(NoPathError) as refusal:
        layered_network(_chart(wall), places, layers=3, fan=3, offset=5000.0)
    error = refusal.value
    assert (error.details["section"], error.details["layer"]) == (2, 1)
    assert error.details["next_shape"] == {"layers": 7, "fan": 5, "offset_m": 2500.0}
    assert error.reasons["land"] > 0
    assert "section 2 of 2" in str(error) and "between layer 1 and layer 2" in str(error)
    assert "7 layers, a fan of 5" in str(error)


def test_zones_and_the_area_of_the_chart_are_tested_too():
    zone = {"type": "Feature", "properties": {"kind": "no-go"}, "geometry": {
        "type": "Polygon", "coordinates": [[[1.8, 64.9], [2.2, 64.9], [2.2, 65.1], [1.8, 65.1],
                                            [1.8, 64.9]]]}}  # fmt: skip
    chart = Chart.open_water(64.0, 65.2, -1.0, 5.0).with_zones(zone)
    network = layered_network(chart, [(65.0, 0.0), (65.0, 4.0)], **SHAPE)
    assert sum(network.meta.rejected.values()) > 0
    assert network.lat.max() <= 65.2
    _, path = shortest_path(network, 0, network.meta.goal)
    assert len(path) == 11


def test_shortest_path_is_the_least_of_all_walks():
    network = layered_network(
        _chart(ISLAND), [(65.0, 0.0), (65.0, 4.0)], layers=5, fan=3, offset=12_000.0
    )
    lengths = {}
    for tail, head, length in zip(network.tails(), network.graph.target, network.edges.length):
        lengths[int(tail), int(head)] = float(length)

    def walks(node):
        if node == network.meta.goal:
            yield 0.0
        for (a, b), length in lengths.items():
            if a == node:
                yield from (length + rest for rest in walks(b))

    least, _ = shortest_path(network, 0, network.meta.goal)
    assert float(least[network.meta.goal]) == pytest.approx(min(walks(0)), rel=1e-12)


@pytest.mark.slow
def test_the_suggested_shape_is_the_coarsest_that_is_good_enough():
    open_water = suggested_shape(Chart.open_water(), (65.0, 0.0), (65.0, 4.0))
    assert open_water.layers == 5  # an odd fan has the geodesic itself
    islands = [box(1.0 + k, 64.7, 1.04 + k, 65.04) for k in range(3)]
    near = suggested_shape(_chart(*islands), (65.0, 0.0), (65.0, 4.0), tolerance=0.001)
    assert near.layers > 5
    network = layered_section(_chart(*islands), (65.0, 0.0), (65.0, 4.0), None, spacing=3000.0)
    assert network.meta.spacing_m <= 3000.0
    assert "chosen" in network.meta.notes[0]


def test_even_fan_is_noted():
    network = layered_network(
        Chart.open_water(), [(65.0, 0.0), (65.0, 4.0)], layers=4, fan=4, offset=5000.0
    )
    assert any("even fan" in note for note in network.meta.notes)


def test_request_of_files_and_options():
    request = LayeredRequest.from_dict({"layers": [1, 15], "fan": 5, "offset_nm": [1.0, 0.5]})
    assert request.as_dict() == {"layers": [1, 15], "fan": 5, "offset_nm": [1.0, 0.5]}
    assert [s.offset for s in request.shapes(2)] == [1852.0, 926.0]
    for bad in (7, {"layers": 3}, {"layers": 3, "fan": 3, "offset_nm": 1, "extra": 2},
                {"layers": True, "fan": 3, "offset_nm": 1}):  # fmt: skip
        with pytest.raises(InputError):
            LayeredRequest.from_dict(bad)


def test_random_segments_on_the_worlds_coast_agree_with_their_samples():
    chart = Chart.gshhg("i")
    places = [(63.675, 9.298), (66.5653, 11.6697)]
    network = layered_network(chart, places, layers=30, fan=7, offset=4400.0)
    tails, heads = network.tails(), network.graph.target
    for share in np.linspace(0.0, 1.0, 9):
        lat, lon = geodesy.positions_along(
            network.lat[tails], network.lon[tails], network.lat[heads], network.lon[heads], share
        )
        assert chart.is_navigable(np.asarray(lat), np.asarray(lon)).all()
    assert network.meta.rejected["land"] > 100


def test_sections_join_at_their_waypoints():
    places = [(65.0, 0.0), (65.0, 2.0), (65.0, 4.0)]
    network = layered_network(Chart.open_water(), places, layers=3, fan=3, offset=2000.0)
    at = [int(np.argmin(geodesy.distance(network.lat, network.lon, *p))) for p in places]
    _, path = shortest_path(network, network.meta.start, network.meta.goal)
    assert set(at) <= set(path)
    for a, b in itertools.pairwise(places):
        assert a != b


def test_positions_on_short_legs_are_those_of_geodesics():
    draw = np.random.default_rng(1)
    lat, lon = draw.uniform(-89.0, 89.0, 500), draw.uniform(-180.0, 180.0, 500)
    for length, tolerance in ((1e4, 0.01), (1e5, 1.0)):
        course, share = draw.uniform(0.0, 2.0 * np.pi, 500), draw.uniform(0.0, 1.0, 500)
        ends = geodesy.direct(lat, lon, course, np.full(500, length))
        first = np.arange(500)
        found = positions_on_short_legs(
            np.append(lat, ends[0]), np.append(lon, ends[1]), first, first + 500,
            np.full(500, length), share,
        )  # fmt: skip
        true = geodesy.direct(lat, lon, course, share * length)
        assert np.max(geodesy.distance(*found, *true)) < tolerance


def test_nodes_are_closer_near_land_only():
    """Every node of the coarse network stays, and the way round the island is that of the fine."""
    places, chart = [(65.0, 0.0), (65.0, 4.0)], _chart(ISLAND)
    coarse = layered_network(chart, places, **SHAPE)
    fine = layered_network(chart, places, layers=19, fan=5, offset=2000.0)
    mixed = layered_network(chart, places, near_coast=15_000.0, **SHAPE)
    check_network(mixed)
    assert coarse.n_edges < mixed.n_edges < 0.6 * fine.n_edges

    def positions(network):
        return set(zip(np.round(network.lat, 9).tolist(), np.round(network.lon, 9).tolist()))

    assert positions(coarse) <= positions(mixed) <= positions(fine)
    lengths = [shortest_path(n, 0)[0][n.meta.goal] for n in (fine, mixed, coarse)]
    assert lengths[0] <= lengths[1] + 1e-6 and lengths[1] <= lengths[2] + 1e-6
    away = chart.coastline.shore_distance(mixed.lat, mixed.lon, cap=1e5)
    others = [k for k, place in enumerate(zip(np.round(mixed.lat, 9), np.round(mixed.lon, 9)))
              if tuple(map(float, place)) not in positions(coarse)]  # fmt: skip
    assert others and np.max(away[others]) <= 15_000.0
    even = layered_network(chart, places, layers=8, fan=4, offset=4000.0, near_coast=15_000.0)
    check_network(even)


def test_requests_for_a_chosen_shape():
    wanted = {"contain": [[64.862, 11.253]], "within_percent": 0.5, "near_coast_nm": 2.0}
    request = LayeredRequest.from_dict(wanted)
    assert request.shapes(3) == (None, None, None)
    assert LayeredRequest.from_dict(request.as_dict()) == request
    for bad in ({"contain": [[64.0]]}, {"within_percent": 0}, {"near_coast_nm": "far"},
                {"layers": 3, "fan": 3, "offset_nm": 1, "contain": [[1, 2]]}):  # fmt: skip
        with pytest.raises(InputError):
            LayeredRequest.from_dict(bad)


@pytest.mark.slow
def test_a_chosen_network_turns_where_land_is_across_the_direct_line():
    """A bay with one mouth to the south, and the goal north of it: no rhombus holds a path."""
    bay = [box(1.0, 64.6, 1.2, 65.4), box(1.0, 65.3, 2.6, 65.4), box(2.4, 64.6, 2.6, 65.4)]
    start, goal = (65.2, 1.8), (65.6, 1.8)
    network = layered_section(_chart(*bay), start, goal, None)
    check_network(network)
    length, path = shortest_path(network, network.meta.start, network.meta.goal)
    lat, lon = np.array([start, (64.6, 1.2), (64.6, 1.0), (65.4, 1.0), goal]).T
    round_west = float(geodesy.distance(lat[:-1], lon[:-1], lat[1:], lon[1:]).sum())
    assert path and round_west <= length[network.meta.goal] <= 1.03 * round_west
    assert "Land is across the direct line" in network.meta.notes[0]
    assert "turning points of a way round land: 64" in network.meta.notes[1]


def test_straits_belong_to_the_section_that_is_nearest():
    request = LayeredRequest(contain=((65.01, 1.0), (64.3, 5.0)))
    places = [(65.0, 0.0), (65.0, 4.0), (64.0, 6.0)]
    assert [request.of_section(places, k).contain for k in (0, 1)] == [
        ((65.01, 1.0),), ((64.3, 5.0),)
    ]  # fmt: skip
    assert request.of_section(places[:2], 0) == request


def test_straits_between_the_ends_that_no_path_passes_are_named():
    passages = [
        SimpleNamespace(name="Aside", line=((65.0, 1.0), (65.2, 2.0), (65.0, 3.0))),
        SimpleNamespace(name="On the way", line=((65.0, 1.9), (65.01, 2.0), (65.0, 2.1))),
        SimpleNamespace(name="Far away", line=((60.0, 1.0), (60.0, 2.0), (60.0, 3.0))),
    ]
    ends = (65.0, 0.0), (65.0, 4.0)
    network = layered_network(Chart.open_water(), ends, layers=99, fan=3, offset=200.0)
    [note] = missed_straits_note(SimpleNamespace(passages=passages), network, ends)
    assert "passes Aside:" in note
