"""A route cut at the waypoints of its files, and the rows that the files hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import densify, inverse
from thalweg.core.rhumb_lines import inverse_rhumb
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.carried_extensions import Visit, visits_of
from thalweg.route.formats.file_waypoints import FileVertices, file_vertices
from thalweg.route.formats.parsed_track import (
    GEOMETRY,
    GREAT_CIRCLE,
    RHUMB_LINE,
    track_of,
    waypoint_track,
)
from thalweg.route.formats.route_file_options import RouteFileOptions
from thalweg.route.formats.sample_places import SamplePlaces, time_integral
from thalweg.route.formats.waypoint_names import waypoint_names
from thalweg.route.indicator_columns import (
    GREATEST_ON_LEGS,
    INSHORE_DISTANCE,
    LAND_DISTANCE_CAP,
    LEAST_ON_LEGS,
)
from thalweg.route.route import Route
from thalweg.route.route_tables import LEG_KINDS, waypoint_rows
from thalweg.route.track import Track

if TYPE_CHECKING:
    from thalweg.chart import Chart

#: Results of legs that are not sums over their parts.
_NO_SUMS = (
    "length", "course", "depart", "arrive", "ordered_speed", "under_keel_clearance", "leg_kind",
)  # fmt: skip
#: Decimals of columns that have not three.
_DECIMALS = {"waiting_h": 6, "ordered_speed_kn": 6}
_LAND_STEP = 463.0  # between the places at which the distance from land is looked up [m]
_DIRECTIONS = ("course", "heading", "leg")  # not interpolated


@dataclass(frozen=True, eq=False)
class FileRoute:
    """A route at the waypoints of its files.

    Attributes
    ----------
    rows : One per waypoint: ``name`` and the columns of `thalweg.route.route.Route.waypoints`, with
        the courses of the file's lines, and ``geometry``, the line of the leg that begins there: RL
        (rhumb line) or GC (great circle).
    cross_track_m : Greatest distance of the route from the lines between the waypoints [m].
    visits : The waypoint of the route at each row; None between two of them.
    """

    rows: list[dict[str, Any]]
    cross_track_m: float
    visits: list[Visit | None]


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
    if options.chart is not None and "land_distance" in cut.legs:
        cut = replace(cut, legs=_with_land_of_parts(cut.legs, route, vertices, options.chart))
    rows = waypoint_rows(cut)
    lat, lon = vertices.lat, vertices.lon
    ends = lat[:-1], lon[:-1], lat[1:], lon[1:]
    course = inverse(*ends)[1] if options.great_circles else inverse_rhumb(*ends)[1]
    approach = cut.legs["leg_kind"] == LEG_KINDS.index("approach")
    names = waypoint_names(vertices.at, options.start, options.goal, approach)
    # a canal is joined from end to end: its leg must not be cut along a rhumb line
    whole = (cut.legs["leg_kind"] == LEG_KINDS.index("canal")) | options.great_circles
    lines = [*np.where(whole, GREAT_CIRCLE, RHUMB_LINE).tolist(), None]
    bearings = np.degrees(np.append(course, course[-1])).tolist()
    digits = {"lat": options.decimals, "lon": options.decimals, **_DECIMALS}
    visits = _waypoints_at(route, vertices)
    given = route.track.extensions.names
    names = [given.get(at, name) if at else name for at, name in zip(visits, names)]
    file_rows = [
        {
            "name": name,
            **{k: round(v, digits.get(k, 3)) if type(v) is float else v for k, v in row.items()},
            "course_deg": round(bearing, 2),
            GEOMETRY: line,
        }
        for name, row, bearing, line in zip(names, rows, bearings, lines)
    ]
    for row, sampled in zip(file_rows, rows):
        if row.get("heading_deg") is None or sampled["course_deg"] is None:
            continue
        # legs of the file are not those of the route: the drift is that of the route there
        drift = sampled["heading_deg"] - sampled["course_deg"]
        drift = 0.0 if row["leg_kind"] == "canal" else drift  # samples do not have the bends
        row["heading_deg"] = round(row["course_deg"] + drift, 3) % 360.0
    return FileRoute(file_rows, vertices.cross_track, visits)


def _waypoints_at(route: Route, vertices: FileVertices) -> list[Visit | None]:
    """Return the waypoint of the route at each waypoint of the file; None between two of them."""
    start = cumulative_sums(route.legs["length"])
    nearest = np.searchsorted(start, vertices.at - 1e-3)
    nearest = np.minimum(nearest, len(start) - 1)
    same = np.abs(start[nearest] - vertices.at) < 1e-3
    visits = visits_of(route.track.positions)
    return [visits[k] if there else None for k, there in zip(nearest.tolist(), same.tolist())]


def file_track(route: Route, options: RouteFileOptions | None = None) -> Track:
    """Return the track that a reader of the files of a route sails, with their rounded numbers.

    Raises
    ------
    InputError : If the route needs more waypoints than the options allow.
    """
    rows = file_route(route, options).rows
    positions = [(row["lat"], row["lon"]) for row in rows]
    return track_of(waypoint_track(positions, [rows[0]["time"]], rows), None, "route")


def _cut(route: Route, vertices: FileVertices) -> _CutRoute:
    """Return the legs and samples of a route between the vertices of its files."""
    track, at, leg = route.track, vertices.at, vertices.leg
    start = cumulative_sums(route.legs["length"])
    before = np.maximum(np.searchsorted(start, at - 1e-6, side="right") - 1, 0)
    leaving_place = SamplePlaces.on_legs(route.samples, leg, at)
    leaving = leaving_place.values(route.samples, nearest=_DIRECTIONS)
    arriving = SamplePlaces.on_legs(route.samples, before, at).values(
        route.samples, nearest=_DIRECTIONS
    )
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
    sailed, begun = _spent_shares(route, leaving_place), at - start[leg] > 1e-3
    for name in (one for one in route.legs if one not in _NO_SUMS):
        values, kind = route.legs[name], name.partition(":")[0]
        if kind in GREATEST_ON_LEGS or kind in LEAST_ON_LEGS:
            extreme = np.minimum if kind in LEAST_ON_LEGS else np.maximum
            legs[name] = _extremes(values, leg[:-1], before[1:], extreme)
            continue
        share = begun if name.startswith("waiting") else sailed  # a wait is at the start of its leg
        until = cumulative_sums(values)[leg]
        legs[name] = np.diff(until + np.where(share == 0.0, 0.0, values[leg] * share))
    return _CutRoute(cut_track, legs, samples, route.cost_name, route.engine_order)


def _with_land_of_parts(
    legs: Mapping[str, FloatArray], route: Route, vertices: FileVertices, chart: Chart
) -> dict[str, FloatArray]:
    """Return the legs with the distance from land of each part of a leg that is cut.

    The whole leg has the least one of its parts. What is sailed inshore is that of the whole,
    spread over the parts that are inshore.
    """
    parent = vertices.leg[:-1]
    is_part = legs["length"] < route.legs["length"][parent] - 1.0
    lat, lon, part = densify(vertices.lat, vertices.lon, _LAND_STEP)
    shore = np.asarray(chart.coastline.shore_distance(lat, lon, cap=LAND_DISTANCE_CAP))
    nearest = np.minimum(np.minimum(shore[1:], shore[:-1]), LAND_DISTANCE_CAP)
    least = np.full(len(parent), LAND_DISTANCE_CAP)
    np.minimum.at(least, part, nearest)
    inshore = np.bincount(part, nearest < INSHORE_DISTANCE, len(parent)) * is_part
    of_leg = np.bincount(parent, inshore)[parent]
    found = dict(legs)
    found["land_distance"] = np.where(
        is_part, np.maximum(least, legs["land_distance"]), legs["land_distance"]
    )
    for name in ("inshore_length", "inshore_time"):
        whole = np.bincount(parent, legs[name] * is_part)[parent]
        spread = whole * inshore / np.maximum(of_leg, 1)
        found[name] = np.where(is_part & (of_leg > 0), spread, legs[name])
    return found


def _extremes(values: FloatArray, first: IntArray, last: IntArray, extreme: np.ufunc) -> FloatArray:
    """Return the least or greatest values of ranges of legs, both ends included."""
    ranges = np.stack([first, np.maximum(first, last) + 1], axis=-1).ravel()
    return np.asarray(extreme.reduceat(np.append(values, values[-1]), ranges)[::2])


def _joined_samples(
    route: Route, at: FloatArray, leaving: dict[str, FloatArray], arriving: dict[str, FloatArray]
) -> dict[str, FloatArray]:
    """Return the samples of all new legs, with those at both of their ends."""
    distance, count = route.samples["distance"], len(at) - 1
    number = np.searchsorted(at, distance, side="left") - 1
    inside = (number >= 0) & (number < count)
    inside[inside] = distance[inside] < at[number[inside] + 1]
    kept = np.flatnonzero(inside)
    number = number[kept]
    size = np.bincount(number, minlength=count) + 2
    end = np.cumsum(size)
    place = np.arange(len(kept)) + 2 * number + 1
    joined = {}
    for name, values in route.samples.items():
        joined[name] = np.empty(int(end[-1]))
        joined[name][place] = values[kept]
        joined[name][end - size] = leaving[name][:-1]
        joined[name][end - 1] = arriving[name][1:]
    joined["leg"] = np.repeat(np.arange(count), size)
    return joined


def _least_clearance(
    route: Route, samples: dict[str, FloatArray], leg: IntArray, wait: FloatArray
) -> FloatArray:
    """Return the least under-keel clearance of each new leg; NaN where unknown."""
    sampled, given = (
        np.where(np.isfinite(values), values, np.nan)
        for values in (samples["under_keel_clearance"], route.legs["under_keel_clearance"])
    )
    first = np.flatnonzero(np.diff(samples["leg"], prepend=-1))
    # between equal legs reduceat takes one value, which does not count
    whole = np.fmin.reduceat(np.append(given, np.nan), leg)[:-1]
    least = np.fmin(np.fmin.reduceat(sampled, first), np.where(np.diff(leg) > 0, whole, np.nan))
    return np.where(wait[:-1] > 0.0, np.fmin(least, given[leg[:-1]]), least)


def _spent_shares(route: Route, places: SamplePlaces) -> FloatArray:
    """Return which share of the fuel of its leg, or of its time where none is known, is spent."""
    samples = route.samples
    spent = time_integral(samples, samples["fuel_rate"])
    whole = spent[places.last]
    part = places.interpolated(spent)
    return np.divide(part, whole, out=np.ones(len(part)), where=whole > 0.0)
