"""The approaches at both ends of a voyage: sailed at a fixed speed, outside the optimised part."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np

from thalweg.chart.approach_choices import line_between
from thalweg.chart.approaches import PortApproach
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import Position, distance, line_length
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE
from thalweg.planning.plan import Plan
from thalweg.planning.plan_data import PlotContext, Proof
from thalweg.planning.plan_front import BaselineComparison, ParetoFront
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.approach_report import (
    approach_limit_notes,
    port_depth_note,
    turn_back_notes_of_route,
    unknown_depth_text,
)
from thalweg.planning.report.provenance import provenance
from thalweg.planning.request.offing_choice import ship_dimensions
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import priced_objective
from thalweg.planning.voyage import Voyage
from thalweg.route import Route, Track
from thalweg.route import join as join_routes
from thalweg.route.canal_legs import approach_speed
from thalweg.ship.fuel_prices import FuelTerms

_LONG_APPROACH = 20.0 * NAUTICAL_MILE  # the speed there matters
_NO_CHOICE = "exact: the whole voyage follows the approaches of its ports"


@dataclass(frozen=True)
class ApproachSailing:
    """How a ship sails the approaches of a voyage.

    Attributes
    ----------
    outward, inward : Of the port of departure and of arrival.
    setting : Speed setting of the track: the slowest that reaches the speed of approaches.
    speed : Over ground [m/s].
    """

    outward: PortApproach | None
    inward: PortApproach | None
    setting: int
    speed: float

    @classmethod
    def of_voyage(cls, context: PlanningContext, ends: Sequence[Endpoint]) -> ApproachSailing:
        """Return the approaches of the first and last end of a voyage."""
        speed = approach_speed(context.ship, context.setting)
        speeds = np.asarray(context.ship.speeds, float)
        fast = np.flatnonzero(speeds[: context.setting + 1] >= speed * (1.0 - 1e-9))
        setting = int(fast[0]) if len(fast) else context.setting
        return cls(ends[0].approach, ends[-1].approach, setting, speed)

    def voyage_at_sea(self, voyage: Voyage) -> Voyage:
        """Return the voyage from sea end to sea end, with its times shifted by the approaches.

        Raises
        ------
        NoRouteError : If the approaches alone take longer than the latest arrival allows.
        """
        first, last = self._duration(self.outward), self._duration(self.inward)
        if not first + last:
            return voyage
        if voyage.arrive_by is not None:
            latest = float(voyage.arrive_by)  # type: ignore[arg-type]
            left = latest - voyage.earliest_departure
            if left <= first + last:
                raise NoRouteError(
                    f"No route arrives by {format_time(latest)}.",
                    f"The approaches of the ports alone take {(first + last) / HOUR:.1f} h.",
                    "Allow more time.",
                    field="arrive_by",
                )
        window = voyage.depart_window
        shifted = None if window is None else tuple(float(t) + first for t in window)  # type: ignore[arg-type]
        by = voyage.arrive_by
        return replace(
            voyage,
            depart=None if voyage.depart is None else float(voyage.depart) + first,  # type: ignore[arg-type]
            depart_window=shifted,  # type: ignore[arg-type]
            arrive_by=None if by is None else float(by) - last,  # type: ignore[arg-type]
        )

    def context_at_sea(self, context: PlanningContext) -> PlanningContext:
        """Return the context of the voyage from sea end to sea end."""
        return replace(
            context,
            voyage=self.voyage_at_sea(context.voyage),
            chart=replace(context.chart, approaches=None),
            approach_times=(self._duration(self.outward), self._duration(self.inward)),
            with_approaches=SailedApproaches(self, context).joined_at_sea_ends,
        )

    def with_approaches(self, plan: Plan, voyage: Voyage, context: PlanningContext) -> Plan:
        """Return a plan from sea end to sea end with the approaches added to all its figures.

        Parameters
        ----------
        plan : Of `voyage_at_sea`.
        voyage : The request.
        context : With a chart that has the approaches.
        """
        plots = plan.plot_context and _with_approach_lines(plan.plot_context, context)
        if self.outward is None and self.inward is None:
            return replace(plan, plot_context=plots)
        sailing = SailedApproaches(self, context)
        routes = tuple(sailing.joined(route) for route in plan.routes)
        at_sea = sailing.joined(plan.best, at_berth=False)  # what every route has, however it waits
        added = _difference(at_sea, plan.best, voyage, context, plan.front)
        more = added[0] if voyage.objective == "front" else added[1]  # a front is bounded in time
        proof = Proof(
            plan.proof.certain + more,
            f"{plan.proof.kind}; with the approaches of the ports",
            plan.proof.solver_total + more,
        )
        front = plan.front
        if front is not None:
            more_each = [
                _difference(whole, part, voyage, context, front)[1]
                for whole, part in zip(routes, plan.routes, strict=True)
            ]
            front = replace(
                _front_with_approaches(front, added, sailing),
                values=np.asarray(front.values) + more_each,
            )
        return replace(
            plan,
            voyage=voyage,
            routes=routes,
            proof=proof,
            front=front,
            notes=(*self.notes(context), *turn_back_notes_of_route(routes[0]), *plan.notes),
            plot_context=plots,
        )

    def notes(self, context: PlanningContext) -> tuple[str, ...]:
        """Return a note about each approach."""
        draught = float(context.ship.draught)
        found = []
        for approach, to in ((self.outward, "out of"), (self.inward, "into")):
            if approach is None:
                continue
            found.append(
                f"+{approach.length / NAUTICAL_MILE:.1f} nm {to} {approach.port.label} along its "
                f"approach {approach.way}".rstrip()
                + f" ({self._duration(approach) / HOUR:.1f} h at "
                f"{self.speed / KNOT:.1f} kn{_in_canal_text(approach)}, line "
                f"{approach.quality}): counted in all totals; {_other_speed_text(approach)}"
                "weather, tide and depth are not considered there."
                + unknown_depth_text(approach, draught)
            )
            found.append(port_depth_note(approach, draught))
            found += approach_limit_notes(context.chart, approach, ship_dimensions(context.ship))
        return tuple(filter(None, found))

    def _duration(self, approach: PortApproach | None) -> float:
        """Return the time of an approach [s]."""
        return 0.0 if approach is None else approach.duration(self.speed)

    def sail(
        self, line: Sequence[Position], depart: float, context: PlanningContext, wait: float = 0.0
    ) -> Route:
        """Return the line of an approach as sailed, after a wait [s]; departure in s since 1970."""
        lat, lon = np.array(line, float).T
        waits = np.append(wait, np.zeros(len(lat) - 1))
        track = Track(lat, lon, depart, waits, np.full(len(lat) - 1, self.setting))
        return context.evaluate(track, _terms(context))


def _other_speed_text(approach: PortApproach) -> str:
    """Return how another speed is set, for long approaches; empty for short ones."""
    long = approach.length >= _LONG_APPROACH
    return "another speed there is set by --approach-speed; " if long else ""


def _terms(context: PlanningContext) -> FuelTerms | None:
    """Return how the objective of a voyage prices fuel; None where it does not choose speeds."""
    voyage = context.voyage
    return priced_objective(voyage, context.ship).terms if voyage.chooses_speeds else None


class SailedApproaches:
    """The approaches of many routes of one plan: each sailed once for each time."""

    def __init__(self, sailing: ApproachSailing, context: PlanningContext) -> None:
        self._sailing = sailing
        self._sail = cache(partial(sailing.sail, context=context))
        at_sea = replace(context, chart=replace(context.chart, approaches=None))
        self._evaluate = partial(at_sea.evaluate, terms=_terms(context))

    def joined_at_sea_ends(self, route: Route) -> Route:
        """Return a route, or a stretch of it, with the approaches that begin where it ends."""
        first, last = ((float(route.track.lat[k]), float(route.track.lon[k])) for k in (0, -1))
        outward, inward = self._sailing.outward, self._sailing.inward
        return self._joined(
            route,
            outward if outward and float(distance(*outward.sea_end, *first)) < 1.0 else None,
            inward if inward and float(distance(*inward.sea_end, *last)) < 1.0 else None,
        )

    def joined(self, route: Route, *, at_berth: bool = True) -> Route:
        """Return a route with the approaches at its ends; a first wait is moved to the berth."""
        return self._joined(route, self._sailing.outward, self._sailing.inward, at_berth)

    def _joined(
        self,
        route: Route,
        outward: PortApproach | None,
        inward: PortApproach | None,
        at_berth: bool = True,
    ) -> Route:
        """Return a route with approaches at its ends; None adds none."""
        parts = [route]
        if outward is not None and outward.length > 1.0:
            depart = route.depart - outward.duration(self._sailing.speed)
            wait = float(route.track.wait[0]) if at_berth else 0.0
            if wait > 0.0:  # at the berth, not at the sea end
                waits = np.append(0.0, route.track.wait[1:])
                parts = [
                    self._evaluate(route.track.replaced(depart=route.depart + wait, wait=waits))
                ]
            parts.insert(0, self._sail(tuple(outward.line), depart, wait=wait))
        if inward is not None and inward.length > 1.0 and math.isfinite(route.arrive):
            parts.append(self._sail(tuple(inward.line[::-1]), route.arrive))
        return join_routes([_connected(a, b) for a, b in zip(parts, [*parts[1:], None])])


def _front_with_approaches(
    front: ParetoFront, added: tuple[float, float], sailing: SailedApproaches
) -> ParetoFront:
    """Return a front with the time [h] and value of the approaches added."""
    comparison = front.comparison
    if comparison is not None:
        routes = tuple(sailing.joined(route) for route in comparison.routes)
        values = np.asarray(comparison.values) + added[1]
        rows = tuple(
            row
            | {"time_h": route.time_h, "value": float(value), "distance_nm": route.distance_nm}
            | {"saved_percent": _percent(row["saved"], float(value))}
            for row, route, value in zip(comparison.rows, routes, values)
        )
        comparison = BaselineComparison(routes, values, rows)
    more = np.array(added)[:, None]
    return replace(front, certain=np.asarray(front.certain) + more, comparison=comparison)


def _with_approach_lines(plots: PlotContext, context: PlanningContext) -> PlotContext:
    """Return the data of plots with the approaches of ports on their chart."""
    chart = replace(plots.chart, approaches=context.chart.approaches)
    return replace(plots, chart=chart)


def _connected(route: Route, after: Route | None) -> Route:
    """Return a route that ends exactly when the next one departs."""
    if after is None or after.depart == route.arrive:
        return route
    legs = dict(route.legs)
    legs["arrive"] = np.append(legs["arrive"][:-1], after.depart)
    return replace(route, legs=legs)


def _percent(saved: float | None, value: float) -> float | None:
    return None if saved is None or value <= 0.0 else 100.0 * saved / value


def _difference(
    whole: Route,
    part: Route,
    voyage: Voyage,
    context: PlanningContext,
    front: ParetoFront | None,
) -> tuple[float, float]:
    """Return the time [h] and value [unit of the objective] of a route beyond that of its part.

    Raises
    ------
    InputError
        If the value of the approaches is not known, such as their traffic.
    """
    hours = whole.time_h - part.time_h
    if voyage.chooses_speeds:
        own = front.objective if front is not None else None
        objective = own or priced_objective(voyage, context.ship).objective
        value = objective.value(whole) - objective.value(part)
        if math.isinf(value):
            raise InputError(
                f"The {objective.name} of the approaches of the ports is not known.",
                "Every leg of the route counts, that from the berth to the sea as well.",
                "Add the data there, or give positions at sea in place of ports.",
                field="objective",
            )
        return hours, value
    if voyage.objective == "distance":
        return hours, whole.distance_nm - part.distance_nm
    return hours, hours


def shared_line(context: PlanningContext, ends: Sequence[Endpoint]) -> tuple[Position, ...] | None:
    """Return the line between two berths whose approaches meet before the sea, else None."""
    if len(ends) != 2 or ends[0].approach is None or ends[1].approach is None:
        return None
    return line_between(ends[0].approach, ends[1].approach, legs_blocked=context.chart.legs_blocked)


def plan_along_approaches(
    context: PlanningContext, ends: Sequence[Endpoint], line: tuple[Position, ...]
) -> Plan:
    """Plan a voyage that does not leave the approaches of its two ports.

    Raises
    ------
    NoRouteError : If it does not arrive in time.
    InputError : If the two berths are the same place.
    """
    voyage = context.voyage
    if line_length(line) < 1.0:
        raise InputError(
            f"{ends[0].name} and {ends[-1].name} have one berth in the table of approaches.",
            "Berths are at least 1 m apart.",
            "Choose two different places.",
        )
    sailing = ApproachSailing.of_voyage(context, ends)
    route = sailing.sail(line, voyage.earliest_departure, context)
    if route.arrive > context.latest_arrival + 1.0:
        raise NoRouteError(
            f"No route arrives by {format_time(context.latest_arrival)}.",
            f"The approaches take {route.time_h:.1f} h at "
            f"{sailing.speed / KNOT:.1f} kn: arrival {format_time(route.arrive)}.",
            "Allow more time.",
            field="arrive_by",
            earliest=format_time(route.arrive),
        )
    front, value = None, route.time_h
    if voyage.chooses_speeds:
        objective = priced_objective(voyage, context.ship)
        total = objective.value(route)
        one = np.array([total])
        exact = np.array([[route.time_h], [total]])
        front = ParetoFront(
            objective.name,
            objective.unit,
            one,
            ("exact",),
            ("approach",),
            certain=exact,
            objective=objective.objective,
        )
        value = route.time_h if voyage.objective == "front" else total
    elif voyage.objective == "distance":
        value = route.distance_nm
    none = np.empty(0)
    note = (
        f"{line_length(line) / NAUTICAL_MILE:.1f} nm from berth to berth along the approaches of "
        f"{ends[0].name} and {ends[1].name}, at {sailing.speed / KNOT:.1f} kn: weather, tide and "
        "depth are not considered there."
    )
    approaches = [end.approach for end in ends if end.approach is not None]
    note += "".join(unknown_depth_text(one, float(context.ship.draught)) for one in approaches)
    notes = [note, *_shared_line_notes(context, approaches, line), *(end.note for end in ends)]
    return Plan(
        voyage=voyage,
        routes=(route,),
        proof=Proof(value, _NO_CHOICE, value),
        rejections={},
        notes=tuple(dict.fromkeys(filter(None, [*notes, *context.needs.notes]))),
        provenance=provenance(context, list(ends), [], [sailing.speed / KNOT]),
        plot_context=PlotContext(none, none, none, context.chart, context.sea, context.ship),
        front=front,
    )


def _shared_line_notes(
    context: PlanningContext, approaches: list[PortApproach], line: tuple[Position, ...]
) -> list[str]:
    """Return notes on ports, passages and bridges along a line that are too small for the ship."""
    too_shallow = [port_depth_note(one, float(context.ship.draught)) for one in approaches]
    whole = replace(approaches[-1], line=line)
    return too_shallow + approach_limit_notes(context.chart, whole, ship_dimensions(context.ship))


def _in_canal_text(approach: PortApproach) -> str:
    """Return how far an approach leads through a canal, at the mean speed there, or ""."""
    if not approach.through:
        return ""
    knots = approach.through_length / approach.through_time / KNOT
    return f", of it {approach.through_length / NAUTICAL_MILE:.1f} nm in a canal at {knots:.1f} kn"
