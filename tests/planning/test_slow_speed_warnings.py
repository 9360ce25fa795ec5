"""The warning where a method of speed loss leaves little of the ordered speed."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, evaluate
from thalweg.planning.report.provenance import slow_speed_warnings


@pytest.mark.parametrize(("wind", "warned"), [(5.0, False), (12.4, True)])
def test_a_small_ship_that_a_method_for_large_ships_stops_is_named(wind, warned):
    ship = Ship.from_dict(
        {
            "name": "coaster",
            "hull": {"length_between_perpendiculars_m": 85.0, "breadth_m": 13.6, "draught_m": 5.4,
                     "block_coefficient": 0.78, "type": "general_cargo"},
            "speeds_kn": [10.5],
            "models": {"speed_loss": "kwon_2008"},
        }
    )  # fmt: skip
    sea = Sea.from_functions(
        {
            "eastward_wind": lambda t, a, o: np.full(np.shape(a), -wind),
            "northward_wind": lambda t, a, o: np.zeros(np.shape(a)),
            "sea_surface_wave_significant_height": lambda t, a, o: np.full(np.shape(a), 0.6),
        }
    )
    route = evaluate(
        [(0.0, 0.0), (0.0, 0.2)], ship=ship, sea=sea, chart=Chart.open_water(), depart=0.0
    )
    notes = slow_speed_warnings(route)
    assert bool(notes) == warned
    if warned:
        assert "less than a quarter of the ordered speed" in notes[0]
