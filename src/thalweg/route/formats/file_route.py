"""A route cut at the waypoints of its files, and the rows that the files hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from thalweg.core.rhumb_lines import inverse_rhumb
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.formats.file_waypoints import FileVertices, file_vertices
from thalweg.route.formats.route_file_options import RouteFileOptions
from thalweg.route.formats.waypoint_names import waypoint_names
from thalweg.route.route import Route
from thalweg.route.route_tables import LEG_KINDS, waypoint_rows
from thalweg.route.track import Track

#: Results of legs that are not sums over their parts.
_NO_SUMS = (
    "length", "course", "depart", "arrive", "ordered_speed", "under_keel_clearance", "leg_kind",
)  # fmt: skip
_DIRECTIONS = ("course", "heading", "leg")  # not interpolated


@dataclass(frozen=True, eq=False)
class FileRoute:
    """A route at the waypoints of its files.

    Attributes
    ----------
    rows : One per waypoint: ``name`` and the columns of `thalweg.route.route.Route.waypoints`, with
        rhumb-line courses.
    cross_track_m : Greatest distance of the route from the rhumb lines between the waypoints [m].
    """

    rows: list[dict[str, Any]]
    cross_track_m: float


@dataclass(frozen=True, eq=False)
class _CutRoute:
    """What `waypoint_rows` needs of a route."""

    track: Track
    legs: Mapping[str, FloatArray]
    samples: Mapping[str, FloatArray]
    cost_name: str
    engine_order: str


def file_route(route: Route, options: RouteFileOptions | None = None) -> FileRoute:
    """Return a route at the waypoints of its files.

    Raises
    ------
    InputError : If the route needs more waypoints than the options allow.
    """
    return _cut_at_waypoints(route, options or RouteFileOptions())


@lru_cache(maxsize=1)  # the files of all formats are written one after the other
def _cut_at_waypoints(route: Route, options: RouteFileOptions) -> FileRoute:
    vertices = file_vertices(route, options)
    cut = _cut(route, vertices)
    rows = waypoint_rows(cut)
    lat, lon = vertices.lat, vertices.lon
    _, course = inverse_rhumb(lat[:-1], lon[:-1], lat[1:], lon[1:])
    approach = cut.legs["leg_kind"] == LEG_KINDS.index("approach")
    names = waypoint_names(vertices.at, options.start, options.goal, approach)
    bearings = np.degrees(np.append(course, course[-1])).tolist()
    rows = [
        {
            "name": name,
            **{k: _rounded(k, v, options.decimals) for k, v in row.items()},
            "course_deg": round(bearing, 2),
        }
        for name, row, bearing in zip(names, rows, bearings)
    ]
    return FileRoute(rows, vertices.cross_track)


def file_track(route: Route, options: RouteFileOptions | None = None) -> Track:
    """Return the track that a reader of the files of a route sails.

    Raises
    ------
    InputError : If the route needs more waypoints than the options allow.
    """
    cut = _cut(route, file_vertices(route, options or RouteFileOptions()))
    return replace(cut.track, speed=cut.legs["ordered_speed"])


def _rounded(name: str, value: Any, decimals: int) -> Any:
    """Return a value with the decimals that mean something."""
    digits = 3
    if name in ("lat", "lon"):
        digits = decimals
    elif name in ("waiting_h", "ordered_speed_kn"):
        digits = 6
    return round(value, digits) if isinstance(value, float) else value


def _cut(route: Route, vertices: FileVertices) -> _CutRoute:
    """Return the legs and samples of a route between the vertices of its files."""
    track, at, leg = route.track, vertices.at, vertices.leg
    start = np.concatenate([[0.0], np.cumsum(route.legs["length"])])
    before = np.maximum(np.searchsorted(start, at - 1e-6, side="right") - 1, 0)
    leaving = _samples_at(route, leg, at)
    arriving = _samples_at(route, before, at)
    wait = np.where(np.abs(start[leg] - at) < 1e-3, track.wait[leg], 0.0)
    wait[-1] = 0.0
    cut_track = Track(vertices.lat, vertices.lon, track.depart, wait, track.setting[leg[:-1]])
    samples = _joined_samples(route, at, leaving, arriving)
    legs = {
        "length": np.diff(at),
        "depart": leaving["time"][:-1],
        "arrive": arriving["time"][1:],
        "ordered_speed": route.legs["ordered_speed"][leg[:-1]],
        "leg_kind": route.legs["leg_kind"][leg[:-1]],
        "under_keel_clearance": _least_clearance(route, samples, leg, wait),
    }
    for name in set(route.legs) - set(_NO_SUMS):
        legs[name] = np.diff(_sum_until(route, name, leg, at - start[leg]))
    return _CutRoute(cut_track, legs, samples, route.cost_name, route.engine_order)


def _samples_at(route: Route, leg: IntArray, at: FloatArray) -> dict[str, FloatArray]:
    """Return the samples of a route in some of its legs, at distances from its start [m]."""
    samples = route.samples
    found = {name: np.empty(len(at)) for name in samples}
    leg_of = samples["leg"].astype(np.int64)
    for number, (which, place) in enumerate(zip(leg, at)):
        here = slice(*np.searchsorted(leg_of, [which, which + 1]))
        distance = samples["distance"][here]
        nearest = int(np.argmin(np.abs(distance - place)))
        for name, values in samples.items():
            part = values[here]
            near = name in _DIRECTIONS or not np.isfinite(part).all()
            found[name][number] = part[nearest] if near else np.interp(place, distance, part)
    return found


def _joined_samples(
    route: Route, at: FloatArray, leaving: dict[str, FloatArray], arriving: dict[str, FloatArray]
) -> dict[str, FloatArray]:
    """Return the samples of all new legs, with those at both of their ends."""
    distance, count = route.samples["distance"], len(at) - 1
    inside = [(distance > at[k]) & (distance < at[k + 1]) for k in range(count)]
    joined = {
        name: np.concatenate(
            [
                part
                for k in range(count)
                for part in (leaving[name][[k]], values[inside[k]], arriving[name][[k + 1]])
            ]
        )
        for name, values in route.samples.items()
    }
    joined["leg"] = np.repeat(np.arange(count), [int(part.sum()) + 2 for part in inside])
    return joined


def _least_clearance(
    route: Route, samples: dict[str, FloatArray], leg: IntArray, wait: FloatArray
) -> FloatArray:
    """Return the least under-keel clearance of each new leg; NaN where unknown."""
    least, given = np.full(len(leg) - 1, np.nan), route.legs["under_keel_clearance"]
    for number in range(len(least)):
        values = samples["under_keel_clearance"][samples["leg"] == number]
        whole = given[leg[number] : leg[number + 1]]
        if wait[number] > 0.0:
            whole = np.append(whole, given[leg[number]])
        known = np.concatenate([values[np.isfinite(values)], whole[np.isfinite(whole)]])
        least[number] = known.min() if known.size else np.nan
    return least


def _sum_until(route: Route, name: str, leg: IntArray, along: FloatArray) -> FloatArray:
    """Return a sum over a route until distances [m] along some of its legs.

    Inside a leg the part is that of the fuel, or of the time where no fuel is known; a wait is at
    its start.
    """
    values = route.legs[name]
    before = np.concatenate([[0.0], np.cumsum(values)])[leg]
    if name.startswith("waiting"):
        return np.asarray(before + np.where(along > 1e-3, values[leg], 0.0))
    samples, shares = route.samples, np.empty(len(leg))
    leg_of = samples["leg"].astype(np.int64)
    for number, which in enumerate(leg):
        here = slice(*np.searchsorted(leg_of, [which, which + 1]))
        time, rate = samples["time"][here], samples["fuel_rate"][here]
        rate = rate if np.isfinite(rate).all() and rate.any() else np.ones(len(time))
        spent = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time))])
        distance = samples["distance"][here] - samples["distance"][here][0]
        part = np.interp(along[number], distance, spent)
        shares[number] = part / spent[-1] if spent[-1] > 0.0 else 1.0
    return np.asarray(before + values[leg] * shares)
