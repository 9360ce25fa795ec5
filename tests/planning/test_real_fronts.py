"""Fronts in real storms and currents: better than the weather-blind route in the same weather.

A constant speed on the shortest way may itself be a point of the front: nothing is saved there.
"""

import numpy as np
import pytest

from tests.conftest import data_file
from thalweg import Chart, Sea, Ship, Voyage, plan

pytestmark = pytest.mark.slow


def front(voyage, sea, spacing):
    """Plan on the coarse coast with half of the speeds: these voyages are in open water."""
    data, chart = Ship.load("handysize-bulker").data, Chart.gshhg("l")
    every_second = {name: values[1::2] for name, values in data["table"].items()}
    ship = Ship.from_dict({**data, "table": every_second})
    return plan(voyage, ship=ship, sea=sea, chart=chart, resolution=spacing)


def saves_everywhere(found):
    """Check constant speeds on the shortest way against the front; return the shares saved."""
    rows = [row for row in found.front.comparison.rows if row["saved"] is not None]
    assert len(rows) >= 3
    assert all(row["saved"] >= 0.0 for row in rows)
    assert sum(row["saved"] > 0.0 for row in rows) >= len(rows) / 2
    assert np.all(np.diff(found.front.values) < 0.0)
    return [row["saved_percent"] for row in rows]


def test_against_and_with_the_agulhas_current():
    file = data_file("metocean/globcurrent_agulhas_2002_daily.nc")
    sea = Sea.open(file).filled(wind=0.0, waves=0.0, currents=0.0)
    voyage = Voyage(
        start=(-31.0, 31.5), goal=(-35.0, 23.0), depart="2002-06-01T00:00Z", objective="front"
    )
    found = front(voyage, sea, spacing=80_000.0)
    assert max(saves_everywhere(found)) > 8.0  # percent of the fuel, along the current


def test_the_blizzard_of_january_1996():
    """From the edge of the analysis; the waves are those that its wind raises."""
    file = data_file("metocean/noaa_ngm_blizzard_1996_wind_msl_6h.nc")
    sea = Sea.open(file).filled(wind=0.0, waves="wind", currents=0.0)
    voyage = Voyage(
        start=(45.0, -50.0), goal=(41.5, -66.0), depart="1996-01-08T00:00Z", objective="front",
        arrive_by="1996-01-12T06:00Z", fuel_price_usd=600.0,
    )  # fmt: skip
    found = front(voyage, sea, spacing=100_000.0)
    assert max(saves_everywhere(found)) > 2.0  # percent of the cost
    slowest = found.front.comparison.rows[-1]  # is caught by winds that leave her too little speed
    assert slowest["speed_kn"] < 10.0 and not slowest["feasible"] and slowest["saved"] is None
    assert found.front.values[-1] < 0.95 * slowest["value"]
    assert any("Carter 1982" in note for note in found.notes)
