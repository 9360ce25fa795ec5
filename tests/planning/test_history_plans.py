"""Plans in the water that ships usually use: inside it, out of it for a gain, beside the usual."""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.network.test_history_parts import line_between, voyage_tracks
from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.history.history_builder import HistoryRules, build_history
from thalweg.network.history.history_corridor import HistoryCorridor
from thalweg.network.history.history_file import write_history
from thalweg.network.history.history_route import no_arcs_text
from thalweg.network.history.voyage_tracks import HistoryPort
from thalweg.operations.examples.synthetic_fleet import (
    SyntheticFleet,
    SyntheticRoute,
    synthetic_fleet,
)
from thalweg.operations.fleet import history_from_tracks, read_fleet
from thalweg.planning import Voyage, plan
from thalweg.planning.distance_table import usual_distance_table
from thalweg.planning.history_plans import _unknown_ports, usual_against_optimal
from thalweg.planning.sea_distance import sea_distance
from thalweg.sea import Sea
from thalweg.ship import Ship

NM = NAUTICAL_MILE
WEST, EAST = (45.0, -16.0), (45.0, -13.0)
PORTS = (HistoryPort("West", "", *WEST), HistoryPort("East", "", *EAST))
SHIP = Ship.simple(speed_kn=14.0, draught_m=6.0)
OPTIONS = {
    "ship": SHIP,
    "sea": Sea.calm(),
    "chart": Chart.open_water(),
    "proof": 0.0,
    "resolution": 15_000.0,
}
VOYAGE = Voyage(start=WEST, goal=EAST, depart="2026-01-10")


@pytest.fixture(scope="module")
def network():
    """Ships sail round a bend 20 nm north of the straight line, 2 nm to either side."""
    lines = [line_between(WEST, (45.33 + d, -14.5), EAST) for d in np.linspace(-0.03, 0.03, 9)]
    tracks = voyage_tracks([*lines, *(line[::-1] for line in lines)], start=[0] * 9 + [1] * 9)
    return build_history(
        Chart.open_water(), tracks, PORTS, rules=HistoryRules(5 * NM, 1 * NM, 3)
    )  # fmt: skip


@pytest.fixture(scope="module")
def inside(network):
    return plan(VOYAGE, network=HistoryCorridor(network), **OPTIONS)


def test_the_plan_stays_in_the_usual_water(network, inside):
    route = inside.best
    assert route.feasible
    at = np.argmin(np.abs(route.track.lon - -14.5))
    assert route.track.lat[at] > 45.2
    straight, usual = distance(*WEST, *EAST) / NM, network.route("West", "East").nm
    assert 1.005 * straight < route.distance_nm <= usual * 1.001
    assert any("stays in the water that ships usually use" in note for note in inside.notes)
    assert inside.notes[0].startswith("No voyages were seen in January")  # but in November


def test_ports_without_tracks_are_named(network):
    known, other = (SimpleNamespace(approach=SimpleNamespace(port=SimpleNamespace(locode=code)),
                                    name=name)
                    for code, name in (("", "West"), ("XXOTH", "Other, XX")))  # fmt: skip
    request = SimpleNamespace(ends=(known, other), corridor=HistoryCorridor(network))
    [note] = _unknown_ports(request)
    assert note.startswith("Other, XX is in no track")


@pytest.mark.slow
def test_the_plan_leaves_it_only_for_the_gain(network, inside):
    straight = float(distance(*WEST, *EAST)) / NM
    gain = 1.0 - straight / inside.best.distance_nm
    free = plan(VOYAGE, network=HistoryCorridor(network, gain=0.5 * gain), **OPTIONS)
    assert free.best.distance_nm == pytest.approx(straight, rel=1e-3)
    assert any("leaves the water" in note for note in free.notes)
    kept = plan(VOYAGE, network=HistoryCorridor(network, gain=2.0 * gain), **OPTIONS)
    assert kept.best.distance_nm == pytest.approx(inside.best.distance_nm, rel=1e-6)
    assert any("not more than" in note for note in kept.notes)


def test_too_few_draughts_do_not_close_an_arc(network):
    assert network.arcs.evidence.draughts_known.max() < 10
    assert np.isfinite(network.weights(draught=29.0)).all()


def test_a_file_is_a_network_of_plan(network, inside, tmp_path):
    write_history(network, tmp_path / "net.json")
    again = plan(VOYAGE, network=f"history:{tmp_path / 'net.json'}", **OPTIONS)
    assert again.best.distance_nm == pytest.approx(inside.best.distance_nm, rel=1e-4)
    with pytest.raises(InputError, match="cannot be read"):
        plan(VOYAGE, network="history:nowhere.json", **OPTIONS)
    with pytest.raises(InputError, match="history:FILE"):
        plan(VOYAGE, network="histories", **OPTIONS)


def test_gains_are_checked(network):
    with pytest.raises(InputError, match="gain"):
        HistoryCorridor(network, gain=-0.1)


def test_usual_against_optimal_is_the_saving_of_the_straight_way(network):
    voyage = Voyage(start="West", goal="East", depart="2026-01-10")
    found = usual_against_optimal(
        voyage, network, ship=SHIP, sea=OPTIONS["sea"], chart=OPTIONS["chart"],
        plan_one=lambda request: plan(request, **OPTIONS),
    )  # fmt: skip
    straight = float(distance(*WEST, *EAST)) / NM
    row = found.to_dict()["distance_nm"]
    assert row["optimal"] == pytest.approx(straight, rel=1e-3)
    line = np.array(found.history.line)
    legs = sum(float(distance(*a, *b)) for a, b in itertools.pairwise(line)) / NM
    assert row["usual"] == pytest.approx(legs, rel=6e-3)  # without the corner at the junction
    saving = 100.0 * (1.0 - row["optimal"] / row["usual"])
    assert row["saving_percent"] == pytest.approx(saving, abs=0.01) and saving > 1.0
    assert found.to_dict()["voyages"] == 9
    assert found.ways == ((), ())  # open water without schemes
    note, draught = found.notes  # the tracks are of November, the voyage is in January
    assert note.startswith("No voyages were seen in January: the tracks have voyages in November")
    assert draught.startswith("Ways closed to the draught of the ship")
    assert row["usual"] == pytest.approx(network.route("West", "East", month=1).nm, rel=1e-3)


@pytest.mark.slow
def test_the_rules_that_a_usual_route_does_not_keep_are_stated(network):
    """A track along the Dutch coast, through the inshore traffic zone off Texel."""
    chart, line = Chart.gshhg("i"), ((52.02, 3.88), (52.6, 4.35), (53.1, 4.6), (53.6, 6.0))
    history = replace(network.route("West", "East"), line=line)

    class OneRoute:
        arcs, radius = network.arcs, network.radius

        def route(self, *names, **limits):
            return history

    def plan_one(request):
        return plan(request, ship=SHIP, sea=OPTIONS["sea"], chart=chart, proof=0.0)

    voyage = Voyage(start="West", goal="East", depart="2026-01-10")
    found = usual_against_optimal(
        voyage, OneRoute(), ship=SHIP, sea=OPTIONS["sea"], chart=chart, plan_one=plan_one
    )
    assert any("inshore traffic zone of Off Texel" in note for note in found.notes)
    assert found.to_dict()["notes"] == list(found.notes)


def test_refusals_name_the_month_and_draught_in_use():
    assert no_arcs_text(None, None) == "No arcs join them."
    assert no_arcs_text(2, 9.5) == (
        "No arcs join them that are open in month 2 and deep enough for a draught of 9.5 m."
    )


def test_tables_hold_the_routes_of_the_network(network):
    table = usual_distance_table(["West", "East"], network)
    assert table.nm[0, 1] == network.route("West", "East").nm
    assert table.nm[1, 0] == network.route("East", "West").nm
    assert table.nm[0, 0] == 0.0
    assert table.to_csv().splitlines()[0] == "nm,West,East"
    with pytest.raises(InputError, match="twice"):
        usual_distance_table(["West", "West"], network)


@pytest.mark.slow
@pytest.mark.parametrize("ports", [("Hamburg", "Kiel"), ("Antwerp", "Bergen")])
def test_ships_that_leave_an_approach_early_do_not_sail_to_its_end(ports):
    """Off the Scheldt ships turn north 20 nm before its western end, which they pass later.

    Positions every five minutes cut the bends of the Elbe by 1 %.
    """
    way = sea_distance(*ports)
    routes = (SyntheticRoute(way.line), SyntheticRoute(way.line[::-1]))
    messages = synthetic_fleet(
        SyntheticFleet(routes, ships=2, interval_s=300.0), start="2024-01-01", days=40, seed=5
    )
    made = history_from_tracks(read_fleet([messages]), Chart.gshhg("i"))
    for there in (ports, ports[::-1]):
        found = made.route(*there)
        assert found.nm == pytest.approx(way.nm, rel=0.018)
        assert found.globe_share < 0.04 and found.confidence == "high"


@pytest.mark.slow
def test_the_way_of_most_voyages_is_taken_though_it_leads_through_a_canal():
    by_canal = sea_distance("Hamburg", "Gothenburg")
    round_skaw = sea_distance("Hamburg", "Gothenburg", avoid=["kiel"])
    assert round_skaw.nm > 1.2 * by_canal.nm
    ways = [SyntheticRoute(by_canal.line, share=2.0, speed_kn=10.0),
            SyntheticRoute(round_skaw.line, share=1.0, speed_kn=18.0)]  # fmt: skip
    back = [SyntheticRoute(way.line[::-1], share=way.share, speed_kn=way.speed_kn) for way in ways]
    fleet = SyntheticFleet((*ways, *back), ships=8, interval_s=600.0)
    messages = synthetic_fleet(fleet, start="2024-01-01", days=60, seed=5)
    made = history_from_tracks(read_fleet([messages]), Chart.gshhg("i"))
    found = made.route("Hamburg", "Gothenburg")
    assert found.nm == pytest.approx(by_canal.nm, rel=0.02)
    assert found.confidence == "high" and found.globe_share < 0.05
    assert found.passes == ("kiel",) and "voyages from the one port to the other" in found.reason
    inner = found.duration[1] / 3600.0 * 10.0
    assert found.nm - 90.0 < inner < found.nm  # without the approaches, at 10 kn
    ends = made.port_node("Hamburg"), made.port_node("Gothenburg")
    [other] = made.whole_ways(*ends, made.weights())
    assert made.arcs.evidence.count[other] < found.whole


@pytest.mark.slow
def test_ships_from_a_river_into_a_canal_are_not_taken_out_to_sea():
    """Hamburg to Gothenburg: the Kiel Canal leaves the Elbe 40 nm before its sea end."""
    way = sea_distance("Hamburg", "Gothenburg")
    assert way.canals == ("Kiel Canal",)
    routes = (SyntheticRoute(way.line), SyntheticRoute(way.line[::-1]))
    fleet = SyntheticFleet(routes, ships=3, interval_s=900.0)
    messages = synthetic_fleet(fleet, start="2024-01-01", days=60, seed=5)
    chart = Chart.gshhg("i")
    made = history_from_tracks(read_fleet([messages]), chart)
    assert made.route("Hamburg", "Gothenburg").nm == pytest.approx(way.nm, rel=0.02)
    assert made.route("Gothenburg", "Hamburg").nm == pytest.approx(way.nm, rel=0.02)
    voyage = Voyage(start="Hamburg", goal="Gothenburg", depart="2024-01-10T00:00Z")
    found = plan(
        voyage, ship=Ship.simple(speed_kn=10.0, draught_m=3.0), sea=Sea.calm(), chart=chart,
        network=HistoryCorridor(made), proof=0.0,
    )  # fmt: skip
    assert found.best.feasible
    assert found.best.distance_nm == pytest.approx(way.nm, rel=0.02)
