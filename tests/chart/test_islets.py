"""Small islets and rocks that the intermediate coastline lacks."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.coast.coast_index_builder import build_index
from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.coast.gshhg import read_land_rings
from thalweg.chart.coast.islets import islet_rings
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.chart.passages import PASSAGES
from thalweg.chart.rings import Rings
from thalweg.core.geodesy import densify

# General knowledge (positions of lighthouses), to half a minute.
ISLETS = {
    "Bannec off Ushant": (48.4217, -5.0177),
    "Rockall": (57.5963, -13.6873),
    "Casquets": (49.722, -2.377),
    "Farilhoes": (39.475, -9.545),
    "Fastnet": (51.389, -9.603),
    "Wolf Rock": (49.945, -5.808),
    "Eddystone": (50.180, -4.265),
    "Roches Douvres": (49.106, -2.814),
    "Pedra Branca": (1.330, 104.406),
    "Saint Peter and Saint Paul": (0.917, -29.346),
    "Bassas da India": (-21.48, 39.68),
    "Kobe Airport": (34.633, 135.226),
    "Kansai Airport": (34.430, 135.232),
}


@pytest.mark.parametrize("name", ISLETS)
def test_islets_far_from_the_coast_are_land(world, name):
    assert world.coastline.shore_distance(*ISLETS[name]) < 500.0


def test_islets_are_small_boxes_that_the_coarser_scale_lacks():
    rings = islet_rings()
    assert len(rings) > 50_000
    assert np.all(np.diff(rings.start) == 5)
    lat, lon = rings.lat.reshape(-1, 5), rings.lon.reshape(-1, 5)
    assert np.ptp(lat, axis=1).max() < 0.2
    assert np.ptp(lat, axis=1).min() > 0.0 and np.ptp(lon, axis=1).min() > 0.0
    assert np.abs(lat).max() < 90.0 and np.abs(lon).max() <= 181.0
    bare = read_land_rings("i", islets=False)
    assert len(read_land_rings("i")) == len(bare) + len(rings)
    assert len(read_land_rings("l")) < len(bare)


@pytest.mark.slow
def test_lines_of_passages_are_clear_of_islets(world):
    bare = read_land_rings("i", islets=False)
    before = Coastline("bare", build_index(bare, 256), lambda: bare)
    for passage in PASSAGES:
        lat, lon, _ = densify(*passage.positions, 200.0)
        afloat = before.shore_distance(lat, lon) > 0.0
        assert np.all(world.coastline.shore_distance(lat, lon)[afloat] > 0.0), passage.name


def test_legs_over_an_islet_are_blocked(world):
    assert world.legs_blocked(48.4217, -5.06, 48.4217, -4.99)
    kept = world.with_offing(2.0 * 1852.0)
    assert kept.legs_blocked(57.62, -14.5, 57.62, -12.5)  # 1.4 nm north of Rockall
    assert not kept.legs_blocked(57.66, -14.5, 57.66, -12.5)
    assert not Chart.gshhg("l").legs_blocked(57.5963, -13.8, 57.5963, -13.6)


def test_named_shoal_areas_need_not_repeat_islets():
    assert not {"Farilhoes", "Casquets rocks"} & {area.name for area in SHOAL_AREAS}


def test_boxes_one_above_the_other_leave_no_sea_closed():
    corners = [((0.0, 10.0), (0.0, 10.5), (1.0, 10.5), (1.0, 10.0))]
    corners += [tuple((lat + 1.0, lon) for lat, lon in corners[0])]
    # the step from the first ring to the second runs along the western side of the first
    rings = Rings.from_lists([(box, False) for box in corners])
    coast = Coastline("boxes", build_index(rings, 64), lambda: rings)
    lat = np.array([0.5, 1.5, 0.5, 1.5, 0.5, 1.5])
    lon = np.array([10.2, 10.2, 9.0, 9.0, 30.0, 30.0])
    assert (coast.shore_distance(lat, lon) > 0.0).tolist() == [False, False, True, True, True, True]
