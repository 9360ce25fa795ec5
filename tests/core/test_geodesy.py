"""Geodesy against published geodesics (Karney 2013; GeographicLib) and its own round trips."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core import geodesy
from thalweg.core.errors import InputError

lat = st.floats(-89.0, 89.0)
lon = st.floats(-180.0, 179.999)


@pytest.mark.parametrize(
    ("start", "goal", "length", "courses"),
    [
        ((40.6, -73.8), (51.6, -0.5), 5551759.4003, (51.198883, 107.821777)),
        ((0.0, 0.0), (0.5, 179.5), 19936288.5790, None),
        ((0.0, 0.0), (0.5, 179.7), 19944127.4208, None),
        (
            (36.530042355041, 0.0),
            (-48.164270779097769, 5.762344694676510),
            9398502.0435,
            (176.125875, 175.334308),
        ),
    ],
)
def test_geographiclib_geodesics(start, goal, length, courses):
    got, first, last = geodesy.inverse(*start, *goal)
    assert float(got) == pytest.approx(length, abs=6e-5)
    if courses:
        assert math.degrees(first) == pytest.approx(courses[0], abs=6e-7)
        assert math.degrees(last) == pytest.approx(courses[1], abs=6e-7)


@given(lat, lon, st.floats(0, 2 * math.pi), st.floats(1.0, 5e6))
def test_direct_undoes_inverse(lat1, lon1, course, length):
    lat2, lon2 = geodesy.direct(lat1, lon1, course, length)
    back = float(geodesy.distance(lat1, lon1, lat2, lon2))
    assert back == pytest.approx(length, rel=1e-9, abs=1e-6)  # degrees hold a micrometre


@given(lat, lon, lat, lon)
def test_triangle_inequality(lat1, lon1, lat2, lon2):
    whole = float(geodesy.distance(lat1, lon1, lat2, lon2))
    way = float(geodesy.distance(lat1, lon1, 10.0, 20.0) + geodesy.distance(10.0, 20.0, lat2, lon2))
    assert whole <= way * (1 + 1e-12)


def test_densify_preserves_vertices_and_length():
    lats, lons = np.array([50.0, 45.0, 40.7]), np.array([-5.0, -40.0, -74.0])
    fine_lat, fine_lon, leg = geodesy.densify(lats, lons, 50_000.0)
    pieces = geodesy.distance(fine_lat[:-1], fine_lon[:-1], fine_lat[1:], fine_lon[1:])
    assert pieces.max() <= 50_000.0
    assert pieces.sum() == pytest.approx(
        geodesy.distance(lats[:-1], lons[:-1], lats[1:], lons[1:]).sum()
    )
    assert fine_lat[np.searchsorted(leg, 1)] == 45.0
    assert (fine_lat[-1], fine_lon[-1]) == (40.7, -74.0)


@pytest.mark.parametrize(
    ("text", "position"),
    [
        ("52.0N 4.1E", (52.0, 4.1)),
        ("52.0,4.1", (52.0, 4.1)),
        ("-33.9, 151.2", (-33.9, 151.2)),
        ("52 30 N 4 06 W", (52.5, -4.1)),
        ("52°30'N 004°06'W", (52.5, -4.1)),
        ("33.9S 151.2E", (-33.9, 151.2)),
        ("51 57.3N 004 02.1E", (51.955, 4.035)),
        ("51-57.3N 004-02.1W", (51.955, -4.035)),
        ("51°57.3'N, 4°2.1'E", (51.955, 4.035)),
        ("N51 57.3 E004 02.1", (51.955, 4.035)),
        ("S33-54.0, E151-12.0", (-33.9, 151.2)),
        ("0N 190E", (0.0, -170.0)),
    ],
)
def test_positions_in_text(text, position):
    assert geodesy.parse_position(text) == pytest.approx(position)


@pytest.mark.parametrize("text", ["Rotterdam", "NLRTM", "52.0", "52.0N"])
def test_a_name_is_not_a_position(text):
    assert geodesy.parse_position(text) is None


@pytest.mark.parametrize(
    "text", ["-33 54S 18.2", "-29.8S 31.5E", "33.9S,-18.2", "52.0N 4.1", "-1 2 3"]
)
def test_a_position_that_is_written_in_another_way_says_how_to_write_it(text):
    with pytest.raises(InputError, match=r"33\.9S 18\.2E"):
        geodesy.parse_position(text)


def test_swapped_latitude_gets_a_hint():
    with pytest.raises(InputError, match="swapped"):
        geodesy.check_position(151.2, -33.9)


@pytest.mark.parametrize("text", ["52 75 N 4 06 E", "52 30 N 4 60 E", "52 30 61 N 4 06 E"])
def test_sixty_minutes_are_refused(text):
    with pytest.raises(InputError, match="60 or more minutes"):
        geodesy.parse_position(text)


def test_longitude_just_beyond_the_antimeridian_stays_in_its_range():
    for value in (-180.00000000000003, 180.0, 540.0, -180.0):
        assert float(geodesy.wrap_longitude(value)) == -180.0


@given(lon)
def test_wrapping_leaves_longitudes_alone(value):
    assert float(geodesy.wrap_longitude(value)) == value
    assert float(geodesy.wrap_longitude(value + 360.0)) == pytest.approx(value, abs=1e-9)


def test_a_degree_of_the_mean_sphere() -> None:
    arc = math.radians(1.0) * geodesy.MEAN_RADIUS
    assert pytest.approx(arc, abs=0.1) == geodesy.METRES_PER_DEGREE


def test_unwrap_longitude_have_no_jumps() -> None:
    lines = np.array([[170.0, 179.0, -178.0, -170.0], [-179.0, 179.0, 0.0, 10.0]])
    got = geodesy.unwrap_longitude(lines)
    np.testing.assert_allclose(got[0], [170.0, 179.0, 182.0, 190.0])
    np.testing.assert_allclose(got[1, :2], [-179.0, -181.0])
    np.testing.assert_allclose(geodesy.wrap_longitude(got), lines)


@given(lat, lon, lat, lon)
def test_rough_lengths_are_within_0_6_percent_of_geodesics(lat1, lon1, lat2, lon2):
    exact = float(geodesy.distance(lat1, lon1, lat2, lon2))
    rough = geodesy.rough_lengths(np.array([lat1, lat2]), np.array([lon1, lon2]))
    assert rough.shape == (1,)
    assert rough[0] == pytest.approx(exact, rel=6e-3, abs=0.1)


@given(lat, lon, lat, lon)
def test_angles_between_unit_vectors_are_rough_lengths(lat1, lon1, lat2, lon2):
    vectors = geodesy.unit_vectors([lat1, lat2], [lon1, lon2])
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=1), 1.0)
    half_chord = 0.5 * float(np.linalg.norm(vectors[1] - vectors[0]))
    angle = 2.0 * math.asin(min(1.0, half_chord))
    rough = geodesy.rough_lengths(np.array([lat1, lat2]), np.array([lon1, lon2]))
    assert rough[0] == pytest.approx(angle * geodesy.MEAN_RADIUS, abs=1.0)


@given(lat, lon)
def test_geocentric_positions_undo_geocentric_unit_vectors(lat, lon):
    vectors = geodesy.geocentric_unit_vectors(np.array([lat]), np.array([lon]))
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=1), 1.0)
    got = geodesy.geocentric_positions(vectors)
    assert got[0] == pytest.approx(lat, abs=1e-9)
    assert (got[1] - lon + 180.0) % 360.0 == pytest.approx(180.0, abs=1e-9)  # 180 W is 180 E


def test_geocentric_vectors_are_exact_at_the_antimeridian_and_the_poles() -> None:
    east, west = geodesy.geocentric_unit_vectors(np.array([10.0, 10.0]), np.array([180.0, -180.0]))
    np.testing.assert_array_equal(east, west)
    poles = geodesy.geocentric_unit_vectors(np.array([90.0, 90.0]), np.array([0.0, 77.0]))
    np.testing.assert_array_equal(poles[0], poles[1])


def test_longitude_difference_turns_by_less_than_half_the_globe():
    assert geodesy.longitude_difference(-179.0, 179.0) == 2.0
    assert geodesy.longitude_difference(179.0, -179.0) == -2.0
    assert geodesy.longitude_difference(180.0, 0.0) == -180.0
    assert geodesy.longitude_difference(np.array([10.0, 350.0]), -5.0).tolist() == [15.0, -5.0]


def test_length_of_a_line():
    line = ((50.0, -1.0), (50.5, 0.0), (51.0, 1.0))
    legs = [float(geodesy.distance(*a, *b)) for a, b in itertools.pairwise(line)]
    assert geodesy.line_length(line) == pytest.approx(sum(legs))
    assert geodesy.line_length(line[:1]) == geodesy.line_length([]) == 0.0


def test_positions_along_many_geodesics_are_those_along_each():
    ends = np.array([[50.0, -10.0, 52.0, -3.0], [-5.0, 179.0, 5.0, -179.0]])
    share = np.array([0.25, 0.5])
    lat, lon = geodesy.positions_along(*ends.T, share)
    for k, end in enumerate(ends):
        assert (lat[k], lon[k]) == geodesy.positions_along(*end, share[k])
