"""Waits at sea in waves above the limit or in unknown ones: avoided where possible, else stated."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Track, Voyage, evaluate, plan
from thalweg.core.units import HOUR, KNOT
from thalweg.planning.report.plan_summary import limits_text
from thalweg.planning.report.route_summary import weather_text
from thalweg.planning.report.waiting_report import waiting_weather_warnings
from thalweg.planning.single.sheltered_waits import with_sheltered_waits

KNOWN, UNKNOWN = 6.0, np.nan


@pytest.fixture
def planned(tmp_path):
    """Plan past high waves from 3.0E for some hours, and from 1.5E after hour 20 for a while."""

    def of(until, height, objective="time", proof=0.0, first=40, **ship):
        hours = np.arange(97.0)
        lat, lon = np.arange(-1.0, 1.001, 0.05), np.arange(0.0, 6.001, 0.05)
        time, _, east = np.meshgrid(hours, lat, lon, indexing="ij")
        waves = np.full(time.shape, 1.0)
        waves[(east >= 2.999) & (east <= 3.601) & (time <= first)] = KNOWN
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
            proof=proof,
            resolution=15_000.0,
        )

    return of


@pytest.mark.slow
def test_a_ship_waits_at_her_berth_where_waves_are_too_high_at_sea(planned):
    found = planned(until=30, height=KNOWN)
    wait = np.asarray(found.best.track.wait)
    assert found.best.feasible
    assert wait[0] == pytest.approx(25.4 * 3600.0, abs=600.0) and not wait[1:].any()
    assert not any(note.startswith("Waits at sea") for note in found.notes)


@pytest.mark.slow
def test_a_wait_that_has_no_other_place_is_the_first_note(planned):
    """From her berth she would arrive after 102 h, and the data end after 96 h."""
    found = planned(until=78, height=KNOWN)
    assert found.best.waiting_h > 20.0
    (note,) = (note for note in found.notes if note.startswith("Waits at sea"))
    assert "in waves of up to 6.0 m, above the limit of 4.0 m" in note
    assert "waves under way" in limits_text(found)
    assert "; 6.0 m in a wait at sea" in weather_text(found.best, None)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("height", "hours", "words"),
    [
        (KNOWN, 60.4, "in waves of up to 6.0 m, above the limit of 4.0 m."),
        (UNKNOWN, 61.3, "where the data have no waves for 17.9 h of it."),
    ],
)
def test_a_ship_arrives_later_where_she_would_wait_at_sea_in_high_or_unknown_waves(
    planned, height, hours, words
):
    """By the wait at sea she arrives after 55.4 h."""
    found = planned(until=36, height=height)
    assert found.best.feasible
    assert np.flatnonzero(np.asarray(found.best.track.wait)).tolist() == [0]
    assert found.best.time_h == pytest.approx(hours, abs=0.3)
    assert not any(note.startswith("Waits at sea") for note in found.notes)
    (note,) = (note for note in found.notes if "later than is possible" in note)
    assert note.startswith("Arrives 5 h ") and "would have to wait at sea 25.4 h" in note
    assert note.endswith(words)


@pytest.mark.slow
def test_a_later_departure_is_searched_beyond_the_period_of_the_first_search(planned):
    """The earliest route arrives after 65 h; the first search knows 75 h, 2.5 times the sailing."""
    found = planned(until=58, height=KNOWN, first=50)
    assert found.best.feasible
    assert np.flatnonzero(np.asarray(found.best.track.wait)).tolist() == [0]
    assert 75.0 < found.best.time_h < 1.3 * 65.4
    assert not any(note.startswith("Waits at sea") for note in found.notes)


@pytest.mark.slow
@pytest.mark.parametrize("proof", [None, 3.0], ids=["time of the search", "time given"])
def test_the_least_time_of_a_front_knows_when_waves_fall(planned, proof, monkeypatch):
    """At 10 kn the voyage would take 30 h, at 8 kn 37.5 h, and not the 55 h of the wait."""
    monkeypatch.setattr("thalweg.planning.pareto.front_bound.least_ways._SECONDS", 4.0)
    speeds = {"speeds_kn": [8.0, 10.0], "fuel_t_per_day": 24.0}
    found = planned(until=30, height=KNOWN, objective="front", proof=proof, **speeds)
    assert found.best.time_h > 55.0
    assert 0.95 * found.best.time_h < found.lower_bound <= found.best.time_h
    assert found.front.certain[0, 0] == pytest.approx(found.lower_bound)


def warnings_of_waits(wait_h, wind_kn):
    """Return the warnings of a ship with a limit of 20 kn that waits at 0.2E, in hours."""
    names = ("eastward_wind", "northward_wind")
    sea = Sea.from_functions(
        {
            names[0]: lambda time, lat, lon: wind_kn(time / HOUR) * KNOT * 0.6 + 0.0 * lat,
            names[1]: lambda time, lat, lon: wind_kn(time / HOUR) * KNOT * 0.8 + 0.0 * lat,
        }
    )
    ship = Ship.simple(speed_kn=10.0, draught_m=5.0, max_wind_speed_kn=20.0)
    track = Track([0.0] * 3, [0.0, 0.2, 0.4], depart=0.0, wait=[HOUR * one for one in wait_h])
    chart = Chart.open_water(-1.0, 1.0, -1.0, 1.0)
    route = evaluate(track, ship=ship, sea=sea, chart=chart, strict=False)
    return waiting_weather_warnings(route, ship)


def storm(hour):  # from 2 h to 6 h; the ship gets to 0.2E after 1.2 h
    return np.where((hour > 2.0) & (hour < 6.0), 35.0, 5.0)


def unknown_for_two_hours(hour):
    return np.where((hour > 2.0) & (hour < 4.0), np.nan, 5.0)


def test_a_wait_in_wind_above_the_limit_is_stated():
    (note,) = warnings_of_waits([0.0, 8.0, 0.0], storm)
    assert note.startswith("Waits at sea 8.0 h at ")
    assert "in wind of up to 35.0 kn, above the limit of 20.0 kn" in note


def test_the_hours_of_unknown_wind_in_a_wait_are_stated():
    (note,) = warnings_of_waits([0.0, 8.0, 0.0], unknown_for_two_hours)
    assert "where the data have no wind for 2.0 h of it" in note


@pytest.mark.parametrize(
    "wait_h",
    [[5.0, 0.0, 0.0], [1.0, 0.09, 0.0], [0.0, 0.0, 0.0], [0.0, 0.5, 0.0]],
    ids=["at the berth", "under six minutes", "without waits", "before the storm"],
)
def test_other_waits_are_not_stated(wait_h):
    assert warnings_of_waits(wait_h, storm) == []


@pytest.mark.parametrize(
    ("rough_start", "closed", "place"),
    [(False, (), 0), (True, (), 1), (True, (0.2,), 2), (True, (0.2, 0.4), 3)],
)
def test_a_wait_moves_to_the_first_sheltered_place_where_she_may_wait(rough_start, closed, place):
    """It blows at 0.6E from 4.5 h to 7 h, in the wait, and on the first leg from 3 h on."""

    def wind(time, lat, lon):
        at_wait = (np.abs(lon - 0.6) < 0.05) & (time > 4.5 * HOUR) & (time < 7.0 * HOUR)
        at_start = rough_start & (np.abs(lon - 0.1) < 0.05) & (time > 3.0 * HOUR)
        return np.where(at_wait | at_start, 30.0, 1.0) + 0.0 * lat

    names = ("eastward_wind", "northward_wind")
    sea = Sea.from_functions({names[0]: wind, names[1]: lambda time, lat, lon: 0.0 * time * lat})
    ship = Ship.simple(speed_kn=10.0, draught_m=5.0, max_wind_speed_kn=20.0)
    water = Chart.open_water(-1.0, 1.0, -1.0, 1.0)
    zones = SimpleNamespace(may_wait=lambda lat, lon: not np.isclose(lon, closed).any())
    context = SimpleNamespace(
        ship=ship, chart=SimpleNamespace(zones=zones),
        evaluate=lambda track: evaluate(track, ship=ship, sea=sea, chart=water, strict=False),
    )  # fmt: skip
    wait = np.array([0.0, 0.0, 0.0, 4.0 * HOUR, 0.0])
    route = context.evaluate(Track([0.0] * 5, [0.0, 0.2, 0.4, 0.6, 0.8], depart=0.0, wait=wait))
    assert route.feasible
    found = with_sheltered_waits(context, route, route.arrive + 60.0)
    assert np.flatnonzero(found.track.wait).tolist() == [place]
    assert found.arrive == pytest.approx(route.arrive, abs=30.0)
    assert (found is route) == (place == 3)
