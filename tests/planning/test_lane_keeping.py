"""Routes led by the lanes of traffic separation schemes that their network is too coarse for."""

import numpy as np
import pytest

from thalweg import Track
from thalweg.chart.zones.traffic_schemes import TRAFFIC_SCHEMES, lanes_of_schemes
from thalweg.core.geodesy import distance
from thalweg.planning.seaways import world_chart
from thalweg.planning.single.lane_keeping import in_lanes_of_traffic

GIBRALTAR = next(one for one in TRAFFIC_SCHEMES if one.name == "Strait of Gibraltar")
WEST, EAST = (36.0, -7.5), (36.2, -3.5)


@pytest.fixture(scope="module")
def chart():
    from dataclasses import replace

    whole = world_chart()
    return replace(whole, zones=replace(whole.zones, lanes=lanes_of_schemes([WEST, EAST])))


def against_nm(chart, track):
    """Return the miles of a track against lanes or in inshore traffic zones."""
    legs = track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:]
    leg, _, share = chart.zones.lane_group.shares_against(*legs)
    return float(np.sum(share * np.asarray(distance(*legs))[leg])) / 1852.0


def wrong_side(start, goal, metres):
    """Return a track along the separation line on one side of it, from west to east or back."""
    lon, lat = GIBRALTAR.shifted(metres).T
    order = slice(None) if (lon[-1] > lon[0]) == (goal[1] > start[1]) else slice(None, None, -1)
    lat = np.concatenate([[start[0]], lat[order], [goal[0]]])
    lon = np.concatenate([[start[1]], lon[order], [goal[1]]])
    wait = np.zeros(len(lat))
    wait[0] = 600.0
    return Track(lat, lon, "2026-01-01T00:00Z", wait, np.arange(len(lat) - 1) % 3)


@pytest.mark.parametrize("eastwards", [True, False])
def test_a_track_against_the_traffic_is_led_by_the_other_lane(chart, eastwards):
    start, goal = (WEST, EAST) if eastwards else (EAST, WEST)
    side = GIBRALTAR.zone + 0.5 * GIBRALTAR.lane
    tracks = [wrong_side(start, goal, metres) for metres in (side, -side)]
    wrong = max(tracks, key=lambda one: against_nm(chart, one))
    assert against_nm(chart, wrong) > 5.0
    found = in_lanes_of_traffic(wrong, chart)
    assert against_nm(chart, found) < 1.0
    assert (found.lat[0], found.lon[0]) == pytest.approx(start)
    assert (found.lat[-1], found.lon[-1]) == pytest.approx(goal)
    assert found.depart == wrong.depart and found.wait.sum() == 600.0
    assert len(found.setting) == len(found.lat) - 1
    assert found.lengths.sum() < 1.03 * wrong.lengths.sum()


def test_a_track_in_its_lane_and_waits_stay(chart):
    side = GIBRALTAR.zone + 0.5 * GIBRALTAR.lane
    tracks = [wrong_side(WEST, EAST, metres) for metres in (side, -side)]
    right, wrong = sorted(tracks, key=lambda one: against_nm(chart, one))
    assert in_lanes_of_traffic(right, chart) is right
    waits = wrong.replaced(wait=np.where(np.arange(len(wrong)) < len(wrong) - 1, 60.0, 0.0))
    assert in_lanes_of_traffic(waits, chart) is waits
    free = world_chart()
    assert not free.zones.lanes
    assert in_lanes_of_traffic(wrong, free) is wrong
