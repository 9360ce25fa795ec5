"""Warnings and provenance of a plan."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.core.geodesy import format_position
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.time import format_time
from thalweg.core.units import KNOT
from thalweg.network import Network
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.approach_report import turn_back_notes_of_route
from thalweg.planning.report.depth_report import depth_notes
from thalweg.planning.report.given_route_report import file_speed_notes, given_route_notes
from thalweg.planning.report.ice_report import ice_warnings
from thalweg.planning.report.land_report import land_notes, shoal_detour_notes_of_plan
from thalweg.planning.report.lane_report import lane_notes
from thalweg.planning.report.squat_report import squat_notes
from thalweg.planning.report.unread_weather import unread_weather_notes
from thalweg.planning.report.waiting_report import (
    heavy_weather_warnings,
    hours_and_slowest,
    stream_warnings,
    unknown_current_warnings,
    waiting_notes,
    waiting_weather_warnings,
)
from thalweg.planning.report.wave_report import comfort_turn_notes, steep_wave_warnings
from thalweg.planning.report.zone_report import far_area_notes, over_speed_notes, war_risk_notes
from thalweg.planning.request.coverage_check import UNREAD
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.route import Route
from thalweg.route.referee.method_ranges import (
    OUT_OF_RANGE,
    WAVES_OUT_OF_RANGE,
    WAVES_UNCOUNTED,
)
from thalweg.sea import Sea
from thalweg.sea.doubtful_values import guesses_of_files
from thalweg.sea.inspection import data_gaps
from thalweg.ship import Ship
from thalweg.ship.ship_assumptions import BELOW_LOWEST

_LEAST_KEPT, _SHORTEST_SLOW = 0.25, 1.0  # of the ordered speed; [h]
#: Begins of assumptions of a route that a plan states as warnings.
_OF_METHODS = (WAVES_UNCOUNTED, WAVES_OUT_OF_RANGE, OUT_OF_RANGE, BELOW_LOWEST)
#: Years between which a departure needs no warning: the reanalysis ERA5 begins in 1940.
_FIRST_YEAR, _LAST_YEAR = "1940", "2100"
_GIVEN_NETWORK: Final = (
    "The search used the network of your own builder; the route is refined in open water and may "
    "leave its edges. To keep ships out of other water, close it with zones."
)


def route_warnings(context: PlanningContext, route: Route) -> list[str]:
    """Return warnings about a route that limits do not cover.

    Parameters
    ----------
    context : Request, data and ship of the plan.
    route : The evaluated route.

    Returns
    -------
    list of str : One sentence for each warning.
    """
    notes = year_warnings(route) + land_notes(context, route)
    notes += turn_back_notes_of_route(route)
    notes += ice_warnings(route, context.sea) + war_risk_notes(
        route.samples["lat"], route.samples["lon"]
    )
    notes += data_gap_warnings(context.sea, route)
    notes += [text for text in route.assumptions if text.startswith(_OF_METHODS)]
    notes += slow_speed_warnings(route) + stream_warnings(route)
    notes += steep_wave_warnings(route, context.sea)
    if not any(note.startswith(UNREAD) for note in context.needs.notes):  # it says so already
        notes += unread_weather_notes(route, context.sea, context.ship)
    if context.voyage.objective == "comfort":
        notes += comfort_turn_notes(route)
    if callable(context.choice.network):
        notes.append(_GIVEN_NETWORK)
    notes += unknown_current_warnings(route) + waiting_weather_warnings(route, context.ship)
    notes += heavy_weather_warnings(route, context.ship)
    notes += waiting_notes(route) + lane_notes(context.chart, route)
    notes += over_speed_notes(context.chart, route) + far_area_notes(context.chart, route)
    notes += squat_notes(route, context.ship, context.min_ukc)
    if context.needs.limits.depth_checked:
        return notes
    notes += shoal_detour_notes_of_plan(context, route)
    return notes + depth_notes(context.chart, route, context.ship, context.min_ukc)


def slow_speed_warnings(route: Route) -> list[str]:
    """Return a warning where wind and waves leave little of the ordered speed through water."""
    ordered = np.asarray(route.legs["ordered_speed"], float)[route.samples["leg"]]
    made = np.asarray(route.samples["speed_through_water"], float)
    hours, k = hours_and_slowest(route, made, made[:-1] < _LEAST_KEPT * ordered[:-1])
    if hours < _SHORTEST_SLOW:
        return []
    place = format_position(float(route.samples["lat"][k]), float(route.samples["lon"][k]))
    return [
        f"The ship makes less than a quarter of the ordered speed for {hours:.1f} h, down "
        f"to {made[k] / KNOT:.1f} kn at {place}: methods of "
        "speed loss are not made for that. Check the ship file, limit wind and waves, or give the "
        "ship a resistance and an engine."
    ]


def given_route_warnings(
    route: Route, *, chart: Chart, sea: Sea, ship: Ship, min_ukc: float
) -> list[str]:
    """Return the warnings about a route from a file, as those about the routes of a plan.

    These are on its year, ice, gaps of data, units and times that files do not state, weather that
    the ship does not read, land, passages, traffic lanes, speeds of the file, squat, depth and
    shoals.

    Parameters
    ----------
    route : The evaluated route.
    chart, sea, ship : With which it was evaluated.
    min_ukc : Required under the keel [m].
    """
    notes = year_warnings(route) + ice_warnings(route, sea) + data_gap_warnings(sea, route)
    notes += war_risk_notes(route.samples["lat"], route.samples["lon"])
    notes += guesses_of_files(sea.layers, frozenset(route.samples))
    notes += slow_speed_warnings(route) + stream_warnings(route)
    notes += steep_wave_warnings(route, sea)
    notes += unread_weather_notes(route, sea, ship)
    notes += waiting_weather_warnings(route, ship) + heavy_weather_warnings(route, ship)
    notes += waiting_notes(route)
    notes += given_route_notes(route, chart=chart, ship=ship) + file_speed_notes(route)
    notes += squat_notes(route, ship, min_ukc) + over_speed_notes(chart, route)
    notes += far_area_notes(chart, route)
    if route.min_ukc_m is not None:
        return notes
    return notes + depth_notes(chart, route, ship, min_ukc)


def year_warnings(route: Route) -> list[str]:
    """Return a warning for a departure in a year of which no weather is known."""
    year = format_time(route.depart)[:4]
    if _FIRST_YEAR <= year <= _LAST_YEAR:
        return []
    return [f"The departure is in the year {year}: check it."]


def data_gap_warnings(sea: Sea, route: Route) -> list[str]:
    """Return warnings about gaps in the time of the data during a voyage."""
    if not math.isfinite(route.arrive):
        return []
    return [
        f"{gap.source} has a gap from {format_time(gap.after)} to {format_time(gap.before)}: legs "
        "in the gap that need its data are not sailed."
        for gap in data_gaps(sea.layers)
        if gap.before > route.depart and gap.after < route.arrive
    ]


def provenance(
    context: PlanningContext,
    ends: list[Endpoint],
    networks: list[dict[str, Any]],
    speeds_kn: list[float | None],
) -> dict[str, Any]:
    """Return the data needed to repeat a plan, as plain data.

    Parameters
    ----------
    context : Request, data and ship of the plan.
    ends : End points and via points, in order.
    networks : Description of each network (`network_summary`).
    speeds_kn : Ordered speed of each setting [kn]; None if there is none.

    Returns
    -------
    dict : Plain data for a JSON file.
    """
    from importlib.metadata import version

    table_error = dataclasses.asdict(context.table.error)
    return {
        "thalweg": version("thalweg"),
        "from": ends[0].true_name,
        "to": ends[-1].true_name,
        "via": [end.true_name for end in ends[1:-1]],
        "ship": {
            "name": context.ship.name,
            "fingerprint": context.ship.fingerprint(),
            "speed_kn": speeds_kn[0] if len(speeds_kn) == 1 else speeds_kn,
            "draught_m": float(context.ship.draught),
            "table_error": {k: finite_or_none(v) for k, v in table_error.items()},
        },
        "sea": context.sea.provenance() | {"fingerprint": context.sea.fingerprint()},
        "chart": context.chart.fingerprint(),
        "networks": networks,
        "seed": context.voyage.seed,
    }


def network_summary(
    network: Network, *, settled: int, depart: float, way: str = ""
) -> dict[str, Any]:
    """Return the description of a network that was searched, for the provenance.

    Parameters
    ----------
    network : The network that was searched.
    settled : Number of nodes that the search settled.
    depart : Departure [s since 1970-01-01T00:00Z].
    way : Name of the route alternative.

    Returns
    -------
    dict : Plain data for a JSON file.
    """
    facts = {
        "kind": network.meta.kind,
        "nodes": int(network.n_nodes),
        "edges": int(network.n_edges),
        "spacing_m": network.meta.spacing_m,
        "directions": network.meta.directions,
        "settled": settled,
        "depart": format_time(depart),
    }
    return facts | ({"way": way} if way else {})
