"""The depth layer of the package, and miles that count more in shoal water."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.depth.global_depth import DEEPEST, coarse_depth, global_depth_codes
from thalweg.chart.depth.shoals import EXCESS, Shoals, safety_contour
from thalweg.chart.zones.zone_set import Zones
from thalweg.kernels.geometry.shoal_excess import shoal_excesses

SHOALS = Shoals(20.0, 12.0)


@pytest.mark.parametrize(
    ("place", "low", "high"),
    [
        ((50.2, -1.0), 45.0, 70.0),  # the English Channel, open
        ((51.0, 1.45), 20.0, 50.0),  # Dover Strait
        ((55.0, 3.0), 15.0, 45.0),  # Dogger Bank
        ((41.4, -70.3), 3.0, 15.0),  # Nantucket Sound
        ((24.0, -78.5), 0.0, 12.0),  # Great Bahama Bank
        ((40.0, -55.0), DEEPEST, DEEPEST),
    ],
)
def test_the_layer_has_the_depths_of_the_sea(place, low, high):
    assert low <= coarse_depth(*place) <= high


def test_between_land_the_layer_is_unknown():
    assert np.isnan(coarse_depth([47.0, np.nan], [8.0, 8.0])).all()


def test_points_on_land_do_not_make_water_near_them_shallow():
    code = np.zeros((1801, 3600), np.uint8)
    code[900, 1800] = 51  # 50 m at 0 N 0 E, land all round
    shoals = SHOALS.arrays._replace(code=code, free=np.zeros((360, 720), np.uint8))
    found = np.empty(1)
    shoal_excesses(shoals, *(np.array([x]) for x in (0.0, -0.09, 0.0, 0.09)), found)
    assert found[0] == 0.0


@pytest.mark.parametrize(
    ("draught", "contour"),
    [(2.0, 5.0), (5.0, 10.0), (9.5, 20.0), (12.0, 20.0), (14.0, 30.0), (40.0, 60.0)],
)
def test_the_contour_is_one_and_a_half_draughts_or_the_next_on_charts(draught, contour):
    assert safety_contour(draught) == contour


def uniform(depth):
    code = np.full((1801, 3600), depth + 1, np.uint8)
    return SHOALS.arrays._replace(code=code, free=np.zeros((360, 720), np.uint8))


@pytest.mark.parametrize(
    ("depth", "excess"),
    [(25, 0.0), (20, 0.0), (16, 0.25), (12, 0.5), (9, 9.75), (6, 19.0), (0, 19.0)],
)
def test_a_mile_counts_more_the_shallower_the_water(depth, excess):
    found = np.empty(2)
    lat1, lon1 = np.array([50.0, 10.0]), np.array([3.0, 179.9])
    shoal_excesses(uniform(depth), lat1, lon1, lat1 + 0.3, lon1 + 7.0, found)
    assert found == pytest.approx(excess)
    assert EXCESS == (0.5, 19.0)


def some_legs(count, reach, seed=3):
    rng = np.random.default_rng(seed)
    lat1, lon1 = rng.uniform(-60, 60, count), rng.uniform(-180, 180, count)
    lat2, lon2 = lat1 + rng.uniform(-reach, reach, count), lon1 + rng.uniform(-reach, reach, count)
    return lat1, lon1, lat2, lon2


@pytest.mark.parametrize("reach", [0.3, 3.0, 25.0])
def test_tiles_without_shoals_are_skipped_without_a_difference(reach):
    legs = some_legs(3000, reach)
    found = SHOALS.excess(*legs)
    plain = np.empty(len(found))
    shoal_excesses(SHOALS.arrays._replace(free=np.zeros((360, 720), np.uint8)), *legs, plain)
    assert (found > 0.0).any()
    assert found == pytest.approx(plain, abs=1e-12)


def test_the_excess_is_the_mean_along_the_leg_in_both_directions():
    lat1, lon1, lat2, lon2 = some_legs(2000, 0.8)
    share = np.linspace(0.0, 1.0, 401)[:, None]
    depth = coarse_depth(lat1 + share * (lat2 - lat1), lon1 + share * (lon2 - lon1))
    excess = np.interp(depth, [6.0, 12.0, 20.0], [19.0, 0.5, 0.0])
    excess[np.isnan(depth)] = 0.0
    found = SHOALS.excess(lat1, lon1, lat2, lon2)
    assert np.abs(found - excess.mean(axis=0)).mean() < 0.04  # named areas count as well
    assert found == pytest.approx(SHOALS.excess(lat2, lon2, lat1, lon1), abs=1e-9)


def test_channels_count_as_deep_along_their_lines():
    line = ((41.4, -70.9), (41.4, -70.1))  # through Nantucket Sound
    inside = SHOALS.excess(41.4, -70.7, 41.4, -70.2)
    assert inside > 1.0
    assert Shoals(20.0, 12.0, (line,)).excess(41.4, -70.7, 41.4, -70.2) == 0.0
    assert global_depth_codes()[1314, 1097] - 1 < 20  # the layer itself is unchanged


def test_a_named_area_beside_a_harbour_stays_shoal():
    inside, outside = (51.85, 2.0), (51.835, 1.8)  # Galloper, and the sea end of Felixstowe
    for place, shoal in ((outside, True), (inside, False)):
        shoals = Shoals(20.0, 12.0, harbours=(place,))
        assert (shoals.excess(51.85, 1.98, 51.85, 2.02) > 5.0) == shoal
        assert shoals.excess(51.835, 1.78, 51.835, 1.8) == 0.0


def test_shoals_add_to_penalty_zones_and_change_the_fingerprint():
    square = [[-71.0, 41.0], [-70.0, 41.0], [-70.0, 41.9], [-71.0, 41.9], [-71.0, 41.0]]
    zone = {"type": "Feature", "properties": {"kind": "penalty", "factor": 2.0},
            "geometry": {"type": "Polygon", "coordinates": [square]}}  # fmt: skip
    leg = (41.4, -70.7, 41.4, -70.2)
    both = Chart.open_water().with_zones({"type": "FeatureCollection", "features": [zone]})
    alone = Zones(shoals=SHOALS)
    joined = both.zones.joined(alone)
    assert joined.factors(*leg)[0] == pytest.approx(1.0 + SHOALS.excess(*leg) + 1.0)
    assert joined.has_penalty and alone.has_penalty and not Zones().has_penalty
    assert len({tuple(z.texts()) for z in (joined, both.zones, alone, Zones())}) == 4


def test_beside_points_that_are_too_shallow_gentle_slopes_count_as_shoal_from_the_next_point_on():
    # Eierlandse Gronden: the points off Texel have 22 m and 7 m, one tenth of a degree apart
    assert coarse_depth(53.2, 4.7) > 20.0 and coarse_depth(53.2, 4.8) < 9.0
    shoals = Shoals(10.0, 7.2)
    code = shoals.arrays.code
    assert code[1432, 1847] == 11 and global_depth_codes()[1432, 1847] > 20  # 10 m
    assert shoals.excess(53.2, 4.71, 53.2, 4.73) > 0.0  # where the layer has more than 15 m
    assert shoals.excess(53.2, 4.5, 53.2, 4.65) == 0.0
    open_sea = np.s_[1460:1500, 1790:1850]  # steep slopes off Norway stay as they are
    steep = global_depth_codes()[open_sea] > 3.0 * 10.0 + 1.0
    assert np.array_equal(code[open_sea][steep], global_depth_codes()[open_sea][steep])
