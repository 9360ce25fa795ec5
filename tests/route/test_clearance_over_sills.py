"""The least clearance that is published is that of the data, whatever limit is asked."""

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, evaluate

SHIP = Ship.simple(speed_kn=10.0, draught_m=4.0)
STEP = 0.01  # of the rows of the bed [deg]


def bed_with_sill(depth):
    """A bed of 20 m with a sill that is one row of the data wide."""
    lat = 51.5 + STEP * np.arange(41)
    values = np.where(np.arange(41) == 20, depth, 20.0)
    coords = {
        "lat": ("lat", lat, {"units": "degrees_north"}),
        "lon": ("lon", [3.0, 3.5, 4.0], {"units": "degrees_east"}),
    }
    bed = np.repeat(values[:, None], 3, axis=1)
    attributes = {"standard_name": "sea_floor_depth_below_sea_surface", "units": "m"}
    return xr.Dataset({"depth": (("lat", "lon"), bed, attributes)}, coords=coords)


@pytest.mark.parametrize("limit", [0.5, 1.0, 2.4, 2.6])
@pytest.mark.parametrize("start", [51.6503, 51.6559, 51.6611])
def test_the_least_clearance_does_not_depend_on_the_limit(start, limit):
    """With a limit of 0.5 m it was up to 1 m more than with 2.4 m."""
    sea, chart = Sea.open(bed_with_sill(6.5)), Chart.open_water(51, 52, 3, 4)
    track = [(start, 3.5), (start + 0.1234, 3.5)]
    found = evaluate(track, ship=SHIP, sea=sea, chart=chart, depart=0.0, min_ukc=limit)
    assert found.min_ukc_m == pytest.approx(2.5, abs=0.02)
    assert found.feasible == (limit < 2.5)
