"""What a plan states about land: the nearest land, and the passages the route uses."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import Passage, split_avoided
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import densify, distance, format_position, line_length
from thalweg.core.time import format_time
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.distance_report import PASSAGE_CLOSED, PASSAGES_CLOSED
from thalweg.planning.request.offing_choice import size_restriction
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways
from thalweg.route import Route
from thalweg.route.passages_used import passages_used
from thalweg.route.referee.land_clearance import least_land_clearance
from thalweg.route.route_tables import LEG_KINDS

_PIECE: Final = 20.0 * NAUTICAL_MILE  # routes are split so to find where a passage would leave them
_LEAST_SAVED: Final = 5.0 * NAUTICAL_MILE  # closed passages that save less are not mentioned
NEAREST_LAND: Final = "Nearest land"  #: a note on it begins so
CLOSE_TO_LAND: Final = "Close to land"  #: ... or so, where it is nearer than `_CLOSE`
_CLOSE: Final = 0.25 * NAUTICAL_MILE
PASSES: Final = "Passes "  #: one on a named passage
_NEAR: Final = 30.0 * NAUTICAL_MILE  # land farther from the route is not mentioned


def land_notes(context: PlanningContext, route: Route) -> list[str]:
    """Return the nearest land to a route and the passages it uses, a sentence each.

    Empty for a voyage that keeps no offing.
    """
    if context.needs.limits.offing <= 0.0 and context.voyage.offing_nm == 0.0:
        return []
    notes = nearest_land_notes(context.chart, route)
    for passage in passages_used(context.chart, route):
        facts = [
            f"line at least {passage.half_width / NAUTICAL_MILE:.2g} nm off the coastline",
            *([f"limits: {passage.limits}"] if passage.limits else []),
            *([f"pilotage {passage.pilotage}"] if passage.pilotage else []),
            *([passage.note] if passage.note else []),
            *(["unchecked"] if "unchecked" in passage.source else []),
        ]
        notes.append(f"{PASSES}{passage.name} ({'; '.join(facts)}).")
    return notes + closed_passage_notes(context, route)


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
    return [
        f"{CLOSE_TO_LAND if one.distance < _CLOSE else NEAREST_LAND}: "
        f"{one.distance / NAUTICAL_MILE:.1f} nm off {where}, from "
        f"{format_position(one.lat, one.lon)}{time_of_passing(route, one.leg, one.lat, one.lon)}."
        for one, where in ((near, "in the approach of a port"), (at_sea, "at sea"))
        if one is not None and one.distance < _NEAR
    ]


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
    """Return a note for each reason why a ship may not use passages of a shorter way.

    They are those that the shortest way between the ends of the route uses where all passages are
    open that are closed to a ship of this size.
    """
    avoided = split_avoided(context.voyage.avoid)[1]
    closed: dict[str, str] = {}
    for passage in context.chart.closed_passages:
        why = "" if passage in avoided else size_restriction(passage, context.ship)
        if why:
            closed[passage.name] = why.removeprefix(f"{passage.name}: ")
    if not any(
        passage.name in closed and saved_length(route, passage) >= _LEAST_SAVED
        for passage in context.chart.closed_passages
    ):
        return []
    names: dict[str, list[str]] = {}
    for name in _closed_on_shorter_way(context.chart, route, closed):
        names.setdefault(closed[name], []).append(name)
    return [_closed_note(reason, alike) for reason, alike in names.items()]


def _closed_on_shorter_way(chart: Chart, route: Route, closed: Collection[str]) -> list[str]:
    """Return the passages on the way that is shorter where closed ones are open, in its order."""
    ends = [
        Endpoint("", float(route.track.lat[k]), float(route.track.lon[k]), 0.0) for k in (0, -1)
    ]
    now = Seaways.of_ship_chart(chart, every_passage=True)
    opened = replace(now, passages=tuple(name for name in now.passages if name not in closed))
    try:
        length = line_length(now.graph_path(*ends))
        path = opened.graph_path(*ends)
    except (InputError, NoRouteError):  # an end that the chart of all seas has on land
        return []
    if length - line_length(path) < _LEAST_SAVED:
        return []
    crossed = passages_crossed(now.chart.coastline, now.chart.passages, *np.array(path).T)
    return [passage.name for _, passage in crossed if passage.name in closed]


def _closed_note(reason: str, names: Sequence[str]) -> str:
    """Return a note on passages that are closed for one reason."""
    if len(names) == 1:
        why = reason if reason.startswith(names[0]) else f"{names[0]}: {reason}"
        return f"{PASSAGE_CLOSED}: {why} (--open {names[0]!r} opens it)."
    listed = f"{', '.join(names[:-1])} and {names[-1]}"
    reason = re.sub(r"^it is\b", "they are", reason)
    return f"{PASSAGES_CLOSED}: {listed}: {reason} (--open NAME opens one)."


def saved_length(route: Route, passage: Passage) -> float:
    """Return by how much a route would be shorter through a passage, at most [m].

    The ship would leave the route at one of its positions, sail straight to the passage and back
    to the route at a later one; land is not considered.

    Returns
    -------
    float : Negative if the passage is out of the way.
    """
    lat, lon, _leg = densify(np.asarray(route.track.lat), np.asarray(route.track.lon), _PIECE)
    sailed = cumulative_sums(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    ends = passage.line[0], passage.line[-1]
    most = -np.inf
    for first, last in (ends, ends[::-1]):
        left = np.maximum.accumulate(-sailed - distance(lat, lon, *first))
        most = max(most, float(np.max(sailed - distance(lat, lon, *last) + left)))
    return most - passage.length
