"""A bar in 2031 on the tide of constituents, and the coast of Prandle and Heaps."""

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.errors import NoRouteError
from thalweg.core.time import parse_time
from thalweg.planning import alternative_plans
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.single.no_route_diagnosis import unreached_goal_error
from thalweg.sea import standard_names as nm
from thalweg.sea.models.stratified_coast import stratified_coast_current
from thalweg.sea.tides.constituents import Constituents

AREA = (51.6, 51.9, 3.40, 3.75)


def _bar(time, lat, lon):
    return np.where((lon > 3.55) & (lon < 3.60), 7.0, 15.0) + 0.0 * lat


@pytest.fixture(scope="module")
def gauge():
    return Constituents.single(nm.WATER_LEVEL, {"M2": (1.4, 59.5), "S2": (0.3, 117.7)}, lat=51.4)


@pytest.mark.slow
def test_a_bar_is_crossed_when_the_tide_of_that_day_allows(gauge):
    start = parse_time("2031-07-05T00:00Z")
    times = start + 600.0 * np.arange(150)
    level = gauge.predict(nm.WATER_LEVEL, times)[0]
    low = times[int(np.argmin(level))]
    sea = Sea.from_tides(gauge, area=AREA) + Sea.from_functions({nm.BED_DEPTH: _bar})
    ship = Ship.load("hopper-dredger").with_load_factor(1.0)  # draught 6.5 m
    voyage = Voyage(start=(51.71, 3.45), goal=(51.77, 3.70), depart=float(low), min_ukc_m=1.0)
    best = plan(voyage, ship=ship, sea=sea, chart=Chart.open_water(*AREA), resolution=1000.0).best
    assert best.waiting_h > 1.0
    assert best.min_ukc_m >= 1.0 - 1e-6
    # the bar opens when the level passes 0.5 m (6.5 + 1 - 7), about; the ship does not dawdle
    opening = times[np.flatnonzero((times > low) & (level > 0.5))[0]]
    assert best.arrive >= opening
    assert best.arrive < opening + 2.5 * 3600.0


@pytest.mark.slow
def test_alternatives_wait_for_the_tide_where_no_other_route_is_found(gauge):
    """Prices of miles are searched without waits first, and with waits where none keeps depth."""
    times = parse_time("2031-07-05T00:00Z") + 600.0 * np.arange(150)
    low = times[int(np.argmin(gauge.predict(nm.WATER_LEVEL, times)[0]))]
    sea = Sea.from_tides(gauge, area=AREA) + Sea.from_functions({nm.BED_DEPTH: _bar})
    ship = Ship.from_dict(
        {
            "name": "tug",
            "hull": {"draught_m": 4.4},
            "speeds_kn": [6, 12],
            "engine": {"reference_power_kw": 2400, "sfoc_g_per_kwh": 205},
            "models": {"calm_water": "cubic"},
        }
    )
    ends = {"start": (51.71, 3.45), "goal": (51.77, 3.70), "depart": float(low), "min_ukc_m": 3.1}
    given = {"ship": ship, "sea": sea, "chart": Chart.open_water(*AREA), "resolution": 1500.0}
    found = alternative_plans(Voyage(**ends), **given)
    assert found.choices[0].route.waiting_h > 1.0
    notes = " ".join(found.notes)
    assert "node" not in notes and "No route for distance" not in notes
    inshore = plan(Voyage(**ends, objective="inshore"), **given).best
    assert inshore.feasible and inshore.waiting_h > 1.0


def test_a_search_without_a_path_is_reported_in_the_words_of_the_voyage():
    error = NoRouteError(
        "There is no path from node 879 to node 880.",
        reasons={"under-keel clearance": 473, "no data": 795},
        nearest=(0.0, 0.5),
    )
    ends = Endpoint("A", 0.0, 0.0, 0.0), Endpoint("B", 0.0, 1.0, 0.0)
    told = unreached_goal_error(error, ends, 0.0, wait=False)
    assert str(told) == (
        "No route from A to B keeps the limits without a wait, departing 1970-01-01T00:00:00Z. "
        "The nearest point reached is 0.0000N 0.5000E, 30.1 nm short. Load less (--load-factor), "
        "require less clearance (--ukc), or allow waiting for the tide."
    )
    assert told.reasons == error.reasons


@pytest.mark.slow
def test_departing_with_the_flood_shortens_the_passage():
    coast = stratified_coast_current(
        "spring", coast=(51.75, 4.0), onshore_deg=90.0, flood="2031-07-05T06:00Z", draught=5.0
    )
    sea = Sea.from_functions(coast)
    ship = Ship.simple(8.0, 5.0)
    chart = Chart.open_water(51.5, 52.5, 3.0, 4.0)
    found = {
        when: plan(
            Voyage(start=(51.6, 3.6), goal=(52.1, 3.6), depart=f"2031-07-05T{when}Z"),
            ship=ship, sea=sea, chart=chart, resolution=4000.0,
        ).best.time_h
        for when in ("04:15", "10:30")
    }  # fmt: skip
    still = 30.05 / 8.0  # h for half a degree of latitude
    assert found["04:15"] < still - 0.2 < still + 0.1 < found["10:30"]


@pytest.mark.slow
def test_a_data_gap_during_a_wait_is_reported(tmp_path):
    hours = np.array([0.0, 0.5, 1.0, 5.0, 5.5, 6.0, 6.5, 7.0])
    axes, ones = ("time", "lat", "lon"), np.ones((8, 5, 5))
    path = tmp_path / "gap.nc"
    xr.Dataset(
        {"zeta": (axes, ones, {"standard_name": "sea_surface_height", "units": "m"}),
         "h": (axes[1:], 15.0 * ones[0], {"standard_name": "sea_floor_depth_below_geoid",
                                         "units": "m"})},
        {"time": np.datetime64("2026-01-01", "ns") + (3600.0 * hours).astype("timedelta64[s]"),
         "lat": np.linspace(51.6, 52.0, 5), "lon": np.linspace(3.4, 3.8, 5)},
    ).to_netcdf(path)  # fmt: skip
    voyage = Voyage(
        start=(51.71, 3.45), goal=(51.77, 3.70), depart="2026-01-01T00:30Z", min_ukc_m=1.0
    )
    chart = Chart.open_water(51.6, 52.0, 3.4, 3.8)
    ship = Ship.load("hopper-dredger")
    found = plan(voyage, ship=ship, sea=Sea.open(path), chart=chart, resolution=1000.0)
    assert found.best.feasible and found.best.waiting_h > 4.0
    assert any(
        "a gap from 2026-01-01T01:00:00Z to 2026-01-01T05:00:00Z" in note for note in found.notes
    )
