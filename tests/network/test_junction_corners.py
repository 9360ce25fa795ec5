"""Usual routes past junctions: without the corners where lines of two voyages are joined."""

import numpy as np
import pytest

from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE as NM
from thalweg.network.history.junction_corners import _straightened

#: Two voyages 6 nm to either side of a junction at 2 E, on the equator.
LINE = [(0.1, 0.0), (0.1, 1.0), (0.1, 1.9), (0.0, 2.0), (-0.1, 2.1), (-0.1, 3.0), (-0.1, 4.0)]


def length(line):
    lat, lon = np.array(line).T
    return float(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]).sum())


def no_land(lat1, lon1, lat2, lon2):
    return np.zeros(len(lat1), bool)


def test_the_line_is_straight_past_a_junction():
    found = _straightened(LINE, [3], 10.0 * NM, no_land)
    assert found[0] == LINE[0] and found[-1] == LINE[-1]
    assert (0.0, 2.0) not in found
    assert length(found) == pytest.approx(length([LINE[0], LINE[1], LINE[5], LINE[6]]), rel=1e-9)
    assert length(found) < length(LINE) - 3.0 * NM


def test_where_land_is_in_the_way_the_line_stays():
    def land(lat1, lon1, lat2, lon2):
        return np.ones(len(lat1), bool)

    assert _straightened(LINE, [3], 10.0 * NM, land) == LINE


def test_junctions_beside_each_other_and_at_the_ends_are_passed_once():
    found = _straightened(LINE, [2, 3, 4], 10.0 * NM, no_land)
    assert found[0] == LINE[0] and found[-1] == LINE[-1] and len(found) < len(LINE)
    assert _straightened(LINE, [1, 5], 500.0 * NM, no_land) == [LINE[0], LINE[-1]]
    assert _straightened(LINE, [], 10.0 * NM, no_land) == LINE
