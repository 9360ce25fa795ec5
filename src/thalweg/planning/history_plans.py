"""Plans in the water that ships usually use, and usual routes against optimal ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.passage_crossings import names_passed
from thalweg.core.errors import NoRouteError
from thalweg.core.time import to_datetime64
from thalweg.network.history.history_corridor import HistoryCorridor
from thalweg.network.history.history_network import HistoryNetwork
from thalweg.network.history.history_route import HistoryRoute
from thalweg.network.history.season_masks import month_notes
from thalweg.planning.plan import Plan
from thalweg.planning.report.lane_report import AGAINST_TRAFFIC, INSHORE_USED, lane_notes
from thalweg.planning.report.route_summary import canals_passed
from thalweg.planning.request.ordered_speed import with_order
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.voyage import Voyage
from thalweg.route import Route, evaluate
from thalweg.sea import Sea
from thalweg.ship import Ship

_BREAKS_RULES = (AGAINST_TRAFFIC, INSHORE_USED)  # notes on traffic rules begin so


@dataclass(frozen=True, eq=False)
class CorridorRequest:
    """What a plan in a corridor needs.

    Attributes
    ----------
    ends : Start, via points and goal.
    plan_one : Plans with a chart and a network.
    """

    voyage: Voyage
    corridor: HistoryCorridor
    chart: Chart
    ends: Sequence[Endpoint]
    plan_one: Callable[[Chart, Any], Plan]


def plan_in_corridor(request: CorridorRequest, draught: float | None) -> Plan:
    """Return the plan inside the corridor, or a free one that is better by more than its gain.

    Parameters
    ----------
    draught : Of the ship [m].

    Returns
    -------
    Plan : With notes on both.

    Raises
    ------
    NoRouteError : If there is no route inside, and the plan may not leave.
    """
    corridor = request.corridor
    if corridor.month is None:
        corridor = replace(corridor, month=_month(request.voyage.earliest_departure))
    if corridor.draught is None:
        corridor = replace(corridor, draught=draught)
    places = [(end.lat, end.lon) for end in request.ends]
    lines = [end.approach.line for end in request.ends if end.approach is not None]
    inside: Plan | None = None
    try:
        chart = corridor.restricted(request.chart, places, lines)
        inside = request.plan_one(chart, corridor.network_between)
    except NoRouteError as error:
        if corridor.gain is None:
            raise
        refusal = str(error)
    if inside is not None:
        unknown = month_notes(corridor.network.months_seen, corridor.month)
        inside = replace(inside, notes=(*unknown, *inside.notes, *_unknown_ports(request)))
    if corridor.gain is None:
        assert inside is not None  # refused above otherwise
        return _with_note(inside, "The route stays in the water that ships usually use.")
    free = request.plan_one(request.chart, "auto")
    if inside is None:
        why = f"No route in the water that ships usually use: {refusal}"
        return replace(free, notes=(why, *free.notes))
    value, least = inside.objective_value, free.objective_value
    gain = 1.0 - least / value if value > 0.0 else 0.0
    words = f"{100.0 * gain:.2f} % of the {request.voyage.objective}"
    if gain > corridor.gain:
        return _with_note(free, f"The route leaves the water that ships usually use: that saves "
                          f"{words}.")  # fmt: skip
    return _with_note(
        inside,
        f"The route stays in the water that ships usually use: leaving it saves {words}, not more "
        f"than {100.0 * corridor.gain:g} %.",
    )


def _unknown_ports(request: CorridorRequest) -> list[str]:
    """Return a note for each port of a voyage to which no track of the network leads."""
    network = request.corridor.network
    notes = []
    for end in request.ends:
        if end.approach is None:
            continue
        port = end.approach.port
        if not any(port.locode == known.locode if port.locode else end.name == known.name
                   for known in network.ports):  # fmt: skip
            notes.append(
                f"{end.name} is in no track of the history network: from there the route takes the "
                "shortest way to its water."
            )
    return notes


def _with_note(plan: Plan, note: str) -> Plan:
    return replace(plan, notes=(*plan.notes, note))


def _month(time: float) -> int:
    """Return the month of a time [s since 1970], 1 to 12."""
    return int(to_datetime64(time).astype("datetime64[M]").astype(np.int64) % 12) + 1


@dataclass(frozen=True, eq=False)
class UsualAgainstOptimal:
    """The usual route of a port pair beside the best one, both sailed by the referee.

    Attributes
    ----------
    usual, optimal : Route
        From sea end to sea end, with the same departure and ordered speed.
    history : HistoryRoute
        What is known of the usual route.
    ways : (tuple of str, tuple of str)
        Canals and named passages of the usual and of the optimal route.
    notes : tuple of str
        Of the usual route: that no voyages were seen in the month; traffic rules that it does not
        keep, and the optimal one does.
    """

    usual: Route
    optimal: Route
    history: HistoryRoute
    ways: tuple[tuple[str, ...], tuple[str, ...]] = ((), ())
    notes: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON.

        Returns
        -------
        dict
            Distance [nm], time [h] and fuel [t] of both, and by how much the optimal route is
            less [%]; unknown values are None.
        """
        rows = {}
        for name in ("distance_nm", "time_h", "fuel_t"):
            a, b = (getattr(route, name) for route in (self.usual, self.optimal))
            known = a is not None and b is not None and np.isfinite(a) and np.isfinite(b)
            saving = 100.0 * (1.0 - b / a) if known and a > 0.0 else None
            rows[name] = {"usual": a if known else None, "optimal": b if known else None,
                          "saving_percent": saving}  # fmt: skip
        return {
            "from": self.history.start.name,
            "to": self.history.goal.name,
            "confidence": self.history.confidence,
            "voyages": self.history.voyages,
            "usual_within_limits": self.usual.feasible,
            "usual_violations": [str(violation) for violation in self.usual.violations],
            "usual_passes": list(self.ways[0]),
            "optimal_passes": list(self.ways[1]),
            "notes": list(self.notes),
            **rows,
        }


def usual_against_optimal(
    voyage: Voyage,
    network: HistoryNetwork,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart,
    plan_one: Callable[[Voyage], Plan],
) -> UsualAgainstOptimal:
    """Return the usual route of a voyage beside the best one.

    Parameters
    ----------
    voyage : Voyage
        Its start and goal are ports of the network.
    network : HistoryNetwork
        The usual route is that of the month of the departure.
    ship : Ship
    sea : Sea
    chart : Chart
        The referee checks both routes on it.
    plan_one : callable
        Plans a voyage with this ship, sea and chart.

    Returns
    -------
    UsualAgainstOptimal

    Raises
    ------
    InputError
        If a port is not in the network.
    NoRouteError
        If the network has no way, or there is no route.
    """
    month = _month(voyage.earliest_departure)
    history = network.route(
        str(voyage.start), str(voyage.goal), month=month, draught=ship.draught or None
    )
    start, goal = history.line[0], history.line[-1]
    best = plan_one(replace(voyage, start=start, goal=goal))
    usual = evaluate(
        history.line, ship=with_order(ship, voyage), sea=sea, chart=chart,
        depart=voyage.earliest_departure, speed_kn=voyage.speed_kn, min_ukc=voyage.min_ukc_m,
        strict=False,
    )  # fmt: skip
    sailed = chart if best.plot_context is None else best.plot_context.chart
    broken = [note for note in lane_notes(sailed, usual) if note.startswith(_BREAKS_RULES)]
    ways = _passes(usual, chart), _passes(best.best, chart)
    notes = [*history.notes, *broken]
    if ship.draught:
        notes.append(f"Ways closed to the draught of the ship, {ship.draught:.1f} m, are left out.")
    return UsualAgainstOptimal(usual, best.best, history, ways, tuple(notes))


def _passes(route: Route, chart: Chart) -> tuple[str, ...]:
    """Return the canals and named passages of a route."""
    lat, lon = np.asarray(route.track.lat, float), np.asarray(route.track.lon, float)
    canals = [canal.title for canal in canals_passed(route, chart)]
    return (*canals, *names_passed(chart.coastline, chart.passages, lat, lon))
