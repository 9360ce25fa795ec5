"""Ways round islands over a small lattice around a line."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core.geodesy import wrap_longitude
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.alternatives.lattice_detour import lattice_detour
from thalweg.network.alternatives.leg_rules import leg_lengths, total_cost

WATER = Chart.open_water(-2.0, 2.0, 178.0, 182.0)
LINE = np.zeros(31), wrap_longitude(np.linspace(179.75, 180.25, 31))  # over the date line


def cost_of_bar(lat1, lon1, lat2, lon2):
    """Miles within 0.1 degrees of the equator east of the date line count five times."""
    near = np.abs(0.5 * (lat1 + lat2)) < 0.1
    east = ((0.5 * (lon1 + lon2)) % 360.0 > 180.0) | (np.abs(lon1 - lon2) > 180.0)
    return leg_lengths(lat1, lon1, lat2, lon2) * np.where(near & east, 5.0, 1.0)


def detour(reach_nm: float, cost=cost_of_bar):
    return lattice_detour(
        WATER, LINE, leg_cost=cost, spacing=NAUTICAL_MILE, reach=reach_nm * NAUTICAL_MILE
    )


def test_a_detour_leads_round_costly_water_on_the_other_side():
    lat, lon = detour(20.0)
    assert np.abs(lat).max() >= 0.1
    assert total_cost((lat, lon), cost_of_bar) < 0.8 * total_cost(LINE, cost_of_bar)
    assert lat[[0, -1]] == pytest.approx(0.0) and np.all(np.abs(lon) <= 180.0)
    assert lon[0] == pytest.approx(179.75) and lon[-1] == pytest.approx(-179.75)


@pytest.mark.parametrize("cost", [cost_of_bar, leg_lengths])
def test_a_detour_costs_no_more_than_the_line(cost):
    assert total_cost(detour(2.0, cost), cost) <= total_cost(LINE, cost) * (1.0 + 1e-9)


def test_a_line_that_is_best_stays():
    lat, lon = detour(20.0, leg_lengths)
    assert np.abs(lat).max() < 1e-9 and len(lon) <= len(LINE[1])
