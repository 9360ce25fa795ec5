"""The best departure of a window."""

from dataclasses import replace

import numpy as np
import pytest

from tests.search.small import limits, line, make_fields, steady
from tests.search.test_restricted_waiting import barred_line
from tests.search.test_tidal_states import GIVEN as TIDAL
from thalweg.core.errors import InputError
from thalweg.search import DepartureWindow, ShipOnNetwork, best_departure, earliest_arrival

HOUR = 3600.0
TIDE = 12.42 * HOUR
ENDS = {"start": 0, "goal": 10}
GIVEN = {"setting": 0, "limits": limits(), "top_speed": 5.0}


def tidal(step=HOUR / 4):
    network = line(11, 2000.0)
    times = np.arange(0.0, 36 * HOUR, step)
    stream = 1.5 * np.cos(2 * np.pi * times / TIDE)[None, :] + np.zeros((11, 1))
    return network, make_fields(network, times, current_east=stream, current_north=0.0)


def test_the_best_departure_has_the_stream_with_it():
    network, fields = tidal()
    result = best_departure(
        ShipOnNetwork(network, fields, steady(5.0), **GIVEN),
        window=DepartureWindow(2 * HOUR, 20 * HOUR),
        **ENDS,
    )
    # by symmetry the passage is centred on the strongest stream
    assert result.depart + result.duration / 2 == pytest.approx(TIDE, abs=400.0)
    fine = [
        earliest_arrival(
            ShipOnNetwork(network, fields, steady(5.0), **GIVEN), depart=t, **ENDS
        ).duration
        for t in np.arange(2 * HOUR, 20 * HOUR, 120.0)
    ]
    assert result.duration <= min(fine) + 0.1


def test_equal_departures_go_to_the_earliest():
    network, _ = tidal()
    fields = make_fields(network, [0.0, 1e5, 2e5], current_east=1.0, current_north=0.0)
    result = best_departure(
        ShipOnNetwork(network, fields, steady(5.0), **GIVEN),
        window=DepartureWindow(500.0, 9000.0),
        **ENDS,
    )
    assert result.depart == 500.0


def test_a_window_of_one_moment():
    network, fields = tidal()
    result = best_departure(
        ShipOnNetwork(network, fields, steady(5.0), **GIVEN),
        window=DepartureWindow(HOUR, HOUR),
        **ENDS,
    )
    alone = earliest_arrival(
        ShipOnNetwork(network, fields, steady(5.0), **GIVEN), depart=HOUR, **ENDS
    )
    assert (result.depart, result.arrive) == (HOUR, alone.arrive)


def test_there_is_no_best_departure_if_all_fail():
    network, fields = tidal()
    given = GIVEN | {"top_speed": 1.0}
    result = best_departure(
        ShipOnNetwork(network, fields, steady(1.0), **given),
        window=DepartureWindow(0.0, 2 * HOUR),
        arrive_by=2 * HOUR,
        **ENDS,
    )
    assert not result.found
    assert "arrives too late" in result.refused


def test_an_own_step_of_departures():
    network, fields = tidal()
    coarse = best_departure(
        ShipOnNetwork(network, fields, steady(5.0), **GIVEN),
        window=DepartureWindow(2 * HOUR, 20 * HOUR, step=4 * HOUR),
        **ENDS,
    )
    assert coarse.depart + coarse.duration / 2 == pytest.approx(TIDE, abs=400.0)


@pytest.mark.parametrize("window", [(2.0, 1.0), (np.nan, 1.0), (0.0, np.inf)])
def test_empty_windows_are_refused(window):
    network, fields = tidal()
    with pytest.raises(InputError, match="window"):
        best_departure(
            ShipOnNetwork(network, fields, steady(5.0), **GIVEN),
            window=DepartureWindow(*window),
            **ENDS,
        )


@pytest.mark.parametrize("waits_at", [[0, 1], [0]])
def test_a_window_where_the_ship_may_wait_at_some_nodes_only(waits_at):
    """A bar that opens at 4 h: who leaves within the first hour must wait, and can."""
    network, fields = barred_line(4 * HOUR)
    network = replace(network, can_wait=np.isin(np.arange(6), waits_at))
    asked = {"start": 0, "goal": 5}
    found = best_departure(
        ShipOnNetwork(network, fields, steady(4.0), **TIDAL),
        window=DepartureWindow(0.0, HOUR),
        **asked,
    )
    last = earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **TIDAL), depart=HOUR, **asked
    )
    assert found.found and last.found
    assert found.arrive == pytest.approx(last.arrive, abs=1.0)
    assert found.duration == pytest.approx(last.duration, abs=1.0)
    later = best_departure(
        ShipOnNetwork(network, fields, steady(4.0), **TIDAL),
        window=DepartureWindow(0.0, 6 * HOUR),
        **asked,
    )
    assert later.duration == pytest.approx(5000.0 / 4.0, abs=1.0)
    with pytest.raises(InputError, match="node 99"):
        best_departure(
            ShipOnNetwork(network, fields, steady(4.0), **TIDAL),
            window=DepartureWindow(0.0, HOUR),
            **asked | {"goal": 99},
        )
