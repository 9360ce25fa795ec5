"""Warnings of ships that stem a current, and the departures of a window."""

import math
from dataclasses import replace

import numpy as np
import pytest

from thalweg import Sea, Ship, Voyage, evaluate, plan
from thalweg.core.units import KNOT
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.planning.report.waiting_report import (
    WAITS_TO_LEAVE,
    stemming_warnings,
    stream_warnings,
    unknown_current_warnings,
    window_notes,
)
from thalweg.route import Track

BEGIN = 1767225600.0  # 2026-01-01 [s since 1970]


def with_current_of(eastward_kn):
    """Return a route of a ship of 10 kn eastwards, with a current over 0.1 degree."""
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, y, x: np.where(
                (x > -4.6) & (x < -4.5), eastward_kn * KNOT, 0.0
            ),
            "northward_sea_water_velocity": lambda t, y, x: 0.0 * t,
        }
    )
    return evaluate(
        [(0.0, -5.0), (0.0, -4.0)], ship=Ship.simple(speed_kn=10.0), sea=sea, depart="2026-01-01"
    )


@pytest.mark.parametrize(("along_kn", "begin"), [
    (9.0, "Strong stream: 9.0 kn"), (7.5, ""), (-8.8, "Strong stream: 8.8 kn"),
    (-9.5, "Stems the current"), (0.0, ""),
])  # fmt: skip
def test_a_stream_nearly_as_fast_as_the_ship_is_stated(along_kn, begin):
    notes = stream_warnings(with_current_of(along_kn))
    assert len(notes) == bool(begin)
    for note in notes:
        assert note.startswith(begin)
        assert count_of_dangers([note]) == 1
        assert "the ship makes 10.0 kn through the water" in note or begin.startswith("Stems")


@pytest.mark.parametrize(("against_kn", "warned"), [(9.5, True), (8.8, False), (-3.0, False)])
def test_a_ship_that_stems_a_current_is_warned_of(against_kn, warned):
    """Over 0.1 degree of longitude a ship of 10 kn makes 0.5 kn for 12 h."""
    route = with_current_of(-against_kn)
    notes = stemming_warnings(route)
    assert len(notes) == warned
    for note in notes:
        assert note.startswith("Stems the current: less than 1 kn over ground for ")
        assert "down to 0.5 kn at 00 00.0N 004 3" in note
        assert count_of_dangers([note]) == 1


def test_departures_of_a_window_are_listed():
    day = 86400.0
    departures = [(k * day, (80.0 + k) * 3600.0 if k < 9 else math.inf) for k in range(13)]
    (note,) = window_notes(departures, (3600.0, 1800.0))
    assert note.startswith("Departures in the window and how long the voyage takes")
    assert ", 7 of 13 tried: 1969-12-31 23:00 UTC 3 d 9 h 30 min; 1970-01-02 23:00 UTC" in note
    assert (
        note.endswith("1970-01-12 23:00 UTC no arrival in the hours searched.")
        and note.count(";") == 6
    )
    assert window_notes(departures[:1], (0.0, 0.0)) == window_notes([], (0.0, 0.0)) == []


def sea_with_currents_from_two_hours_on():
    """Return a sea of 0.2 m/s eastwards whose current is unknown before 02:00."""
    return Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, y, x: np.where(
                t < BEGIN + 7200.0, np.nan, 0.2
            ),
            "northward_sea_water_velocity": lambda t, y, x: 0.0 * t,
        }
    )


def test_a_wait_for_an_unknown_current_is_no_wait_for_a_tide():
    track = Track([0.0, 0.0, 0.0], [-5.0, -4.98, -4.9], BEGIN, wait=[0.0, 9000.0, 0.0])
    sea = sea_with_currents_from_two_hours_on()
    route = evaluate(track, ship=Ship.simple(speed_kn=10.0), sea=sea, strict=False)
    times = np.linspace(BEGIN + 600.0, BEGIN + 9600.0, 31)
    current = np.where(times < BEGIN + 7200.0, np.nan, 0.0)
    samples = {"leg": np.ones(31, int), "time": times, "eastward_sea_water_velocity": current}
    (note,) = unknown_current_warnings(replace(route, wait_samples=samples))
    assert note.startswith("Waits at sea at 0.0000N 4.9800W since the data have no current there")
    assert "from 2026-01-01 00:10 UTC to 2026-01-01 01:55 UTC" in note
    known = {**samples, "eastward_sea_water_velocity": np.zeros(31)}
    assert unknown_current_warnings(replace(route, wait_samples=known)) == []
    assert unknown_current_warnings(replace(route, wait_samples={})) == []


@pytest.mark.slow
def test_a_plan_that_cannot_leave_for_want_of_data_says_so():
    """The current is known from 02:00 on: the wait before is no wait for a tide."""
    sea = sea_with_currents_from_two_hours_on()
    voyage = Voyage(start=(0, -5), goal=(0, -4.5), depart="2026-01-01")
    answer = plan(voyage, ship=Ship.simple(speed_kn=10.0), sea=sea)
    (note,) = (one for one in answer.notes if one.startswith(WAITS_TO_LEAVE))
    assert "at 0.0000N 5.0000W since the data have no current there from 2026-01-01 00:00" in note
    assert count_of_dangers([note]) == 1
