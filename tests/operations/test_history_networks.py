"""A made fleet on known routes: its history network recovers lengths, seasons and outliers."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from thalweg.chart import Chart
from thalweg.chart.canals import CANALS
from thalweg.chart.ports import PORTS as PORTS_OF_INDEX
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import densify, distance, line_length
from thalweg.core.units import DAY, HOUR, NAUTICAL_MILE
from thalweg.network.history.history_builder import HistoryRules, build_history
from thalweg.network.history.history_file import read_history, write_history
from thalweg.network.history.junctions import CorridorLine
from thalweg.network.history.missing_arcs import strongly_connected_parts
from thalweg.network.history.voyage_tracks import HistoryPort
from thalweg.operations.examples.synthetic_fleet import (
    SyntheticFleet,
    SyntheticRoute,
    synthetic_fleet,
)
from thalweg.operations.fleet import history_from_tracks, read_fleet
from thalweg.operations.fleet.history_from_tracks import history_port, read_history_ports
from thalweg.operations.fleet.port_calls import (
    find_port_calls,
    voyages_between_calls,
    without_waits_at_canals,
)
from thalweg.planning.distance_table import usual_distance_table

A, B, C = (50.0, -30.0), (50.0, -20.0), (44.0, -25.0)
SUMMER = SyntheticRoute((A, (52.0, -25.0), B), months=(5, 6, 7, 8, 9))
WINTER = SyntheticRoute((A, (48.0, -25.0), B), months=(1, 2, 3, 4, 10, 11, 12), speed_kn=12.0)
OUTLIER = SyntheticRoute((A, (55.0, -28.0), B), share=0.004)
BACK = SyntheticRoute((B, A), share=2.0)
ONWARD = SyntheticRoute((B, C))
HOME = SyntheticRoute((C, (47.0, -28.0), A))
PORTS = [
    HistoryPort(name, code, *place, 0.0, (place,))
    for name, code, place in (
        ("Alpha, XX", "XXALP", A), ("Bravo, XX", "XXBRA", B), ("Charlie, XX", "XXCHA", C)
    )
]  # fmt: skip


@pytest.fixture(scope="module")
def messages():
    fleet = SyntheticFleet(
        (SUMMER, WINTER, OUTLIER, BACK, ONWARD, HOME), ships=10, interval_s=1800.0
    )
    return synthetic_fleet(fleet, start="2024-01-01", days=500, seed=3)


@pytest.fixture(scope="module")
def fleet(messages):
    return read_fleet([messages])


@pytest.fixture(scope="module")
def network(fleet):
    return history_from_tracks(fleet, Chart.open_water(), ports=PORTS)


@pytest.mark.slow
@pytest.mark.parametrize(("start", "goal", "month", "truth"), [
    ("Alpha", "Bravo", 1, WINTER), ("Alpha", "Bravo", 7, SUMMER), ("Bravo", "Alpha", None, BACK),
    ("Bravo", "Charlie", None, ONWARD), ("Charlie", "Alpha", None, HOME),
])  # fmt: skip
def test_medians_of_length_and_time_are_recovered(network, start, goal, month, truth):
    found = network.route(start, goal, month=month)
    assert found.length == pytest.approx(truth.length, rel=0.003)
    hours = truth.length / NAUTICAL_MILE / truth.speed_kn
    assert found.duration[1] / HOUR == pytest.approx(hours, rel=0.02)
    assert found.duration[0] < found.duration[1] < found.duration[2]
    assert found.voyages >= 30 and found.confidence == "high"
    assert found.globe_share == 0.0
    if month is not None:
        assert found.voyages_in_month > 0


def test_a_month_without_voyages_lowers_the_confidence(network):
    august = network.route("Bravo", "Charlie", month=8)
    evidence = network.arcs.evidence
    months = evidence.months.copy()
    months[:, 7] = 0
    arcs = replace(network.arcs, evidence=replace(evidence, months=months))
    unseen = replace(network, arcs=arcs).route("Bravo", "Charlie", month=8)
    assert (august.confidence, unseen.confidence) == ("high", "medium")
    assert "no voyage in this month" in unseen.reason and "no voyage" not in august.reason


def test_seasons_are_honoured_and_without_a_month_the_way_of_most_voyages_is_taken(network):
    middle = {month: _latitude_at(network.route("Alpha", "Bravo", month=month), -25.0)
              for month in range(1, 13)}  # fmt: skip
    for month, lat in middle.items():
        assert lat == pytest.approx(52.0 if month in SUMMER.months else 48.0, abs=0.1)
    both = [network.route("Alpha", "Bravo", month=month) for month in (1, 7)]
    assert network.route("alpha, xx", "XXBRA").voyages == max(way.voyages for way in both)


def test_outliers_do_not_make_the_usual_way(network, messages):
    north = messages[(messages.lat > 54.0)]
    assert north.mmsi.nunique() >= 1  # the fleet has some
    for month in range(1, 13):
        assert max(p[0] for p in network.route("Alpha", "Bravo", month=month).line) < 52.5


def test_arcs_are_directed_and_hold_what_was_seen(network):
    there = network.route("Alpha", "Bravo", month=1)
    back = network.route("Bravo", "Alpha", month=1)
    assert _latitude_at(there, -25.0) < 48.2 < 50.0 < _latitude_at(back, -25.0)
    evidence = network.arcs.evidence
    arc = back.arcs[0]
    assert evidence.months[arc].sum() == evidence.count[arc]
    assert evidence.draught[arc][2] == 12.0 and evidence.draughts_known[arc] == evidence.count[arc]
    assert evidence.ship_length[arc] == pytest.approx([120.0, 180.0, 180.0])
    assert (
        network.route("Bravo", "Alpha", draught=12.4).arcs == network.route("Bravo", "Alpha").arcs
    )
    with pytest.raises(NoRouteError, match="draught"):
        network.route("Bravo", "Alpha", draught=15.0)


def test_every_port_reaches_every_other(network):
    arcs = network.arcs
    part = strongly_connected_parts(len(network.nodes), arcs.tail, arcs.head)
    assert len(np.unique(part)) == 1


def test_tube_covers_nine_tenths_of_the_tracks(network):
    arc = network.route("Charlie", "Alpha").arcs[0]
    width = network.arcs.tube[arc][:, 1] - network.arcs.tube[arc][:, 0]
    # p95 - p5 of the spread of 1,500 m, which is sqrt(sin) of the phase of the whole voyage
    assert 3_000.0 < width.max() < 7_000.0
    assert (width > 0.0).all()


def test_a_file_holds_the_whole_network(network, tmp_path):
    write_history(network, tmp_path / "net.json")
    again = read_history(tmp_path / "net.json")
    for start, goal in (("Alpha", "Bravo"), ("Charlie", "Bravo")):
        for month in (1, 7):
            a, b = (net.route(start, goal, month=month) for net in (network, again))
            assert b.length == pytest.approx(a.length, abs=1.0)
            assert (b.arcs, b.voyages, b.confidence) == (a.arcs, a.voyages, a.confidence)
    assert again.arcs_by_kind() == network.arcs_by_kind()
    assert np.allclose(again.arcs.tube, network.arcs.tube, atol=0.1)


@pytest.mark.parametrize("damage", [
    lambda d: d.update(format="other"),
    lambda d: d.update(version=99),
    lambda d: d.pop("arcs"),
    lambda d: d["arcs"][0].update({"from": 10_000}),
    lambda d: d["arcs"][0].update(line=[[50.0, 0.0]]),
    lambda d: d["arcs"][0].update(kind="flown"),
    lambda d: d["ports"][0].update(lat=None),
])  # fmt: skip
def test_damaged_files_are_refused_in_words(network, tmp_path, damage):
    path = tmp_path / "net.json"
    write_history(network, path)
    data = json.loads(path.read_text())
    damage(data)
    path.write_text(json.dumps(data))
    with pytest.raises(InputError, match="history network"):
        read_history(path)


def test_unknown_ports_and_months_are_refused(network):
    with pytest.raises(InputError, match="Alpha"):
        network.route("Alfa", "Bravo")
    with pytest.raises(InputError, match="month"):
        network.route("Alpha", "Bravo", month=13)
    with pytest.raises(InputError, match="same port"):
        network.route("Alpha", "Alpha")


def test_a_port_without_voyages_is_joined_over_the_globe(fleet):
    far = HistoryPort("Delta, XX", "", 40.0, -40.0, 0.0, ((40.0, -40.0),))
    net = history_from_tracks(fleet, Chart.open_water(), ports=[*PORTS, far])
    found = net.route("Delta", "Bravo")
    assert found.globe_share > 0.3 and found.voyages == 0
    assert found.confidence in ("low", "none") and net.arcs_by_kind()["globe"] == 2
    assert found.to_dict()["duration_h"]["p50"] is None
    both = found.length, net.route("Bravo", "Delta").length
    assert both[0] == pytest.approx(both[1], rel=0.25)


def test_ways_seen_in_one_direction_are_reversed_and_marked(fleet):
    calls = find_port_calls(fleet, [port.places for port in PORTS])
    tracks = voyages_between_calls(fleet, calls)
    onward = np.flatnonzero((tracks.start == 1) & (tracks.goal == 2))[:20]
    net = build_history(Chart.open_water(), _some(tracks, onward), PORTS[1:])
    assert net.arcs_by_kind() == {"sailed": 1, "reversed": 1, "globe": 0}
    back = net.route("Charlie", "Bravo")
    there = net.route("Bravo", "Charlie")
    assert back.voyages == 0 and back.length == pytest.approx(there.length, rel=1e-12)


def test_a_way_back_round_the_ocean_is_not_taken_for_a_usual_one(fleet):
    """Ships sail A-B, B-C and C-A: from B to A the arc is reversed, of low confidence, not by C."""
    calls = find_port_calls(fleet, [port.places for port in PORTS])
    tracks = voyages_between_calls(fleet, calls)
    ways = [(0, 1), (1, 2), (2, 0)]
    some = [np.flatnonzero((tracks.start == a) & (tracks.goal == b))[:12] for a, b in ways]
    net = build_history(Chart.open_water(), _some(tracks, np.sort(np.concatenate(some))), PORTS)
    there, back = net.route("Alpha", "Bravo"), net.route("Bravo", "Alpha")
    assert there.confidence in ("high", "medium") and there.voyages > 0
    assert (
        back.nm
        < 1.05 * there.nm
        < net.route("Bravo", "Charlie").nm + net.route("Charlie", "Alpha").nm
    )
    assert back.confidence == "low" and back.voyages == 0


@pytest.mark.slow
def test_ships_that_leave_an_approach_early_do_not_sail_to_its_sea_end():
    """As between Hamburg and the Kiel Canal: 60 nm of the Elbe lead on to the open sea."""
    berth, turn, sea = (50.0, -29.0), (50.0, -30.0), (50.0, -32.0)
    line = (berth, turn, sea)
    river = HistoryPort("Delta, XX", "XXDEL", *sea, line_length(line), (berth, *line))
    out = SyntheticRoute((berth, turn, C))
    west = SyntheticRoute((berth, turn, sea, (47.0, -34.0)))
    far = HistoryPort("Echo, XX", "XXECH", 47.0, -34.0, 0.0, ((47.0, -34.0),))
    routes = (out, SyntheticRoute(out.line[::-1]), west, SyntheticRoute(west.line[::-1]))
    messages = synthetic_fleet(
        SyntheticFleet(routes, ships=6, interval_s=1800.0), start="2024-01-01", days=200, seed=4
    )
    ports = [river, PORTS[2], far]
    made = history_from_tracks(read_fleet([messages]), Chart.open_water(), ports=ports)
    for ends, truth in (
        (("Delta", "Charlie"), out), (("Charlie", "Delta"), out),
        (("Delta", "Echo"), west), (("Echo", "Delta"), west),
    ):  # fmt: skip
        assert made.route(*ends).length == pytest.approx(truth.length, rel=0.01)
    left = made.route("Delta", "Charlie").line[0]
    assert float(distance(*left, *turn)) < 10.0 * NAUTICAL_MILE
    names = ("Delta", "Charlie", "Echo")
    table = usual_distance_table(names, made)
    assert table.length[0, 1] == pytest.approx(out.length, rel=0.01)
    assert not any("doubtful" in note for note in table.notes)
    [joined] = table.notes
    assert "No voyage sailed the whole way" in joined
    assert "Charlie to Echo" in joined and "Delta" not in joined


@pytest.mark.slow
def test_a_berth_on_the_land_of_the_chart_leads_to_sea_by_the_approach_of_its_port(tmp_path):
    """The quays of Klaipeda are on land, and the nearest water is the lagoon behind them."""
    (tmp_path / "ports.csv").write_text("name,lat,lon\nQuay,55.69,21.125\nRoads,55.71,20.95\n")
    chart = Chart.gshhg("i")
    quay, roads = read_history_ports(tmp_path / "ports.csv", chart)
    index = history_port(PORTS_OF_INDEX.lookup("LTKLJ"), chart)
    assert (quay.lat, quay.lon) == (index.lat, index.lon) and quay.name == "Quay"
    assert index.approach_m < quay.approach_m < index.approach_m + 2.0 * NAUTICAL_MILE
    assert (roads.lat, roads.lon, roads.approach_m) == (55.71, 20.95, 0.0)


def test_corridors_are_junctions_with_names(fleet):
    line = CorridorLine("Gate", (47.5, -25.0), (48.5, -25.0))
    net = history_from_tracks(fleet, Chart.open_water(), ports=PORTS, corridors=[line])
    assert "Gate" in net.route("Alpha", "Bravo", month=1).passes
    assert "Gate" not in net.route("Alpha", "Bravo", month=7).passes


def test_time_in_port_between_daily_positions_does_not_count_as_under_way():
    """Twelve knots for four days, and most of a day in port before and after."""
    lon = np.array([-20.0, -20.0, -19.0, -12.0, -5.0, 2.0, 3.0, 3.0])
    table = pd.DataFrame({"mmsi": 1, "time": 1.7e9 + DAY * np.arange(len(lon)), "lat": 45.0,
                          "lon": lon})  # fmt: skip
    tracks = voyages_between_calls(
        fleet := read_fleet([table]), find_port_calls(fleet, [[(45.0, -20.0)], [(45.0, 3.0)]])
    )
    assert (tracks.start.tolist(), tracks.goal.tolist()) == ([0], [1])
    speed = float(distance(45.0, -19.0, 45.0, -12.0)) / DAY
    sailed = float(tracks.steps.sum())
    assert tracks.under_way[-1] == pytest.approx(sailed / speed, rel=1e-3)
    assert tracks.under_way[-1] < 3.5 * DAY < tracks.time[-1] - tracks.time[0]


@pytest.mark.parametrize(("hours", "passes", "calls"), [(6, True, 2), (6, False, 3), (20, True, 3)])
def test_waits_for_a_canal_are_no_calls(hours, passes, calls):
    """A stop off Port Said, and on through the Suez Canal or back to the west."""
    places = {"Alexandria": (31.25, 29.85), "Said": (31.40, 32.38), "Gulf": (28.6, 33.0)}
    suez = next(canal for canal in CANALS if canal.name == "suez")
    south = [suez.ends[0], suez.ends[1], places["Gulf"]]
    onward = south if passes else [(31.6, 31.0), places["Alexandria"]]
    way = [places["Alexandria"], (31.6, 31.0), places["Said"], *onward]
    lat, lon, _ = densify(*np.array(way, float).T, 4_000.0)
    stop = int(np.argmin(distance(lat, lon, *places["Said"])))
    step = np.append(0.0, distance(lat[:-1], lon[:-1], lat[1:], lon[1:])) / 7.0
    time = 1.7e9 + np.cumsum(step)
    lat, lon = (np.insert(part, stop, [part[stop]] * 3) for part in (lat, lon))
    time = np.insert(time, stop, time[stop] + np.arange(3.0))
    time[stop + 1 :] += hours * HOUR
    table = pd.DataFrame({"mmsi": 1, "time": time, "lat": lat, "lon": lon})
    fleet = read_fleet([table])
    found = find_port_calls(fleet, [[place] for place in places.values()])
    assert found.port.tolist() == [0, 1, 2 if passes else 0]
    assert len(without_waits_at_canals(fleet, found, CANALS).port) == (calls if passes else 3)


def test_stops_at_sea_are_no_calls_and_do_not_count_as_time_under_way():
    lon = np.concatenate([np.full(6, -10.0), np.linspace(-10.0, -9.0, 8), np.full(20, -9.0),
                          np.linspace(-9.0, -8.0, 8), np.full(6, -8.0)])  # fmt: skip
    table = pd.DataFrame({"mmsi": 1, "time": 1.7e9 + 1800.0 * np.arange(len(lon)), "lat": 45.0,
                          "lon": lon})  # fmt: skip
    tracks = voyages_between_calls(
        fleet := read_fleet([table]), find_port_calls(fleet, [[(45.0, -10.0)], [(45.0, -8.0)]])
    )
    assert (tracks.start.tolist(), tracks.goal.tolist()) == ([0], [1])
    assert tracks.under_way[-1] == 14 * 1800.0
    assert tracks.time[-1] - tracks.time[0] == 35 * 1800.0


def test_noon_reports_make_voyages():
    lon = np.array([-10.0, -4.0, 2.0, 8.0, 2.0, -4.0, -10.0])
    table = pd.DataFrame({"vessel": "Noon", "time": 1.7e9 + 86400.0 * np.arange(7), "lat": -45.0,
                          "lon": lon})  # fmt: skip
    fleet = read_fleet([table], interval=0.0)
    tracks = voyages_between_calls(
        fleet, find_port_calls(fleet, [[(-45.0, -10.0)], [(-45.0, 8.0)]])
    )
    assert tracks.start.tolist() == [0, 1] and tracks.goal.tolist() == [1, 0]


def test_tracks_without_a_voyage_are_refused():
    table = pd.DataFrame({"mmsi": 1, "time": [1.7e9, 1.7e9 + 600.0], "lat": 45.0,
                          "lon": [0.0, 0.01]})  # fmt: skip
    with pytest.raises(InputError, match="No voyage between two ports was found: 1 ship with 2"):
        history_from_tracks(read_fleet([table]), Chart.open_water(), ports=PORTS)


def test_rules_are_checked():
    with pytest.raises(InputError, match="tolerance"):
        HistoryRules(radius=1_000.0, tolerance=5_000.0)


def test_files_of_ships_are_read_as_tables(messages, tmp_path):
    some = messages[(messages.mmsi < 200_000_003) & (messages.time < messages.time.min() + 2e6)]
    one, two = tmp_path / "one.csv", tmp_path / "two.csv"
    text = some.assign(time=pd.to_datetime(some.time.round(), unit="s").dt.strftime("%FT%TZ"))
    text = text.rename(columns={"mmsi": "MMSI", "lat": "LAT", "lon": "LON", "length": "LOA"})
    text[text.MMSI == 200_000_000].to_csv(one, index=False)
    text[text.MMSI != 200_000_000].to_csv(two, index=False, sep="\t")
    from_files, from_table = read_fleet([one, two]), read_fleet([some])
    assert from_files.ptr.tolist() == from_table.ptr.tolist()
    assert from_files.time == pytest.approx(from_table.time, abs=0.51)
    assert from_files.lat == pytest.approx(from_table.lat)
    assert from_files.length == pytest.approx(from_table.length)


def _latitude_at(route, lon):
    lats, lons = np.array(route.line).T
    order = np.argsort(lons)
    return float(np.interp(lon, lons[order], lats[order]))


def _some(tracks, index):
    """Return some of the voyages."""
    parts = [np.arange(tracks.ptr[v], tracks.ptr[v + 1]) for v in index]
    ptr = np.cumsum([0, *map(len, parts)])
    at = np.concatenate(parts)
    ships = replace(tracks.ships, draught=tracks.ships.draught[index],
                    length=tracks.ships.length[index])  # fmt: skip
    return type(tracks)(
        ptr, tracks.time[at], tracks.lat[at], tracks.lon[at], tracks.under_way[at],
        tracks.broken[at], np.zeros(len(index), int), np.ones(len(index), int), ships,
    )  # fmt: skip
