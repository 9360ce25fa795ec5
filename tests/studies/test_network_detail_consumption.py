"""Fuel, CO2 and cost of the detail 'network': those of the referee, control areas included."""

from __future__ import annotations

from importlib import resources

import numpy as np
import pytest
import yaml

pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")

from thalweg.chart import Chart
from thalweg.core.time import parse_time
from thalweg.planning import Voyage
from thalweg.planning.departures.departure_series import DepartureSeries
from thalweg.sea import Sea
from thalweg.ship import Ship
from thalweg.studies.row_runner import worst_weather

DAY = parse_time("2026-01-05T00:00Z")
SHAPE = {"layers": 7, "fan": 5, "offset_nm": 4.0}
AREA = [[1.0, 64.0], [3.0, 64.0], [3.0, 66.0], [1.0, 66.0], [1.0, 64.0]]
#: Heat of heavy fuel oil over that of marine gas oil [MJ/kg] (MEPC.364(79)).
HFO_TO_MGO = 40.2 / 42.7


def zones(kind, **properties):
    shape = {"type": "Polygon", "coordinates": [AREA]}
    feature = {"type": "Feature", "properties": {"kind": kind} | properties, "geometry": shape}
    return {"type": "FeatureCollection", "features": [feature]}


def bulker(**fuel) -> Ship:
    library = resources.files("thalweg.ship.library").joinpath("handysize-bulker.yaml")
    data = yaml.safe_load(library.read_text("utf-8"))
    del data["fuel"]["eca_price_factor"]
    burnt = {key: value for key, value in (data["fuel"] | fuel).items() if value is not None}
    return Ship.from_dict(data | {"fuel": burnt, "costs": {"hire_per_day": 9000.0}})


def series_and_route(chart, **fuel):
    series = DepartureSeries.prepare(
        Voyage(start=(65.0, 0.0), goal=(65.0, 2.0), depart=DAY, offing_nm=0.0, layered=SHAPE),
        ship=bulker(**fuel), sea=Sea.calm(), chart=chart, network="layered",
    )  # fmt: skip
    (figures,) = series.figures([DAY])
    return figures, series.refereed(DAY)


def test_the_part_of_the_way_in_a_control_area_burns_its_fuel():
    chart = Chart.open_water().with_zones(zones("eca"))
    figures, route = series_and_route(chart, eca_type="mgo", eca_price_per_t=700.0)
    plain, _ = series_and_route(Chart.open_water().without_eca(), eca_type="mgo")
    half = 0.5 * plain["fuel_t"]
    assert figures["fuel_eca_t"] == pytest.approx(half * HFO_TO_MGO, rel=2e-3)
    assert figures["fuel_t"] == pytest.approx(half * (1.0 + HFO_TO_MGO), rel=1e-3)
    for name in ("fuel_t", "fuel_eca_t", "co2_t"):
        assert figures[name] == pytest.approx(getattr(route, name), rel=1e-4), name
    assert figures["cost_usd"] == pytest.approx(route.cost, rel=1e-4)
    assert figures["currency"] == "USD"


def test_price_zones_and_hire_count():
    chart = Chart.open_water().with_zones(zones("price", factor=2.0)).without_eca()
    figures, route = series_and_route(chart)
    fuel, hire = 300.0 * figures["fuel_t"], 9000.0 * figures["time_h"] / 24.0
    assert figures["cost_usd"] == pytest.approx(1.5 * fuel + hire, rel=1e-3)
    assert figures["cost_usd"] == pytest.approx(route.cost, rel=1e-4)
    assert "fuel_eca_t" not in figures


def test_fuel_without_a_carbon_factor_has_unknown_co2():
    figures, route = series_and_route(Chart.open_water().without_eca(), type=None)
    assert route.co2_t is None and figures["co2_t"] is None
    assert np.isfinite(figures["fuel_t"])


def test_the_worst_weather_of_a_refined_row_leaves_out_approaches():
    """No weather is known on the approaches of ports."""
    height, east = np.array([np.nan, 1.5, 2.0, np.nan]), np.array([np.nan, 3.0, -6.0, np.nan])
    found = worst_weather(
        {
            "sea_surface_wave_significant_height": height,
            "eastward_wind": east,
            "northward_wind": 0.0 * east,
        }
    )
    assert found["max_significant_wave_height_m"] == 2.0
    assert found["max_wind_speed_ms"] == 6.0
    assert found["max_current_ms"] is None
