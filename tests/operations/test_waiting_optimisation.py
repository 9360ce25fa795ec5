"""Waiting rules and the optimum, against brute force and against each other."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.errors import CoverageError, InputError
from thalweg.operations.waiting.trip_table import TripTable
from thalweg.operations.waiting.waiting_optimisation import (
    DEPARTURE_RULES,
    optimum_energy,
    plan_waiting,
)
from thalweg.operations.waiting.waiting_study import break_even_power, waiting_study

STEP = 60.0


def table(rng, count, *, closed=0.0, periodic=True, name="trip"):
    duration = rng.uniform(0.2 * STEP, 6.0 * STEP, count)
    energy = rng.uniform(1e6, 2e6, count)
    shut = rng.random(count) < closed
    shut[rng.integers(count)] = False
    duration[shut] = energy[shut] = np.inf
    return TripTable(name, 0.0, STEP, duration, energy, rng.normal(size=count), periodic)


def brute_force(trips, ready, width, hotel):
    """Try every sequence of departures."""
    best = np.inf

    def sail(k, ready, energy):
        nonlocal best
        if k == len(trips):
            best = min(best, energy)
            return
        trip, n = trips[k], len(trips[k])
        reach = range(ready, ready + n) if trip.periodic else range(ready, n)
        allowed = [s for s in reach if np.isfinite(trip.duration[s % n])]
        for s in allowed:
            if s > allowed[0] + width:
                break
            took = trip.duration[s % n] / STEP
            took = took if k == len(trips) - 1 else int(np.ceil(took - 1e-9))
            after = s + int(np.ceil(took))
            if not trip.periodic and after >= n and k < len(trips) - 1:
                continue
            sail(k + 1, after, energy + trip.energy[s % n] + hotel * STEP * (s - ready + took))

    sail(0, ready, 0.0)
    return best


@given(
    seed=st.integers(0, 2**31),
    width=st.integers(0, 5),
    hotel=st.floats(0.0, 5e4),
    closed=st.sampled_from([0.0, 0.4]),
)
def test_the_optimum_is_that_of_brute_force(seed, width, hotel, closed):
    rng = np.random.default_rng(seed)
    out, back = table(rng, 9, closed=closed), table(rng, 9, closed=closed)
    trips = [out, back, out]
    start = int(rng.integers(0, 9))
    plan = plan_waiting(trips, start=start * STEP, max_wait=width * STEP, hotel_power=hotel)
    expected = brute_force(trips, start, width, hotel)
    assert plan.energy == pytest.approx(expected, rel=1e-12)
    from_all = optimum_energy(trips, max_wait=width * STEP, hotel_power=hotel)
    assert from_all[start] == pytest.approx(expected, rel=1e-12)


@given(seed=st.integers(0, 2**31), width=st.integers(0, 4), hotel=st.floats(0.0, 5e4))
def test_the_optimum_of_a_table_that_ends_is_that_of_brute_force(seed, width, hotel):
    rng = np.random.default_rng(seed)
    trips = [table(rng, 20, periodic=False) for _ in range(3)]
    expected = brute_force(trips, 0, width, hotel)
    if np.isinf(expected):
        with pytest.raises(CoverageError):
            plan_waiting(trips, start=0.0, max_wait=width * STEP, hotel_power=hotel)
        return
    plan = plan_waiting(trips, start=0.0, max_wait=width * STEP, hotel_power=hotel)
    assert plan.energy == pytest.approx(expected, rel=1e-12)


@given(
    seed=st.integers(0, 2**31),
    cycles=st.integers(1, 5),
    wait=st.integers(0, 60),
    hotel=st.floats(0.0, 1e5),
)
def test_no_plan_is_better_than_the_optimum(seed, cycles, wait, hotel):
    rng = np.random.default_rng(seed)
    trips = [table(rng, 40, closed=0.1), table(rng, 40, closed=0.1)] * cycles
    asked = {"start": 7 * STEP, "max_wait": wait * STEP, "hotel_power": hotel}
    energy = {rule: plan_waiting(trips, rule=rule, **asked).energy for rule in DEPARTURE_RULES}
    assert all(energy["optimum"] <= e * (1 + 1e-12) for e in energy.values())
    longer = plan_waiting(trips, start=7 * STEP, max_wait=(wait + 9) * STEP, hotel_power=hotel)
    assert longer.energy <= energy["optimum"] * (1 + 1e-12)
    one = {r: plan_waiting(trips[:1], rule=r, **asked).energy for r in DEPARTURE_RULES}
    assert one["next trip"] == pytest.approx(one["optimum"], rel=1e-12)
    assert one["next trip"] <= one["none"] * (1 + 1e-12)


@given(seed=st.integers(0, 2**31), rule=st.sampled_from(DEPARTURE_RULES), wait=st.integers(0, 9))
def test_plans_can_be_sailed(seed, rule, wait):
    rng = np.random.default_rng(seed)
    trips = [table(rng, 30, closed=0.3) for _ in range(4)]
    plan = plan_waiting(trips, start=3 * STEP, max_wait=wait * STEP, rule=rule, hotel_power=1e3)
    ready, waited = plan.start, 0.0
    for trip, leave, reach in zip(trips, plan.departs, plan.arrives):
        at = round((leave - trip.start) / STEP)
        assert leave == pytest.approx(at * STEP) and leave >= ready - 1e-6
        assert reach - leave == pytest.approx(trip.duration[at % 30])
        waited += leave - ready
        ready = reach
    assert plan.waited == pytest.approx(waited, abs=1e-6)
    used = sum(t.energy[round(d / STEP) % 30] for t, d in zip(trips, plan.departs))
    assert plan.energy == pytest.approx(used + 1e3 * plan.duration, rel=1e-9)


def test_the_rule_of_the_thesis_looks_at_the_current_alone():
    current = np.sin(2 * np.pi * np.arange(100) / 100)
    flat = TripTable("a", 0.0, STEP, np.full(100, 30.0), np.arange(100.0), current, True)
    for start, most, leaves in (
        (0, 10, 10),
        (0, 50, 25),
        (25, 90, 25),
        (50, 40, 50),
        (50, 75, 125),
    ):
        plan = plan_waiting([flat], start=start * STEP, max_wait=most * STEP, rule="current")
        assert plan.departs[0] == leaves * STEP


def test_waiting_is_possible_into_the_next_period_and_an_infinite_wait_is_one_period():
    cheap = np.full(50, 2.0)
    cheap[3] = 1.0
    trip = TripTable("a", 0.0, STEP, np.full(50, STEP), cheap, cheap, True)
    late = plan_waiting([trip, trip], start=10 * STEP, max_wait=1e12)
    assert late.energy == 2.0
    assert late.departs == (53 * STEP, 103 * STEP)


def test_break_even_power_is_where_saving_and_cost_meet():
    energy = np.full(100, 10e6)
    energy[20:] = 9e6
    trip = TripTable("a", 0.0, STEP, np.full(100, STEP), energy, np.zeros(100), True)
    found = break_even_power([trip], start=0.0, max_wait=30 * STEP)
    assert found == pytest.approx(1e6 / (20 * STEP), rel=2e-3)
    assert break_even_power([trip], start=20 * STEP, max_wait=30 * STEP) == 0.0
    assert break_even_power([trip], start=0.0, max_wait=30 * STEP, largest=500.0) == np.inf


def test_a_study_is_a_table_of_plans():
    rng = np.random.default_rng(1)
    trips = [table(rng, 40, name="there"), table(rng, 40, name="back")] * 2
    study = waiting_study(trips, starts=[0.0, 600.0], max_waits=[0.0, 300.0, 900.0])
    frame = study.to_frame()
    assert len(frame) == 4 * 2 * 3
    assert (study.saving("none") == 0.0).all()
    assert (study.saving("optimum")[:, 0] >= 0.0).all()
    assert (np.diff(study.saving("optimum"), axis=1) >= -1e-12).all()
    best = frame[(frame.rule == "optimum") & (frame.most_wait_h == 0.25)]
    assert best.energy_kwh.to_numpy() * 3.6e6 == pytest.approx(study.energy("optimum")[:, 2])
    assert study.as_dict()["trips"] == ["there", "back"] * 2


def test_what_cannot_be_is_refused():
    rng = np.random.default_rng(2)
    trip = table(rng, 10)
    other = TripTable("b", 0.0, 30.0, trip.duration, trip.energy, trip.current, True)
    for wrong in (
        {"trips": [], "max_wait": 0.0},
        {"trips": [trip, other], "max_wait": 0.0},
        {"trips": [trip], "max_wait": -1.0},
        {"trips": [trip], "max_wait": float("nan")},
        {"trips": [trip], "max_wait": 0.0, "hotel_power": -1.0},
        {"trips": [trip], "max_wait": 0.0, "rule": "optimun"},
    ):
        with pytest.raises(InputError):
            plan_waiting(wrong.pop("trips"), start=0.0, **wrong)
    with pytest.raises(InputError):
        waiting_study([trip], starts=[], max_waits=[0.0])
    never = TripTable("c", 0.0, STEP, *(np.full(5, np.inf),) * 2, np.zeros(5), True)
    for rule in DEPARTURE_RULES:
        with pytest.raises(CoverageError, match="cannot be made at any"):
            plan_waiting([never], start=0.0, max_wait=0.0, rule=rule)
    ends = table(rng, 10, periodic=False)
    for rule, start in itertools.product(DEPARTURE_RULES, (-STEP, 10 * STEP)):
        with pytest.raises(CoverageError):
            plan_waiting([ends], start=start, max_wait=0.0, rule=rule)
