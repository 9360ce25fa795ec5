"""What a plan tells besides its routes: warnings, and all that is needed to repeat it."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np

from thalweg.core.geodesy import format_position
from thalweg.core.time import format_time
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.route import Route
from thalweg.sea.inspection import data_gaps

#: The coarse depth of the world is looked at only this far off the coast [m] ...
_MIN_SHORE_DISTANCE = 15_000.0
#: ... and doubted when it leaves less than this under the keel [m].
_MIN_PLAUSIBLE_CLEARANCE = 10.0
#: Poleward of this [deg] ice is mentioned.
_ICE_WARNING_LATITUDE = 72.0


def route_warnings(context: PlanningContext, route: Route) -> list[str]:
    """Return the warnings about a route that no limit looks at."""
    notes = ice_warnings(route) + data_gap_warnings(context, route)
    if not math.isfinite(context.needs.limits[codes.LIMIT_REQUIRED_DEPTH]):
        notes += shallow_water_warnings(context, route)
    return notes


def shallow_water_warnings(context: PlanningContext, route: Route) -> list[str]:
    """Warn where the embedded coarse depth of the world looks shallow, well off the coast."""
    lat, lon = route.samples["lat"][::4], route.samples["lon"][::4]
    depth = np.asarray(context.chart.coarse_depth_at(lat, lon))
    offshore = (
        np.asarray(context.chart.shore_distance(lat, lon, cap=_MIN_SHORE_DISTANCE))
        >= _MIN_SHORE_DISTANCE
    )
    doubtful = offshore & (depth < float(context.ship.draught) + _MIN_PLAUSIBLE_CLEARANCE)
    if not doubtful.any():
        return []
    worst = int(np.argmin(np.where(doubtful, depth, np.inf)))
    return [
        f"The coarse depth of the world shows {max(float(depth[worst]), 0.0):.0f} m near "
        f"{format_position(float(lat[worst]), float(lon[worst]))}: check the chart there."
    ]


def data_gap_warnings(context: PlanningContext, route: Route) -> list[str]:
    """Warn where files tell nothing for a part of the voyage: the ship cannot sail by them then."""
    if not math.isfinite(route.arrive):
        return []
    return [
        f"{gap.source} tells nothing from {format_time(gap.after)} to {format_time(gap.before)}: "
        "what it alone holds is not known then, and no leg is sailed on it."
        for gap in data_gaps(context.sea)
        if gap.before > route.depart and gap.after < route.arrive
    ]


def ice_warnings(route: Route) -> list[str]:
    """Warn where ice is likely, which no limit looks at."""
    lat = route.samples["lat"]
    worst = int(np.argmax(np.abs(lat)))
    if abs(float(lat[worst])) < _ICE_WARNING_LATITUDE:
        return []
    place = format_position(float(lat[worst]), float(route.samples["lon"][worst]))
    return [
        f"The route comes as far as {place} and sea ice is not considered: give a via point or a "
        "no-go zone if that water is closed."
    ]


def provenance(
    context: PlanningContext,
    ends: list[Endpoint],
    networks: list[dict[str, Any]],
    speeds_kn: list[float | None],
) -> dict[str, Any]:
    """Return all that is needed to repeat a plan, as plain data."""
    from importlib.metadata import version

    table_error = dataclasses.asdict(context.table.error)
    return {
        "thalweg": version("thalweg"),
        "from": ends[0].name,
        "to": ends[-1].name,
        "via": [end.name for end in ends[1:-1]],
        "ship": {
            "name": context.ship.name,
            "fingerprint": context.ship.fingerprint(),
            "speed_kn": speeds_kn[0] if len(speeds_kn) == 1 else speeds_kn,
            "draught_m": float(context.ship.draught),
            "table_error": {k: finite_or_none(v) for k, v in table_error.items()},
        },
        "sea": context.sea.provenance() | {"fingerprint": context.sea.fingerprint()},
        "chart": context.chart.fingerprint(),
        "networks": networks,
        "seed": context.voyage.seed,
    }


def network_summary(
    network: Network, *, settled: int, depart: float, way: str = ""
) -> dict[str, Any]:
    """Return what is told of a network that was searched."""
    facts = {
        "kind": network.meta.kind,
        "nodes": int(network.n_nodes),
        "edges": int(network.n_edges),
        "spacing_m": network.meta.spacing_m,
        "directions": network.meta.directions,
        "settled": settled,
        "depart": format_time(depart),
    }
    return facts | ({"way": way} if way else {})


def finite_or_none(value: float) -> float | None:
    """Return a number, or None where it is not one."""
    return value if math.isfinite(value) else None
