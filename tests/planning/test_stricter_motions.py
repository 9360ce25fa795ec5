"""Limits of motions get stricter with the others while the referee finds them exceeded."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from thalweg.core.errors import NoRouteError
from thalweg.core.limits import TIGHTENING, Limits
from thalweg.planning.indicators import candidate_routes
from thalweg.planning.pareto import exploration
from thalweg.planning.planning_context import PlanningContext, ShipTables
from thalweg.planning.single import stretch
from thalweg.ship import Ship

VESSEL = {
    "name": "small",
    "speeds_kn": [8.0],
    "hull": {
        "length_between_perpendiculars_m": 33.9, "breadth_m": 9.6, "draught_m": 2.8,
        "block_coefficient": 0.62,
    },
    "limits": {"max_vertical_acceleration_m_s2": 1.0},
}  # fmt: skip


@pytest.fixture(scope="module")
def table():
    return Ship.from_dict(VESSEL).tabulate()


def _context(table, **more) -> PlanningContext:
    given = dict.fromkeys(("voyage", "ship", "sea", "chart", "choice"))
    needs = SimpleNamespace(limits=Limits(), notes=())
    return PlanningContext(needs=needs, tables=ShipTables(table, 0), **{**given, **more})


def _route(feasible: bool, time_h: float = 10.0, waiting_h: float = 0.0) -> SimpleNamespace:
    return SimpleNamespace(
        feasible=feasible, violations=(), depart=0.0, arrive=3600.0 * time_h, time_h=time_h,
        waiting_h=waiting_h, track=None,
    )  # fmt: skip


@pytest.mark.slow
def test_kernels_get_the_motions_of_waves_that_are_higher_by_the_margin(table):
    stricter = _context(table).with_stricter_motions(0.05).table
    usual, more = table.kernel_arrays().motions, stricter.kernel_arrays().motions
    assert usual.max() > 0.1
    np.testing.assert_allclose(more, usual / 0.95, rtol=1e-6)
    assert more.dtype == usual.dtype
    calm = Ship.simple(8.0, 5.0).tabulate()  # a ship without such limits
    assert _context(calm).with_stricter_motions(0.05).table is calm


def test_a_stretch_is_tried_with_stricter_motions(monkeypatch, table):
    margins = []

    def tried(context, network, ends, window, limits, seas):
        margins.append(context.table.motions_margin)
        return SimpleNamespace(route=_route(context.table.motions_margin >= 0.05), result=None)

    network = SimpleNamespace(meta=SimpleNamespace(kind="lattice", spacing_m=1000.0))
    monkeypatch.setattr(stretch, "_search_and_refine", tried)
    monkeypatch.setattr(stretch, "network_of_attempt", lambda *given: network)
    monkeypatch.setattr(stretch, "without_unknown_edges", lambda context, own, gaps: own)
    monkeypatch.setattr(stretch, "without_exceeding_paths", lambda context, own, *places: own)
    monkeypatch.setattr(stretch, "_path_on_network", lambda *given: _route(False))
    monkeypatch.setattr(stretch, "_on_points_of_bed", lambda *given: None)
    voyage = SimpleNamespace(latest_arrival=np.inf, arrive_by=None)
    context = _context(table, voyage=voyage)
    monkeypatch.setattr(PlanningContext, "latest_arrival", np.inf)
    found = stretch.plan_stretch(context, None, None, (0.0, 0.0))
    assert found.route.feasible
    assert margins == [0.0, TIGHTENING[2].share, 0.0, TIGHTENING[3].share]
    assert context.table.motions_margin == 0.0


def test_candidates_are_searched_with_stricter_limits_while_the_fastest_breaks_one(
    monkeypatch, table
):
    """A slower candidate that keeps the limits does not end the search for the fastest."""
    rounds = [
        [_route(False, 12.0), _route(True, 26.0)],
        [_route(True, 12.6), _route(True, 20.0)],
    ]
    searched = iter(rounds)
    monkeypatch.setattr(
        candidate_routes, "candidate_routes", lambda own, ways: (next(searched), [], [])
    )
    monkeypatch.setattr(candidate_routes, "canal_notes", lambda *given: [])
    monkeypatch.setattr(PlanningContext, "latest_arrival", np.inf)
    guard = SimpleNamespace(stopped=lambda: False)
    trade_off = _TradeOff(_context(table), Limits(), guard)
    routes, _ = candidate_routes._feasible_candidates(trade_off, [])
    assert [route.time_h for route in routes] == [12.6, 20.0]


@dataclass(frozen=True)
class _TradeOff:
    """What the search of candidates reads and replaces."""

    context: PlanningContext
    limits: Limits
    interrupt_guard: SimpleNamespace


@pytest.mark.parametrize(
    ("planned", "waiting", "expected"),
    [
        (_route(True, 12.6), 13.5, 12.6),
        (_route(False, 12.0), 13.5, 26.1),
        (_route(True, 27.0), 13.5, 26.1),
        (_route(True, 12.6), 0.2, 26.1),
        (None, 13.5, 26.1),
    ],
)
def test_the_fastest_of_a_plan_replaces_one_that_waits(monkeypatch, planned, waiting, expected):
    """For fronts and alternatives alike; the plan must use the same canals."""

    def plan(trade_off):
        if planned is None:
            raise NoRouteError("No route.", "A test.", "None.")
        return SimpleNamespace(route=planned, network=None)

    monkeypatch.setattr(exploration, "_least_time_stretch", plan)
    monkeypatch.setattr(exploration, "canals_used", lambda network, chart: ())
    trade_off = SimpleNamespace(context=SimpleNamespace(chart=None))
    given = _route(True, 26.1, waiting)
    for name, hours in ((exploration.OPEN_SEA, expected), ("Kiel Canal", 26.1)):
        way = SimpleNamespace(name=name)
        assert exploration._fastest_by_plan(trade_off, way, given).time_h == hours
