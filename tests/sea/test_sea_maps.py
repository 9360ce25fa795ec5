"""Colours of the maps of a sea."""

import numpy as np
import pytest

from thalweg.sea.sea_maps import MapPanel, _colour_limits

PERIOD = MapPanel("Peak period", "s", "sea_surface_wave_peak_period", (), "viridis")


@pytest.mark.parametrize(
    ("values", "limits"),
    [
        (np.full((4, 4), 10.0), (9.0, 11.0)),  # the bar had "+1e1" and 0 to 0.001
        (np.array([[6.0, 12.0], [np.nan, 9.0]]), (6.0, 12.0)),
        (np.zeros((2, 2)), (0.0, 1e-3)),
        (np.full((2, 2), np.nan), (0.0, 1.0)),
    ],
)
def test_a_field_of_one_value_has_a_scale_round_it(values, limits):
    assert _colour_limits(values, PERIOD) == pytest.approx(limits, rel=0.02)
