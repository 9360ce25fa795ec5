"""Restrictions of the chart for a voyage: canals, ice latitudes, emission control areas."""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from thalweg.chart import Chart
from thalweg.chart.canals import Canal, canals_with_dues
from thalweg.core.errors import ThalwegWarning
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.ice_limits import northern_limit, on_ice_coast
from thalweg.planning.request.offing_choice import ship_dimensions
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import priced_objective
from thalweg.planning.voyage import Voyage
from thalweg.ship import Ship

#: Water beyond these latitudes [deg] is excluded unless the voyage goes there: sea ice is not
#: modelled, and the Northwest and Northeast Passages are north of the first.
ICE_LIMIT_NORTH, ICE_LIMIT_SOUTH = 71.9, -60.0
IN_WATER: Final = "in water "  #: the latitudes in the kind of a bound come after these words
EXCLUDED_BY_DUES: Final = "Canal excluded for its dues: "  #: a note on such a canal begins so
#: Canals are mentioned if the geodesics through them are at most so much longer, in all and [m].
_DETOUR_RATIO, _DETOUR = 1.3, 500.0 * NAUTICAL_MILE
_ICE_LIMIT_MARGIN = 3.0  # [deg] beyond the places of the voyage that remain open


def exclude_closed_canals(
    chart: Chart, voyage: Voyage, ship: Ship, ends: Sequence[Endpoint]
) -> tuple[Chart, list[str]]:
    """Return the chart without canals that are forbidden or too small, and notes about them.

    The canals have the dues of the ship.
    Canal dues are in USD: where the objective is a cost in another currency, and the rate of the
    dollar is not known, canals with dues are excluded as well. Only canals near the geodesic get a
    note.

    Raises
    ------
    InputError : If a forbidden canal does not exist (with near matches).
    """
    if voyage.forbid:
        chart = chart.without_canals(*voyage.forbid)
    chart = replace(chart, canals=canals_with_dues(chart.canals, ship.file.hull))
    currency = _foreign_currency(voyage, ship)
    notes, closed = [], []
    for canal in chart.canals:
        why = canal_restriction(canal, ship)
        note = excluded_canal_note(why)
        if not why and currency and canal.fee > 0.0:
            why = note = (
                f"{EXCLUDED_BY_DUES}{canal.title}: they are in USD, the prices in {currency}. Give "
                "the price of a dollar in the ship file (fuel.usd_rate)."
            )
        if why:
            closed.append(canal.name)
            if any(_near_geodesic(canal, *pair) for pair in itertools.pairwise(ends)):
                notes.append(note)
    return (chart.without_canals(*closed) if closed else chart), notes


def canal_restriction(canal: Canal, ship: Ship) -> str:
    """Return why a canal is closed to a ship of this size, as text; empty if it is open."""
    return canal.transit_restriction(**ship_dimensions(ship))


def excluded_canal_note(why: str) -> str:
    """Return a note on a canal that a voyage may not use, by the reason that begins with it."""
    return f"Canal excluded: {why}."


def _foreign_currency(voyage: Voyage, ship: Ship) -> str:
    """Return the currency if the objective is a cost in one without a rate of USD, else ''."""
    if not voyage.chooses_speeds or math.isfinite(ship.fuel_terms.dollar_rate):
        return ""
    objective = priced_objective(voyage, ship)
    return objective.unit if objective.name == "cost" and objective.unit != "USD" else ""


def _near_geodesic(canal: Canal, start: Endpoint, goal: Endpoint) -> bool:
    """Return whether the route through a canal is not much longer than the geodesic."""
    a, b = (start.lat, start.lon), (goal.lat, goal.lon)
    one, other = canal.ends
    lengths = (
        distance(*a, *p) + canal.length + distance(*q, *b) for p, q in ((one, other), (other, one))
    )
    straight = float(distance(*a, *b))
    return float(min(lengths)) < min(_DETOUR_RATIO * straight, straight + _DETOUR)


def exclude_ice_latitudes(
    chart: Chart,
    ends: list[Endpoint],
    southern: Callable[[float], tuple[float, list[str]]] | None = None,
) -> tuple[Chart, list[str]]:
    """Return the chart without the latitudes where ice is likely, as far as the voyage allows.

    Parameters
    ----------
    southern : Called with the southern limit [deg]; returns a narrower one, and notes on it.
    """
    area = chart.area
    if area.width < 360.0 or area.south > -89.0 or area.north < 89.0:
        return chart, []  # limited by the user
    north = max(ICE_LIMIT_NORTH, *(end.lat + _ICE_LIMIT_MARGIN for end in ends))
    if any(on_ice_coast(end.lat, end.lon) for end in ends):
        north = max(north, northern_limit(*((end.lat, end.lon) for end in ends)))
    south = min(ICE_LIMIT_SOUTH, *(end.lat - _ICE_LIMIT_MARGIN for end in ends))
    south, notes = (south, []) if southern is None else southern(south)
    kept = chart.within(max(south, -90.0), min(north, 90.0), area.west, area.west + area.width)
    return kept, notes


def add_emission_control_areas(chart: Chart, voyage: Voyage, ship: Ship) -> tuple[Chart, list[str]]:
    """Return the chart with emission control areas where these affect the objective.

    They are the areas in force when the data of the package were compiled, for any departure, as
    past weather often represents future weather. Where a chart has areas of its own, those count
    instead.
    """
    if not voyage.chooses_speeds:
        return chart, []
    prices = priced_objective(voyage, ship).prices
    if not prices.differs_in_control_areas or chart.zones.eca or not chart.counts_eca:
        return chart, []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ThalwegWarning)
        chart = chart.with_eca()
    return chart, [str(warning.message) for warning in caught]
