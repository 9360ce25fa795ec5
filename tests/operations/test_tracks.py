"""Models against measurements, on synthetic tracks with known activities and speeds."""

import json
import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import distance
from thalweg.core.units import KNOT
from thalweg.operations.examples.synthetic_tracks import SyntheticCycle, synthetic_track
from thalweg.operations.tracks.track_analysis import analyse_tracks
from thalweg.operations.tracks.track_calibration import (
    agreement_statistics,
    calibrate,
    leg_speeds,
    speeds_over_ground,
)
from thalweg.sea import Sea
from thalweg.ship import Conditions, Ship

TIDE = 44700.0
EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"
CYCLE = SyntheticCycle((52.3, 4.0), (52.1, 4.2), full_kn=11.0, empty_kn=13.0)
TIDAL = Sea.from_functions(
    {
        EAST: lambda t, la, lo: 0.5 * np.sin(2 * np.pi * t / TIDE) + 0.0 * la,
        NORTH: lambda t, la, lo: 0.8 * np.cos(2 * np.pi * t / TIDE) + 0.0 * la,
    }
)


@pytest.fixture(scope="module")
def made():
    return synthetic_track(
        CYCLE, sea=TIDAL, start="2026-01-01", cycles=12, interval_s=120.0, current_factor=1.4
    )


@pytest.fixture(scope="module")
def analysis(made):
    ship = Ship.simple(speeds_kn=[11.0, 13.0])
    return analyse_tracks(made.frame, CYCLE.areas, sea=TIDAL, ship=ship)


@pytest.mark.slow
def test_the_true_factor_and_speeds_are_found(analysis):
    """Without speed noise the factor is met within 0.02 and the speeds within 0.03 kn."""
    found = analysis.calibration
    assert found.factor == pytest.approx(1.4, abs=0.02)
    assert found.speeds["sailing full"] / KNOT == pytest.approx(11.0, abs=0.03)
    assert found.speeds["sailing empty"] / KNOT == pytest.approx(13.0, abs=0.03)
    assert found.slope_one == pytest.approx(1.4, abs=0.03)
    assert found.factor_error < 0.01 and found.legs == 24
    assert found.residual < 0.05


@pytest.mark.parametrize("seed", range(4))
def test_speed_noise_is_within_the_stated_errors(seed):
    track = synthetic_track(
        replace(CYCLE, position_noise_m=10.0),
        sea=TIDAL,
        start="2026-01-01",
        cycles=10,
        interval_s=240.0,
        current_factor=0.7,
        speed_noise=0.03,
        seed=seed,
    )
    found = analyse_tracks(track.frame, CYCLE.areas, sea=TIDAL).calibration
    assert abs(found.factor - 0.7) < 3.5 * found.factor_error
    assert 0.01 < found.factor_error < 0.1
    for kind, knots in (("sailing full", 11.0), ("sailing empty", 13.0)):
        assert abs(found.speeds[kind] - knots * KNOT) < 3.5 * found.speed_errors[kind]


def test_activities_and_cycles_equal_those_of_the_simulation(made, analysis):
    kinds = [a.kind for a in analysis.activities]
    assert kinds == [*made.truth.kind, "loading"]  # the last trip ends in the area
    whole = [a for a in analysis.activities if a.whole]
    assert len(whole) == 47
    cycles = analysis.cycle_frame()
    assert len(cycles) == 11
    start = made.truth.start[made.truth.kind == "loading"].diff().dropna().to_numpy()
    assert cycles["cycle [h]"].to_numpy()[:-1] == pytest.approx(start[1:] / 3600, abs=0.05)
    parts = [c for c in cycles.columns if c.endswith("[h]") and c != "cycle [h]"]
    assert cycles[parts].sum(axis=1).to_numpy() == pytest.approx(cycles["cycle [h]"].to_numpy())
    shares = analysis.statistics()
    assert shares.share.sum() == pytest.approx(1.0)
    radius = 2 * CYCLE.radius_nm / 12.0  # the way from the edge counts as work
    worked = shares.set_index("activity").mean_h
    assert worked["unloading"] == pytest.approx(1.0 + radius, abs=0.05)


def test_better_models_lie_closer(analysis):
    fits = analysis.spreads()
    order = ("still water", "currents", "calibrated")
    assert [fits[n].count for n in order] == [24] * 3
    errors = [fits[n].rmse_rel for n in order]
    assert errors[0] > 2 * errors[1] > 6 * errors[2]
    assert fits["calibrated"].slope == pytest.approx(1.0, abs=0.02)
    assert fits["calibrated"].r2 > 0.99 > fits["currents"].r2 > 0.9
    assert fits["ship"].rmse_rel == pytest.approx(fits["currents"].rmse_rel, rel=0.15)
    assert fits["ship, calibrated"].rmse_rel < 1.0
    assert any("setting of 11.00 kn while sailing full" in note for note in analysis.notes)
    assert any("setting of 13.00 kn while sailing empty" in note for note in analysis.notes)


def test_the_table_of_legs_has_distances_and_errors(analysis):
    legs = analysis.leg_frame()
    assert len(legs) == 24
    assert (legs.distance_nm < 14.1 - 2 * 0.5 * CYCLE.radius_nm).all()
    assert legs.distance_nm.to_numpy() == pytest.approx(legs.speed_kn * legs.hours)
    assert (legs["calibrated rmse_rel [%]"] < 2.0).all()
    assert legs["calibrated [kn]"].to_numpy() == pytest.approx(legs.speed_kn.to_numpy(), rel=0.01)


def test_the_answer_is_json(analysis, made):
    found = analysis.as_dict()
    text = json.dumps(found, allow_nan=False)
    assert json.loads(text) == found
    assert found["cycles"]["count"] == 11 and found["vessel"] == "244000000"
    # of the complete cycles alone, without those that the record cuts off
    hours = analysis.cycle_frame()["cycle [h]"].mean()
    assert found["cycles"]["per_week"] == pytest.approx(168.0 / hours)
    still = analyse_tracks(made.frame, CYCLE.areas)
    assert still.calibration is None and list(still.models) == ["still water"]
    json.dumps(still.as_dict(), allow_nan=False)


def test_unknown_currents_are_reported_and_excluded(made):
    half = made.truth.start.iloc[24]
    sea = Sea.from_functions(
        {
            EAST: lambda t, la, lo: np.where(t < half, 0.5 * np.sin(2 * np.pi * t / TIDE), np.nan),
            NORTH: lambda t, la, lo: np.where(t < half, 0.8 * np.cos(2 * np.pi * t / TIDE), np.nan),
        }
    )
    found = analyse_tracks(made.frame, CYCLE.areas, sea=sea)
    assert found.calibration.legs == 12
    assert found.calibration.factor == pytest.approx(1.4, abs=0.03)
    assert found.spreads()["currents"].count == 12 and found.spreads()["still water"].count == 24
    assert any("has no current" in note for note in found.notes)


def test_still_water_gives_no_calibration_factor(made):
    found = analyse_tracks(made.frame, CYCLE.areas, sea=Sea.calm())
    assert found.calibration is None
    assert any("not determined" in note for note in found.notes)


def test_gaps_in_a_track_are_reported(made):
    frame = made.frame.drop(index=range(100, 130))
    found = analyse_tracks(frame, CYCLE.areas, sea=TIDAL)
    assert any("No positions for" in note for note in found.notes)
    assert found.calibration.factor == pytest.approx(1.4, abs=0.02)


def test_a_ship_at_its_measured_power_goes_as_fast_as_it_went():
    """The speed at a power and the power at a speed of one ship undo each other."""
    ship = Ship.load("vox-olympia")
    bed = {"sea_floor_depth_below_geoid": lambda t, la, lo: 30.0 + 0.0 * la}
    sea = Sea.from_functions(bed) + TIDAL.filled(wind=0.0, waves=0.0)
    cycle = SyntheticCycle((52.3, 4.0), (52.1, 4.2), full_kn=9.0, empty_kn=11.0)
    track = synthetic_track(cycle, sea=TIDAL, start=0.0, cycles=4, interval_s=120.0)
    calm = {"wind_speed": 0.0, "wind_angle": 0.0, "wave_height": 0.0, "wave_angle": 0.0}
    met = Conditions(**calm, wave_period=8.0, depth=30.0)
    power = {
        draught: float(ship.power_at_speed(met, knots * KNOT)) / 1e3
        for draught, knots in ((8.0, 9.0), (5.0, 11.0))
    }
    frame = track.frame.assign(power_kw=track.frame.draught_m.map(power))
    found = analyse_tracks(frame, cycle.areas, sea=sea, ship=ship)
    fit = found.spreads()["ship, measured power"]
    assert fit.count == 8
    assert fit.rmse_rel < 0.5 and fit.slope == pytest.approx(1.0, abs=0.02)
    without = analyse_tracks(track.frame, cycle.areas, sea=sea, ship=ship)
    assert "ship, measured power" not in without.models


def test_spread_of_a_hand_computed_example():
    fit = agreement_statistics([1.0, 2.0, 3.0, 4.0, np.nan], [1.5, 2.0, 3.5, 5.0, 9.0])
    assert fit.count == 4
    assert (fit.slope, fit.intercept) == pytest.approx((1.2, 0.0))
    assert fit.r2 == pytest.approx(36.0 / 37.5)
    assert fit.rmse == pytest.approx(np.sqrt(1.5 / 4))
    assert fit.rmse_rel == pytest.approx(100 * np.sqrt(1.5 / 4) / 2.5)


def test_spread_is_nan_where_it_is_undefined():
    assert np.isnan(agreement_statistics([], []).rmse)
    assert np.isnan(agreement_statistics([1.0, 2.0], [1.0, 2.0]).slope)
    flat = agreement_statistics([3.0, 3.0, 3.0], [2.0, 3.0, 4.0])
    assert np.isnan(flat.slope) and flat.rmse == pytest.approx(np.sqrt(2 / 3))
    assert np.isnan(agreement_statistics([1.0, 2.0, 3.0], [4.0, 4.0, 4.0]).r2)


@given(
    x=st.lists(st.floats(1.0, 20.0), min_size=4, max_size=30, unique_by=lambda v: round(v, 3)),
    slope=st.floats(0.1, 3.0),
    offset=st.floats(-2.0, 2.0),
)
def test_a_line_is_found_again(x, slope, offset):
    fit = agreement_statistics(x, slope * np.array(x) + offset)
    assert fit.slope == pytest.approx(slope, rel=1e-6, abs=1e-9)
    assert fit.intercept == pytest.approx(offset, abs=1e-6)
    assert fit.r2 == pytest.approx(1.0, abs=1e-6)


def test_over_ground_undoes_through_water(analysis):
    segments = analysis.segments
    for factor in (0.0, 1.0, 1.7):
        water = np.abs(segments.ground - factor * segments.current)
        assert speeds_over_ground(segments, water, factor) == pytest.approx(segments.speed)
    assert np.isnan(speeds_over_ground(segments, 1e-3, 5.0)).any()
    legs = leg_speeds(segments, segments.speed)
    assert calibrate(segments.part(segments.leg < 2)) is None and len(legs) == 24


@pytest.mark.parametrize("stops", range(70, 75))  # minute in which it stops
def test_a_ship_at_rest_during_a_trip_has_no_course(stops):
    """Nine minutes are no wait, but may hold a segment of no length: its leg is still compared."""
    minutes = np.arange(0.0, 180.0)
    way = np.interp(minutes, [30, stops, stops + 9, stops + 49], [0.0, 0.5, 0.5, 1.0])
    table = pd.DataFrame(
        {"time": 1.77e9 + 60.0 * minutes, "lat": 52.3 - 0.2 * way, "lon": 4.0 + 0.2 * way}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = analyse_tracks(table, CYCLE.areas, sea=TIDAL)
    legs = found.leg_frame()
    assert len(legs) == 1 and (found.segments.speed > 0.0).all()
    length = float(distance(52.3, 4.0, 52.1, 4.2))
    # of the stop some minutes may be left, in the segments that sail on
    assert 0.95 * length / (93.0 * 60.0) < legs.speed_kn[0] * KNOT < length / (80.0 * 60.0)
    assert np.isfinite(legs["currents [kn]"][0])


def test_tracks_that_cannot_be_made():
    asked = {"sea": TIDAL, "start": 0.0}
    for wrong in ({"cycles": 0}, {"interval_s": 0.0}, {"speed_noise": -1.0}):
        with pytest.raises(InputError):
            synthetic_track(CYCLE, **asked, **wrong)
    with pytest.raises(InputError, match="three radii apart"):
        SyntheticCycle((52.0, 4.0), (52.0, 4.01))
    with pytest.raises(InputError, match="position_noise_m"):
        replace(CYCLE, position_noise_m=-1.0)
    slow = SyntheticCycle((52.3, 4.0), (52.1, 4.2), full_kn=1.0)
    with pytest.raises(NoRouteError):
        synthetic_track(slow, sea=TIDAL, start=0.0, current_factor=3.0)
    nowhere = Sea.from_functions(
        {n: (lambda t, la, lo: 0.0 * la) for n in (EAST, NORTH)}, area=(0.0, 1.0, 0.0, 1.0)
    )
    with pytest.raises(InputError, match="has no current"):
        synthetic_track(CYCLE, sea=nowhere, start=0.0)
