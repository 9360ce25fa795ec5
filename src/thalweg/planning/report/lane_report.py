"""What a plan states about the traffic separation schemes of the package."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.chart.zones.traffic_schemes import INSHORE, TRAFFIC_SCHEMES
from thalweg.core.geodesy import distance
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.planning_context import PlanningContext
from thalweg.route import Route

_LEAST: Final = 2.0 * NAUTICAL_MILE  # shorter stretches in a scheme are crossings


def lane_notes(context: PlanningContext, route: Route) -> list[str]:
    """Return through which schemes a route leads, and where it runs against their traffic.

    Parameters
    ----------
    context : Request, data and ship of the plan.

    Returns
    -------
    list of str : Empty where the route meets none, and for charts with lanes of their own.
    """
    names = [scheme.name for scheme in TRAFFIC_SCHEMES]
    lanes = context.chart.zones.lanes
    if not lanes or not all(lane.name.partition(",")[0] in names for lane in lanes):
        return []
    lat, lon = np.asarray(route.track.lat, float), np.asarray(route.track.lon, float)
    legs = lat[:-1], lon[:-1], lat[1:], lon[1:]
    against = _miles(context, legs)
    along = _miles(context, (*legs[2:], *legs[:2]))
    inshore = _miles(context, legs, inshore=True)
    kept = [name for name in names if along.get(name, 0.0) > max(_LEAST, against.get(name, 0.0))]
    notes = []
    if kept:
        notes.append(
            f"Keeps to starboard of the separation lines of {', '.join(kept)}: these are "
            "approximate and not charted; lay the route off in the lanes of the chart. Schemes "
            f"other than the {len(names)} of the package are not known here."
        )
    notes += [
        f"Uses the inshore traffic zone of {name} for about {metres / NAUTICAL_MILE:.0f} nm: check "
        "the route in the chart."
        for name, metres in inshore.items()
        if metres > _LEAST
    ]
    return notes + [
        f"Runs against the traffic of {name} for about {metres / NAUTICAL_MILE:.0f} nm, by an "
        "approximate separation line: check the route in the chart."
        for name, metres in against.items()
        if metres > _LEAST
    ]


def _miles(
    context: PlanningContext, legs: tuple[FloatArray, ...], *, inshore: bool = False
) -> dict[str, float]:
    """Return the distance [m] that legs run against each scheme, or in its inshore zones."""
    group = context.chart.zones.lane_group
    length = np.asarray(distance(*legs))
    found: dict[str, float] = {}
    for leg, lane, share in zip(*group.shares_against(*legs)):
        name, _, part = group.lanes[lane].name.partition(", ")
        if (part == INSHORE) != inshore:
            continue
        found[name] = found.get(name, 0.0) + float(share * length[leg])
    return found
