"""Waits at sea in waves above the limit or in unknown ones: avoided where possible, else stated."""

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.planning.report.plan_summary import limits_text

KNOWN, UNKNOWN = 6.0, np.nan


@pytest.fixture
def planned(tmp_path):
    """Plan past high waves from 3.0E for 40 h, and from 1.5E after hour 20 for a while."""

    def of(until, height, objective="time", **ship):
        hours = np.arange(97.0)
        lat, lon = np.arange(-1.0, 1.001, 0.05), np.arange(0.0, 6.001, 0.05)
        time, _, east = np.meshgrid(hours, lat, lon, indexing="ij")
        waves = np.full(time.shape, 1.0)
        waves[(east >= 2.999) & (east <= 3.601) & (time <= 40)] = KNOWN
        waves[(east >= 1.499) & (east < 2.999) & (time >= 20) & (time <= until)] = height
        name = "sea_surface_wave_significant_height"
        steps = np.datetime64("2026-05-01", "ns") + hours.astype(int) * np.timedelta64(1, "h")
        axes = {
            "time": steps,
            "lat": ("lat", lat, {"units": "degrees_north"}),
            "lon": ("lon", lon, {"units": "degrees_east"}),
        }
        field = (("time", "lat", "lon"), waves, {"standard_name": name, "units": "m"})
        xr.Dataset({"hs": field}, axes).to_netcdf(tmp_path / "waves.nc")
        return plan(
            Voyage(
                start=(0.0, 0.5), goal=(0.0, 5.5), depart="2026-05-01T00:00Z", objective=objective
            ),
            ship=Ship.simple(speed_kn=10.0, draught_m=5.0, max_wave_height_m=4.0, **ship),
            sea=Sea.open(tmp_path / "waves.nc"),
            chart=Chart.open_water(-1.0, 1.0, 0.0, 6.0),
            proof=3.0,
        )

    return of


def test_a_ship_waits_at_her_berth_where_waves_are_too_high_at_sea(planned):
    found = planned(until=30, height=KNOWN)
    wait = np.asarray(found.best.track.wait)
    assert found.best.feasible
    assert wait[0] == pytest.approx(25.4 * 3600.0, abs=600.0) and not wait[1:].any()
    assert not any(note.startswith("Waits at sea") for note in found.notes)


@pytest.mark.parametrize(
    ("height", "words"),
    [
        (KNOWN, "in waves of up to 6.0 m, above the limit of 4.0 m"),
        (UNKNOWN, "where the data have no waves for 1"),
    ],
)
def test_a_wait_that_has_no_other_place_is_the_first_note(planned, height, words):
    found = planned(until=36, height=height)
    assert found.best.waiting_h > 20.0
    (note,) = (note for note in found.notes if note.startswith("Waits at sea"))
    assert words in note
    assert "waves under way" in limits_text(found)


@pytest.mark.slow
def test_the_least_time_of_a_front_knows_when_waves_fall(planned):
    """At the top speed all the way the voyage would take 30 h, and not the 55 h of the wait."""
    speeds = {"speeds_kn": [8.0, 10.0], "fuel_t_per_day": 24.0}
    found = planned(until=30, height=KNOWN, objective="front", **speeds)
    assert found.best.time_h > 55.0
    assert 0.95 * found.best.time_h < found.lower_bound <= found.best.time_h
