"""Zones from GeoJSON and ports of the World Port Index."""

from __future__ import annotations

import json

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.kernels.codes import LAND, NO_GO, OK


def zone(west, south, east, north, **properties):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": properties, "geometry": geometry}


OPEN = Chart.open_water()


def test_a_no_go_zone_blocks_legs_and_positions():
    chart = OPEN.with_zones(zone(1, 1, 2, 2, kind="no-go"))
    assert chart.leg_status(1.5, 0.0, 1.5, 3.0) == NO_GO
    assert chart.leg_status(1.5, 1.4, 1.5, 1.6) == NO_GO
    assert chart.leg_status(0.5, 0.0, 0.5, 3.0) == OK
    assert chart.is_navigable([1.5, 0.5], [1.5, 1.5]).tolist() == [False, True]
    assert OPEN.is_navigable(1.5, 1.5)


@pytest.mark.parametrize("lat", [0.0, 55.0])
def test_a_margin_keeps_routes_clear_of_a_no_go_zone(lat):
    north, miles = lat + 1.0, 1.0 / 60.0  # a mile of latitude [deg]; across, the cosine counts
    chart = OPEN.with_zones(zone(1, lat, 2, north, kind="no-go", keep_clear_nm=6))
    across = miles / np.cos(np.radians(lat + 0.5))
    assert not chart.is_navigable(north + 5.8 * miles, 1.5)
    assert chart.is_navigable(north + 6.5 * miles, 1.5)
    assert not chart.is_navigable(lat + 0.5, 2.0 + 5.8 * across)
    assert chart.is_navigable(lat + 0.5, 2.0 + 6.5 * across)
    corner = np.array([4.1, 4.8])  # along both axes: 5.8 and 6.8 nm from the corner
    beside = corner * miles / np.cos(np.radians(north))
    assert chart.is_navigable(north + corner * miles, 2.0 + beside).tolist() == [False, True]
    assert chart.zones.margins == pytest.approx([6 * 1852.0])


def test_a_margin_of_another_zone_or_size_is_refused():
    for properties in ({"kind": "no-go", "keep_clear_nm": -1}, {"kind": "eca", "keep_clear_nm": 1}):
        with pytest.raises(InputError, match="keep_clear_nm"):
            OPEN.with_zones(zone(1, 1, 2, 2, **properties))


def test_land_is_reported_before_a_zone(world):
    chart = world.with_zones(zone(0, 40, 10, 60, kind="no go zone"))
    assert chart.leg_status(47.0, 2.0, 47.0, 3.0) == LAND
    assert chart.leg_status(54.0, 3.0, 54.0, 4.0) == NO_GO


def test_factors_are_weighted_by_length():
    chart = OPEN.with_zones([zone(1, -1, 2, 1, kind="penalty", factor=3.0)])
    penalty, price = chart.zones.factors(0.0, [0.0, 1.2, 5.0], 0.0, [4.0, 1.8, 6.0])
    assert penalty == pytest.approx([1.5, 3.0, 1.0], abs=1e-6)
    assert price.tolist() == [1.0, 1.0, 1.0]


def test_factors_of_legs_with_unknown_ends_are_unknown():
    for chart in (OPEN, OPEN.with_zones([zone(1, -1, 2, 1, kind="penalty", factor=3.0)])):
        penalty, price = chart.zones.factors([0.0, float("nan"), 0.0], 0.0, 0.0, 4.0)
        assert np.isnan(penalty).tolist() == np.isnan(price).tolist() == [False, True, False]


def test_overlapping_zones_count_the_largest_factor():
    chart = OPEN.with_zones(
        [zone(0, -1, 2, 1, kind="price", factor=1.5), zone(1, -1, 3, 1, kind="ECA", factor=2.0)]
    )
    assert chart.zones.factors(0.0, 0.0, 0.0, 3.0)[1] == pytest.approx((1.5 + 2.0 + 2.0) / 3.0)
    more = chart.with_zones(zone(0, -1, 3, 1, kind="price", factor=4.0))
    assert more.zones.factors(0.0, 0.0, 0.0, 3.0)[1] == pytest.approx(4.0)


def test_zones_cross_the_antimeridian():
    features = [
        zone(179, -1, -179, 1, kind="penalty", factor=2.0),
        zone(179, 2, -179, 3, kind="nogo"),
    ]
    chart = OPEN.with_zones({"type": "FeatureCollection", "features": features})
    assert chart.zones.factors(0.0, 178.0, 0.0, -178.0)[0] == pytest.approx(1.5)
    assert chart.zones.factors(0.0, -178.0, 0.0, 178.0)[0] == pytest.approx(1.5)
    assert chart.legs_blocked(2.5, 178.0, 2.5, -178.0)
    assert not chart.is_navigable(2.5, -179.5)


@pytest.mark.parametrize(
    ("properties", "words"),
    [
        ({}, "no kind"),
        ({"kind": "lovely"}, "'no-go', 'penalty', 'price'"),
        ({"name": "wind farm"}, "A zone 'wind farm' has no kind"),
        ({"kind": "penalty"}, "at least 1"),
        ({"kind": "penalty", "factor": 0.5}, "at least 1"),
        ({"kind": "price", "factor": -1}, "above 0"),
        ({"kind": "price", "factor": "nan"}, "above 0"),
    ],
)
def test_invalid_zones_are_refused(properties, words):
    with pytest.raises(InputError, match=words):
        OPEN.with_zones(zone(0, 0, 1, 1, **properties))


def test_swapped_or_broken_coordinates_are_refused(tmp_path):
    with pytest.raises(InputError, match="longitude first"):
        OPEN.with_zones(zone(0, 120, 1, 121, kind="no-go"))
    with pytest.raises(InputError, match="four"):
        Chart.from_geojson({"type": "Polygon", "coordinates": [[[0, 0], [1, 1]]]})
    with pytest.raises(InputError, match="not an area"):
        OPEN.with_zones({"type": "Point", "coordinates": [0, 0]})
    path = tmp_path / "zones.geojson"
    path.write_text("{broken")
    with pytest.raises(InputError, match="cannot be read"):
        OPEN.with_zones(path)
    path.write_text(json.dumps(zone(0, 0, 1, 1, kind="no-go")))
    assert not OPEN.with_zones(path).is_navigable(0.5, 0.5)


def test_a_self_crossing_land_polygon_is_repaired_with_a_warning():
    bow = [[0, 0], [1, 1], [1, 0], [0, 1], [0, 0]]
    with pytest.warns(ThalwegWarning, match="repaired"):
        chart = Chart.from_geojson({"type": "Polygon", "coordinates": [bow]})
    assert chart.is_navigable([0.5, 0.5, 0.9], [0.1, 0.9, 0.5]).tolist() == [False, False, True]


@pytest.mark.parametrize(
    ("text", "locode"),
    [
        ("Rotterdam", "NLRTM"),
        ("nlrtm", "NLRTM"),
        ("ROTTERDAM, NL", "NLRTM"),
        ("Le Havre", "FRLEH"),
        ("Antwerp", "BEANR"),
        ("New York", "USNYC"),
        ("Southampton, GB", "GBSOU"),
        ("Málaga", "ESAGP"),
        ("Suez", "EGSUZ"),
    ],
)
def test_ports_are_found_by_name_or_locode(text, locode):
    assert PORTS.lookup(text).locode == locode


def test_rotterdam_is_where_it_is():
    port = PORTS.lookup("Rotterdam")
    assert (port.name, port.country_code) == ("Rotterdam", "NL")
    assert (port.lat, port.lon) == pytest.approx((51.9, 4.483), abs=0.01)


def test_an_ambiguous_port_lists_the_candidates():
    with pytest.raises(InputError) as caught:
        PORTS.lookup("Georgetown")
    assert "GYGEO" in str(caught.value)
    assert "USGGE" in caught.value.details["near"]


@pytest.mark.parametrize(
    ("text", "point"), [("51,45 3,20", "51.45 3.20"), ("-33,5; 151,2", "-33.5  151.2")]
)
def test_positions_with_decimal_commas_are_refused_with_points(text, point):
    with pytest.raises(InputError, match="decimal points") as caught:
        PORTS.lookup(text)
    assert repr(point) in str(caught.value)


def test_an_unknown_port_names_near_ones():
    with pytest.raises(InputError, match="Rotterdam"):
        PORTS.lookup("Rotterdm")
    with pytest.raises(InputError, match="no port"):
        PORTS.lookup("")


@pytest.mark.parametrize(
    ("ring", "said"),
    [
        ([[900, 0], [910, 0], [910, 5], [900, 0]], "longitude 900|longitude 910"),
        ([[0, -80], [10, -80], [10, -99], [0, -80]], "latitude -99"),
    ],
)
def test_positions_off_the_globe_are_named(ring, said):
    zone = {
        "type": "Feature",
        "properties": {"kind": "no-go"},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    with pytest.raises(InputError, match=said):
        Chart.open_water().with_zones(zone)


def _ring_of(*corners):
    ring = [list(corner) for corner in (*corners, corners[0])]
    return {
        "type": "Feature",
        "properties": {"kind": "no-go"},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }


@pytest.mark.parametrize(("west", "east"), [(-100, 100), (-170, 170), (10, 350), (-179.9, 179.9)])
def test_a_wide_zone_is_not_silently_turned_inside_out(west, east):
    """Its direction is that of RFC 7946, so it is not taken to cross the antimeridian."""
    with pytest.raises(InputError, match="degrees as written, or") as caught:
        OPEN.with_zones(zone(west, -10, east, 10, kind="no-go"))
    assert f"longitude {west:g} to {east:g}" in str(caught.value)


@pytest.mark.slow
def test_a_wide_zone_with_points_in_between_is_what_is_written():
    corners = [(-100, -10), (0, -10), (100, -10), (100, 10), (0, 10), (-100, 10)]
    chart = OPEN.with_zones(_ring_of(*corners))
    assert chart.is_navigable(0.0, [-101, -99, 0, 99, 101, 180]).tolist() == [
        True, False, False, False, True, True,
    ]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("west", "east"), [(100, -100), (170, -170), (350, 10), (170, 190)])
def test_a_zone_across_the_antimeridian_or_greenwich_takes_the_short_side(west, east):
    chart = OPEN.with_zones(zone(west, -10, east, 10, kind="no-go"))
    middle = west + 0.5 * ((east - west) % 360)
    outside = [west - 1, east + 1, middle + 180]
    assert chart.is_navigable(0.0, [west + 1, middle, east - 1]).tolist() == [False] * 3
    assert chart.is_navigable(0.0, outside).tolist() == [True] * 3


def test_an_outline_valid_only_across_the_antimeridian_is_accepted_in_both_directions():
    lens = [(179, 0), (179.5, -2), (-179.5, -2), (-179, 0), (-179.5, 2), (179.5, 2)]
    bulging = [
        (179.5, -1), (179.8, -3), (178, 0), (179.8, 3), (179.5, 1), (-179, 1), (-179, -1),
    ]  # fmt: skip
    for corners in (bulging, bulging[::-1]):
        chart = OPEN.with_zones(_ring_of(*corners))
        assert not chart.is_navigable(0.0, 179.9)
        assert chart.is_navigable(0.0, 0.0)
    assert not OPEN.with_zones(_ring_of(*lens)).is_navigable(0.0, 180.0)
    both_names = [
        (170, 0),
        (180, 0),
        (-180, 0),
        (-170, 0),
        (-170, 9),
        (-180, 9),
        (180, 9),
        (170, 9),
    ]
    chart = OPEN.with_zones(_ring_of(*both_names))
    assert chart.is_navigable(5.0, [175, -175, 0, 165]).tolist() == [False, False, True, True]


def test_a_band_round_the_globe_and_a_ring_round_a_pole():
    band = OPEN.with_zones(zone(-180, 60, 180, 90, kind="no-go"))
    assert band.is_navigable([70.0, 70.0, 50.0], [0.0, 180.0, 0.0]).tolist() == [False, False, True]
    with pytest.raises(InputError, match="encloses a pole"):
        OPEN.with_zones(_ring_of((-120, -60), (0, -60), (120, -60)))


def test_anchorages_across_the_antimeridian():
    for west, east in ((170, 190), (-190, -170), (170, -170)):
        chart = OPEN.with_zones(zone(west, -10, east, 10, kind="anchorage"))
        chart = chart.with_zones(zone(179, -1, 181, 1, kind="no-waiting"))
        where = [175, -175, 185, -185, 180, -180, 100, -169]
        assert chart.may_wait(0.0, where).tolist() == [True] * 4 + [False] * 4


def test_a_hole_across_the_antimeridian():
    outer = [[170, -10], [-170, -10], [-170, 10], [170, 10], [170, -10]]
    hole = [[175, -5], [175, 5], [-175, 5], [-175, -5], [175, -5]]
    feature = zone(0, 0, 1, 1, kind="no-go")
    feature["geometry"]["coordinates"] = [outer, hole]
    chart = OPEN.with_zones(feature)
    assert chart.is_navigable(0.0, [171, 176, 180, -176, -171]).tolist() == [
        False, True, True, True, False,
    ]  # fmt: skip


def test_a_hole_may_be_written_on_another_turn_of_longitude_than_its_outline():
    outer = [[170, -10], [190, -10], [190, 10], [170, 10], [170, -10]]
    hole = [[-176, -5], [-176, 5], [-172, 5], [-172, -5], [-176, -5]]
    feature = zone(0, 0, 1, 1, kind="no-go")
    feature["geometry"]["coordinates"] = [outer, hole]
    chart = OPEN.with_zones(feature)
    assert chart.is_navigable(0.0, [175, -178, -174, 186, -171]).tolist() == [
        False, False, True, True, False,
    ]  # fmt: skip


@pytest.mark.parametrize(
    "broken",
    [
        {"geometry": {"type": "Polygon", "coordinates": 5}},
        {"geometry": {"type": "MultiPolygon", "coordinates": [5]}},
        {"properties": [1], "geometry": {"type": "Polygon", "coordinates": []}},
        {"type": "FeatureCollection", "features": 5},
    ],
)
def test_geojson_of_the_wrong_shape_is_refused(broken):
    with pytest.raises(InputError, match="Check the GeoJSON"):
        OPEN.with_zones({"type": "Feature", "properties": {"kind": "no-go"}, **broken})
