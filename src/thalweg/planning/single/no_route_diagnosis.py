"""Errors for voyages without a route: the reason, and what the user can change."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import distance, format_position
from thalweg.core.time import format_time
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.network.shortest_paths import reversed_graph, shortest_path_tree
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.single.controlling_depth import find_controlling_depth
from thalweg.planning.single.weather_stall import SearchedWater, weather_stall
from thalweg.sea import StationFields, standard_names
from thalweg.search import SearchResult


def no_route_error(
    network: Network,
    result: SearchResult,
    ends: tuple[Endpoint, Endpoint],
    *,
    depart: float,
    last: float,
    latest: float | None = None,
    water: SearchedWater | None = None,
) -> NoRouteError:
    """Build the error for a search that did not reach its goal.

    Parameters
    ----------
    result : Result of the failed search.
    depart : Earliest departure [s since 1970].
    last : End of the data [s since 1970]; may be infinite.
    latest : Latest departure of a window [s since 1970]; all departures in it were searched.
    water : The sea that was searched; with it the error states where the water is too shallow at
        any tide, the greatest depth there and its time, and where the weather leaves the ship
        little of her speed.
    """
    reasons = {**network.meta.rejected}
    for reason, count in result.refused.items():
        reasons[reason] = reasons.get(reason, 0) + count
    reasons = {reason: count for reason, count in reasons.items() if count}
    found = _reached(network, result, ends[1], depart)
    nearest, reached, ended = None, "No point beyond the start can be reached.", False
    if found is not None:
        nearest = found.lat, found.lon
        reached = (
            f"The nearest point reached is {format_position(*nearest)}, "
            f"{found.left / NAUTICAL_MILE:.1f} nm short."
        )
        ended = found.arrival > last
    deepest = None if water is None else _deepest_path(network, water.fields, water.required)
    if deepest is not None and deepest.depth == -math.inf:
        return NoRouteError(
            f"No route from {ends[0].name} to {ends[1].name}: "
            "on every path there is water of unknown depth.",
            str(deepest),
            _ADVICE_UNKNOWN,
            reasons=reasons,
            nearest=nearest,
        )
    if deepest is not None and deepest.missing > 0.0:
        return NoRouteError(
            f"No route from {ends[0].name} to {ends[1].name}: "
            "the water is too shallow at any tide.",
            str(deepest),
            _ADVICE_SHALLOW,
            reasons=reasons,
            nearest=nearest,
            missing_m=deepest.missing,
        )
    stall = None
    if water is not None:
        node, time = (network.meta.start, depart) if found is None else (found.node, found.here)
        stall = weather_stall(network, water, node, time)
    if stall is not None:
        reached = f"{stall} {reached}"
        slow = reasons.pop(codes.REASONS[codes.CURRENT], 0)
        reasons |= {_TOO_SLOW: slow} if slow else {}
    causes = dict(reasons)
    if stall is None and water is not None and reasons.get(codes.REASONS[codes.NO_DATA]):
        unknown = _unknown_beyond(network, -1 if found is None else found.node, water.fields)
        reached += unknown
        if found is not None and not unknown:  # the gaps are elsewhere, as beyond the data
            causes = _without_gaps(reasons)
    is_tidal = stall is None and deepest is not None and not math.isnan(deepest.time)
    is_tidal = is_tidal and _main_cause(causes) == codes.DEPTH
    if is_tidal and deepest is not None:
        reached += f" {deepest.tide_text()}"
    ended = ended and bool(reasons.get(codes.REASONS[codes.OUTSIDE_PERIOD]))
    within = f"arrives before the data end at {format_time(last)}" if ended else "keeps the limits"
    when = f"departing {format_time(depart)}"
    if latest is not None and latest > depart:
        when = f"departing at any time from {format_time(depart)} to {format_time(latest)}"
    return NoRouteError(
        f"No route from {ends[0].name} to {ends[1].name} {within}, {when}.",
        reached,
        _advice(causes, ended, is_tidal)
        if stall is None
        else _ADVICE_STALL + (_LONGER if ended else ""),
        reasons=reasons,
        nearest=nearest,
        **({"data_end": format_time(last)} if ended else {}),
    )


def unreached_goal_error(
    error: NoRouteError, ends: tuple[Endpoint, ...], depart: float, *, wait: bool
) -> NoRouteError:
    """Return the error of a search between two nodes in the words of the voyage.

    Parameters
    ----------
    error : As the search raised it.
    ends : Start, via points and goal.
    depart : Departure [s since 1970].
    wait : Whether the ship might wait.
    """
    where = "No point beyond the start can be reached."
    if error.nearest is not None:
        left = float(distance(*error.nearest, ends[-1].lat, ends[-1].lon)) / NAUTICAL_MILE
        where = (
            f"The nearest point reached is {format_position(*error.nearest)}, {left:.1f} nm short."
        )
    waits = "" if wait else " without a wait"
    return NoRouteError(
        f"No route from {ends[0].name} to {ends[-1].name} keeps the limits{waits}, "
        f"departing {format_time(depart)}.",
        where,
        _advice(_without_gaps(error.reasons), ended=False, is_tidal=False),
        reasons=error.reasons,
        nearest=error.nearest,
    )


class _Reached(NamedTuple):
    """The node from which the way to the goal is shortest, of those that were reached.

    Attributes
    ----------
    left : Length of that way [m], or of the geodesic where the network has none.
    arrival : At the goal, at the mean speed until then [s since 1970].
    here : At this node [s since 1970].
    """

    node: int
    lat: float
    lon: float
    left: float
    arrival: float
    here: float


def _reached(
    network: Network, result: SearchResult, goal: Endpoint, depart: float
) -> _Reached | None:
    """Return how far the search came; None where it has no node."""
    if result.nearest_node < 0:
        return None
    lat, lon, start = network.lat, network.lon, network.meta.start
    node, left = result.nearest_node, math.nan
    if min(start, network.meta.goal) >= 0:
        backwards, edge = reversed_graph(network)
        length = network.edges.length[edge]
        left_of = shortest_path_tree(backwards, length, network.meta.goal).distance
        left_of = np.where(np.isfinite(result.node_arrival), left_of, math.inf)
        if np.isfinite(left_of).any():
            node = int(np.argmin(left_of))
            left = float(left_of[node])
    if math.isnan(left):
        left = float(distance(lat[node], lon[node], goal.lat, goal.lon))
    here = float(result.node_arrival[node])
    sailed = float(distance(lat[start], lon[start], lat[node], lon[node])) if start >= 0 else 0.0
    arrival = here + (here - depart) * left / sailed if sailed > 0.0 else here
    return _Reached(node, float(lat[node]), float(lon[node]), left, arrival, here)


def _unknown_beyond(network: Network, node: int, fields: StationFields) -> str:
    """Return what is unknown in the water next to a node and where, as a sentence; else empty."""
    if node < 0:
        return ""
    first, last = network.graph.indptr[node : node + 2]
    edges = range(int(first), int(last))
    samples = [network.samples.station_b[network.samples.ptr[e] : network.samples.ptr[e + 1]]
               for e in edges]  # fmt: skip
    beyond = np.unique(np.concatenate([network.graph.target[first:last], *samples, [node]]))
    unknown = np.isnan(fields.values[beyond]).any(axis=1)
    names = [
        standard_names.CHANNEL_VARIABLES[channel]
        for channel, column in enumerate(fields.channel_index)
        if column >= 0 and channel in standard_names.CHANNEL_VARIABLES and unknown[:, column].any()
    ]
    if not names:
        return ""
    at = int(beyond[int(np.argmax(unknown.any(axis=1)))])
    place = format_position(float(network.stations.lat[at]), float(network.stations.lon[at]))
    return f" Next to it, at {place}, {', '.join(names)} {_be(names)} unknown."


def _be(names: list[str]) -> str:
    return "is" if len(names) == 1 else "are"


def late_arrival_error(
    arrive_by: float,
    earliest: float,
    *,
    window: bool = False,
    approach: float = 0.0,
    about: bool = False,
) -> NoRouteError:
    """Build the error for a latest arrival that no route meets.

    Parameters
    ----------
    arrive_by : Latest arrival of the voyage [s since 1970].
    earliest : Earliest possible arrival [s since 1970].
    window : Whether it is that of the shortest passage in a departure window.
    approach : Time in the approach of the port of arrival after both [s].
    about : Whether the earliest arrival is that of the network, before refinement.
    """
    arrive_by, earliest = arrive_by + approach, earliest + approach
    if earliest <= arrive_by:  # in time, but not with this objective
        return NoRouteError(
            f"The shortest route does not arrive by {format_time(arrive_by)}.",
            f"The fastest route arrives at {format_time(earliest)}.",
            "Choose the objective 'time', or allow a later arrival.",
            reasons={codes.REASONS[codes.ARRIVE_BY]: 1},
            field="arrive_by",
        )
    subject = "shortest passage of the window arrives at" if window else "earliest arrival is"
    subject += " about" if about else ""
    return NoRouteError(
        f"No route arrives by {format_time(arrive_by)}.",
        f"The {subject} {format_time(earliest)}.",
        "Allow a later arrival, or depart earlier.",
        reasons={codes.REASONS[codes.ARRIVE_BY]: 1},
        field="arrive_by",
        earliest=format_time(earliest),
    )


class DeepestPath(NamedTuple):
    """Where and when the water is deepest on the best path, and what is required there.

    Attributes
    ----------
    lat, lon : [deg].
    depth : Greatest depth there [m]; infinite if unknown.
    time : When it is deepest [s since 1970]; NaN if the depth does not change.
    required : Required depth [m].
    until : End of the data [s since 1970].
    """

    lat: float
    lon: float
    depth: float
    time: float
    required: float
    until: float

    @property
    def missing(self) -> float:
        """Required depth less greatest depth [m]; not positive where the tide is high enough."""
        return self.required - self.depth

    def tide_text(self) -> str:
        """Return that the water is deep enough at high water only, as a sentence."""
        return (
            f"The water on the way is too shallow at that time: near "
            f"{format_position(self.lat, self.lon)} {self.required:.2f} m are required, "
            f"and the greatest depth is {self.depth:.2f} m at {format_time(self.time)}."
        )

    def __str__(self) -> str:
        place = format_position(self.lat, self.lon)
        if not math.isfinite(self.depth):
            return f"The depth near {place} is not known."
        when = "" if math.isnan(self.time) else f", at {format_time(self.time)}"
        until = "" if math.isnan(self.time) else f" before {format_time(self.until)}"
        return (
            f"The deepest path has at most {self.depth:.2f} m near {place}{when}; "
            f"{self.required:.2f} m are required{until}: {self.missing:.2f} m "
            "too little; a draught smaller by that passes there."
        )


def _deepest_path(network: Network, fields: StationFields, required: float) -> DeepestPath | None:
    """Return the controlling depth at the highest tide beside the required one; None if unknown."""
    if not math.isfinite(required) or min(network.meta.start, network.meta.goal) < 0:
        return None
    found = find_controlling_depth(network, fields)
    if found is None:
        return None
    end = float(fields.times[-1])
    return DeepestPath(found.lat, found.lon, found.depth, found.time, required, end)


_ADVICE_SHALLOW = (
    "Load less (--load-factor), require less clearance (--ukc), or use data that include a higher "
    "tide."
)
_ADVICE_UNKNOWN = (
    "Add data that have the depth there, or a finer --resolution where the known water is narrower "
    "than the network of the search."
)
_ADVICE_TIDE = (
    "Depart later, use water levels that last longer, search a window of departures "
    "(--depart-window), or permit waits where --no-wait forbids them; or load less "
    "(--load-factor), or require less clearance (--ukc)."
)
_TOO_SLOW = "current too strong for the speed that the weather leaves"
_ADVICE_STALL = (
    "Her speed loss in wind and waves is the cause. Depart at another time, or give the ship "
    "limits below that weather (limits.max_significant_wave_height_m, limits.max_wind_speed_kn): "
    "plans go round it or wait for it then. If she keeps more speed in truth, choose another "
    "models.speed_loss: kwon_2008 is for winds up to Beaufort 6, of large ships 8."
)
_LONGER = " Or add a longer forecast."
_ADVICE_ENDED = (
    "Add a longer forecast, or depart earlier. If this was not for the least time, such a plan may "
    "still arrive in time: its last step is not bound to the network of this search."
)
_ADVICE_WEATHER = (
    "Depart later, search a window of departures (--depart-window), permit waits where --no-wait "
    "forbids them, or raise the limit of the ship."
)
_ADVICE = {
    codes.DEPTH: "Load less (--load-factor), require less clearance (--ukc), or allow waiting for "
    "the tide.",
    codes.WAVE_HEIGHT: _ADVICE_WEATHER,
    codes.WIND_SPEED: _ADVICE_WEATHER,
    codes.NO_DATA: "The data have gaps: add a layer that covers them, or fill them by name, for "
    "example --fill currents=nearest:25 or currents=0.",
    codes.CURRENT: "The current is faster than the ship: depart at another time.",
    codes.ARRIVE_BY: "Allow a later arrival.",
    codes.SAFETY: "Depart later, order another speed, or relax the limits of the ship file.",
}


_OF_ANY_COAST = (codes.LAND, codes.OFFING, codes.NO_GO, codes.OUTSIDE_PERIOD)


def _without_gaps(reasons: dict[str, int]) -> dict[str, int]:
    """Return reasons without gaps of data, unless they are the only cause."""
    others = {text: n for text, n in reasons.items() if text != codes.REASONS[codes.NO_DATA]}
    return others if _main_cause(others) else reasons


def _main_cause(reasons: dict[str, int]) -> int:
    """Return the code of the most frequent reason but coasts and periods; 0 if there is none."""
    counts = {
        code: reasons.get(codes.REASONS[code], 0)
        for code in codes.REASONS
        if code not in _OF_ANY_COAST
    }
    code = max(counts, key=lambda c: counts[c])
    return code if counts[code] else 0


def _advice(reasons: dict[str, int], ended: bool, is_tidal: bool) -> str:
    """Return what to do; ``is_tidal``: the tide makes the water deep enough at another time."""
    later = _ADVICE_ENDED if ended else ""
    code = _main_cause(reasons)
    if code:
        advice = _ADVICE_TIDE if is_tidal else _ADVICE.get(code, "Change the limits or the area.")
        return later or advice
    if later:
        return later
    if reasons.get(codes.REASONS[codes.OFFING]):
        return "Try a finer resolution, or a smaller offing: --resolution, --offing."
    return "Try a finer resolution, or check that the places are not enclosed by land."
