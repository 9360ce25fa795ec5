"""`plan`: the one place that wires the rooms together."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np

from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.geodesy import format_position
from thalweg.core.time import format_time
from thalweg.core.units import KNOT
from thalweg.kernels import codes
from thalweg.planning.door import check_kinds, covered_ends
from thalweg.planning.ends import End, check_apart, find_end
from thalweg.planning.needs import check_period, find_needs
from thalweg.planning.networks import Builder, NetworkChoice
from thalweg.planning.passage import Passage, Task, make_passage, table_of
from thalweg.planning.plan import Plan, Proof, Surroundings, in_unit
from thalweg.planning.voyage import Voyage
from thalweg.route import Route, with_wind_speed
from thalweg.route import join as join_routes
from thalweg.sea import Sea
from thalweg.ship import Ship

#: The coarse depth of the world is looked at only this far off the coast [m] ...
_OFFSHORE = 15_000.0
#: ... and doubted when it leaves less than this under the keel [m].
_DOUBTFUL = 10.0
#: Poleward of this [deg] ice is mentioned.
_POLAR = 72.0


def plan(
    voyage: Voyage,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    network: str | Builder = "auto",
    resolution: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> Plan:
    """Plan a voyage: exact search on a network, refinement in open water, score by the referee.

    Parameters
    ----------
    voyage : Voyage
        What is asked.
    ship : Ship
        The ship, with its limits.
    sea : Sea
        Currents, levels, wind and waves. Never assumed: ask for `Sea.calm` if there is none.
    chart : Chart, optional
        Land, depth and zones; GSHHG coastline at resolution "i" when not given.
    network : {"auto", "lattice", "mesh"} or callable
        How the network is built; see `thalweg.planning.networks.NetworkChoice`.
    resolution : float, optional
        Spacing of the network [m]; chosen from the distance when not given.
    progress : callable, optional
        Called with a short text at each stage.

    Returns
    -------
    Plan
        The best route, its proof and its provenance.

    Raises
    ------
    InputError
        For places on land, unknown ports, settings the ship does not have.
    CoverageError
        If the data lack a variable, the area or the period.
    NoRouteError
        If no route exists within the limits (with the reasons counted).
    """
    chart = Chart.gshhg("i") if chart is None else chart
    check_kinds(voyage, ship, sea, chart)
    sea = with_wind_speed(ship, sea)
    choice = NetworkChoice(network, resolution)
    ends = _ends(voyage, chart)
    needs = find_needs(voyage, ship=ship, sea=sea, chart=chart)
    last = check_period(voyage, sea, needs)
    world = {"ship": ship, "sea": sea, "chart": chart}
    ends = covered_ends(ends, voyage=voyage, needs=needs, last=last, **world)  # type: ignore[arg-type]
    task = Task(
        voyage=voyage,
        ship=ship,
        sea=sea,
        chart=chart,
        needs=needs,
        table=table_of(ship),
        setting=_setting(voyage, ship),
        last=last,
        choice=choice,
        tell=progress or (lambda text: None),
    )
    passages = _make_passages(task, ends)
    return _gather(task, ends, passages)


def _ends(voyage: Voyage, chart: Chart) -> list[End]:
    places = [("start", voyage.start)]
    places += [(f"via point {i + 1}", place) for i, place in enumerate(voyage.via)]
    places.append(("goal", voyage.goal))
    ends = [find_end(place, chart, what) for what, place in places]
    for first, second in itertools.pairwise(ends):
        check_apart(first, second)
    return ends


def _setting(voyage: Voyage, ship: Ship) -> int:
    speeds = np.asarray(ship.speeds)
    if voyage.speed_kn is None:
        return len(speeds) - 1
    misses = np.abs(speeds / KNOT - voyage.speed_kn)
    best = int(np.argmin(misses))
    if misses[best] > 0.05:
        listed = ", ".join(f"{speed / KNOT:.1f}" for speed in speeds)
        raise InputError(
            f"The ship {ship.name!r} has no setting for {voyage.speed_kn:g} kn.",
            f"Its speeds are {listed} kn.",
            "Choose one of them.",
            field="speed_kn",
        )
    return best


def _make_passages(task: Task, ends: list[End]) -> list[Passage]:
    window = (task.voyage.earliest_departure, task.voyage.latest_departure)
    passages: list[Passage] = []
    for start, goal in itertools.pairwise(ends):
        passage = make_passage(task, start, goal, window)
        passages.append(passage)
        window = (passage.route.arrive, passage.route.arrive)
    return passages


def _gather(task: Task, ends: list[End], passages: list[Passage]) -> Plan:
    voyage = task.voyage
    routes = [passage.route for passage in passages]
    route = routes[0] if len(routes) == 1 else join_routes(routes)
    refused: Counter[str] = Counter()
    for passage in passages:
        refused.update(passage.network.meta.rejected)
        refused.update(passage.result.refused)
    total = sum(passage.result.cost for passage in passages)
    bound = sum(passage.bound.value for passage in passages)
    proof = Proof(
        lower_bound=in_unit(bound, voyage.objective),
        kind=passages[0].bound.kind,
        certain=in_unit(sum(passage.floor.value for passage in passages), voyage.objective),
        solver_total=in_unit(total, voyage.objective),
    )
    notes = [end.note for end in ends if end.note] + list(task.needs.notes)
    notes += [note for passage in passages for note in passage.notes]
    notes += _ice_notes(route)
    if not math.isfinite(task.needs.limits[codes.LIMIT_REQUIRED_DEPTH]):
        notes += _shallow_notes(task, route)
    return Plan(
        voyage=voyage,
        routes=(route,),
        proof=proof,
        rejections={reason: count for reason, count in refused.items() if count},
        notes=tuple(dict.fromkeys(notes)),
        provenance=_provenance(task, ends, passages),
        surroundings=_surroundings(task, passages),
    )


def _shallow_notes(task: Task, route: Route) -> list[str]:
    """Warn where the embedded coarse depth of the world looks shallow, well off the coast."""
    lat, lon = route.samples["lat"][::4], route.samples["lon"][::4]
    depth = np.asarray(task.chart.warning_depth_at(lat, lon))
    offshore = np.asarray(task.chart.shore_distance(lat, lon, cap=_OFFSHORE)) >= _OFFSHORE
    doubtful = offshore & (depth < float(task.ship.draught) + _DOUBTFUL)
    if not doubtful.any():
        return []
    worst = int(np.argmin(np.where(doubtful, depth, np.inf)))
    return [
        f"The coarse depth of the world shows {max(float(depth[worst]), 0.0):.0f} m near "
        f"{format_position(float(lat[worst]), float(lon[worst]))}: check the chart there."
    ]


def _ice_notes(route: Route) -> list[str]:
    """Warn where ice is likely, which no limit looks at."""
    lat = route.samples["lat"]
    worst = int(np.argmax(np.abs(lat)))
    if abs(float(lat[worst])) < _POLAR:
        return []
    place = format_position(float(lat[worst]), float(route.samples["lon"][worst]))
    return [
        f"The route comes as far as {place} and sea ice is not considered: give a via point or a "
        "no-go zone if that water is closed."
    ]


def _surroundings(task: Task, passages: list[Passage]) -> Surroundings:
    nodes = [passage.network.n_nodes for passage in passages]
    return Surroundings(
        lat=np.concatenate([p.network.station_lat[:n] for p, n in zip(passages, nodes)]),
        lon=np.concatenate([p.network.station_lon[:n] for p, n in zip(passages, nodes)]),
        arrival=np.concatenate([p.isochrones[:n] for p, n in zip(passages, nodes)]),
        chart=task.chart,
        sea=task.sea,
        ship=task.ship,
    )


def _provenance(task: Task, ends: list[End], passages: list[Passage]) -> dict[str, Any]:
    from importlib.metadata import version

    table_error = dataclasses.asdict(task.table.error)
    return {
        "thalweg": version("thalweg"),
        "from": ends[0].name,
        "to": ends[-1].name,
        "via": [end.name for end in ends[1:-1]],
        "ship": {
            "name": task.ship.name,
            "fingerprint": task.ship.fingerprint(),
            "speed_kn": _known(float(task.ship.speeds[task.setting]) / KNOT),
            "draught_m": float(task.ship.draught),
            "table_error": {k: _known(v) for k, v in table_error.items()},
        },
        "sea": task.sea.provenance() | {"fingerprint": task.sea.fingerprint()},
        "chart": task.chart.fingerprint(),
        "networks": [
            {
                "kind": p.network.meta.kind,
                "nodes": int(p.network.n_nodes),
                "edges": len(p.network.target),
                "spacing_m": p.network.meta.spacing_m,
                "directions": p.network.meta.directions,
                "settled": int(p.result.settled),
                "depart": format_time(p.route.depart),
            }
            for p in passages
        ],
        "seed": task.voyage.seed,
    }


def _known(value: float) -> float | None:
    return value if math.isfinite(value) else None
