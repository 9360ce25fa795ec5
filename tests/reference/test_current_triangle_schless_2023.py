"""The current triangle, exact cases, and the rudder drag of Schless (2023)."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.ship.methods import current_triangle as cur


def triangle(speed, course_deg, east, north):
    return cur.current_triangle(
        speed, np.radians(course_deg), current_east=east, current_north=north
    )


@pytest.mark.parametrize(
    ("speed", "course", "east", "north", "ground"),
    [(12.0, 45.0, 1.0, 0.5, 13.05545), (12.0, 90.0, 0.0, 2.0, 11.83216)],
)
def test_seuren_2020_checks(speed, course, east, north, ground):
    got = triangle(speed, course, east, north)
    assert got.speed_over_ground == pytest.approx(ground, abs=5.1e-6)


def test_schless_cross_current():
    """1 m/s straight across at 5.7797 m/s: 5.693, not 5.695 m/s (eq. 3.57)."""
    got = triangle(5.7797, 0.0, 1.0, 0.0)
    assert got.speed_over_ground == pytest.approx(5.693, abs=6e-4)
    assert np.degrees(got.crab_angle) == pytest.approx(-9.96, abs=5e-3)


def test_with_and_against():
    got = triangle(5.0, [0.0, 180.0], 0.0, 1.5)
    assert got.speed_over_ground == pytest.approx([6.5, 3.5])
    assert got.crab_angle == pytest.approx([0.0, 0.0], abs=1e-12)


def test_the_three_vectors_close():
    rng = np.random.default_rng(7)
    speed, course = rng.uniform(3.0, 12.0, 200), rng.uniform(0.0, 360.0, 200)
    east, north = rng.uniform(-2.0, 2.0, (2, 200))
    got = triangle(speed, course, east, north)
    assert got.possible.all()
    way_east = speed * np.sin(got.heading) + east
    way_north = speed * np.cos(got.heading) + north
    bearing = np.radians(course)
    assert way_east == pytest.approx(got.speed_over_ground * np.sin(bearing), abs=1e-12)
    assert way_north == pytest.approx(got.speed_over_ground * np.cos(bearing), abs=1e-12)


def test_too_strong_a_current():
    got = triangle([2.0, 2.0, np.nan], 0.0, [2.5, 0.0, 0.0], [0.0, -2.5, 0.0])
    assert not got.possible.any()
    assert np.isnan(got.speed_over_ground).all()


@pytest.mark.parametrize("curve", ["nodes", "quadratic"])
def test_drag_curve_is_odd_free_and_rising(curve):
    angles = np.radians(np.linspace(0.0, 35.0, 400))
    drag = cur.rudder_drag_coefficient(angles, curve=curve)
    assert drag[0] == 0.0
    assert np.all(np.diff(drag) > 0.0)
    assert cur.rudder_drag_coefficient(-angles, curve=curve) == pytest.approx(drag)
    assert np.isnan(cur.rudder_drag_coefficient(np.radians(36.0), curve=curve))


def test_nodes_are_met():
    angles = np.radians(cur.LUEBKE_ANGLES_DEG)
    assert cur.rudder_drag_coefficient(angles) == pytest.approx(cur.LUEBKE_DRAG, abs=1e-12)


def test_quadratic_printed_values():
    angles = np.radians([5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0])
    got = cur.rudder_drag_coefficient(angles, curve="quadratic")
    assert got == pytest.approx([0.036, 0.087, 0.153, 0.235, 0.332, 0.445, 0.572], abs=6e-4)


def test_coefficients_behind_table_4_5():
    """Table 4.5 implies .0306 to .0869 at 4.3 to 10.0 degrees."""
    got = cur.rudder_drag_coefficient(np.radians([4.3, 10.0]), curve="quadratic")
    assert got == pytest.approx([0.0306, 0.0869], rel=0.012)


def test_monotone_curve_stays_near_the_quadratic():
    angles = np.radians(np.linspace(1.0, 35.0, 200))
    nodes = cur.rudder_drag_coefficient(angles)
    quadratic = cur.rudder_drag_coefficient(angles, curve="quadratic")
    assert np.max(np.abs(nodes - quadratic)) < 0.012


def test_drag_force_equals_a_hand_calculation():
    force = cur.rudder_drag(6.0, np.radians(-10.0), rudder_area=20.0, density=1025.0)
    assert force == pytest.approx(0.5 * 1025.0 * 0.09 * 20.0 * 36.0)


def test_unknown_curve():
    with pytest.raises(InputError, match="nodes"):
        cur.rudder_drag_coefficient(0.1, curve="node")
