"""Properties of the motions of any ship in any sea."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.ship.methods.seakeeping import (
    ship_motions,
    stability_msc1_circ1228,
    wave_spectra,
)

HULL = ship_motions.MotionHull(length=140.0, breadth=22.0, draught=8.0, block_coefficient=0.7)

heights = st.floats(0.1, 12.0)
periods = st.floats(3.0, 18.0)
angles = st.floats(0.0, float(np.pi))
speeds = st.floats(0.0, 12.0)


def respond(**changes):
    given_ = {"height": 3.0, "period": 9.0, "wave_angle": 0.5, "speed": 7.0, "hull": HULL,
              "forward": 50.0, "peak_factor": 1.0}  # fmt: skip
    return ship_motions.ship_response(**{**given_, **changes})


@given(period=periods, angle=angles, speed=speeds)
def test_zero_waves_zero_response(period, angle, speed):
    got = respond(height=0.0, period=period, wave_angle=angle, speed=speed)
    for part in (got.heave, got.pitch, got.motion, got.acceleration):
        assert part.m0 == 0.0
        assert part.most_probable_maximum() == 0.0


def test_zero_waves_need_no_period():
    assert respond(height=0.0, period=np.nan).heave.m0 == 0.0
    assert respond(height=0.0, period=0.0).acceleration.m0 == 0.0
    assert respond(height=0.0, period=np.nan, wave_angle=np.nan).pitch.m0 == 0.0
    assert np.isnan(respond(height=0.0, speed=np.nan).heave.m0)


@given(height=heights, period=periods, angle=angles, speed=speeds, factor=st.floats(0.1, 10.0))
def test_linear_in_height(height, period, angle, speed, factor):
    one = respond(height=height, period=period, wave_angle=angle, speed=speed)
    more = respond(height=factor * height, period=period, wave_angle=angle, speed=speed)
    for a, b in zip((one.heave, one.pitch, one.acceleration),
                    (more.heave, more.pitch, more.acceleration), strict=True):  # fmt: skip
        assert b.significant_amplitude == pytest.approx(factor * a.significant_amplitude)


@given(height=heights, period=periods, angle=angles, speed=speeds)
def test_port_equals_starboard(height, period, angle, speed):
    port = respond(height=height, period=period, wave_angle=-angle, speed=speed)
    starboard = respond(height=height, period=period, wave_angle=angle, speed=speed)
    assert port.heave.m0 == starboard.heave.m0
    assert port.acceleration.m0 == starboard.acceleration.m0


@given(angle=angles, speed=speeds)
def test_long_waves_lift_the_ship_as_they_lift_the_water(angle, speed):
    w = np.array([0.03])
    heave, pitch = ship_motions.jensen_motions(w, speed=speed, wave_angle=angle, hull=HULL)
    strip = ship_motions.jensen_motions(w, speed=speed, wave_angle=angle, hull=HULL, decay="strip")
    assert strip[0] == pytest.approx(heave, abs=0.001)
    slope = w**2 / 9.80665 * np.abs(np.cos(angle))
    assert heave == pytest.approx([1.0], abs=0.01)
    assert pitch == pytest.approx(slope, rel=0.01, abs=1e-12)


@given(angle=angles, speed=speeds)
def test_short_waves_do_not_move_the_ship(angle, speed):
    heave, pitch = ship_motions.jensen_motions(
        [6.0], speed=speed, wave_angle=angle, hull=HULL, decay="strip"
    )
    assert heave[0] < 1e-6
    assert pitch[0] < 1e-6


def test_published_decay_does_not_fade_in_beam_seas():
    """The flaw the notes speak of: heave goes to one half, not to zero."""
    heave, _ = ship_motions.jensen_motions([20.0], speed=0.0, wave_angle=np.pi / 2, hull=HULL)
    assert heave[0] == pytest.approx(0.5, abs=0.01)


@given(w=st.floats(0.1, 2.0), speed=speeds)
def test_both_decays_are_one_in_head_seas(w, speed):
    pairs = [
        ship_motions.jensen_motions([w], speed=speed, wave_angle=0.0, hull=HULL, decay=decay)
        for decay in ship_motions.PRESSURE_DECAYS
    ]
    assert pairs[0][0] == pytest.approx(pairs[1][0])
    assert pairs[0][1] == pytest.approx(pairs[1][1])


def test_acceleration_does_not_hang_on_the_cut_off():
    """Beam sea: 48 points to 8 peak frequencies against a trapezoid to 16."""
    got = respond(wave_angle=np.pi / 2, period=7.0, forward=0.0)
    w = np.linspace(0.2, 16.0 * 2.0 * np.pi / 7.0, 40_001)
    waves = wave_spectra.bretschneider(w, height=3.0, period=7.0)
    heave, _ = ship_motions.jensen_motions(
        w, speed=7.0, wave_angle=np.pi / 2, hull=HULL, decay="strip"
    )
    assert got.acceleration.m0 == pytest.approx(np.trapezoid(w**4 * heave**2 * waves, w), rel=0.01)


@given(w=st.floats(0.05, 4.0), angle=angles, speed=speeds)
def test_finite_everywhere(w, angle, speed):
    heave, pitch = ship_motions.jensen_motions([w], speed=speed, wave_angle=angle, hull=HULL)
    assert np.isfinite(heave).all()
    assert np.isfinite(pitch).all()


def test_the_pole_of_following_seas_is_removed():
    """The response is continuous where the ship has the speed of the waves."""
    w = 9.80665 / 12.0 * (1.0 + np.array([-1e-7, 0.0, 1e-7]))
    heave, pitch = ship_motions.jensen_motions(w, speed=12.0, wave_angle=np.pi, hull=HULL)
    assert np.ptp(heave) < 1e-5
    assert np.ptp(pitch) < 1e-5


def test_beam_seas_do_not_pitch():
    _, pitch = ship_motions.jensen_motions([0.5], speed=5.0, wave_angle=np.pi / 2, hull=HULL)
    assert pitch[0] == pytest.approx(0.0, abs=1e-15)


def test_head_seas_shake_most_at_speed():
    """At the bow, at speed, acceleration falls from head to following seas."""
    angles_ = np.linspace(0.0, np.pi, 19)
    got = respond(wave_angle=angles_, speed=8.0, period=10.0)
    along = got.acceleration.m0[[0, 3, 15, 18]]
    assert along[0] > along[2]
    assert along[1] > along[3]
    assert got.acceleration.m0.argmax() < 10


@pytest.mark.parametrize("name", ["height", "period", "wave_angle", "speed"])
def test_nan_in_nan_out(name):
    got = respond(**{name: np.array([np.nan, 1.0])})
    for part in (got.heave, got.pitch, got.motion, got.acceleration):
        assert np.isnan(part.m0[0])
        assert np.isfinite(part.m0[1])


def test_negative_height_is_unknown():
    assert np.isnan(respond(height=-1.0).heave.m0)


@given(conditions=st.lists(st.tuples(heights, periods, angles, speeds), min_size=1, max_size=5))
def test_scalar_equals_array_element(conditions):
    h, t, a, v = np.array(conditions).T
    together = respond(height=h, period=t, wave_angle=a, speed=v)
    for i, (hi, ti, ai, vi) in enumerate(conditions):
        alone = respond(height=hi, period=ti, wave_angle=ai, speed=vi)
        assert together.heave.m0[i] == pytest.approx(float(alone.heave.m0), rel=1e-13)
        assert together.acceleration.m2[i] == pytest.approx(float(alone.acceleration.m2), rel=1e-13)


@given(height=heights, period=periods)
def test_spectrum_is_never_negative_and_preserves_the_height(height, period):
    w, weights = wave_spectra.quadrature(period)
    density = wave_spectra.jonswap(w, height=height, period=period)
    assert np.all(density >= 0.0)
    m0 = wave_spectra.spectral_moment(density, weights, frequency=w, order=0)
    assert 4.0 * np.sqrt(m0) == pytest.approx(height, rel=3e-3)


def test_broadcasting_of_grids():
    got = respond(height=np.full((3, 1), 2.0), speed=np.linspace(0.0, 8.0, 4))
    assert got.heave.m0.shape == (3, 4)
    assert got.acceleration_parts.shape == (3, 4, 48)


@given(angle=angles, speed=st.floats(0.0, 20.0), height=heights, period=periods)
def test_stability_flags_agree_with_margins_and_sides(angle, speed, height, period):
    def check(side):
        return stability_msc1_circ1228.dangerous_situations(
            speed=speed, wave_angle=side, wave_height=height, wave_period=period,
            length=120.0, roll_period=14.0,
        )  # fmt: skip

    port, starboard = check(-angle), check(angle)
    assert port.dangerous == starboard.dangerous
    assert starboard.surf_riding == (starboard.margins.surf_riding < 0.0)
    assert starboard.synchronous_roll == (starboard.margins.synchronous_roll < 0.0)
    assert not (starboard.synchronous_roll and not starboard.parametric_roll)
