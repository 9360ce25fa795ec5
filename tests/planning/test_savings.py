"""Savings over weather-blind routes: references keep the limits, and the saving has two parts."""

from types import SimpleNamespace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.planning.pareto.baseline import constant_speed_tracks, undercut_note
from thalweg.route import Track

START, GOAL = (0.0, 0.0), (0.0, 2.0)
CHART = Chart.open_water(-1.0, 1.0, -0.5, 2.5)
KNOT = 1852.0 / 3600.0


def front(sea, **limits):
    ship = Ship.from_dict(
        {
            "name": "cubic",
            "hull": {"draught_m": 5.0},
            "speeds_kn": [8.0, 10.0, 12.0],
            "engine": {"reference_speed_kn": 12.0},
            "fuel": {"reference_t_per_day": 24.0},
            "models": {"calm_water": "cubic"},
            "limits": limits,
        }
    )
    voyage = Voyage(
        start=START, goal=GOAL, depart="2026-01-01T00:00Z", objective="front", method="exact"
    )
    return plan(voyage, ship=ship, sea=sea, chart=CHART, resolution=9.0 * 1852.0)


def on_the_way(lat, lon, half_width):
    """1 in the middle of the geodesic, falling to 0 at the half-width [deg] to both sides."""
    across = np.clip(2.0 - np.abs(lat) / half_width, 0.0, 1.0)
    along = np.clip(3.0 - 5.0 * np.abs(lon - 1.0), 0.0, 1.0)
    return across * along


@pytest.mark.slow
def test_a_reference_that_breaks_a_limit_saves_nothing():
    waves = {
        "sea_surface_wave_significant_height": lambda t, a, o: 6.0 * on_the_way(a, o, 0.2),
    }
    answer = front(Sea.from_functions(waves), max_significant_wave_height_m=4.0)
    assert answer.best.feasible
    rows = answer.front.comparison.rows
    assert rows and not any(row["feasible"] for row in rows)
    assert all(row["saved"] is None and row["saved_h"] is None for row in rows)
    (note,) = [note for note in answer.notes if "weather-blind" in note]
    assert note.startswith("No weather-blind route is feasible: wave height")


@pytest.mark.slow
def test_a_saving_is_that_of_the_route_and_that_of_the_speeds():
    """Against 4 kn on the way alone: at a constant speed the ship saves by sailing round it."""
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, a, o: -4.0 * KNOT * on_the_way(a, o, 0.2),
            "northward_sea_water_velocity": lambda t, a, o: 0.0 * a,
        }
    )
    rows = [row for row in front(sea).front.comparison.rows if row["saved"] is not None]
    assert rows
    for row in rows:
        assert row["feasible"]
        assert row["saved_by_route"] >= 0.0 and row["saved_by_speed"] >= 0.0
        assert row["saved"] == pytest.approx(row["saved_by_route"] + row["saved_by_speed"])
    middle = rows[len(rows) // 2]
    assert middle["saved_by_route"] > 0.5 * middle["saved"] > 0.0


@pytest.mark.slow
def test_in_calm_water_neither_part_saves():
    for row in front(Sea.calm()).front.comparison.rows:
        assert row["saved_by_route"] == pytest.approx(0.0, abs=1e-6 * row["value"])


def test_a_cheaper_route_for_comparison_is_explained():
    """At 12 h it costs 99 where the front costs 110, and at 9 h the front has no route."""
    front = [SimpleNamespace(time_h=10.0), SimpleNamespace(time_h=14.0)]
    blind = [
        SimpleNamespace(time_h=12.0, arrive=12.0, feasible=True),
        SimpleNamespace(time_h=9.0, arrive=9.0, feasible=True),
    ]
    values = np.array([120.0, 100.0])
    note = undercut_note(front, values, blind, np.array([99.0, 50.0]), np.inf)
    assert note is not None and "up to 10 % better" in note and "traffic lanes" in note
    assert undercut_note(front, values, blind, np.array([110.0, 50.0]), np.inf) is None
    assert undercut_note(front, values, blind, np.array([99.0, 50.0]), 11.0) is None  # late
    blind[0].feasible = False
    assert undercut_note(front, values, blind, np.array([99.0, 50.0]), np.inf) is None


class Tabulated:
    """An evaluator with a score for each track and setting: (time, cost, violation)."""

    settings = 2

    def __init__(self, scores):
        self.scores = scores

    def __call__(self, genomes):
        rows = [self.scores[int(genome.setting[0])][k] for k, genome in enumerate(genomes)]
        return tuple(np.array(rows, float).T)


def test_a_constant_speed_is_sailed_on_its_cheapest_and_fastest_track():
    tracks = [Track([0.0, lat, 0.0], [0.0, 1.0, 2.0], 0.0, None, [0, 1]) for lat in (0.0, 0.1, 0.2)]
    slow = [(30.0, 5.0, 0.0), (31.0, 4.0, 0.0), (29.0, 3.9, 0.1)]  # the last is not feasible
    fast = [(21.0, 8.0, 0.0), (20.0, 7.0, 0.0), (22.0, 9.0, 0.0)]
    found = constant_speed_tracks(tracks, np.arange(2), Tabulated([slow, fast]))
    assert [(k, track.setting.tolist()) for k, track in found] == [
        (0, [0, 0]),
        (1, [0, 0]),
        (1, [1, 1]),
    ]
    closed = [(1.0, 1.0, 1.0)] * 3
    assert constant_speed_tracks(tracks, np.arange(2), Tabulated([closed, closed])) == []


def test_the_constant_speed_of_least_cost_is_sailed_beside_the_evenly_spread_ones():
    """Gdynia - Rotterdam was planned at 14.3 kn, where 14.1 kn cost 0.6 % less."""
    tracks = [Track([0.0, 0.0, 0.0], [0.0, 1.0, 2.0], 0.0, None, [0, 1])]
    scores = [[(30.0 - k, 100.0 + (k - 3) ** 2, 0.0)] for k in range(12)]
    found = constant_speed_tracks(tracks, np.arange(12), Tabulated(scores))
    assert [int(track.setting[0]) for _, track in found] == [0, 2, 3, 4, 7, 9, 11]
