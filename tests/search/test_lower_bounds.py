"""Lower bounds stay below what they bound, and kappa has its closed form in still water."""

import math

import numpy as np
import pytest

from tests.search.small import grid, limits, make_fields, steady
from thalweg.core.geodesy import distance
from thalweg.search import direction_factor, earliest_arrival, lower_bound
from thalweg.search.earliest_arrival import ArrivalQuery
from thalweg.search.lower_bounds import free_space_bound, network_bound
from thalweg.search.search_problem import ShipOnNetwork, make_search_problem


@pytest.mark.parametrize("gap_deg", [4.0, 19.107, 26.565, 45.0, 60.0])
def test_in_still_water_kappa_is_the_cosine_of_half_the_gap(gap_deg):
    gap = math.radians(gap_deg)
    assert direction_factor(gap, 0.0) == pytest.approx(math.cos(gap / 2), abs=1e-12)
    assert direction_factor(gap, 1e-9) == pytest.approx(math.cos(gap / 2), abs=1e-7)


def test_the_printed_direction_errors_of_square_networks():
    worst = {8: 1.0824, 16: 1.0275, 32: 1.0131}
    gaps = {8: math.pi / 4, 16: math.atan(0.5), 32: math.atan(1 / 3)}
    for directions, gap in gaps.items():
        assert 1.0 / direction_factor(gap) == pytest.approx(worst[directions], abs=6e-5)


def test_kappa_is_the_least_over_many_headings_and_falls_with_gap_and_current():
    gap, rho = math.radians(30.0), 0.5
    kappa = direction_factor(gap, rho)
    rng = np.random.default_rng(1)

    def over_ground(angle):
        return rho * np.cos(angle) + np.sqrt(1.0 - (rho * np.sin(angle)) ** 2)

    first, share = rng.uniform(-math.pi, math.pi, 200_000), rng.random(200_000)
    a, b = first, first + gap
    # share of the time on each of two courses: the velocity made good and the one straight there
    velocity = np.stack(
        [
            share * over_ground(a) * np.cos(a) + (1 - share) * over_ground(b) * np.cos(b),
            share * over_ground(a) * np.sin(a) + (1 - share) * over_ground(b) * np.sin(b),
        ]
    )
    made_good = np.hypot(*velocity) / over_ground(np.arctan2(velocity[1], velocity[0]))
    assert made_good.min() >= kappa - 1e-9
    assert made_good.min() == pytest.approx(kappa, abs=1e-5)
    assert direction_factor(gap, 0.6) < kappa < direction_factor(gap, 0.4)
    assert direction_factor(math.radians(40.0), rho) < kappa


def test_extremes_of_kappa():
    assert direction_factor(0.0, 0.9) == 1.0
    assert direction_factor(0.3, 1.0) == 0.0
    assert direction_factor(math.pi, 0.0) == 0.0
    assert 0.0 < direction_factor(math.pi / 4, 0.95) < math.cos(math.pi / 8)


def world(reach, gap):
    network = grid(21, 21, 0.02, reach, gap=gap)

    def swirl(t, lat, lon):
        return 1.2 * np.sin(20 * lat) * np.cos(t / 9000.0) + 0.0 * lon

    fields = make_fields(
        network,
        np.linspace(0, 1e5, 40),
        current_east=swirl,
        current_north=lambda t, a, o: swirl(t, o, a),
    )
    return network, fields


ENDS = {"start": 0, "goal": 20 * 21 + 13}
GIVEN = {"setting": 0, "limits": limits(), "top_speed": 5.0}


@pytest.mark.parametrize("objective", ["time", "distance"])
def test_the_bound_of_a_coarse_network_is_below_the_finest_network(objective):
    network, fields = world(1, math.pi / 4)
    fine, fine_fields = world(4, math.atan(1 / 4))
    asked = ENDS | {"objective": objective, "depart": 0.0}
    bound = lower_bound(ShipOnNetwork(network, fields, steady(5.0), **GIVEN), **asked)
    best = earliest_arrival(ShipOnNetwork(fine, fine_fields, steady(5.0), **GIVEN), **asked).cost
    coarse = earliest_arrival(ShipOnNetwork(network, fields, steady(5.0), **GIVEN), **asked).cost
    assert bound.value < best < coarse
    assert bound.value > 0.85 * best
    assert 0.0 < bound.kappa <= 1.0
    assert (bound.kappa == 1.0) is (objective == "distance")  # there the geodesic is the better


def test_the_free_bound_is_the_geodesic_at_full_speed_with_the_strongest_current():
    network, fields = world(1, math.pi / 4)
    given = make_search_problem(
        ShipOnNetwork(network, fields, steady(5.0), setting=0, limits=limits(), top_speed=5.0)
    )
    u, v = fields.values[..., 0].astype(float), fields.values[..., 1].astype(float)
    geodesic = float(distance(0.0, 0.0, network.lat[433], network.lon[433]))
    free = free_space_bound(network, given, start=0, goal=433)
    expected = geodesic / (5.0 + np.hypot(u, v).max())
    assert free.value == pytest.approx(expected, rel=1e-6)
    assert free.value <= expected
    far = free_space_bound(network, given, start=0, goal=433, objective="distance")
    assert far.value == pytest.approx(geodesic, rel=1e-8)


def test_without_a_valid_factor_the_free_bound_remains():
    network, _ = world(1, math.pi / 4)
    fields = make_fields(network, [0.0, 1e6], current_east=5.5, current_north=0.0)
    given = make_search_problem(
        ShipOnNetwork(network, fields, steady(5.0), setting=0, limits=limits(), top_speed=5.0)
    )
    assert network_bound(network, given, ArrivalQuery(0, 20, 0.0, "time")).value == 0.0
    bound = lower_bound(
        ShipOnNetwork(network, fields, steady(5.0), **GIVEN), start=0, goal=20, depart=0.0
    )
    assert "free space" in bound.kind


def test_limits_at_the_network_do_not_lift_the_bound_above_a_looser_ship():
    network, _ = world(1, math.pi / 4)
    wave = np.where(np.abs(network.stations.lon - 0.1) < 0.03, 3.03, 1.0)
    wave[network.stations.lat > 0.3] = 1.0
    fields = make_fields(network, [0.0, 1e6], wave_height_channel=wave[:, None])
    tight = lower_bound(
        ShipOnNetwork(network, fields, steady(5.0), **(GIVEN | {"limits": limits(wave=3.0)})),
        depart=0.0,
        **ENDS,
    )
    loose = earliest_arrival(
        ShipOnNetwork(network, fields, steady(5.0), **(GIVEN | {"limits": limits(wave=3.05)})),
        depart=0.0,
        **ENDS,
    )
    assert tight.value < loose.cost
