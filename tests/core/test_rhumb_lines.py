"""Rhumb lines against values published for GeographicLib's RhumbSolve, and their properties."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from thalweg.core.geodesy import distance
from thalweg.core.rhumb_lines import (
    densify_for_rhumb,
    direct_rhumb,
    inverse_rhumb,
    rhumb_cross_track,
    rhumb_deviates,
    rhumb_pieces,
)
from thalweg.core.units import NAUTICAL_MILE

JFK = (40 + 38 / 60 + 23 / 3600, -(73 + 46 / 60 + 44 / 3600))
SINGAPORE = (1 + 21 / 60 + 33 / 3600, 103 + 59 / 60 + 22 / 3600)
#: Page of RhumbSolve and tests of GeographicLib (Karney): start, goal, course [deg], length [m].
PUBLISHED = [
    (JFK, SINGAPORE, 103.582833003410954, 18523563.0423774272),
    ((33.3, 44.4), (12.34, 56.78), 151.483174375421527, 2641839.7239669343),
]


@pytest.mark.parametrize(("start", "goal", "course", "length"), PUBLISHED)
def test_published_rhumb_lines(start, goal, course, length):
    got, bearing = inverse_rhumb(*start, *goal)
    assert float(got) == pytest.approx(length, abs=1e-5)
    assert math.degrees(bearing) == pytest.approx(course, abs=1e-10)
    assert direct_rhumb(*start, math.radians(course), length) == pytest.approx(goal, abs=1e-9)


def test_parallels_and_meridians():
    length, course = inverse_rhumb(60.0, 179.0, 60.0, -179.0)
    radius = 6378137.0 * math.cos(math.radians(60.0)) / math.sqrt(1 - 0.00669437999014 * 0.75)
    assert float(length) == pytest.approx(math.radians(2.0) * radius, rel=1e-12)
    assert math.degrees(course) == pytest.approx(90.0)
    length, course = inverse_rhumb(10.0, 5.0, -20.0, 5.0)
    assert float(length) == pytest.approx(float(distance(10.0, 5.0, -20.0, 5.0)), rel=1e-12)
    assert math.degrees(course) == pytest.approx(180.0)
    assert float(inverse_rhumb(10.0, 5.0, 10.0, 5.0)[0]) == 0.0
    lat, lon = direct_rhumb(10.0, 179.0, 0.5 * math.pi, 500_000.0)
    assert float(lat) == pytest.approx(10.0, abs=1e-12) and float(lon) < -176.0


def test_beyond_a_pole_there_is_no_rhumb_line():
    assert np.isnan(direct_rhumb(89.0, 0.0, 0.0, 200_000.0)).all()


@given(st.floats(-85, 85), st.floats(-180, 179), st.floats(-85, 85), st.floats(-180, 179))
@example(82.0, 0.0, 82.0, 1.0)
@example(-84.9, 10.0, -84.9000001, 40.0)
def test_direct_undoes_inverse_and_geodesics_are_shorter(lat1, lon1, lat2, lon2):
    assume(abs(abs(lon2 - lon1) - 180.0) > 1e-6)
    length, course = inverse_rhumb(lat1, lon1, lat2, lon2)
    shortest = float(distance(lat1, lon1, lat2, lon2))
    assert float(length) >= shortest * (1 - 1e-9) - 1e-6
    assert float(distance(*direct_rhumb(lat1, lon1, course, length), lat2, lon2)) < 1e-2


@given(st.floats(-80, 80), st.floats(-180, 179), st.floats(0.05, 0.15))
def test_quadrature_and_closed_form_agree(lat, lon, step):
    ends = [lat, np.clip(lat + math.degrees(step), -84, 84)]
    whole, course = inverse_rhumb(ends[0], lon, ends[1], lon + 10.0)
    middle = direct_rhumb(ends[0], lon, course, 0.5 * whole)
    first, bearing = inverse_rhumb(ends[0], lon, *middle)
    assert float(first) == pytest.approx(0.5 * float(whole), rel=1e-10)
    assert float(bearing) == pytest.approx(float(course), abs=1e-10)


def test_a_great_circle_is_broken_until_rhumb_lines_keep_to_it():
    lat, lon = np.array([49.7, 40.4]), np.array([-6.5, -73.7])
    limit = 0.1 * NAUTICAL_MILE
    assert rhumb_deviates(lat, lon, 200 * NAUTICAL_MILE).all()
    out_lat, out_lon, leg = densify_for_rhumb(lat, lon, limit)
    assert not rhumb_deviates(out_lat, out_lon, limit).any()
    assert 30 < len(out_lat) < 70 and len(leg) == len(out_lat) - 1
    on = inverse_rhumb(out_lat[:-1], out_lon[:-1], out_lat[1:], out_lon[1:])[0].sum()
    assert on == pytest.approx(float(distance(lat[0], lon[0], lat[1], lon[1])), rel=1e-5)
    assert (out_lat[[0, -1]] == lat).all()
    finer = densify_for_rhumb(lat, lon, limit, 10 * NAUTICAL_MILE)
    assert distance(finer[0][:-1], finer[1][:-1], finer[0][1:], finer[1][1:]).max() <= 18_520.1


def test_rhumb_lines_are_cut_until_geodesics_keep_to_them():
    lat, lon = np.array([50.0, 45.0, 45.0]), np.array([-5.0, -45.0, -70.0])
    out_lat, out_lon, leg = rhumb_pieces(lat, lon, 20.0)
    sailed = distance(out_lat[:-1], out_lon[:-1], out_lat[1:], out_lon[1:]).sum()
    whole = inverse_rhumb(lat[:-1], lon[:-1], lat[1:], lon[1:])[0].sum()
    assert sailed == pytest.approx(whole, rel=1e-6)
    assert not rhumb_deviates(out_lat, out_lon, 20.0).any()
    np.testing.assert_allclose(out_lat[np.searchsorted(leg, 1) :], 45.0, atol=1e-9)


def test_cross_track_distance_from_a_rhumb_line():
    course = math.radians(60.0)
    end = direct_rhumb(50.0, 175.0, course, 400_000.0)
    abreast = direct_rhumb(50.0, 175.0, course, 250_000.0)
    aside = direct_rhumb(*abreast, course + 0.5 * math.pi, 300.0)
    found = rhumb_cross_track((50.0, 175.0), end, [abreast[0], aside[0]], [abreast[1], aside[1]])
    assert found == pytest.approx([0.0, 300.0], abs=0.02)
