"""Sailing one edge: against quadrature, in second order, with every reason to refuse."""

import numpy as np
import pytest

from tests.search.small import limits, line, make_fields, steady
from thalweg.kernels import codes
from thalweg.search import ShipOnNetwork
from thalweg.search.fifo import sampled_arrivals

HOUR = 3600.0


def sail(network, fields, departures, *, table=None, bounds=None, edges=(0,)):
    given = {"setting": 0, "limits": limits() if bounds is None else bounds, "top_speed": 9.0}
    table = steady(5.0) if table is None else table
    arrivals, statuses = sampled_arrivals(
        ShipOnNetwork(network, fields, table, **given), departures=departures, edges=edges
    )
    return arrivals[0], statuses[0]


def oscillating(t, lat, lon):
    return 1.5 * np.cos(2 * np.pi * t / (12.42 * HOUR)) + 0.0 * lat


def exact_arrival(length, depart, speed=5.0, steps=200_000):
    """Integrate dx/dt = V + u(t) on an edge along the current, by a fine Runge-Kutta in x."""
    x, t = length / steps, depart
    for _ in range(steps):
        k1 = 1.0 / (speed + oscillating(t, 0.0, 0.0))
        k2 = 1.0 / (speed + oscillating(t + x * k1, 0.0, 0.0))
        t += 0.5 * x * (k1 + k2)
    return t


def test_time_dependent_current_converges_in_second_order():
    length, depart = 40e3, 2000.0
    truth = exact_arrival(length, depart)
    errors = []
    for pieces in (1, 2, 4, 8):
        network = line(2, length, pieces=pieces)
        times = np.arange(0.0, 6 * HOUR, 30.0)
        fields = make_fields(network, times, current_east=oscillating, current_north=0.0)
        arrivals, _ = sail(network, fields, [depart])
        errors.append(abs(arrivals[0] - truth))
    assert errors[3] < 1.0  # of some 7000 s
    assert errors[0] / errors[1] > 3.0
    assert errors[1] / errors[2] > 3.0


def test_a_steady_edge_takes_length_over_speed_on_any_time_axis():
    network = line(2, 9000.0, pieces=3)
    times = np.array([0.0, 10.0, 700.0, 701.0, 5000.0, 90000.0])  # far from uniform
    fields = make_fields(network, times, current_east=1.0, current_north=0.0)
    departures = np.array([0.0, 5.0, 10.0, 650.0, 700.5, 4999.0, 50000.0])
    arrivals, statuses = sail(network, fields, departures)
    assert np.all(statuses == codes.OK)
    assert arrivals - departures == pytest.approx(9000.0 / 6.0, rel=1e-6)


def test_fields_are_linear_in_time_between_uneven_times():
    network = line(2, 1.0)  # so short that it is sailed at one instant
    times = np.array([0.0, 100.0, 1000.0])
    fields = make_fields(network, times, speed_field=np.array([[2.0, 4.0, 8.0]] * 2))
    departures = np.array([0.0, 25.0, 100.0, 325.0, 775.0])
    arrivals, _ = sail(network, fields, departures)
    expected = np.interp(departures, times, [2.0, 4.0, 8.0])
    assert 1.0 / (arrivals - departures) == pytest.approx(expected, rel=5e-3)


def test_outside_the_period_there_is_no_sailing():
    network = line(2, 5000.0)
    fields = make_fields(network, [1000.0, 5000.0], current_east=0.0, current_north=0.0)
    arrivals, statuses = sail(network, fields, [999.0, 1000.0, 4000.0, 4001.0, 5001.0])
    assert statuses.tolist() == [
        codes.OUTSIDE_PERIOD, codes.OK, codes.OK, codes.OUTSIDE_PERIOD, codes.OUTSIDE_PERIOD,
    ]  # fmt: skip
    assert arrivals[1:3] == pytest.approx([2000.0, 5000.0], abs=1e-3)
    assert np.isinf(arrivals[[0, 3, 4]]).all()


@pytest.mark.parametrize(
    ("channels", "bounds", "status"),
    [
        ({"water_level": -3.0}, limits(depth=5.0), codes.DEPTH),
        ({"wave_height_channel": 4.0}, limits(wave=3.0), codes.WAVE_HEIGHT),
        ({"wind_east": 20.0, "wind_north": 0.0}, limits(wind=15.0), codes.WIND_SPEED),
        ({"current_east": -6.0, "current_north": 0.0}, limits(), codes.CURRENT),
        ({"current_east": np.nan, "current_north": 0.0}, limits(), codes.NO_DATA),
    ],
)
@pytest.mark.parametrize("where", [0, 1, 2, 3])
def test_one_blocked_sample_anywhere_blocks_the_edge(channels, bounds, status, where):
    network = line(2, 6000.0, depth=6.0, pieces=3)
    place = (
        where if where < 2 else network.samples.station_a[where - 2]
    )  # tail, head, two samples of edge 0

    def only_there(value):
        field = np.full((len(network.stations.lat), 2), 0.0)
        field[place] = value
        return field

    named = {name: only_there(value) for name, value in channels.items()}
    fields = make_fields(network, [0.0, 1e5], **named)
    assert sail(network, fields, [0.0], bounds=bounds)[1][0] == status


def test_nan_next_in_time_does_not_spoil_an_exact_sample_time():
    network = line(2, 1.0)
    level = np.array([[5.0, 5.0, np.nan, 5.0]] * 2)
    fields = make_fields(network, [0.0, 100.0, 200.0, 300.0], speed_field=level)
    _, statuses = sail(network, fields, [0.0, 99.0, 101.0, 150.0, 250.0])
    expected = [codes.OK, codes.OK] + [codes.NO_DATA] * 3
    assert statuses.tolist() == expected
