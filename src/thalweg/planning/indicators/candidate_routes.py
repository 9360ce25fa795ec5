"""Candidates for alternatives of a voyage, all on the networks and the frozen sea of one trade-off.

The key figures are minimised on one network in the weather; in fuel and cost, the fastest route at
one lower speed competes. Others are ways that differ (`OtherWays`). Ways that run farther against
lanes than the fastest route by any canals are left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.interrupt import SearchInterrupted
from thalweg.core.limits import NETWORK_STEPS, TIGHTENING
from thalweg.core.objective import Objective
from thalweg.network import Network
from thalweg.planning.approach_sailing import (
    ApproachSailing,
    SailedApproaches,
    plan_along_approaches,
    shared_line,
)
from thalweg.planning.indicators.other_ways import OtherWays
from thalweg.planning.indicators.ways_not_offered import canal_notes
from thalweg.planning.network_selection.route_alternatives import (
    RouteAlternative,
    canals_used,
    network_of_all_ways,
)
from thalweg.planning.offing_attempts import plan_off_land, shortest_length
from thalweg.planning.pareto.exploration import fastest_in_known_water, network_pareto_front
from thalweg.planning.pareto.front_points import track_from_front_point
from thalweg.planning.pareto.search_horizon import FastestPaths, extend_horizon
from thalweg.planning.pareto.single_speed import refined_in_open_water
from thalweg.planning.pareto.trade_off_context import TradeOffContext
from thalweg.planning.pareto.trade_off_planner import with_trade_off
from thalweg.planning.pareto.turn_reduction import may_leave_nodes, scored_with_fewer_turns
from thalweg.planning.pareto.weighted_sums import (
    KeyFigureRange,
    key_figure,
    normalised_objective,
    with_objective,
)
from thalweg.planning.plan_front import knee
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.lane_report import lane_detour_notes, routes_within_lanes
from thalweg.planning.request.offing_choice import chosen_offing
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.route import Route, Track
from thalweg.ship.comfort.onboard_motions import required_motions

STOPPED: Final = "Stopped"  #: first word of notes after Ctrl-C
_OBJECTIVES: Final = ("cost", "fuel", "comfort", "encounters", "inshore", "distance")
_REFINED: Final = ("cost", "fuel")  # in open water
_WEIGHTED: Final = ("time", "fuel", "comfort", "encounters")
_LONGER: Final = 1.5  # times the time of the fastest, without a time of arrival


def berth_to_berth_candidates(
    context: PlanningContext, ends: list[Endpoint]
) -> tuple[list[Route], list[str]]:
    """Return candidates with the approaches of ports, and notes."""
    line = shared_line(context, ends)
    if line is not None:
        found = plan_along_approaches(context, ends, line)
        return list(found.routes), list(found.notes)
    sailing = ApproachSailing.of_voyage(context, ends)
    at_sea = sailing.context_at_sea(context)
    offing = chosen_offing(context.voyage, context.ship)

    def search(off_land: PlanningContext) -> tuple[list[Route], list[str]]:
        return with_trade_off(off_land, ends, _feasible_candidates)

    routes, notes = plan_off_land(
        at_sea, ends, offing, search, length_of=lambda found: shortest_length(found[0])
    )
    sailed = SailedApproaches(sailing, context)
    return [sailed.joined(route) for route in routes], [*sailing.notes(context), *notes]


def _feasible_candidates(
    trade_off: TradeOffContext, alternatives: list[RouteAlternative]
) -> tuple[list[Route], list[str]]:
    """Return the candidates that keep the limits, searched with limits as tight as that takes.

    Where the fastest breaks a limit, stricter ones are tried as well: the fastest that keeps the
    limits may be hours before the slower candidates that do.
    """
    context, latest = trade_off.context, trade_off.context.latest_arrival
    found: list[tuple[list[Route], list[str]]] = []  # with a route that keeps the limits
    for step in NETWORK_STEPS:
        own = replace(
            trade_off,
            limits=context.needs.limits.tightened(TIGHTENING[step]),
            context=context.with_stricter_motions(TIGHTENING[step].share),
        )
        try:
            routes, notes, refused = candidate_routes(own, alternatives)
        except NoRouteError:
            if found:  # too strict
                break
            raise
        kept = [route for route in routes if route.feasible and route.arrive <= latest + 1.0]
        notes += canal_notes(context.chart, routes, kept or routes[:1], latest, refused)
        if kept:
            found.append((kept, notes))
        if routes[0].feasible or trade_off.interrupt_guard.stopped():
            break
    found = found or [(routes[:1], notes)]
    kept, notes = min(found, key=lambda one: min(route.time_h for route in one[0]))
    return kept, list(dict.fromkeys((*context.needs.notes, *notes)))


def longest_notes(context: PlanningContext, routes: Sequence[Route]) -> list[str]:
    """Return a note on how long routes take at most, where the voyage has no time of arrival."""
    if context.voyage.arrive_by is not None or len(context.ship.speeds) < 2 or len(routes) < 2:
        return []
    return [
        f"Least fuel and the other figures are of routes that take at most {_LONGER:g} times as "
        "long at sea as the fastest (the cheapest may take longer): with more time less fuel is "
        "possible. Set another limit by the latest arrival (--arrive-by)."
    ]


def candidate_routes(
    trade_off: TradeOffContext, alternatives: list[RouteAlternative]
) -> tuple[list[Route], list[str], list[tuple[set[str], str]]]:
    """Return routes among which the alternatives of a voyage are, and notes.

    Parameters
    ----------
    trade_off : With all settings of the ship; its own objective is not used.
    alternatives : By canals, the shortest first.

    Returns
    -------
    routes : Scored by the referee, the fastest of the shortest alternative first; some may break
        limits, and those by other canals may take longer.
    notes : Which candidates could not be found.
    refused : Canals of each alternative without a route, and why it has none.

    Raises
    ------
    NoRouteError : If no route arrives in time.
    """
    search = _Candidates(trade_off)
    first = search.fastest(alternatives[0])
    all_ways = network_of_all_ways(alternatives[0], search.context.chart, trade_off.ends)
    ways = OtherWays(trade_off, search.best["time"])
    steps: list[tuple[str, Iterator[Track]]] = [
        (f"for {name}", search.of_least(first.network, name)) for name in _OBJECTIVES
    ]
    steps += [
        ("of a weighted sum", search.of_weighted_sum(first.network)),
        ("round islands", ways.round_islands(all_ways)),
        ("farther off land", ways.farther_off_land(first.network)),
        ("by passages", ways.by_passages(first.network)),
        ("round passages", ways.round_passages(first.network)),
    ]
    for words, tracks in steps:
        search.add(words, tracks)
    for other in alternatives[1:]:
        if not search.stopped:
            search.try_alternative(other)
    search.notes += lane_detour_notes(search.context.chart, [first.network])
    in_time = [route for route in search.routes if search.is_in_time(route)]
    standards = [route for route in search.fastest_routes if route in in_time]
    kept, note = routes_within_lanes(search.context.chart, in_time, standards)
    kept += [route for route in search.fastest_routes if route not in in_time]
    return kept, [*search.notes, *note], search.refused


class _Candidates:
    """Routes found so far, and the searches for more."""

    def __init__(self, trade_off: TradeOffContext) -> None:
        self.trade_off, self.context = trade_off, trade_off.context
        self.terms = trade_off.objective.terms
        self.currency = self.terms.currency or "USD"
        self.routes: list[Route] = []
        self.fastest_routes: list[Route] = []  # of each set of canals
        self.notes: list[str] = []
        self.refused: list[tuple[set[str], str]] = []  # canals of alternatives without a route
        self.best: dict[str, Route] = {}
        self.paths = FastestPaths()  # of the first network

    @property
    def stopped(self) -> bool:
        return self.trade_off.interrupt_guard.stopped()

    @property
    def longest(self) -> float:
        """Time [s] that ways take at most: half as much again as the fastest, if none is set."""
        fastest = self.best["time"]
        free = self.context.voyage.arrive_by is not None
        return math.inf if free else _LONGER * (fastest.arrive - fastest.depart)

    def is_in_time(self, route: Route) -> bool:
        """Return whether a route is not longer in time; that of least cost may be, at a price."""
        return route is self.best.get("cost") or not route.arrive - route.depart > self.longest

    def fastest(self, alternative: RouteAlternative) -> RouteAlternative:
        """Add the fastest route of an alternative; return it without water that has no data."""
        own = with_objective(self.trade_off, Objective.of("time", currency=self.currency))
        alternative, _horizon, route = fastest_in_known_water(own, alternative)
        self.routes.append(self._scored(route.track))
        self.fastest_routes.append(self.routes[-1])
        self.best.setdefault("time", self.routes[-1])
        return alternative

    def try_alternative(self, alternative: RouteAlternative) -> None:
        """Add the fastest route of another alternative, if it has one."""
        try:
            self.fastest(alternative)
        except NoRouteError as error:
            used = set(canals_used(alternative.network, self.context.chart))
            self.refused.append((used, str(error.args[0])))

    def add(self, words: str, tracks: Iterator[Track]) -> None:
        """Score the tracks of one step; a step that is not possible leaves a note."""
        if self.stopped:
            self.notes.append(f"{STOPPED} before the routes {words} were searched.")
            return
        self.context.report_progress(f"searching routes {words}")
        try:
            for track in tracks:
                self.routes.append(self._scored(track))
        except (NoRouteError, InputError) as error:
            self.notes.append(f"No route {words}: {error.args[0]}")
        except SearchInterrupted:
            self.notes.append(f"{STOPPED} while the routes {words} were searched.")

    def _scored(self, track: Track) -> Route:
        route = self.context.evaluate(track, self.terms)
        self.context.show_route(route)
        return route

    def of_least(self, network: Network, name: str) -> Iterator[Track]:
        """Yield the route of least value of a key figure, and the knee of its front with time."""
        if not np.isfinite(key_figure(self.best["time"], name)):
            if name == "comfort":
                required_motions(self.context.ship)  # a note, where she has no places
            return
        if name == "comfort" and key_figure(self.best["time"], name) == 0.0:  # flat calm
            return
        objective = Objective.of(name, currency=self.currency)
        tracks = self._front(network, objective)
        found = [self._scored(tracks[0])]
        if name in _REFINED:
            found += self._fastest_way_at_one_speed(self._longest_of(objective))
        self.best[name] = min(found, key=objective.value)
        self.routes.append(self.best[name])
        yield from tracks[1:]

    def _fastest_way_at_one_speed(self, longest: float) -> list[Route]:
        """Return the fastest route at each setting that keeps the limits in a time [s]."""
        track = self.best["time"].track
        if np.any(track.wait > 0.0):  # made for the times of the fastest
            return []
        legs = len(track) - 1
        tracks = [
            track.replaced(setting=np.full(legs, setting), speed=None)
            for setting in self.trade_off.settings
        ]
        found = [self.context.evaluate(one, self.terms) for one in tracks]
        latest = min(self.context.latest_arrival, track.depart + longest)
        return [route for route in found if route.feasible and route.arrive <= latest]

    def _longest_of(self, objective: Objective) -> float:
        """Return the time that ways take at most [s]: none where it is a part of the cost."""
        priced = objective.name == "cost" and self.terms.time_price > 0.0
        return math.inf if priced else self.longest

    def of_weighted_sum(self, network: Network) -> Iterator[Track]:
        """Yield the route of the least sum of key figures, each over its range."""
        names = [name for name in _WEIGHTED if name in self.best]
        if len(names) < 2:
            return
        ranges: dict[str, KeyFigureRange] = {}
        for name in names:
            values = [key_figure(self.best[other], name) for other in names]
            ranges[name] = KeyFigureRange(1.0, min(values), max(values))
        yield self._front(network, normalised_objective(ranges, self.currency))[0]

    def _front(self, network: Network, objective: Objective) -> list[Track]:
        """Return the cheapest track of the front of time and an objective, and that at its knee."""
        own = with_objective(self.trade_off, objective)
        horizon = extend_horizon(own, network, self.paths)
        front = network_pareto_front(own, network, horizon.frozen, horizon.latest)
        longest = self._longest_of(objective)
        points = [point for point in front.points if not point.time > longest]
        points.sort(key=lambda point: point.time)
        if not points:
            why = " and ".join(front.refused) or "too late for the period of the data"
            raise NoRouteError(
                f"no path of the network has this key figure; legs were refused as {why}.",
                "The other routes were found by other objectives and keep the limits.",
                "Relax the limits, or extend the data.",
                reasons=front.refused,
            )
        middle = knee(*(np.array([getattr(p, at) for p in points]) for at in ("time", "cost")))
        cheapest = min(points, key=lambda point: point.cost)
        chosen = [cheapest] if len(points) < 3 else [cheapest, points[middle]]
        tracks = [(track_from_front_point(network, point), point.time) for point in chosen]
        scored = (scored_with_fewer_turns(own, track, time) for track, time in tracks)
        refined = objective.name in _REFINED and may_leave_nodes(own)
        return [(refined_in_open_water(own, r) if refined else r).track for r in scored]
