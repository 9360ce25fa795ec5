"""Traffic of other ships: rates of encounters from zones and from rasters of density."""

import json
import math

import numpy as np
import pytest
import xarray as xr

from thalweg.chart import Chart
from thalweg.chart.zones.ship_traffic import TRAFFIC_SPEED, mean_relative_speed
from thalweg.core.errors import DatasetError, InputError
from thalweg.core.time import parse_time
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.route import Track, evaluate
from thalweg.route.indicator_columns import indicator_value
from thalweg.sea import Sea
from thalweg.ship import Ship

JULY, JANUARY = parse_time("2026-07-10T12:30Z"), parse_time("2026-01-10T12:30Z")


def _square(west, east, **properties):
    ring = [[west, 64.0], [east, 64.0], [east, 66.0], [west, 66.0], [west, 64.0]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def _zones(*features, **members):
    return {"type": "FeatureCollection", "features": list(features), **members}


def _rate(source, lon, time=JULY, speed=5.0):
    traffic = Chart.open_water().with_traffic(source).traffic
    return float(traffic.rate(65.0, lon, time, speed)[0])


@pytest.mark.parametrize("speed", [0.0, 2.0, TRAFFIC_SPEED, 20.0])
def test_mean_relative_speed_is_the_mean_over_all_directions(speed):
    theta = (np.arange(200_000) + 0.5) / 200_000 * 2.0 * math.pi
    u = TRAFFIC_SPEED
    expected = np.sqrt(speed**2 + u**2 - 2.0 * speed * u * np.cos(theta)).mean()
    assert float(mean_relative_speed(speed)) == pytest.approx(expected, rel=1e-8)


def test_rates_of_zones_and_unknown_water():
    zones = _zones(_square(0, 1, encounters_per_h=3.0), _square(0.5, 1, encounters_per_h=6.0))
    assert _rate(zones, 0.2) == pytest.approx(3.0 / HOUR)
    assert _rate(zones, 0.7) == pytest.approx(6.0 / HOUR)  # the greatest of two
    assert math.isnan(_rate(zones, 2.0))  # unknown, not zero
    assert _rate({**zones, "elsewhere": {"encounters_per_h": 0.0}}, 2.0) == 0.0
    miles = _zones(_square(0, 1, encounters_per_nm=2.0))
    assert _rate(miles, 0.5) == pytest.approx(2.0 / NAUTICAL_MILE * 5.0)
    dense = _zones(_square(0, 1, ships_per_km2=0.01))
    expected = 1e-8 * NAUTICAL_MILE * float(mean_relative_speed(5.0))
    assert _rate(dense, 0.5) == pytest.approx(expected)


def test_zones_hold_in_their_months_and_hours():
    summer = _zones(
        _square(0, 1, encounters_per_h=3.0, months=[6, 7, 8], hours=[12, 13]),
        elsewhere={"encounters_per_h": 1.0},
    )
    assert _rate(summer, 0.5, JULY) == pytest.approx(3.0 / HOUR)
    assert _rate(summer, 0.5, JANUARY) == pytest.approx(1.0 / HOUR)
    assert _rate(summer, 0.5, JULY + 2 * HOUR) == pytest.approx(1.0 / HOUR)


def _raster(units="km-2", **more):
    lat, lon = np.arange(64.0, 66.01, 0.5), np.arange(0.0, 2.01, 0.5)
    shape = [len(more[d]) for d in more]
    values = np.ones((*shape, len(lat), len(lon))) * 0.02
    if more:
        values *= np.arange(1, shape[0] + 1).reshape(-1, *[1] * (values.ndim - 1))
    values[..., -1] = np.nan
    coords = {**more, "lat": lat, "lon": lon}
    return xr.DataArray(
        values, dims=tuple(coords), coords=coords, attrs={"units": units}, name="density"
    )


def test_density_of_rasters_by_month_hour_and_unit():
    meeting = NAUTICAL_MILE * float(mean_relative_speed(5.0))
    assert _rate(_raster(), 0.7) == pytest.approx(0.02e-6 * meeting)
    assert math.isnan(_rate(_raster(), 2.0)) and math.isnan(_rate(_raster(), 5.0))
    monthly = _raster(month=np.arange(1, 13))
    assert _rate(monthly, 0.7, JULY) == pytest.approx(7 * 0.02e-6 * meeting)
    hourly = _raster(hour=np.arange(24))
    assert _rate(hourly, 0.7, JULY) == pytest.approx(13 * 0.02e-6 * meeting)
    emodnet = _raster("hours km-2 month-1")
    assert _rate(emodnet, 0.7) == pytest.approx(0.02e-6 / 730.5 * meeting)
    zones = Chart.open_water().with_traffic(_raster()).with_traffic(
        _zones(_square(0, 1, encounters_per_h=1.0))
    )  # fmt: skip
    assert zones.traffic.rate(65.0, 0.7, JULY, 5.0)[0] == pytest.approx(1.0 / HOUR)
    assert zones.fingerprint() != Chart.open_water().fingerprint()


@pytest.mark.parametrize(
    ("source", "text"),
    [
        (_zones(_square(0, 1)), "has the properties"),
        (_zones(_square(0, 1, encounters_per_h=-1)), "zero or more"),
        (_zones(_square(0, 1, encounters_per_h=1, encounters_per_nm=1)), "has one of"),
        (_zones(_square(0, 1, encounters_per_h=1, months=[13])), "months"),
        (_zones(_square(0, 1, encounter_per_h=1)), "encounter_per_h"),
        (_zones(_square(0, 1, encounters_per_h=1), elsewhere=3), "elsewhere"),
    ],
)
def test_zones_that_are_not_clear_are_refused(source, text):
    with pytest.raises(InputError, match=text):
        Chart.open_water().with_traffic(source)


def test_rasters_that_are_not_clear_are_refused():
    with pytest.raises(DatasetError, match="unit"):
        Chart.open_water().with_traffic(_raster("furlong-2"))
    with pytest.raises(DatasetError, match="axes"):
        Chart.open_water().with_traffic(_raster(depth=np.arange(3)))
    with pytest.raises(DatasetError, match="negative"):
        Chart.open_water().with_traffic(_negative())


def _negative():
    found = _raster()
    found[0, 0] = -9999.0
    return found


def test_encounters_of_a_route_add_up_over_legs_and_waits(tmp_path):
    path = tmp_path / "traffic.geojson"
    path.write_text(json.dumps(_zones(
        _square(0.0, 0.5, encounters_per_h=4.0), elsewhere={"encounters_per_h": 0.5}
    )))  # fmt: skip
    chart = Chart.open_water().with_traffic(path)
    ship = Ship.simple(speed_kn=10.0)
    track = Track.from_positions([(65.0, 0.0), (65.0, 0.25), (65.0, 1.0)], depart=JULY)
    track = track.replaced(wait=np.array([7200.0, 3600.0, 0.0]))
    route = evaluate(track, ship=ship, sea=Sea.calm(), chart=chart)
    dense = route.indicators["dense_traffic_h"]
    sailed = route.time_h - 2.0  # the wait at the berth does not count
    assert route.indicators["encounters"] == pytest.approx(4.0 * dense + 0.5 * (sailed - dense))
    half = route.distance_nm / 2.0 / 10.0
    assert dense == pytest.approx(half + 1.0, abs=0.01)
    legs = route.legs["encounters"]
    assert indicator_value(route, "encounters") == pytest.approx(legs.sum(), rel=1e-12)
    rows = route.waypoints()
    assert [row["encounters"] for row in rows] == [*legs, None]
    unknown = Chart.open_water().with_traffic(_zones(_square(0, 0.5, encounters_per_h=4.0)))
    part = evaluate(track, ship=ship, sea=Sea.calm(), chart=unknown)
    assert part.indicators["encounters"] is None
    assert any("encounters are not known" in text for text in part.assumptions)
    without = evaluate(track, ship=ship, sea=Sea.calm(), chart=Chart.open_water())
    assert without.indicators["encounters"] is None and without.indicators["inshore_nm"] == 0.0
