"""How far the routes of a front are from the line that no route is below."""

from types import SimpleNamespace

import numpy as np
import pytest

from thalweg.planning.plan_front import ParetoFront


def front_of(values, certain):
    stages = ("exact",) * len(values)
    return ParetoFront("fuel", "t", np.array(values), stages, stages, certain=np.array(certain))


def routes_of(*hours):
    return tuple(SimpleNamespace(time_h=time) for time in hours)


def test_a_joint_gap_meets_the_line_below_the_front():
    """On value = 20 - time the point (10, 12) scaled by 1 - e has 22 (1 - e) = 20."""
    front = front_of([12.0, 10.0], [[5.0, 15.0], [15.0, 5.0]])
    routes = routes_of(10.0, 10.0)
    assert front.gaps(routes) == pytest.approx([2.0 / 12.0, 0.0])
    assert front.joint_gaps(routes) == pytest.approx([1.0 - 20.0 / 22.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("least", [float("nan"), 9.0, 9.7])
def test_no_route_is_faster_than_the_least_time(least):
    front = front_of([100.0], [[9.5, 12.0], [20.0, 10.0]])
    shares = front.joint_gaps(routes_of(10.0), least_time_h=least)
    assert shares == pytest.approx([0.03 if least == 9.7 else 0.05], abs=1e-6)


def test_without_a_line_there_is_no_joint_gap():
    assert front_of([1.0], np.empty((2, 0))).joint_gaps(routes_of(1.0)) == [None]
