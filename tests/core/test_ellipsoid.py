"""The dimensions of the Earth are those of the library that geodesics come from."""

from thalweg.core import ellipsoid
from thalweg.core.geodesy import WGS84


def test_the_ellipsoid_is_that_of_the_geodesics():
    assert WGS84.a == ellipsoid.EQUATORIAL_RADIUS
    assert WGS84.f == ellipsoid.FLATTENING
    assert abs(ellipsoid.ECCENTRICITY_SQUARED - WGS84.es) < 1e-15
    assert abs(ellipsoid.AXIS_RATIO_SQUARED - (WGS84.b / WGS84.a) ** 2) < 1e-14
    assert abs(ellipsoid.MEAN_RADIUS - (2.0 * WGS84.a + WGS84.b) / 3.0) < 0.05
