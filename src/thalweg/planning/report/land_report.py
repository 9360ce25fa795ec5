"""What a plan states about land: the nearest land, and the passages the route uses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.canals import CANALS, Canal, exclude_canals
from thalweg.chart.passages import split_avoided
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import densify, distance, format_position
from thalweg.core.time import format_time
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.closed_way_report import (
    NarrowWay,
    notes_by_reason,
    title_of_way,
    ways_of_names,
    ways_on_line,
)
from thalweg.planning.report.distance_report import (
    offing_detour_notes,
    roundabout_notes,
    shoal_detour_notes,
)
from thalweg.planning.request.chart_restrictions import canal_restriction, excluded_canal_note
from thalweg.planning.request.offing_choice import size_restriction
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals
from thalweg.route import Route
from thalweg.route.passages_used import passages_used
from thalweg.route.referee.land_clearance import LandClearance, least_land_clearance
from thalweg.route.route_tables import LEG_KINDS
from thalweg.sea import Sea
from thalweg.sea.fill_policies import is_calm_layer
from thalweg.sea.standard_names import CURRENT
from thalweg.ship import Ship

_PIECE: Final = 20.0 * NAUTICAL_MILE  # routes are split so to find where a passage would leave them
_LEAST_SAVED: Final = 5.0 * NAUTICAL_MILE  # closed passages that save less are not mentioned
NEAREST_LAND: Final = "Nearest land"  #: a note on it begins so
CLOSE_TO_LAND: Final = "Close to land"  #: ... or so, where it is nearer than `_CLOSE`
_CLOSE: Final = 0.25 * NAUTICAL_MILE
_STEP_OF_LINE: Final = 0.1 * NAUTICAL_MILE
_BESIDE_LINE: Final = 0.5 * NAUTICAL_MILE  # positions so near the line of a passage are in it
PASSES: Final = "Passes "  #: one on a named passage
_SHORT_VOYAGE: Final = 40.0 * NAUTICAL_MILE  # has no note on shoals
UNKNOWN_STREAM: Final = "Strong streams are not known"  #: a note on such a passage begins so
TANKER_RULES: Final = "Rules for tankers"  #: a note on a passage that has some begins so
ALONG_COAST: Final = "Runs along a coast"  #: a note on miles of a large ship near land begins so
_DEEP, _LONG = 12.0, 200.0  # large ships have this draught or length [m]
_OPEN_COAST: Final = 5.0 * NAUTICAL_MILE
_LEAST_ALONG_COAST: Final = 20.0 * NAUTICAL_MILE
_ROUND_ENDS: Final = 30.0 * NAUTICAL_MILE
_ROUND_PASSAGES: Final = 15.0 * NAUTICAL_MILE
_STEP_ALONG_COAST: Final = 1.0 * NAUTICAL_MILE
_NEAR: Final = 30.0 * NAUTICAL_MILE  # land farther from the route is not mentioned


def land_notes(context: PlanningContext, route: Route) -> list[str]:
    """Return the nearest land to a route and the passages it uses, a sentence each.

    Empty for a voyage that keeps no offing.
    """
    if context.needs.limits.offing <= 0.0 and context.voyage.offing_nm == 0.0:
        return []
    notes = nearest_land_notes(context.chart, route)
    notes += coasting_notes(context.chart, route, context.ship)
    notes += unknown_stream_notes(context.chart, route, context.sea)
    notes += tanker_notes(context.chart, route, context.ship)
    for passage in passages_used(context.chart, route):
        facts = [
            f"line at least {passage.half_width / NAUTICAL_MILE:.2g} nm off the coastline",
            *([f"limits: {passage.limits}"] if passage.limits else []),
            *([f"pilotage {passage.pilotage}"] if passage.pilotage else []),
            *([passage.note] if passage.note else []),
            *(["unchecked"] if "unchecked" in passage.source else []),
        ]
        notes.append(f"{PASSES}{passage.name} ({'; '.join(facts)}).")
    closed = closed_passage_notes(context, route)
    if not closed and context.chart.passages and not context.voyage.via:
        ends = [(float(route.track.lat[k]), float(route.track.lon[k])) for k in (0, -1)]
        closed = list(roundabout_notes(ends, route.distance_nm * NAUTICAL_MILE))
    return notes + closed


def nearest_land_notes(chart: Chart, route: Route) -> list[str]:
    """Return notes on the nearest land to a route at sea, and in its approaches if that is less.

    The distance at sea is the indicator ``land_distance_nm``. Empty far off land.
    """
    count = len(route.track.lat) - 1
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(count)))
    approach = kind == LEG_KINDS.index("approach")
    at_sea = least_land_clearance(chart, route.track, ~approach)
    near = least_land_clearance(chart, route.track, approach)
    if near is not None and at_sea is not None and near.distance >= at_sea.distance:
        near = None
    words = _water_words(chart, route, at_sea)
    return [
        f"{CLOSE_TO_LAND if one.distance < _CLOSE else NEAREST_LAND}: "
        f"{one.distance / NAUTICAL_MILE:.1f} nm off {where}, from "
        f"{format_position(one.lat, one.lon)}{time_of_passing(route, one.leg, one.lat, one.lon)}."
        for one, where in ((near, "in the approach of a port"), (at_sea, words))
        if one is not None and one.distance < _NEAR
    ]


def unknown_stream_notes(chart: Chart, route: Route, sea: Sea) -> list[str]:
    """Return a note on each passage with strong streams, where the data have no currents."""
    data = [layer.variables for layer in sea.layers if not is_calm_layer(layer)]
    if any(set(CURRENT.pair) <= variables for variables in data):
        return []
    return [
        f"{UNKNOWN_STREAM}: {passage.name} has {passage.note}, and the data have no currents. "
        f"Pass near slack water by the pilot book, or plan with --avoid {passage.name!r}."
        for passage in passages_used(chart, route)
        if "stream" in passage.note
    ]


def tanker_notes(chart: Chart, route: Route, ship: Ship) -> list[str]:
    """Return a note on each passage with rules for tankers; none for other ships."""
    if "tanker" not in (ship.file.hull.type or "").casefold():
        return []
    return [
        f"{TANKER_RULES}: {passage.name} ({passage.note}). Check them for this ship and cargo, or "
        f"plan with --avoid {passage.name!r}."
        for passage in passages_used(chart, route)
        if "tanker" in passage.note
    ]


def coasting_notes(chart: Chart, route: Route, ship: Ship) -> list[str]:
    """Return a note on the miles that a large ship sails close along a coast; none for others.

    Miles near the ends and in named passages do not count.
    """
    if float(ship.draught) < _DEEP and (ship.length or 0.0) < _LONG:
        return []
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(len(route.track.lat) - 1)))
    at_sea = np.flatnonzero(kind != LEG_KINDS.index("approach"))
    if chart.coastline.is_empty or not len(at_sea):
        return []
    whole = slice(int(at_sea[0]), int(at_sea[-1]) + 2)
    lat, lon, leg = densify(route.track.lat[whole], route.track.lon[whole], _STEP_ALONG_COAST)
    of_leg = kind[whole.start : whole.stop - 1]
    in_canal = of_leg[np.append(leg, len(of_leg) - 1)] == LEG_KINDS.index("canal")
    off = np.asarray(chart.coastline.shore_distance(lat, lon, cap=_OPEN_COAST))
    close = (off < _OPEN_COAST) & ~in_canal
    for end in (0, -1):
        close &= np.asarray(distance(lat, lon, lat[end], lon[end])) > _ROUND_ENDS
    for passage in passages_used(chart, route):
        y, x, _part = densify(*passage.positions, _STEP_ALONG_COAST)
        for k in np.flatnonzero(close):
            close[k] = float(np.min(distance(lat[k], lon[k], y, x))) > _ROUND_PASSAGES
    metres = float(np.sum(np.asarray(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))[close[1:]]))
    if metres < _LEAST_ALONG_COAST:
        return []
    nearest = int(np.argmin(np.where(close, off, np.inf)))
    place = format_position(float(lat[nearest]), float(lon[nearest]))
    return [
        f"{ALONG_COAST} for {metres / NAUTICAL_MILE:.0f} nm nearer than "
        f"{_OPEN_COAST / NAUTICAL_MILE:g} nm, {off[nearest] / NAUTICAL_MILE:.1f} nm at {place}, "
        "outside named passages: large ships keep farther off an open coast, laden "
        "tankers by the rules of many states. To keep off, plan with --offing, such as 5 or 10."
    ]


def _water_words(chart: Chart, route: Route, nearest: LandClearance | None) -> str:
    """Return "at sea", or the name of the passage in which a route is nearest to land."""
    if nearest is None or nearest.distance >= _NEAR:
        return "at sea"
    for passage in passages_used(chart, route):
        line = np.array(passage.line)
        lat, lon, _part = densify(line[:, 0], line[:, 1], _STEP_OF_LINE)
        off = float(np.min(distance(lat, lon, nearest.lat, nearest.lon)))
        if off < np.fmax(2.0 * passage.half_width, _BESIDE_LINE):
            return f"in a passage ({passage.name})"
    return "at sea"


def time_of_passing(route: Route, leg: int, lat: float, lon: float) -> str:
    """Return words on when a route passes a position [deg] on one of its legs, from 0.

    The number of the leg would not do: approaches and other stretches are put before it later.

    Returns
    -------
    str : Empty where the time is not known.
    """
    track, legs = route.track, route.legs
    sailed = float(distance(track.lat[leg], track.lon[leg], lat, lon))
    share = min(1.0, sailed / max(float(legs["length"][leg]), 1.0))
    time = float(legs["depart"][leg] + share * (legs["arrive"][leg] - legs["depart"][leg]))
    return f", passed at {format_time(60.0 * round(time / 60.0))}" if math.isfinite(time) else ""


def closed_passage_notes(context: PlanningContext, route: Route) -> list[str]:
    """Return a note for each reason why a ship may not use passages or canals of a shorter way.

    They are those that the shortest way between the ends of the route uses where all are open that
    are closed to a ship of this size. Canals of which the request has a note already are left out.
    """
    closed = _closed_to_size(context)
    if not any(saved_length(route, way) >= _LEAST_SAVED for way, _ in closed.values()):
        return []
    saved, names = _closed_on_shorter_way(context.chart, route, closed)
    if not names:
        return []
    reasons = notes_by_reason({name: closed[name][1] for name in names})
    through = "through" if len(reasons) == 1 else "through all that is closed"
    shorter = f"The way {through} is about {saved / NAUTICAL_MILE:,.0f} nm shorter"
    found = []
    for alike, note in reasons:
        remedy = "" if isinstance(closed[alike[0]][0], Canal) else " (--open NAME opens one)"
        if remedy and len(alike) == 1:
            remedy = f" (--open {alike[0]!r} opens it)"
        found.append(f"{note}{remedy}. {shorter}.")
    return found


def _closed_to_size(context: PlanningContext) -> dict[str, tuple[NarrowWay, str]]:
    """Return the passages and canals that are closed to a ship of this size, and why, by title."""
    voyage, ship, chart = context.voyage, context.ship, context.chart
    canals, avoided = split_avoided(voyage.avoid)
    found: dict[str, tuple[NarrowWay, str]] = {}
    for passage in chart.closed_passages:
        why = "" if passage in avoided else size_restriction(passage, ship)
        if why:
            found[passage.name] = passage, why
    open_names = {canal.name for canal in chart.canals}
    for canal in exclude_canals(CANALS, (*canals, *voyage.forbid)):
        why = "" if canal.name in open_names else canal_restriction(canal, ship)
        if why and excluded_canal_note(why) not in context.needs.notes:
            found[canal.title] = canal, why
    return found


def _closed_on_shorter_way(
    chart: Chart, route: Route, closed: Mapping[str, tuple[NarrowWay, str]]
) -> tuple[float, list[str]]:
    """Return by how much a way by closed passages and canals is shorter [m], and their titles."""
    ends = [
        Endpoint("", float(route.track.lat[k]), float(route.track.lon[k]), 0.0) for k in (0, -1)
    ]
    now = Seaways.of_ship_chart(chart, every_passage=True)
    names = {way.name for way, _ in closed.values()}
    opened = replace(
        now,
        canals=tuple(name for name in now.canals if name not in names),
        passages=tuple(name for name in now.passages if name not in names),
    )
    try:
        length, _ = path_length_and_canals(now.chart, now.graph_path(*ends))
        path = opened.graph_path(*ends)
    except (InputError, NoRouteError):  # an end that the chart of all seas has on land
        return 0.0, []
    saved = length - path_length_and_canals(now.chart, path)[0]
    if saved < _LEAST_SAVED:
        return 0.0, []
    used = ways_on_line(now, ways_of_names(now, sorted(names)), path)
    for way in list(used) if len(used) > 1 else ():  # one that saves little of it is not named
        less = opened.without(way.name)
        still = length - path_length_and_canals(now.chart, less.graph_path(*ends))[0]
        if still > saved - _LEAST_SAVED:
            opened, saved = less, still
            used = [one for one in used if one is not way]
    length, through = (  # the graph is coarse: a way over it is some miles too long
        path_length_and_canals(now.chart, seas.path(*ends, offing=chart.offing.distance))[0]
        for seas in (now, opened)
    )
    saved = length - through
    return (saved, [title_of_way(way) for way in used]) if saved >= _LEAST_SAVED else (0.0, [])


def shoal_detour_notes_of_plan(context: PlanningContext, route: Route) -> list[str]:
    """Return how much longer shoals, or else the offing, make a planned voyage, as a note.

    Empty for short voyages, those with via points and those on charts without shoals.
    """
    chart, shoals = context.chart, context.chart.zones.shoals
    if shoals is None or not chart.passages or chart.area.width < 360.0 or context.voyage.via:
        return []
    at_sea = np.flatnonzero(np.asarray(route.legs["leg_kind"]) != LEG_KINDS.index("approach"))
    if not len(at_sea) or route.distance_nm * NAUTICAL_MILE < _SHORT_VOYAGE:
        return []
    lat, lon = np.asarray(route.track.lat), np.asarray(route.track.lon)
    ends = [Endpoint("", float(lat[k]), float(lon[k]), 0.0) for k in (at_sea[0], at_sea[-1] + 1)]
    seas = replace(Seaways.of_ship_chart(chart), shoals=shoals)
    offing, closed = chart.offing.distance, chart.zones.closed_shoals
    try:
        notes = shoal_detour_notes(seas, ends, offing=offing)
        if notes:
            return list(notes)
        metres = float(np.asarray(route.legs["length"])[at_sea].sum())
        if closed is not None:
            notes = shoal_detour_notes(seas, ends, offing=offing, length=metres)
        if not notes:
            return offing_detour_notes(seas, (ends[0], ends[1]), metres, offing)
        way = np.array(replace(seas, shoals=None).path(*ends, offing=offing))
        lat, lon, _leg = densify(way[:, 0], way[:, 1], NAUTICAL_MILE)
        over_closed = closed is not None and closed.contains(lat, lon).any()
        return (
            list(notes)
            if over_closed
            else offing_detour_notes(seas, (ends[0], ends[1]), metres, offing)
        )
    except (InputError, NoRouteError):  # an end that the chart of all seas has on land
        return []


def saved_length(route: Route, way: NarrowWay) -> float:
    """Return by how much a route would be shorter through a passage or canal, at most [m].

    The ship would leave the route at one of its positions, sail straight to the passage and back
    to the route at a later one; land is not considered.

    Returns
    -------
    float : Negative if it is out of the way.
    """
    lat, lon, _leg = densify(np.asarray(route.track.lat), np.asarray(route.track.lon), _PIECE)
    sailed = cumulative_sums(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    ends = way.ends
    most = -np.inf
    for first, last in (ends, ends[::-1]):
        left = np.maximum.accumulate(-sailed - distance(lat, lon, *first))
        most = max(most, float(np.max(sailed - distance(lat, lon, *last) + left)))
    return most - way.length
