"""The greatest charted depth in the cells of a mesh, and the bound over a bar of the chart."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import thalweg
from thalweg import Chart, Sea, Ship, Voyage
from thalweg.search.certificate.charted_depths import greatest_depths


def depth_grid(values, south, west, step):
    lat = south + step * np.arange(values.shape[0])
    lon = west + step * np.arange(values.shape[1])
    named = {"standard_name": "sea_floor_depth_below_geopotential_datum", "units": "m"}
    return xr.Dataset({"depth": (("lat", "lon"), values, named)}, {"lat": lat, "lon": lon})


@settings(max_examples=30, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    spacing=st.floats(0.004, 0.09),
    corner=st.floats(-0.3, 0.3),
    west=st.sampled_from([3.0, 179.6, -180.0]),
)
def test_no_depth_in_a_cell_is_greater(seed, spacing, corner, west):
    """Depths at random positions, of two grids of which the first one has gaps."""
    random = np.random.default_rng(seed)
    fine = random.uniform(1.0, 30.0, (16, 18))
    fine[random.random(fine.shape) < 0.1] = np.nan
    wide = random.uniform(1.0, 30.0, (9, 9))
    chart = Chart.open_water().with_depth(depth_grid(fine, 51.0, west, 0.03))
    chart = chart.with_depth(depth_grid(wide, 50.8, west - 0.1, 0.11))
    lat = 51.0 + corner + spacing * np.arange(8)
    lon = west + corner + spacing * np.arange(9)
    greatest = greatest_depths(chart.depths, lat, lon)
    assert greatest.shape == (7, 8)
    y = np.append(random.uniform(lat[0], lat[-1], 400), np.repeat(lat, 2))
    x = np.append(random.uniform(lon[0], lon[-1], 400), np.tile([lon[0], lon[-1]], len(lat)))
    depth = chart.depths.at(y, x)
    row = np.clip(np.searchsorted(lat, y, side="right") - 1, 0, 6)
    column = np.clip(np.searchsorted(lon, x, side="right") - 1, 0, 7)
    known = ~np.isnan(depth)
    assert (depth[known] <= greatest[row, column][known] + 1e-4).all()


def test_cells_beyond_the_soundings_have_no_depth_and_functions_any():
    chart = Chart.open_water().with_depth(depth_grid(np.full((3, 3), 8.0), 51.0, 3.0, 0.1))
    lat, lon = np.array([50.5, 50.6, 51.05, 51.1]), np.array([3.0, 3.1, 3.15])
    expected = [[-np.inf, -np.inf], [8.0, 8.0], [8.0, 8.0]]
    assert greatest_depths(chart.depths, lat, lon).tolist() == expected
    function = chart.with_depth(lambda lat, lon: 5.0 + 0.0 * lat)
    expected[0] = expected[1] = [np.inf, np.inf]
    assert greatest_depths(function.depths, lat, lon).tolist() == expected


@pytest.mark.slow
def test_the_bound_waits_for_the_tide_at_a_bar_of_the_chart(tmp_path):
    """The bar has 5 m and the ship needs 7: she waits for 2 m of tide."""
    values = np.full((31, 51), 20.0)
    values[:, 23:28] = 5.0
    chart = Chart.open_water().with_depth(depth_grid(values, 51.3, 3.0, 0.02))
    table = "time,water_level\n2026-06-01T00:10Z,4.1\n2026-06-01T06:25Z,0.9\n"
    table += "2026-06-01T12:40Z,4.3\n2026-06-01T18:50Z,0.8\n"
    (tmp_path / "table.csv").write_text(table)
    sea = Sea.open(f"{tmp_path / 'table.csv'}@51.3,51.9,3,4")
    hull = {"length_overall_m": 90.0, "breadth_m": 14.0, "draught_m": 6.0}
    ship = Ship.from_dict({"name": "coaster", "hull": hull, "speeds_kn": [10.0]})
    voyage = Voyage(start=(51.6, 3.1), goal=(51.6, 3.9), depart="2026-06-01T03:00Z", min_ukc_m=1.0)
    plan = thalweg.plan(voyage, ship=ship, sea=sea, chart=chart, proof=10.0)
    assert plan.best.feasible and plan.best.waiting_h > 3.0
    assert 0.94 * plan.best.time_h < plan.lower_bound <= plan.best.time_h
