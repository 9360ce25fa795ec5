"""Routes of a front that wait once, at the start, and change from one speed to the next once."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from thalweg.planning.pareto.evolutionary_refinement import evaluator_around_routes
from thalweg.planning.pareto.trade_off_context import (
    RefereedCandidate,
    TradeOffContext,
    scored_candidate,
)
from thalweg.planning.pareto.waiting.wait_screening import WaitScreen
from thalweg.planning.pareto.waiting.waits_of_fronts import with_waits_long_enough
from thalweg.route import Route, Track

_SHARES: Final = (0.5, 0.33, 0.67)  # of the way, at the first speed
_SHARES_OF_FRONT: Final = _SHARES[:1]
_EARLIER: Final = 300.0  # than a wait between those at each of the speeds [s]


def two_speeds_after_wait(
    trade_off: TradeOffContext, steady: Sequence[RefereedCandidate]
) -> list[RefereedCandidate]:
    """Return routes between those that hold one speed after one wait at the start.

    The best speed past a tide is between two settings where one comes too late for the tide and
    the other waits for it: the ship sails a part of the way at each.

    Parameters
    ----------
    steady : Routes within the limits, each at one setting, on some lines.

    Returns
    -------
    list of RefereedCandidate
        Within the limits. For one objective beside its best route, for a front between all.
    """

    def score(track: Track) -> Route:
        return trade_off.context.evaluate(track, trade_off.objective.terms)

    if not steady:
        return []
    screen = WaitScreen(evaluator_around_routes(trade_off, [one.route for one in steady]))
    found: list[RefereedCandidate] = []
    for lower, higher, shares in _neighbours(trade_off, steady):
        for track in _mixtures(lower.route.track, higher.route.track, shares):
            if trade_off.interrupt_guard.stopped():
                return found
            route = with_waits_long_enough(trade_off.context, score(track), score, screen)
            value = trade_off.objective.value(route)
            in_time = route.arrive <= trade_off.context.latest_arrival + 1.0
            if route.feasible and in_time and math.isfinite(value):
                candidate = replace(lower.candidate, track=route.track)
                found.append(scored_candidate(trade_off, candidate, route, value))
    return found


def _neighbours(
    trade_off: TradeOffContext, steady: Sequence[RefereedCandidate]
) -> Iterator[tuple[RefereedCandidate, RefereedCandidate, tuple[float, ...]]]:
    """Yield pairs of routes at neighbouring settings on the same line, and shares of the way."""
    by_line: dict[str, dict[int, RefereedCandidate]] = {}
    for one in steady:
        line = by_line.setdefault(one.candidate.alternative, {})
        setting = int(one.route.track.setting[0])
        known = line.get(setting)
        if known is None or one.value < known.value:
            line[setting] = one
    best = min(steady, key=lambda one: one.value, default=None)
    for line in by_line.values():
        for lower, higher in pairwise(sorted(line)):
            pair = line[lower], line[higher]
            if trade_off.context.voyage.objective == "front":
                yield *pair, _SHARES_OF_FRONT
            elif best in pair:
                yield *pair, _SHARES


def _mixtures(lower: Track, higher: Track, shares: Sequence[float]) -> Iterator[Track]:
    """Yield tracks along the line of one track with each of two settings on a part of it."""
    legs = len(lower.setting)
    for share in shares:
        change = round(share * legs)
        if not 0 < change < legs:
            continue
        for first, second in ((lower, higher), (higher, lower)):
            setting = np.full(legs, second.setting[0])
            setting[:change] = first.setting[0]
            wait = np.zeros(len(lower.wait))
            between = share * float(first.wait.sum()) + (1.0 - share) * float(second.wait.sum())
            wait[0] = max(between - _EARLIER, 0.0)
            yield lower.replaced(setting=setting, wait=wait)
