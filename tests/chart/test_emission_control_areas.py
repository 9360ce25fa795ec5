"""Emission control areas: limits, dates, and the fraction of a leg inside them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thalweg.chart import Chart
from thalweg.chart.zones.emission_control_areas import (
    emission_control_areas,
    select_emission_control_areas,
)
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.geodesy import direct, distance, positions_along
from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.geometry.cube_sphere import inside, unit_vector


def zone(west, south, east, north, **properties):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": {"kind": "eca", **properties}, "geometry": geometry}


OPEN = Chart.open_water()
IN_FORCE = [
    "baltic-sea",
    "north-sea",
    "north-america-pacific",
    "north-america-atlantic",
    "north-america-hawaii",
    "us-caribbean",
    "mediterranean",
]


@pytest.fixture(scope="module")
def seas() -> Chart:
    return OPEN.with_eca()


def test_the_areas_that_count_today(seas):
    assert [z.name for z in seas.zones.eca] == IN_FORCE


@pytest.mark.parametrize(
    ("date", "names"),
    [
        ("2006-05-18", []),
        ("2006-05-19", ["baltic-sea"]),
        ("2007-11-22", ["baltic-sea", "north-sea"]),
        ("2012-08-01", IN_FORCE[:5]),
        ("2025-04-30T23:59Z", IN_FORCE[:6]),
        ("2025-05-01", IN_FORCE),
    ],
)
def test_dates_of_areas(date, names):
    assert [z.name for z in OPEN.with_eca(date=date).zones.eca] == names


def test_areas_to_come_are_known_but_not_their_limits():
    areas = {area.name: area for area in emission_control_areas()}
    assert areas["norwegian-sea"].sulphur_from == "2027-03-01"
    assert areas["canadian-arctic"].sulphur_from == "2027-03-01"
    assert areas["north-east-atlantic"].sulphur_from == "2028-09-01"
    with pytest.raises(InputError, match=r"limits.*not in this package"):
        OPEN.with_eca("norwegian-sea")
    with pytest.warns(ThalwegWarning, match=r"canadian-arctic, norwegian-sea.*unknown here"):
        assert len(OPEN.with_eca(date="2027-03-01").zones.eca) == 7


def test_names_short_unknown_and_too_early():
    assert [z.name for z in OPEN.with_eca(["North America"]).zones.eca] == IN_FORCE[2:5]
    with pytest.raises(InputError, match="north-sea"):
        OPEN.with_eca("norht-sea")
    with pytest.raises(InputError, match="does not count on 2024-01-01"):
        OPEN.with_eca("mediterranean", date="2024-01-01")
    twice = OPEN.with_eca("north-sea").with_eca(["north-sea", "baltic-sea"])
    assert [z.name for z in twice.zones.eca] == ["north-sea", "baltic-sea"]


def test_published_points_are_exact():
    for name, first, count in (
        ("north-america-pacific", (32.536111, -117.103056), 47),
        ("north-america-atlantic", (60.0, -64.16), 206),
        ("north-america-hawaii", (22.548333, -153.009167), 44),
        ("us-caribbean", (17.310278, -67.537222), 54),
    ):
        rings = select_emission_control_areas(name)[0].rings
        points = set(zip(rings.lat.tolist(), rings.lon.tolist()))
        assert first in points
        assert len(points) >= count


@pytest.mark.parametrize(
    ("lat", "lon", "within"),
    [
        (61.99, 0.0, True),  # the North Sea south of 62 N ...
        (62.01, 0.0, False),
        (60.0, -3.99, True),  # ... and east of 4 W
        (60.0, -4.01, False),
        (49.5, -4.99, True),  # the Channel east of 5 W
        (49.5, -5.01, False),
        (48.51, -5.0 + 1e-3, True),  # and north of 48 30 N
        (47.0, -5.0, False),
        (53.5, -5.0, False),  # the Irish Sea
        (59.0, 20.0, True),
        (57.7, 11.3, True),  # Kattegat: Baltic
        (57.8, 11.3, True),  # Skagerrak: North Sea
        (64.5, 10.0, False),
        (36.0, -5.9, True),  # inside the line from Cape Trafalgar to Cape Spartel
        (36.0, -6.05, False),
        (40.7, 28.0, False),  # Sea of Marmara
        (43.0, 35.0, False),
        (31.4, 32.35, False),  # the approach of the Suez Canal is left out
        (31.6, 32.35, True),
        (40.0, -70.0, True),
        (40.0, -60.0, False),
        (21.0, -157.0, True),
        (18.0, -66.0, True),
        (27.0, -94.0, True),
        (25.5, -94.0, False),
        (48.0, -126.0, True),
        (48.0, -133.0, False),
    ],
)
def test_places_inside_and_outside(seas, lat, lon, within):
    assert bool(seas.zones.in_eca(lat, lon)) is within
    assert any(z.contains(lat, lon) for z in seas.zones.eca) is within
    assert bool(seas.zones.in_eca(lat, lon + 360.0)) is within


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "box"),
    [
        ("baltic-sea", (54.0, 57.6, 11.2, 19.0)),
        ("baltic-sea", (60.0, 65.9, 17.0, 30.5)),
        ("north-sea", (51.5, 61.9, 0.5, 7.0)),
        ("mediterranean", (31.0, 39.5, 15.5, 25.9)),
        ("north-america-atlantic", (43.6, 51.0, -69.5, -57.5)),
        ("north-america-pacific", (47.2, 50.0, -127.0, -122.3)),
        ("north-america-pacific", (54.0, 60.0, -137.0, -130.5)),
    ],
)
def test_closing_lines_leave_no_coastal_water_out(world, name, box):
    south, north, west, east = box
    lat, lon = (m.ravel() for m in np.mgrid[south:north:0.1, west:east:0.1])
    water = world.is_navigable(lat, lon)
    assert water.sum() > 500
    assert OPEN.with_eca(name).zones.in_eca(lat[water], lon[water]).all()


def test_share_of_a_leg_half_inside():
    chart = OPEN.with_zones(zone(0, -1, 2, 1))
    assert chart.zones.eca_fraction(0.0, -1.0, 0.0, 1.0) == pytest.approx(0.5, abs=2e-6)
    assert chart.zones.eca_fraction(0.5, [0.5, 3.0], 0.5, [1.5, 4.0]).tolist() == [1.0, 0.0]
    assert np.isnan(chart.zones.eca_fraction(np.nan, 0.0, 0.0, 1.0))
    assert np.isnan(OPEN.zones.eca_fraction(np.nan, 0.0, 0.0, 1.0))
    assert OPEN.zones.eca_fraction(0.0, 0.0, 0.0, 1.0) == 0.0
    assert not OPEN.zones.in_eca(0.0, 0.0)


def test_share_is_by_length_on_a_long_oblique_geodesic():
    """The geodesic's own crossing of 60 N, by bisection, against the share."""
    chart = OPEN.with_zones(zone(-60, 60, 20, 80))
    ends = (50.0, -40.0, 70.0, 5.0)
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if positions_along(*ends, middle)[0] < 60.0 else (low, middle)
    length = float(distance(*ends))
    assert float(chart.zones.eca_fraction(*ends)) * length == pytest.approx(
        (1.0 - low) * length, abs=0.5
    )


def test_a_leg_out_of_one_area_and_into_another(seas):
    """Santander road to Boston: fractions of pieces add up for any division."""
    ends = (48.0, -12.0, 42.0, -69.0)
    whole = float(seas.zones.eca_fraction(*ends))
    lat, lon = positions_along(*ends, np.linspace(0.0, 1.0, 38))
    parts = seas.zones.eca_fraction(lat[:-1], lon[:-1], lat[1:], lon[1:])
    lengths = distance(lat[:-1], lon[:-1], lat[1:], lon[1:])
    assert whole == pytest.approx(float((parts * lengths).sum() / lengths.sum()), abs=1e-6)
    assert 0.1 < whole < 0.5


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(st.floats(-70, 70), st.floats(-180, 180), st.floats(0, 6.28), st.floats(1e3, 8e5), st.data())
def test_share_agrees_with_many_points(lat, lon, course, length, data):
    size = data.draw(st.floats(0.2, 5.0))
    at = data.draw(st.floats(0.0, 1.0))
    end = direct(lat, lon, course, length)
    middle = direct(lat, lon, course, at * length)
    y, x = float(middle[0]), float(middle[1])
    ring = [
        [x + size * np.cos(a), min(89.0, max(-89.0, y + 0.7 * size * np.sin(a)))]
        for a in np.linspace(0.0, 2.0 * np.pi, 7)[:-1]
    ]
    feature = {
        "type": "Feature",
        "properties": {"kind": "eca"},
        "geometry": {"type": "Polygon", "coordinates": [[*ring, ring[0]]]},
    }
    chart = OPEN.with_zones(feature)
    share = float(chart.zones.eca_fraction(lat, lon, *end))
    y, x = positions_along(lat, lon, float(end[0]), float(end[1]), (np.arange(2000) + 0.5) / 2000)
    assert share == pytest.approx(chart.zones.in_eca(y, x).mean(), abs=3e-3)


def test_areas_across_the_antimeridian():
    chart = OPEN.with_zones(zone(179, -1, -179, 1))
    assert chart.zones.in_eca(0.0, [179.5, -179.5, 178.5, 180.5]).tolist() == [
        True,
        True,
        False,
        True,
    ]
    assert chart.zones.eca_fraction(0.0, 178.0, 0.0, -178.0) == pytest.approx(0.5, abs=2e-6)
    written_on = OPEN.with_zones(zone(179, -1, 181, 1))
    assert written_on.zones.eca_fraction(0.0, 178.0, 0.0, -178.0) == pytest.approx(0.5, abs=2e-6)
    assert written_on.zones.eca[0].contains(0.0, [-179.5, 179.5]).all()


def test_a_hole_is_outside():
    ring = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
    hole = [[1, 1], [1, 3], [3, 3], [3, 1], [1, 1]]
    feature = {
        "type": "Feature",
        "properties": {"kind": "ECA", "name": "ring"},
        "geometry": {"type": "Polygon", "coordinates": [ring, hole]},
    }
    chart = OPEN.with_zones(feature)
    assert chart.zones.in_eca(2.0, [0.5, 2.0]).tolist() == [True, False]
    assert chart.zones.eca[0].contains(2.0, [0.5, 2.0]).tolist() == [True, False]
    assert chart.zones.eca_fraction(2.0, 0.0, 2.0, 4.0) == pytest.approx(0.5, abs=1e-3)


def test_a_control_area_with_a_factor_is_a_price_zone():
    chart = OPEN.with_zones(zone(0, -1, 2, 1, factor=1.6))
    assert chart.zones.eca == ()
    assert chart.zones.factors(0.0, -1.0, 0.0, 1.0)[1] == pytest.approx(1.3, abs=1e-6)


def test_invalid_outlines_are_refused_with_the_place():
    bow = [[0, 0], [1, 1], [1, 0], [0, 1], [0, 0]]
    for kind in ({"kind": "eca"}, {"kind": "price", "factor": 2.0}, {"kind": "no-go"}):
        feature = {
            "type": "Feature",
            "properties": kind,
            "geometry": {"type": "Polygon", "coordinates": [bow]},
        }
        with pytest.raises(InputError, match=r"self-intersection near longitude 0.5, latitude 0.5"):
            OPEN.with_zones(feature)


def test_the_fingerprint_depends_on_the_areas(seas):
    prints = {chart.fingerprint() for chart in (OPEN, seas, OPEN.with_eca("north-sea"))}
    assert len(prints) == 3


@jit
def _count_inside(index, lat, lon):
    count = 0
    for i in range(len(lat)):
        x, y, z = unit_vector(lat[i], lon[i])
        count += inside(index, x, y, z)
    return count


def test_the_index_for_kernels(seas):
    rng = np.random.default_rng(3)
    lat, lon = rng.uniform(45.0, 64.0, 4000), rng.uniform(-15.0, 12.0, 4000)
    within = seas.zones.in_eca(lat, lon)
    assert _count_inside(seas.zones.eca_index, lat, lon) == within.sum()
