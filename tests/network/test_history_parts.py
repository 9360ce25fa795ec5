"""Parts of history networks against direct computation: turning points, seasons, lines, tubes."""

import itertools

import numpy as np
import pytest
from shapely.geometry import box

from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.core.geodesy import distance
from thalweg.network import check_network, shortest_path
from thalweg.network.history.arc_lines import ArcLines, GlobeWays, lines_off_land
from thalweg.network.history.arc_statistics import arcs_of_occurrences, group_percentiles
from thalweg.network.history.history_builder import HistoryRules, build_history
from thalweg.network.history.history_corridor import HistoryCorridor
from thalweg.network.history.junction_visits import ArcOccurrences
from thalweg.network.history.season_masks import open_months
from thalweg.network.history.stretch_ends import EndFinder
from thalweg.network.history.turning_points import turning_points
from thalweg.network.history.voyage_tracks import (
    HistoryPort,
    TrackShips,
    VoyageTracks,
    ellipsoid_vectors,
    lengths_between,
)

NM = 1852.0
PORTS = (HistoryPort("West", "", 45.0, -20.0), HistoryPort("East", "", 45.0, -10.0))


def voyage_tracks(lines, *, speed=7.0, broken=(), start=None, draught=10.0):
    """Return tracks of lines (lat, lon), from port 0 to port 1 unless stated."""
    lat = np.concatenate([np.array(line, float)[:, 0] for line in lines])
    lon = np.concatenate([np.array(line, float)[:, 1] for line in lines])
    ptr = np.cumsum([0, *(len(line) for line in lines)])
    step = np.append(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]) / speed, 0.0)
    step[ptr[1:] - 1] = 0.0
    whole = np.concatenate([[0.0], np.cumsum(step)[:-1]])
    under_way = whole - np.repeat(whole[ptr[:-1]], np.diff(ptr))
    gaps = np.zeros(len(lat), bool)
    gaps[list(broken)] = True
    count = len(lines)
    begin = np.zeros(count, int) if start is None else np.array(start)
    ships = TrackShips(np.full(count, draught), np.full(count, np.nan))
    return VoyageTracks(ptr, 1.7e9 + whole, lat, lon, under_way, gaps, begin, 1 - begin, ships)


def line_between(*places, spacing=2 * NM):
    lat, lon, _ = geodesy.densify(*np.array(places, float).T, spacing)
    return list(zip(lat.tolist(), lon.tolist()))


def test_lengths_from_chords_equal_geodesics():
    random = np.random.default_rng(1)
    lat, lon = random.uniform(-80, 80, 500), random.uniform(-180, 180, 500)
    for reach, tolerance in ((2e5, 5e-5), (2e6, 5e-4)):
        to = geodesy.direct(lat, lon, random.uniform(0, 2 * np.pi, 500), reach)
        found = lengths_between(ellipsoid_vectors(lat, lon), ellipsoid_vectors(*to))
        assert found == pytest.approx(np.full(500, reach), rel=tolerance)


def test_turning_points_are_those_of_the_textbook():
    random = np.random.default_rng(2)
    lines = []
    for _ in range(12):
        turn = random.uniform(44.0, 46.0, 3)
        line = line_between((45.0, -20.0), *zip(turn, (-18.0, -15.0, -12.0)), (45.0, -10.0),
                            spacing=8 * NM)  # fmt: skip
        lines.append([(lat + random.normal(0, 0.01), lon) for lat, lon in line])
    tracks = voyage_tracks(lines)
    found = turning_points(tracks, 2 * NM)
    for number in range(len(lines)):
        first, last = tracks.ptr[number], tracks.ptr[number + 1] - 1
        expected = _textbook(tracks.vectors, first, last, 2 * NM)
        assert np.flatnonzero(found[first : last + 1]).tolist() == [k - first for k in expected]


def _textbook(vectors, first, last, tolerance):
    """Return the positions that Douglas and Peucker keep, by recursion."""
    normal = np.cross(vectors[first], vectors[last])
    normal /= np.linalg.norm(normal)
    away = np.abs(vectors[first + 1 : last] @ normal)
    if last - first < 2 or away.max() <= tolerance:
        return [first, last]
    at = first + 1 + int(np.argmax(away))
    before = _textbook(vectors, first, at, tolerance)
    return before + _textbook(vectors, at, last, tolerance)[1:]


def test_percentiles_of_groups_equal_those_of_numpy():
    random = np.random.default_rng(3)
    ptr = np.array([0, 4, 4, 5, 30])
    values = random.normal(size=30)
    values[7] = np.nan
    found = group_percentiles(values, ptr, (10.0, 50.0, 90.0))
    for group, (a, b) in enumerate(itertools.pairwise(ptr)):
        own = values[a:b][np.isfinite(values[a:b])]
        expected = np.percentile(own, (10, 50, 90)) if len(own) else np.full(3, np.nan)
        assert found[group] == pytest.approx(expected, nan_ok=True)


@pytest.mark.parametrize(("seen", "leaving", "shut"), [
    ([20] * 12, [20] * 12, ()),  # all year
    ([0, 0, 0, 0, 9, 9, 9, 9, 0, 0, 0, 0], [9] * 12, (0, 1, 2, 3, 8, 9, 10, 11)),
    ([2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 2], [2] * 12, ()),  # six voyages: not believed
    ([0, 0, 0, 0, 9, 9, 9, 9, 0, 0, 0, 0], [0, 0, 0, 0, 9, 9, 9, 9, 0, 0, 0, 0], ()),  # none left
    ([40, 40, 40, 40, 1, 0, 0, 0, 1, 40, 40, 40], [40] * 12, (4, 5, 6, 7, 8)),  # stray ships
    ([1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 1], [1] * 12, ()),  # one empty month is chance
])  # fmt: skip
def test_seasons_are_believed_only_with_enough_samples(seen, leaving, shut):
    found = open_months(np.array([seen]), np.array([leaving]))[0]
    assert np.flatnonzero(~found).tolist() == list(shut)


def test_the_medoid_is_the_track_in_the_middle_and_far_ways_are_apart():
    random = np.random.default_rng(4)
    middle = [line_between((45.0, -20.0), (45.0 + d, -15.0), (45.0, -10.0))
              for d in (-0.2, -0.1, 0.0, 0.1, 0.2)]  # fmt: skip
    far = [line_between((45.0, -20.0), (48.0 + d, -15.0), (45.0, -10.0)) for d in (0.0, 0.05, 0.1)]
    stray = [line_between((45.0, -20.0), (41.0, -15.0), (45.0, -10.0))]
    lines = [*middle, *far, *stray]
    order = random.permutation(len(lines))
    tracks = voyage_tracks([lines[k] for k in order])
    begin, end = tracks.along[tracks.ptr[:-1]], tracks.along[tracks.ptr[1:] - 1]
    zero = np.zeros(len(lines), int)
    found = arcs_of_occurrences(
        tracks, ArcOccurrences(np.arange(len(lines)), zero, zero + 1, begin, end),
        radius=10 * NM, least=3, first_port=9,
    )  # fmt: skip
    assert found.evidence.count.tolist() == [5, 3]
    assert found.outliers == 1
    assert order[found.candidates[:, 0]].tolist() == [2, 6]
    lengths = [distance(*np.array(lines[k][:-1]).T, *np.array(lines[k][1:]).T).sum()
               for k in range(5)]  # fmt: skip
    assert found.evidence.length[0] == pytest.approx(np.percentile(lengths, (10, 50, 90)), rel=1e-5)
    assert found.evidence.duration[0] == pytest.approx(found.evidence.length[0] / 7.0, rel=1e-4)
    # port is south of an eastbound medoid's starboard: 0.2 degrees of latitude, 5 to 95 %
    tube = found.tube[0][4]
    assert tube == pytest.approx([-0.19 * 60 * NM, 0.19 * 60 * NM], rel=0.15)


class StubWays(GlobeWays):
    """Ways over the globe that are known beforehand."""

    def between(self, start, goal):
        return [start, (46.5, -15.5), (46.5, -14.5), goal]


def test_tracks_over_land_are_replaced_and_marked():
    island = Chart.from_geojson(
        {"type": "Polygon", "coordinates": [
            [list(p) for p in box(-15.3, 44.0, -14.7, 46.0).exterior.coords]
        ]}
    )  # fmt: skip
    gap = [(45.0, -20.0), (45.05, -16.0), (45.05, -14.0), (45.0, -10.0)]
    whole = line_between((45.0, -20.0), (46.2, -15.0), (45.0, -10.0))
    for lines, source, repaired in (([gap, gap, whole], 2, False), ([gap, gap], 0, True)):
        tracks = voyage_tracks(lines)
        begin, end = tracks.along[tracks.ptr[:-1]], tracks.along[tracks.ptr[1:] - 1]
        zero = np.zeros(len(lines), int)
        stretches = ArcOccurrences(np.arange(len(lines)), zero, zero + 1, begin, end)
        tried = np.full((1, 4), -1)
        tried[0, : len(lines)] = np.arange(len(lines))
        found = lines_off_land(
            island, tracks, stretches, tried,
            finder=EndFinder(
                island, tracks, (np.array([45.0, 45.0]), np.array([-20.0, -10.0])), PORTS
            ),
            turning=turning_points(tracks, 1 * NM), radius=10 * NM, ways=StubWays(island),
        )  # fmt: skip
        assert not found.lines.blocked(island).any()
        assert found.source.tolist() == [source]
        assert (found.repaired[0] > 0.1) == repaired


def test_share_in_control_areas_is_exact():
    chart = Chart.open_water().with_zones(
        {"type": "FeatureCollection", "features": [{
            "type": "Feature", "properties": {"name": "east", "kind": "eca"},
            "geometry": {"type": "Polygon", "coordinates": [
                [list(p) for p in box(-5.0, -1.0, 20.0, 1.0).exterior.coords]]},
        }]}
    )  # fmt: skip
    lines = ArcLines.of_lists([[(0.0, -20.0), (0.0, 0.0)], [(0.0, -20.0), (0.0, -10.0)]])
    assert lines.control_area_shares(chart) == pytest.approx([0.25, 0.0], abs=1e-4)


@pytest.fixture(scope="module")
def lane():
    """A lane with a bend, its tracks spread by up to 12 nm to either side."""
    lines = [line_between((45.0, -20.0), (45.0 + d, -17.0), (46.0 + d, -13.0), (45.0, -10.0))
             for d in np.linspace(-0.2, 0.2, 21)]  # fmt: skip
    back = [line[::-1] for line in lines]
    tracks = voyage_tracks([*lines, *back], start=[0] * 21 + [1] * 21)
    return build_history(Chart.open_water(), tracks, PORTS, rules=HistoryRules(10 * NM, 2 * NM, 3))


def test_the_corridor_is_a_network_whose_best_way_is_no_longer_than_the_usual(lane):
    chart = Chart.open_water()
    network = HistoryCorridor(lane).network_between(chart, (45.0, -20.0), (45.0, -10.0))
    check_network(network)
    length, path = shortest_path(network, network.meta.start, network.meta.goal)
    straight = float(distance(45.0, -20.0, 45.0, -10.0))
    usual = lane.route("West", "East").length
    assert straight < length[network.meta.goal] <= usual * 1.001
    assert (network.lat[path[0]], network.lon[path[-1]]) == (45.0, -10.0)


def test_water_outside_the_tube_is_closed(lane):
    chart = Chart.open_water()
    ends = [(45.0, -20.0), (45.0, -10.0)]
    closed = HistoryCorridor(lane).restricted(chart, ends, [])
    lat, lon = np.array(lane.route("West", "East").line).T
    assert closed.is_navigable(lat, lon).all()
    assert not closed.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]).any()
    aside = closed.is_navigable([47.0, 44.0, 45.0, 45.6], [-13.0, -15.0, -8.0, -15.0])
    assert aside.tolist() == [False, False, False, True]
    assert bool(closed.legs_blocked([45.0], [-20.0], [45.0], [-10.0])[0])


def test_places_beside_the_network_are_joined_to_it(lane):
    network = HistoryCorridor(lane).network_between(Chart.open_water(), (44.0, -21.0), (45.0, -9.0))
    length, path = shortest_path(network, network.meta.start, network.meta.goal)
    assert path and length[network.meta.goal] > lane.route("West", "East").length
