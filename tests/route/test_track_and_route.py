"""Tracks, routes as values, and joining."""

import dataclasses
import json

import numpy as np
import pytest

from tests.route.planar import ship
from thalweg.core.errors import InputError
from thalweg.route import Track, Violation, evaluate, join
from thalweg.sea import Sea
from thalweg.ship import Ship


def test_track_is_checked_and_frozen():
    track = Track([0, 1], [179, 181], 0.0)
    assert track.lon.tolist() == [179.0, -179.0]
    assert track.setting.tolist() == [-1]
    assert track == Track([0, 1], [179, -179], 0.0)
    with pytest.raises(ValueError, match="read-only"):
        track.lat[0] = 5.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        track.depart = 1.0
    for bad, message in (
        (dict(lat=[0], lon=[0]), "1 waypoint"),
        (dict(lat=[0, 1], lon=[0]), "longitudes"),
        (dict(lat=[0, np.nan], lon=[0, 1]), "not a pair of numbers"),
        (dict(lat=[0, 120], lon=[0, 30]), "swapped"),
        (dict(lat=[0, 1], lon=[0, 1], wait=[0, 5]), "wait"),
        (dict(lat=[0, 1], lon=[0, 1], wait=[-1, 0]), "wait"),
        (dict(lat=[0, 1], lon=[0, 1], setting=[1, 2]), "settings"),
    ):
        with pytest.raises(InputError, match=message):
            Track(depart=0.0, **bad)


def test_repeated_positions_are_merged():
    track = Track.from_positions([(0, 0), (0, 0), (1, 1), (1, 1)], depart="1970-01-01T00:00Z")
    assert track.positions == [(0.0, 0.0), (1.0, 1.0)]
    with pytest.raises(InputError, match="pair"):
        Track.from_positions([(0, 0, 0)], depart=0)


def test_route_is_plain_data_on_demand():
    route = evaluate([(50, 0), (51, 1)], ship=ship(5.0), sea=Sea.calm(), depart="2026-01-01T00:00Z")
    data = json.loads(json.dumps(route.as_dict(), allow_nan=False))
    assert data["depart"] == "2026-01-01T00:00:00Z"
    assert data["feasible"] is True
    assert data["waypoints"][-1]["speed_over_ground_kn"] is None
    with pytest.raises(TypeError):
        route.samples["time"] = 0
    with pytest.raises(ValueError, match="read-only"):
        route.samples["time"][0] = 0.0
    assert "nm" in str(route)


def test_violation_has_a_position():
    text = str(Violation("under-keel clearance", 0.0, 52.0, 4.1, -0.5, 1.0))
    assert text == (
        "under-keel clearance at 52 00.0N 004 06.0E on 1970-01-01 00:00 UTC (-0.50 m, limit 1.00 m)"
    )
    windy = Violation("wind speed above the limit (waiting)", np.nan, 52.0, 4.1, 10.0, 5.0)
    assert str(windy).endswith("at 52 00.0N 004 06.0E (19.44 kn, limit 9.72 kn)")
    assert Violation("land: leg 2", float("nan"), 0.0, 0.0).as_dict()["time"] is None


def test_fuel_between_joined_routes_is_unknown_not_zero():
    boat = Ship.load("vox-olympia")
    depth = {"sea_floor_depth_below_geoid": lambda t, lat, lon: 20.0 + 0.0 * lat}
    sea = Sea.from_functions(depth).filled(wind=0.0, waves=0.0, currents=0.0)
    first = evaluate([(52.0, 3.0), (52.1, 3.0)], ship=boat, sea=sea, depart=0)
    at_once = evaluate([(52.1, 3.0), (52.2, 3.0)], ship=boat, sea=sea, depart=first.arrive)
    later = evaluate([(52.1, 3.0), (52.2, 3.0)], ship=boat, sea=sea, depart=first.arrive + 3600)
    assert join([first, at_once]).fuel_t == pytest.approx(first.fuel_t + at_once.fuel_t)
    both = join([first, later])
    assert (both.fuel_t, both.energy_mwh, both.co2_t) == (None, None, None)
    hour = evaluate(both, ship=boat, sea=sea).fuel_t - first.fuel_t - later.fuel_t
    assert hour == pytest.approx(3.6 * boat.waiting_fuel_rate, rel=1e-3)


def test_joined_routes_add_up():
    boat, sea = ship(5.0), Sea.calm()
    first = evaluate([(0, 0), (0, 1)], ship=boat, sea=sea, depart=0)
    second = evaluate([(0, 1), (1, 1)], ship=boat, sea=sea, depart=first.arrive + 3600)
    both = join([first, second])
    assert both.arrive == second.arrive
    assert both.distance_nm == pytest.approx(first.distance_nm + second.distance_nm)
    assert both.waiting_h == pytest.approx(1.0)
    assert len(both.track) == 3
    assert np.all(np.diff(both.samples["distance"]) >= 0)
    again = evaluate(both, ship=boat, sea=sea)
    assert again.arrive == pytest.approx(both.arrive, abs=1e-6)
    for wrong in ([second, first], [first, first], []):
        with pytest.raises(InputError):
            join(wrong)


def test_a_track_along_a_path_waits_where_it_departs_later():
    lat, lon = np.array([0.0, 0.0, 0.0, 0.0]), np.array([0.0, 1.0, 2.0, 3.0])
    arrive, depart = [100.0, 300.0, 500.0, 700.0], [160.0, 300.9, 499.9, 900.0]
    track = Track.along_path(lat, lon, arrive=arrive, depart=depart, setting=2)
    assert track.depart == 100.0
    assert track.wait.tolist() == [60.0, 0.0, 0.0, 0.0]
    assert track.setting.tolist() == [2, 2, 2]
    assert depart[-1] == 900.0
    own = Track.along_path(lat, lon, arrive=arrive, depart=depart, setting=[0, 1, 2])
    assert own.setting.tolist() == [0, 1, 2]
