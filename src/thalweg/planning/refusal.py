"""Why there is no route, in words a user can act on."""

from __future__ import annotations

import math

from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import distance, format_position
from thalweg.core.time import format_time
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.planning.ends import End
from thalweg.search import SearchResult


def no_route(
    network: Network, result: SearchResult, ends: tuple[End, End], *, depart: float, last: float
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
    return NoRouteError(
        f"No route from {ends[0].name} to {ends[1].name} within the limits, departing "
        f"{format_time(depart)}.",
        words,
        _advice(reasons, last),
        reasons=reasons,
        nearest=nearest,
    )


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
