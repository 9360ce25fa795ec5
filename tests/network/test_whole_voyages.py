"""Usual routes are those of voyages that sailed from the one port to the other, where any did.

Four ports on 45 N with sea room on all sides: West, Middle (a port of call on the way), East, and
North of West. Fast ships sail West to East on a lane that is longer than the way by Middle; slow
ships call at Middle.
"""

from dataclasses import replace

import numpy as np
import pytest

from tests.network.test_history_parts import line_between, voyage_tracks
from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import line_length
from thalweg.network.history.history_builder import HistoryRules, build_history
from thalweg.network.history.history_corridor import HistoryCorridor
from thalweg.network.history.history_file import read_history, write_history
from thalweg.network.history.voyage_tracks import HistoryPort, PortNames
from thalweg.planning.distance_table import usual_distance_table

NM, HOUR = 1852.0, 3600.0
WEST, MIDDLE, EAST, NORTH = (45.0, -20.0), (45.0, -16.0), (45.0, -12.0), (47.0, -20.0)
PLACES = {"West": WEST, "Middle": MIDDLE, "East": EAST, "North": NORTH}
#: A pier without voyages has the sea end of West.
PORTS = (HistoryPort("Pier", "", *WEST),
         *(HistoryPort(name, "", *place) for name, place in PLACES.items()))  # fmt: skip
BY_SOUTH = (WEST, (44.0, -18.0), (44.0, -14.0), EAST)
LANE = (WEST, (45.2, -18.2), (45.2, -17.8), MIDDLE)
BESIDE = (WEST, (45.32, -18.2), (45.32, -17.8), MIDDLE)  # 7 nm from the lane
FAST, SLOW = 9.0, 4.5  # [m/s]
#: Lines, speed [m/s], number of voyages.
FLEET = (
    (BY_SOUTH, FAST, 12),
    (LANE, SLOW, 15),
    (BESIDE, FAST, 14),
    ((MIDDLE, EAST), SLOW, 15),
    ((NORTH, (46.0, -20.0), WEST), SLOW, 11),
)


@pytest.fixture(scope="module")
def network():
    random = np.random.default_rng(3)
    lines, ends, speeds = [], [], []
    names = list(PLACES.values())
    for way, speed, count in FLEET:
        for _ in range(count):
            aside = random.normal(0.0, 0.01, 2)
            inner = [tuple(np.array(place) + aside) for place in way[1:-1]]
            lines.append(line_between(way[0], *inner, way[-1], spacing=random.uniform(1, 3) * NM))
            ends.append((1 + names.index(way[0]), 1 + names.index(way[-1])))
            speeds.append(speed)
    for _ in range(4):  # known at the ends and half way only
        lines.append(line_between(WEST, EAST, spacing=200 * NM))
        ends.append((1, 3))
        speeds.append(FAST)
    tracks = voyage_tracks(lines, speed=1.0)
    start, goal = np.array(ends).T
    slower = np.repeat(np.array(speeds), np.diff(tracks.ptr))
    tracks = replace(
        tracks, start=start, goal=goal, under_way=tracks.under_way / slower,
        time=1.7e9 + tracks.under_way / slower,
    )  # fmt: skip
    return build_history(Chart.open_water(), tracks, PORTS, rules=HistoryRules(10 * NM, NM, 3))


def test_the_usual_route_is_not_joined_from_voyages_with_a_call_between(network):
    found = network.route("West", "East")
    assert found.length == pytest.approx(line_length(BY_SOUTH), rel=0.005)
    assert line_length(BY_SOUTH) > 1.05 * (line_length(LANE) + line_length((MIDDLE, EAST)))
    assert min(lat for lat, _ in found.line) == pytest.approx(44.0, abs=0.05)
    assert found.duration[1] == pytest.approx(line_length(BY_SOUTH) / FAST, rel=0.01)
    assert (found.voyages, found.whole, found.confidence) == (12, 12, "high")
    assert found.reason == "12 voyages on this way"


def test_voyages_with_wide_gaps_make_no_way(network):
    ways = network.whole_ways(
        network.port_node("West"), network.port_node("East"), network.weights()
    )
    assert network.arcs.evidence.count[ways].tolist() == [12]


def test_where_nobody_sailed_voyages_of_a_port_beside_are_named(network):
    [note] = network.route("Pier", "East").notes
    assert "12 voyages sailed from West to East, which are within 20 nm" in note
    assert network.route("West", "East").notes == ()


def test_draughts_that_nobody_sailed_are_refused_with_the_deepest(network):
    with pytest.raises(NoRouteError, match="its 12 voyages drew at most 10 m"):
        network.route("West", "East", draught=14.0)
    assert network.route("West", "East", draught=10.2).whole == 12


def test_lanes_side_by_side_are_ways_of_their_own_with_their_own_times(network):
    found = network.route("West", "Middle")
    assert found.length == pytest.approx(line_length(LANE), rel=0.005)  # of most voyages
    assert found.duration[1] == pytest.approx(line_length(LANE) / SLOW, rel=0.01)
    assert found.voyages == 15
    ways = network.whole_ways(
        network.port_node("West"), network.port_node("Middle"), network.weights()
    )
    assert network.arcs.evidence.count[ways].tolist() == [15, 14]
    other = network.arcs.evidence.duration[ways[1], 1]
    assert other == pytest.approx(line_length(BESIDE) / FAST, rel=0.01)


def test_ways_that_nobody_sailed_whole_are_never_of_high_confidence(network):
    found = network.route("North", "Middle")
    assert len(found.arcs) > 1 and found.whole == 0
    assert found.voyages >= 10 and found.confidence != "high"
    assert "no voyage from the one port to the other" in found.reason
    assert found.to_dict()["voyages_of_whole_way"] == 0
    table = usual_distance_table(["North", "Middle"], network)
    [note] = table.notes
    assert "No voyage sailed the whole way" in note and "North to Middle" in note


def test_a_way_back_that_nobody_sailed_is_that_of_the_other_direction(network):
    found = network.route("East", "West")
    assert found.length == pytest.approx(network.route("West", "East").length, rel=1e-6)
    assert found.line == network.route("West", "East").line[::-1]
    assert found.confidence == "low" and "12 voyages in the other direction" in found.reason
    assert np.isnan(found.duration[1])


def test_the_corridor_has_the_water_of_whole_voyages_alone(network):
    import shapely

    chart = HistoryCorridor(network).restricted(Chart.open_water(), [WEST, EAST], [])
    closed = shapely.union_all(chart.zones.no_go)
    assert not closed.contains(shapely.Point(-16.0, 44.0))
    assert closed.contains(shapely.Point(-16.5, 45.05))  # on the way by Middle


def test_a_file_keeps_whole_voyages(network, tmp_path):
    write_history(network, tmp_path / "net.json")
    again = read_history(tmp_path / "net.json")
    assert again.route("West", "East").reason == "12 voyages on this way"


def test_a_port_beside_one_of_the_network_is_found():
    terminal = HistoryPort("Port Polnochny, PL", "", 54.4117, 18.7511)
    terminal = HistoryPort("Port Polnochny, PL", "", 54.4117, 18.7511)
    names = PortNames.of_ports([terminal, HistoryPort("Karlshamn, SE", "SEKAN", 56.1095, 14.8872)])
    assert names.find("Gdansk") == [0] and names.find("PLGDN") == [0]
    assert names.find("Karlshamn") == [1] and names.find("Klaipeda") == []


@pytest.mark.parametrize("draught", [-5.0, 0.0, 90.0, float("nan")])
def test_draughts_out_of_reason_are_refused(network, draught):
    with pytest.raises(InputError, match="draught is"):
        network.route("West", "East", draught=draught)


def test_rules_out_of_reason_are_refused_in_words():
    with pytest.raises(InputError, match="radius of junctions is 18520 nm"):
        HistoryRules(radius=18_520.0 * NM)
    with pytest.raises(InputError, match="-3 nm"):
        HistoryRules(radius=-3.0 * NM)
