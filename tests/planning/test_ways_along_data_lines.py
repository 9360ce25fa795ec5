"""Jets that are one row of the data wide are found, wherever the row lies beside the raster."""

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Track, Voyage, evaluate, plan
from thalweg.core.units import KNOT

WEST, EAST, ASIDE = 0.5, 4.5, 0.1  # of the voyage, and of the jet [deg]
DEPART = "2026-01-01T00:00Z"
SHIP = Ship.simple(speed_kn=4.0 / KNOT, draught_m=5.0)


def currents(rows, east):
    """Write a file of currents that differ by row only."""
    lon = np.arange(-2.0, 7.01, 0.12)
    values = np.repeat(np.asarray(east, float)[:, None], lon.size, axis=1)
    names = {"uo": "eastward_sea_water_velocity", "vo": "northward_sea_water_velocity"}
    return xr.Dataset(
        {
            name: (
                ("lat", "lon"),
                values if name == "uo" else 0.0 * values,
                {"standard_name": standard, "units": "m s-1"},
            )
            for name, standard in names.items()
        },
        coords={
            "lat": ("lat", rows, {"units": "degrees_north"}),
            "lon": ("lon", lon, {"units": "degrees_east"}),
        },
    )


def uneven_rows():
    """Rows 0.2 degrees apart, with one of a jet between two that are 33 m off."""
    close = [51.0731, 51.0734, 51.0737]
    rows = np.concatenate([np.arange(49.8, 51.08, 0.05), close, np.arange(51.1, 52.3, 0.05)])
    return rows, np.where(np.abs(rows - 51.0734) < 1e-6, 2.0, 0.0), 51.0734


def last_row_of_short_floats():
    """A jet in the last row of a file whose axes are numbers of 32 bits, contrary before it."""
    rows = (50.24 + 0.04 * np.arange(23)).astype(np.float32).astype(float)
    return rows, np.where(np.arange(rows.size) == rows.size - 1, 2.5, -0.5), rows[-1] - 1e-3


@pytest.mark.parametrize(
    ("world", "slower"), [(uneven_rows, 0.01), (last_row_of_short_floats, 0.01)]
)
def test_a_jet_in_one_row_is_found(world, slower):
    """The plans were 38 and 8 % slower than these routes by hand."""
    rows, east, row = world()
    sea, chart = Sea.open(currents(rows, east)), Chart.open_water(48, 54, -2, 7)
    lon = [WEST, *np.linspace(WEST + 0.15, EAST - 0.15, 90), EAST]
    track = Track([row - ASIDE, *[row] * 90, row - ASIDE], lon, DEPART)
    by_hand = evaluate(track, ship=SHIP, sea=sea, chart=chart, depart=DEPART)
    assert by_hand.feasible
    voyage = Voyage(start=(row - ASIDE, WEST), goal=(row - ASIDE, EAST), depart=DEPART)
    found = plan(voyage, ship=SHIP, sea=sea, chart=chart, proof=2.0)
    assert found.objective_value < by_hand.time_h * (1.0 + slower)
    assert found.lower_bound < by_hand.time_h
