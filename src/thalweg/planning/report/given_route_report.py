"""What a route from a file does near land, in passages and in traffic lanes, and at which speed."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.canal_parts import part_number_of_legs
from thalweg.core.geodesy import format_position
from thalweg.core.given_numbers import to_number
from thalweg.core.time import duration_text
from thalweg.core.types import BoolArray
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.planning.report.approach_report import (
    LAND_OF_LINES_BY_HAND,
    most_miles_over_land,
    over_land_note,
)
from thalweg.planning.report.closed_way_report import CLOSED_ON_ROUTE
from thalweg.planning.report.land_report import time_of_passing
from thalweg.planning.report.lane_report import lane_notes
from thalweg.planning.request.lane_choice import chart_with_schemes
from thalweg.planning.request.offing_choice import (
    chart_off_land,
    default_offing,
    size_restriction,
)
from thalweg.planning.request.swapped_degrees import misplaced_name_notes, swap_notice
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.route import Route
from thalweg.route.carried_extensions import visits_of
from thalweg.route.passages_used import passages_used
from thalweg.route.referee.land_clearance import offing_breaches
from thalweg.route.refinement.track_geometry import course_changes
from thalweg.route.route_tables import LEG_KINDS
from thalweg.ship import Ship

TURNS_ROUND: Final = "Turns round"  #: a note on such a waypoint begins so
NEAR_LAND: Final = "Nearer to land than usual"  #: a note on such legs begins so
FILE_SPEED: Final = "Not the speed of the route file"  #: a note on legs with limits begins so
_SHARP: Final = math.radians(150.0)  # alterations of course that no passage plan has at sea
_LONGER: Final = 600.0  # that approaches take than ordered, from which on it is stated [s]
_SAME_SPEED: Final = 0.05  # differences below this are none [kn]
_AS_WRITTEN: Final = (
    0.95  # of the usual distance: lines of files are up to 0.1 nm off those of plans
)
_ROUND_PORTS: Final = 40.0 * NAUTICAL_MILE  # legs to and from ends near land, in rivers and bays


def given_route_notes(route: Route, *, chart: Chart, ship: Ship) -> list[str]:
    """Return notes on a route from a file that plans keep to by themselves.

    Parameters
    ----------
    route : The evaluated route.
    chart : On charts other than those of the world's coasts there are no notes.

    Returns
    -------
    list of str : On the place nearest to land, passages that are closed to the ship, and traffic.
    """
    lat, lon = np.asarray(route.track.lat, float), np.asarray(route.track.lon, float)
    if not chart.passages or len(lat) < 2:
        return []
    notes = misplaced_name_notes(route.track.extensions.names)
    swapped = [swap_notice(float(lat[k]), float(lon[k]), chart) for k in (0, -1)]
    notes += swapped[:1] if all(swapped) else []
    notes += _turns_back(route, chart) + _near_land(route, chart, ship)
    notes += approach_speed_notes(route, ship)
    in_approach = _in_approach(route, chart)
    in_canal = part_number_of_legs(chart.canals, lat, lon) >= 0  # land of the coastline
    legs = [slice(k, k + 2) for k in np.flatnonzero(in_approach & ~in_canal)]
    miles = max((most_miles_over_land(chart, lat[k], lon[k]) for k in legs), default=0.0)
    notes += [over_land_note("a port", miles)] if miles >= LAND_OF_LINES_BY_HAND else []
    for passage in passages_used(chart, route):
        why = size_restriction(passage, ship)
        notes += [f"{CLOSED_ON_ROUTE} {why}."] if why else []
    if not chart.zones.lanes:
        places = [(float(lat[k]), float(lon[k])) for k in _sea_ends(route)]
        chart = chart_with_schemes(chart, ship, places)
    return notes + lane_notes(chart, route)


def approach_speed_notes(route: Route, ship: Ship) -> list[str]:
    """Return how much longer approaches take than at the speeds that are ordered there.

    Returns
    -------
    list of str : A note, from `_LONGER` on.
    """
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(len(route.track) - 1)))
    ordered = np.asarray(route.legs["ordered_speed"], float)
    slower = np.flatnonzero((kind == LEG_KINDS.index("approach")) & (ordered > ship.approach_speed))
    length = np.asarray(route.legs["length"], float)[slower]
    longer = float(np.sum(length / ship.approach_speed - length / ordered[slower]))
    if longer < _LONGER:
        return []
    return [
        f"{length.sum() / NAUTICAL_MILE:.1f} nm along approaches of ports count at "
        f"{ship.approach_speed / KNOT:g} kn, not at the {ordered[slower].max() / KNOT:.1f} kn that "
        f"are ordered: they take {duration_text(longer)} longer. Where she is faster there, "
        "evaluate with --approach-speed."
    ]


def _sea_ends(route: Route) -> tuple[int, int]:
    """Return the waypoints at the sea ends of the approaches, round which lanes do not count.

    Plans are made between them; without approaches they are the first and the last waypoint.
    """
    count = len(route.track.lat)
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(count - 1)))
    at_sea = np.flatnonzero(kind != LEG_KINDS.index("approach"))
    return (int(at_sea[0]), int(at_sea[-1]) + 1) if at_sea.size else (0, count - 1)


def file_speed_notes(route: Route) -> list[str]:
    """Return a note on legs whose ordered speed is outside the speeds that an RTZ file allows them.

    Parameters
    ----------
    route : Its track carries ``speedMin`` and ``speedMax`` [kn] of the legs of the file.
    """
    track, details = route.track, route.track.extensions.details
    ordered = np.asarray(route.legs["ordered_speed"], float) / KNOT
    arriving = [details.get(visit, {}) for visit in visits_of(track.positions)[1:]]
    last_of = {int(leg): k for k, leg in enumerate(track.leg_numbers)}  # pieces of a rhumb line
    notes = []
    for name, word, sign in (
        ("speedMax", "above the greatest", 1.0),
        ("speedMin", "below the least", -1.0),
    ):
        limits = {leg: to_number(arriving[k].get(name)) for leg, k in last_of.items()}
        limit = np.array([limits[int(leg)] for leg in track.leg_numbers])
        excess = sign * (ordered - limit)
        broken = excess > _SAME_SPEED
        if broken.any():
            worst = int(np.nanargmax(np.where(broken, excess, np.nan)))
            legs = sorted({int(leg) for leg in track.leg_numbers[broken]})
            more = f" On {len(legs)} legs in all." if len(legs) > 1 else ""
            notes.append(
                f"{FILE_SPEED}: {ordered[worst]:.1f} kn is ordered on leg "
                f"{int(track.leg_numbers[worst])}, {word} speed of the file there ({name} "
                f"{limit[worst]:g} kn).{more} Order another with --speed."
            )
    return notes


def _turns_back(route: Route, chart: Chart) -> list[str]:
    """Return a note on the waypoints at sea where the route turns back on itself."""
    track = route.track
    turns = np.abs(course_changes(track.lat, track.lon))
    in_approach = _in_approach(route, chart)
    at_sea = ~(in_approach[1:] | in_approach[:-1])
    which = np.flatnonzero((turns > _SHARP) & at_sea & (track.wait[1:-1] <= 0.0)) + 1
    if not which.size:
        return []
    first = int(which[0])
    more = f" So it does at {len(which)} waypoints." if len(which) > 1 else ""
    return [
        f"{TURNS_ROUND} by {math.degrees(turns[first - 1]):.0f} degrees at waypoint "
        f"{int(track.leg_numbers[first])}, "
        f"{format_position(float(track.lat[first]), float(track.lon[first]))}: is a waypoint "
        f"wrong, repeated or out of order?{more}"
    ]


def _near_land(route: Route, chart: Chart, ship: Ship) -> list[str]:
    """Return a note on the place nearest to land that a plan would have kept off, not in ports."""
    offing = default_offing(ship)
    track = route.track
    ends = [Endpoint("", float(track.lat[k]), float(track.lon[k]), 0.0) for k in (0, -1)]
    shore = chart.coastline.shore_distance(
        np.array([end.lat for end in ends]), np.array([end.lon for end in ends]), cap=offing
    )
    near = [end for end, away in zip(ends, np.asarray(shore)) if away < offing]
    off_land = chart_off_land(
        chart, near or ends[:1], offing, near_ends=_ROUND_PORTS if near else 0.0
    )
    in_approach = _in_approach(route, chart)
    breaches = [
        at
        for at, _ in offing_breaches(off_land, track)
        if not in_approach[at.leg] and at.distance < _AS_WRITTEN * offing
    ]
    if not breaches:
        return []
    worst = min(breaches, key=lambda at: at.distance)
    legs = {int(track.leg_numbers[at.leg]) for at in breaches}
    more = f" On {len(legs)} legs in all." if len(legs) > 1 else ""
    return [
        f"{NEAR_LAND}: {worst.distance / NAUTICAL_MILE:.1f} nm off at "
        f"{format_position(worst.lat, worst.lon)}"
        f"{time_of_passing(route, worst.leg, worst.lat, worst.lon)}; plans keep "
        f"{offing / NAUTICAL_MILE:g} nm for a ship of this size, outside ports and passages.{more}"
    ]


def _in_approach(route: Route, chart: Chart) -> BoolArray:
    """Return which legs are in approaches, also on the way: plans follow them past other ports."""
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(len(route.legs["length"]))))
    found = kind == LEG_KINDS.index("approach")
    if chart.approaches is None:
        return np.asarray(found)
    return np.asarray(found | chart.approaches.legs(route.track.lat, route.track.lon))
