"""Zones from GeoJSON and ports of the World Port Index."""

from __future__ import annotations

import json

import pytest

from thalweg.chart import Chart
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


def test_land_is_told_before_a_zone(world):
    chart = world.with_zones(zone(0, 40, 10, 60, kind="no go zone"))
    assert chart.leg_status(47.0, 2.0, 47.0, 3.0) == LAND
    assert chart.leg_status(54.0, 3.0, 54.0, 4.0) == NO_GO


def test_factors_are_weighted_by_length():
    chart = OPEN.with_zones([zone(1, -1, 2, 1, kind="penalty", factor=3.0)])
    penalty, price = chart.zone_factor(0.0, [0.0, 1.2, 5.0], 0.0, [4.0, 1.8, 6.0])
    assert penalty == pytest.approx([1.5, 3.0, 1.0], abs=1e-6)
    assert price.tolist() == [1.0, 1.0, 1.0]


def test_overlapping_zones_count_the_largest_factor():
    chart = OPEN.with_zones(
        [zone(0, -1, 2, 1, kind="price", factor=1.5), zone(1, -1, 3, 1, kind="ECA", factor=2.0)]
    )
    assert chart.zone_factor(0.0, 0.0, 0.0, 3.0)[1] == pytest.approx((1.5 + 2.0 + 2.0) / 3.0)
    more = chart.with_zones(zone(0, -1, 3, 1, kind="price", factor=4.0))
    assert more.zone_factor(0.0, 0.0, 0.0, 3.0)[1] == pytest.approx(4.0)


def test_zones_cross_the_antimeridian():
    features = [
        zone(179, -1, -179, 1, kind="penalty", factor=2.0),
        zone(179, 2, -179, 3, kind="nogo"),
    ]
    chart = OPEN.with_zones({"type": "FeatureCollection", "features": features})
    assert chart.zone_factor(0.0, 178.0, 0.0, -178.0)[0] == pytest.approx(1.5)
    assert chart.zone_factor(0.0, -178.0, 0.0, 178.0)[0] == pytest.approx(1.5)
    assert chart.legs_blocked(2.5, 178.0, 2.5, -178.0)
    assert not chart.is_navigable(2.5, -179.5)


@pytest.mark.parametrize(
    ("properties", "words"),
    [
        ({}, "no kind"),
        ({"kind": "lovely"}, "'no-go', 'penalty', 'price'"),
        ({"kind": "penalty"}, "at least 1"),
        ({"kind": "penalty", "factor": 0.5}, "at least 1"),
        ({"kind": "price", "factor": -1}, "above 0"),
        ({"kind": "price", "factor": "nan"}, "above 0"),
    ],
)
def test_zones_that_make_no_sense_are_refused(properties, words):
    with pytest.raises(InputError, match=words):
        OPEN.with_zones(zone(0, 0, 1, 1, **properties))


def test_swapped_or_broken_coordinates_are_refused(tmp_path):
    with pytest.raises(InputError, match="longitude first"):
        OPEN.with_zones(zone(0, 120, 1, 121, kind="no-go"))
    with pytest.raises(InputError, match="four"):
        Chart.from_geojson({"type": "Polygon", "coordinates": [[[0, 0], [1, 1]]]})
    with pytest.raises(InputError, match="no area"):
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
    assert OPEN.port(text).locode == locode


def test_rotterdam_is_where_it_is():
    port = OPEN.ports.lookup("Rotterdam")
    assert (port.name, port.country_code) == ("Rotterdam", "NL")
    assert (port.lat, port.lon) == pytest.approx((51.9, 4.483), abs=0.01)


def test_an_ambiguous_port_lists_the_candidates():
    with pytest.raises(InputError) as caught:
        OPEN.port("Georgetown")
    assert "GYGEO" in str(caught.value)
    assert "USGGE" in caught.value.details["near"]


def test_an_unknown_port_names_near_ones():
    with pytest.raises(InputError, match="Rotterdam"):
        OPEN.port("Rotterdm")
    with pytest.raises(InputError, match="no port"):
        OPEN.port("")


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
