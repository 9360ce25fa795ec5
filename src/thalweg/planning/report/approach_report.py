"""Notes on approaches: too shallow or small for a ship, ways that turn back where one ends."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.approaches import PortApproach
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import Passage
from thalweg.chart.port_limits.bridges import bridges_over
from thalweg.core.geodesy import densify, distance, format_position, longitude_difference
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route import Route
from thalweg.route.refinement.track_geometry import course_changes
from thalweg.route.route_tables import LEG_KINDS

TURNS_BACK: Final = "Turns back"  #: a note on such a way begins so
PORT_TOO_SHALLOW: Final = "The port is too shallow"  #: a note on such a port begins so
APPROACH_TOO_SMALL: Final = "The approach is too small"  #: a note on such an approach begins so
OVER_LAND: Final = "The approach crosses land"  #: a note on a line without its river begins so
LOW_BRIDGE: Final = "Low bridge"  #: a note on a bridge that leaves little room begins so
_SHARP: Final = math.radians(120.0)
_DEEP_SHIP: Final = 9.0  # draught that many ports do not take [m]
_LONG_APPROACH: Final = 5.0  # [nm]
LAND_OF_LINES_BY_HAND: Final = 6.0  #: of one leg, from which on a note says so [nm]
_LAND_STEP: Final = 0.2 * NAUTICAL_MILE
#: Miles of charted land on one leg, of computed lines and of those by hand, which follow rivers.
_OVER_LAND: Final = {False: 2.0, True: LAND_OF_LINES_BY_HAND}
_OVER_LAND_AT_BERTH: Final = 3.0  # the same of the first leg: ports have the place of the town
_LEAST_ROOM: Final = 2.0  # under a bridge without a note [m]


def port_depth_note(approach: PortApproach, draught: float) -> str:
    """Return a note on a port that is too shallow for a draught [m]; empty where it is not."""
    if not draught > approach.max_draught:
        return ""
    source, place = approach.draught_source, approach.port.label
    limit = f"{approach.max_draught:g} m"
    largest = (
        f"the largest draught in {place} is {limit} ({source})"
        if source
        else f"the World Port Index gives {limit} as the largest draught in {place}"
    )
    return (
        f"{PORT_TOO_SHALLOW}: {largest}; the ship draws {draught:.1f} m. Load less, or ask the "
        "port."
    )


def approach_limit_notes(
    chart: Chart, approach: PortApproach, sizes: Mapping[str, float | None]
) -> list[str]:
    """Return a note for each passage and bridge of an approach that is too small for a ship.

    One more names the bridges where the air draught is not known.

    Parameters
    ----------
    chart : Its coastline and passages. Passages are also for ports on them, so that their use is
        not considered.
    sizes : Draught, beam, length and air draught of the ship [m], those that are known, by the
        names of `thalweg.chart.passages.Passage.ship_restriction`.
    """
    every = (*chart.passages, *chart.closed_passages)  # the size of a ship may have closed it
    reasons = too_small_passages(chart, sizes)
    lat, lon = np.array(approach.line, float).T
    draught = sizes.get("draught") or 0.0
    passages = [
        f"{APPROACH_TOO_SMALL}: that of {approach.label} leads through {reasons[one]} "
        f"({one.source.rpartition(': ')[2]}). "
        + ("Load less, or ask the port." if draught > one.max_draught else "Ask the port.")
        for _at, one in passages_crossed(chart.coastline, reasons, lat, lon)
    ]
    low = [one for one in every if math.isfinite(one.max_air_draught)]
    low = [one for _at, one in passages_crossed(chart.coastline, low, lat, lon)]
    bridges = _bridge_notes(approach, sizes.get("air_draught"), low)
    return _over_land_notes(chart, approach) + passages + bridges


def _over_land_notes(chart: Chart, approach: PortApproach) -> list[str]:
    lat, lon = np.array(approach.line, float).T
    if approach.through or "Canal" in approach.way:  # a canal is land of the coastline
        return []
    least = _OVER_LAND[approach.quality != "computed"]
    first = most_miles_over_land(chart, lat[:2], lon[:2])
    miles = most_miles_over_land(chart, lat[1:], lon[1:])
    miles = max(miles, first if first >= _OVER_LAND_AT_BERTH else 0.0)
    return [over_land_note(approach.label, miles)] if miles >= least else []


def most_miles_over_land(chart: Chart, lat: FloatArray, lon: FloatArray) -> float:
    """Return for how many miles a leg of a line is charted land, of the leg with most of them.

    Parameters
    ----------
    lat, lon : float64 array (n,) of the line [deg].
    """
    if chart.coastline.is_empty or len(lat) < 2:
        return 0.0
    lat, lon, leg = densify(lat, lon, _LAND_STEP)
    middle = 0.5 * (lat[1:] + lat[:-1]), lon[:-1] + 0.5 * longitude_difference(lon[1:], lon[:-1])
    on_land = np.asarray(chart.coastline.shore_distance(*middle, cap=1.0)) <= 0.0
    metres = np.asarray(distance(lat[:-1], lon[:-1], lat[1:], lon[1:])) * on_land
    return float(np.bincount(leg, metres).max()) / NAUTICAL_MILE


def over_land_note(label: str, miles: float) -> str:
    """Return a note on an approach of which a leg is charted land for some miles."""
    return (
        f"{OVER_LAND}: that of {label} has a straight leg of which {miles:.0f} nm are land by the "
        "coastline, which does not have the water there. Do not sail this line: take the channel "
        "from the chart of the port; it is longer."
    )


def _bridge_notes(
    approach: PortApproach, air_draught: float | None, low: Sequence[Passage]
) -> list[str]:
    """Return notes on the bridges over an approach.

    Parameters
    ----------
    air_draught : Of the ship [m]; None where it is not known.
    low : Named passages on the approach with a limit of the air draught.
    """
    bridges = bridges_over(approach.line)
    if air_draught is None:
        names = [f"{one.name} ({one.max_air_draught:g} m)" for one in low]
        names += [f"{one.name} ({one.clearance:g} m)" for one in bridges]
        return [
            f"Bridges over the approach of {approach.label}: {', '.join(names)}. The air draught "
            "of the ship is not known and was not compared."
        ] * bool(names)
    room = {one: one.clearance - air_draught for one in bridges}
    return [
        (f"{APPROACH_TOO_SMALL}: that" if room[one] < 0.0 else f"{LOW_BRIDGE}: the approach")
        + f" of {approach.label} leads under {one.name}: the air draught of {air_draught:g} m "
        + ("is over" if room[one] < 0.0 else f"leaves {room[one]:.1f} m of")
        + f" its clearance of {one.clearance:g} m ({one.source}). Ask the port: other berths may "
        "lie before the bridge, and the clearance grows at low water."
        for one in bridges
        if room[one] < _LEAST_ROOM
    ]


def too_small_passages(chart: Chart, sizes: Mapping[str, float | None]) -> dict[Passage, str]:
    """Return the named passages that are too small for a ship, and why, whoever uses them.

    Parameters
    ----------
    chart, sizes : As of `approach_limit_notes`.
    """
    every = (*chart.passages, *chart.closed_passages)  # the size of a ship may have closed it
    limited = [replace(one, use="trade") for one in every if one.limits]
    too_small = [(one, one.ship_restriction(**sizes)) for one in limited]
    return {one: reason for one, reason in too_small if reason}


def unknown_depth_text(approach: PortApproach, draught: float) -> str:
    """Return a sentence for deep ships on a port of which no largest draught is known, or "".

    It names the approach where that is long: no table has the depth along it.

    Parameters
    ----------
    draught : Of the ship [m].
    """
    if draught < _DEEP_SHIP or not math.isnan(approach.max_draught):
        return ""
    miles = approach.length / NAUTICAL_MILE
    way = "" if miles < _LONG_APPROACH else f", nor the depth along its approach of {miles:.0f} nm"
    return f" No largest draught in {approach.port.label} is known{way}: ask the port."


def turn_back_notes(lat: FloatArray, lon: FloatArray, ends: Iterable[int]) -> list[str]:
    """Return a note for each end of an approach at which a way turns back.

    Approaches lead to open sea on one side; where the way onwards lies on the other side and no
    branch of the approach leads there, it is longer than a pilot would go.

    Parameters
    ----------
    lat, lon : float64 array (n,) of the whole way [deg].
    ends : Which of its waypoints are ends of approaches. The first and the last waypoint, which
        terminals in open water have as the end of their approach, have no turn.
    """
    turns = np.abs(course_changes(lat, lon))
    return [
        f"{TURNS_BACK} by {math.degrees(turns[at - 1]):.0f} degrees at "
        f"{format_position(lat[at], lon[at])}: the sea end of the channel of a port is there, on "
        "the side away from the voyage. If the chart has a channel nearer to the voyage, plan from "
        "or to a position in that channel."
        for at in ends
        if 1 <= at <= len(turns) and turns[at - 1] > _SHARP
    ]


def turn_back_notes_of_route(route: Route) -> list[str]:
    """Return the notes of a route with the approaches of its ports."""
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(len(route.legs["length"]))))
    is_approach = kind == LEG_KINDS.index("approach")
    ends = np.flatnonzero(is_approach[1:] != is_approach[:-1]) + 1
    track = route.track
    lat, lon = np.asarray(track.lat, float), np.asarray(track.lon, float)
    return turn_back_notes(lat, lon, ends.tolist())
