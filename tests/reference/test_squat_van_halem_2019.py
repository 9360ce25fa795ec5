"""Squat: the corrected van Oord rule of van Halem (2019), Barrass, and their limits."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.units import KNOT
from thalweg.ship.methods.shallow_water import barrass_squat, squat

HOPPER = {"draught": 6.5, "breadth": 20.0}
BLOCK = 10_000e3 / 1025.0 / (80.0 * 20.0 * 6.5)  # 10 000 t, 80 x 20 x 6.5 m: 0.938

#: depth -> speed [m/s] with V_max 10 kn and 1 m clearance (corrected column).
CORRECTED = {
    7.5: 0.0,
    7.6: 1.8526,
    7.8: 3.1707,
    8.0: 3.6058,
    9.0: 3.8750,
    10.0: 4.0799,
    12.0: 4.3636,
    25.0: 4.9234,
}


def limit(depth, **changes):
    given = {"clearance": 1.0, "gravity": 9.81, "block_coefficient": BLOCK, **HOPPER, **changes}
    return squat.shallow_water_speed_limit(10.0 * KNOT, depth, **given)


@pytest.mark.parametrize(("depth", "speed"), CORRECTED.items())
def test_corrected_speeds_to_printed_digits(depth, speed):
    assert limit(depth) == pytest.approx(speed, abs=5.1e-5)


def test_block_coefficient_of_the_example_is_not_a_thousandth():
    assert pytest.approx(0.938, abs=5e-4) == BLOCK


def test_the_released_program_is_faster_where_squat_rules():
    """Its squat limit never acts: 3.4749 and 3.5422 m/s at 7.6 and 7.8 m are critical speeds."""
    critical = squat.shallow_water_speed(10.0 * KNOT, [7.6, 7.8], gravity=9.81, **HOPPER)
    assert critical == pytest.approx([3.4749, 3.5422], abs=5.1e-5)
    assert np.all(limit([7.6, 7.8]) < critical)


def test_array_equals_scalars():
    depths = np.array(list(CORRECTED))
    assert limit(depths).tolist() == [float(limit(d)) for d in depths]


def test_no_depth_no_speed_and_unknown_stays_unknown():
    assert limit(0.0) == 0.0
    assert limit(-3.0) == 0.0
    assert np.isnan(limit(np.nan))


def test_deep_water_gives_the_deep_speed():
    deep = squat.shallow_water_speed_limit(
        5.0, 5000.0, draught=6.5, breadth=20.0, block_coefficient=0.8, clearance=1.0
    )
    assert 0.999 * 5.0 < deep <= 5.0


def test_infinite_depth_is_deep_water():
    kwargs = {"block_coefficient": 0.8, **HOPPER}
    assert squat.shallow_water_speed_limit(5.0, np.inf, **kwargs) == pytest.approx(5.0, rel=1e-3)
    assert barrass_squat.barrass_squat(5.0, np.inf, **kwargs) == 0.0
    assert barrass_squat.barrass_2004_squat(5.0, np.inf, **kwargs) == 0.0


def test_zero_speed_stays_zero():
    assert squat.shallow_water_speed(0.0, 10.0, **HOPPER) == 0.0
    assert barrass_squat.barrass_squat(0.0, 10.0, block_coefficient=0.8, **HOPPER) == 0.0


def test_a_ship_at_rest_that_fills_the_waterway_has_no_squat():
    at = {"block_coefficient": 0.8, "channel_width": 20.0, **HOPPER}
    sunk = barrass_squat.barrass_squat([0.0, 1.0, 0.0], [6.0, 6.0, np.nan], **at)
    assert sunk.tolist() == pytest.approx([0.0, np.inf, np.nan], nan_ok=True)


def test_speed_never_falls_with_depth():
    depths = np.linspace(7.0, 60.0, 400)
    assert np.all(np.diff(limit(depths)) >= 0.0)


def test_barrass_equals_a_hand_calculation():
    """B 20, T 6.5, h 10, width 180: S2 = 130/1670; C_B .8, 10 kn."""
    expected = 0.8 * (130.0 / 1670.0) ** (2.0 / 3.0) * 10.0**2.08 / 30.0
    got = barrass_squat.barrass_squat(10.0 * KNOT, 10.0, block_coefficient=0.8, **HOPPER)
    assert got == pytest.approx(expected, rel=1e-12)
    assert got == pytest.approx(0.585, abs=5e-4)


def test_inverse_of_barrass():
    speeds = np.array([1.0, 3.0, 5.0])
    sunk = barrass_squat.barrass_squat(speeds, 9.0, block_coefficient=0.8, **HOPPER)
    back = barrass_squat.barrass_speed(sunk, 9.0, block_coefficient=0.8, **HOPPER)
    assert back == pytest.approx(speeds, rel=1e-12)


def test_a_channel_sinks_the_ship_deeper():
    open_water = barrass_squat.barrass_squat(4.0, 10.0, block_coefficient=0.8, **HOPPER)
    canal = barrass_squat.barrass_squat(
        4.0, 10.0, block_coefficient=0.8, channel_width=80.0, **HOPPER
    )
    assert canal / open_water == pytest.approx((1670.0 / 670.0) ** (2.0 / 3.0))


def test_a_narrower_channel_never_lets_the_ship_go_faster():
    widths = np.linspace(20.5, 400.0, 500)
    speeds = squat.shallow_water_speed(5.0, 9.0, draught=6.5, breadth=20.0, channel_width=widths)
    assert np.all(np.diff(speeds) >= -1e-12)
    open_water = 5.0 * np.sqrt(np.tanh(9.80665 * 9.0 / 25.0))
    assert speeds[0] == pytest.approx(0.390 * open_water, rel=1e-3)  # the cubic at its least
    assert speeds[-1] > 0.8 * open_water


def test_a_filled_channel_is_blocked():
    assert barrass_squat.blockage_ratio(6.0, 6.5, breadth=20.0, channel_width=20.0) == np.inf
    assert limit(6.4, channel_width=20.0) == 0.0


def test_later_barrass_form_equals_a_hand_calculation():
    """K = B T / (b h) with b = 7.04 B / C_B^0.85, or the width of the channel."""
    at = {"draught": 10.0, "breadth": 30.0, "block_coefficient": 0.8}
    knots = 5.0 / KNOT
    open_water = 0.8 * (10.0 / (7.04 / 0.8**0.85 * 12.0)) ** 0.81 * knots**2.08 / 20.0
    assert barrass_squat.barrass_2004_squat(5.0, 12.0, **at) == pytest.approx(open_water, rel=1e-12)
    canal = 0.8 * (300.0 / (150.0 * 12.0)) ** 0.81 * knots**2.08 / 20.0
    got = barrass_squat.barrass_2004_squat(5.0, 12.0, channel_width=150.0, **at)
    assert got == pytest.approx(canal, rel=1e-12)
    speeds = barrass_squat.barrass_2004_speed(canal, 12.0, channel_width=150.0, **at)
    assert speeds == pytest.approx(5.0, rel=1e-12)


def test_later_barrass_form_agrees_within_its_scatter():
    """The 1979 and 2004 forms describe the same thing: within a factor of 1.5 in open water."""
    kwargs = {"draught": 10.0, "breadth": 30.0, "block_coefficient": 0.8}
    old = barrass_squat.barrass_squat(5.0, 12.0, **kwargs)
    new = barrass_squat.barrass_2004_squat(5.0, 12.0, **kwargs)
    assert 1.0 / 1.5 < new / old < 1.5


def test_clearance_under_way():
    assert squat.dynamic_under_keel_clearance(10.0, 6.5, squat=0.5) == pytest.approx(3.0)


def test_validity():
    inside = barrass_squat.squat_validity([8.0, 100.0], draught=6.5, block_coefficient=0.8)
    assert inside == []
    assert barrass_squat.squat_validity(1.101, draught=1.0, block_coefficient=[0.501, 0.899]) == []
    assert (
        len(barrass_squat.squat_validity(1.099, draught=1.0, block_coefficient=[0.499, 0.901])) == 3
    )
    notes = barrass_squat.squat_validity(6.6, draught=6.5, block_coefficient=0.95)
    assert [note.quantity for note in notes] == ["block coefficient", "depth over draught"]
