"""Voyages by via points leave later where they would wait at sea above the limits."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.time import parse_time
from thalweg.core.units import HOUR

WATER = Chart.open_water(50.0, 52.0, -0.5, 3.5)
DEPART = parse_time("2026-01-01T00:00Z")
VIA = (51.0, 1.5)


def gale(opens_h):
    """Waves of 4 m east of 1 E from 6.5 h after the departure until a time; 1 m else."""

    def height(time, lat, lon):
        hours = (np.asarray(time) - DEPART) / HOUR
        high = (hours > 6.5) & (hours < opens_h) & (np.asarray(lon) > 1.0)
        return np.where(high, 4.0, 1.0) + 0.0 * np.asarray(lat)

    calm = {
        name: lambda time, lat, lon: 0.0 * np.asarray(lat)
        for name in ("eastward_wind", "northward_wind")
    }
    return Sea.from_functions({"sea_surface_wave_significant_height": height, **calm})


def planned(opens_h, **more):
    ship = Ship.simple(speed_kn=10.0, draught_m=5.0, max_wave_height_m=2.0)
    voyage = Voyage(start=(51.0, 0.0), goal=(51.0, 3.0), via=[VIA], depart=DEPART, **more)
    return plan(voyage, ship=ship, sea=gale(opens_h), chart=WATER, resolution=8000.0, proof=0.0)


@pytest.mark.slow
def test_a_wait_at_a_via_point_is_a_wait_at_the_berth():
    found = planned(12.0)
    best = found.best
    assert best.feasible and np.flatnonzero(best.track.wait).tolist() == [0]
    assert best.track.depart == DEPART
    assert 12.0 + 5.6 < best.time_h < 12.0 + 8.0  # a ship at the via point then has 5.7 h to go
    (note,) = [note for note in found.notes if note.startswith("Arrives ")]
    assert "would have to wait at sea" in note and "waves of up to 4.0 m" in note
    assert not any(note.startswith("Waits at sea") for note in found.notes)


@pytest.mark.slow
def test_a_voyage_that_need_not_wait_leaves_at_once():
    found = planned(0.0)
    assert found.best.waiting_h == 0.0
    assert found.best.time_h == pytest.approx(11.37, abs=0.02)
    assert not any(note.startswith("Arrives ") for note in found.notes)


@pytest.mark.slow
def test_the_wait_stays_where_a_later_departure_is_too_late():
    """The plan of a later departure is refused; the one that is found is not."""
    found = planned(12.0, arrive_by=DEPART + 18.5 * HOUR)
    assert found.best.feasible and found.best.time_h == pytest.approx(17.7, abs=0.1)
    assert any(note.startswith("Waits at sea 6.3 h") for note in found.notes)
