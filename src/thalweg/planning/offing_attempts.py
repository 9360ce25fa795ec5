"""Plans at the offing of the ship, and nearer to land where no route exists at it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final, TypeVar

from thalweg.core.errors import NoPathError, NoRouteError
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.codes import DEPTH, REASONS
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.offing_choice import chart_off_land, offing_note
from thalweg.planning.request.voyage_endpoints import Endpoint

Planned = TypeVar("Planned")

_SHARES: Final = (1.0, 0.5, 0.25, 0.0)  # of the offing that are tried where no route exists


def plan_off_land(
    context: PlanningContext,
    ends: Sequence[Endpoint],
    offing: float,
    run: Callable[[PlanningContext], Planned],
) -> Planned:
    """Plan at an offing; where no route exists, at half of it, a quarter, and without.

    Parameters
    ----------
    context : With a chart without an offing.
    offing : [m].
    run : Plans with a context.

    Raises
    ------
    NoRouteError : If no route exists without an offing either.
    """
    if offing <= 0.0 or context.chart.coastline.is_empty:
        return run(context)
    refusal: NoRouteError | None = None
    for share in _SHARES:
        kept = share * offing
        tried = replace(context, chart=chart_off_land(context.chart, ends, kept))
        limits = replace(context.needs.limits, offing=kept)
        notes = (*context.needs.notes, offing_note(tried.chart, ends, offing))
        tried = replace(tried, needs=replace(context.needs, limits=limits, notes=notes))
        try:
            return run(tried)
        except NoRouteError as error:
            nearer = isinstance(error, NoPathError) or REASONS[DEPTH] in error.reasons
            refusal = refusal or error
            if not nearer:
                break
            context.report_progress(f"no route {kept / NAUTICAL_MILE:.2g} nm off land")
    assert refusal is not None  # the loop returned otherwise
    raise refusal
