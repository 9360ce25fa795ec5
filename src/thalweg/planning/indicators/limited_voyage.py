"""Plans of voyages with limits of indicators over the whole route, by all ways that are known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError
from thalweg.planning.indicators.alternative_plans import alternative_plans
from thalweg.planning.pareto.limited_plan import plan_within_limits
from thalweg.planning.plan import Plan
from thalweg.planning.voyage import Voyage
from thalweg.route import Route
from thalweg.sea import Sea
from thalweg.ship import Ship


def plan_limited_voyage(
    voyage: Voyage,
    ship: Ship,
    sea: Sea,
    chart: Chart,
    plan_one: Callable[..., Plan],
    **options: Any,
) -> Plan:
    """Plan a voyage whose route keeps limits of indicators.

    Parameters
    ----------
    voyage : With ``at_most`` or ``at_least``.
    plan_one : Plans a voyage without such limits, with these options, by ``ship``, ``sea`` and
        ``chart``.
    **options : ``network``, ``resolution`` and ``progress`` of `thalweg.plan`.

    Raises
    ------
    InputError : In an ensemble forecast, and as `plan_within_limits`.
    NoRouteError : If no route keeps the limits, of the plans and of the alternatives.
    """
    if sea.members:
        raise InputError(
            "Indicators of the whole route are limited, in an ensemble forecast.",
            "Such limits are for one forecast.",
            "Leave out at_most and at_least, or give one member.",
            field="at_most",
        )

    def other_routes() -> Sequence[Route]:
        if options["progress"] is not None:
            options["progress"]("no route keeps the limits: comparing other ways")
        try:
            found = alternative_plans(voyage, ship=ship, sea=sea, chart=chart, **options)
        except (InputError, NoRouteError):  # alternatives do not exist for every voyage
            return ()
        return [one.route for one in found.choices]

    return plan_within_limits(
        voyage, partial(plan_one, ship=ship, sea=sea, chart=chart), other_routes
    )
