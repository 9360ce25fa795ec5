"""Plans at the offing of the ship, and over shoals or nearer to land where no route exists."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
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
from thalweg.planning.request.shoal_choice import (
    SHOALS_OPENED,
    close_exact_areas,
    close_shoals,
)
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways
from thalweg.route import Route

Planned = TypeVar("Planned")

_CHECK: Final = (
    "The depth layer has one depth in 6 nm, which says little in fjords and among islands. Check "
    "the depths on the chart."
)
#: What is tried where no route exists: the share of the offing that is kept, and round the ends a
#: radius [m] within which a smaller share of it is enough.
_OFFINGS: Final = (
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
_CLOSED: Final = 0.0  # shoals: everywhere except close to the ends
_OPEN: Final = math.inf
_ROUND_ENDS: Final = tuple(miles * NAUTICAL_MILE for miles in (100.0, 250.0))  # where they open
_NEAR_SHARE: Final = 0.3  # of the distance between the ends: what is farther is not near them
_ENCLOSED: Final = 300.0 * NAUTICAL_MILE  # water that ends so near an end leaves it enclosed
#: A plan longer than the way that ships take by this share and this length [m] is a detour.
_DETOUR_SHARE, _DETOUR = 1.3, 30.0 * NAUTICAL_MILE


@dataclass(frozen=True)
class _Attempt:
    """What a plan keeps clear of.

    Attributes
    ----------
    share : Of the offing that is kept.
    radius : Round the ends, within which ``near_share`` of the offing is enough [m]; 0 for none.
    shoals : Radius round the ends in which shoals are open [m].
    areas : Whether named areas of exact outline stay closed where shoals are open.
    """

    share: float
    radius: float
    near_share: float
    shoals: float
    areas: bool = True

    @property
    def is_of_ends(self) -> bool:
        """Whether something is open round the ends."""
        return self.radius > 0.0 or 0.0 < self.shoals < _OPEN


def plan_off_land(
    context: PlanningContext,
    ends: Sequence[Endpoint],
    offing: float,
    run: Callable[[PlanningContext], Planned],
    *,
    length_of: Callable[[Planned], float],
) -> Planned:
    """Plan at an offing with shoals closed; where no route exists, with less of both.

    First round the end that the water does not lead to or from: shoals open there, then the
    distance from land is smaller. Then shoals open everywhere but in named areas of exact outline,
    and the offing is a half, a quarter and none; last these areas open as well.

    Parameters
    ----------
    context : With a chart without an offing.
    offing : [m].
    run : Plans with a context.
    length_of : Returns the length of what was planned [m].

    Raises
    ------
    NoRouteError : If no route exists without an offing either.
    """
    if offing <= 0.0 or context.chart.coastline.is_empty:
        return run(context)
    refusal: NoRouteError | None = None
    detour: Planned | None = None  # round shoals
    usual = math.inf  # length of the way that ships take
    can_close = False
    cut_off = False  # whether the distance from land leaves no way from an end
    enclosed: tuple[int, ...] = ()
    waiting = _attempts(ends)
    while waiting:
        attempt = waiting.pop(0)
        if detour is not None and attempt.shoals < _OPEN:
            continue
        which = enclosed or (0, -1)
        if attempt.shoals < _OPEN and attempt.is_of_ends:
            near_end = cut_off if attempt.radius > 0.0 else bool(enclosed)
            if not (can_close and near_end):
                continue  # what closes the way is not near an end
        kept = attempt.share * offing
        chart = chart_off_land(
            context.chart, ends, kept,
            near_ends=attempt.radius, near_least=attempt.near_share * kept, which=which,
        )  # fmt: skip
        notes = [*context.needs.notes, offing_note(chart, ends, offing)]
        if attempt.shoals < _OPEN:
            round_ends = {number % len(ends): attempt.shoals for number in which if attempt.shoals}
            chart, note, without_way = close_shoals(chart, ends, round_ends=round_ends)
            can_close = can_close or bool(note or without_way)
            cut = [n for n in (0, -1) if n % len(ends) in without_way and n not in enclosed]
            cut_off, enclosed = cut_off or bool(cut), (*enclosed, *cut)
            if not note:
                continue
            chart, reopened, length = open_sills(chart, ends)
            usual = length or math.inf
            notes += [reopened, note] if reopened else [note]
        elif attempt.areas:
            open_chart, chart = chart, close_exact_areas(chart, ends)
            if chart is open_chart:
                continue
        if can_close and attempt.shoals > _CLOSED:
            longer = 0.0 if detour is None else length_of(detour) - usual
            notes.append(_opened_note(attempt, [ends[number] for number in which], longer))
        limits = replace(context.needs.limits, offing=kept)
        needs = replace(context.needs, limits=limits, notes=tuple(notes))
        try:
            found = run(replace(context, chart=chart, needs=needs))
        except NoRouteError as error:
            if detour is not None:
                return detour
            nearer = isinstance(error, NoPathError) or REASONS[DEPTH] in error.reasons
            if refusal is None and isinstance(error, NoPathError):
                refusal = _closed_way(context, ends)
                if refusal is not None:
                    raise refusal from error
            refusal = refusal or error
            if not nearer:
                break
            before, enclosed = enclosed, _with_enclosed_end(enclosed, error, ends)
            if attempt.is_of_ends and before and enclosed != before:
                waiting.insert(0, attempt)  # once more, with the other end as well
            context.report_progress(_progress_text(attempt, kept))
            continue
        if attempt.shoals < _OPEN and _is_detour(length_of(found), usual):
            detour = found
            context.report_progress("the way round the shoals is much longer than that of ships")
            continue
        return found if detour is None or length_of(found) < length_of(detour) else detour
    if detour is not None:
        return detour
    assert refusal is not None  # the loop returned otherwise
    raise refusal


def shortest_length(routes: Iterable[Route]) -> float:
    """Return the length of the shortest route [m]; inf without routes."""
    return min((route.distance_nm for route in routes), default=math.inf) * NAUTICAL_MILE


def _is_detour(length: float, usual: float) -> bool:
    """Return whether a way [m] is much longer than another one [m]."""
    return length > max(_DETOUR_SHARE * usual, usual + _DETOUR)


def _attempts(ends: Sequence[Endpoint]) -> list[_Attempt]:
    """Return what is tried, in order."""
    length = float(distance(ends[0].lat, ends[0].lon, ends[-1].lat, ends[-1].lon))
    near = _NEAR_SHARE * length
    found = [_Attempt(*_OFFINGS[0], _CLOSED)]
    found += [_Attempt(*_OFFINGS[0], radius) for radius in _ROUND_ENDS if radius <= near]
    found += [_Attempt(*one, _CLOSED) for one in _OFFINGS[1:4] if one[1] <= near]
    offings = [one for one in _OFFINGS if one[1] <= near]
    return found + [_Attempt(*one, _OPEN, areas) for areas in (True, False) for one in offings]


def _with_enclosed_end(
    known: tuple[int, ...], error: NoRouteError, ends: Sequence[Endpoint]
) -> tuple[int, ...]:
    """Return the numbers of the ends that the water does not lead from or to, as far as known.

    The water that the start leads to ends near the start, or near a goal that nothing leads to.
    """
    if error.nearest is None:
        return known
    away = [float(distance(*error.nearest, end.lat, end.lon)) for end in (ends[0], ends[-1])]
    length = float(distance(ends[0].lat, ends[0].lon, ends[-1].lat, ends[-1].lon))
    if min(away) > min(_ENCLOSED, _NEAR_SHARE * length):
        return known
    one = 0 if away[0] <= away[1] else -1
    return known if one in known else (*known, one)


def _opened_note(attempt: _Attempt, ends: Sequence[Endpoint], longer: float) -> str:
    """Return a note on shoals that are open since no route, or one longer [m], is round them."""
    if attempt.shoals == _OPEN:
        but = ", but for named areas of exact outline" if attempt.areas else ""
        why = (
            f"with that water closed the route is {longer / NAUTICAL_MILE:.0f} nm longer"
            if longer > 0.0
            else "with that water closed no route was found"
        )
        return f"{SHOALS_OPENED}{but}: {why}. {_CHECK}"
    names = " and ".join(end.name for end in ends)
    return (
        f"{SHOALS_OPENED} within {attempt.shoals / NAUTICAL_MILE:.0f} nm of {names}: "
        f"with that water closed no route was found. {_CHECK}"
    )


def _progress_text(attempt: _Attempt, kept: float) -> str:
    """Return what an attempt showed; the offing was ``kept`` [m]."""
    if attempt.shoals < _OPEN:
        return "no route round the shoals"
    text = f"no route {kept / NAUTICAL_MILE:.2g} nm off land"
    near = f", less within {attempt.radius / NAUTICAL_MILE:.0f} nm of the ends"
    return text + near if attempt.radius else text


def _closed_way(context: PlanningContext, ends: Sequence[Endpoint]) -> NoRouteError | None:
    """Return an error that names what is closed to the ship on the only way; None if nothing is."""
    return closed_way_error(
        Seaways.of_ship_chart(context.chart), ends, ship_dimensions(context.ship)
    )
