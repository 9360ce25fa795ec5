"""Banks narrower than the network's spacing: planned round, not answered with a breach."""

from datetime import UTC, datetime
from types import SimpleNamespace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import distance
from thalweg.core.units import HOUR, KNOT
from thalweg.kernels import codes
from thalweg.planning.single import exceeded_limits
from thalweg.route.route import SPEED_NOT_PREDICTED, Violation

SHIP = Ship.simple(speed_kn=10.0, draught_m=5.0)
WATER = Chart.open_water(49.9, 51.1, 0.5, 3.5)
BANK = (50.5, 1.98, 0.05)  # 5.5 km long and 1.4 km wide, between the nodes
CURRENT = ("eastward_sea_water_velocity", "northward_sea_water_velocity")


def bank_depth(time, lat, lon):
    across = np.hypot((lat - BANK[0]) / 1.0, (lon - BANK[1]) * 2.5)
    return np.where(across < BANK[2], 3.0, 20.0) + 0.0 * time


@pytest.mark.parametrize("objective", ["time", "distance"])
@pytest.mark.parametrize("resolution", [30_000.0])
@pytest.mark.slow
def test_a_closed_bank_between_the_nodes_is_planned_round(objective, resolution) -> None:
    """Both were once answered with a route over the bank, 3 m too shallow."""
    still = {name: lambda time, lat, lon: 0.0 * lat for name in CURRENT}
    sea = Sea.from_functions({"sea_floor_depth_below_geoid": bank_depth, **still})
    voyage = Voyage(
        start=(50.5, 1.0), goal=(50.5, 3.0), depart="2026-01-01", objective=objective, min_ukc_m=1.0
    )
    best = plan(voyage, ship=SHIP, sea=sea, chart=WATER, resolution=resolution).best
    assert best.feasible
    assert best.min_ukc_m >= 1.0
    assert 76.6 < best.distance_nm < 84.0  # straight over the bank: 76.6


@pytest.mark.slow
def test_a_ship_waits_for_the_tide_at_a_bar_between_the_nodes() -> None:
    """Once planned over the bar at low water, 0.6 m too shallow, and 1.6 h faster than possible."""
    period, high, bar = 12.42 * HOUR, 6.0 * HOUR, (0.50, 0.51)
    first = datetime(2026, 1, 1, tzinfo=UTC).timestamp()

    def depth(time, lat, lon):
        return np.where((lon > bar[0]) & (lon < bar[1]), 5.0, 30.0) + 0.0 * lat

    def level(time, lat, lon):
        return 1.05 * np.cos(2.0 * np.pi * (time - first - high) / period) + 0.0 * lat

    sea = Sea.from_functions(
        {
            "sea_floor_depth_below_geoid": depth,
            "sea_surface_height_above_geopotential_datum": level,
        }
    )
    voyage = Voyage(start=(0.0, 0.0), goal=(0.0, 1.0), depart="2026-01-01", min_ukc_m=1.0)
    water = Chart.open_water(-0.1, 0.1, -0.1, 1.1)
    ship = Ship.simple(speed_kn=8.0, draught_m=5.0)
    found = plan(voyage, ship=ship, sea=sea, chart=water, resolution=1000.0)
    opens = high - np.arccos(1.0 / 1.05) / (2.0 * np.pi) * period
    least = (opens + float(distance(0.0, bar[0], 0.0, 1.0)) / (8.0 * KNOT)) / HOUR
    assert found.best.feasible
    assert least - 1e-3 < found.best.time_h < 1.0005 * least
    assert found.lower_bound <= found.best.time_h


def _scored(*reasons):
    return SimpleNamespace(violations=tuple(Violation(why, 0.0, 0.0, 0.0) for why in reasons))


def test_edges_of_paths_that_exceed_a_limit_are_left_out_before_any_is_refined(monkeypatch):
    """Each round refined its path: twenty minutes behind a storm."""
    paths = {"whole": (SPEED_NOT_PREDICTED,), "first": (SPEED_NOT_PREDICTED,), "second": ()}
    following = {"whole": "first", "first": "second"}
    monkeypatch.setattr(
        exceeded_limits, "without_exceeding_edges", lambda context, own, places: following[own]
    )
    places = exceeded_limits.exceeded_limits_on_routes(_scored(SPEED_NOT_PREDICTED))
    left = exceeded_limits.without_exceeding_paths(
        None, "whole", places, lambda network: _scored(*paths[network])
    )
    assert left == "second"


def test_a_network_that_has_no_path_left_is_searched_for_the_error(monkeypatch):
    def path_on(network):
        raise NoRouteError("No route.", "", "")

    monkeypatch.setattr(
        exceeded_limits, "without_exceeding_edges", lambda context, own, places: own + 1
    )
    assert exceeded_limits.without_exceeding_paths(None, 0, (), path_on) == 1


def test_stricter_limits_do_not_help_where_alone_the_speed_is_not_predicted():
    other = codes.REASONS[codes.WAVE_HEIGHT]
    help_of = exceeded_limits.stricter_limits_help
    assert not help_of(_scored(SPEED_NOT_PREDICTED, SPEED_NOT_PREDICTED))
    assert help_of(_scored(SPEED_NOT_PREDICTED, other)) and help_of(_scored())
