"""Stops at real berths belong to the port whose berth is nearest, not to one farther up a river."""

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.network.history.voyage_tracks import ellipsoid_vectors
from thalweg.operations.fleet.history_from_tracks import size_weights, world_port_places
from thalweg.operations.fleet.port_calls import PortCallRules, ports_of_positions

BERTHS = [
    ("NLEUR", 51.957, 4.030),  # Maasvlakte; was Vlaardingen
    ("BEANR", 51.290, 4.260),  # Deurganck dock; was Brussels
    ("NLVLI", 51.450, 3.700),  # was Ghent
    ("NLTNZ", 51.340, 3.820),  # was Ghent
    ("DEBRV", 53.595, 8.520),  # was Brake
    ("DEBKE", 53.330, 8.480),
    ("GBFXT", 51.953, 1.305),  # was Harwich
    ("NLRTM", 51.885, 4.430),
    ("DEHAM", 53.540, 9.910),
    ("FRLEH", 49.467, 0.150),
]


@pytest.fixture(scope="module")
def world():
    ports, places = world_port_places(Chart.gshhg("i"))
    return ports, places, size_weights(ports)


def test_berths_belong_to_their_ports(world):
    ports, places, weights = world
    vectors = ellipsoid_vectors(*np.array([berth[1:] for berth in BERTHS]).T)
    found = ports_of_positions(vectors, places, PortCallRules().reach, weights)
    assert [ports[k].locode for k in found] == [berth[0] for berth in BERTHS]


def test_positions_far_from_all_ports_belong_to_none(world):
    _, places, weights = world
    vectors = ellipsoid_vectors(np.array([45.0, 0.0]), np.array([-30.0, -25.0]))
    assert ports_of_positions(vectors, places, PortCallRules().reach, weights).tolist() == [-1, -1]
