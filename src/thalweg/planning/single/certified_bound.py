"""The certified lower bound of one passage."""

from __future__ import annotations

import numpy as np

from thalweg.core.limits import Limits
from thalweg.core.units import HOUR
from thalweg.planning.planning_context import PlanningContext
from thalweg.route import Route
from thalweg.sea import Sea
from thalweg.search import LowerBound
from thalweg.search.certificate.barrier_mesh import ShipInBarrier
from thalweg.search.certificate.time_certificate import PassageToBound, certify_time
from thalweg.ship import PerformanceTable, TableError, TablePart

_KIND = (
    "certificate: no ship gets ahead of an arrival-time function that was checked in every cell "
    "of a mesh ({cells} cells along the way); it holds for all routes in open water{sampling}"
)
#: Tables of ships whose speed varies have an error; bounds are lowered by this share.
_TABLE_MARGIN = 1e-3


def certified_bound(context: PlanningContext, route: Route, *, seconds: float) -> LowerBound | None:
    """Return a lower bound of the time, or the distance, of every route of a passage.

    Parameters
    ----------
    context : PlanningContext
    route : Route
        A feasible route of the passage.
    seconds : float
        Time that the search for the bound may take [s]; 0 or less for none.

    Returns
    -------
    LowerBound or None
        In seconds or metres; None where no certificate was found, and for ships whose speed is a
        field of the sea.
    """
    if seconds <= 0.0 or not route.feasible:
        return None
    context.report_progress("proving a lower bound")
    by_length = context.voyage.objective == "distance"
    if context.ship.speed_field is not None and not by_length:
        return None  # its greatest speed is not known beforehand
    passage = _still_water(context, route) if by_length else _passage(context, route)
    found = certify_time(passage, seconds=seconds)
    if found is None:
        return None
    margin = 1.0 if by_length or not context.table.axes else 1.0 - _TABLE_MARGIN
    sampling = f", in {found.sampling}" if found.sampling else ""
    value = min(found.value * margin, passage.known)
    return LowerBound(value, _KIND.format(cells=found.cells, sampling=sampling))


def _passage(context: PlanningContext, route: Route) -> PassageToBound:
    top = context.ship.top_speed(context.setting)
    ship = ShipInBarrier(
        context.table.kernel_arrays(),
        context.setting,
        context.needs.limits.array,
        float(context.table.largest(context.setting) if top is None else top),
    )
    return PassageToBound(
        context.sea, context.chart, ship, context.needs.channels, *_ends(route),
        depart=route.depart, known=route.time_h * HOUR,
    )  # fmt: skip


def _still_water(context: PlanningContext, route: Route) -> PassageToBound:
    """Return the passage of a ship of 1 m/s in still water, whose time is the distance."""
    part = TablePart((), (), np.ones(1, np.float32))
    table = PerformanceTable((part,), np.ones(1), "", TableError(0.0, 0.0, 0.0))
    ship = ShipInBarrier(table.kernel_arrays(), 0, Limits().array, 1.0)
    length = float(route.legs["length"].sum())
    return PassageToBound(
        Sea.calm(), context.chart, ship, (), *_ends(route), depart=route.depart, known=length
    )


def _ends(route: Route) -> tuple[tuple[float, float], tuple[float, float]]:
    lat, lon = route.track.lat, route.track.lon
    return (float(lat[0]), float(lon[0])), (float(lat[-1]), float(lon[-1]))
