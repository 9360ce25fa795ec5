"""Removal of sharp turns that save almost nothing, in a sea whose cost depends on the heading."""

import math

import numpy as np
import pytest

from thalweg.core.geodesy import inverse
from thalweg.route.evaluators.polyline import Polyline
from thalweg.route.refinement.track_geometry import course_changes
from thalweg.route.refinement.turn_removal import without_needless_turns

SPEED = 5.0  # m/s


class HeadingCost:
    """A metre to the north costs 1; at ``angle`` degrees from it and more, ``share`` less."""

    def __init__(self, share, angle=40.0, fixed=()):
        self.share, self.angle, self.fixed = share, math.radians(angle), fixed

    def sail(self, batch):
        lat, lon = batch.lat[0], batch.lon[0]
        length, course, _ = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
        off = np.abs(np.angle(np.exp(1j * course))) >= self.angle
        arrive = np.concatenate([[0.0], np.cumsum(length / SPEED)])
        return arrive[None], np.array([np.sum(length * np.where(off, 1.0 - self.share, 1.0))])

    def fixed_points(self, lat, lon):
        fixed = np.isin(lat, self.fixed)
        fixed[[0, -1]] = True
        return fixed


class SquaredLengths(HeadingCost):
    """Many short legs cost less than few long ones."""

    def sail(self, batch):
        arrive, _ = super().sail(batch)
        return arrive, np.array([np.sum(np.diff(arrive[0]) ** 2)])


def zigzag(legs, angle=45.0, north=0.1):
    """Legs of equal length, in turn to the left and the right of north."""
    east = np.arange(legs + 1) % 2 * math.tan(math.radians(angle)) * north
    lat = north * np.arange(legs + 1.0)
    return Polyline(lat, east, np.full(legs + 1, -np.inf), np.zeros(legs, np.int64), 0.0)


def cost_of(line, evaluator):
    return float(evaluator.sail(line.batch())[1][0])


def test_tacks_that_save_little_are_left_out():
    line = zigzag(20)  # 41 % longer than the straight line
    evaluator = HeadingCost(1.0 - 0.97 / math.sqrt(2.0))  # the tacks save 3 % in all
    shorter = without_needless_turns(line, evaluator)
    assert len(shorter) == 2
    assert cost_of(shorter, evaluator) / cost_of(line, evaluator) == pytest.approx(1 / 0.97, 5e-3)


def test_tacks_that_save_much_stay():
    evaluator = HeadingCost(0.5)  # 30 % in all, 10 % for each of three turns of 90 degrees
    line = zigzag(4, north=0.3)  # 10 % of the cost is that of 60 minutes
    assert without_needless_turns(line, evaluator) is line
    assert len(without_needless_turns(zigzag(4, north=0.1), evaluator)) < 5  # of 20 minutes


def test_fixed_points_and_waits_stay():
    line = zigzag(20)
    leave = line.leave.copy()
    leave[13] = 1.0
    waits = Polyline(line.lat, line.lon, leave, line.setting, 0.0)
    shorter = without_needless_turns(waits, HeadingCost(0.0, fixed=line.lat[[7]]))
    kept = set(zip(shorter.lat, shorter.lon))
    assert {(line.lat[k], line.lon[k]) for k in (0, 7, 13, 20)} <= kept
    assert len(shorter) < 10


def test_gentle_turns_are_no_reason_to_cut_corners():
    """A bow of 20 legs, 9 degrees between them, has no sharp turn; chords of it cost more."""
    bearing = np.linspace(0.0, math.pi, 21)
    line = Polyline(
        -np.cos(bearing), np.sin(bearing), np.full(21, -np.inf), np.zeros(20, np.int64), 0.0
    )
    assert without_needless_turns(line, SquaredLengths(0.0)) is line


def test_points_that_only_cost_are_left_out():
    line = zigzag(2, angle=10.0)  # one turn of 20 degrees
    assert len(without_needless_turns(line, HeadingCost(0.0))) == 2


def test_alterations_of_course_are_to_starboard_and_none_on_a_meridian():
    lat = np.array([0.0, 1.0, 2.0, 2.0, 1.0])
    lon = np.array([10.0, 10.0, 10.0, 11.0, 11.0])
    turns = np.degrees(course_changes(lat, lon))
    assert turns == pytest.approx([0.0, 90.0, 90.0], abs=0.05)
    assert np.degrees(course_changes(lat[::-1], lon[::-1])) == pytest.approx(
        [-90.0, -90.0, 0.0], abs=0.05
    )
