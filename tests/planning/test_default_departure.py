"""The departure of a voyage that states none."""

import numpy as np
import pytest

from thalweg import Sea, Ship
from thalweg.core.geodesy import distance, positions_along
from thalweg.core.time import format_time
from thalweg.planning.request.default_departure import default_departure

SHIP = Ship.simple(speed_kn=14.0, draught_m=5.0)
HALIFAX, BISHOP_ROCK = (44.6, -63.5), (49.7, -6.5)


def test_in_a_storm_the_ship_meets_it():
    sea = Sea.storm()
    departure, reason = default_departure(sea, HALIFAX, BISHOP_ROCK, SHIP)
    track = sea.layers[0].track
    fractions = np.linspace(0.0, 1.0, 200)
    sailing = float(distance(*HALIFAX, *BISHOP_ROCK)) / SHIP.speeds[0]
    there = track.position(departure + fractions * sailing)
    away = distance(*positions_along(*HALIFAX, *BISHOP_ROCK, fractions), *there).min() / 1852.0
    assert away < 120.0
    assert departure + sailing <= track.time[-1]
    assert format_time(departure) in reason and f"{away:.0f} nm" in reason and "--depart" in reason


def test_a_storm_that_stays_away_is_stated():
    sea = Sea.storm()
    departure, reason = default_departure(sea, (-30.0, 60.0), (-28.0, 70.0), SHIP)
    assert "hardly matters" in reason
    assert departure == sea.layers[0].period[0]


def test_data_and_formulas_without_storm():
    still = Sea.calm()
    departure, reason = default_departure(still, (50.0, 1.0), (51.0, 2.0), SHIP)
    assert "now" in reason and departure > 1.7e9


def test_a_longer_voyage_than_the_storm_departs_at_its_beginning():
    sea = Sea.storm()
    departure, _ = default_departure(sea, (50.0, -5.0), (-33.0, 18.0), SHIP, 0.5)
    assert departure == pytest.approx(sea.layers[0].period[0])
