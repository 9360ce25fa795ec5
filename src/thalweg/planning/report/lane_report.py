"""What a plan states about the traffic separation schemes of the package."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.zones.missing_schemes import seas_with_other_schemes
from thalweg.chart.zones.traffic_schemes import INSHORE, PORT_RADIUS, TRAFFIC_SCHEMES
from thalweg.core.arrays.leg_ends import leg_ends
from thalweg.core.errors import names_in_words
from thalweg.core.geodesy import densify, distance
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import Network
from thalweg.network.shortest_paths import shortest_path
from thalweg.route import Route

AGAINST_TRAFFIC: Final = "Runs against the traffic"  #: a note on such miles begins so
INSHORE_USED: Final = "Uses the inshore traffic zone"  #: a note on such miles begins so
LANE_DETOUR: Final = "Keeping out of"  #: a note on a detour by lanes and inshore zones begins so
_KEPT_OUT: Final = {False: "opposite lane", True: "inshore traffic zone"}
_STEP: Final = 2.0 * NAUTICAL_MILE  # of positions along a route
_LEAST: Final = 2.0 * NAUTICAL_MILE  # shorter stretches in a scheme are crossings
_LONG_DETOUR: Final = 5.0 * NAUTICAL_MILE  # detours are stated from this length ...
_LARGE_DETOUR: Final = 0.03  # ... or this share of the shortest way


def lane_notes(chart: Chart, route: Route) -> list[str]:
    """Return through which schemes a route leads, and where it runs against their traffic.

    Parameters
    ----------
    chart : Of the plan.

    Returns
    -------
    list of str : Where the route meets none that is so; empty for charts with lanes of their own.
    """
    if not _has_schemes(chart):
        return []
    legs = leg_ends(*_positions(route))
    against = _metres(chart, legs)
    along = _metres(chart, (*legs[2:], *legs[:2]))
    inshore = _metres(chart, legs, inshore=True)
    wrong = {name: metres for name, metres in against.items() if metres > _LEAST}
    kept = [s.name for s in TRAFFIC_SCHEMES if along.get(s.name, 0.0) > _LEAST]
    kept = [name for name in kept if name not in wrong]
    notes = []
    others = _other_schemes_text(route)
    if kept:
        notes.append(
            f"Keeps to starboard of the separation lines of {', '.join(kept)}, not within "
            f"{PORT_RADIUS / NAUTICAL_MILE:.0f} nm of the ends of the voyage: these lines are "
            f"approximate and not charted; lay the route off in the lanes of the chart. {others}"
        )
    notes += [
        f"{INSHORE_USED} of {name} for about {metres / NAUTICAL_MILE:.0f} nm: check the route in "
        "the chart."
        for name, metres in inshore.items()
        if metres > _LEAST
    ]
    if not (along or against or inshore):
        notes.append(
            f"Meets none of the {len(TRAFFIC_SCHEMES)} traffic separation schemes of the package. "
            f"{others}"
        )
    return notes + [
        f"{AGAINST_TRAFFIC} of {name}, or within a quarter of a lane of its separation zone, for "
        f"about {metres / NAUTICAL_MILE:.0f} nm, by an approximate separation line: check the "
        "route in the chart."
        for name, metres in wrong.items()
    ]


def _other_schemes_text(route: Route) -> str:
    """Return a sentence on the schemes along a route that the package does not have."""
    lat, lon, _leg = densify(*_positions(route), _STEP)
    seas = seas_with_other_schemes(lat, lon)
    if not seas:
        return "Others are not known here: look for them in the chart."
    return (
        f"The charts have others in or off {names_in_words(seas)}: keep their lanes by the chart."
    )


def lane_detour_notes(
    chart: Chart, networks: Sequence[Network], route: Route | None = None
) -> list[str]:
    """Return a note where lanes and inshore traffic zones make the shortest way much longer.

    Shortest paths of the networks are compared, with the lanes and without.

    Parameters
    ----------
    chart : With the lanes.
    networks : Of the stretches of a voyage, each with start and goal.
    route : Schemes against which it runs are not named.

    Returns
    -------
    list of str : Empty below 5 nm and 3 %, and for charts with lanes of their own.
    """
    if not _has_schemes(chart):
        return []
    kept = free = 0.0
    own = leg_ends(*_positions(route)) if route is not None else None
    names: dict[str, list[str]] = {}
    for network in networks:
        edges, length = network.edges, network.edges.length
        penalty = np.asarray(edges.penalty_factor, float)
        some = np.flatnonzero(penalty > 1.0)
        tail, head = network.tails()[some], network.graph.target[some]
        ends = network.lat[tail], network.lon[tail], network.lat[head], network.lon[head]
        without = penalty.copy()
        without[some] = np.maximum(penalty[some] - chart.zones.lane_group.excess(*ends), 1.0)
        places = [_shortest(network, length * factor) for factor in (penalty, without)]
        kept += float(np.sum(distance(*leg_ends(*places[0]))))
        free += float(np.sum(distance(*leg_ends(*places[1]))))
        for inshore in (False, True):
            against = {} if own is None else _metres(chart, own, inshore=inshore)
            for name, metres in _metres(chart, leg_ends(*places[1]), inshore=inshore).items():
                if metres > _LEAST >= against.get(name, 0.0):
                    names.setdefault(_KEPT_OUT[inshore], []).append(name)
    longer = kept - free
    if not names or (longer < _LONG_DETOUR and longer < _LARGE_DETOUR * free):
        return []
    return [
        f"{LANE_DETOUR} {_listed(names)} makes the shortest way about "
        f"{longer / NAUTICAL_MILE:.0f} nm ({100.0 * longer / free:.0f} %) longer on the network of "
        "the search: Rule 10 requires ships to keep out, and to cross lanes at right angles. An "
        "inshore traffic zone is open to ships "
        "under 20 m and to voyages from or to a place inside it (Rule 10 (d)). To "
        "compare only, plan with --ignore-lanes; do not sail that route where the chart has the "
        "scheme."
    ]


def _listed(names: Mapping[str, Sequence[str]]) -> str:
    """Return what is kept out of, such as "the opposite lanes of A and B, and of the ... of C"."""
    parts = []
    for what, places in names.items():
        known = list(dict.fromkeys(places))
        parts.append(f"the {what}{'s' if len(known) > 1 else ''} of {names_in_words(known)}")
    return " and ".join(parts)


def routes_within_lanes(
    chart: Chart, routes: list[Route], fastest: Sequence[Route]
) -> tuple[list[Route], list[str]]:
    """Return the routes that run no farther against lanes than fastest ones, and a note.

    Parameters
    ----------
    chart : With lanes, of the package or of the user.
    fastest : Those of each set of canals, which keep the lanes as far as it pays.

    Returns
    -------
    routes : Those with no more than two miles above the most of the fastest, against lanes, and so
        in inshore zones.
    notes : How many were left out; empty where none was.
    """
    if not chart.zones.lanes:
        return routes, []
    most = np.max([_lengths_against(chart, route) for route in fastest], axis=0) + _LEAST
    kept = [route for route in routes if np.all(_lengths_against(chart, route) <= most)]
    if len(kept) == len(routes):
        return routes, []
    return kept, [
        f"{len(routes) - len(kept)} of {len(routes)} ways found are left out: they run against "
        "lanes or through inshore traffic zones, farther than the fastest route by any canals."
    ]


def _lengths_against(chart: Chart, route: Route) -> FloatArray:
    """Return how far a route runs against lanes, and in inshore traffic zones [m]."""
    legs = leg_ends(*_positions(route))
    return np.array([sum(_metres(chart, legs, inshore=one).values()) for one in (False, True)])


def _has_schemes(chart: Chart) -> bool:
    """Return whether all lanes of a chart are those of the package."""
    names = [scheme.name for scheme in TRAFFIC_SCHEMES]
    lanes = chart.zones.lanes
    return bool(lanes) and all(lane.name.partition(",")[0] in names for lane in lanes)


def _shortest(network: Network, weight: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the positions [deg] of the path of least weight; none where there is no path."""
    meta = network.meta
    _, path = shortest_path(network, meta.start, meta.goal, weight=weight, per_metre=1.0)
    return network.lat[path], network.lon[path]


def _positions(route: Route) -> tuple[FloatArray, FloatArray]:
    return np.asarray(route.track.lat, float), np.asarray(route.track.lon, float)


def _metres(
    chart: Chart, legs: tuple[FloatArray, ...], *, inshore: bool = False
) -> dict[str, float]:
    """Return the distance [m] that legs run against each scheme, or in its inshore zones.

    The last 0.1 nm of each area do not count: routes are led along the edges of lanes.
    """
    group = chart.zones.lane_group.without_edges
    length = np.asarray(distance(*legs))
    found: dict[str, float] = {}
    for leg, lane, share in zip(*group.shares_against(*legs)):
        name, _, part = group.lanes[lane].name.partition(", ")
        if (part == INSHORE) != inshore:
            continue
        found[name] = found.get(name, 0.0) + float(share * length[leg])
    return found
