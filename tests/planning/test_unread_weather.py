"""Notes on weather that the speed of a ship does not depend on."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.cli.main import main
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.planning.report.unread_weather import (
    WAVES_UNREAD,
    WIND_UNREAD,
    unread_weather_notes,
)
from thalweg.route import evaluate
from thalweg.sea import standard_names as nm

KWON = Ship.load("handysize-bulker")
IN_WAVES = Ship.from_speed_function(lambda c: 6.0 - 0.2 * c.wave_height)
STEADY = Ship.simple(10)
WAVES = {
    nm.WAVE_HEIGHT: lambda t, y, x: np.where(x > -19.0, 4.0, 1.0) + 0.0 * y,
    "sea_surface_wave_from_direction": lambda t, y, x: 270.0 + 0.0 * y,
}
WIND = {
    nm.EASTWARD_WIND: lambda t, y, x: 12.0 + 0.0 * y,
    nm.NORTHWARD_WIND: lambda t, y, x: 0.0 * y,
}
LINE = [(50.0, -20.0), (50.0, -18.0)]


def notes_of(ship, functions, **fills):
    sea = Sea.from_functions(functions, time_step=0.0)
    sea = sea.filled(**fills) if fills else sea
    route = evaluate(LINE, ship=ship, sea=sea, depart=0)
    return route, unread_weather_notes(route, sea, ship)


def test_waves_that_a_speed_loss_by_the_wind_does_not_read_are_stated():
    """Kwon's ship made her calm speed in 4 m waves with a wind of 0, without a note."""
    route, (note,) = notes_of(KWON, WAVES, wind=0.0)
    assert note.startswith(f"{WAVES_UNREAD}: up to 4.0 m at 50")
    assert "her speed depends on the wind alone, which would raise lower waves there, and" in note
    assert count_of_dangers([note]) == 1
    slower, none = notes_of(KWON, WAVES, wind="waves")
    assert none == []  # they act by the wind that is derived from them
    assert slower.time_h > 1.02 * route.time_h


def test_waves_beside_a_wind_of_the_data_are_stated_where_they_do_not_make_it():
    swell = {**WAVES, **WIND, nm.EASTWARD_WIND: lambda t, y, x: 6.0 + 0.0 * y}
    assert notes_of(KWON, swell)[1][0].startswith(WAVES_UNREAD)
    assert notes_of(KWON, swell, wind="waves")[1][0].startswith(WAVES_UNREAD)
    low = {**swell, nm.WAVE_HEIGHT: lambda t, y, x: 0.4 + 0.0 * y}
    assert notes_of(KWON, low)[1] == []


def test_waves_of_the_wind_are_those_that_a_loss_by_the_wind_means():
    """A wind of 12 m/s raises 3.4 m: 4 m are its waves, as far as the formulas know."""
    assert notes_of(KWON, {**WAVES, **WIND})[1] == []


def test_a_wind_that_a_ship_of_waves_alone_does_not_read_is_stated():
    _, (note,) = notes_of(IN_WAVES, {**WAVES, **WIND})
    assert note.startswith(f"{WIND_UNREAD}: up to 23 kn at 50")
    assert notes_of(IN_WAVES, WIND, waves="wind")[1] == []


def test_a_ship_that_reads_neither_has_a_note_on_both():
    notes = notes_of(STEADY, {**WAVES, **WIND})[1]
    assert [note.split(":")[0] for note in notes] == [WAVES_UNREAD, WIND_UNREAD]
    assert notes_of(STEADY, {})[1] == []


def test_plans_have_the_note():
    sea = Sea.from_functions(WAVES, time_step=0.0).filled(wind=0.0)
    voyage = Voyage(start=LINE[0], goal=LINE[1], depart="2026-01-01", objective="distance")
    water = Chart.open_water(48.0, 52.0, -22.0, -16.0)
    found = plan(voyage, ship=KWON, sea=sea, chart=water, resolution=20_000.0)
    assert [note for note in found.notes if note.startswith(WAVES_UNREAD)]
    steady = plan(voyage, ship=STEADY, sea=sea, chart=water, resolution=20_000.0)
    assert not [note for note in steady.notes if note.startswith(WAVES_UNREAD)]
    assert [note for note in steady.notes if note.startswith("Weather is not considered")]


@pytest.mark.parametrize("fill", [[], ["--fill", "wind=0"], ["--fill", "wind=waves"]])
def test_the_command_line_takes_wind_of_waves(tmp_path, capsys, fill):
    times = np.datetime64("2026-01-01T00:00", "ns") + np.arange(9) * np.timedelta64(6, "h")
    axes = ("time", "lat", "lon")
    names = {"swh": (4.0, "m"), "mwd": (270.0, "degrees")}
    xr.Dataset(
        {name: (axes, np.full((9, 3, 3), v), {"units": unit}) for name, (v, unit) in names.items()},
        {"time": times, "lat": [49.0, 50.0, 51.0], "lon": [-21.0, -19.0, -17.0]},
    ).to_netcdf(tmp_path / "waves.nc")
    (tmp_path / "route.csv").write_text("lat,lon,time\n50,-20,2026-01-01T00:00Z\n50,-18,\n")
    asked = ["evaluate", str(tmp_path / "route.csv"), "--ship", "handysize-bulker"]
    asked += ["--sea", str(tmp_path / "waves.nc"), "--coast", "none", "--json", "--quiet", *fill]
    code = main(asked)
    said = capsys.readouterr()
    if not fill:
        assert code != 0 and "--fill wind=waves" in said.out
        return
    notes = json.loads(said.out)["notes"]
    assert any(WAVES_UNREAD in note for note in notes) == (fill[1] == "wind=0")
    assert any("raises the known waves" in note for note in notes) == (fill[1] == "wind=waves")


@pytest.mark.slow
def test_a_ship_that_reads_the_direction_of_waves_alone_has_a_route():
    """She was refused for "gaps" in the data: the search did not read the heights."""

    def speed(c):
        off = np.abs(np.arctan2(np.sin(c.wave_angle), np.cos(c.wave_angle)))
        return 6.0 * (1.0 - 0.5 * np.exp(-((off / 0.6) ** 2)))

    east = {
        nm.WAVE_HEIGHT: lambda t, y, x: 2.0 + 0.0 * y,
        "sea_surface_wave_from_direction": lambda t, y, x: 90.0 + 0.0 * y,
    }
    found = plan(
        Voyage(start=(0.0, 0.0), goal=(0.0, 0.8), depart="2026-01-01"),
        ship=Ship.from_speed_function(speed),
        sea=Sea.from_functions(east),
        chart=Chart.open_water(-1.0, 1.0, -1.0, 2.0),
    )
    off = np.linspace(0.0, 1.5, 10_001)  # she tacks at the angle of the best speed made good
    best = (6.0 * (1.0 - 0.5 * np.exp(-((off / 0.6) ** 2))) * np.cos(off)).max()
    assert found.best.time_h == pytest.approx(0.8 * 111_319.49 / best / 3600.0, rel=1e-4)


@pytest.mark.slow
def test_a_bound_is_lowered_by_what_the_table_of_a_function_is_off():
    """A narrow peak of speed at waves of 2.1 m was not in the table: a bound above a route."""
    ship = Ship.from_speed_function(
        lambda c: 4.0 + 4.0 * np.exp(-(((c.wave_height - 2.13) / 0.03) ** 2))
    )
    waves = {
        nm.WAVE_HEIGHT: lambda t, y, x: 2.0 + 0.4 * y + 0.0 * x,
        "sea_surface_wave_from_direction": lambda t, y, x: 90.0 + 0.0 * y,
    }
    found = plan(
        Voyage(start=(0.0, 0.0), goal=(0.0, 0.8), depart="2026-01-01"),
        ship=ship,
        sea=Sea.from_functions(waves, time_step=0.0),
        chart=Chart.open_water(-1.0, 1.0, -1.0, 2.0),
    )
    off = ship.tabulate().error.max
    assert off > 0.01
    assert f"a table of the ship's function, {off:.1%} off at most" in found.proof.kind
    assert found.lower_bound <= (1.0 - off) * found.best.time_h * 1.001
