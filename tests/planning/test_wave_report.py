"""Waves steeper than any sea: the wave period of the data is wrong, and plans state it."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.planning.report.note_order import danger_first
from thalweg.planning.report.wave_report import TOO_STEEP, comfort_turn_notes
from thalweg.route import Track, evaluate
from thalweg.sea.standard_names import WAVE_HEIGHT, WAVE_PERIOD

WAVE_FROM = "sea_surface_wave_from_direction"


def waves(height, period):
    return Sea.from_functions(
        {
            WAVE_HEIGHT: lambda time, lat, lon: height + 0.0 * lat,
            WAVE_PERIOD: lambda time, lat, lon: period + 0.0 * lat,
            WAVE_FROM: lambda time, lat, lon: 0.0 * lat,
        }
    )


@pytest.mark.parametrize(
    ("height", "period", "steep"),
    [(2.3, 0.9, True), (2.3, 3.7, True), (2.3, 4.0, False), (2.3, 8.0, False), (0.2, 0.5, False)],
)
def test_plans_warn_of_waves_steeper_than_any_sea(height, period, steep):
    chart = Chart.open_water(50.0, 52.5, 1.0, 4.0)
    voyage = Voyage(start=(51.0, 2.0), goal=(51.2, 2.4), depart="2026-01-01T00:00Z")
    sea = waves(height, period)
    found = plan(voyage, ship=Ship.simple(speed_kn=8.0), sea=sea, chart=chart, proof=0.0)
    warned = [note for note in found.notes if note.startswith(TOO_STEEP)]
    assert bool(warned) == steep
    if steep:
        value = height / (9.80665 * period**2 / (2.0 * np.pi))
        assert f"a steepness of {value:.2f}" in warned[0]
        assert danger_first(["Passes A.", *warned])[0] == warned[0]


@pytest.mark.parametrize(("swing", "noted"), [(1.0, True), (0.1, False)])
def test_many_sharp_turns_for_comfort_are_stated(swing, noted):
    lat = 51.0 + 0.1 * np.arange(6)
    lon = 2.0 + swing * 0.1 * (np.arange(6) % 2)
    track = Track(lat, lon, depart=0.0, wait=np.zeros(6), setting=np.zeros(5, int))
    route = evaluate(track, ship=Ship.simple(speed_kn=8.0), sea=Sea.calm())
    notes = comfort_turn_notes(route)
    assert bool(notes) == noted
    if noted:
        assert notes[0].startswith("Turns 4 times by more than 60 degrees")
