"""Gullies of one point of the data: sailed at low water, though networks have no nodes in them."""

import numpy as np
import pytest

from tests.sill_seas import DREDGER, gully_in_unknown_water, winding_gully, write_sea
from thalweg import Chart, Sea, Voyage, evaluate, plan
from thalweg.core.errors import NoRouteError
from thalweg.planning.network_selection.bed_network import near_line, network_on_bed
from thalweg.planning.request.voyage_endpoints import Endpoint

START, GOAL = (51.66, 3.42), (51.69, 3.78)
ENDS = (Endpoint("start", *START, 0.0), Endpoint("goal", *GOAL, 0.0))
WATER = Chart.open_water(51.5, 51.85, 3.3, 3.9)
STEPS = [
    (51.675, 3.496),
    (51.69, 3.496),
    (51.69, 3.592),
    (51.66, 3.592),
    (51.66, 3.688),
    (51.6825, 3.688),
]


def planned(path, objective):
    voyage = Voyage(
        start=START, goal=GOAL, depart="2026-05-01T04:00Z", objective=objective, min_ukc_m=1.0
    )
    return plan(voyage, ship=DREDGER, sea=Sea.open(path), chart=WATER).best


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["time", "fuel"])
def test_a_gully_of_one_point_is_sailed_at_low_water(tmp_path, objective):
    """Ships waited four hours in it for the tide; least fuel was refused."""
    winding_gully(tmp_path / "gully.nc", flats=3.0)
    track = [START, (51.675, 3.456), *STEPS, (51.6825, 3.742), GOAL]
    given = {"ship": DREDGER, "sea": Sea.open(tmp_path / "gully.nc"), "chart": WATER}
    by_hand = evaluate(track, **given, depart="2026-05-01T04:00Z", min_ukc=1.0)
    assert by_hand.feasible
    best = planned(tmp_path / "gully.nc", objective)
    assert best.feasible
    assert best.distance_nm < 1.002 * by_hand.distance_nm
    if objective == "time":
        assert best.waiting_h == 0.0
        assert best.time_h < 1.002 * by_hand.time_h
    else:  # at 8 kn, and a wait that burns nothing lets corners be cut
        assert best.fuel_t < by_hand.fuel_t * 0.65


@pytest.mark.slow
def test_a_gully_in_unknown_water_is_sailed_at_least_fuel(tmp_path):
    """The small network of a front had no way through it."""
    gully_in_unknown_water(tmp_path / "gully.nc")
    best = planned(tmp_path / "gully.nc", "fuel")
    assert best.feasible and best.waiting_h == 0.0
    assert best.min_ukc_m > 2.0
    assert 13.0 < best.distance_nm < 16.5


@pytest.mark.slow
def test_water_of_unknown_depth_is_not_called_too_shallow(tmp_path):
    """No load helps where the known points touch in corners only."""
    lat, lon = 51.60 + 0.0025 * np.arange(61), 3.40 + 0.004 * np.arange(101)
    depth = np.full((61, 101), np.nan)
    depth[:, :15] = depth[:, -15:] = 20.0
    write_sea(tmp_path / "gap.nc", lat, depth, lon, np.zeros(25), np.arange(25.0))
    with pytest.raises(
        NoRouteError, match="on every path there is water of unknown depth"
    ) as caught:
        planned(tmp_path / "gap.nc", "fuel")
    assert "too shallow" not in str(caught.value) and "Load less" not in str(caught.value)


def test_the_network_of_a_bed_has_its_known_points_near_the_way(tmp_path):
    gully_in_unknown_water(tmp_path / "gully.nc")
    sea = Sea.open(tmp_path / "gully.nc")
    network = network_on_bed(WATER, sea, ENDS, 7.5)
    assert network.meta.kind == "mesh" and network.n_nodes > 1000
    row = (network.lat[:-2] - 51.60) / 0.0025
    assert np.allclose(row, np.rint(row), atol=1e-6)
    few = near_line(
        network, np.array([START[0], GOAL[0]]), np.array([START[1], GOAL[1]]), most_nodes=300
    )
    kept = np.unique(few.graph.target)
    assert 100 < len(kept) <= 300
    assert network_on_bed(WATER, sea, ENDS, -np.inf) is None
    assert network_on_bed(WATER, Sea.calm(), ENDS, 7.5) is None
