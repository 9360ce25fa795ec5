"""Speeds in blocks that a bridge can order."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, evaluate
from thalweg.core.limits import Limits
from thalweg.core.objective import FUEL_MASS
from thalweg.core.units import KNOT
from thalweg.planning.pareto.cheapest_blocks import (
    BlockShift,
    block_durations,
    cheapest_blocks,
    cheapest_shift,
)
from thalweg.planning.pareto.speed_blocks import in_speed_blocks, merged_settings
from thalweg.planning.pareto.trade_off_context import RefereedCandidate, TrackCandidate
from thalweg.route import Track

SPEEDS = np.array([9.9, 14.1])
DEPART = 1767225600.0  # 2026-01-01


def test_a_short_leg_between_legs_of_one_speed_takes_theirs():
    setting, hours = np.array([0, 1, 0, 0]), np.array([7.0, 0.2, 3.0, 5.0])
    assert merged_settings(setting, hours, SPEEDS, 6.0, late=True).tolist() == [0, 0, 0, 0]


def test_long_blocks_stay_as_they_are():
    setting, hours = np.array([0, 0, 1, 1]), np.array([3.0, 3.0, 4.0, 2.5])
    assert merged_settings(setting, hours, SPEEDS, 6.0, late=False).tolist() == [0, 0, 1, 1]


@pytest.mark.parametrize("seed", range(20))
def test_merged_blocks_last_and_are_not_late_if_they_must_not(seed):
    draw = np.random.default_rng(seed)
    setting, hours = draw.integers(0, 4, 30), draw.uniform(0.1, 4.0, 30)
    speeds = np.array([8.0, 10.0, 12.0, 14.0])
    for late in (True, False):
        merged = merged_settings(setting, hours, speeds, 6.0, late=late)
        lasting = block_durations(merged, hours)
        assert len(lasting) == 1 or lasting.min() >= 6.0
        time = (hours * speeds[setting] / speeds[merged]).sum()
        assert abs(time / hours.sum() - 1.0) < 0.35
    assert set(merged) <= set(setting)


def test_cheapest_speeds_without_a_least_time_are_the_cheapest_of_each_piece():
    """Blocks of one piece exist also beside pieces that some speeds cannot sail."""
    draw = np.random.default_rng(5)
    for _ in range(20):
        time = draw.uniform(0.5, 1.5, (6, 1)) / np.array([1.0, 1.3, 1.7])
        cost = draw.uniform(0.5, 1.5, (6, 3))
        time[draw.integers(6), 2] = np.inf
        found = cheapest_blocks(time, cost, 0.0, np.inf)
        cheapest = np.where(np.isfinite(time), cost, np.inf).min(axis=1).sum()
        assert cost[np.arange(6), found].sum() == pytest.approx(cheapest, rel=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_cheapest_blocks_against_all_choices(seed):
    """Within 15 % of the cheapest where few pieces leave few choices, and exact without haste."""
    draw = np.random.default_rng(seed)
    pieces, speeds = 9, np.array([1.0, 1.3, 1.7])
    length = draw.uniform(0.5, 1.5, pieces)
    time = length[:, None] / speeds
    cost = length[:, None] * draw.uniform(0.5, 1.5, (pieces, 1)) * speeds**2
    time[draw.integers(pieces), 2] = np.inf
    every = np.array(np.meshgrid(*[range(3)] * pieces)).reshape(pieces, -1).T
    rows = np.arange(pieces)
    all_time, all_cost = time[rows, every].sum(axis=1), cost[rows, every].sum(axis=1)
    least = 1.5
    held = np.array([block_durations(s, time[rows, s]).min() >= least for s in every])
    allowed = held & np.isfinite(all_time)
    fastest = all_time[allowed].min()
    assert cheapest_blocks(time, cost, least, fastest - 1e-6) is None
    for available in (fastest + 1e-9, 1.15 * fastest, 1.4 * fastest):
        found = cheapest_blocks(time, cost, least, available)
        spent, price = time[rows, found].sum(), cost[rows, found].sum()
        assert spent <= available
        assert block_durations(found, time[rows, found]).min() >= least
        best = all_cost[allowed & (all_time <= available)].min()
        assert best * (1.0 - 1e-12) <= price <= 1.15 * best
    slow = cheapest_blocks(time, cost, least, np.inf)
    assert cost[rows, slow].sum() == pytest.approx(all_cost[allowed].min(), rel=1e-12)


def test_a_short_block_goes_and_its_cost_is_stated():
    """14.1 kn for 2.6 nm between hours at 9.9 kn, in still water."""
    ship = Ship.load("handysize-bulker").with_speeds(SPEEDS * KNOT)
    lon = np.array([0.0, 1.0, 1.0 + 2.6 / 60.0, 2.0])

    def score(track):
        return evaluate(track, ship=ship, sea=Sea.calm(), chart=Chart.open_water())

    context = SimpleNamespace(
        voyage=Voyage(start=(0, 0), goal=(0, 2), depart=DEPART, objective="fuel"),
        ship=ship,
        sea=Sea.calm(),
        chart=Chart.open_water(),
        table=ship.tabulate(),
        needs=SimpleNamespace(channels=()),
        evaluate=lambda track, terms: score(track),
        latest_arrival=np.inf,
        data_end=np.inf,
    )
    trade_off = SimpleNamespace(
        context=context,
        consumption=ship.tabulate_fuel(),
        limits=Limits(),
        settings=np.arange(2),
        notes=[],
        objective=SimpleNamespace(
            name="fuel", prices=FUEL_MASS, terms=None, value=lambda route: route.fuel_t
        ),
    )
    routes = [
        score(Track(np.zeros(4), lon, DEPART, None, np.array([0, middle, 0]))) for middle in (1, 0)
    ]
    before = [
        RefereedCandidate(TrackCandidate(r.track, "exact", "", r.time_h, r.fuel_t), r, r.fuel_t)
        for r in routes
    ]
    after = in_speed_blocks(trade_off, before)
    assert [len(item.route.track) for item in after] == [2, 4]  # two waypoints suffice
    assert after[0].route.fuel_t == pytest.approx(routes[1].fuel_t, rel=1e-6)
    (note,) = trade_off.notes
    assert (
        note.startswith("Speeds are ordered in blocks of at least 6 h")
        and "0.0 % to the fuel" in note
    )
    context.voyage = replace(context.voyage, method="exact")
    assert in_speed_blocks(trade_off, before) == before
    context.voyage = replace(context.voyage, speed_block_h=6.0)  # once without effect
    assert len(in_speed_blocks(trade_off, before)[0].route.track) == 2
    context.latest_arrival = routes[0].arrive  # in time only with the short block
    kept = in_speed_blocks(trade_off, before[:1])
    assert kept[0] is before[0]
    assert "keep shorter ones" in trade_off.notes[-1]


def test_the_boundary_of_two_blocks_takes_the_time_that_is_left():
    """Four pieces of 10 h at the slow setting 0 and 8 h at the fast one; 1 h is left."""
    time, cost = np.tile([10.0, 8.0], (4, 1)), np.tile([3.0, 5.0], (4, 1))
    for setting, expected in (
        ([0, 0, 1, 1], BlockShift(2, 0.5, (0, 1))),  # half of the first fast piece becomes slow
        ([1, 1, 0, 0], BlockShift(1, 0.5, (1, 0))),
    ):
        setting = np.array(setting)
        assert cheapest_shift(setting, time, cost, 12.0, 37.0) == expected
        assert cheapest_shift(setting, time, cost, 13.0, 37.0) is None  # 12 h of the fast block
        assert cheapest_shift(setting, time, cost, 12.0, 36.0) is None  # no time is left
    assert cheapest_shift(np.ones(4, int), time, cost, 12.0, 37.0) is None  # one block


def test_a_boundary_is_not_moved_where_that_costs_more():
    time, cost = np.tile([10.0, 8.0], (4, 1)), np.tile([6.0, 5.0], (4, 1))
    assert cheapest_shift(np.array([0, 0, 1, 1]), time, cost, 1.0, 37.0) is None
