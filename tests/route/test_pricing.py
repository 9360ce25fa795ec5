"""Fuel, emissions and cost of evaluated routes: control areas, canals, waits, prices."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.canals import CORINTH, SUEZ, Canal, canals_with_dues
from thalweg.core.errors import InputError
from thalweg.core.geodesy import positions_along
from thalweg.core.units import DAY, KNOT, NAUTICAL_MILE
from thalweg.planning.report.route_summary import cost_text
from thalweg.route import Track, evaluate
from thalweg.route.formats import read_track, write_csv, write_geojson, write_gpx
from thalweg.sea import Sea
from thalweg.ship import Ship
from thalweg.ship.file.price_reader import fuel_terms
from thalweg.ship.fuel_prices import FuelTerms
from thalweg.ship.schema.ship_schema import ShipFile


def terms_of(sections: dict) -> FuelTerms:
    """Fuels and prices of a ship file with these sections."""
    return fuel_terms(ShipFile.of({"name": "ship", **sections}))


BULKER = Ship.load("handysize-bulker")
STEADY = Ship.from_dict(
    {**BULKER.data, "models": {"calm_water": "table", "speed_loss": "none"}, "limits": {}}
)
CALM = Sea.calm()
OPEN = Chart.open_water()


def zone(west, south, east, north, **properties):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": {"kind": "eca", **properties}, "geometry": geometry}


def test_cost_and_co2_of_a_leg_at_sea():
    """Table 5.3 of Seuren (2020): 39.0 t a day at 15.2 kn, 300 USD/t, 3.114 t CO2/t."""
    route = evaluate([(0, 0), (0, 5)], ship=BULKER, sea=CALM, chart=OPEN, depart=0)
    fuel = 39.0 * route.time_h / 24.0
    assert route.fuel_t == pytest.approx(fuel, rel=1e-9)
    assert route.cost == pytest.approx(300.0 * fuel, rel=1e-9)
    assert route.co2_t == pytest.approx(3.114 * fuel, rel=1e-9)
    assert route.fuel_eca_t == 0.0
    assert route.fuel_by_zone_t == {"outside": pytest.approx(fuel)}
    assert route.as_dict()["cost_usd"] == route.cost


def test_a_leg_half_inside_costs_half_and_half():
    chart = OPEN.with_zones(zone(0, -1, 2, 1, name="here"))
    ends = [(0, -1), (0, 1)]
    route = evaluate(ends, ship=BULKER, sea=CALM, chart=chart, depart=0)
    outside = evaluate(ends, ship=BULKER, sea=CALM, chart=OPEN, depart=0)
    assert route.cost == pytest.approx(outside.cost * (1 + 1.5593) / 2, rel=2e-6)
    assert route.fuel_eca_t == pytest.approx(route.fuel_t / 2, rel=2e-6)
    assert route.fuel_by_zone_t["here"] == pytest.approx(route.fuel_eca_t, rel=1e-12)
    assert sum(route.fuel_by_zone_t.values()) == pytest.approx(route.fuel_t, rel=1e-12)


@pytest.mark.parametrize("cuts", [[0.5], [0.1, 0.37, 0.9], np.linspace(0.02, 0.98, 25)])
def test_splitting_a_leg_changes_nothing(cuts):
    chart = OPEN.with_eca("north-sea").with_zones(zone(-8, 45, -7, 60, kind="price", factor=1.3))
    ends = ((63.5, -9.0), (51.0, 1.0))
    whole = evaluate(ends, ship=BULKER, sea=CALM, chart=chart, depart=0)
    middle = list(zip(*positions_along(*ends[0], *ends[1], np.array(cuts))))
    parts = evaluate([ends[0], *middle, ends[1]], ship=BULKER, sea=CALM, chart=chart, depart=0)
    for name in ("fuel_t", "co2_t", "cost", "fuel_eca_t"):
        assert getattr(parts, name) == pytest.approx(getattr(whole, name), rel=1e-6)
    assert 0.2 < whole.fuel_eca_t / whole.fuel_t < 0.9


def test_the_share_is_of_fuel_not_of_length_where_the_ship_slows_down():
    """Against a current of 5 kn in the eastern half, which is the control area."""
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, a, o: np.where(o > 0.0, -5.0 * KNOT, 0.0),
            "northward_sea_water_velocity": lambda t, a, o: 0.0 * a,
        }
    )
    chart = OPEN.with_zones(zone(0, -1, 2, 1))
    route = evaluate([(0, -1), (0, 1)], ship=STEADY, sea=sea, chart=chart, depart=0)
    expected = (1 / 10.2) / (1 / 10.2 + 1 / 15.2)
    assert route.fuel_eca_t / route.fuel_t == pytest.approx(expected, rel=1e-3)


def test_price_zones_multiply_and_another_fuel_burns_inside():
    both = OPEN.with_zones(
        [zone(0, -1, 2, 1, name="eca"), zone(0, -1, 2, 1, kind="price", factor=2.0)]
    )
    terms = terms_of(
        {"fuel": {"type": "hfo", "eca_type": "mgo", "price_per_t": 500.0, "eca_price_per_t": 800.0}}
    )
    route = evaluate([(0, 0.5), (0, 1)], ship=BULKER, sea=CALM, chart=both, depart=0, terms=terms)
    by_hfo = 39.0 * route.time_h / 24.0
    mgo = by_hfo * 40.2 / 42.7
    assert route.fuel_t == pytest.approx(mgo, rel=1e-9)
    assert route.co2_t == pytest.approx(3.206 * mgo, rel=1e-9)
    assert route.cost == pytest.approx(2.0 * 800.0 * mgo, rel=1e-9)


def test_time_and_waiting_have_a_price():
    terms = BULKER.fuel_terms.with_prices(time_usd_per_day=24_000.0)
    track = Track([0, 0, 0], [0, 1, 2], 0.0, [3600.0, 7200.0, 0.0])
    route = evaluate(track, ship=BULKER, sea=CALM, chart=OPEN, terms=terms)
    free = evaluate(track, ship=BULKER, sea=CALM, chart=OPEN)
    assert route.cost - free.cost == pytest.approx(1000.0 * route.time_h, rel=1e-9)
    data = dict(BULKER.data)
    hotel = Ship.from_dict(
        {**data, "engine": {"hotel_load_kw": 300.0, "hotel_sfoc_g_per_kwh": 200}}
    )
    rate = hotel.waiting_fuel_rate
    assert rate == pytest.approx(300.0 * 0.2 / 3600.0)
    chart = OPEN.with_zones(zone(0.5, -1, 3, 1))
    lying = evaluate(track, ship=hotel, sea=CALM, chart=chart)
    assert lying.legs["waiting_fuel"] == pytest.approx([3600.0 * rate, 7200.0 * rate])
    fuel = lying.legs["fuel"].sum() + lying.legs["waiting_fuel"].sum()
    assert lying.fuel_t == pytest.approx(fuel / 1000.0)
    inside = 0.5 * lying.legs["fuel"][0] + lying.legs["fuel"][1] + 7200.0 * rate
    assert lying.fuel_eca_t == pytest.approx(inside / 1000.0, rel=1e-5)


def test_unknown_prices_are_unknown_never_zero():
    ship = Ship.from_dict(
        {**{k: v for k, v in BULKER.data.items() if k != "fuel"}, "costs": {"hire_per_day": 1e4}}
    )
    route = evaluate([(0, 0), (0, 1)], ship=ship, sea=CALM, chart=OPEN, depart=0)
    assert route.fuel_t > 0.0
    assert route.cost is None and route.co2_t is None
    assert route.as_dict()["cost_usd"] is None
    assert route.waypoints()[-1]["cost_usd"] is None and route.waypoints()[-1]["co2_t"] is None
    speedy = Ship.simple(speed_kn=12.0, draught_m=5.0)
    route = evaluate([(0, 0), (0, 1)], ship=speedy, sea=CALM, chart=OPEN, depart=0)
    assert route.fuel_t is None and route.cost is None and route.fuel_eca_t is None
    assert route.fuel_by_zone_t is None


def test_the_currency_is_stated():
    euros = terms_of({"fuel": {"type": "hfo", "price_per_t": 500.0, "currency": "EUR"}})
    route = evaluate([(0, 0), (0, 1)], ship=BULKER, sea=CALM, depart=0, terms=euros)
    assert route.currency == "EUR"
    assert route.as_dict()["cost_eur"] == pytest.approx(500.0 * route.fuel_t)
    assert "EUR" in str(route) and "cost_eur" in route.waypoints()[0]
    unnamed = replace(euros, currency="")
    route = evaluate([(0, 0), (0, 1)], ship=BULKER, sea=CALM, depart=0, terms=unnamed)
    assert route.currency == "USD"
    assert any("name no currency" in text for text in route.assumptions)
    with pytest.raises(InputError, match="not FuelTerms"):
        evaluate([(0, 0), (0, 1)], ship=BULKER, sea=CALM, depart=0, terms=300.0)


def test_columns_are_sums_up_to_the_waypoint():
    chart = OPEN.with_zones(zone(1, -1, 2, 1))
    route = evaluate([(0, 0), (0, 1), (0, 2)], ship=BULKER, sea=CALM, chart=chart, depart=0)
    rows = route.waypoints()
    assert [row["cost_usd"] for row in rows] == pytest.approx(
        [0.0, route.legs["cost"][0], route.cost]
    )
    assert route.legs["cost"][1] == pytest.approx(1.5593 * route.legs["cost"][0], rel=1e-6)
    assert rows[-1]["co2_t"] == pytest.approx(route.co2_t)
    frame = route.to_frame()
    assert frame["cost_usd"].iloc[-1] == pytest.approx(route.cost)


# canals


@pytest.fixture(scope="module")
def world() -> Chart:
    return Chart.gshhg("l").with_eca()


def through(canal: Canal, before, after, backward=False):
    ends = canal.ends[::-1] if backward else canal.ends
    return [before, *ends, after]


@pytest.mark.parametrize("backward", [False, True])
def test_a_route_through_suez(world, backward):
    places = through(SUEZ, (32.5, 31.0), (28.9, 32.75))
    places = places[::-1] if backward else places
    depart = "2026-01-01T00:00Z"
    route = evaluate(places, ship=BULKER, sea=CALM, chart=world, depart=depart)
    assert route.feasible, route.violations
    leg = {name: values[1] for name, values in route.legs.items()}
    assert leg["arrive"] - leg["depart"] == pytest.approx(SUEZ.transit_time, abs=1e-3)
    assert leg["length"] == pytest.approx(SUEZ.length)
    # 185 km in 14 h are 7.2 kn: the slowest setting, 8.8 kn at 14.30 t a day, keeps up
    assert SUEZ.length / SUEZ.transit_time / KNOT == pytest.approx(7.2, abs=0.1)
    assert leg["fuel"] == pytest.approx(14_300.0 * SUEZ.transit_time / DAY)
    assert leg["cost"] == pytest.approx(leg["fuel"] * 0.3 + 112_327.0, rel=1e-3)
    assert any("Suez Canal: 112,327 USD, by suez net" in text for text in route.assumptions)
    sea = [k for k in range(3) if k != 1]
    assert route.distance_nm * NAUTICAL_MILE == pytest.approx(
        SUEZ.length + route.legs["length"][sea].sum()
    )
    assert route.fuel_by_zone_t["mediterranean"] > 0.0
    # the samples follow the canal, not the straight line
    on = route.samples["leg"] == 1
    assert np.abs(np.diff(route.samples["lon"][on])).max() < 0.05
    assert route.samples["lon"][on].min() == pytest.approx(32.30, abs=0.01)


def test_the_sea_and_the_land_are_not_looked_at_in_a_canal(world):
    """No data within the isthmus, and a canal that is not open to deep ships."""
    gone = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, a, o: np.where(
                (a > 30.0) & (a < 31.2), np.nan, 0.0
            ),
            "northward_sea_water_velocity": lambda t, a, o: 0.0 * a,
        }
    )
    places = through(SUEZ, (31.6, 32.3), (29.5, 32.5))
    route = evaluate(places, ship=STEADY, sea=gone, chart=world, depart=0)
    assert route.feasible, route.violations
    assert math.isfinite(route.cost)
    closed = evaluate(places, ship=BULKER, sea=CALM, chart=world.without_canals("suez"), depart=0)
    assert any(v.reason.startswith("land") for v in closed.violations)
    narrow = evaluate(
        through(CORINTH, (38.1, 22.7), (37.8, 23.2)), ship=BULKER, sea=CALM, chart=world, depart=0
    )
    (fault,) = [v for v in narrow.violations if v.reason.startswith("canal")]
    assert "draught of 9.5 m is over the 7.2 m" in fault.reason
    assert "beam of 23.4 m" in fault.reason


def test_a_canal_faster_than_the_ship_takes_its_highest_setting(world):
    quick = replace(SUEZ, transit_time=SUEZ.length / (30.0 * KNOT))
    chart = replace(world, canals=(quick,))
    route = evaluate(
        through(quick, (31.6, 32.3), (29.5, 32.5)), ship=BULKER, sea=CALM, chart=chart, depart=0
    )
    assert route.legs["fuel"][1] == pytest.approx(39_000.0 * quick.transit_time / DAY)


def test_dues_in_another_currency_leave_the_cost_unknown(world):
    euros = terms_of({"fuel": {"type": "hfo", "price_per_t": 500.0, "currency": "EUR"}})
    places = through(SUEZ, (31.6, 32.3), (29.5, 32.5))
    route = evaluate(places, ship=BULKER, sea=CALM, chart=world, depart=0, terms=euros)
    assert route.cost is None and route.fuel_t > 0.0
    assert any("fuel.usd_rate" in text for text in route.assumptions)
    assert "prices in EUR, and no fuel.usd_rate is given" in cost_text(route, [SUEZ])


def test_dues_are_paid_at_the_rate_of_the_dollar(world):
    fuel = {"type": "hfo", "price_per_t": 500.0, "currency": "EUR", "usd_rate": 0.8}
    places = through(SUEZ, (31.6, 32.3), (29.5, 32.5))
    route = evaluate(
        places, ship=BULKER, sea=CALM, chart=world, depart=0, terms=terms_of({"fuel": fuel})
    )
    dues = 0.8 * canals_with_dues([SUEZ], BULKER.file.hull)[0].fee
    assert route.cost_parts["canal dues"] == pytest.approx(dues)
    assert route.cost == pytest.approx(0.5 * 1000.0 * route.fuel_t + dues)
    text = cost_text(route, [SUEZ])
    assert "USD at 0.8 EUR" in text and f"canal dues {dues:,.0f})" in text


@pytest.mark.parametrize(
    ("ending", "write"), [("csv", write_csv), ("geojson", write_geojson), ("gpx", write_gpx)]
)
def test_a_canal_survives_files(world, tmp_path, ending, write):
    places = through(SUEZ, (31.6, 32.3), (29.5, 32.5), backward=False)
    route = evaluate(places, ship=BULKER, sea=CALM, chart=world, depart=0)
    path = tmp_path / f"route.{ending}"
    write(route, path)
    again = evaluate(read_track(path), ship=BULKER, sea=CALM, chart=world)
    assert again.legs["length"][1] == pytest.approx(SUEZ.length)
    assert again.cost == pytest.approx(route.cost, rel=1e-6)
    if ending == "geojson":
        features = json.loads(path.read_text())["features"]
        assert features[0]["properties"]["cost_usd"] == pytest.approx(route.cost)
        assert features[-1]["properties"]["co2_t"] == pytest.approx(route.co2_t, abs=5e-4)
    if ending == "csv":
        header = path.read_text().splitlines()[0].split(",")
        assert {"fuel_t", "co2_t", "cost_usd"} <= set(header)


# energy, and the price of speed


def test_energy_is_power_and_hotel_load_over_time_and_waiting_the_hotel_load():
    engine = {"reference_speed_kn": 10.0, "reference_power_kw": 2000.0, "hotel_load_kw": 300.0}
    cubic = {"hull": {"draught_m": 5.0}, "models": {"calm_water": "cubic"}}
    ship = Ship.from_dict({"name": "x", "speeds_kn": [5.0, 10.0], "engine": engine, **cubic})
    track = Track([0, 0, 0], [0, 1, 2], 0.0, [3600.0, 7200.0, 0.0], [0, 1])
    route = evaluate(track, ship=ship, sea=CALM, chart=OPEN)
    sailed = route.legs["arrive"] - route.legs["depart"]
    assert route.legs["energy"] == pytest.approx(np.array([550e3, 2300e3]) * sailed, rel=1e-9)
    assert route.legs["waiting_energy"] == pytest.approx([300e3 * 3600, 300e3 * 7200])
    whole = route.legs["energy"].sum() + route.legs["waiting_energy"].sum()
    assert route.energy_mwh == pytest.approx(whole / 3.6e9)
    assert route.as_dict()["energy_mwh"] == route.energy_mwh
    assert route.waypoints()[-1]["energy_mwh"] == pytest.approx(route.energy_mwh)
    assert set(route.samples["power"]) == {250e3, 2000e3}
    without = evaluate(track, ship=Ship.simple(speeds_kn=[5.0, 10.0]), sea=CALM, chart=OPEN)
    assert without.energy_mwh is None and without.as_dict()["energy_mwh"] is None


def test_energy_in_a_current_follows_the_time():
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, a, o: np.where(o > 0.5, -4.0 * KNOT, 0.0),
            "northward_sea_water_velocity": lambda t, a, o: 0.0 * a,
        }
    )
    ship = Ship.load("jbc")
    calm = Sea.layered(sea, CALM)
    route = evaluate([(0, 0), (0, 1)], ship=ship, sea=calm, chart=OPEN, depart=0)
    power = float(route.samples["power"][0])
    assert route.energy_mwh == pytest.approx(
        (power + ship.hotel_power) * route.time_h / 1e6, rel=1e-4
    )


def test_canals_take_the_power_and_the_cubed_speed_of_their_setting(world):
    engine = {"reference_speed_kn": 12.0, "reference_power_kw": 6000.0, "hotel_load_kw": 500.0}
    costs = {"per_week": 604800.0, "per_second_per_cubed_speed": 0.01}
    more = {"hull": {"draught_m": 5.0}, "models": {"calm_water": "cubic"}, "costs": costs}
    ship = Ship.from_dict({"name": "x", "speeds_kn": [6.0, 9.0, 12.0], "engine": engine, **more})
    places = through(SUEZ, (31.6, 32.3), (29.5, 32.5))
    route = evaluate(places, ship=ship, sea=CALM, chart=world, depart=0)
    brake = 6e6 * (9.0 / 12.0) ** 3  # 7.2 kn: 9 kn is the slowest setting that keeps up
    assert route.legs["energy"][1] == pytest.approx((brake + 5e5) * SUEZ.transit_time)
    spent = 1.0 + 0.01 * (9.0 * KNOT) ** 3
    assert route.legs["cost"][1] == pytest.approx(
        spent * SUEZ.transit_time + SUEZ.fee
    )  # size not known


def test_the_price_of_speed_counts_while_sailing_and_zones_multiply_it():
    costs = {"per_week": 604800.0, "per_second_per_cubed_speed": 0.01}
    ship = Ship.from_dict(
        {"name": "x", "speeds_kn": [10.0], "hull": {"draught_m": 5}, "costs": costs}
    )
    chart = OPEN.with_zones([zone(1, -1, 2, 1, kind="price", factor=2.0)])
    track = Track([0, 0, 0], [0, 1, 2], 0.0, [3600.0, 7200.0, 0.0])
    route = evaluate(track, ship=ship, sea=CALM, chart=chart)
    cube = 0.01 * (10.0 * KNOT) ** 3
    sailed = route.legs["arrive"] - route.legs["depart"]
    wanted = np.array([1.0, 2.0]) * cube * sailed + sailed + [3600.0, 7200.0]
    assert route.legs["cost"] == pytest.approx(wanted, rel=1e-6)


def test_a_speed_loss_beyond_its_range_is_an_assumption_of_the_route():
    wind = {
        "eastward_wind": lambda t, a, o: 15.0 + 0.0 * a,
        "northward_wind": lambda t, a, o: 0.0 * a,
    }
    waves = {"sea_surface_wave_significant_height": lambda t, a, o: 2.0 + 0.0 * a}
    sea = Sea.from_functions({**wind, **waves})
    route = evaluate([(0, 0), (0.2, 0)], ship=BULKER, sea=sea, chart=OPEN, depart=0)
    assert any("outside its range: kwon_2008: Beaufort" in text for text in route.assumptions)
