"""Voyages by via points that leave later, where they would wait at sea above the limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final, TypeAlias

import numpy as np

from thalweg.core.errors import CoverageError, NoRouteError
from thalweg.core.units import HOUR
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.waiting_report import waiting_weather_texts
from thalweg.planning.single.late_paths import after_wait_at_berth
from thalweg.planning.single.stretch_result import StretchResult
from thalweg.planning.single.waits_above_limits import (
    ARRIVES_LATER,
    MOST_LATER,
    arrives_later_note,
)
from thalweg.route import join as join_routes

Stretches: TypeAlias = list[StretchResult]

_MOST_TRIED: Final = 3  # departures


def by_later_departure(
    context: PlanningContext, stretches: Stretches, planned: Callable[[float], Stretches]
) -> Stretches:
    """Return the stretches of a later departure that waits at sea in weather within the limits.

    The stretches of a voyage are searched one after the other: a wait at a via point shows only
    when they are joined. The ship then leaves later by as long as she waited on the way.

    Parameters
    ----------
    stretches : Of a voyage from a given departure, in order.
    planned : Returns the stretches from a departure [s since 1970].

    Returns
    -------
    list of StretchResult : The given ones where they wait in no such weather, or where no departure
        that is tried arrives at most 30 % of the voyage later.
    """
    if len(stretches) == 1 or not context.voyage.wait or not context.leaves_later:
        return stretches
    route = join_routes([stretch.route for stretch in stretches])
    above = waiting_weather_texts(route, context.ship) if route.feasible else []
    latest = min(route.arrive + MOST_LATER * route.time_h * HOUR, context.latest_arrival)
    tried = route
    for _ in range(_MOST_TRIED if above else 0):
        try:
            later = planned(tried.depart + float(np.sum(tried.track.wait)))
        except (NoRouteError, CoverageError):  # too late for the latest arrival or the data
            break
        tried = join_routes([stretch.route for stretch in later])
        if not tried.feasible or tried.arrive > latest:
            break
        if waiting_weather_texts(tried, context.ship):
            continue
        first = after_wait_at_berth(context, later[0].route, route, route.depart)
        note = arrives_later_note(max(0.0, tried.arrive - route.arrive), above[0])
        notes = [text for text in later[0].notes if not text.startswith(ARRIVES_LATER)]
        return [replace(later[0], route=first, notes=(*notes, note)), *later[1:]]
    return stretches
