"""Legs along approaches of ports: slow from the ends of a track on, not where it passes a port."""

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.ports import PORTS
from thalweg.route import Track
from thalweg.route.canal_legs import canal_legs
from thalweg.ship import Ship

# From Kiel through the canal and down the Elbe to the German Bight. The second and the third leg
# follow the line of the approach of Hamburg.
FROM_KIEL = [(54.42, 10.2), (53.885, 9.1), (53.879208, 9.020075), (53.939778, 8.659889),
             (53.980159, 8.438182), (54.006931, 8.107534)]  # fmt: skip


@pytest.fixture(scope="module")
def chart():
    return Chart.gshhg("i")


def speeds(places, chart):
    """Return the speed [kn] of each leg along an approach or in a canal, NaN of the others."""
    ship = Ship.load("handysize-bulker")
    lat, lon = np.array(places, float).T
    setting = np.full(len(lat) - 1, int(np.argmax(ship.speeds)))
    legs = canal_legs(Track(lat, lon, 0.0, setting=setting), chart, ship)
    rows = [legs.of(k) if number >= 0 else None for k, number in enumerate(legs.number.tolist())]
    return [np.nan if row is None else row.length / row.transit_time * 3600 / 1852 for row in rows]


def test_a_ship_that_passes_the_approach_of_another_port_keeps_her_speed(chart):
    in_canal, *at_sea = speeds(FROM_KIEL, chart)
    assert 6.0 < in_canal < 9.0
    assert np.isnan(at_sea).all()


def test_from_the_berth_every_leg_of_the_approach_is_slow(chart):
    line = PORT_APPROACHES.of(PORTS.lookup("Hamburg")).line
    west = (line[-1][0], line[-1][1] - 1.0)
    found = speeds([*line, west], chart)
    assert np.allclose(found[:-1], 10.0)
    assert np.isnan(found[-1])
    back = speeds([west, *line[::-1]], chart)
    assert np.isnan(back[0])
    assert np.allclose(back[1:], 10.0)


def test_a_call_at_a_river_port_on_the_way_is_slow_where_the_river_is_land(chart):
    line = PORT_APPROACHES.of(PORTS.lookup("Hamburg")).line
    west = (line[-1][0], line[-1][1] - 1.0)
    found = np.array(speeds([west, *line[::-1], *line[1:], west], chart))
    lat, lon = np.array([west, *line[::-1], *line[1:], west]).T
    on_land = chart.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:])
    assert on_land.any()
    assert np.allclose(found[on_land], 10.0)
