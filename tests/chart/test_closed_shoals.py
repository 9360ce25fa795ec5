"""Closed shoals: where the depth layer has metres less than required, and what stays open."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.depth.closed_shoals import ClosedShoals, closing_depth
from thalweg.chart.depth.global_depth import coarse_depth
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.codes import NO_GO, OK

BOX = (40.0, 43.0, -72.0, -68.0)
CLOSED = ClosedShoals(7.5, box=BOX)
SOUND = (41.45, -70.3, 41.45, -70.1)  # Nantucket Sound, a named area of 6 m


@pytest.mark.parametrize(
    ("required", "depth"), [(9.5, 7.5), (14.0, 11.2), (20.0, 16.0), (3.0, 1.0), (1.5, 0.0)]
)
def test_water_is_closed_two_metres_and_a_fifth_below_what_is_required(required, depth):
    assert closing_depth(required) == pytest.approx(depth)


def test_between_water_points_the_closed_water_is_where_the_layer_is_shallower():
    lat, lon = (x.ravel() for x in np.mgrid[40.1:42.9:0.013, -71.9:-68.1:0.017])
    depth = coarse_depth(lat, lon)
    off_land = Chart.gshhg("i").coastline.shore_distance(lat, lon, cap=15000.0) > 14000.0
    named = np.any([area.contains(lat, lon) for area in SHOAL_AREAS if area.depth < 7.5], axis=0)
    sure = off_land & ~named & (np.abs(depth - 7.5) > 1.0)
    assert not (CLOSED.contains(lat[sure], lon[sure]) ^ (depth[sure] < 7.5)).any()
    assert CLOSED.contains(lat[named], lon[named]).all()


def test_no_leg_crosses_closed_shoals_and_users_zones_are_told_apart():
    open_water = Chart.open_water()
    chart = replace(open_water, zones=Zones(closed_shoals=CLOSED))
    assert chart.leg_status(*SOUND) == NO_GO and open_water.leg_status(*SOUND) == OK
    assert not chart.is_navigable(SOUND[0], SOUND[1])
    assert not chart.crosses_no_go_zone(*SOUND)  # of the user: approaches of ports cross shoals
    assert chart.leg_status(40.2, -69.5, 40.2, -68.5) == OK
    assert chart.fingerprint() != open_water.fingerprint()
    assert Zones().joined(chart.zones).closed_shoals is CLOSED
    assert not Zones().closed_shapes and Zones().closed_index is not None


def test_channels_and_discs_stay_open():
    line = ((41.45, -70.5), (41.45, -70.0))
    beside = 41.45, -70.2
    assert CLOSED.contains(*(np.array([x]) for x in beside))[0]
    along = replace(CLOSED, channels=(line,))
    round_place = replace(CLOSED, discs=((41.45, -70.25, 8.0 * NAUTICAL_MILE),))
    for opened in (along, round_place):
        assert not opened.contains(*(np.array([x]) for x in beside))[0]
        assert opened.text() != CLOSED.text()
    off = 41.8, -70.25
    assert distance(*off, 41.45, -70.25) > 8.0 * NAUTICAL_MILE
    shoals = np.array([41.0]), np.array([-69.7])  # Nantucket Shoals
    assert CLOSED.contains(*shoals) and round_place.contains(*shoals)


def test_boxes_across_the_antimeridian_hold_the_same_shoals():
    lat, lon = (x.ravel() for x in np.mgrid[-20.0:-15.0:0.05, 176.0:184.0:0.05])
    east = ClosedShoals(12.0, box=(-21.0, -14.0, 175.0, 185.0))
    west = ClosedShoals(12.0, box=(-21.0, -14.0, -185.0, -175.0))
    found = east.contains(lat, lon)
    assert found.any() and np.array_equal(found, west.contains(lat, lon - 360.0))
