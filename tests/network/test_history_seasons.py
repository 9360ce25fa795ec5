"""A made fleet on two ways by season: usual lengths, both directions, months without voyages."""

from dataclasses import replace

import numpy as np
import pytest

from tests.network.test_history_parts import line_between, voyage_tracks
from thalweg.chart import Chart
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import line_length
from thalweg.network.history.history_builder import HistoryRules, build_history
from thalweg.network.history.season_masks import open_months, voyages_of_regions
from thalweg.network.history.voyage_tracks import HistoryPort
from thalweg.planning.distance_table import usual_distance_table

NM = 1852.0
WEST, EAST = (45.0, -20.0), (45.1, -16.0)
PORTS = (HistoryPort("West", "", *WEST), HistoryPort("East", "", *EAST))
#: Both ways leave West by one place; turns nearer to each other than the radius make a chain of
#: junctions, which ships pass a few miles off.
SUMMER = (WEST, (44.95, -19.8), (45.0, -18.4), (45.15, -17.0), (45.2, -16.3), EAST)
WINTER = (WEST, (44.95, -19.8), (44.3, -18.2), (45.0, -16.5), (45.2, -16.3), EAST)
MONTHS = {"summer": (6, 7), "winter": (1, 2)}


def sea_months(months):
    """Return times [s since 1970] in the middle of some months of 2025, ten voyages in each."""
    days = [np.datetime64(f"2025-{month:02d}-05T00") + np.timedelta64(2 * k, "D")
            for month in months for k in range(10)]  # fmt: skip
    return np.array(days).astype("datetime64[s]").astype(float)


@pytest.fixture(scope="module")
def network():
    """Twenty voyages in each season and direction, spread by about 1 nm, positions 1 nm apart."""
    random = np.random.default_rng(11)
    lines, start, begin = [], [], []
    for name, way in (("summer", SUMMER), ("winter", WINTER)):
        for direction in (0, 1):
            for time in sea_months(MONTHS[name]):
                aside = random.normal(0.0, 0.015, 2)
                inner = [tuple(np.array(place) + aside) for place in way[2:-2]]
                line = line_between(*way[:2], *inner, *way[-2:], spacing=random.uniform(1, 2) * NM)
                lines.append(line[:: 1 - 2 * direction])
                start.append(direction)
                begin.append(time)
    tracks = voyage_tracks(lines, start=start)
    first = tracks.time[tracks.ptr[:-1]]
    tracks = replace(tracks, time=tracks.time + np.repeat(np.array(begin) - first,
                                                          np.diff(tracks.ptr)))  # fmt: skip
    return build_history(Chart.open_water(), tracks, PORTS, rules=HistoryRules(10 * NM, NM, 3))


@pytest.mark.parametrize(("month", "way"), [(1, WINTER), (2, WINTER), (6, SUMMER), (7, SUMMER)])
def test_usual_lengths_are_those_of_the_line_and_of_the_voyages(network, month, way):
    there = network.route("West", "East", month=month)
    back = network.route("East", "West", month=month)
    for found in (there, back):
        assert found.length == pytest.approx(line_length(found.line), rel=1e-9)
        assert found.length == pytest.approx(line_length(way), rel=0.01)
        assert found.voyages >= 5 and found.confidence in ("high", "medium")
        hours = line_length(way) / 7.0
        assert found.duration[1] == pytest.approx(hours, rel=0.02)
        assert not found.notes
    assert there.length == pytest.approx(back.length, rel=0.01)


def test_no_arc_is_reversed_where_ships_sail_both_ways(network):
    assert network.arcs_by_kind() == {"sailed": len(network.arcs), "reversed": 0, "globe": 0}


def test_arcs_are_measured_from_where_ships_pass_junctions(network):
    arcs, evidence = network.arcs, network.arcs.evidence
    many = evidence.count >= 10
    assert many.sum() >= 8
    spread = evidence.length[many, 2] - evidence.length[many, 0]
    assert np.median(spread) < 1.0 * NM
    apart = np.abs(arcs.lines.lengths[many] - evidence.length[many, 1])
    assert np.median(apart) < 0.5 * NM


@pytest.mark.parametrize(("season", "other"), [("summer", "winter"), ("winter", "summer")])
def test_arcs_of_one_season_are_closed_in_the_other_in_both_directions(network, season, other):
    evidence = network.arcs.evidence
    own, away = (evidence.months[:, np.array(MONTHS[name]) - 1].sum(axis=1)
                 for name in (season, other))  # fmt: skip
    arcs = np.flatnonzero((own >= 15) & (away == 0))
    directions = np.sign(
        network.nodes.lon[network.arcs.head] - network.nodes.lon[network.arcs.tail]
    )
    assert {-1.0, 1.0} <= set(directions[arcs].tolist())
    for arc in arcs.tolist():
        shut = np.flatnonzero(~evidence.open_in[arc]) + 1
        assert tuple(shut) == MONTHS[other]  # months without any voyage close nothing


@pytest.mark.parametrize("month", [4, 5, 10, 12])
def test_in_months_without_tracks_all_ways_are_open_and_a_note_says_so(network, month):
    for ends in (("West", "East"), ("East", "West")):
        found = network.route(*ends, month=month)
        both = [network.route(*ends, month=one) for one in (1, 7)]
        most = max(both, key=lambda way: way.voyages)
        assert found.length == most.length and found.voyages == most.voyages
        assert found.confidence == "medium"
        [note] = found.notes
        assert "tracks have voyages in January, February, June and July only" in note
        assert found.to_dict()["notes"] == [note]
    assert note in usual_distance_table(["West", "East"], network, month=month).notes


def test_a_file_of_closed_months_without_tracks_is_read_the_same(network):
    """Files of former versions close arcs in months that have no tracks."""
    evidence = network.arcs.evidence
    shut = replace(evidence, open_in=evidence.open_in & (evidence.months > 0))
    former = replace(network, arcs=replace(network.arcs, evidence=shut))
    assert former.route("West", "East", month=5).length == pytest.approx(
        network.route("West", "East", month=5).length
    )
    blocked = replace(evidence, open_in=np.zeros_like(evidence.open_in))
    with pytest.raises(NoRouteError):
        replace(network, arcs=replace(network.arcs, evidence=blocked)).route(
            "West", "East", month=6
        )


def test_the_season_of_a_region_says_nothing_of_another_one():
    """Tracks of January here and of July elsewhere closed the arcs here in July."""
    tail, head = np.repeat([0, 2], 40), np.repeat([1, 3], 40)
    months = np.repeat([0, 6], 40)
    by_node = voyages_of_regions((tail, head), np.arange(80), months)
    assert by_node.sum(axis=1).tolist() == [40, 40, 40, 40]
    seen = np.zeros((2, 12), int)
    seen[0, 0] = seen[1, 6] = 40
    assert open_months(seen, by_node[[0, 2]]).all()
    assert not open_months(seen, by_node[[0, 2]].sum(axis=0))[0, 6]
