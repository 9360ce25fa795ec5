"""Which water a voyage may use: canals that are open and fit, ice left out, control areas."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Sequence

from thalweg.chart import Chart
from thalweg.chart.canals import Canal
from thalweg.core.errors import ThalwegWarning
from thalweg.core.geodesy import distance
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import priced_objective
from thalweg.planning.voyage import Voyage
from thalweg.ship import Ship

#: Water beyond these latitudes [deg] is left out unless the voyage goes there: sea ice is not
#: considered, and the passages round the north of America and Asia lie beyond the first.
ICE_LIMIT_NORTH, ICE_LIMIT_SOUTH = 71.9, -65.0
_DETOUR_RATIO = 1.3  # ways by a canal up to so many geodesics long are worth a word
_ICE_LIMIT_MARGIN = 3.0  # degrees beyond a place of the voyage that stay open


def exclude_closed_canals(
    chart: Chart, voyage: Voyage, ship: Ship, ends: Sequence[Endpoint]
) -> tuple[Chart, list[str]]:
    """Return the chart without the canals that are forbidden or too small, and what to say.

    Where the cost is made least and is in another currency than the dues of canals, which are in
    USD, those with dues are left out, too. Only what lies on the way is said.

    Raises
    ------
    InputError
        If a forbidden canal does not exist (with near matches).
    """
    if voyage.forbid:
        chart = chart.without_canals(*voyage.forbid)
    beam = ship.breadth
    currency = _foreign_currency(voyage, ship)
    notes, closed = [], []
    for canal in chart.canals:
        why = canal.transit_restriction(draught=float(ship.draught) or None, beam=beam)
        if not why and currency and canal.fee > 0.0:
            why = f"{canal.title}: its dues are in USD, and the prices are in {currency}"
        if why:
            closed.append(canal.name)
            if any(_near_geodesic(canal, *pair) for pair in itertools.pairwise(ends)):
                notes.append(f"Not passed: {why}.")
    return (chart.without_canals(*closed) if closed else chart), notes


def _foreign_currency(voyage: Voyage, ship: Ship) -> str:
    """Return the currency of the cost that is made least, where there is one and not USD."""
    if not voyage.chooses_speeds:
        return ""
    objective = priced_objective(voyage, ship)
    return objective.unit if objective.name == "cost" and objective.unit != "USD" else ""


def _near_geodesic(canal: Canal, start: Endpoint, goal: Endpoint) -> bool:
    """Return whether the way by a canal is not much longer than the geodesic."""
    a, b = (start.lat, start.lon), (goal.lat, goal.lon)
    one, other = canal.ends
    ways = (
        distance(*a, *p) + canal.length + distance(*q, *b) for p, q in ((one, other), (other, one))
    )
    return float(min(ways)) < _DETOUR_RATIO * float(distance(*a, *b))


def exclude_ice_latitudes(chart: Chart, ends: list[Endpoint]) -> Chart:
    """Return the chart without the water where ice is likely, as far as the voyage allows."""
    area = chart.area
    if area.width < 360.0 or area.south > -89.0 or area.north < 89.0:
        return chart  # the user has drawn limits
    north = max(ICE_LIMIT_NORTH, *(end.lat + _ICE_LIMIT_MARGIN for end in ends))
    south = min(ICE_LIMIT_SOUTH, *(end.lat - _ICE_LIMIT_MARGIN for end in ends))
    return chart.within(max(south, -90.0), min(north, 90.0), area.west, area.west + area.width)


def add_emission_control_areas(chart: Chart, voyage: Voyage, ship: Ship) -> tuple[Chart, list[str]]:
    """Return the chart with emission control areas where fuel counts otherwise in them.

    They are those in force on the day the package's data were looked up, whatever the departure:
    weather of the past stands for weather to come. A chart with areas of its own keeps them.
    """
    if not voyage.chooses_speeds:
        return chart, []
    prices = priced_objective(voyage, ship).prices
    if not prices.differs_in_control_areas or chart.zones.eca:
        return chart, []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ThalwegWarning)
        chart = chart.with_eca()
    names = ", ".join(zone.name for zone in chart.zones.eca)
    notes = [f"Emission control areas taken into account: {names}."]
    return chart, notes + [str(warning.message) for warning in caught]
