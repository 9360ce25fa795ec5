"""The embedded storm: limits of its formulas, and a vortex at the position of its track."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.geodesy import direct
from thalweg.core.time import parse_time
from thalweg.core.units import KNOT
from thalweg.kernels import codes
from thalweg.sea import Sea
from thalweg.sea.models import cyclone_formulas as models
from thalweg.sea.models.cyclone_layer import AmbientSea
from thalweg.sea.models.cyclone_track import load_best_track
from thalweg.sea.models.cyclone_vortex import vortex_state

HS = "sea_surface_wave_significant_height"
STILL = AmbientSea(wind=(0.0, 0.0), wave_height=0.0)


def holland(radius, *, f=0.0, b=1.5, deficit=6000.0, rm=40e3):
    return models.holland_gradient_wind(
        radius, radius_of_maximum=rm, pressure_deficit=deficit, b=b, coriolis=f
    )


def test_holland_maximum_is_at_its_radius_and_has_its_closed_form() -> None:
    radius = np.arange(5e3, 300e3, 100.0)
    wind = holland(radius)
    assert radius[np.argmax(wind)] == pytest.approx(40e3, abs=150.0)
    assert wind.max() == pytest.approx(np.sqrt(1.5 * 6000.0 / (1.15 * np.e)), rel=1e-6)


def test_holland_wind_is_zero_at_the_centre_and_far_away_and_weaker_with_rotation() -> None:
    assert holland(0.0) == pytest.approx(0.0, abs=1e-9)
    assert holland(5e6, f=1e-4) < 0.1
    assert holland(40e3, f=1e-4) < holland(40e3)
    assert holland(40e3, f=-1e-4) == holland(40e3, f=1e-4)


def test_holland_b_inverts_the_maximum_wind_and_stays_in_its_range() -> None:
    wind = holland(40e3, b=1.7)
    assert models.holland_b(wind, 6000.0) == pytest.approx(1.7)
    assert models.holland_b(10.0, 6000.0) == 1.0
    assert models.holland_b(90.0, 3000.0) == 2.5


def test_willoughby_radius_of_a_40_m_s_storm_at_30_degrees() -> None:
    # 46.4 exp(-0.62 + 0.507) = 41.44 km
    assert models.radius_of_maximum_wind_willoughby2006(40.0, 30.0) == pytest.approx(
        41.44e3, rel=1e-3
    )


def test_inflow_angles_of_bretschneider() -> None:
    got = np.degrees(models.inflow_angle([0.0, 1.0, 1.1, 1.2, 9.0], 1.0))
    assert got == pytest.approx([10.0, 20.0, 22.5, 25.0, 25.0])


def test_translation_wind_is_rotated_left_in_the_north_and_right_in_the_south() -> None:
    east, north = models.translation_wind(10.0, 0.0, 40.0)
    assert np.hypot(east, north) == pytest.approx(5.5)
    assert np.degrees(np.arctan2(north, east)) == pytest.approx(20.0)
    assert models.translation_wind(10.0, 0.0, -40.0)[1] == pytest.approx(-north)


def test_equivalent_fetch_of_a_worked_example() -> None:
    # V = 40, s = 5, R = 50 km: shape = -3.48 + 3.012 - 3.0575 + 3.504 + 7.58 + 1.756 = 9.3145
    spatial = 22.5e3 * np.log10(50e3) - 70.8e3
    assert models.equivalent_fetch_young2013(40.0, 5.0, 50e3) == pytest.approx(
        9.3145 * spatial, rel=1e-4
    )


def test_waves_grow_linearly_with_wind_at_a_fetch_and_period_follows_energy() -> None:
    assert models.wave_height_jonswap(20.0, 98066.5) == pytest.approx(0.0016 * 20.0 * 100.0)
    fp = 0.09
    height = 4.0 * np.sqrt(6.365e-6 * (fp * 30.0 / 9.80665) ** -3.3 * 30.0**4) / 9.80665
    assert models.peak_period_young2006(height, 30.0) == pytest.approx(1.0 / fp)


def test_the_track_is_the_best_track() -> None:
    track = load_best_track("danielle-1998")
    row = np.flatnonzero(track.time == parse_time("1998-09-03T06:00Z"))[0]
    assert (track.lat[row], track.lon[row], track.pressure[row]) == (42.1, -57.5, 96000.0)
    assert track.wind[row] == pytest.approx(70.0 * KNOT * 0.93)
    assert np.diff(track.time) == pytest.approx(6 * 3600.0)


def test_wind_turns_counter_clockwise_around_the_centre_and_inwards() -> None:
    sea = Sea.storm(ambient=STILL)
    time = parse_time("1998-09-03T06:00Z")
    lat, lon = direct(42.1, -57.5, np.radians([0.0, 90.0, 180.0, 270.0]), 120e3)
    got = sea.sample(["eastward_wind", "northward_wind", "wind_speed", HS], time, lat, lon)
    assert got["eastward_wind"][0] < -10.0  # north of the centre: from the east
    assert got["northward_wind"][1] > 20.0  # east (right of the motion): from the south
    assert got["eastward_wind"][2] > 10.0
    assert got["northward_wind"][3] < 0.0
    assert got["northward_wind"][0] < 0.0 < got["northward_wind"][2]  # blowing inwards
    right, left = got["wind_speed"][1], got["wind_speed"][3]
    assert right > left + 5.0
    assert got[HS][1] > got[HS][3]


def test_strongest_modelled_wind_is_that_of_the_track() -> None:
    time = parse_time("1998-09-03T06:00Z")
    lat, lon = np.meshgrid(np.linspace(39, 45, 200), np.linspace(-62, -53, 200))
    got = Sea.storm(ambient=STILL).sample(["wind_speed", HS], time, lat, lon)
    assert got["wind_speed"].max() == pytest.approx(70.0 * KNOT * 0.93, rel=0.03)
    assert 8.0 < got[HS].max() < 13.0


def test_the_fitted_deficit_preserves_the_symmetric_maximum() -> None:
    track = load_best_track("danielle-1998")
    state = vortex_state(track, track.time[20:])
    wind = models.holland_gradient_wind(
        state.radius,
        radius_of_maximum=state.radius,
        pressure_deficit=state.deficit,
        b=state.b,
        coriolis=state.coriolis,
    )
    assert wind == pytest.approx(state.maximum, rel=1e-9)
    assert (state.radius <= 150e3).all()


def test_ambient_sea_far_away_and_unknown_outside_the_period_of_the_track() -> None:
    sea = Sea.storm()
    time = parse_time("1998-09-03T06:00Z")
    got = sea.sample(["eastward_wind", HS, "sea_surface_wave_from_direction"], time, -40.0, 100.0)
    assert got["eastward_wind"] == 5.0
    assert got[HS] == 1.5
    assert got["sea_surface_wave_from_direction"] == pytest.approx(255.0)
    early = parse_time("1998-08-01T00:00Z")
    assert np.isnan(sea.sample([HS], early, 0.0, 0.0)[HS])
    assert sea.why_missing(HS, early, 0.0, 0.0) == "period"


def test_series_equal_samples_and_the_taper_is_continuous() -> None:
    sea = Sea.storm()
    start = parse_time("1998-09-04T00:00Z")
    fields = sea.freeze_stations(
        [45.0, 40.0],
        [-45.0, -50.0],
        start,
        start + 7200.0,
        [codes.WIND_EAST, codes.WAVE_HEIGHT_CHANNEL],
    )
    assert fields.times.tolist() == [start, start + 3600.0, start + 7200.0]
    got = sea.sample(
        ["eastward_wind", HS], fields.times[None], [[45.0], [40.0]], [[-45.0], [-50.0]]
    )
    assert fields.values[:, :, 0] == pytest.approx(got["eastward_wind"], rel=1e-6)
    assert fields.values[:, :, 1] == pytest.approx(got[HS], rel=1e-6)
    lat, lon = direct(45.0, -44.0, 0.3, np.arange(1e3, 1400e3, 2e3))
    height = sea.sample([HS], start + 6 * 3600, lat, lon)[HS]
    assert np.abs(np.diff(height)).max() < 0.25


def test_dates_can_be_shifted() -> None:
    sea = Sea.storm(start="2026-01-01T00:00Z")
    assert sea.coverage()[0].start == parse_time("2026-01-01T00:00Z")
    moved = sea.sample([HS], parse_time("2026-01-11T00:00Z"), 42.0, -57.0)[HS]
    true = Sea.storm().sample([HS], parse_time("1998-09-03T06:00Z"), 42.0, -57.0)[HS]
    assert moved == pytest.approx(true)
    assert sea.fingerprint() != Sea.storm().fingerprint()


@pytest.mark.parametrize("step", [0.0, -60.0, float("nan")])
def test_a_storm_needs_a_step(step) -> None:
    with pytest.raises(InputError, match="time step"):
        Sea.storm(time_step=step)


def test_an_unknown_storm_lists_the_known_ones() -> None:
    with pytest.raises(InputError, match="danielle-1998"):
        Sea.storm("daniele")
