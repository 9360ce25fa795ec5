"""Polishing: the same passage in the same time for less fuel, money or CO2."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.geodesy import direct, inverse
from thalweg.core.time import TimeLike, parse_time
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.route.canal_legs import canal_ends
from thalweg.route.referee.evaluation import evaluate
from thalweg.route.refinement.better_route import freeze_around, tightened
from thalweg.route.refinement.cost_evaluator import Purse, Weights, make_purse
from thalweg.route.refinement.newton_offsets import bend
from thalweg.route.refinement.polyline import Line, line_of, track_of_line, unwrapped
from thalweg.route.refinement.simplification import thinned
from thalweg.route.refinement.smoothing import resampled
from thalweg.route.refinement.speed_profile import choose_paces
from thalweg.route.refinement.string_pulling import pull
from thalweg.route.refinement.time_evaluator import penalty_factors, rough_lengths
from thalweg.route.route import Route
from thalweg.route.track import Track
from thalweg.ship.tables.tabulate import tabulate_cubed_speed

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import GridFields, Sea
    from thalweg.ship import PerformanceTable, Ship
    from thalweg.ship.fuel_prices import FuelTerms

_COLUMN = {"fuel": "fuel", "cost": "cost", "co2": "co2"}
_MARGINS = (0.0, 0.005, 0.02)  # by which limits are tightened while the referee objects
_PARTS = (6, 12, 24, 48)  # least number of legs of each level
_TURNS = 2  # choices of settings and bendings of a level
_NEWTON = 4  # steps of a bending
_HOPEFUL = 1.02  # a coarse start is worked on if it costs no more than this times the own one
_TIMINGS = 4  # referees asked until the arrival fits
_ON_TIME = 2e-6  # share of the passage by which it may come early
_CROSSED = 0.02  # share of a leg in a control area, and out of it, that is worth a waypoint


def polish(
    scored: Route,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None,
    table: PerformanceTable | TableArrays,
    fuel: PerformanceTable | TableArrays,
    limits: ArrayLike,
    objective: str = "cost",
    arrive_by: TimeLike | None = None,
    terms: FuelTerms | None = None,
    min_ukc: float | None = 0.0,
    fields: GridFields | None = None,
    thin: bool = True,
) -> Route:
    """Return a route of the same way that costs less and arrives no later.

    Parameters
    ----------
    scored : Route
        As the referee found it, with the same terms.
    ship : Ship
    sea : Sea
    chart : Chart or None
    table, fuel : PerformanceTable or TableArrays
        Of the ship: speed through water [m/s] and fuel rate [kg/s] (`Ship.tabulate_fuel`). Where
        the cost is that of time and cubed speed (`FuelTerms.by_speed`) fuel is not looked at.
    limits : array_like of float
        Required depth [m], wave height [m] and wind speed [m/s] for the kernels.
    objective : {"fuel", "cost", "co2"}
    arrive_by : time, optional
        Latest arrival; by default when the given route arrives, and never earlier than that.
    terms : FuelTerms, optional
        What fuel and time cost; by default what the ship file says.
    min_ukc : float or None
        As for `evaluate`.
    fields : GridFields, optional
        The sea frozen around the route, to be used for many; by default frozen anew.
    thin : bool
        Leave out waypoints that make no difference (up to five more evaluations).

    Returns
    -------
    Route
        Scored by the referee; never worse than the given one: it keeps every limit, costs no more
        and arrives no later than ``arrive_by``. The given one if nothing better is found.
        Canals, waits and the order of the way stay.

    Raises
    ------
    InputError
        If there is no such objective, or a price it needs is unknown.

    Notes
    -----
    Level by level legs are halved, the settings chosen anew (`choose_paces`) and the waypoints bent
    sideways by Newton's method on cost plus the worth of time, which is the slope of cost over time
    that the settings leave. All this on frozen fields; the referee has the last word, and the
    time of arrival it finds is met by choosing settings again, to a few millionths of the passage.
    """
    terms = ship.fuel_terms if terms is None else terms
    weights = Weights.of(objective, terms, ship.waiting_fuel_rate)
    if weights.cubed:
        fuel = tabulate_cubed_speed(ship.speeds)
    latest = scored.arrive if arrive_by is None else max(parse_time(arrive_by), scored.arrive)
    if not (scored.feasible and math.isfinite(scored.arrive)):
        return scored

    def score(track: Track) -> Route:
        return evaluate(
            track, ship=ship, sea=sea, chart=chart, min_ukc=min_ukc, strict=False, terms=terms
        )

    def value(route: Route) -> float:
        good = route.feasible and route.arrive <= latest + 1e-6
        return _value(route, objective, chart) if good else math.inf

    frozen = fields
    if frozen is None:
        frozen = freeze_around(
            scored, scored.track, 0.2, ship=ship, sea=sea, limits=limits, until=latest
        )

    def purse_of(track: Track, margin: float) -> Purse:
        return make_purse(
            ship=ship,
            table=table,
            fuel=fuel,
            fields=frozen,
            limits=tightened(limits, margin),
            chart=chart,
            track=track,
            weights=weights,
        )

    best = _attempts(scored, latest, purse_of, score, value)
    if not thin:
        return best
    held = canal_ends(best.track, chart)
    return thinned(best, score, value, most=value(scored), held=held)


def _attempts(
    scored: Route,
    latest: float,
    purse_of: Callable[[Track, float], Purse],
    score: Callable[[Track], Route],
    value: Callable[[Route], float],
) -> Route:
    """Return the best of a route and what comes of working on it.

    A slower ship may meet weather that the route does not: if it cannot use the time it has, the
    route is worked on at its own arrival first.
    """

    def attempt(start: Route, target: float) -> Route:
        best = start
        for margin in _MARGINS:
            purse = purse_of(start.track, margin)
            line = _worked(line_of(start.track, purse), purse, target - start.depart)
            if line is None:
                break
            route = _in_time(line, purse, target, score, value)
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


def _value(route: Route, objective: str, chart: Chart | None) -> float:
    """Return what is made least, with what penalty zones add; inf where it is unknown."""
    legs = route.legs
    spent = legs[_COLUMN[objective]] + (legs["waiting_fuel"] if objective == "fuel" else 0.0)
    factor = penalty_factors(chart, route.track.lat, route.track.lon)
    total = float(np.sum(spent if factor is None else spent * factor))
    return total if math.isfinite(total) else math.inf


def _worked(line: Line, purse: Purse, latest: float) -> Line | None:
    """Return the cheapest line found that is in time; None if the given one cannot be sailed."""
    paced, worth = choose_paces(line, purse, latest)
    own = _price(paced, purse, worth)
    if not math.isfinite(own):
        return None
    starts = [pull(paced, purse.worth(worth))]
    if not np.isfinite(line.leave).any() and not _held(line, purse)[1:-1].any():
        for count in _PARTS[:2]:
            coarse = resampled(paced, count + 1)
            if len(line) > count + 1 and _price(coarse, purse, worth) <= _HOPEFUL * own:
                starts.append(coarse)
    found = [line, *(_levels(start, purse, latest, worth) for start in starts)]
    return min(found, key=lambda item: _in_time_cost(item, purse, latest, worth))


def _held(line: Line, purse: Purse) -> np.ndarray:
    return purse.fixed_points(line.lat, line.lon)


def _price(line: Line, purse: Purse, worth: float) -> float:
    """Return cost plus the worth of the time."""
    return float(purse.worth(worth).sail(line.bundle())[1][0])


def _in_time_cost(line: Line, purse: Purse, latest: float, worth: float) -> float:
    """Return the cost at the best settings, lateness at its worth (and then some)."""
    arrive, cost, _ = purse.spend(choose_paces(line, purse, latest)[0].bundle())
    late = max(float(arrive[0, -1]) - latest, 0.0)
    return float(cost[0]) + (2.0 * worth * late if late > 0.0 else 0.0)


def _levels(line: Line, purse: Purse, latest: float, worth: float) -> Line:
    """Refine a line level by level."""
    total = float(rough_lengths(line.lat, line.lon).sum())
    for number, parts in enumerate(_PARTS):
        while True:
            finer = _split(line, purse, total / parts)
            if len(finer) == len(line):
                break
            line = finer
        if number == len(_PARTS) - 1:
            line = _cut_at_borders(line, purse)
        for _ in range(_TURNS):
            paced, worth = choose_paces(line, purse, latest, whole=True)
            if not math.isfinite(_price(paced, purse, worth)):
                return line
            line = bend(paced, purse.worth(worth), rounds=_NEWTON)
    return line


def _split(line: Line, purse: Purse, longest: float) -> Line:
    """Halve the legs longer than that, but not canals."""
    canal = purse.canal_legs(line.lat, line.lon)
    return line.split(longest, ~canal)


def _cut_at_borders(line: Line, purse: Purse) -> Line:
    """Return the line with a waypoint where a leg enters or leaves the control areas."""
    chart = purse.chart
    if chart is None or not chart.zones.eca or purse.weights.inside == purse.weights.outside:
        return line
    share = chart.eca_share(line.lat[:-1], line.lon[:-1], line.lat[1:], line.lon[1:])
    crossed = (share > _CROSSED) & (share < 1.0 - _CROSSED)
    crossed &= ~purse.canal_legs(line.lat, line.lon)
    legs = np.flatnonzero(crossed)
    if not len(legs):
        return line
    inside = chart.in_eca(line.lat[legs], line.lon[legs])
    at = np.where(inside, share[legs], 1.0 - share[legs])
    length, course, _ = inverse(
        line.lat[legs], line.lon[legs], line.lat[legs + 1], line.lon[legs + 1]
    )
    lat, lon = direct(line.lat[legs], line.lon[legs], course, at * length)
    return Line(
        np.insert(line.lat, legs + 1, lat),
        unwrapped(np.insert(line.lon, legs + 1, lon)),
        np.insert(line.leave, legs + 1, -math.inf),
        np.insert(line.setting, legs, line.setting[legs]),
        line.depart,
    )


def _in_time(
    line: Line,
    purse: Purse,
    latest: float,
    score: Callable[[Track], Route],
    value: Callable[[Route], float],
) -> Route:
    """Let the referee score a line, its settings chosen so that it arrives when it should."""
    target = latest - purse.origin
    budget, exact = target, _ON_TIME * target
    found: list[Route] = []
    for _ in range(_TIMINGS):
        route = score(track_of_line(choose_paces(line, purse, budget)[0], purse))
        found.append(route)
        late = route.arrive - latest
        if not math.isfinite(late) or -exact <= late <= 0.0:
            break
        budget -= late + 0.3 * exact
    return min(found, key=value)
