"""Plans at the offing of the ship, and over shoals or nearer to land where no route exists."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final, TypeVar

from thalweg.core.errors import NoPathError, NoRouteError
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.codes import DEPTH, REASONS
from thalweg.planning.network_selection.closed_ways import closed_way_error
from thalweg.planning.network_selection.sill_choice import open_sills
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.offing_choice import (
    chart_off_land,
    offing_note,
    ship_dimensions,
)
from thalweg.planning.request.shoal_choice import SHOALS_OPENED, close_shoals
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways

Planned = TypeVar("Planned")

_OPENED: Final = (
    f"{SHOALS_OPENED}: no route was found that avoids it. Check the depths on the chart."
)
#: What is tried where no route exists: the share of the offing that is kept, and round the first
#: and the last end a radius [m] within which a smaller share of it is enough.
_ATTEMPTS: Final = (
    (1.0, 0.0, 1.0),
    (1.0, 15.0 * NAUTICAL_MILE, 0.25),
    (1.0, 40.0 * NAUTICAL_MILE, 0.25),
    (1.0, 15.0 * NAUTICAL_MILE, 0.0),
    (0.5, 0.0, 1.0),
    (0.25, 0.0, 1.0),
    (1.0, 80.0 * NAUTICAL_MILE, 0.0),
    (1.0, 120.0 * NAUTICAL_MILE, 0.0),
    (0.0, 0.0, 1.0),
)


_NEAR_SHARE: Final = 0.3  # of the distance between the ends: what is farther is not near them


def plan_off_land(
    context: PlanningContext,
    ends: Sequence[Endpoint],
    offing: float,
    run: Callable[[PlanningContext], Planned],
) -> Planned:
    """Plan at an offing with shoals closed; where no route exists, with these open.

    Where none exists either, nearer to land round the ends, then at half of the offing, a quarter,
    and without.

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
    was_closed = False
    length = float(distance(ends[0].lat, ends[0].lon, ends[-1].lat, ends[-1].lon))
    tried = [one for one in _ATTEMPTS if one[1] <= _NEAR_SHARE * length]
    attempts = (1.0, 0.0, 1.0, True), *((*one, False) for one in tried)
    for share, radius, near_share, closing in attempts:
        kept = share * offing
        chart = chart_off_land(
            context.chart, ends, kept, near_ends=radius, near_least=near_share * kept
        )
        notes = [*context.needs.notes, offing_note(chart, ends, offing)]
        if closing:
            chart, note = close_shoals(chart, ends)
            if not note:
                continue
            chart, reopened = open_sills(chart, ends)
            notes += [reopened, note] if reopened else [note]
            was_closed = True
        elif was_closed:
            notes.append(_OPENED)
        limits = replace(context.needs.limits, offing=kept)
        needs = replace(context.needs, limits=limits, notes=tuple(notes))
        try:
            return run(replace(context, chart=chart, needs=needs))
        except NoRouteError as error:
            nearer = isinstance(error, NoPathError) or REASONS[DEPTH] in error.reasons
            if refusal is None and isinstance(error, NoPathError):
                refusal = _closed_way(context, ends)
                if refusal is not None:
                    raise refusal from error
            refusal = refusal or error
            if not nearer:
                break
            context.report_progress(
                "no route round the shoals"
                if closing
                else f"no route {kept / NAUTICAL_MILE:.2g} nm off land"
                + (f", less within {radius / NAUTICAL_MILE:.0f} nm of the ends" if radius else "")
            )
    assert refusal is not None  # the loop returned otherwise
    raise refusal


def _closed_way(context: PlanningContext, ends: Sequence[Endpoint]) -> NoRouteError | None:
    """Return an error that names what is closed to the ship on the only way; None if nothing is."""
    return closed_way_error(
        Seaways.of_ship_chart(context.chart), ends, ship_dimensions(context.ship)
    )
