"""A route in every member of an ensemble: spreads, tails, and members it cannot be sailed in."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg import Sea, Ship, evaluate
from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.route import cvar, evaluate_members

EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"
TRACK = [(0.0, 0.0), (0.0, 1.0)]  # along the equator, to the east
SHIP = Ship.simple(speed_kn=10.0)


def current(speed: float, bed: float = 100.0) -> Sea:
    """Return a sea that runs to the east."""
    return Sea.from_functions(
        {
            EAST: lambda t, y, x: speed + 0.0 * t,
            NORTH: lambda t, y, x: 0.0 * t,
            "sea_floor_depth_below_geoid": lambda t, y, x: bed + 0.0 * t,
        }
    )


def test_time_in_every_member_is_that_of_the_referee_and_of_the_sum() -> None:
    speeds = [-1.0, 0.0, 0.5, 2.0]
    sea = Sea.ensemble(*(current(u) for u in speeds))
    told: list[tuple[int, int]] = []
    found = evaluate_members(
        TRACK, ship=SHIP, sea=sea, depart=0.0, progress=lambda *at: told.append(at)
    )
    length = float(found.routes[0].legs["length"].sum())
    exact = [length / (10.0 * KNOT + u) / 3600.0 for u in speeds]
    assert [route.time_h for route in found.routes] == pytest.approx(exact, rel=1e-9)
    assert (
        found.routes[0].time_h == evaluate(TRACK, ship=SHIP, sea=sea.member(0), depart=0.0).time_h
    )
    spread = found.time_h
    assert spread.mean == pytest.approx(np.mean(exact), rel=1e-9)
    assert spread.p10 == pytest.approx(np.percentile(exact, 10), rel=1e-9)
    assert spread.p90 == pytest.approx(np.percentile(exact, 90), rel=1e-9)
    assert spread.cvar == pytest.approx(max(exact), rel=1e-9)  # a tail of 0.4 of a member
    assert spread.count == 4
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert found.infeasible == () and found.notes == ()
    assert found.fuel_t is None and found.cost is None
    assert found.risk("time_h", "cvar") == pytest.approx(spread.cvar, rel=1e-12)
    assert found.risk("time_h", "p90") == pytest.approx(spread.p90, rel=1e-12)
    assert math.isnan(found.risk("fuel_t"))


def test_infeasible_members_are_listed_and_count() -> None:
    sea = Sea.ensemble(current(0.0), current(0.0, bed=5.0), current(-9.0), current(0.5))
    ship = Ship.simple(speed_kn=10.0, draught_m=6.0)
    found = evaluate_members(TRACK, ship=ship, sea=sea, depart=0.0)
    assert len(found.routes) == 4
    assert found.infeasible == (1, 2)
    assert "2 of 4 members" in found.notes[0] and "(1, 2)" in found.notes[0]
    assert "under-keel clearance" in found.notes[0]
    assert found.time_h.count == 2
    assert found.time_h.mean == pytest.approx(
        0.5 * (found.routes[0].time_h + found.routes[3].time_h)
    )
    assert found.values("time_h")[1] == math.inf
    assert found.risk("time_h", "mean") == math.inf
    assert found.risk("time_h", "cvar") == math.inf
    assert found.risk("time_h", "p10") < math.inf
    plain = found.as_dict()
    assert plain["infeasible"] == [1, 2] and plain["time_h"]["members"] == 2


def test_a_route_infeasible_everywhere_has_no_spread() -> None:
    sea = Sea.ensemble(current(-9.0), current(-8.0))
    found = evaluate_members(TRACK, ship=SHIP, sea=sea, depart=0.0)
    assert found.time_h is None
    assert found.risk() == math.inf
    assert str(found) == "Distribution: infeasible in all 2 members"


def test_data_that_end_too_early_make_a_member_infeasible() -> None:
    short = [
        Sea.from_functions(
            {EAST: lambda t, y, x: 0.0 * t, NORTH: lambda t, y, x: 0.0 * t}, period=(0.0, 3600.0)
        )
        for _ in range(2)
    ]
    found = evaluate_members(TRACK, ship=SHIP, sea=Sea.ensemble(*short), depart=0.0)
    assert found.infeasible == (0, 1)


def test_the_tail_equals_a_hand_calculation() -> None:
    assert cvar(range(1, 11), 0.9) == 10.0
    assert cvar(range(1, 11), 0.8) == 9.5
    assert cvar(range(1, 26), 0.9) == pytest.approx((25 + 24 + 0.5 * 23) / 2.5)
    assert cvar([4.0, 1.0, 2.0], 0.0) == pytest.approx(7.0 / 3.0)
    assert cvar([4.0, 1.0], 0.99) == 4.0
    assert math.isnan(cvar([]))
    assert cvar([1.0, math.inf], 0.5) == math.inf


@given(
    st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=40),
    st.floats(0.0, 0.98),
)
def test_the_tail_is_the_least_of_its_definition(values, alpha) -> None:
    """Rockafellar and Uryasev: min over a of a + mean(max(x - a, 0)) / (1 - alpha)."""
    x = np.array(values)
    levels = a = np.unique(x)
    by_level = a + np.maximum(x[None, :] - levels[:, None], 0.0).mean(axis=1) / (1.0 - alpha)
    if (1.0 - alpha) * x.size >= 1.0:
        assert cvar(x, alpha) == pytest.approx(by_level.min(), rel=1e-9, abs=1e-6)
    assert x.mean() - 1e-6 <= cvar(x, alpha) <= x.max() + 1e-6


def test_invalid_arguments_are_refused() -> None:
    sea = Sea.ensemble(current(0.0), current(1.0))
    with pytest.raises(InputError, match="not an ensemble"):
        evaluate_members(TRACK, ship=SHIP, sea=current(0.0), depart=0.0)
    with pytest.raises(InputError, match=r"sea\.member\(i\)"):
        evaluate(TRACK, ship=SHIP, sea=sea, depart=0.0)
    with pytest.raises(InputError, match="tail"):
        evaluate_members(TRACK, ship=SHIP, sea=sea, depart=0.0, alpha=1.0)
    with pytest.raises(InputError, match="strict"):
        evaluate_members(TRACK, ship=SHIP, sea=sea, depart=0.0, strict=True)
    found = evaluate_members(TRACK, ship=SHIP, sea=sea, depart=0.0)
    with pytest.raises(InputError, match="time_h"):
        found.spread("time")
    with pytest.raises(InputError, match="measure"):
        found.risk("time_h", "worst")


def test_the_highest_waves_of_each_member_are_stated() -> None:
    """Also in the members where they are over the limit of the ship."""
    heights = [1.5, 8.0, 3.0]
    members = [
        Sea.from_functions(
            {"sea_surface_wave_significant_height": lambda t, y, x, h=h: h * x + 0.0 * t}
        )
        for h in heights
    ]
    ship = Ship.simple(speed_kn=10.0, max_wave_height_m=5.0)
    found = evaluate_members(TRACK, ship=ship, sea=Sea.ensemble(*members), depart=0.0)
    assert found.infeasible == (1,)
    assert found.highest_waves_m == pytest.approx(heights, rel=1e-6)
    assert found.as_dict()["highest_waves_m"] == list(found.highest_waves_m)
    calm = Sea.ensemble(current(0.0), current(0.5))
    assert evaluate_members(TRACK, ship=SHIP, sea=calm, depart=0.0).highest_waves_m == (None, None)
