"""Polygons from GeoJSON: holes, nesting and faulty numbers."""

from __future__ import annotations

import pytest

from thalweg.chart.geojson_polygons import parse_polygons, read_land_areas

OUTLINE = [[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]
SQUARE = [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]
SQUARE_2 = [[3, 3], [3, 4], [4, 4], [4, 3], [3, 3]]
TRIANGLE = [[5, 5], [5, 6], [6, 6], [5, 5]]
AREAS = {5: 1.0, 4: 0.5}  # of the holes, by number of positions


@pytest.mark.parametrize("holes", [[], [SQUARE], [SQUARE, SQUARE_2], [SQUARE, TRIANGLE]])
def test_holes_may_have_different_numbers_of_positions(holes):
    geometry = {"type": "Polygon", "coordinates": [OUTLINE, *holes]}
    for repair in (True, False):
        (shape,) = parse_polygons(geometry, "zones", repair=repair)
        assert len(shape.interiors) == len(holes)
        assert shape.area == pytest.approx(100.0 - sum(AREAS[len(hole)] for hole in holes))


def test_land_keeps_all_its_lakes():
    geometry = {"type": "Polygon", "coordinates": [OUTLINE, SQUARE, TRIANGLE]}
    assert len(read_land_areas(geometry)) == 3
