"""Networks have nodes in the lanes of traffic separation schemes."""

from dataclasses import replace

import numpy as np
import pytest

from thalweg import Chart
from thalweg.chart.zones.traffic_schemes import TRAFFIC_SCHEMES, lanes_of_schemes
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import lattice
from thalweg.network.passage_nodes import PassageNodes
from thalweg.network.regional_lattice import unassembled_lattice
from thalweg.network.regional_lattice.lane_nodes import lane_nodes
from thalweg.network.shortest_paths import shortest_path

ENDS = (47.0, -8.0), (56.0, 3.5)


@pytest.fixture(scope="module")
def chart():
    return replace(Chart.gshhg("l"), zones=Zones(lanes=lanes_of_schemes(ENDS)))


def least_path(chart, start, goal):
    """The path of least length with miles against the traffic counted, on edges of 20 nm."""
    network = lattice(chart, start, goal, spacing=20.0 * NAUTICAL_MILE)
    weight = network.edges.length * np.asarray(network.edges.penalty_factor, float)
    _, path = shortest_path(
        network, network.meta.start, network.meta.goal, weight=weight, per_metre=1.0
    )
    lat, lon = network.lat[path], network.lon[path]
    legs = lat[:-1], lon[:-1], lat[1:], lon[1:]
    leg, _, share = chart.zones.lane_group.shares_against(*legs)
    length = np.asarray(distance(*legs))
    return length.sum() / NAUTICAL_MILE, (share * length[leg]).sum() / NAUTICAL_MILE


@pytest.mark.slow
@pytest.mark.parametrize("ends", [ENDS, ENDS[::-1]], ids=["up", "down"])
def test_a_coarse_network_leads_along_the_lanes_of_the_channel(chart, ends, monkeypatch):
    miles, against = least_path(chart, *ends)
    none = PassageNodes(np.empty(0), np.empty(0), np.empty(0, bool))
    monkeypatch.setattr(unassembled_lattice, "lane_nodes", lambda chart: none)
    without = least_path(chart, *ends)
    assert against < 2.0
    assert miles + 9.0 * against < without[0] + 9.0 * without[1] - 5.0


def test_nodes_are_with_the_traffic_in_the_middle_of_lanes(chart):
    nodes = lane_nodes(chart)
    follows = np.flatnonzero(nodes.joined)
    dover = next(scheme for scheme in TRAFFIC_SCHEMES if scheme.name == "Dover Strait")
    off = dover.shifted(dover.zone + 0.5 * dover.lane)
    near = np.asarray(distance(nodes.lat[:, None], nodes.lon[:, None], off[:, 1], off[:, 0]))
    assert (near.min(axis=0) < 100.0).all()
    apart = distance(*(x[k] for k in (follows - 1, follows) for x in (nodes.lat, nodes.lon)))
    assert np.max(apart) < 8.01 * NAUTICAL_MILE
    assert len(lane_nodes(Chart.gshhg("l")).lat) == 0
