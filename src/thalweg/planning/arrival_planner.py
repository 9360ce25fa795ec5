"""Plans that arrive at a given time: by the speed, or by the departure."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoPathError, NoRouteError, OutsidePeriodError
from thalweg.core.geodesy import distance
from thalweg.core.time import duration_text, format_time, utc_text
from thalweg.core.units import HOUR, KNOT
from thalweg.planning.plan import Plan
from thalweg.planning.plan_data import Proof
from thalweg.planning.request.ordered_speed import with_exact_speed
from thalweg.planning.request.requirements import period_of_data, required_under_keel_clearance
from thalweg.planning.request.voyage_endpoints import resolve_endpoint
from thalweg.planning.single.arrival_search import (
    AIM,
    EARLY,
    LATE,
    ArrivalSearch,
    solve_arrival,
    whole_answer,
)
from thalweg.planning.voyage import Voyage
from thalweg.route import Route, Track, evaluate
from thalweg.route.ground_speed import ENGINE_ORDER, at_constant_ground_speed
from thalweg.sea import Sea
from thalweg.ship import Ship

_NEAR_SPEED = 0.005  # [m/s]: two trials nearer to a jump of the arrivals than that are enough
_TRIED_BEFORE = 13.0 * HOUR  # a tide: departures before the first guess, where that has no route
_LONGEST_RATIO = 10.0  # of the time before the arrival that is searched, over the passage
_LEAST_SPEED_RATIO = 0.5  # of the slowest setting of the ship file


@dataclass(frozen=True)
class ArrivalRequest:
    """A voyage that arrives at a given time, with its data.

    Attributes
    ----------
    voyage : With `arrive`.
    plan_one : Plans a voyage without `arrive` for a ship; trials have no proof, and no later
        departure where the ship waits in weather above her limits.
    report : Is called with a short text before each trial.
    """

    voyage: Voyage
    ship: Ship
    sea: Sea
    chart: Chart
    plan_one: Callable[[Voyage, Ship, bool], Plan]
    report: Callable[[str], None] = lambda text: None

    @property
    def arrive(self) -> float:
        """Time of arrival [s since 1970]."""
        return float(self.voyage.arrive)  # type: ignore[arg-type]

    def at_speed(self, speed: float) -> Ship:
        """Return the ship that holds a speed [m/s] as the voyage orders."""
        return with_exact_speed(self.ship, speed / KNOT, self.voyage.hold)

    def sail(
        self, plan: Plan, ship: Ship, depart: float | None = None, *, within_limits: bool = False
    ) -> float:
        """Return the arrival [s since 1970] on the track of a plan.

        Returns
        -------
        float : inf where the track does not end, and within limits also where it breaks one.
        """
        clearance = required_under_keel_clearance(self.voyage, ship) if within_limits else None
        route = evaluate(
            plan.best.track.replaced(setting=None, speed=None),
            ship=ship,
            sea=self.sea,
            chart=self.chart,
            depart=depart,
            min_ukc=clearance,
            strict=False,
        )
        counts = math.isfinite(route.arrive) and (route.feasible or not within_limits)
        return route.arrive if counts else math.inf


def plan_arrival(request: ArrivalRequest) -> Plan:
    """Plan a voyage that arrives at the time of its request.

    With an objective that chooses the speeds this is the latest arrival. Otherwise one speed or
    power is held: with a departure it is found so that the ship arrives in the minute before the
    time; without one the latest departure is found.

    Returns
    -------
    Plan : Its notes state what is held.

    Raises
    ------
    InputError : If the sea is an ensemble, or the ship cannot hold what is ordered.
    NoRouteError : If the ship cannot arrive at this time; the error says when it can.
    OutsidePeriodError : If the data do not cover the voyage.
    """
    if request.sea.members:
        raise InputError(
            "A time of arrival was requested for an ensemble of forecasts.",
            "Each member of it gives another arrival.",
            "Use one member, or give the latest arrival with arrive_by.",
            field="arrive",
        )
    _check_end_of_data(request)
    voyage = request.voyage
    if voyage.chooses_speeds:
        limited = replace(voyage, arrive=None, arrive_by=request.arrive)
        found = request.plan_one(limited, request.ship, True)
        note = (
            "The speeds are chosen leg by leg; the ship arrives at the requested time or before it."
        )
    elif voyage.depart is None:
        found, note = _latest_departure(request)
    else:
        found, note = _at_found_speed(request)
    return replace(found, voyage=voyage, notes=(note, *found.notes))


def _check_end_of_data(request: ArrivalRequest) -> None:
    first, last = period_of_data(request.ship, request.sea)
    if not first < request.arrive <= last:
        raise OutsidePeriodError(
            f"The arrival {format_time(request.arrive)} is outside the data.",
            f"The data run from {format_time(first)} to {format_time(last)}.",
            "Choose an arrival in that period, or add data.",
            field="arrive_by",
        )


def _at_found_speed(request: ArrivalRequest) -> tuple[Plan, str]:
    """Return the plan at the speed that arrives in time, and a note that states it."""
    top, low = float(request.ship.speeds[-1]), _lowest_speed(request)
    fixed = replace(request.voyage, arrive=None, hold=None)

    def plan_at(speed: float, *, proven: bool = False) -> Plan:
        if not proven:
            request.report(f"trying {speed / KNOT:.2f} kn")
        return request.plan_one(fixed, request.at_speed(speed), proven)

    def arrival_on(plan: Plan, speed: float) -> float:
        return request.sail(plan, request.at_speed(speed))

    fastest = plan_at(top)
    slow_arrival = arrival_on(fastest, low)
    if slow_arrival < request.arrive - EARLY:  # its waits may be others than at the highest speed
        slow_arrival = _arrival_of_trial(plan_at, low)
    _check_possible(request, fastest, (low, top), slow_arrival)
    # with the sign changed, so that the arrival grows with the value
    search = ArrivalSearch(
        lambda value: plan_at(-value),
        lambda plan, value: arrival_on(plan, -value),
        request.arrive,
        (-top, -low),
        _NEAR_SPEED,
    )
    speed, found = solve_arrival(search, (-top, fastest))
    speed, found = whole_answer(search, speed, lambda value: plan_at(-value, proven=True))
    held = found.best.engine_order or "constant speed"
    if request.voyage.hold == "ground":
        found = _over_ground(request, found)
        held = ENGINE_ORDER
        speed = -_ground_speed(found.best)
    word = {
        "constant power": "Constant power, that of {:.2f} kn in calm water",
        "constant speed": "Constant speed through water of {:.2f} kn",
        ENGINE_ORDER: "Constant speed over ground of {:.2f} kn at sea, set hour by hour",
    }.get(held, "Constant ordered speed of {:.2f} kn")
    return found, f"{word.format(-speed / KNOT)}: {_on_time(found, request)}."


def _arrival_of_trial(plan_at: Callable[[float], Plan], speed: float) -> float:
    """Return the arrival of the plan at a speed; inf where no route is possible at it."""
    try:
        return plan_at(speed).best.arrive
    except NoRouteError:
        return math.inf


def _lowest_speed(request: ArrivalRequest) -> float:
    """Return half the slowest setting [m/s], or that setting where the ship has none below it."""
    slowest = float(request.ship.speeds[0])
    try:
        request.at_speed(_LEAST_SPEED_RATIO * slowest)
    except InputError:
        return slowest
    return _LEAST_SPEED_RATIO * slowest


def _check_possible(
    request: ArrivalRequest, fastest: Plan, speeds: tuple[float, float], slow_arrival: float
) -> None:
    """Raise `NoRouteError` unless the requested time is between the fastest and slowest arrival."""
    low, top = speeds
    arrive = fastest.best.arrive
    if not fastest.best.feasible or not math.isfinite(arrive):
        limit = f": {fastest.best.violations[0]}" if fastest.best.violations else ""
        raise NoRouteError(
            "No route at the highest speed keeps all limits" + limit + ".",
            "The speed is found from that route.",
            "Relax the limits, or give the latest arrival with arrive_by.",
        )
    if arrive > request.arrive + LATE:
        late = arrive - request.arrive
        # a ship that waits for a tide need not depart so much earlier
        waits = fastest.best.waiting_h > 0.0
        earlier = "" if waits else f", or depart about {duration_text(late)} earlier"
        raise NoRouteError(
            f"The ship cannot arrive at {utc_text(request.arrive)}.",
            f"At its highest speed of {top / KNOT:.1f} kn it arrives at {utc_text(arrive)}, "
            f"{duration_text(late)} later.",
            f"Ask for that time or a later one{earlier}; without a departure the latest one is "
            "found.",
        )
    if slow_arrival < request.arrive - EARLY:
        raise NoRouteError(
            f"The ship arrives before {utc_text(request.arrive)} at every speed considered.",
            f"At {low / KNOT:.1f} kn, the lowest of them, it arrives at {utc_text(slow_arrival)}.",
            "Leave out the departure to get the latest one, depart later, or let it wait with "
            "arrive_by.",
        )


def _latest_departure(request: ArrivalRequest) -> tuple[Plan, str]:
    """Return the plan with the latest departure that arrives in time, and a note."""
    voyage = request.voyage
    speed = request.ship.speeds[-1] if voyage.speed_kn is None else voyage.speed_kn * KNOT
    ship = request.at_speed(float(speed))
    fixed = replace(voyage, arrive=None, hold=None, speed_kn=None, depart=0.0)

    def plan_at(depart: float, *, proven: bool = False) -> Plan:
        if not proven:
            request.report(f"trying the departure {utc_text(depart)}")
        return request.plan_one(replace(fixed, depart=depart), ship, proven)

    first = period_of_data(ship, request.sea)[0]
    ends = [resolve_endpoint(p, request.chart, "place") for p in (voyage.start, voyage.goal)]
    away = float(distance(ends[0].lat, ends[0].lon, ends[1].lat, ends[1].lon)) / float(speed)
    guess = max(request.arrive - away, first)
    if voyage.wait:
        plan = plan_at(guess)
    else:
        guess, plan = _first_departure(plan_at, guess, first)
    if guess == first and plan.best.arrive > request.arrive + LATE:
        raise _data_begin_too_late(request, first, plan.best.arrive)
    earliest = max(first, request.arrive - _LONGEST_RATIO * (away + plan.best.time_h * HOUR))
    search = ArrivalSearch(
        plan_at,
        lambda found, depart: request.sail(found, ship, depart),
        request.arrive,
        (earliest, request.arrive),
        EARLY,
        lambda found, depart: request.sail(found, ship, depart, within_limits=True),
    )
    depart, _ = solve_arrival(search, (guess, plan))
    depart, found = whole_answer(search, depart, lambda value: plan_at(value, proven=True))
    note = (
        f"Latest departure {utc_text(depart)} at {found.best.engine_order or 'constant speed'} "
        f"({speed / KNOT:.1f} kn ordered): {_on_time(found, request)}."
    )
    return found, note


def _first_departure(
    plan_at: Callable[[float], Plan], guess: float, first: float
) -> tuple[float, Plan]:
    """Return the first departure before a guess that has a route, and its plan.

    A ship that may not wait finds a bar closed at many departures.
    """
    depart = guess
    while True:
        try:
            return depart, plan_at(depart)
        except NoPathError:
            raise
        except NoRouteError:
            depart -= HOUR
            if depart < max(first, guess - _TRIED_BEFORE):
                raise


def _data_begin_too_late(request: ArrivalRequest, first: float, arrive: float) -> NoRouteError:
    return NoRouteError(
        f"The ship cannot arrive at {utc_text(request.arrive)}.",
        f"The data begin at {utc_text(first)}; departing then it arrives at {utc_text(arrive)}.",
        "Ask for a later arrival, order a higher speed, or add earlier data.",
    )


def _over_ground(request: ArrivalRequest, plan: Plan) -> Plan:
    """Return the plan with its route sailed at one speed over ground, arriving in time."""
    route, chart = plan.best, plan.plot_context.chart if plan.plot_context else request.chart
    at_sea = route.legs["leg_kind"] == 0
    passed = float((route.legs["arrive"] - route.legs["depart"])[~at_sea].sum())
    time = request.arrive - AIM - route.depart - passed - float(route.track.wait.sum())
    speed = float(route.legs["length"][at_sea].sum()) / time
    clearance = required_under_keel_clearance(request.voyage, request.ship)

    def sail(track: Track) -> Route:
        return evaluate(
            track,
            ship=request.ship,
            sea=request.sea,
            chart=chart,
            min_ukc=clearance,
            strict=False,
        )

    limits = _lowest_speed(request), float(request.ship.speeds[-1])
    found = at_constant_ground_speed(route, speed, sail, ordered_range=limits)
    kind = "none: the time is given, and the speed over ground follows from it"
    proof = Proof(math.nan, kind, plan.proof.solver_total)
    return replace(plan, routes=(found,), proof=proof)


def _ground_speed(route: Route) -> float:
    """Return the mean speed over ground at sea [m/s]."""
    at_sea = route.legs["leg_kind"] == 0
    legs = route.legs
    time = (legs["arrive"] - legs["depart"])[at_sea].sum()
    return float(legs["length"][at_sea].sum() / time)


def _on_time(plan: Plan, request: ArrivalRequest) -> str:
    early = request.arrive - plan.best.arrive
    if early <= 2.0 * EARLY:
        return "the ship arrives at the requested time"
    return (
        f"the ship arrives {duration_text(early)} before the requested time; leaving a "
        "little later or sailing a little slower, it would arrive after that time"
    )
