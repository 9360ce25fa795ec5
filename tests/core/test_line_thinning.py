"""Lines with fewer points: the points left out are within the tolerance of what remains."""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import numpy as np
import pytest

from thalweg.core.arrays.line_thinning import (
    distances_from_arcs,
    inner_points,
    mark_needed_points,
)
from thalweg.core.geodesy import MEAN_RADIUS, unit_vectors

NM = 1852.0


def needed(lat, lon, tolerance, ends=None, **options):
    keep = np.zeros(len(lat), bool)
    first, last = ends or (np.array([0]), np.array([len(lat) - 1]))
    keep[first] = keep[last] = True
    vectors = MEAN_RADIUS * unit_vectors(lat, lon)
    distances = partial(distances_from_arcs, vectors)
    mark_needed_points(keep, first, last, tolerance=tolerance, distances=distances, **options)
    return np.flatnonzero(keep).tolist()


def test_points_between_pairs():
    between = inner_points(np.array([0, 5]), np.array([3, 7]))
    assert between.point.tolist() == [1, 2, 6]
    assert between.pair.tolist() == [0, 0, 1]
    assert between.begins.tolist() == [0, 2]


def test_points_on_a_great_circle_are_left_out_and_a_corner_stays():
    lat = [0.0, 0.0, 0.0, 1.0, 2.0]
    lon = [0.0, 1.0, 2.0, 2.0, 2.0]
    assert needed(lat, lon, 10.0) == [0, 2, 4]
    assert needed(lat, lon, 200.0 * NM) == [0, 4]


def test_a_point_beyond_the_end_of_a_line_is_as_far_as_that_end():
    lat, lon = [0.0, 0.0, 0.0], [0.0, 3.0, 2.0]  # sails on by 60 nm, and back
    assert needed(lat, lon, 59.0 * NM) == [0, 1, 2]
    assert needed(lat, lon, 61.0 * NM) == [0, 2]


def test_a_line_that_ends_where_it_begins():
    lat, lon = [0.0, 0.5, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0]
    assert needed(lat, lon, 50.0 * NM) == [0, 2, 3]


def test_lines_that_cannot_be_joined_are_split():
    lat, lon = np.zeros(9), np.linspace(0.0, 8.0, 9)

    def over_land(first, last):
        return (lon[first] < 2.5) & (lon[last] > 4.5)

    assert needed(lat, lon, 10.0) == [0, 8]
    kept = needed(lat, lon, 10.0, must_split=over_land)
    assert not any(over_land(a, b) for a, b in pairwise(kept) if b - a > 1)
    assert set(kept) - {0, 8}


@pytest.mark.parametrize("tolerance", [2.0 * NM, 10.0 * NM])
def test_all_points_are_within_the_tolerance_of_many_lines(tolerance):
    random = np.random.default_rng(3)
    lat, lon = 40.0 + np.cumsum(random.normal(0.0, 0.05, (2, 400)), axis=1)
    first, last = np.array([0, 150, 151]), np.array([149, 150, 399])
    kept = np.array(needed(lat, lon, tolerance, (first, last)))
    assert 10 < len(kept) < 300 and {0, 149, 150, 151, 399} <= set(kept.tolist())
    a, b = kept[:-1], kept[1:]
    wide = b - a > 1
    vectors = MEAN_RADIUS * unit_vectors(lat, lon)
    a, b = a[wide], b[wide]
    assert distances_from_arcs(vectors, a, b, inner_points(a, b)).max() <= tolerance
