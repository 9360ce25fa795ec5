"""Restrictions of the chart: canals and ice latitudes; concatenated networks."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.chart.passages import find_passages
from thalweg.core.errors import NoRouteError
from thalweg.network import check_network, lattice, shortest_path
from thalweg.network.global_grid.ice_limits import northern_limit
from thalweg.network.network_concatenation import CanalLink, concatenate_networks
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.planning.report.zone_report import far_area_notes
from thalweg.planning.request.chart_restrictions import (
    ICE_LIMIT_NORTH,
    exclude_closed_canals,
    exclude_ice_latitudes,
)
from thalweg.planning.request.offing_choice import size_restriction
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.sea_distance import sea_distance
from thalweg.route import Track, evaluate

SHIP = Ship.simple(speed_kn=12.0, draught_m=5.0)
CHART = Chart.gshhg("i")
ELBE, GDANSK, OFF_KIEL = (53.9, 8.9), (54.6, 18.9), (54.6, 10.6)


def network(start, goal, **more):
    return lattice(Chart.open_water(-3.0, 3.0, -3.0, 8.0), start, goal, **more)


def length(net):
    return shortest_path(net, net.meta.start, net.meta.goal)[0][net.meta.goal]


@pytest.mark.slow
def test_joined_networks_are_as_long_as_their_parts():
    parts = [network((0.0, 0.0), (1.0, 2.0)), network((1.0, 2.0), (0.0, 4.0))]
    whole = concatenate_networks(parts, [None])
    check_network(whole)
    assert whole.n_nodes == parts[0].n_nodes + parts[1].n_nodes - 1
    assert length(whole) == pytest.approx(sum(length(part) for part in parts), rel=1e-12)


@pytest.mark.slow
def test_a_canal_between_networks_takes_its_time_and_fee():
    parts = [network((0.0, 0.0), (0.0, 1.0)), network((0.0, 1.5), (0.0, 3.0))]
    link = CanalLink(80_000.0, 36_000.0, 5_000.0)
    whole = concatenate_networks(parts, [link])
    check_network(whole)
    canal = np.flatnonzero(np.isfinite(whole.edges.fixed_time))
    assert len(canal) == 1
    assert whole.edges.fixed_time[canal[0]] == 36_000.0 and whole.edges.fee[canal[0]] == 5_000.0
    assert length(whole) == pytest.approx(sum(length(part) for part in parts) + 80_000.0)


@pytest.mark.slow
def test_the_kiel_canal_is_taken_unless_forbidden():
    voyage = {"start": ELBE, "goal": GDANSK, "depart": "2026-01-01T00:00Z"}
    by_canal = plan(Voyage(**voyage), ship=SHIP, sea=Sea.calm(), chart=CHART)
    round_skagen = plan(Voyage(**voyage, forbid=["kiel"]), ship=SHIP, sea=Sea.calm(), chart=CHART)
    track = by_canal.best.track
    legs = CHART.canal_of_legs(track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:])
    assert [CHART.canals[i].name for i in legs if i >= 0] == ["kiel"]
    assert by_canal.best.feasible and round_skagen.best.feasible
    assert by_canal.best.distance_nm == pytest.approx(375.0, abs=4.0)
    assert round_skagen.best.track.lat.max() > 57.7  # Skagen
    canal = CHART.canals[[c.name for c in CHART.canals].index("kiel")]
    sailed = by_canal.best.distance_nm - canal.length / 1852.0
    assert by_canal.best.time_h == pytest.approx(
        sailed / 12.0 + canal.transit_time / 3600.0, rel=1e-3
    )


@pytest.mark.slow
def test_the_bound_of_a_cost_counts_the_dues_of_a_canal_or_the_way_round_it():
    ship = Ship.from_dict(
        {
            "name": "x", "hull": {"draught_m": 5.0}, "speeds_kn": [8.0, 12.0],
            "fuel": {"reference_t_per_day": 24.0, "price_per_t": 500.0},
            "engine": {"reference_speed_kn": 12.0}, "models": {"calm_water": "cubic"},
        }
    )  # fmt: skip
    start = (54.0, 5.0)  # from where the way round Skagen is not much longer
    voyage = {"start": start, "goal": GDANSK, "depart": "2026-01-01T00:00Z", "objective": "cost"}
    chart = Chart.gshhg("l")
    given = {"ship": ship, "sea": Sea.calm(), "chart": chart, "resolution": 40_000.0}
    answer = plan(Voyage(**voyage, method="exact"), **given, proof=2.0)
    other = plan(Voyage(**voyage, method="exact", forbid=["kiel"]), **given, proof=0.0)
    assert "with the time, dues and fuel of canals, or the way round them" in answer.proof.kind
    assert "dues" not in other.proof.kind
    both = sorted((answer.best.cost, other.best.cost))
    assert 0.75 * both[0] < answer.lower_bound <= both[0]
    # from beside the canal the way round is 1.8 times as long, and still cheaper than the dues
    voyage["start"] = ELBE
    beside = plan(Voyage(**voyage, method="exact"), **given, proof=2.0)
    round_skagen = plan(Voyage(**voyage, method="exact", forbid=["kiel"]), **given, proof=0.0)
    assert beside.best.cost == pytest.approx(round_skagen.best.cost, rel=0.02)
    dues = max(canal.fee for canal in chart.canals if canal.name == "kiel")
    assert dues < beside.lower_bound <= beside.best.cost
    assert not any("leaves the canal dues out" in text for text in beside.notes)


def test_a_deep_ship_does_not_pass_a_shallow_canal():
    ends = [Endpoint("a", *ELBE, 0.0), Endpoint("b", *GDANSK, 0.0)]
    voyage = Voyage(start=ELBE, goal=GDANSK, depart="2026-01-01T00:00Z")
    chart, notes = exclude_closed_canals(CHART, voyage, Ship.simple(draught_m=12.0), ends)
    assert "kiel" not in [canal.name for canal in chart.canals]
    assert "suez" in [canal.name for canal in chart.canals]
    assert len(notes) == 1 and "Kiel Canal" in notes[0] and "draught of 12 m" in notes[0]


def test_canals_are_left_out_of_a_cost_in_another_currency_than_their_dues():
    ends = [Endpoint("a", *ELBE, 0.0), Endpoint("b", *GDANSK, 0.0)]
    data = {
        "name": "x", "hull": {"draught_m": 5.0}, "speeds_kn": [8.0, 12.0],
        "fuel": {"reference_t_per_day": 24.0, "price_per_t": 500.0},
        "engine": {"reference_speed_kn": 12.0}, "models": {"calm_water": "cubic"},
    }  # fmt: skip

    def passed(currency, objective, **more):
        ship = Ship.from_dict({**data, "fuel": {**data["fuel"], "currency": currency, **more}})
        depart = "2026-01-01T00:00Z"
        voyage = Voyage(start=ELBE, goal=GDANSK, depart=depart, objective=objective)
        chart, notes = exclude_closed_canals(CHART, voyage, ship, ends)
        return "kiel" in [canal.name for canal in chart.canals], notes

    assert passed("USD", "cost") == (True, [])
    assert passed("EUR", "fuel") == (True, [])
    open_, notes = passed("EUR", "cost")
    assert not open_ and len(notes) == 1
    assert "Kiel Canal: they are in USD, the prices in EUR" in notes[0]
    assert count_of_dangers(notes) == 1  # no summary leaves it out
    assert passed("EUR", "cost", usd_rate=0.9) == (True, [])


@pytest.mark.slow
def test_a_least_cost_is_the_same_in_another_currency_at_its_rate():
    def cheapest(price, **currency):
        fuel = {"reference_t_per_day": 24.0, "price_per_t": price, **currency}
        ship = Ship.from_dict(
            {
                "name": "x", "hull": {"draught_m": 5.0}, "speeds_kn": [8.0, 10.0, 12.0],
                "fuel": fuel, "engine": {"reference_speed_kn": 12.0},
                "models": {"calm_water": "cubic"}, "costs": {"hire_per_day": 20.0 * price},
            }
        )  # fmt: skip
        depart = "2026-01-01T00:00Z"
        voyage = Voyage(start=ELBE, goal=OFF_KIEL, depart=depart, objective="cost")
        return plan(voyage, ship=ship, sea=Sea.calm(), chart=CHART, resolution=40_000.0, proof=1.0)

    dollars = cheapest(500.0)
    euros = cheapest(400.0, currency="EUR", usd_rate=0.8)
    assert euros.best.cost == pytest.approx(0.8 * dollars.best.cost, rel=1e-6)
    assert euros.best.cost_parts["canal dues"] > 0.0
    assert euros.lower_bound == pytest.approx(0.8 * dollars.lower_bound, rel=1e-3)


def test_ice_latitudes_are_excluded_unless_the_voyage_goes_there():
    def reach(lat):
        chart, _ = exclude_ice_latitudes(
            CHART, [Endpoint("a", 60.0, 0.0, 0.0), Endpoint("b", lat, 10.0, 0.0)]
        )
        return chart.is_navigable(np.array([73.0, 79.5]), np.array([10.0, 5.0])).tolist()

    assert reach(62.0) == [False, False]
    assert reach(78.0) == [True, True]
    assert ICE_LIMIT_NORTH < 72.0  # Bellot Strait, the route north of America


@pytest.mark.slow
def test_a_missing_route_without_canals_is_reported():
    chart = Chart.gshhg("c").within(26.0, 34.0, 28.0, 37.0)  # on both sides of Suez
    voyage = Voyage(
        start=(33.0, 30.0), goal=(27.5, 34.5), depart="2026-01-01T00:00Z", forbid=["all"],
        offing_nm=0.0,  # without a plan at each smaller distance from land
    )  # fmt: skip
    with pytest.raises(NoRouteError):
        plan(voyage, ship=SHIP, sea=Sea.calm(), chart=chart, resolution=30_000.0)


@pytest.mark.parametrize(("height", "closed"), [(None, set()), (39.0, set()), (45.0, {"kiel"})])
def test_canals_and_passages_under_lower_bridges_are_closed(height, closed):
    """The bridges of the Kiel Canal leave 40 m, that of Naeroysund 41 m."""
    hull = {"draught_m": 5.0, "length_overall_m": 110.0, "breadth_m": 16.0}
    hull |= {} if height is None else {"air_draught_m": height}
    ship = Ship.from_dict({"name": "x", "hull": hull, "speeds_kn": [12.0]})
    voyage = Voyage(start=ELBE, goal=GDANSK, depart="2026-03-01")
    ends = [Endpoint("a", *ELBE, 0.0), Endpoint("b", *GDANSK, 0.0)]
    left, _ = exclude_closed_canals(CHART, voyage, ship, ends)
    names = {"kiel", "suez", "panama"}
    assert names - {canal.name for canal in left.canals} == closed
    (bridge,) = find_passages(["Naeroysund"])
    assert bool(size_restriction(bridge, ship)) == (height == 45.0)


@pytest.mark.parametrize(
    ("places", "north"),
    [
        ([(69.0, 33.0), (51.9, 4.1)], 72.0),  # Murmansk, Rotterdam
        ([(69.0, 33.0), (69.7, 170.3)], 81.0),  # Murmansk, Pevek: by Vilkitsky
        ([(70.3, -148.5), (49.3, -123.1)], 81.0),  # Prudhoe Bay, Vancouver
        ([(78.2, 15.6), (51.9, 4.1)], 81.0),  # Longyearbyen
        ([(82.5, -62.3), (51.9, 4.1)], 90.0),  # Alert
    ],
)
def test_ways_to_arctic_coasts_go_as_far_north_as_vilkitsky(places, north):
    assert northern_limit(*places) == north


@pytest.mark.slow
def test_murmansk_to_pevek_leads_along_the_coast():
    """It was refused, and planned by Panama (12,047 nm)."""
    way = sea_distance("Murmansk", "Pevek")
    assert "Vilkitsky" in way.straits and not way.canals
    assert way.nm == pytest.approx(2400.0, rel=0.04)


def test_areas_far_from_the_voyage_are_stated_with_the_order_of_coordinates():
    """A no-go zone with latitude and longitude exchanged was ignored without a word."""
    corners = [(52.1, 2.5), (52.6, 2.5), (52.6, 3.0), (52.1, 3.0), (52.1, 2.5)]

    def notes(ring):
        area = {
            "type": "Feature",
            "properties": {"kind": "no-go"},
            "geometry": {"type": "Polygon", "coordinates": [[list(corner) for corner in ring]]},
        }
        chart = Chart.open_water(51.0, 54.0, 2.0, 5.0).with_zones(
            {"type": "FeatureCollection", "features": [area]}
        )
        track = Track([52.0, 53.0], [3.2, 3.4], 0.0)
        route = evaluate(track, ship=Ship.simple(10.0, 5.0), sea=Sea.calm(), chart=chart)
        return far_area_notes(chart, route)

    (note,) = notes(corners)
    assert "the nearest of the 1 begins at 3.0000N 52.1000E, more than 300 nm away" in note
    assert "latitude and longitude are exchanged" in note
    assert notes([corner[::-1] for corner in corners]) == []
