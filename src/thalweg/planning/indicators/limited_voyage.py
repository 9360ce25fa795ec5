"""Plans of voyages with limits of indicators over the whole route, by all ways that are known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError
from thalweg.planning.indicators.alternative_plans import alternative_plans
from thalweg.planning.pareto.indicator_limit import IndicatorLimit
from thalweg.planning.pareto.limited_plan import plan_within_limits
from thalweg.planning.pareto.speed_blocks import SHARE_OF_PASSAGE
from thalweg.planning.plan import Plan
from thalweg.planning.voyage import Voyage
from thalweg.route import Route
from thalweg.route.indicator_columns import indicator_value
from thalweg.sea import Sea
from thalweg.ship import Ship

_MUCH_LEFT: Final = 0.02  # share of a limit for which shorter blocks of speed are tried
_WORTHWHILE: Final = 2e-3  # gain of time for which they are taken


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

    plan_free = partial(plan_one, ship=ship, sea=sea, chart=chart)
    found = plan_within_limits(voyage, plan_free, other_routes)
    if voyage.objective != "time" or not _left_of_limits(voyage, found.best) > _MUCH_LEFT:
        return found
    block = SHARE_OF_PASSAGE * found.best.time_h
    if not 0.0 < min(voyage.least_speed_block_h, block) < found.best.time_h:
        return found
    shorter = replace(voyage, speed_block_h=0.5 * min(voyage.least_speed_block_h, block))
    try:
        other = plan_within_limits(shorter, plan_free, other_routes)
    except NoRouteError:
        return found
    if not other.best.time_h < (1.0 - _WORTHWHILE) * found.best.time_h:
        return found
    note = (
        f"Blocks of speed are {shorter.speed_block_h:.1f} h here: longer ones leave "
        f"{100.0 * _left_of_limits(voyage, found.best):.0f} % of a limit and take "
        f"{found.best.time_h - other.best.time_h:.1f} h more. --speed-block sets another time."
    )
    return replace(other, voyage=voyage, notes=(note, *other.notes))


def _left_of_limits(voyage: Voyage, route: Route) -> float:
    """Return the least share that a route leaves of the limits at most; 0 without such limits."""
    limits = [one for one in IndicatorLimit.of_voyage(voyage) if one.sense > 0 and one.value > 0.0]
    left = [1.0 - indicator_value(route, one.name, one.at) / one.value for one in limits]
    return min(left, default=0.0)
