"""Safety and comfort as limits: ship files, the model, the kernels, and a leg that is refused."""

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.errors import InputError
from thalweg.kernels import codes
from thalweg.kernels.leg.point_speed import point_speed
from thalweg.kernels.leg.table_lookup import axes_needed
from thalweg.planning.report.route_summary import route_items
from thalweg.route import evaluate
from thalweg.sea import Sea
from thalweg.ship import Conditions, Ship
from thalweg.ship.methods.seakeeping.motion_sickness import (
    motion_sickness_dose,
    motion_sickness_percent_iso,
    weighted_acceleration,
)
from thalweg.ship.methods.seakeeping.ship_motions import MotionHull, ship_response
from thalweg.ship.methods.seakeeping.stability_msc1_circ1228 import dangerous_situations

HULL = {
    "length_between_perpendiculars_m": 150.0,
    "breadth_m": 25.0,
    "draught_m": 8.0,
    "block_coefficient": 0.7,
    "roll_period_s": 14.0,
}
MOTIONS = MotionHull(150.0, 25.0, 8.0, 0.7)
LIMITS = np.array([-np.inf, np.inf, np.inf])


def _ship(limits, **more):
    data = {"name": "careful", "hull": HULL, "speeds_kn": [12, 18, 24], "limits": limits}
    return Ship.from_dict({**data, **more})


CIRCULAR = _ship({"msc_circ_1228": ["all"]})
BOW = _ship({"max_vertical_acceleration_m_s2": 1.5})
SICK = _ship({"max_motion_sickness_percent": 20, "motion_sickness_at_m": 30.0})
SHIPS = (CIRCULAR, BOW, SICK)


@cache
def _arrays(number):
    """Return the arrays of a ship by its place in `SHIPS`; tables of motions take seconds."""
    return SHIPS[number].tabulate().kernel_arrays()


def _status(ship, setting, angle, height, period):
    """Ask the kernel: course north, waves from ``angle`` to starboard of the bow."""
    arrays = _arrays(SHIPS.index(ship))
    sample, index = np.zeros(codes.CHANNEL_COUNT), np.full(codes.CHANNEL_COUNT, -1)
    for channel, value in (
        (codes.WAVE_HEIGHT_CHANNEL, height),
        (codes.WAVE_EAST, -math.sin(angle)),
        (codes.WAVE_NORTH, -math.cos(angle)),
        (codes.WAVE_PERIOD, period),
    ):
        sample[channel], index[channel] = value, channel
    return point_speed(sample, index, 0.0, 1.0, arrays, setting, np.inf, LIMITS)


def _forbids(ship, setting, angle, height, period):
    return bool(
        ship.limits.safety.forbids(
            ship.speeds[setting], wave_angle=angle, wave_height=height, wave_period=period
        )
    )


@given(st.integers(0, 2), st.floats(0, np.pi), st.floats(0.0, 9.0), st.floats(3.0, 20.0))
def test_kernels_and_model_forbid_the_same_of_the_circular(setting, angle, height, period):
    forbidden = _forbids(CIRCULAR, setting, angle, height, period)
    nudged = {
        _forbids(CIRCULAR, setting, angle + a, height * b, period * b)
        for a in (-1e-6, 1e-6)
        for b in (1 - 1e-6, 1 + 1e-6)
    }
    if len(nudged) > 1:
        return  # on the edge itself
    _, status = _status(CIRCULAR, setting, angle, height, period)
    assert status == (codes.SAFETY if forbidden else codes.OK)


@given(
    st.sampled_from(["bow", "sick"]),
    st.integers(0, 2),
    st.floats(0, np.pi),
    st.floats(0.0, 12.0),
    st.floats(3.0, 20.0),
)
@pytest.mark.slow
def test_kernels_and_model_forbid_the_same_motions_away_from_the_edge(
    which, setting, angle, height, period
):
    ship = BOW if which == "bow" else SICK
    lower, higher = (
        _forbids(ship, setting, angle, height * factor, period) for factor in (0.95, 1.05)
    )
    if lower != higher:
        return  # within five per cent of the limit
    _, status = _status(ship, setting, angle, height, period)
    assert status == (codes.SAFETY if lower else codes.OK)


@given(st.floats(1, 14), st.floats(0, np.pi), st.floats(0, 12), st.floats(3, 20))
def test_the_circular_is_that_of_the_method(speed, angle, height, period):
    checks = dangerous_situations(
        speed=speed,
        wave_angle=angle,
        wave_height=height,
        wave_period=0.834 * period,
        length=150.0,
        roll_period=14.0,
        harmless_wave_height=1.5,
    )
    found = CIRCULAR.limits.safety.forbids(
        speed, wave_angle=angle, wave_height=height, wave_period=period
    )
    assert bool(found) == bool(checks.dangerous)


def test_the_limit_of_acceleration_is_that_of_the_bow():
    state = ship_response(
        height=4.0, period=9.0, wave_angle=0.0, speed=8.0, hull=MOTIONS, forward=75.0
    )
    rms = float(np.sqrt(state.acceleration.m0))
    for factor, expected in ((0.98, True), (1.02, False)):
        ship = _ship({"max_vertical_acceleration_m_s2": rms * factor})
        found = ship.limits.safety.forbids(8.0, wave_angle=0.0, wave_height=4.0, wave_period=9.0)
        assert bool(found) is expected
    abaft = _ship({"max_vertical_acceleration_m_s2": rms * 0.98, "acceleration_at_m": -20})
    assert not abaft.limits.safety.forbids(8.0, wave_angle=0.0, wave_height=4.0, wave_period=9.0)


def test_the_limit_of_sickness_is_the_share_of_people_after_the_exposure():
    state = ship_response(height=3.0, period=8.0, wave_angle=0.5, speed=7.0, hull=MOTIONS)
    felt = weighted_acceleration(state.acceleration_parts, state.encounter_frequency)
    percent = float(motion_sickness_percent_iso(motion_sickness_dose(felt, duration=4 * 3600.0)))
    for factor, expected in ((0.98, True), (1.02, False)):
        limits = {"max_motion_sickness_percent": percent * factor, "motion_sickness_hours": 4}
        found = _ship(limits).limits.safety.forbids(
            7.0, wave_angle=0.5, wave_height=3.0, wave_period=8.0
        )
        assert bool(found) is expected


def test_waves_are_needed_and_unknown_waves_refuse():
    assert CIRCULAR.needs >= {
        "sea_surface_wave_significant_height",
        "sea_surface_wave_period_at_variance_spectral_density_maximum",
    }
    assert axes_needed(_arrays(0)) == sum(
        1 << axis
        for axis in (codes.AXIS_WAVE_HEIGHT, codes.AXIS_WAVE_ANGLE, codes.AXIS_WAVE_PERIOD)
    )
    assert _status(CIRCULAR, 0, 0.0, np.nan, 8.0)[1] == codes.NO_DATA
    assert _status(CIRCULAR, 0, 0.0, 3.0, np.nan)[1] == codes.NO_DATA
    assert _status(CIRCULAR, 2, math.pi, 0.0, np.nan)[1] in (codes.OK, codes.NO_DATA)
    free = Ship.from_dict({"name": "free", "hull": HULL, "speeds_kn": [12]})
    assert free.limits.safety is None and free.needs == frozenset()


def test_following_seas_forbid_high_speed_only():
    """1.8 sqrt(150) = 22.05 kn dead astern: 24 kn surf-rides, 18 kn does not."""
    only = _ship({"msc_circ_1228": ["surf_riding"]})
    at = {"wave_angle": math.pi, "wave_height": 4.0, "wave_period": 9.0}
    assert only.limits.safety.forbids(only.speeds, **at).tolist() == [False, False, True]
    assert not only.limits.safety.forbids(only.speeds, **{**at, "wave_angle": 0.3}).any()
    low = {**at, "wave_height": 1.4}
    assert not only.limits.safety.forbids(only.speeds, **low).any()


def _evaluated(limits, *, speed_kn=12, height=4.0, period=9.0, places=None):
    uniform = {
        "sea_surface_wave_significant_height": height,
        "sea_surface_wave_to_direction": 180.0,
        "sea_surface_wave_period_at_variance_spectral_density_maximum": period,
    }
    sea = Sea.from_functions(
        {name: lambda t, lat, lon, x=x: x + 0 * lat for name, x in uniform.items()}
    )
    ship = _ship(limits, **({"places": places} if places else {}))
    north = [(40.0, -30.0), (41.0, -30.0)]
    return evaluate(north, ship=ship, sea=sea, depart="2026-01-01T00:00Z", speed_kn=speed_kn), ship


def test_a_broken_limit_is_named_with_place_exposure_value_and_limit():
    """Motions at 12 kn in head seas; each limit is a violation of its own."""
    limits = {"max_vertical_acceleration_m_s2": 0.3, "max_motion_sickness_percent": 10}
    limits |= {"acceleration_at_m": 60.0, "motion_sickness_at_m": -40.0, "motion_sickness_hours": 4}
    route, _ = _evaluated(limits)
    by_reason = {one.reason.partition(": ")[2]: one for one in route.violations}
    assert set(by_reason) == {
        "vertical acceleration at 60 m ahead of midship",
        "motion sickness in 4 h at 40 m abaft midship",
    }
    at = {"height": 4.0, "period": 9.0, "speed": 12 * 1852 / 3600, "wave_angle": 0.0}
    bow, aft = (ship_response(**at, hull=MOTIONS, forward=x) for x in (60.0, -40.0))
    found = by_reason["vertical acceleration at 60 m ahead of midship"]
    assert found.value == pytest.approx(float(np.sqrt(bow.acceleration.m0)), rel=0.02)
    assert found.limit == pytest.approx(0.3) and " m/s2, limit 0.3" in str(found)
    sick = by_reason["motion sickness in 4 h at 40 m abaft midship"]
    weighted = weighted_acceleration(aft.acceleration_parts, aft.encounter_frequency)
    dose = motion_sickness_dose(weighted, duration=4 * 3600.0)
    assert sick.value == pytest.approx(float(motion_sickness_percent_iso(dose)), rel=0.02)
    assert sick.limit == pytest.approx(10.0) and " %, limit 10.00 %)" in str(sick)


@pytest.mark.parametrize(
    ("danger", "name", "half"),
    [("synchronous_roll", "synchronous roll", 1.0), ("parametric_roll", "parametric roll", 0.5)],
)
def test_resonance_is_named_with_the_periods_of_encounter(danger, name, half):
    period = 20.0 if half == 1.0 else 11.5  # encounters near 14 s and 7 s at 12 kn in head seas
    route, _ = _evaluated({"msc_circ_1228": [danger]}, period=period)
    (found,) = route.violations
    near = "encounter period within 10% of the roll period of 14 s"
    near += " or half of it" if half == 0.5 else ""
    assert found.reason == f"safety or comfort limit of the ship: {name}, {near}"
    assert abs(found.value / (14.0 * half) - 1.0) < 0.1 + 1e-9
    side = 1.1 if found.value >= 14.0 * half else 0.9
    assert found.limit == pytest.approx(14.0 * half * side)
    assert " s, limit " in str(found)


def test_the_summary_states_exposure_and_limit_of_sickness():
    """The limit is for 2 h amidships, the figure for the whole voyage at the place."""
    limits = {"max_motion_sickness_percent": 40}
    route, ship = _evaluated(limits, height=2.0, places={"wheelhouse": 40.0})
    (weather,) = [t for word, t in route_items(route, sea=None, chart=None, ship=ship)
                  if word == "Weather"]  # fmt: skip
    percent = route.indicators["places"]["wheelhouse"]["sick_percent"]
    assert (
        f"; sick after the whole voyage: wheelhouse {percent:.0f} % (limit: 40 % in 2 h amidships)"
        in weather
    )


def test_the_height_from_which_waves_are_a_danger_can_be_set():
    ship = _ship({"msc_circ_1228": ["surf_riding"], "danger_from_wave_height_m": 0.5})
    at = {"wave_angle": math.pi, "wave_height": 0.6, "wave_period": 5.0}
    assert ship.limits.safety.forbids(ship.speeds, **at).tolist() == [False, False, True]


def test_the_referee_lists_where_the_ship_breaks_its_safety_limits():
    sea = Sea.from_functions(
        {
            "sea_surface_wave_significant_height": lambda t, lat, lon: 4.0 + 0 * lat,
            "sea_surface_wave_to_direction": lambda t, lat, lon: 0.0 + 0 * lat,
            "sea_surface_wave_period_at_variance_spectral_density_maximum": (
                lambda t, lat, lon: 9.0 + 0 * lat
            ),
        }
    )
    only = _ship({"msc_circ_1228": ["surf_riding"]})
    north = [(40.0, -30.0), (41.0, -30.0)]
    fast, slow = (
        evaluate(north, ship=only, sea=sea, depart="2026-01-01T00:00Z", speed_kn=speed)
        for speed in (24, 18)
    )
    (found,) = fast.violations
    assert found.reason == "safety or comfort limit of the ship: surf-riding"
    assert found.value == pytest.approx(fast.samples["speed_through_water"].max())
    assert found.limit == pytest.approx(1.8 * math.sqrt(150.0) * 1852 / 3600, rel=1e-3)
    assert " kn, limit 22.05 kn)" in str(found) and found.as_dict()["limit"] == found.limit
    assert slow.violations == ()
    against = evaluate(north[::-1], ship=only, sea=sea, depart="2026-01-01T00:00Z", speed_kn=24)
    assert against.violations == ()


def test_weather_that_slows_a_ship_makes_it_safe():
    """The speed that counts is the one attained, in tables as in the model."""
    ship = _ship(
        {"msc_circ_1228": ["surf_riding"]},
        hull={**HULL, "displacement_m3": 21000},
        models={"speed_loss": "kwon_2008"},
    )
    c = Conditions(wind_speed=25.0, wind_angle=math.pi)
    attained = float(ship.speed_through_water(c, 2))
    at = {"wave_angle": math.pi, "wave_height": 5.0, "wave_period": 9.0}
    assert bool(ship.limits.safety.forbids(attained, **at)) == (attained > 22.05 * 1852 / 3600)


@pytest.mark.parametrize(
    ("limits", "hull", "match"),
    [
        ({"msc_circ_1228": ["surfriding"]}, {}, "surf_riding"),
        ({"msc_circ_1228": ["parametric_roll"]}, {"roll_period_s": None}, "natural roll period"),
        ({"max_vertical_acceleration_m_s2": 1.0, "acceleration_at_m": 140}, {}, "off the ship"),
        ({"max_vertical_acceleration_m_s2": -1.0}, {}, "greater than 0"),
        ({"max_motion_sickness_percent": 130}, {}, "at most 100"),
    ],
)
def test_limits_that_cannot_be_are_refused(limits, hull, match):
    whole = {k: v for k, v in {**HULL, **hull}.items() if v is not None}
    with pytest.raises(InputError, match=match):
        _ship(limits, hull=whole)


def test_a_ship_with_limits_is_another_ship():
    assert BOW.fingerprint() != SICK.fingerprint() != CIRCULAR.fingerprint()


@pytest.mark.slow
def test_a_plan_avoids_dangerous_waves_as_evaluated_by_the_referee():
    """24 kn straight before a following sea would surf-ride: the plan turns off by 45 degrees."""
    from thalweg import Chart, Voyage, plan

    sea = Sea.from_functions(
        {
            "sea_surface_wave_significant_height": lambda t, lat, lon: 4.0 + 0 * lat,
            "sea_surface_wave_to_direction": lambda t, lat, lon: 0.0 * lat,
            "sea_surface_wave_period_at_variance_spectral_density_maximum": (
                lambda t, lat, lon: 9.0 + 0 * lat
            ),
        }
    )
    voyage = Voyage(start=(40.0, -30.0), goal=(41.0, -30.0), depart="2026-01-01T00:00Z")
    chart = Chart.open_water(38, 43, -33, -27)
    routes = []
    for limits in ({}, {"msc_circ_1228": ["surf_riding"]}):
        ship = _ship(limits, speeds_kn=[24])
        routes.append(plan(voyage, ship=ship, sea=sea, chart=chart, resolution=8000.0).best)
    free, careful = routes
    assert free.violations == careful.violations == ()
    assert 1.05 < careful.time_h / free.time_h < 1.0 / math.cos(math.radians(45.0)) + 0.02
    off = np.degrees(np.abs((careful.samples["course"] + np.pi) % (2 * np.pi) - np.pi))
    assert off.max() > 20.0
