"""Plans that trade time for fuel, cost or emissions: exact front, refinement, referee."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.geodesy import FloatArray, distance, inverse
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.kernels.compilation import warm_up
from thalweg.network import Network, shortest
from thalweg.planning.frozen_sea import Frozen, freeze
from thalweg.planning.interrupt_guard import Keeper, Stopped
from thalweg.planning.network_selection.route_alternatives import Way
from thalweg.planning.pareto.objective import Criterion, Rate
from thalweg.planning.request.voyage_endpoints import End
from thalweg.planning.single.no_route_diagnosis import no_route, too_late
from thalweg.planning.single.passage import Task, isochrones, refined, track_of
from thalweg.route import Route, Track
from thalweg.sea import StationFields
from thalweg.search import Front, SearchResult, direction_factor, earliest_arrival, front

#: How much longer than in still water the slowest ship worth looking at may take ...
_PATIENCE = 1.25
#: ... how much longer than the cheapest constant setting that was sailed ...
_SPARE = 1.1
#: ... and how much longer than in still water it is looked for, step by step.
_LONGEST, _GROWTH = 30.0, 1.6
_TWO_TIDES = 25 * HOUR
#: How much longer the sea is frozen, so that edges left last can be sailed to their end.
_MORE = 0.05
#: A turn [rad] that is none: by it a leg of 100 km is a metre off at its middle at most.
_STRAIGHT = 2e-5
#: Into how many bins the time of a front is divided; refinement makes up for what they miss.
_BINS = 300


@dataclass(frozen=True)
class Explored:
    """What came of one way round.

    Attributes
    ----------
    way : Way
    frozen : Frozen
    fastest : Route
        The fastest route, refined and refereed.
    first : SearchResult
        The fastest way on the network.
    exact : Front or None
        The exact front of the network; None where its search was stopped.
    isochrones : ndarray
        Earliest arrival at every node [s since 1970]; inf where never reached.
    factor : float
        How much shorter than the network's way the way in open water may be.
    """

    way: Way
    frozen: Frozen
    fastest: Route
    first: SearchResult
    exact: Front | None
    isochrones: np.ndarray
    factor: float


@dataclass(frozen=True)
class Means:
    """What all ways round are explored with."""

    task: Task
    criterion: Criterion
    rate: Rate
    ends: tuple[End, ...]
    settings: np.ndarray
    limits: np.ndarray
    keeper: Keeper
    notes: list[str] = field(default_factory=list)  # for the plan, as they come up

    @property
    def via(self) -> tuple[End, ...]:
        """The places between the first end and the last."""
        return self.ends[1:-1]


@dataclass(frozen=True)
class Ahead:
    """The sea over a network for as long as a front needs it.

    Attributes
    ----------
    frozen : Frozen
    first : SearchResult
        The fastest way; not found where there is none in that time.
    setting : int
        That of this way: the highest there is a way with.
    latest : float
        Latest arrival of the front [s since 1970].
    """

    frozen: Frozen
    first: SearchResult
    setting: int
    latest: float


@dataclass(frozen=True)
class Candidate:
    """A track with what the solver says of it.

    Attributes
    ----------
    track : Track
    stage : str
        Where it comes from.
    way : str
        The way round.
    time : float
        [s].
    value : float
        [unit of the criterion].
    """

    track: Track
    stage: str
    way: str
    time: float
    value: float


def explore(means: Means, way: Way) -> Explored:
    """Search the fastest route and the exact front of one way round.

    Raises
    ------
    NoRouteError
        If there is no way in time, with the earliest arrival when there is one.
    """
    task = means.task
    depart = task.voyage.earliest_departure
    task.tell(f"freezing the sea: {way.name}")
    ahead = look_ahead(means, way.network)
    frozen, first, latest = ahead.frozen, ahead.first, ahead.latest
    task.tell(f"searching: {way.name}")
    if not first.found:
        raise no_route(
            way.network,
            first,
            (means.ends[0], means.ends[-1]),
            depart=depart,
            last=task.last,
            fields=frozen.stations,
            required=float(means.limits[codes.LIMIT_REQUIRED_DEPTH]),
        )
    if first.arrive > task.latest:
        raise too_late(task.latest, first.arrive)
    fastest = refined(task, track_of(way.network, first, ahead.setting), means.limits)
    means.keeper.begin()
    task.tell(f"searching the front: {way.name}")
    try:
        exact = network_front(means, way.network, frozen, latest)
    except Stopped:
        exact = None
    until = first.arrive + 0.5 * first.duration
    arrival = isochrones(task, way.network, frozen, depart, until)
    return Explored(way, frozen, fastest, first, exact, arrival, _factor(means, way, frozen))


def network_front(
    means: Means, network: Network, frozen: Frozen, latest: float, *, lower: bool = True
) -> Front:
    """Search the exact front of a network.

    Raises
    ------
    Stopped
        If Ctrl-C is pressed before there is a front.
    """
    task = means.task
    share_of_labels = 0.5 if lower else 1.0

    def progress(share: float) -> None:
        if share < share_of_labels and means.keeper.stopped():
            raise Stopped

    depart = task.voyage.earliest_departure
    dues = network.fee if means.criterion.name == "cost" else np.zeros(network.n_edges)
    return front(
        replace(network, fee=dues),
        frozen.stations,
        task.table,
        means.rate.table,
        start=network.meta.start,
        goal=network.meta.goal,
        depart=depart,
        limits=means.limits,
        latest=latest,
        settings=means.settings,
        weight=means.criterion.weights(network, task.chart),
        time_price=means.criterion.time_price,
        waiting_fuel=means.rate.waiting,
        waiting_weight=means.criterion.outside,
        wait=task.voyage.wait,
        bin_s=(latest - depart) / _BINS,
        top_speed=frozen.top_speed,
        lower=lower,
        progress=progress,
    )


def _factor(means: Means, way: Way, frozen: Frozen) -> float:
    """Return the factor of directions for the slowest setting in the strongest current."""
    slowest = float(np.min(np.asarray(means.task.ship.speeds)[means.settings]))
    ratio = strongest_current(frozen.stations) / slowest if slowest > 0.0 else 1.0
    return direction_factor(way.network.meta.gap_rad, ratio)


def fastest_allowed(means: Means, network: Network, frozen: Frozen) -> tuple[SearchResult, int]:
    """Search the fastest way at the highest setting with which there is one; return both.

    A lower setting may keep what is forbidden in waves where the highest does not.
    """
    table = means.task.table.kernel_arrays()
    heeds = table.safety.size > 0 or table.motions.size > 0
    tried = means.settings[::-1] if heeds else means.settings[-1:]
    ways = ((fastest_way(means, network, frozen, int(one)), int(one)) for one in tried)
    first = next(ways)
    return first if first[0].found else next((way for way in ways if way[0].found), first)


def fastest_way(means: Means, network: Network, frozen: Frozen, setting: int) -> SearchResult:
    """Search the fastest way over a network at one setting."""
    task = means.task
    return earliest_arrival(
        network,
        frozen.stations,
        task.table,
        start=network.meta.start,
        goal=network.meta.goal,
        depart=task.voyage.earliest_departure,
        setting=setting,
        limits=means.limits,
        wait=task.voyage.wait,
        top_speed=frozen.top_speed,
    )


def look_ahead(means: Means, network: Network) -> Ahead:
    """Freeze the sea over a network as long as its front needs it, and search the fastest way.

    Without a latest arrival that is until the slowest ship worth looking at has arrived. How long
    it takes is guessed by its speed in still water first; where currents or weather make it
    slower, the period grows until the cheapest constant setting has been sailed to the end.

    Raises
    ------
    InputError
        If the sea over the shortest period takes more memory than is allowed.
    """
    task, depart = means.task, means.task.voyage.earliest_departure
    asked = math.isfinite(task.latest)
    tides = math.isfinite(task.needs.limits[codes.LIMIT_REQUIRED_DEPTH])
    length = shortest_length(network)
    if math.isinf(length):  # no way: the sea is frozen as for a straight one
        ends = means.ends[0], means.ends[-1]
        length = float(distance(ends[0].lat, ends[0].lon, ends[1].lat, ends[1].lon))
    still = length / float(task.ship.speeds[economical(means)])
    slow = depart + _PATIENCE * still + (_TWO_TIDES if tides else 0.0)
    final = min(task.last, depart + _LONGEST * still + _TWO_TIDES)
    latest = min(task.latest, task.last) if asked else min(slow, final)
    ahead: Ahead | None = None
    while True:
        until = latest if asked else min(latest + _MORE * (latest - depart), final)
        until = max(until, min(slow, final))
        try:
            frozen = freeze(task, network, depart, until)
        except InputError:
            if ahead is None:
                raise
            return ahead  # what fits into the memory
        warm_up.finish()
        first, setting = fastest_allowed(means, network, frozen)
        ahead = Ahead(frozen, first, setting, latest)
        need = first.arrive if asked else _slow_arrival(means, network, frozen, until)
        if need <= until or until >= final:
            return ahead
        slow = depart + _GROWTH * (until - depart) if math.isinf(need) else need
        latest = latest if asked else min(slow, final)


def _slow_arrival(means: Means, network: Network, frozen: Frozen, until: float) -> float:
    """Return until when a front is worth looking for: later than its cheapest constant setting.

    Infinite while a setting that has not arrived when the frozen sea ends may still be cheaper.
    """
    depart = means.task.voyage.earliest_departure

    def duration(setting: int) -> float:
        return fastest_way(means, network, frozen, setting).arrive - depart

    late = _SPARE * duration(economical(means))
    if depart + late <= until:
        return depart + late
    rates = spending(means)
    time = np.array([duration(int(setting)) for setting in means.settings])
    cost = rates * np.minimum(time, until - depart)  # of what has not arrived: so much at least
    return depart + _SPARE * float(time[np.argmin(cost)])


def shortest_length(network: Network) -> float:
    """Return the length of the shortest way over a network [m]; inf if there is none."""
    meta = network.meta
    return float(shortest(network, meta.start, meta.goal)[0][meta.goal])


def economical(means: Means) -> int:
    """Return the setting that makes a mile cheapest in still water."""
    cost = spending(means) / np.asarray(means.task.ship.speeds)[means.settings]
    return int(means.settings[np.argmin(cost)])


def spending(means: Means) -> FloatArray:
    """Return what a second at each of the settings costs in still water; infinite if unknown."""
    rate = means.criterion.outside * means.rate.still[means.settings] + means.criterion.time_price
    return np.where(np.isfinite(rate), rate, np.inf)


def track_of_point(network: Network, point: Any) -> Track:
    """Turn a point of an exact front into a track."""
    path = np.asarray(point.path)
    wait = np.maximum(0.0, np.asarray(point.path_depart) - np.asarray(point.path_arrive))
    wait[-1] = 0.0
    wait = np.where(wait < 1.0, 0.0, wait)
    setting = np.asarray(point.setting)
    lat, lon = network.station_lat[path], network.station_lon[path]
    kept = np.flatnonzero(_corners(lat, lon, setting, wait))
    return Track(lat[kept], lon[kept], float(point.path_arrive[0]), wait[kept], setting[kept[:-1]])


def _corners(lat: FloatArray, lon: FloatArray, setting: Any, wait: FloatArray) -> Any:
    """Return which points of a path are needed: it turns, waits or changes its speed there."""
    keep = np.ones(len(lat), bool)
    _, course, back = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
    turn = np.angle(np.exp(1j * (course[1:] - back[:-1])))
    same = (np.abs(turn) < _STRAIGHT) & (setting[1:] == setting[:-1]) & (wait[1:-1] == 0.0)
    keep[1:-1] = ~same
    return keep


def spread(time: FloatArray, value: FloatArray, count: int) -> np.ndarray:
    """Return indices of at most ``count`` points of a front: its ends, and evenly between."""
    order = np.argsort(time, kind="stable")
    if len(order) <= count:
        return order
    x = (time[order] - time[order[0]]) / max(float(np.ptp(time)), 1e-12)
    y = (value[order] - value.min()) / max(float(np.ptp(value)), 1e-12)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    wanted = np.linspace(0.0, along[-1], count)
    picked = np.unique(np.abs(along[None, :] - wanted[:, None]).argmin(axis=1))
    return np.asarray(order[picked])


def not_dominated(time: FloatArray, value: FloatArray) -> list[int]:
    """Return the indices of what is not dominated, by ascending time."""
    kept: list[int] = []
    least = math.inf
    for index in np.lexsort((value, time)):
        if value[index] * (1.0 + 1e-9) < least:
            kept.append(int(index))
            least = float(value[index])
    return kept


def strongest_current(stations: StationFields) -> float:
    """Return the strongest current [m/s] in frozen fields; 0 where there is none."""
    east, north = (stations.channel_index[c] for c in (codes.CURRENT_EAST, codes.CURRENT_NORTH))
    if east < 0 or north < 0:
        return 0.0
    squared = stations.values[:, :, east] ** 2 + stations.values[:, :, north] ** 2
    return math.sqrt(float(np.nanmax(squared, initial=0.0)))
