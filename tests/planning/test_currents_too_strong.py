"""Departures after a current that the ship cannot hold against, and routes that never arrive."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thalweg import NoRouteError
from thalweg.core.units import HOUR
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.single.currents_too_strong import leaving_after_current
from thalweg.planning.single.stretch_result import StretchResult
from thalweg.planning.single.weather_gaps import check_times_known
from thalweg.route import Track
from thalweg.route.route import Violation

STOP = Violation("current too strong to hold the course", 7.0 * HOUR, 58.7, -3.0)


def _route(depart: float, *, arrives: bool) -> Any:
    track = Track.from_positions([(58.6, -2.5), (58.6, -4.0)], depart=depart)
    return SimpleNamespace(
        track=track, depart=depart, time_h=5.0 if arrives else math.nan, feasible=arrives,
        violations=() if arrives else (STOP,),
    )  # fmt: skip


def _stretch(route: Any) -> StretchResult:
    return StretchResult(route, "result of the search", None, np.zeros(1), ("own note",))  # type: ignore[arg-type]


def _context(*, wait: bool = True, opens: float = 0.0) -> Any:
    """Return a context of which the strait opens for a departure [h]."""

    def evaluate(track: Track) -> Any:
        leaves = track.depart + float(track.wait[0])
        found = _route(track.depart, arrives=leaves >= opens * HOUR)
        found.track = track
        return found

    return SimpleNamespace(
        voyage=SimpleNamespace(wait=wait), evaluate=evaluate, report_progress=lambda text: None
    )


@pytest.mark.parametrize(("opens", "wait_h"), [(0.2, 0.25), (0.9, 1.0), (5.5, 6.0)])
def test_the_ship_leaves_when_the_stream_has_eased(opens, wait_h):
    tried = []

    def search(window):
        tried.append(window[0] / HOUR)
        return _stretch(_route(window[0], arrives=window[0] >= opens * HOUR))

    first = _stretch(_route(0.0, arrives=False))
    found = leaving_after_current(_context(opens=opens), first, (0.0, 0.0), search)
    assert found.route.feasible and found.route.track.wait[0] == wait_h * HOUR
    assert found.route.depart == 0.0 and tried[-1] == wait_h
    assert found.result == first.result
    assert found.notes[-1].startswith("Leaves ") and "58 42.0N 003 00.0W" in found.notes[-1]


def test_ships_that_may_not_wait_and_other_refusals_are_left_as_they_are():
    first = _stretch(_route(0.0, arrives=False))
    assert leaving_after_current(_context(wait=False), first, (0.0, 0.0), pytest.fail) is first
    assert leaving_after_current(_context(), first, (0.0, 9.0), pytest.fail) is first
    arrived = _stretch(_route(0.0, arrives=True))
    assert leaving_after_current(_context(), arrived, (0.0, 0.0), pytest.fail) is arrived
    never = leaving_after_current(
        _context(opens=99.0), first, (0.0, 0.0), lambda window: _stretch(_route(0.0, arrives=False))
    )
    assert never is first


def test_a_route_that_never_arrives_is_refused():
    ends = Endpoint("Invergordon", 57.7, -4.1, 0.0), Endpoint("Stornoway", 58.2, -6.4, 0.0)
    with pytest.raises(
        NoRouteError, match="current too strong to hold the course at 58 42"
    ) as found:
        check_times_known(_route(0.0, arrives=False), *ends)
    assert found.value.reasons == {"current too strong to hold the course": 1}
    check_times_known(_route(0.0, arrives=True), *ends)
