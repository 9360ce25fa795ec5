"""An ordered speed is sailed as it is given, also next to a setting of the ship."""

import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan


@pytest.mark.parametrize("speed", [11.96, 12.0, 14.04])
def test_the_ordered_speed_is_not_rounded_to_a_setting(speed):
    voyage = Voyage(start=(30.0, -40.0), goal=(30.0, -38.0), depart="2026-01-01T00:00Z",
                    speed_kn=speed)  # fmt: skip
    ship = Ship.load("handysize-bulker")
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=Chart.open_water(), proof=0.0)
    assert found.best.distance_nm / found.best.time_h == pytest.approx(speed, abs=2e-3)
