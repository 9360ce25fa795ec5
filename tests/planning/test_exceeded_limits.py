"""Banks narrower than the network's spacing: planned round, not answered with a breach."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan

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
