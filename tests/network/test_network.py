"""The network check finds every kind of fault; end points; shortest paths; kernels."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.network.worlds import land_chart
from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoRouteError
from thalweg.kernels.network import graph_building
from thalweg.network import Graph, Network, check_network, lattice, shortest_path, with_endpoints
from thalweg.network.conformal_projection import (
    great_circle_projection,
    mercator_projection,
)
from thalweg.network.shortest_paths import shortest_path_tree
from thalweg.planning.network_selection.network_builder import build_network
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.sea import Sea

OPEN = Chart.open_water()


@pytest.fixture(scope="module")
def network() -> Network:
    return lattice(OPEN, (10, -40), (12, -37), directions=16, spacing=30e3)


def changed(array: np.ndarray, index: int, value: float) -> np.ndarray:
    copy = array.copy()
    copy[index] = value
    return copy


def test_sound_network_passes(network):
    check_network(network, symmetric=True)


FAULTS = {
    "indptr": ("graph", lambda g: {"indptr": g.indptr[:-1].copy()}, "indptr"),
    "falling": ("graph", lambda g: {"indptr": changed(g.indptr, 3, 10**6)}, "ascend"),
    "target": (
        "graph",
        lambda g: {"target": changed(g.target, 0, len(g.indptr) - 1)},
        "ends outside",
    ),
    "loop": ("graph", lambda g: {"target": changed(g.target, 0, 0)}, "own node"),
    "length": ("edges", lambda e: {"length": e.length * 1.00001}, "length"),
    "negative": ("edges", lambda e: {"length": -e.length}, "positive"),
    "course": ("edges", lambda e: {"course": e.course + np.float32(0.01)}, "course"),
    "penalty": (
        "edges",
        lambda e: {"penalty_factor": 0.5 * e.penalty_factor},
        "factor",
    ),
    "price": ("edges", lambda e: {"price_factor": -e.price_factor}, "price"),
    "station": ("stations", lambda s: {"lat": changed(s.lat, 0, np.nan)}, "finite"),
    "latitude": ("stations", lambda s: {"lat": changed(s.lat, 0, 91.0)}, "90"),
    "sample": ("samples", lambda s: {"station_a": changed(s.station_a, 0, -1)}, "no station"),
    "weight": ("samples", lambda s: {"weight": changed(s.weight, 0, 1.5)}, "weight"),
    "fraction": ("samples", lambda s: {"fraction": changed(s.fraction, 0, 1.0)}, "inside its edge"),
    "place": ("samples", lambda s: {"station_a": np.roll(s.station_a, 500)}, "lie on its edge"),
    "kind": ("edges", lambda e: {"course": e.course.astype(float)}, "float32"),
    "goal": ("meta", lambda _: {"goal": 10**6}, "goal"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_every_fault_is_named(network, name):
    part, change, word = FAULTS[name]
    sound = getattr(network, part)
    with pytest.raises(InputError, match=word) as fault:
        check_network(replace(network, **{part: replace(sound, **change(sound))}))
    assert fault.value.details["faults"]


def test_too_few_waiting_nodes_are_named(network):
    with pytest.raises(InputError, match="can_wait"):
        check_network(replace(network, can_wait=network.can_wait[:-1].copy()))


def test_one_way_edges_are_valid_unless_symmetry_is_declared(network):
    keep = np.ones(network.n_edges, bool)
    ptr = network.samples.ptr
    keep[np.flatnonzero(np.diff(ptr) == 0)[0]] = False
    indptr = np.concatenate([[0], np.cumsum(keep)])[network.graph.indptr]
    one_way = replace(
        network,
        graph=Graph(indptr, network.graph.target[keep]),
        edges=network.edges.take(keep),
        samples=replace(network.samples, ptr=np.append(ptr[:-1][keep], ptr[-1])),
    )
    check_network(one_way)
    with pytest.raises(InputError, match="no opposite"):
        check_network(one_way, symmetric=True)


def test_unordered_samples_are_a_fault():
    wide = lattice(OPEN, (10, -40), (12, -37), directions=32, spacing=30e3)
    edge = np.flatnonzero(np.diff(wide.samples.ptr) == 2)[0]
    first = wide.samples.ptr[edge]
    swapped = wide.samples.fraction.copy()
    swapped[first : first + 2] = swapped[first : first + 2][::-1]
    with pytest.raises(InputError, match="not in order"):
        check_network(replace(wide, samples=replace(wide.samples, fraction=swapped)))


def test_with_endpoints_adds_nodes_in_order(network):
    places = [(10.3, -39.2), (11.6, -37.8), (11.0, -38.5), (10.9, -38.9)]
    grown = with_endpoints(network, OPEN, *places[:2], via=places[2:])
    check_network(grown, symmetric=True)
    n = network.n_nodes
    assert (grown.meta.start, grown.meta.goal) == (n, n + 1)
    for number, place in enumerate(places):
        assert (grown.lat[n + number], grown.lon[n + number]) == place
        assert np.isfinite(shortest_path(grown, n)[0][n + number])
    assert grown.n_edges > network.n_edges
    old, _ = shortest_path(network, 0)
    new, _ = shortest_path(grown, 0)
    assert np.all(new[:n] <= old + 1e-6)


def test_with_endpoints_refuses_land_and_the_unreachable():
    chart = land_chart((10.4, 10.6, -38.6, -38.4))
    net = lattice(chart, (10, -40), (12, -37), directions=16, spacing=30e3)
    with pytest.raises(InputError, match="start"):
        with_endpoints(net, chart, (10.5, -38.5), (11, -38))
    with pytest.raises(InputError, match="via point 1"):
        with_endpoints(net, chart, (10.2, -38.5), (11, -38), via=[(10.5, -38.5)])
    with pytest.raises(NoRouteError):
        with_endpoints(net, OPEN, (10.2, -38.5), (60, 100))


@settings(max_examples=25)
@given(st.integers(0, 10_000))
def test_static_distances_equal_networkx(seed):
    rng = np.random.default_rng(seed)
    a, b = rng.integers(0, 30, (2, 70)).astype(np.int32)
    a, b = a[a != b], b[a != b]
    weight = rng.random(len(a))
    indptr, target, pair, _ = graph_building.directed_edges_of_pairs(30, a, b)
    tree = shortest_path_tree(Graph(indptr, target), weight[pair], 0)
    peer = nx.Graph()
    peer.add_nodes_from(range(30))
    for p, q, w in zip(a.tolist(), b.tolist(), weight.tolist()):
        if not peer.has_edge(p, q) or peer[p][q]["weight"] > w:
            peer.add_edge(p, q, weight=w)
    truth = nx.single_source_dijkstra_path_length(peer, 0)
    assert tree.distance == pytest.approx([truth.get(k, np.inf) for k in range(30)])
    for node in range(30):
        path = tree.path(node)
        length = sum(peer[p][q]["weight"] for p, q in pairwise(path))
        assert length == pytest.approx(truth.get(node, 0.0))
        assert (path[:1] + path[-1:] == [0, node]) == (node in truth)


def test_measure_agrees_with_the_exact_geodesic():
    rng = np.random.default_rng(3)
    lat, lon = rng.uniform(-88, 88, 3000), rng.uniform(-180, 180, 3000)
    course, length = rng.uniform(0, 2 * np.pi, 3000), 10 ** rng.uniform(2, 6.5, 3000)
    to = geodesy.direct(lat, lon, course, length)
    here = np.arange(3000, dtype=np.int32)
    measured, middle = np.empty(3000), np.empty(3000, np.float32)
    graph_building.fill_lengths_and_courses(
        np.append(lat, to[0]), np.append(lon, to[1]), here, here + np.int32(3000), measured, middle
    )
    assert np.abs(measured - length).max() < 1e-3
    half = geodesy.direct(lat, lon, course, 0.5 * length)
    exact = geodesy.inverse(*half, *to)[1]
    assert np.abs(np.angle(np.exp(1j * (middle - exact)))).max() < 1e-3


@given(st.floats(-85, 85), st.floats(-180, 179.9), st.booleans())
def test_frames_invert_and_are_conformal(lat, lon, turned):
    frame = (
        great_circle_projection((40, -70), (50, -5), 1e4)
        if turned
        else mercator_projection((40, -70), 1e4, latitude=45)
    )
    x, y = frame.from_positions(lat, lon)
    back = frame.to_positions(x, y)
    assert geodesy.distance(lat, lon, *back) < 1e-3
    if abs(float(y) * frame.unit + frame.y0) < 2.5:
        centre = frame.to_positions(x, y)
        step = 0.01
        along = geodesy.inverse(*centre, *frame.to_positions(x + step, y))
        up = geodesy.inverse(*centre, *frame.to_positions(x, y + step))
        assert float(along[0] / up[0]) == pytest.approx(1.0, abs=1e-3)
        quarter = np.angle(np.exp(1j * (along[1] - up[1])))
        assert float(quarter) == pytest.approx(np.pi / 2, abs=1e-3)
        assert float(up[0]) == pytest.approx(float(frame.metres(y)) * step, rel=6e-3)


def test_a_builder_of_ones_own_returns_a_network():
    ends: Any = [SimpleNamespace(lat=0.0, lon=0.0), SimpleNamespace(lat=0.0, lon=1.0)]
    choice = NetworkChoice(lambda *given, **more: None)
    with pytest.raises(InputError, match="The network builder returns None"):
        build_network(choice, Chart.open_water(), Sea.calm(), ends, period=(0.0, 1.0))
