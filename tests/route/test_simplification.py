"""Simplification of refined routes."""

import numpy as np
import pytest

from thalweg import Sea, Ship, evaluate
from thalweg.core.geodesy import densify, positions_along
from thalweg.route import Track
from thalweg.route.refinement.simplification import simplified_route

SHIP = Ship.simple(speed_kn=10.0, draught_m=5.0)


def score(track):
    return evaluate(track, ship=SHIP, sea=Sea.calm())


def time_of(route):
    return route.time_h


def test_a_straight_line_needs_two_waypoints():
    lat, lon = positions_along(50.0, -10.0, 52.0, -3.0, np.linspace(0.0, 1.0, 60))
    route = score(Track.from_positions(zip(lat, lon), depart=0.0))
    fewer = simplified_route(route, score, time_of, most=np.inf)
    assert len(fewer.track.lat) == 2
    assert fewer.time_h == pytest.approx(route.time_h, rel=1e-6)


def test_corners_and_waits_stay():
    lat, lon, _ = densify([50.0, 51.0, 51.0], [-10.0, -9.0, -7.0], 6_000.0)
    track = Track.from_positions(zip(lat, lon), depart=0.0)
    wait = np.zeros(len(lat))
    wait[5] = 600.0
    route = score(track.replaced(wait=wait))
    fewer = simplified_route(route, score, time_of, most=np.inf)
    assert fewer.waiting_h == pytest.approx(600.0 / 3600.0)
    assert len(fewer.track.lat) == 4
    assert fewer.time_h <= route.time_h * (1 + 6.1e-5)


def test_waypoints_remain_if_removal_would_cost_more_than_allowed():
    bearing = np.linspace(0.0, np.pi, 60)
    track = Track.from_positions(zip(50.0 + np.sin(bearing), -5.0 - np.cos(bearing)), depart=0.0)
    route = score(track)
    fewer = simplified_route(route, score, time_of, most=0.0)
    assert fewer is route


def test_a_waypoint_beyond_the_end_of_a_line_is_not_on_it():
    lat, lon = positions_along(50.0, -10.0, 52.0, -3.0, np.linspace(0.0, 1.0, 60))
    lat, lon = np.append(lat, lat[-20]), np.append(lon, lon[-20])  # past the goal and back
    route = score(Track.from_positions(zip(lat, lon), depart=0.0))
    fewer = simplified_route(route, score, time_of, most=np.inf)
    assert len(fewer.track.lat) == 3
    assert fewer.time_h == pytest.approx(route.time_h, rel=1e-6)
