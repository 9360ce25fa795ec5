"""What a plan states about ice: by the data, or by the months in which it is usual."""

from __future__ import annotations

import calendar
from collections.abc import Sequence
from typing import Final

import numpy as np

from thalweg.chart.ice_areas import ICE_AREAS, IceArea
from thalweg.core.geodesy import Position, densify, distance, format_position_minutes
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.ice_limits import outside_ice
from thalweg.route import Route
from thalweg.sea import Sea
from thalweg.sea.standard_names import ICE

_FAR_NORTH: Final = 60.0  # latitude of an end from which on ways through ice are of use [deg]
_BY_THE_NORTH: Final = 68.0  # latitude that the geodesic reaches then [deg]
_ROUNDABOUT: Final = 1.5  # times the geodesic
_LATITUDE: Final = 72.0  #: [deg] beyond which ice is likely in all months
_OPEN_WATER: Final = 0.1  #: greatest concentration of ice that counts as open water
REACHES_ICE: Final = "The route reaches"  #: a note on ice begins so
SOUTH_LEFT_OUT: Final = "Water south of "  #: a note on water left out begins so
_SPACING: Final = 20.0 * NAUTICAL_MILE  #: of the places at which ways without a date are tested [m]
#: Northern boundary of the Southern Winter Seasonal Zone (lon, lat) [deg], rhumb lines: Load Lines
#: Convention 1966, Annex II, regulation 48; round Tasmania and South America roughly.
_WINTER_ZONE: Final = (
    (-75.0, -41.0), (-73.883, -41.783), (-65.88, -47.1), (-50.0, -34.0), (17.0, -34.0),
    (20.0, -35.167), (28.0, -34.0), (118.0, -35.5), (144.7, -40.7), 
    (147.3, -43.5), (167.7, -47.1), (170.0, -47.0), (190.0, -33.0), (281.0, -33.0),
)  # fmt: skip
#: Winter in the Southern Winter Seasonal Zone, as (month, day).
_SOUTHERN_WINTER: Final = ((4, 16), (10, 15))
_ADVICE: Final = "give a via point or a no-go zone if that water is closed"


def ice_warnings(route: Route, sea: Sea) -> list[str]:
    """Return warnings about ice on a route, which is never modelled.

    Parameters
    ----------
    route : The evaluated route.
    sea : Its ice counts where it is known; elsewhere the months of `ICE_AREAS` count.

    Returns
    -------
    list of str : A sentence for the thickest ice of the data, and for each area.
    """
    lat, lon = (np.asarray(route.samples[name], float) for name in ("lat", "lon"))
    time = np.asarray(route.samples["time"], float)
    time = np.where(np.isfinite(time), time, route.depart)
    ice = _ice_of_data(sea, time, lat, lon)
    notes = []
    if np.any(ice > _OPEN_WATER):
        at = int(np.nanargmax(ice))
        notes.append(
            f"{REACHES_ICE} ice that covers {100.0 * ice[at]:.0f} % of the water by the data, at "
            f"{format_position_minutes(lat[at], lon[at])}; ice is not modelled: {_ADVICE}."
        )
    unknown = np.isnan(ice)
    month = _months(time)
    reached: dict[str, tuple[int, IceArea]] = {}  # of each name where the ship first is in it
    for area in ICE_AREAS:
        inside = unknown & np.isin(month, area.months)
        inside[inside] = area.contains(lat[inside], lon[inside])
        if inside.any():
            first = (int(np.argmax(inside)), area)
            reached[area.name] = min(first, reached.get(area.name, first), key=lambda one: one[0])
            unknown &= ~inside
    for at, area in reached.values():
        what = "Icebergs are" if area.kind == "icebergs" else "Ice is"
        charts = "warnings of icebergs" if area.kind == "icebergs" else "ice charts"
        notes.append(
            f"{REACHES_ICE} the {area.name} in {calendar.month_name[month[at]]}, from "
            f"{format_position_minutes(lat[at], lon[at])}. {what} usual there {area.season} "
            f"({area.source}), and the data have none: read the {charts}. Ice is not "
            f"modelled: {_ADVICE}."
        )
    notes += _load_line_notes(time, lat, lon)
    far = np.where(unknown, np.abs(lat), 0.0)
    worst = int(np.argmax(far))
    if far[worst] < _LATITUDE:
        return notes
    place = format_position_minutes(lat[worst], lon[worst])
    return [*notes, f"{REACHES_ICE} {place}, and sea ice is not modelled: {_ADVICE}."]


def ice_notes_of_way(line: Sequence[Position]) -> tuple[str, ...]:
    """Return a note on the areas and months of ice on a way that has no date.

    Parameters
    ----------
    line : Waypoints (lat, lon) [deg].
    """
    places = np.array(line, float)
    lat, lon, _ = densify(places[:, 0], places[:, 1], _SPACING)
    found: dict[str, str] = {}
    far = np.abs(lat)
    for area in ICE_AREAS:  # of one name the longest season is first
        inside = area.contains(lat, lon)
        far[inside] = 0.0
        if area.name not in found and inside.any():
            found[area.name] = f"{area.name} {area.season}"
    notes = (f"Ice is usual on the way in: {'; '.join(found.values())}.",) if found else ()
    worst = int(np.argmax(far))
    if far[worst] < _LATITUDE:
        return notes
    place = format_position_minutes(lat[worst], lon[worst])
    return (*notes, f"The way reaches {place}, and sea ice is not modelled.")


def way_left_out_notes(start: Position, goal: Position, length: float) -> tuple[str, ...]:
    """Return a note where ice closes a shorter way between two places far north.

    Parameters
    ----------
    start, goal : (lat, lon) [deg].
    length : Of the way [m].
    """
    if max(start[0], goal[0]) < _FAR_NORTH or not outside_ice(start, goal):
        return ()
    if length < _ROUNDABOUT * float(distance(*start, *goal)):
        return ()
    ends = np.array([start, goal], float)
    lat, _, _ = densify(ends[:, 0], ends[:, 1], _SPACING)
    if lat.max() < _BY_THE_NORTH:
        return ()
    return (
        "Water beyond 72 N is used only from and to arctic coasts: the Northern Sea Route and the "
        "Northwest Passage are left out. Give a place there for that way, such as --via Pevek.",
    )


def _load_line_notes(time: FloatArray, lat: FloatArray, lon: FloatArray) -> list[str]:
    """Return a note on the winter load line in the Southern Winter Seasonal Zone, by its dates."""
    days = time.astype("datetime64[s]").astype("datetime64[D]")
    day = (days - days.astype("datetime64[M]")).astype(np.int64) + 1
    of_year = 100 * _months(time) + day
    first, last = (100 * month + day for month, day in _SOUTHERN_WINTER)
    corners = np.array(_WINTER_ZONE)
    boundary = np.interp(lon, corners[:, 0], corners[:, 1], period=360.0)
    if not np.any((lat < boundary) & (of_year >= first) & (of_year <= last)):
        return []
    return [
        "The winter load line applies from 16 April to 15 October where the route is in the "
        "Southern Winter Seasonal Zone (Load Lines Convention 1966, Annex II): see that the "
        "draught allows it."
    ]


def _months(time: FloatArray) -> np.ndarray:
    """Return the month of each time [s since 1970-01-01T00:00Z], 1 to 12."""
    return time.astype("datetime64[s]").astype("datetime64[M]").astype(np.int64) % 12 + 1


def _ice_of_data(sea: Sea, time: FloatArray, lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return the concentration of ice along a route; NaN where no data have it."""
    if ICE not in sea.variables or sea.members:
        return np.full(lat.shape, np.nan)
    return np.asarray(sea.sample([ICE], time, lat, lon)[ICE], float)
