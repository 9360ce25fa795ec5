"""Roll in waves by the effective wave slope."""

import numpy as np
import pytest

from thalweg.ship import Ship
from thalweg.ship.comfort.motion_sheet import motion_sheet
from thalweg.ship.comfort.onboard_motions import ROLL_NOTE, onboard_motions
from thalweg.ship.methods.seakeeping.roll_motion import roll_amplitude, roll_rms
from thalweg.ship.methods.seakeeping.ship_motions import MotionHull

HULL = MotionHull(120.0, 20.0, 7.0, 0.7)
BEAM, PERIOD = 0.5 * np.pi, 12.0
DATA = {
    "name": "small", "speeds_kn": [6.0, 10.0], "places": {"mess": 0.0},
    "hull": {"length_between_perpendiculars_m": 33.9, "breadth_m": 9.6, "draught_m": 2.8,
             "block_coefficient": 0.62, "metacentric_height_m": 1.0},
    "engine": {"reference_speed_kn": 10.0},
    "tasks": {"crane": {"place": "mess", "max_roll_deg": 2.0}},
}  # fmt: skip


def amplitude(frequency, **changes):
    given = {"speed": 0.0, "wave_angle": BEAM, "hull": HULL, "natural_period": PERIOD}
    return roll_amplitude(np.atleast_1d(frequency), **{**given, **changes})


def test_long_waves_roll_the_ship_by_the_effective_wave_slope():
    k = 0.05**2 / 9.80665
    assert amplitude(0.05)[0] == pytest.approx(0.73 * k / (1 - (0.05 * PERIOD / 2 / np.pi) ** 2),
                                               rel=1e-3)  # fmt: skip


def test_resonance_is_limited_by_damping():
    own = 2.0 * np.pi / PERIOD
    k = own**2 / 9.80665
    slope = 0.73 * k * np.sinc(0.5 * k * 20.0 / np.pi)
    assert amplitude(own, damping=0.1)[0] == pytest.approx(slope / 0.2)
    assert amplitude(own, damping=0.05)[0] == pytest.approx(slope / 0.1)


def test_no_roll_in_head_and_following_seas_and_most_in_beam_seas():
    angles = np.radians([0.0, 45.0, 90.0, 180.0])
    found = roll_rms(height=3.0, period=11.0, wave_angle=angles, speed=0.0, hull=HULL,
                     natural_period=PERIOD)  # fmt: skip
    assert found[[0, 3]] == pytest.approx(0.0, abs=1e-12)
    assert found[2] > found[1] > 0.0
    double = roll_rms(height=6.0, period=11.0, wave_angle=angles, speed=0.0, hull=HULL,
                      natural_period=PERIOD)  # fmt: skip
    assert double == pytest.approx(2.0 * found, rel=0.1)  # the spectrum is more peaked


def test_flat_water_and_unknown_weather():
    found = roll_rms(height=[0.0, 2.0], period=[np.nan, np.nan], wave_angle=BEAM, speed=5.0,
                     hull=HULL, natural_period=PERIOD)  # fmt: skip
    assert found[0] == 0.0 and np.isnan(found[1])


def test_the_sheet_has_roll_and_the_speed_that_is_attained():
    sheet = motion_sheet(Ship.from_dict(DATA), {"wave_height": 2.0, "wave_period": 7.0})
    beam = sheet["headings_deg"].index(90)
    assert sheet["roll_rms_deg"][beam] > 2.0 > sheet["roll_rms_deg"][0]
    assert not sheet["tasks"]["crane"][beam] and sheet["tasks"]["crane"][0]
    assert ROLL_NOTE not in sheet["warnings"]
    gunnerus = Ship.load("gunnerus-2019")
    sheet = motion_sheet(gunnerus, {"wave_height": 3.0})
    assert sheet["ordered_speed_kn"] == pytest.approx(gunnerus.speeds[-1] * 3600 / 1852)
    assert sheet["attained_speed_kn"][0] < 0.9 * sheet["ordered_speed_kn"]
    head = onboard_motions(gunnerus).at(
        sheet["attained_speed_kn"][0] * 1852 / 3600, wave_angle=0.0, wave_height=3.0,
        wave_period=sheet["wave_period_s"],
    )  # fmt: skip
    assert sheet["pitch_rms_deg"][0] == pytest.approx(np.degrees(head.pitch))


def test_without_a_roll_period_roll_is_not_known():
    hull = {k: v for k, v in DATA["hull"].items() if k != "metacentric_height_m"}
    sheet = motion_sheet(Ship.from_dict({**DATA, "hull": hull}), {"wave_height": 2.0})
    assert sheet["roll_rms_deg"] == [None] * len(sheet["headings_deg"])
    assert sheet["tasks"]["crane"] == [None] * len(sheet["headings_deg"])
    assert ROLL_NOTE in sheet["warnings"]
