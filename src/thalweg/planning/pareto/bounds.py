"""The lower bound of a Pareto front by mixtures of speeds over the least length."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.zones.leg_fractions import outlines_only
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.geodesy import METRES_PER_DEGREE, distance
from thalweg.core.pareto_fronts import lower_hull
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.kernels.geometry.coast_index import outlines_touched
from thalweg.planning.pareto.exploration import strongest_current
from thalweg.planning.pareto.trade_off_context import ExploredAlternative, TradeOffContext
from thalweg.planning.plan_data import Proof
from thalweg.planning.plan_front import certain_at
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.single.certified_bound import certified_distance, strongest_current_in_data
from thalweg.route import Route
from thalweg.search import table_bounds

_KIND = (
    "certificate: the least length of a route round land at mixtures of the speeds, with the "
    "strongest current in the data and the least rates and prices"
)
_CURRENT_UNKNOWN = (
    "no bound: the strongest current of the water that the ship can reach was not found"
)
_NOTHING_LEAST = "no bound: the least that the data allow is zero"
_OUTLINE_STEP = 0.05  # between positions on the outlines of control areas [deg]
_BESIDE_OUTLINE = 1e-4  # [deg]
_SECONDS = 2.0  # for the bound of the length, by default


def derive_proof(
    trade_off: TradeOffContext,
    explored: list[ExploredAlternative],
    certain: FloatArray,
    kind: str,
    *,
    until: float,
) -> Proof:
    """Return the bound of a plan: of the least time for a whole front, else of the objective.

    Parameters
    ----------
    certain : A front that no route is below: hours and values, (2, m).
    kind : How it was found.
    until : Longest time of the routes that the bound is for [h].
    """
    if trade_off.context.voyage.objective == "front":
        fastest = min(one.first.duration for one in explored) / HOUR
        return _proof(float(certain[0].min()), kind, fastest)
    points = [point for one in explored if one.exact for point in one.exact.points]
    solver = min((point.cost for point in points), default=math.nan)
    return _proof(certain_at(certain, until), kind, solver)


def _proof(value: float, kind: str, solver: float) -> Proof:
    """Return a bound; none where it is zero, as of comfort: a ship may be without motions."""
    if value > 0.0:
        return Proof(value, kind, solver)
    return Proof(math.nan, kind if kind.startswith("no bound") else _NOTHING_LEAST, solver)


def strongest_current_of_plan(
    trade_off: TradeOffContext, explored: list[ExploredAlternative], routes: Sequence[Route]
) -> tuple[float, str]:
    """Return the strongest current [m/s] for the bound of a front, and the kind of the bound.

    Parameters
    ----------
    routes : Of the front.
    """
    context = trade_off.context
    if not {codes.CURRENT_EAST, codes.CURRENT_NORTH} <= set(context.needs.channels):
        return 0.0, _KIND
    feasible = [route for route in routes if route.feasible]
    if not feasible or trade_off.interrupt_guard.stopped():
        return math.inf, _CURRENT_UNKNOWN
    found = strongest_current_in_data(context, max(feasible, key=lambda route: route.time_h))
    at_stations = max(strongest_current(one.frozen.stations) for one in explored)
    return max(found[0], at_stations), _KIND + (f", in {found[1]}" if found[1] else "")


def certain_front(trade_off: TradeOffContext, length: float, current: float) -> FloatArray:
    """Return a lower front that holds for every route: hours and values (2, m), to join by lines.

    Parameters
    ----------
    length : No route is shorter [m].
    current : No current is stronger [m/s]; inf where none is known to be the strongest.

    Notes
    -----
    At a setting a route covers a metre in no less than ``1 / v`` seconds, with the ship's top speed
    and the strongest current, for no less than ``rate / v``, with the least rate of consumption
    and the least price. A route that mixes settings has time and value above a mean of these
    points: not below their lower convex hull. At the ends the price is that of control areas, as
    far as it takes to leave them.
    """
    context, prices = trade_off.context, trade_off.objective.prices
    rates = np.maximum(table_bounds(trade_off.consumption.kernel_arrays(), np.fmin), 0.0)
    rates = rates[trade_off.settings]
    top = np.array([float(context.ship.top_speed(int(s)) or math.inf) for s in trade_off.settings])
    zone_factor = 1.0
    if prices.dues > 0.0:  # a route off the network may sail in the cheapest zone throughout
        zone_factor = min([1.0, *(float(factor) for _, factor in context.chart.zones.price)])
    inside = 0.0
    if prices.inside > prices.outside:
        ends = trade_off.ends[0], trade_off.ends[-1]
        inside = min(length, sum(_least_to_leave(context.chart, end) for end in ends))
    parts = [(inside, prices.inside), (length - inside, min(prices.inside, prices.outside))]
    slow = 1.0 / (top + current)
    (time, value), (more_time, more_value) = (
        (part * slow, part * slow * (zone_factor * price * rates + prices.time))
        for part, price in parts
    )
    seconds = np.add.outer(time, more_time).ravel()
    values = np.add.outer(value, more_value).ravel()
    hull = lower_hull(seconds, values)
    hull = hull[: int(np.argmin(values[hull])) + 1]
    return np.array([seconds[hull] / HOUR, values[hull]])


def _least_to_leave(chart: Chart, end: Endpoint) -> float:
    """Return a length [m] that no way out of the control areas is shorter than; 0 outside them.

    A ship leaves them where an outline is in water and no other area is beyond it, or through a
    canal that leads out.
    """
    zones = chart.zones
    if not bool(zones.in_eca(end.lat, end.lon)):
        return 0.0
    least = math.inf
    coast = outlines_only(chart.coastline.index)
    for zone in zones.eca:
        rings = zone.rings
        for first, last in itertools.pairwise(rings.start):
            lat, lon = rings.lat[first:last], rings.lon[first:last]
            pieces = np.ceil(np.hypot(np.diff(lat), np.diff(lon)) / _OUTLINE_STEP)
            place = np.concatenate([[0.0], np.cumsum(np.maximum(pieces, 1.0))])
            along = np.arange(place[-1] + 1.0)
            lat, lon = np.interp(along, place, lat), np.interp(along, place, lon)
            ends = lat[:-1], lon[:-1], lat[1:], lon[1:]
            shore = np.empty(len(lat) - 1, np.bool_)
            outlines_touched(coast, *(np.ascontiguousarray(x) for x in ends), shore)
            land = np.asarray(chart.coastline.shore_distance(lat[:-1], lon[:-1], cap=1.0)) <= 0.0
            away = np.asarray(distance(end.lat, end.lon, lat, lon))
            leads_out = (shore | ~land) & ~_between_areas(zones, *ends)
            near = np.minimum(away[:-1], away[1:])[leads_out]
            least = min(least, float(np.min(near, initial=math.inf)))
    least -= 0.5 * _OUTLINE_STEP * METRES_PER_DEGREE
    for canal in chart.canals:
        lat, lon = np.array(canal.ends).T
        inside = zones.in_eca(lat, lon)
        if inside.any() and not inside.all():
            least = min(least, float(np.min(distance(end.lat, end.lon, lat, lon))))
    return max(least, 0.0)


def _between_areas(zones: Zones, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray,
                   lon2: FloatArray) -> BoolArray:  # fmt: skip
    """Return on which pieces of outlines [deg] there are control areas on both sides."""
    both = np.ones(len(lat1), np.bool_)
    for share in (0.0, 0.5, 1.0):
        lat, lon = lat1 + share * (lat2 - lat1), lon1 + share * (lon2 - lon1)
        for north, east in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)):
            both &= zones.in_eca(lat + _BESIDE_OUTLINE * north, lon + _BESIDE_OUTLINE * east)
    return both


def certified_length(trade_off: TradeOffContext, routes: Sequence[Route]) -> float:
    """Return a length [m] that no route is shorter than.

    Round land, with the offing and no-go zones, where there are neither via points nor canals on
    the way; otherwise that of the geodesics.
    """
    context, ends = trade_off.context, trade_off.ends
    geodesic = sum(float(distance(a.lat, a.lon, b.lat, b.lon)) for a, b in itertools.pairwise(ends))
    feasible = [route for route in routes if route.feasible]
    seconds = context.proof_seconds if context.proof_seconds is not None else _SECONDS
    if len(ends) > 2 or not feasible or trade_off.interrupt_guard.stopped():
        return geodesic
    shortest = min(feasible, key=lambda route: float(route.legs["length"].sum()))
    found = certified_distance(context, shortest, seconds=seconds)
    return max(geodesic, found.value) if math.isfinite(found.value) else geodesic
