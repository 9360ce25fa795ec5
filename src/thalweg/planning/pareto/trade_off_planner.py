"""From the fronts of all ways round to one plan."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, KNOT
from thalweg.kernels import codes
from thalweg.network import shortest
from thalweg.planning.interrupt_guard import Keeper
from thalweg.planning.network_selection.route_alternatives import find_ways
from thalweg.planning.pareto.baseline import blind_tracks, compare, sail_blind
from thalweg.planning.pareto.bounds import certain, disproved, lower_front, lowered_notes, proof_of
from thalweg.planning.pareto.exploration import (
    Candidate,
    Explored,
    Means,
    explore,
    not_dominated,
    shortest_length,
    spread,
    track_of_point,
)
from thalweg.planning.pareto.objective import find_criterion
from thalweg.planning.pareto.plan_front import FrontOfPlan
from thalweg.planning.pareto.route_names import names_of_ways
from thalweg.planning.plan import Plan, Surroundings
from thalweg.planning.report.provenance import known, network_facts, provenance, route_notes
from thalweg.planning.request.voyage_endpoints import End
from thalweg.planning.single.passage import Task
from thalweg.route import Route, evaluate

#: Margins on the depth [m] and on wave height and wind [fraction], tried in turn while the referee
#: finds no route within the limits.
_MARGINS = ((0.0, 0.0), (0.1, 0.02), (0.3, 0.05), (1.0, 0.1))
#: A route that ends so near the end of the data was bounded by it [s].
_NEAR_THE_END = 3.0 * HOUR
#: Routes of a front that are refereed and published, fewer where one takes many steps to sail.
_FEWEST_ROUTES, _MOST_ROUTES, _MOST_STEPS = 40, 100, 150_000
_STOPPED_ROUTES = 20  # after Ctrl-C


@dataclass(frozen=True)
class Scored:
    """A candidate with what the referee says of it."""

    candidate: Candidate
    route: Route
    value: float


def trade(task: Task, ends: list[End]) -> Plan:
    """Plan a voyage whose objective trades time for fuel, energy, cost or CO2.

    Raises
    ------
    InputError
        If the ship's fuel, its price or its power is not known.
    NoRouteError
        If no route exists within the limits and in time.
    """
    criterion = find_criterion(task.voyage, task.ship)
    rate = criterion.rate_of(task.ship)
    single = task.voyage.speed_kn is not None
    settings = np.array([task.setting]) if single else np.arange(len(task.ship.speeds))
    with Keeper() as keeper:
        means = Means(task, criterion, rate, tuple(ends), settings, task.needs.limits, keeper)
        ways = find_ways(task, ends)
        for depth, fraction in _MARGINS:
            limits = task.needs.limits * (1.0 - fraction)
            limits[codes.LIMIT_REQUIRED_DEPTH] = (
                task.needs.limits[codes.LIMIT_REQUIRED_DEPTH] + depth
            )
            explored = _explored(replace(means, limits=limits), ways)
            scored = _scored(means, _candidates(replace(means, limits=limits), explored))
            if keeper.stopped() or any(item.route.feasible for item in scored):
                break
        return _gathered(means, ends, explored, scored)


def _explored(means: Means, ways: list[Any]) -> list[Explored]:
    """Explore all ways round; one that cannot be sailed is left out if another can."""
    found: list[Explored] = []
    refusal: NoRouteError | None = None
    for way in ways:
        if found and means.keeper.stopped():
            means.notes.append(f"Stopped before the way round by {way.name} was looked at.")
            break
        try:
            found.append(explore(means, way))
        except NoRouteError as error:
            refusal = refusal or error
    if not found:
        assert refusal is not None  # there is at least one way
        raise refusal
    return found


def _candidates(means: Means, explored: list[Explored]) -> list[Candidate]:
    """Return routes worth the referee's time: the fastest of each way, and a front."""
    fastest = [
        Candidate(one.fastest.track, "fastest", one.way.name, one.fastest.time_h * HOUR, math.nan)
        for one in explored
    ]
    found = [candidate for one in explored for candidate in _exact(one)]
    if not found:  # stopped before there was a front
        return fastest
    found += _refined(means, explored, found)
    kept = not_dominated(*_points(found))
    time, value = _points([found[index] for index in kept])
    steps = max(len(one.fastest.samples["time"]) for one in explored)
    most = min(max(_MOST_STEPS // max(steps, 1), _FEWEST_ROUTES), _MOST_ROUTES)
    if means.keeper.stopped():
        most = min(most, _STOPPED_ROUTES)
    return [*fastest, *(found[kept[index]] for index in spread(time, value, most))]


def _exact(one: Explored) -> list[Candidate]:
    """Return the exact front of one way round."""
    network, name = one.way.network, one.way.name
    return [
        Candidate(track_of_point(network, point), "exact", name, point.time, point.cost)
        for point in (one.exact.points if one.exact else ())
    ]


def _refined(means: Means, explored: list[Explored], exact: list[Candidate]) -> list[Candidate]:
    """Return what comes of drawing ways round and of refining the front, as far as was asked."""
    method, stopped = means.task.voyage.method, means.keeper.stopped
    if method == "exact" or stopped():
        return []
    from thalweg.planning.pareto.evolutionary_refinement import evolved
    from thalweg.planning.pareto.fixed_route_fronts import round_candidates

    found = round_candidates(means) if method == "default" else []
    for one in explored:
        if stopped():
            break
        means.task.tell(f"refining the front: {one.way.name}")
        of_way = [c for c in (*exact, *found) if c.way == one.way.name]
        found += evolved(means, one, of_way)
    return found


def _points(found: list[Candidate]) -> tuple[np.ndarray, np.ndarray]:
    return np.array([item.time for item in found]), np.array([item.value for item in found])


def _scored(means: Means, candidates: list[Candidate]) -> list[Scored]:
    """Let the referee score candidates; what is dominated is dropped, what breaks limits too."""
    task = means.task
    task.tell(f"refereeing {len(candidates)} routes")
    scored = []
    for candidate in candidates:
        route = evaluate(
            candidate.track,
            ship=task.ship,
            sea=task.sea,
            chart=task.chart,
            min_ukc=task.min_ukc,
            strict=False,
            terms=means.criterion.terms,
        )
        scored.append(Scored(candidate, route, means.criterion.of(route)))
    latest = task.latest
    usable = [
        item
        for item in scored
        if item.route.feasible and math.isfinite(item.value) and item.route.arrive <= latest + 1.0
    ]
    if not usable:
        return [item for item in scored if math.isfinite(item.route.arrive)]
    time = np.array([item.route.time_h for item in usable])
    value = np.array([item.value for item in usable])
    return [usable[index] for index in not_dominated(time, value)]


def _gathered(
    means: Means, ends: list[End], explored: list[Explored], scored: list[Scored]
) -> Plan:
    """Put the plan together."""
    task, criterion = means.task, means.criterion
    whole = task.voyage.objective == "front"
    blind = _blind(means, explored)
    scored = _with_blind(means, scored, blind)
    if not scored:
        raise _nothing_sails(means, explored)
    ordered = sorted(scored, key=lambda item: item.route.time_h)
    if not whole:
        best = min(ordered, key=lambda item: item.value)
        ordered = [best, *(item for item in ordered if item is not best)]
    routes = tuple(item.route for item in ordered)
    values = np.array([item.value for item in ordered])
    lower = lower_front(explored, certain(means, explored)[1])
    share = disproved(lower, np.array([route.time_h for route in routes]), values)
    lower *= share[:, None]
    shortest_way = min(explored, key=lambda one: shortest_length(one.way.network)).way.name
    front = FrontOfPlan(
        criterion=criterion.name,
        unit=criterion.unit,
        values=values,
        stages=tuple(item.candidate.stage for item in ordered),
        ways=names_of_ways(
            routes,
            [item.candidate.way or shortest_way for item in ordered],
            {one.way.name: one.way.network for one in explored},
            task.chart,
        ),
        lower=lower,
        comparison=compare(task, criterion, routes, values, blind),
    )
    stopped = means.keeper.stopped()
    return Plan(
        voyage=task.voyage,
        routes=routes,
        proof=proof_of(means, explored, front, whole=whole),
        rejections=_rejections(explored),
        notes=tuple(
            dict.fromkeys(
                [
                    *(_stopped(explored, front) if stopped else ()),
                    *_notes(means, ends, explored, ordered),
                    *means.notes,
                    *lowered_notes(share),
                ]
            )
        ),
        provenance=provenance(task, ends, _networks(explored), _speeds_kn(means)),
        surroundings=_surroundings(task, explored),
        front=front,
        cancelled=stopped,
    )


def _stopped(explored: list[Explored], front: FrontOfPlan) -> list[str]:
    """Say what a plan holds that was stopped by Ctrl-C."""
    if all(one.exact is None for one in explored):
        kept = "before there was a front: the fastest route is kept"
    elif set(front.stages) <= {"exact", "fastest"}:
        kept = "before refinement: the exact front of the network is kept"
    else:
        kept = "before all was done: the best so far is kept"
    return [f"Stopped by Ctrl-C {kept}; more time may find better."]


def _blind(means: Means, explored: list[Explored]) -> list[Route]:
    """Return the weather-blind routes of the shortest way round, in the weather of the plan."""
    if means.keeper.stopped():
        return []
    network = min((one.way.network for one in explored), key=shortest_length)
    _, path = shortest(network, network.meta.start, network.meta.goal)
    means.task.tell("sailing the weather-blind route")
    tracks = blind_tracks(means.task, network.lat[path], network.lon[path], means.settings)
    sailed = sail_blind(means.task, means.criterion, tracks)
    if not sailed:
        means.notes.append(
            "The weather-blind route cannot be sailed to its end in these data: nothing to compare."
        )
    return sailed


def _with_blind(means: Means, scored: list[Scored], blind: list[Route]) -> list[Scored]:
    """Return all that is not dominated, constant speeds on the shortest way among it."""
    latest = means.task.latest
    constant = [
        Scored(Candidate(r.track, "constant speed", "", r.time_h * HOUR, value), r, value)
        for r, value in ((route, means.criterion.of(route)) for route in blind)
        if r.feasible and r.arrive <= latest + 1.0
    ]
    if not any(item.route.feasible for item in scored):
        return constant or scored
    pool = [*scored, *constant]
    time = np.array([item.route.time_h for item in pool])
    value = np.array([item.value for item in pool])
    return [pool[index] for index in not_dominated(time, value)]


def _rejections(explored: list[Explored]) -> dict[str, int]:
    refused: Counter[str] = Counter()
    for one in explored:
        refused.update(one.way.network.meta.rejected)
        refused.update(one.first.refused)
        refused.update(one.exact.refused if one.exact else {})
    return {reason: count for reason, count in refused.items() if count}


def _networks(explored: list[Explored]) -> list[dict[str, Any]]:
    return [
        network_facts(
            one.way.network,
            settled=int(one.first.settled),
            depart=one.fastest.depart,
            way=one.way.name,
        )
        for one in explored
    ]


def _speeds_kn(means: Means) -> list[float | None]:
    return [known(float(means.task.ship.speeds[s]) / KNOT) for s in means.settings]


def _surroundings(task: Task, explored: list[Explored]) -> Surroundings:
    """Return what the pictures need, the earliest arrivals of all ways round."""
    networks = [one.way.network for one in explored]
    return Surroundings(
        lat=np.concatenate([network.lat for network in networks]),
        lon=np.concatenate([network.lon for network in networks]),
        arrival=np.concatenate([one.isochrones for one in explored]),
        chart=task.chart,
        sea=task.sea,
        ship=task.ship,
    )


def _notes(
    means: Means, ends: list[End], explored: list[Explored], ordered: list[Scored]
) -> list[str]:
    task, best = means.task, ordered[0].route
    notes = [end.note for end in ends if end.note] + list(task.needs.notes)
    notes += [f"The referee finds a limit broken: {v}." for v in best.violations[:5]]
    notes += route_notes(task, best)
    slowest = max(item.route.arrive for item in ordered)
    bounded = task.voyage.arrive_by is None and math.isfinite(task.last)
    if bounded and slowest > task.last - _NEAR_THE_END:
        notes.append(f"The data end at {format_time(task.last)}: slower routes were not looked at.")
    return notes


def _nothing_sails(means: Means, explored: list[Explored]) -> NoRouteError:
    latest = means.task.latest
    by = f" by {format_time(latest)}" if math.isfinite(latest) else ""
    soonest = min(one.first.arrive for one in explored)
    return NoRouteError(
        f"No route arrives{by} when it is sailed in fine steps.",
        f"The network's earliest arrival is {format_time(soonest)}.",
        "Allow more time, or relax the limits.",
        reasons=_rejections(explored),
    )
