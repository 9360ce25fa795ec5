"""The fastest paths of one network, shared by several objectives."""

from __future__ import annotations

import math
from dataclasses import dataclass

from thalweg.planning.pareto import search_horizon
from thalweg.planning.pareto.search_horizon import FastestPaths


@dataclass(frozen=True)
class Found:
    """What `FastestPaths` reads of a result."""

    arrive: float

    @property
    def found(self) -> bool:
        """Whether there is a path."""
        return math.isfinite(self.arrive)


def test_a_path_is_searched_again_only_where_it_may_differ(monkeypatch):
    arrivals, searched = {0: 100.0, 1: 50.0}, []

    def search(trade_off, network, sea, setting):
        searched.append((setting, sea))
        return Found(arrivals[setting] if arrivals[setting] <= sea else math.inf)

    monkeypatch.setattr(search_horizon, "fastest_path", search)
    paths = FastestPaths()

    def arrival(until, setting):
        return paths.arrival(None, None, until, until, setting)

    assert math.isinf(arrival(40.0, 1)) and math.isinf(arrival(30.0, 1))
    assert searched == [(1, 40.0)]  # not found by 40: nor by 30
    assert arrival(60.0, 1) == arrival(200.0, 1) == 50.0
    assert searched == [(1, 40.0), (1, 60.0)]  # found by 60: the same in any longer period
    assert math.isinf(arrival(45.0, 1)) and len(searched) == 2  # it arrives at 50
    assert arrival(200.0, 0) == 100.0 and math.isinf(arrival(90.0, 0))
    assert searched[2:] == [(0, 200.0)]
    assert not paths.path(None, None, 90.0, 90.0, 0).found  # with the reasons of that period
    assert searched[3:] == [(0, 90.0)]
    assert arrival(200.0, 0) == 100.0 and len(searched) == 4
