"""Cost refinement: the same passage in the same time for less fuel, money or CO2."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.errors import unknown_name_error
from thalweg.core.geodesy import direct, inverse, rough_lengths, unwrap_longitude
from thalweg.core.limits import TIGHTENING, Tightening
from thalweg.core.objective import Objective
from thalweg.core.time import TimeLike, parse_time
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.route.canal_legs import canal_ends
from thalweg.route.evaluators.cost_evaluator import CostEvaluator, make_cost_evaluator
from thalweg.route.evaluators.polyline import (
    Polyline,
    polyline_of_track,
    track_of_polyline,
)
from thalweg.route.evaluators.time_evaluator import penalty_factors
from thalweg.route.referee.evaluation import evaluate
from thalweg.route.refinement.better_route import RefinementConditions, freeze_around_track
from thalweg.route.refinement.sailed_polyline import optimise_line_offsets
from thalweg.route.refinement.simplification import simplified_route
from thalweg.route.refinement.smoothing import resampled_polyline
from thalweg.route.refinement.speed_profile import choose_speeds
from thalweg.route.refinement.string_pulling import string_pull
from thalweg.route.route import Route
from thalweg.route.track import Track
from thalweg.ship.consumption import consumption_table, leg_prices

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import GridFields
    from thalweg.ship import PerformanceTable
    from thalweg.ship.fuel_prices import FuelTerms

_OBJECTIVE_COLUMNS = {"fuel": "fuel", "cost": "cost", "co2": "co2"}
_STEPS = TIGHTENING[:3]  # tried while the referee finds violations
_MIN_LEGS_OF_LEVEL = (6, 12, 24, 48)  # least number of legs of each level
_PASSES_PER_LEVEL = 2  # choices of settings, each followed by Newton's method
_NEWTON_STEPS = 4  # iterations of Newton's method
_COARSE_START_TOLERANCE = (
    1.02  # a coarse start is refined too if it costs no more than this times the line itself
)
_MAX_ARRIVAL_CORRECTIONS = 4  # evaluations by the referee until the arrival fits
_ARRIVAL_TOLERANCE = 2e-6  # share of the time by which it may come early
_MIN_ZONE_SHARE = (
    0.02  # least share of a leg inside and outside a control area that gets a waypoint
)


def refine_cost(
    scored: Route,
    conditions: RefinementConditions,
    *,
    fuel: PerformanceTable | TableArrays,
    objective: str = "cost",
    arrive_by: TimeLike | None = None,
    terms: FuelTerms | None = None,
    fields: GridFields | None = None,
    thin: bool = True,
) -> Route:
    """Return a route past the same obstacles that costs less and arrives no later.

    Parameters
    ----------
    scored : Route
        As evaluated by the referee, with the same terms.
    conditions : RefinementConditions
        Ship, sea, chart and limits.
    fuel : PerformanceTable or TableArrays
        Fuel rate of the ship [kg/s] (`Ship.tabulate_fuel`). Where the cost is that of time and
        cubed speed (`FuelTerms.by_speed`) it is not used.
    objective : {"fuel", "cost", "co2"}
    arrive_by : time, optional
        Latest arrival; by default when the given route arrives, and never earlier than that.
    terms : FuelTerms, optional
        Prices of fuel and time; by default those of the ship file.
    fields : GridFields, optional
        The sea frozen around the route, if it is used for several calls.
    thin : bool
        Remove waypoints that make no difference (up to five more evaluations).

    Returns
    -------
    Route
        Evaluated by the referee and not worse than the given one: it violates no limit, costs no
        more and arrives no later than ``arrive_by``. The given one if no better route is found.
        Canals and waits do not change.

    Raises
    ------
    InputError
        If there is no such objective, or a price it needs is unknown.

    Notes
    -----
    Level by level legs are halved, settings are chosen (`choose_speeds`) and the waypoints move
    sideways by Newton's method on cost plus the value of time, which is the slope of cost over time
    at the chosen settings. All this uses frozen fields; the referee evaluates the result, and
    settings are chosen again until its time of arrival is met to a few millionths of the time.
    """
    ship, sea, chart = conditions.ship, conditions.sea, conditions.chart
    terms = ship.fuel_terms if terms is None else terms
    if objective not in _OBJECTIVE_COLUMNS:
        kind = "objective of a cost refinement"
        raise unknown_name_error(kind, str(objective), _OBJECTIVE_COLUMNS)
    prices = leg_prices(Objective.of(objective), ship, terms)
    if prices.consumption == "cubed_speed":
        fuel = consumption_table(ship, prices.consumption)
    latest = scored.arrive if arrive_by is None else max(parse_time(arrive_by), scored.arrive)
    if not (scored.feasible and math.isfinite(scored.arrive)):
        return scored

    def score(track: Track) -> Route:
        return evaluate(
            track,
            ship=ship,
            sea=sea,
            chart=chart,
            min_ukc=conditions.min_ukc,
            strict=False,
            terms=terms,
        )

    def value(route: Route) -> float:
        good = route.feasible and route.arrive <= latest + 1e-6
        return _objective_value(route, objective, chart) if good else math.inf

    frozen = fields
    if frozen is None:
        frozen = freeze_around_track(
            scored, scored.track, 0.2, ship=ship, sea=sea, limits=conditions.limits, until=latest
        )

    def evaluator_of(track: Track, step: Tightening) -> CostEvaluator:
        evaluator = make_cost_evaluator(
            ship=ship,
            table=conditions.table,
            fuel=fuel,
            fields=frozen,
            limits=conditions.limits.tightened(step),
            chart=chart,
            track=track,
            prices=prices,
        )
        return replace(evaluator, holds_settings=conditions.holds_settings)

    best = _best_attempt(scored, latest, evaluator_of, score, value)
    if not thin:
        return best
    held = canal_ends(best.track, chart)
    return simplified_route(best, score, value, most=value(scored), held=held)


def _best_attempt(
    scored: Route,
    latest: float,
    evaluator_of: Callable[[Track, Tightening], CostEvaluator],
    score: Callable[[Track], Route],
    value: Callable[[Route], float],
) -> Route:
    """Return the best of a route and its refinements.

    A slower ship may meet other weather than the route: if it cannot use the available time, the
    route is refined for its own arrival first.
    """

    def attempt(start: Route, target: float) -> Route:
        best = start
        for step in _STEPS:
            evaluator = evaluator_of(start.track, step)
            line = _optimised(
                polyline_of_track(start.track, evaluator), evaluator, target - start.depart
            )
            if line is None:
                break
            route = _score_on_time(line, evaluator, target, score, value)
            best = min(best, route, key=value)
            if route.feasible:
                break
        return best

    best = attempt(scored, latest)
    if best is scored and latest > scored.arrive:
        best = attempt(scored, scored.arrive)
        if best is not scored:
            best = attempt(best, latest)
    return best


def _objective_value(route: Route, objective: str, chart: Chart | None) -> float:
    """Return the objective with the additions of penalty zones; inf where it is unknown."""
    legs = route.legs
    spent = legs[_OBJECTIVE_COLUMNS[objective]] + (
        legs["waiting_fuel"] if objective == "fuel" else 0.0
    )
    factor = penalty_factors(chart, route.track.lat, route.track.lon)
    total = float(np.sum(spent if factor is None else spent * factor))
    return total if math.isfinite(total) else math.inf


def _optimised(line: Polyline, evaluator: CostEvaluator, latest: float) -> Polyline | None:
    """Return the cheapest line that arrives in time; None if the given one cannot be sailed."""
    paced, value_of_time = choose_speeds(line, evaluator, latest)
    own = _cost_with_time_value(paced, evaluator, value_of_time)
    if not math.isfinite(own):
        return None
    starts = [string_pull(paced, evaluator.with_value_of_time(value_of_time))]
    if not np.isfinite(line.leave).any() and not _fixed_waypoints(line, evaluator)[1:-1].any():
        for count in _MIN_LEGS_OF_LEVEL[:2]:
            coarse = resampled_polyline(paced, count + 1)
            if (
                len(line) > count + 1
                and _cost_with_time_value(coarse, evaluator, value_of_time)
                <= _COARSE_START_TOLERANCE * own
            ):
                starts.append(coarse)
    found = [
        line,
        *(_refine_by_levels(start, evaluator, latest, value_of_time) for start in starts),
    ]
    return min(found, key=lambda item: _cost_with_lateness(item, evaluator, latest, value_of_time))


def _fixed_waypoints(line: Polyline, evaluator: CostEvaluator) -> np.ndarray:
    return evaluator.fixed_points(line.lat, line.lon)


def _cost_with_time_value(line: Polyline, evaluator: CostEvaluator, value_of_time: float) -> float:
    """Return the cost plus the value of the time."""
    return float(evaluator.with_value_of_time(value_of_time).sail(line.batch())[1][0])


def _cost_with_lateness(
    line: Polyline, evaluator: CostEvaluator, latest: float, value_of_time: float
) -> float:
    """Return the cost at the best settings, plus twice the value of the lateness."""
    arrive, cost, _ = evaluator.cost_and_time(choose_speeds(line, evaluator, latest)[0].batch())
    late = max(float(arrive[0, -1]) - latest, 0.0)
    return float(cost[0]) + (2.0 * value_of_time * late if late > 0.0 else 0.0)


def _refine_by_levels(
    line: Polyline, evaluator: CostEvaluator, latest: float, value_of_time: float
) -> Polyline:
    """Refine a line level by level."""
    total = float(rough_lengths(line.lat, line.lon).sum())
    for number, parts in enumerate(_MIN_LEGS_OF_LEVEL):
        while True:
            finer = _split_long_legs(line, evaluator, total / parts)
            if len(finer) == len(line):
                break
            line = finer
        if number == len(_MIN_LEGS_OF_LEVEL) - 1:
            line = _split_at_zone_borders(line, evaluator)
        for _ in range(_PASSES_PER_LEVEL):
            paced, value_of_time = choose_speeds(line, evaluator, latest, whole=True)
            if not math.isfinite(_cost_with_time_value(paced, evaluator, value_of_time)):
                return line
            line = optimise_line_offsets(
                paced, evaluator.with_value_of_time(value_of_time), rounds=_NEWTON_STEPS
            )
    return line


def _split_long_legs(line: Polyline, evaluator: CostEvaluator, longest: float) -> Polyline:
    """Halve the legs that are longer than ``longest`` [m], except canals."""
    canal = evaluator.canal_legs(line.lat, line.lon)
    return line.split(longest, ~canal)


def _split_at_zone_borders(line: Polyline, evaluator: CostEvaluator) -> Polyline:
    """Return the line with a waypoint where a leg enters or leaves the control areas."""
    chart = evaluator.chart
    if chart is None or not chart.zones.eca or not evaluator.prices.differs_in_control_areas:
        return line
    share = chart.zones.eca_fraction(line.lat[:-1], line.lon[:-1], line.lat[1:], line.lon[1:])
    crossed = (share > _MIN_ZONE_SHARE) & (share < 1.0 - _MIN_ZONE_SHARE)
    crossed &= ~evaluator.canal_legs(line.lat, line.lon)
    legs = np.flatnonzero(crossed)
    if not len(legs):
        return line
    inside = chart.zones.in_eca(line.lat[legs], line.lon[legs])
    at = np.where(inside, share[legs], 1.0 - share[legs])
    length, course, _ = inverse(
        line.lat[legs], line.lon[legs], line.lat[legs + 1], line.lon[legs + 1]
    )
    lat, lon = direct(line.lat[legs], line.lon[legs], course, at * length)
    return Polyline(
        np.insert(line.lat, legs + 1, lat),
        unwrap_longitude(np.insert(line.lon, legs + 1, lon)),
        np.insert(line.leave, legs + 1, -math.inf),
        np.insert(line.setting, legs, line.setting[legs]),
        line.depart,
    )


def _score_on_time(
    line: Polyline,
    evaluator: CostEvaluator,
    latest: float,
    score: Callable[[Track], Route],
    value: Callable[[Route], float],
) -> Route:
    """Return the route of a line with settings chosen so that it arrives in time."""
    target = latest - evaluator.origin
    budget, exact = target, _ARRIVAL_TOLERANCE * target
    found: list[Route] = []
    for _ in range(_MAX_ARRIVAL_CORRECTIONS):
        route = score(track_of_polyline(choose_speeds(line, evaluator, budget)[0], evaluator))
        found.append(route)
        late = route.arrive - latest
        if not math.isfinite(late) or -exact <= late <= 0.0:
            break
        budget -= late + 0.3 * exact
    return min(found, key=value)
