"""The certified lower bound of one stretch."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.chart.depth.closed_shoals import CLOSED_SHOALS
from thalweg.chart.zones.traffic_schemes import INSHORE
from thalweg.core.limits import Limits
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH
from thalweg.planning.planning_context import PlanningContext, greatest_speed_of
from thalweg.planning.report.route_summary import canals_passed
from thalweg.planning.request.chart_restrictions import IN_WATER
from thalweg.route import Route
from thalweg.sea import Sea
from thalweg.search import LowerBound
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import ShipInBarrier
from thalweg.search.certificate.departure_certificate import certify_departures
from thalweg.search.certificate.positions_in_reach import Reach
from thalweg.search.certificate.raster_path import fast_path_on_raster
from thalweg.search.certificate.time_certificate import (
    TimeCertificate,
    certify_priced_length,
    certify_time,
)
from thalweg.ship import PerformanceTable, TableError, TablePart
from thalweg.ship.models.function_model import FunctionModel

if TYPE_CHECKING:
    from thalweg.chart import Chart

_BARRIER_KIND = (
    "certificate: no ship gets ahead of an arrival-time function that was checked in every cell "
    "of a mesh ({cells} cells along the way)"
)
_GEODESIC_KIND = "certificate: the geodesic at the greatest speed over ground in the data"
_ROUND_LAND_KIND = (
    "certificate: the least length round land at the greatest speed over ground in the data"
)
_HOLDS_FOR = "; it holds for all routes in open water"
#: Of bounds that count inshore traffic zones as closed.
KEEPING_OUT = "that keep out of inshore traffic zones"
#: Tables of ships whose speed varies have an error; bounds are lowered by this share.
TABLE_MARGIN = 1e-3
#: A bound this share above the value of a route contradicts it.
_CONTRADICTION = 2e-3
_NOT_SAILED = "no bound: the route breaks a limit"
_NEAR_LIMIT = 1.0  # of the latitudes of a chart, at which a bound names them [deg]
LONGEST_PROOF = 30.0  #: by default [s]
_SHORTEST_PROOF = 1.0
_FOR_SMALL_SHIPS = "small_or_local"  # use of passages that save little
#: Likewise where a passage of trade is closed: the way round it needs outlines of all land beside.
_PROOF_ROUND_CLOSED = 15.0
_CELLS_FOR_CURRENT = 100  # where the data are no finer
_CELLS_OF_PATH = 800  # of functions, along the longer side
#: Cells of functions in the spacing of a network that is coarser than usual, and how many at least.
_CELLS_OF_SPACING, _FEWEST_CELLS_OF_PATH = 10, 100
_CONTRADICTED = (
    "no bound: in {sampling} the route of the plan would not be possible in its time, so that a "
    "bound for that sea is not valid; more time for the proof samples it more closely, and bounds "
    "of how fast its functions change (lipschitz) make one for the functions themselves"
)
_ENCLOSED = (
    "no bound: the proof gives {bound}, but the route of the plan needs less; land or limits "
    "in the proof may enclose an end that the route leaves"
)


def certified_bound(
    context: PlanningContext,
    route: Route,
    *,
    departures: tuple[float, float],
    seconds: float,
) -> LowerBound:
    """Return a lower bound of the time, or the distance, of every route of a stretch.

    Parameters
    ----------
    route : A feasible route of the stretch.
    departures : First and last departure that the bound holds for [s since 1970-01-01T00:00Z].
    seconds : Time that the search for the bound may take [s]; 0 for that of the geodesic alone.

    Returns
    -------
    LowerBound : In seconds or metres; NaN where there is none, with the reason.
    """
    if not route.feasible:
        return no_bound(_NOT_SAILED)
    context.report_progress("proving a lower bound")
    by_length = context.voyage.objective == "distance"
    stretch = _still_water(context, route) if by_length else _stretch(context, route)
    if not by_length:
        stretch = replace(stretch, depart=departures[0], latest=departures[1])
    found = certify_departures(stretch, seconds=seconds)
    margin = 1.0 if by_length else 1.0 - _table_margin(context)
    if found.reached * margin > stretch.known * (1.0 + _CONTRADICTION) + route.tolerance_s:
        return no_bound(_contradicted(found, stretch.known, by_length=by_length))
    return LowerBound(min(found.value * margin, stretch.known), _kind(context, route, found))


def usual_proof_time(chart: Chart, routes: Sequence[Route], searched: float) -> float:
    """Return the time for the proof of a bound [s]: as long as the search, within limits.

    Parameters
    ----------
    chart : With the passages that are closed to the ship.
    routes : Of the stretches of a voyage.
    searched : Time of the search [s].
    """
    least = _SHORTEST_PROOF
    closed = [passage for passage in chart.closed_passages if passage.use != _FOR_SMALL_SHIPS]
    for route in routes if closed else ():
        reach = Reach(*_ends(route), float(route.legs["length"].sum()))
        if any(reach.has(*passage.positions).any() for passage in closed):
            least = _PROOF_ROUND_CLOSED
    return min(max(searched, least), LONGEST_PROOF)


def path_through_data(
    context: PlanningContext, route: Route
) -> tuple[FloatArray, FloatArray] | None:
    """Return positions (lat, lon) [deg] of a fast way through the data, finer than a network.

    Parameters
    ----------
    route : A feasible route of the stretch.

    Returns
    -------
    pair of float64 array, or None
        None without currents, for ships that weather slows down, and for the least distance.
    """
    currents = {CURRENT_EAST, CURRENT_NORTH} <= set(context.needs.channels)
    simple = not context.table.axes and context.ship.speed_field is None
    if not (currents and simple and route.feasible) or context.voyage.objective == "distance":
        return None
    stretch, spacing = _stretch(context, route), context.choice.spacing
    cells = _CELLS_OF_PATH
    if spacing is not None:
        cells = min(cells, round(_CELLS_OF_SPACING * stretch.length / spacing))
    return fast_path_on_raster(stretch, max(cells, _FEWEST_CELLS_OF_PATH))


def certified_distance(
    context: PlanningContext,
    routes: Sequence[Route],
    *,
    price: float = 1.0,
    longer: Mapping[str, float] = MappingProxyType({}),
    seconds: float,
) -> LowerBound:
    """Return a lower bound of the length [m] of every route between the ends of some routes.

    Parameters
    ----------
    routes : Feasible routes between the same ends.
    price : What a metre inside the control areas counts, 1 or more; others count 1.
    longer : By how much canals count as longer than they are, by name [m].
    seconds : Time that the search for the bound may take [s].

    Returns
    -------
    LowerBound : With the lengths of canals on the way; NaN where there is no mesh.
    """
    canals = tuple(
        replace(canal, transit_time=canal.length + longer.get(canal.name, 0.0))
        for canal in context.chart.canals
    )
    stretch = replace(
        _still_water(context, routes[0]),
        chart=replace(context.chart, canals=canals),
        known=min(priced_length(route, context.chart, price, longer) for route in routes),
        kept_out=kept_out(context.chart, routes),
    )
    if price == 1.0:
        return LowerBound(certify_time(stretch, seconds=seconds).value, "")
    found = certify_priced_length(stretch, price, seconds=seconds)
    return no_bound("") if found is None else LowerBound(found.value, "")


def kept_out(chart: Chart, routes: Sequence[Route]) -> tuple[Any, ...]:
    """Return the inshore traffic zones (shapely polygons) that none of some routes enters.

    Ships on their way to other places keep out of them (Rule 10 (d)): bounds are for such routes.
    """
    lanes, entered = chart.zones.lanes, set()
    zones = [number for number, lane in enumerate(lanes) if lane.name.endswith(INSHORE)]
    for route in routes if zones else ():
        lat, lon = np.asarray(route.track.lat, float), np.asarray(route.track.lon, float)
        _, lane, share = chart.zones.lane_group.shares_against(lat[:-1], lon[:-1], lat[1:], lon[1:])
        entered.update(np.asarray(lane)[np.asarray(share) > 0.0].tolist())
    return tuple(lanes[number].shape for number in zones if number not in entered)


def priced_length(
    route: Route,
    chart: Chart,
    price: float = 1.0,
    longer: Mapping[str, float] = MappingProxyType({}),
) -> float:
    """Return the length of a route [m] as `certified_distance` counts it."""
    lengths = np.asarray(route.legs["length"], float)
    if price != 1.0:
        lat, lon = route.track.lat, route.track.lon
        inside = np.asarray(chart.zones.eca_fraction(lat[:-1], lon[:-1], lat[1:], lon[1:]))
        lengths = lengths * (1.0 + (price - 1.0) * inside)
    extra = sum(longer.get(canal.name, 0.0) for canal in canals_passed(route, chart))
    return float(lengths.sum()) + extra


def certified_total(
    context: PlanningContext,
    routes: Sequence[Route],
    departures: tuple[float, float],
    *,
    seconds: float,
) -> LowerBound:
    """Return a lower bound of all routes of a voyage: the sum of those of its stretches.

    Parameters
    ----------
    routes : Of the stretches between the ends and the via points, in order.
    departures : First and last departure of the voyage [s since 1970-01-01T00:00Z].
    seconds : Time that the search for the bounds may take [s].

    Returns
    -------
    LowerBound : In seconds or metres; NaN where there is none, with the reason.

    Notes
    -----
    A better voyage may pass a via point at another time. It leaves it no earlier than the bounds
    of the stretches before allow, and no later than those of the stretches after leave for an
    arrival in the time of the voyage that is known. Each stretch is bounded for all departures
    between these times.
    """
    if len(routes) == 1:
        return certified_bound(context, routes[0], departures=departures, seconds=seconds)
    first, last = departures
    end = last + (routes[-1].arrive - routes[0].depart)
    if not all(route.feasible for route in routes):
        return no_bound(_NOT_SAILED)
    least = [certified_bound(context, one, departures=(first, end), seconds=0.0) for one in routes]
    timed = context.voyage.objective != "distance"
    whole = sum(route.time_h for route in routes)
    for number, route in enumerate(routes):
        before = sum(bound.value for bound in least[:number]) * timed
        after = sum(bound.value for bound in least[number:]) * timed
        period = (first + before, end - after) if number else (first, last)
        share = seconds * route.time_h / whole
        found = certified_bound(context, route, departures=period, seconds=share)
        if not found.value <= least[number].value:
            least[number] = found
    kind = f"{least[0].kind}; sum of {len(routes)} stretches, each for all departures that may win"
    return LowerBound(sum(bound.value for bound in least), kind)


@dataclass(frozen=True, eq=False)
class CurrentsInReach:
    """The currents in all water from which a route of some time can be sailed.

    Attributes
    ----------
    stretch : Of the route, with currents as all there is in the sea.
    domain : None near a pole and across half of the globe.
    """

    stretch: StretchToBound
    domain: BarrierDomain | None

    def strongest(self) -> tuple[float, str]:
        """Return the strongest current that a ship can meet [m/s], and how the sea was sampled.

        The text is empty where the data themselves were read.
        """
        domain = self.domain or BarrierDomain.of_globe(self.stretch, _CELLS_FOR_CURRENT)
        return domain.strongest_current, domain.sampling


def currents_in_reach(
    context: PlanningContext, route: Route, *, longest: float
) -> CurrentsInReach | None:
    """Return the currents that a ship can reach in the ``longest`` time [s]; None without any."""
    stretch = _stretch(context, route)
    if len(stretch.currents) < 2:
        return None
    stretch = replace(stretch, channels=stretch.currents, known=max(longest, stretch.known))
    return CurrentsInReach(stretch, BarrierDomain.around(stretch, _CELLS_FOR_CURRENT))


def _contradicted(found: TimeCertificate, known: float, *, by_length: bool) -> str:
    """Return why a bound above a route is not published."""
    if found.sampling:
        return _CONTRADICTED.format(sampling=found.sampling)
    reached = found.reached
    bound = f"at least {reached / 1e3:.1f} km" if by_length else f"at least {reached / HOUR:.2f} h"
    # what encloses an end lets nobody through: the value of the barrier there has no meaning
    return _ENCLOSED.format(bound=bound if reached < 2.0 * known else "that there is no way")


def no_bound(why: str) -> LowerBound:
    """Return the bound of a plan that has none, with the reason."""
    return LowerBound(math.nan, why)


def _kind(context: PlanningContext, route: Route, found: TimeCertificate) -> str:
    """Return how a bound was found and what it holds for, as text."""
    text = _BARRIER_KIND.format(cells=found.cells) if found.cells else _GEODESIC_KIND
    text = _ROUND_LAND_KIND if found.round_land else text
    by_land = bool(found.cells) or found.round_land
    text += _HOLDS_FOR + (f" {KEEPING_OUT}" if by_land and kept_out(context.chart, [route]) else "")
    counted = []
    if by_land:
        zones = context.chart.zones
        counted = ["land"] if found.cells else []
        counted += ["the offing"] if found.cells and context.chart.offing.distance > 0.0 else []
        counted += ["no-go zones"] if zones.no_go else []
        counted += [CLOSED_SHOALS] if zones.closed_shoals else []
        counted += ["canals"] if found.mesh is not None and found.mesh.links else []
    text += f" with {', '.join(counted)}" if counted else ""
    text += _latitudes(context, route)
    if context.chart.zones.has_penalty:
        text += ", without the penalties of zones, shoals and traffic lanes"
    if context.table.axes and isinstance(context.ship.model, FunctionModel):
        text += f", for a table of the ship's function, {context.table.error.max:.1%} off at most"
    return text + (f", in {found.sampling}" if found.sampling else "")


def _table_margin(context: PlanningContext) -> float:
    """Return the share by which a bound is lowered for the error of the ship's table."""
    found = context.table.error.max if isinstance(context.ship.model, FunctionModel) else 0.0
    return min(max(TABLE_MARGIN, found), 1.0) if context.table.axes else 0.0


def _latitudes(context: PlanningContext, route: Route) -> str:
    """Return the latitudes of the water of a bound, where the route is near them, as text."""
    area, lat = context.chart.area, np.asarray(route.track.lat, float)
    south = f"north of {-area.south:g} S" if lat.min() < area.south + _NEAR_LIMIT < 0.0 else ""
    north = f"south of {area.north:g} N" if lat.max() > area.north - _NEAR_LIMIT > 0.0 else ""
    named = " and ".join(filter(None, (south, north)))
    return f", {IN_WATER}{named}" if named and area.width >= 360.0 else ""


def _stretch(context: PlanningContext, route: Route) -> StretchToBound:
    top = greatest_speed_of(context.ship, context.table, context.setting)
    field = context.ship.speed_field
    if field is not None:
        top = math.nan
    elif context.sea_is_calm:  # the table has following wind and seas, too
        top = float(context.ship.speeds[context.setting])
    ship = ShipInBarrier(
        context.table.before_closing().kernel_arrays(),
        context.setting,
        context.needs.limits.array,
        top,
        field,
    )
    return StretchToBound(
        context.sea, context.chart, ship, context.needs.channels, *_ends(route),
        depart=route.depart, known=route.time_h * HOUR,
        kept_out=kept_out(context.chart, [route]),
    )  # fmt: skip


def _still_water(context: PlanningContext, route: Route) -> StretchToBound:
    """Return the stretch for a ship of 1 m/s in still water, whose time is the distance."""
    part = TablePart((), (), np.ones(1, np.float32))
    table = PerformanceTable((part,), np.ones(1), "", TableError(0.0, 0.0, 0.0))
    ship = ShipInBarrier(table.kernel_arrays(), 0, Limits().array, 1.0)
    length = float(route.legs["length"].sum())
    canals = tuple(replace(canal, transit_time=canal.length) for canal in context.chart.canals)
    return StretchToBound(
        Sea.calm(),
        replace(context.chart, canals=canals),
        ship,
        (),
        *_ends(route),
        depart=route.depart,
        known=length,
        kept_out=kept_out(context.chart, [route]),
    )


def _ends(route: Route) -> tuple[tuple[float, float], tuple[float, float]]:
    lat, lon = route.track.lat, route.track.lon
    return (float(lat[0]), float(lon[0])), (float(lat[-1]), float(lon[-1]))
