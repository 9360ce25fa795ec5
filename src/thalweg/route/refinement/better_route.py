"""A better route than a given one, as evaluated by the referee."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.geodesy import unwrap_longitude
from thalweg.core.limits import TIGHTENING, Limits
from thalweg.kernels import codes
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.route.canal_legs import canal_legs, sea_stretches
from thalweg.route.evaluators.time_evaluator import penalty_factors
from thalweg.route.referee.evaluation import evaluate
from thalweg.route.referee.sailing_physics import make_sailing_environment
from thalweg.route.referee.wind_speed_only import with_wind_speed
from thalweg.route.refinement.feasible_interpolation import bisect_to_feasible
from thalweg.route.refinement.interface_points import with_interface_points
from thalweg.route.refinement.simplification import simplified_route
from thalweg.route.refinement.smoothing import smooth
from thalweg.route.route import Route
from thalweg.route.sea_raster import RasterSize, freeze_raster
from thalweg.route.track import Track
from thalweg.sea.standard_names import CHANNEL_VARIABLES

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import GridFields, Sea
    from thalweg.ship import PerformanceTable, Ship

LARGEST_RASTER = 4_000_000  #: numbers in the frozen raster of the sea around a track
_CELLS = 12, 400  # least and greatest number of cells along the longer side of the track
_RASTER_MARGINS = (
    0.2,
    0.4,
    0.6,
)  # margins around the track, as shares of its box, tried while a track comes near the edge
_RASTER_EDGE_SHARE = 0.04  # distance to the edge that counts as near, as a share of the raster
# (step of `TIGHTENING`, whether it may wait anywhere), in the order of attempts
_ATTEMPTS = ((0, True), (1, True), (2, True), (3, True), (0, False), (2, False))
_ATTEMPTS_WITHOUT_WAITING = 4  # those that differ for a ship that does not wait
_WAIT_TOLERANCE = 0.5  # seconds to which waits are shortened, or this share of the voyage if less:
_WAIT_TOLERANCE_SHARE = 1e-5
_FIRST_SHORTER = 30.0  # by which a wait is shortened first [s]
_WAIT_EXTENSIONS = (
    0.0,
    120.0,
    600.0,
    1800.0,
)  # seconds by which a wait may grow when the referee finds violations

ScoreFunction = Callable[[Track], Route]


@dataclass(frozen=True, eq=False)
class RefinementConditions:
    """Ship, sea, chart and limits that a route is refined with.

    Attributes
    ----------
    ship : Ship
    sea : Sea
    chart : Chart or None
    table : PerformanceTable or TableArrays
        Speed through water of the ship [m/s].
    limits : Limits
        Limits along the route (`thalweg.core.limits.Limits`).
    min_ukc : float, optional
        As for `evaluate`.
    holds_settings : bool
        Whether the ship keeps the speed settings of the route where speeds would be chosen.
    """

    ship: Ship
    sea: Sea
    chart: Chart | None
    table: PerformanceTable | TableArrays
    limits: Limits
    min_ukc: float | None = None
    holds_settings: bool = False


def better_route(
    scored: Route,
    conditions: RefinementConditions,
    *,
    objective: str = "time",
    wait: bool | None = None,
) -> Route:
    """Smooth a route and return the better of the two, as evaluated by the referee.

    Parameters
    ----------
    scored : Route
        As evaluated by the referee.
    conditions : RefinementConditions
        Ship, sea, chart and limits.
    objective : {"time", "distance"}
    wait : bool, optional
        Whether the ship may wait where it did not before; by default only if it waits somewhere.

    Returns
    -------
    Route
        Evaluated by the referee; not worse than the given one, and feasible if the given one is.
    """
    ship, sea, chart = conditions.ship, conditions.sea, conditions.chart
    table, limits, min_ukc = conditions.table, conditions.limits, conditions.min_ukc

    def score(track: Track) -> Route:
        return evaluate(track, ship=ship, sea=sea, chart=chart, min_ukc=min_ukc, strict=False)

    if canal_legs(scored.track, chart).any:
        better = partial(better_route, conditions=conditions, objective=objective, wait=wait)
        refined = _refine_between_canals(scored, chart, score, better)
        return min(scored, refined, key=lambda item: comparison_key(item, objective, chart))
    best, infeasible = scored, None
    may_wait = bool(scored.track.wait.any()) if wait is None else wait
    for step, patient in _ATTEMPTS[: None if may_wait else _ATTEMPTS_WITHOUT_WAITING]:
        track = scored.track
        for edge in _RASTER_MARGINS:
            fields = freeze_around_track(scored, track, edge, ship=ship, sea=sea, limits=limits)
            track = smooth(
                track,
                table=table,
                fields=fields,
                limits=limits.tightened(TIGHTENING[step]),
                chart=chart,
                objective=objective,
                wait=may_wait and patient,
            )
            if objective == "distance" or not _touches_raster_edge(track, fields):
                break
        route = shorten_waits(score(track), score) if track != scored.track else scored
        best = min(best, route, key=lambda item: comparison_key(item, objective, chart))
        if route.feasible:
            break
        if best is scored and scored.feasible and math.isfinite(route.arrive):
            infeasible = track if infeasible is None else infeasible
    if best is scored and infeasible is not None:
        best = bisect_to_feasible(scored, infeasible, score)
    best = shorten_waits(best, score)
    if objective != "distance":
        world = make_sailing_environment(ship, with_wind_speed(ship, sea), chart)
        bent = with_interface_points(best, world, score)
        best = min(best, bent, key=lambda item: comparison_key(item, objective, chart))
    most = comparison_key(scored, objective, chart)[1] if scored.feasible else math.inf
    return simplified_route(
        best, score, lambda item: comparison_key(item, objective, chart)[1], most=most
    )


def _refine_between_canals(
    scored: Route, chart: Chart | None, score: ScoreFunction, better: Callable[[Route], Route]
) -> Route:
    """Return the route with its stretches between canals refined, one after the other."""
    route = scored
    for number in range(len(sea_stretches(scored.track, chart))):
        track = route.track
        first, last = sea_stretches(track, chart)[number]
        depart = track.depart if first == 0 else float(route.legs["arrive"][first - 1])
        if not math.isfinite(depart):
            break
        part = better(score(track.part(first, last, depart))).track
        route = score(track.with_part(first, last, part))
    return route


def freeze_around_track(
    route: Route,
    track: Track,
    margin: float,
    *,
    ship: Ship,
    sea: Sea,
    limits: Limits,
    until: float | None = None,
) -> GridFields:
    """Freeze the sea on a raster around a track, as fine as the data and a size limit allow.

    Parameters
    ----------
    route : For the duration of the voyage.
    margin : Margin on all sides, as a share of the longer side of the box around the track.
    until : Latest arrival [s since 1970-01-01T00:00Z]; by default that of the route.
    """
    start = track.depart
    arrive = route.arrive if math.isfinite(route.arrive) else start + 2.0 * _usual(route, ship)
    arrive = arrive if until is None else max(arrive, until)
    end = start + 1.1 * (arrive - start) + 600.0
    channels = _channels(ship, sea, limits)
    extra = {codes.SPEED_FIELD: ship.speed_field} if ship.speed_field is not None else None
    size = RasterSize(margin, *_CELLS, LARGEST_RASTER)
    lon = unwrap_longitude(track.lon)
    return freeze_raster(sea, track.lat, lon, (start, end), channels, size, extra=extra)


def _touches_raster_edge(track: Track, fields: GridFields) -> bool:
    """Return whether a track is so near to the edge of a raster that this may constrain it."""
    rows, columns = fields.values.shape[1:3]
    y = (track.lat - fields.lat0) / (fields.dlat * (rows - 1))
    x = ((track.lon - fields.lon0) % 360.0) / (fields.dlon * (columns - 1))
    return bool(min(y.min(), x.min(), 1.0 - y.max(), 1.0 - x.max()) < _RASTER_EDGE_SHARE)


def shorten_waits(route: Route, score: ScoreFunction) -> Route:
    """Return the route with every wait as short as is feasible for the referee, to half a second.

    Frozen fields blur the time at which a bar opens by up to one of their time steps; the referee
    knows it exactly. A wait that is too short is extended first.

    Parameters
    ----------
    route : Route
        As evaluated by the referee.
    score : callable
        The referee: a track to its route.

    Returns
    -------
    Route
        The given one if it has no waits.
    """
    waiting = np.flatnonzero(route.track.wait)
    if not waiting.size:
        return route
    if not route.feasible:
        for longer in _WAIT_EXTENSIONS[1:]:
            later = score(_with_wait(route.track, int(waiting[-1]), longer))
            if later.feasible:
                route = later
                break
        else:
            return route
    for index in waiting:
        route = _shorten_wait(route, int(index), score)
    return route


def _shorten_wait(route: Route, index: int, score: ScoreFunction) -> Route:
    """Bisect between a wait that is too short and one that is long enough.

    The given wait is nearly right as a rule: the first steps are short and grow.
    """
    long_enough = float(route.track.wait[index])
    none = score(_with_wait(route.track, index, -long_enough))
    if none.feasible:
        return none if none.arrive <= route.arrive else route
    best, track, too_short, less = route, route.track, 0.0, _FIRST_SHORTER
    exact = min(_WAIT_TOLERANCE, _WAIT_TOLERANCE_SHARE * (route.arrive - route.depart))
    while long_enough - too_short > exact:
        tried = max(0.5 * (too_short + long_enough), long_enough - less)
        shorter = score(_with_wait(track, index, tried - float(track.wait[index])))
        if shorter.feasible and shorter.arrive <= best.arrive:
            best, long_enough, less = shorter, tried, 8.0 * less
        else:
            too_short, less = tried, math.inf
    return best


def _with_wait(track: Track, index: int, change: float) -> Track:
    """Return the track with one wait changed and the next one still ending when it did."""
    wait = np.array(track.wait)
    wait[index] = max(wait[index] + change, 0.0)
    later = np.flatnonzero(wait[index + 1 :])
    if later.size:
        following = index + 1 + int(later[0])
        wait[following] = max(wait[following] - change, 0.0)
    return track.replaced(wait=wait)


def comparison_key(route: Route, objective: str, chart: Chart | None) -> tuple[int, float, float]:
    """Return the key by which routes are compared: violations, then the objective, then time.

    Parameters
    ----------
    objective : "distance", or time for all others.
    chart : Its penalty zones count.

    Returns
    -------
    violations : Number of exceeded limits; 0 for feasible routes.
    objective : [m] or [s], with the additions of penalty zones.
    arrive : float [s since 1970-01-01T00:00Z]
    """
    if not math.isfinite(route.arrive):
        return sys.maxsize, math.inf, math.inf
    sailed = route.legs["arrive"] - route.legs["depart"]
    spent = route.legs["length"] if objective == "distance" else sailed
    lat, lon = route.track.lat, route.track.lon
    factor = penalty_factors(chart, lat, lon)
    if factor is not None and chart is not None and chart.canals:  # as on the network
        factor[chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]) >= 0] = 1.0
    cost = float(np.sum(spent if factor is None else factor * spent))
    if objective != "distance":
        cost += float(route.track.wait.sum())
    return len(route.violations), cost, route.arrive


def penalty_excess(route: Route, objective: str, chart: Chart | None) -> float:
    """Return what penalty zones and shoals add to the objective of a route.

    Parameters
    ----------
    objective : "distance", or time for all others.

    Returns
    -------
    float : [m] or [s]; 0 for a route that breaks a limit.
    """
    if not route.feasible or chart is None or not chart.zones.has_penalty:
        return 0.0
    excess = comparison_key(route, objective, chart)[1] - comparison_key(route, objective, None)[1]
    return max(excess, 0.0)


def _usual(route: Route, ship: Ship) -> float:
    speeds = ship.speeds[np.isfinite(ship.speeds)]
    return float(route.legs["length"].sum()) / float(speeds[-1] if speeds.size else 5.0)


def _channels(ship: Ship, sea: Sea, limits: Limits) -> list[int]:
    """Return the channels that the kernels need."""
    names = {CHANNEL_VARIABLES[codes.CURRENT_EAST], CHANNEL_VARIABLES[codes.CURRENT_NORTH]}
    names |= ship.needs
    if limits.depth_checked or "depth" in ship.reads:
        names |= {CHANNEL_VARIABLES[codes.WATER_LEVEL], CHANNEL_VARIABLES[codes.BED_DEPTH]}
    return [c for c, name in CHANNEL_VARIABLES.items() if name in names and name in sea.variables]
