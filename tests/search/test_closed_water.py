"""Cells of a mesh that are closed all over: what touches a shore or an outline is not."""

import numpy as np
import pytest

from thalweg import Chart
from thalweg.search.certificate.closed_water import closed_cells

LAT = np.linspace(-1.0, 1.0, 21)


def land(west, east):
    ring = [[west, -2.0], [east, -2.0], [east, 2.0], [west, 2.0], [west, -2.0]]
    return {"type": "Polygon", "coordinates": [ring]}


@pytest.mark.parametrize("meridian", [0.0, 12.0, 180.0])
def test_a_cell_across_a_shore_along_any_meridian_is_open(meridian):
    chart = Chart.from_geojson(land(meridian, meridian + 1.0))
    lon = meridian + np.linspace(-0.525, 0.575, 12)  # the sixth cell is a quarter water
    assert closed_cells(chart, LAT, lon)[10].tolist() == [False] * 6 + [True] * 5


def test_land_that_the_data_split_at_a_meridian_is_closed_across_it():
    both = {"type": "GeometryCollection", "geometries": [land(-1.0, 0.0), land(0.0, 1.0)]}
    lon = np.linspace(-0.525, 0.575, 12)
    assert closed_cells(Chart.from_geojson(both), LAT, lon).all()
