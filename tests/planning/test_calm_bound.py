"""In a calm sea the bound of the time is at the speed in calm water, not at that with the wind."""

import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.ship.file.ship_file import library_names


@pytest.mark.slow
@pytest.mark.parametrize("name", library_names())
def test_the_bound_of_a_straight_voyage_in_calm_water_is_tight_and_not_above_it(name):
    voyage = Voyage(start=(45.0, -30.0), goal=(46.0, -27.0), depart="2026-03-01T00:00Z")
    ship = Ship.load(name)
    chart = Chart.open_water().with_depth(lambda lat, lon: 4000.0 + 0.0 * lat)
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=chart, proof=0.0, resolution=20_000.0)
    assert 0.0 <= found.gap < 5e-3  # Plan.gap is an error where a bound is above the plan


@pytest.mark.slow
@pytest.mark.parametrize("name", ["kvlcc2", "gunnerus-2019"])
def test_the_bound_of_least_fuel_in_calm_water_is_tight_and_not_above_it(name):
    voyage = Voyage(start=(45.0, -30.0), goal=(46.0, -27.0), depart="2026-03-01T00:00Z",
                    objective="fuel")  # fmt: skip
    ship = Ship.load(name)
    given = {"ship": ship, "sea": Sea.calm(), "chart": Chart.open_water()}
    found = plan(voyage, **given, proof=0.0, resolution=20_000.0)
    assert 0.0 <= found.gap < 5e-3
