"""`run_project`: simulation of a dredging project, with checks of the sites before it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from thalweg.core.errors import InputError, NoRouteError, OutsidePeriodError
from thalweg.core.geodesy import Position, format_position
from thalweg.core.time import format_time
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.operations.dredging.cycle_records import DredgingCycle
from thalweg.operations.dredging.cycle_simulation import CycleCallback, Simulator
from thalweg.operations.dredging.load_sequence import cycles_of_least_time
from thalweg.operations.dredging.project import BEST_LOAD_FACTOR, Project
from thalweg.operations.dredging.project_environment import (
    LINE,
    MessageCallback,
    ProjectEnvironment,
    SiteNetwork,
    fixed_route_network,
    freeze_site_network,
    project_network,
)
from thalweg.operations.dredging.project_result import ProjectResult, ProjectRun, summarise_run
from thalweg.planning.request.coverage_check import check_argument_types
from thalweg.planning.voyage import Voyage

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.network import Network
    from thalweg.sea import Sea
    from thalweg.ship import Ship

OPTIMISED, BASE_CASE = "optimised", "base case"
_MUCH_WAITING = 0.15  # share of the time from which the loads of all cycles are chosen together
_FEW_CYCLES = 20  # for which they are chosen together, too
_MAX_BISECTIONS = 24  # of a depth; accurate to a millimetre
_MAX_DEPTH = 200.0  # [m]

_NO_FUEL = "Fuel, energy and CO2 are not known: the ship file has no fuel."


class _Watch(NamedTuple):
    """What is called while a project is simulated."""

    report: MessageCallback
    on_cycle: CycleCallback | None


def run_project(
    project: Project,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart,
    progress: Callable[[str], None] | None = None,
    on_cycle: CycleCallback | None = None,
) -> ProjectResult:
    """Simulate a project to its end, in each cycle with the load and routes that produce most.

    Parameters
    ----------
    project : Project
    ship : Ship
        Draught and speed depend on its load.
    sea : Sea
        For the whole period of the project. If it has a mesh, that is the network.
    chart : Chart
        Land, zones and depth.
    progress : callable, optional
        Called with a short text at each stage.
    on_cycle : callable, optional
        Called with the name of the run and each `DredgingCycle` of it.

    Returns
    -------
    ProjectResult
        With the base case, if the project has one and it is finished within the period: a note
        states why it is missing.

    Raises
    ------
    InputError
        If a site is dry or on land, the hopper exceeds the capacity of the ship, or the sea at the
        network takes too much memory.
    NoRouteError
        If there is no route at any tide for any load; states the highest water and missing depth.
    OutsidePeriodError
        If the volume is not moved by the end of the project's period in the optimised run.

    Notes
    -----
    The production of a cycle is its volume divided by the time from the start of loading until the
    ship is back at the loading site. For every load factor the legs out and back are searched
    exactly on the network (`thalweg.search.profile_search`), and the load with the highest
    production is taken, as in van Halem (2019), section 3.2.1. The choice is greedy: the effect on
    later cycles is ignored. In projects of 20 cycles or fewer, and where the ship waits more than
    15 % of the time, the loads of all cycles are chosen together (`load_sequence`), and a note says
    how much earlier they end. Where
    the base case takes less time in all, its load on the best routes is tried, and the base case
    itself is the answer if that takes longer too; a note says so. The referee then evaluates every
    leg in small steps; its times are those of the project.
    """
    report: MessageCallback = progress or (lambda text: None)
    voyage = Voyage(start=project.sites.load, goal=project.sites.unload, depart=project.start)
    check_argument_types(voyage, ship, sea, chart)
    _check_hopper(project.work.hopper, ship)
    period = (project.start, project.end)
    environment = ProjectEnvironment.open(project.sites, period, ship=ship, sea=sea, chart=chart)
    check_sites(environment)
    report("building the network")
    site_network = freeze_site_network(environment, project_network(environment), report)
    factors = project.work.load_factors
    watch = _Watch(report, on_cycle)
    optimised = _simulate_run(
        project, environment, site_network, factors, name=OPTIMISED, watch=watch
    )
    base = None
    if project.base is not None:
        given = project.base.load_factor
        line = freeze_site_network(
            environment, fixed_route_network(chart, project.base.route), report
        )
        chosen = factors if given == BEST_LOAD_FACTOR else (float(given),)
        try:
            base = _simulate_run(project, environment, line, chosen, name=BASE_CASE, watch=watch)
        except OutsidePeriodError as error:  # the optimised run is a result without it
            note = f"Without the base case: {error.asked} {error.possible}"
            optimised = replace(optimised, notes=(*optimised.notes, note))
        else:
            if base.feasible and _takes_longer(optimised, base):
                optimised = _no_slower_run(project, environment, site_network, optimised, base)
    has_fuel = optimised.totals["fuel_t"] is not None
    origin = _provenance(environment, site_network, has_fuel=has_fuel)
    return ProjectResult(project, environment, optimised, base, origin)


def _no_slower_run(
    project: Project,
    environment: ProjectEnvironment,
    site_network: SiteNetwork,
    greedy: ProjectRun,
    base: ProjectRun,
) -> ProjectRun:
    """Return a run that takes no longer than the base case, where the greedy choice does.

    The load of the base case is sailed on the network; if that takes longer too, the base case is
    the answer.
    """
    loads = {cycle.load_factor for cycle in base.cycles}
    found: ProjectRun | None = None
    if project.base is not None and project.base.load_factor != BEST_LOAD_FACTOR:
        with contextlib.suppress(OutsidePeriodError, NoRouteError):
            found = _simulate_run(
                project, environment, site_network, (float(project.base.load_factor),),
                name=OPTIMISED, watch=_Watch(lambda text: None, None),
            )  # fmt: skip
    why = (
        "the load of greatest production, chosen cycle by cycle without those that follow, takes "
        f"{_cycles_and_days(greedy)} in all, the base case {_cycles_and_days(base)}"
    )
    if found is None or _takes_longer(found, base):
        note = f"The loads and routes are those of the base case: {why}."
        return replace(base, name=OPTIMISED, notes=(*base.notes, note))
    note = f"Every cycle has the load of the base case, {max(loads):g}, where it is full: {why}."
    return replace(found, notes=(*found.notes, note))


def _cycles_and_days(run: ProjectRun) -> str:
    return f"{run.totals['cycles']} cycles and {run.totals['duration_days']:.2f} days"


def _takes_longer(run: ProjectRun, other: ProjectRun) -> bool:
    """Return whether a run produces less than another, of the same volume."""
    return run.cycles[-1].end > other.cycles[-1].end


def _simulate_run(
    project: Project,
    environment: ProjectEnvironment,
    site_network: SiteNetwork,
    factors: tuple[float, ...],
    *,
    name: str,
    watch: _Watch,
) -> ProjectRun:
    watch.report(f"{name}: preparing {len(factors)} loads")
    simulator = Simulator(
        project, environment, site_network, factors=factors, report=watch.report,
        on_cycle=watch.on_cycle, name=name,
    )  # fmt: skip
    possible = simulator.possible
    if not possible:
        raise no_path_error(environment, site_network, min(x for x in factors if x > 0.0), name)
    notes: tuple[str, ...] = ()
    impassable = [x for x in factors if x > max(possible)]
    if impassable:
        notes = (f"Load factors above {max(possible):g} have no route at any tide.",)
    cycles = simulator.run()
    together_counts = _waiting_share(cycles) > _MUCH_WAITING or len(cycles) <= _FEW_CYCLES
    if len(factors) > 1 and together_counts:
        together = cycles_of_least_time(simulator, cycles, report=watch.report)
        if together[-1].end < cycles[-1].end:
            hours = (cycles[-1].end - together[-1].end) / HOUR
            notes += (
                f"The loads ({name}) are those of the whole project that end it first: "
                f"{hours:.1f} h earlier than with the load of greatest production in each cycle.",
            )
            cycles = together
    return summarise_run(
        name, cycles, project=project, ship=environment.ship, required=environment.min_ukc,
        notes=notes,
    )  # fmt: skip


def _waiting_share(cycles: Sequence[DredgingCycle]) -> float:
    """Return the share of the time of cycles in which the ship waits."""
    return sum(cycle.waiting for cycle in cycles) / (cycles[-1].end - cycles[0].start)


def _check_hopper(hopper: float, ship: Ship) -> None:
    capacity = ship.loading.capacity
    if hopper > capacity * (1.0 + 1e-9):  # False if the capacity is NaN (unknown)
        raise InputError(
            f"hopper_m3 is {hopper:g}.",
            f"The ship {ship.name!r} holds {capacity:g} m3 at load factor 1.",
            "Correct one of them: loading.capacity_m3 of the ship, or hopper_m3.",
            field="hopper_m3",
        )


def check_sites(environment: ProjectEnvironment) -> None:
    """Raise `InputError` for sites on land, or too shallow for the empty ship at every tide."""
    sites, chart = environment.sites, environment.chart
    for what, place in (("loading", sites.load), ("unloading", sites.unload)):
        if not bool(np.all(chart.is_navigable(np.array([place[0]]), np.array([place[1]])))):
            raise InputError(
                f"The {what} site {format_position(*place)} is on land or in a no-go zone.",
                "A site must be navigable water on the chart.",
                "Move it.",
                field=what,
            )
        _check_depth(environment, what, place)


def _check_depth(environment: ProjectEnvironment, what: str, place: Position) -> None:
    empty = environment.loaded(0.0).required_depth
    if not math.isfinite(empty):
        return
    times, depth = _depth_at(environment, place)
    if not np.isfinite(depth).any():
        raise InputError(
            f"The depth at the {what} site {format_position(*place)} is not known.",
            "The chart or the sea must provide the depth at both sites.",
            "Move it into the area of the data.",
            field=what,
        )
    best = int(np.nanargmax(depth))
    if depth[best] < empty:
        raise InputError(
            f"The {what} site {format_position(*place)} is too shallow at every tide.",
            f"The water is deepest {format_time(float(times[best]))}: {depth[best]:.2f} m, "
            f"{empty - depth[best]:.2f} m less than the empty ship needs ({empty:.2f} m).",
            "Move the site into deeper water.",
            field=what,
            missing_m=float(empty - depth[best]),
        )


def _depth_at(environment: ProjectEnvironment, place: Position) -> tuple[np.ndarray, np.ndarray]:
    """Return (times, water depth [m]) at a place over the period."""
    from thalweg.sea import standard_names as nm

    (start, end), sea = environment.period, environment.sea
    times = sea.times(start, end)
    times = times[(times >= start) & (times <= end)]
    depth = np.full(times.shape, np.inf)
    if environment.chart.has_depth:
        depth = np.minimum(depth, np.asarray(environment.chart.depths.at(*place), float))
    channels = [n for n in (nm.BED_DEPTH, nm.WATER_LEVEL) if n in sea.variables]
    lat, lon = np.full(times.shape, place[0]), np.full(times.shape, place[1])
    samples = sea.sample(channels, times, lat, lon) if channels else {}
    if nm.BED_DEPTH in samples:
        depth = np.minimum(depth, samples[nm.BED_DEPTH])
    return times, depth + samples.get(nm.WATER_LEVEL, 0.0)


def no_path_error(
    environment: ProjectEnvironment, site_network: SiteNetwork, load_factor: float, name: str
) -> NoRouteError:
    """Return the error for a project without a route at any tide for its lightest load.

    It states the shallowest place that every route must pass, when the water is highest there, and
    the missing depth.
    """
    loaded = environment.loaded(load_factor)
    required = loaded.required_depth
    open_to = _passable_depth(site_network, loaded) if math.isfinite(required) else -math.inf
    summary = f"There is no route at any tide with load factor {load_factor:g} ({name})."
    if not math.isfinite(open_to):
        unknown = (
            _first_unknown_depth(site_network.network)
            if site_network.network.meta.kind == LINE
            else None
        )
        if unknown is not None:
            return NoRouteError(
                summary,
                f"The depth of the water on its route at {format_position(*unknown)} is not known.",
                "Correct base_case.route, or give data that cover it.",
                nearest=unknown,
            )
        return NoRouteError(
            summary,
            "The sites are not connected by water of known depth.",
            "Check the chart, the data and the detour.",
        )
    place, when = _bottleneck(site_network, open_to)
    return NoRouteError(
        summary,
        f"The best route is {required - open_to:.2f} m too shallow: at {format_position(*place)} "
        f"the water is highest {format_time(when)}, {open_to:.2f} m deep, and the ship needs "
        f"{required:.2f} m.",
        "Load less, require less clearance, or choose another site.",
        missing_m=required - open_to,
        highest=format_time(when),
        nearest=place,
    )


def _passable_depth(site_network: SiteNetwork, loaded: Any) -> float:
    """Return the greatest least depth of all routes at their highest tides [m]."""
    low, high = -_MAX_DEPTH, _MAX_DEPTH
    limits = loaded.limits

    def passable(depth: float) -> bool:
        tried = limits.with_required_depth(depth)
        return site_network.profile_search(loaded, full=True, limits=tried).shortest < math.inf

    if not passable(low):
        return -math.inf
    for _ in range(_MAX_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passable(middle) else (low, middle)
    return low


def _first_unknown_depth(network: Network) -> Position | None:
    """Return the start of the first edge of unknown depth, counted from the loading site."""
    unknown = np.flatnonzero(np.isnan(network.edges.depth))
    if not len(unknown):
        return None
    node = int(np.minimum(network.tails(), network.graph.target)[unknown].min())
    return float(network.lat[node]), float(network.lon[node])


def _bottleneck(site_network: SiteNetwork, depth: float) -> tuple[Position, float]:
    """Return the shallowest node of the best route, and the time of its highest water."""
    waters, network = site_network.waters, site_network.network
    sea = waters.sea
    charted = network.edges.depth + sea.highest[network.graph.target]
    best = np.minimum(charted, sea.deepest[network.graph.target])
    edge = int(np.nanargmin(np.abs(best - depth)))
    node = int(network.graph.target[edge])
    column = sea.channel_index[codes.WATER_LEVEL]
    level = sea.values[node, :, column] if column >= 0 else np.zeros(len(sea.times))
    when = float(sea.times[int(np.nanargmax(level))])
    return (float(network.lat[node]), float(network.lon[node])), when


def _provenance(
    environment: ProjectEnvironment, site_network: SiteNetwork, *, has_fuel: bool
) -> dict[str, Any]:
    from importlib.metadata import version

    network = site_network.network
    return {
        "thalweg": version("thalweg"),
        "ship": {"name": environment.ship.name, "fingerprint": environment.ship.fingerprint()},
        "sea": environment.sea.provenance() | {"fingerprint": environment.sea.fingerprint()},
        "chart": environment.chart.fingerprint(),
        "network": {
            "kind": network.meta.kind,
            "nodes": int(network.n_nodes),
            "edges": int(network.n_edges),
            "rings": environment.sites.network.rings,
        },
        "assumptions": [*environment.needs.notes, *([] if has_fuel else [_NO_FUEL])],
    }
