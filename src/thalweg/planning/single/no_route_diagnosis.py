"""Why there is no route, in words a user can act on."""

from __future__ import annotations

import math
from typing import NamedTuple

from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import distance, format_position
from thalweg.core.time import format_time
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.single.controlling_depth import find_controlling_depth
from thalweg.sea import StationFields
from thalweg.search import SearchResult


def no_route_error(
    network: Network,
    result: SearchResult,
    ends: tuple[Endpoint, Endpoint],
    *,
    depart: float,
    last: float,
    fields: StationFields | None = None,
    required: float = -math.inf,
) -> NoRouteError:
    """Build the error for a search that did not reach its goal.

    Parameters
    ----------
    network : Network
    result : SearchResult
        Of the failed search.
    ends : pair of End
    depart : float
        Earliest departure [s since 1970].
    last : float
        When the data end [s since 1970]; inf if they do not.
    fields : StationFields, optional
        The sea that was searched; with it and ``required`` it is told where the water is too
        shallow at any tide, how high it comes there and when.
    required : float, optional
        Depth that is needed [m].
    """
    reasons = {**network.meta.rejected}
    for reason, count in result.refused.items():
        reasons[reason] = reasons.get(reason, 0) + count
    reasons = {reason: count for reason, count in reasons.items() if count}
    nearest, words = None, "Nothing beyond the start can be reached."
    if result.nearest_node >= 0:
        lat = float(network.station_lat[result.nearest_node])
        lon = float(network.station_lon[result.nearest_node])
        nearest = (lat, lon)
        left = float(distance(lat, lon, ends[1].lat, ends[1].lon)) / NAUTICAL_MILE
        words = f"The nearest point reached is {format_position(lat, lon)}, {left:.1f} nm short."
    never = None if fields is None else _depth_deficit(network, fields, required)
    if never is not None:
        return NoRouteError(
            f"No route from {ends[0].name} to {ends[1].name}: "
            "the water is too shallow at any tide.",
            str(never),
            _ADVICE_SHALLOW,
            reasons=reasons,
            nearest=nearest,
            missing_m=never.missing,
        )
    return NoRouteError(
        f"No route from {ends[0].name} to {ends[1].name} within the limits, departing "
        f"{format_time(depart)}.",
        words,
        _advice(reasons, last),
        reasons=reasons,
        nearest=nearest,
    )


def late_arrival_error(arrive_by: float, earliest: float, *, window: bool = False) -> NoRouteError:
    """Build the error for a latest arrival that even the fastest way misses.

    Parameters
    ----------
    arrive_by : float
        Latest arrival asked [s since 1970].
    earliest : float
        Arrival of the fastest way [s since 1970].
    window : bool
        Whether that is the shortest passage of a window of departures, not the earliest arrival.
    """
    if earliest <= arrive_by:  # that of another objective
        return NoRouteError(
            f"The shortest way does not arrive by {format_time(arrive_by)}.",
            f"The fastest arrives at {format_time(earliest)}.",
            "Ask for the least time, or allow a later arrival.",
            reasons={codes.REASONS[codes.ARRIVE_BY]: 1},
        )
    told = "shortest passage of the window arrives at" if window else "earliest arrival is"
    return NoRouteError(
        f"No route arrives by {format_time(arrive_by)}.",
        f"The {told} {format_time(earliest)}.",
        "Allow a later arrival, or depart earlier.",
        reasons={codes.REASONS[codes.ARRIVE_BY]: 1},
        earliest=format_time(earliest),
    )


class DepthDeficit(NamedTuple):
    """Too little water at any tide: where, how much at most, when, and how much is needed."""

    lat: float
    lon: float
    depth: float
    time: float
    required: float
    until: float

    @property
    def missing(self) -> float:
        """By how much it misses [m]."""
        return self.required - self.depth

    def __str__(self) -> str:
        place = format_position(self.lat, self.lon)
        if not math.isfinite(self.depth):
            return f"No depth is known on the way near {place}."
        when = "" if math.isnan(self.time) else f", at {format_time(self.time)}"
        until = "" if math.isnan(self.time) else f" before {format_time(self.until)}"
        return (
            f"The best way there is has at most {self.depth:.2f} m near {place}{when}; "
            f"{self.required:.2f} m are needed{until}: {self.missing:.2f} m too little."
        )


def _depth_deficit(network: Network, fields: StationFields, required: float) -> DepthDeficit | None:
    """Return the shallowest place of the best way if even the highest tide is too low there."""
    if not math.isfinite(required) or min(network.meta.start, network.meta.goal) < 0:
        return None
    found = find_controlling_depth(network, fields)
    if found is None or found.depth >= required:
        return None
    end = float(fields.times[-1])
    return DepthDeficit(found.lat, found.lon, found.depth, found.time, required, end)


_ADVICE_SHALLOW = "Sail lighter, ask less clearance, or come at a higher tide than these data hold."
_ADVICE = {
    codes.DEPTH: "Sail lighter, ask less clearance, or allow waiting for the tide.",
    codes.WAVE_HEIGHT: "Leave later, or raise the limit of the ship.",
    codes.WIND_SPEED: "Leave later, or raise the limit of the ship.",
    codes.NO_DATA: "The data have gaps: add a layer that covers them, or name a filling.",
    codes.CURRENT: "The current is faster than the ship: leave at another time.",
    codes.ARRIVE_BY: "Allow a later arrival.",
    codes.SAFETY: "Leave later, order another speed, or loosen the limits of the ship file.",
}


def _advice(reasons: dict[str, int], last: float) -> str:
    counts = {
        code: reasons.get(codes.REASONS[code], 0)
        for code in codes.REASONS
        if code not in (codes.LAND, codes.OUTSIDE_PERIOD)
    }
    code = max(counts, key=lambda c: counts[c])
    if counts[code]:
        return _ADVICE.get(code, "Change the limits or the area.")
    if reasons.get(codes.REASONS[codes.OUTSIDE_PERIOD]) and math.isfinite(last):
        return f"The data end at {format_time(last)}: add later data or leave earlier."
    return "Try a finer resolution, or check that the places are not enclosed by land."
