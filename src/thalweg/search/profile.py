"""Profile search: the routes between two places for every departure of a long period.

A project sails between the same two places hundreds of times. What does not depend on the departure
is prepared once: the network and the frozen sea as kernels see them and the strongest currents
(`Waters`), then for each ship the bounds of the time to go and the times afloat (`Passages`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.kernels import profile as kernel
from thalweg.kernels.codes import AXIS_DEPTH, BED_DEPTH, LIMIT_REQUIRED_DEPTH, WATER_LEVEL
from thalweg.kernels.edges import NetworkArrays, SeaArrays, ShipArrays
from thalweg.kernels.extremes import largest_current, largest_speed_field
from thalweg.kernels.tables import TableArrays, table_value
from thalweg.search.arrays import SHRINK, network_arrays, sea_arrays, ship_arrays

if TYPE_CHECKING:
    from thalweg.network.network import Network
    from thalweg.sea.fields import StationFields
    from thalweg.ship.table import PerformanceTable

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_MOST_DEPTH = 60.0  # deeper than this the greatest speed is that anywhere [m]
_SPARE = 1e-3  # an arrival this much above a known one is still looked at [s]
_FIRST_SLACK = 3600.0  # beyond the bound, when nothing is known yet [s]
_WINDOW = 7200.0  # windows of the fields begin at multiples of this [s] ...
_KEPT = 6  # ... and so many are kept
_SAME = 0.25  # arrivals closer than this are one tide's opening (found to 0.1 s) [s]


@dataclass(frozen=True, eq=False)
class Passage:
    """One departure and the way it sails.

    Attributes
    ----------
    depart, arrive : float
        [s]; ``arrive`` is inf when the goal is not reached.
    nodes : int64[P]
        From start to goal; empty when not reached.
    node_arrive, node_depart : float64[P]
        Arrival at and departure from each node [s]; a later departure is waiting.
    settled : int
        Nodes settled to find it.
    """

    depart: float
    arrive: float
    nodes: IntArray
    node_arrive: FloatArray
    node_depart: FloatArray
    settled: int = 0

    @property
    def found(self) -> bool:
        """Whether the goal is reached."""
        return len(self.nodes) > 0

    @property
    def waiting(self) -> float:
        """Time lain still [s]."""
        return float(np.sum(self.node_depart - self.node_arrive))


@dataclass(frozen=True, eq=False)
class Profile:
    """The passages of many departures.

    Attributes
    ----------
    passages : tuple of Passage
        By departure, ascending.
    searched : int
        How many of them were searched; the others wait for the next one of these and sail with it.
    """

    passages: tuple[Passage, ...]
    searched: int

    @property
    def departures(self) -> FloatArray:
        """Departures [s]."""
        return np.array([p.depart for p in self.passages])

    @property
    def arrivals(self) -> FloatArray:
        """Earliest arrivals [s]; inf where there is none."""
        return np.array([p.arrive for p in self.passages])


@dataclass(frozen=True, eq=False)
class Waters:
    """A network and a frozen sea, prepared for many searches.

    Attributes
    ----------
    network : NetworkArrays
    sea : SeaArrays
    tails : int32[E]
        Node every edge leaves.
    arriving_ptr, arriving : int64[N + 1], int32[E]
        The edges that arrive at each node.
    """

    network: NetworkArrays
    sea: SeaArrays
    tails: NDArray[np.int32]
    arriving_ptr: IntArray
    arriving: NDArray[np.int32]

    @classmethod
    def prepare(cls, network: Network, fields: StationFields) -> Waters:
        """Gather what searches read.

        Raises
        ------
        InputError
            If the fields do not belong to the network.
        """
        stations = len(network.station_lat)
        if fields.values.shape[0] != stations:
            raise InputError(
                f"The fields have {fields.values.shape[0]} stations, the network {stations}.",
                "Fields belong to the network they were frozen for.",
                "Freeze the sea at the stations of this network.",
            )
        order = np.argsort(network.target, kind="stable").astype(np.int32)
        ptr = np.concatenate(
            [[0], np.cumsum(np.bincount(network.target, minlength=network.n_nodes))]
        )
        sea = sea_arrays(fields, tides=True)
        tails = np.ascontiguousarray(network.tails(), np.int32)
        return cls(network_arrays(network), sea, tails, ptr.astype(np.int64), order)

    @cached_property
    def strongest(self) -> NDArray[np.float32]:
        """Strongest current of every station towards each of sixteen directions [m/s]."""
        found = np.empty((self.sea.values.shape[0], kernel.SECTORS), np.float32)
        kernel.strongest_currents(self.sea, found)
        return found

    @cached_property
    def _windows(self) -> tuple[Lock, dict[tuple[int, int], SeaArrays]]:
        return Lock(), {}

    def window(self, depart: float, last: float) -> SeaArrays:
        """Return the fields around some times, close together in memory.

        A search reads few times at many stations; in the fields of a long period these lie so far
        apart that fetching them takes most of its time.
        """
        times = self.sea.times
        first = int(np.searchsorted(times, depart - depart % _WINDOW, side="right")) - 1
        first = max(first, 0)
        hours = 4 * _WINDOW
        while times[first] + hours < last:
            hours *= 2.0
        end = min(int(np.searchsorted(times, times[first] + hours)) + 2, len(times))
        lock, windows = self._windows
        with lock:
            found = windows.pop((first, end), None)
            if found is None:
                values = np.ascontiguousarray(self.sea.values[:, first:end])
                found = self.sea._replace(times=times[first:end].copy(), values=values)
                while len(windows) >= _KEPT:
                    windows.pop(next(iter(windows)))
            windows[first, end] = found
            return found

    @cached_property
    def top_current(self) -> float:
        """Largest current anywhere [m/s]."""
        return float(largest_current(self.sea))

    @cached_property
    def charted(self) -> NDArray[np.float32]:
        """Charted depth of every node [m]: that of the deepest edge that leaves it."""
        depth = np.full(len(self.network.can_wait), -np.inf, np.float32)
        has_edges = np.diff(self.network.indptr) > 0
        if has_edges.any():
            first = self.network.indptr[:-1][has_edges]
            depth[has_edges] = np.fmax.reduceat(self.network.depth, first)
        return depth

    def passages(
        self,
        table: PerformanceTable | TableArrays,
        *,
        start: int,
        goal: int,
        setting: int,
        limits: ArrayLike,
        top_speed: float,
        wait: bool = True,
    ) -> Passages:
        """Prepare the passages of a ship between two nodes; arguments as in `earliest_arrival`."""
        count = len(self.network.can_wait)
        if not (0 <= start < count and 0 <= goal < count and start != goal):
            raise InputError(
                f"There are no passages from node {start} to node {goal}.",
                f"The network has nodes 0 to {count - 1}, and the two differ.",
                "",
            )
        ship = ship_arrays(table, setting, limits)
        field_top = largest_speed_field(self.sea)
        fastest = field_top if field_top >= 0.0 else float(top_speed)
        if not (np.isfinite(fastest) and fastest > 0.0):
            raise InputError(
                f"A ship with a top speed of {fastest} m/s gets nowhere.",
                "A speed is a positive number.",
                "Check the ship's speeds.",
            )
        states = self._states(ship, (start, goal), wait)
        ahead = self._ahead(ship, goal, fastest, field_top >= 0.0)
        slowness = SHRINK / (fastest + self.top_current)
        return Passages(self, ship, states, ahead, (start, goal), slowness, wait)

    def _states(self, ship: ShipArrays, ends: tuple[int, int], wait: bool) -> kernel.States:
        """Return the times afloat of every node; start and goal stay single."""
        count = len(self.network.can_wait)
        required = float(ship.limits[LIMIT_REQUIRED_DEPTH])
        index = self.sea.channel_index
        varies = index[WATER_LEVEL] >= 0 or index[BED_DEPTH] >= 0
        changing = np.array(self.network.can_wait)
        changing[list(ends)] = False
        counts = np.ones(count, np.int64)
        split = wait and required > -math.inf and varies
        if split:
            kernel.count_afloat(self.sea, self.charted, changing, required, counts)
        ptr = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        size = int(ptr[-1])
        states = kernel.States(ptr, np.empty(size, np.int32), *(np.empty(size) for _ in range(3)))
        if not split:
            changing[:] = False
        kernel.fill_afloat(self.sea, self.charted, changing, required, states)
        return states

    def _ahead(self, ship: ShipArrays, goal: int, fastest: float, field: bool) -> kernel.Ahead:
        """Return lower bounds of the time to the goal and of every edge [s]."""
        caps = np.full(1, fastest) if field else _speed_caps(ship, fastest)
        times = np.empty(len(self.tails))
        required = float(ship.limits[LIMIT_REQUIRED_DEPTH])
        kernel.least_times(
            self.network, self.tails, self.sea, self.strongest, caps, required, times
        )
        count = len(self.network.can_wait)
        ahead = np.empty(count)
        memory = np.empty(count, np.int32), np.empty(count), np.full(count, -1, np.int32)
        kernel.backward_bounds(
            self.arriving_ptr, self.arriving, self.tails, times, goal, ahead, memory
        )
        return kernel.Ahead(ahead, times)


def _speed_caps(ship: ShipArrays, fastest: float) -> FloatArray:
    """Return the greatest speed through water by depth [m/s], see `thalweg.kernels.profile`."""
    if ship.needs != 1 << AXIS_DEPTH:
        return np.full(1, fastest)
    table = ship.table
    grids = [
        table.axis_start[part, 0]
        + np.arange(table.axis_size[part, 0]) / table.axis_inv_step[part, 0]
        for part in range(len(table.part_axes))
        if table.part_axes[part, 0] == AXIS_DEPTH
    ]
    depth = np.unique(np.concatenate([*grids, np.arange(0.0, _MOST_DEPTH, kernel.CAP_STEP)]))
    speed = np.array([_known_speed(table, d, ship.setting) for d in depth])
    most = np.minimum(np.maximum.accumulate(speed), fastest)
    up_to = kernel.CAP_STEP * (1.0 + np.arange(int(_MOST_DEPTH / kernel.CAP_STEP)))
    at = np.minimum(np.searchsorted(depth, up_to), len(depth) - 1)
    return np.append(most[at], fastest)


def _known_speed(table: TableArrays, depth: float, setting: int) -> float:
    speed, ok = table_value(table, (0.0, 0.0, 0.0, 0.0, 0.0, float(depth)), setting)
    return float(speed) if ok else 0.0


@dataclass(frozen=True, eq=False)
class Passages:
    """All passages of one ship between two nodes, searched when they are asked for.

    Attributes
    ----------
    waters : Waters
    ship : ShipArrays
    states : States
        Times afloat of every node.
    ahead : Ahead
        Lower bounds of the time to go.
    ends : tuple of int
        Start and goal.
    slowness : float
        Lower bound of the time per metre [s/m].
    wait : bool
        Whether the ship may wait.
    """

    waters: Waters
    ship: ShipArrays
    states: kernel.States
    ahead: kernel.Ahead
    ends: tuple[int, int]
    slowness: float
    wait: bool

    @property
    def shortest(self) -> float:
        """Lower bound of the time of any passage [s]; inf if no tide ever opens a way."""
        return float(self.ahead.node[self.ends[0]])

    @cached_property
    def _network(self) -> NetworkArrays:
        given = self.waters.network
        return given._replace(opens=np.array(given.opens), closes=np.array(given.closes))

    @cached_property
    def _marks(self) -> kernel.Marks:
        return kernel.new_marks(len(self.states.node))

    @cached_property
    def _room(self) -> tuple[NDArray[np.int32], FloatArray, FloatArray]:
        count = len(self.states.node)
        return np.empty(count, np.int32), np.empty(count), np.empty(count)

    def sail(
        self, depart: float, *, known: float = math.inf, arrive_by: float = math.inf
    ) -> Passage:
        """Find the earliest arrival of one departure.

        Parameters
        ----------
        depart : float
            [s].
        known : float
            An arrival that is known to be possible, or a guess [s]; it saves work.
        arrive_by : float
            Later arrivals are of no use [s].

        Returns
        -------
        Passage
            The same as that of `earliest_arrival`, to within ties.
        """
        depart = float(depart)
        last = min(float(arrive_by), float(self.waters.sea.times[-1]))
        longest = last - depart
        if not (math.isfinite(depart) and self.shortest <= longest):
            return _nothing(depart)
        limit = known - depart + _SPARE if known < math.inf else 1.6 * self.shortest + _FIRST_SLACK
        while True:
            found = self._search(depart, min(limit, longest))
            if found.found or limit >= longest:
                return found
            limit = max(2.0 * limit, 1.6 * self.shortest + _FIRST_SLACK)

    def _search(self, depart: float, limit: float) -> Passage:
        first = self.states.ptr
        start, goal = int(first[self.ends[0]]), int(first[self.ends[1]])
        trip = kernel.Trip(start, goal, depart, float(limit), self.slowness, bool(self.wait))
        marks, sea = self._marks, self.waters.window(depart, depart + limit)
        cost = kernel.sail_once(self._network, self.states, sea, self.ship, trip, self.ahead, marks)
        settled = int(marks.counts[kernel.SETTLED])
        if cost == math.inf:
            kernel.forget(marks)
            return replace(_nothing(depart), settled=settled)
        nodes, arrive, leave = self._room
        count = kernel.trace(self.states, marks, trip, nodes, arrive, leave)
        kernel.forget(marks)
        path, when, out = nodes[-count:], arrive[-count:].copy(), leave[-count:].copy()
        return Passage(depart, float(when[-1]), path.astype(np.int64), when, out, settled)

    def profile(self, departures: ArrayLike, *, arrive_by: float = math.inf) -> Profile:
        """Find the passages of many departures.

        Parameters
        ----------
        departures : array_like
            [s], ascending.
        arrive_by : float
            Later arrivals are of no use [s].

        Returns
        -------
        Profile

        Notes
        -----
        Where a ship may wait at the start, arrivals never fall with the departure. So the last
        departure's arrival bounds that of those before it, and between two departures that arrive
        together all arrive together: these wait at the start and sail with the later one.
        """
        times = np.asarray(departures, float).ravel()
        if times.size == 0 or not np.all(np.isfinite(times)) or np.any(np.diff(times) <= 0.0):
            raise InputError("The departures do not ascend.", "Times in order [s].", "Sort them.")
        found: dict[int, Passage] = {}
        waits = self.wait and bool(self.waters.network.can_wait[self.ends[0]])
        if waits:
            self._halve(times, found, arrive_by)
        else:
            for k, t in enumerate(times):
                found[k] = self.sail(t, arrive_by=arrive_by)
        searched = len(found)
        following = len(times) - 1
        for k in range(len(times) - 1, -1, -1):
            if k in found:
                following = k
            else:
                found[k] = _sooner(found[following], float(times[k]))
        return Profile(tuple(found[k] for k in range(len(times))), searched)

    def _halve(self, times: FloatArray, found: dict[int, Passage], arrive_by: float) -> None:
        last = len(times) - 1
        found[last] = self.sail(times[last], arrive_by=arrive_by)
        found.setdefault(0, self.sail(times[0], arrive_by=arrive_by))
        open_ranges = [(0, last)] if last > 0 else []
        while open_ranges:
            low, high = open_ranges.pop()
            if high - low < 2 or _together(found[low], found[high]):
                continue
            middle = (low + high) // 2
            later = found[high]
            known = (
                later.arrive if later.arrive - times[middle] < _worth_knowing(self) else math.inf
            )
            found[middle] = self.sail(times[middle], known=known, arrive_by=arrive_by)
            open_ranges += [(low, middle), (middle, high)]


def _worth_knowing(passages: Passages) -> float:
    """Return how long a passage may take for its arrival to bound an earlier one [s]."""
    return 3.0 * passages.shortest + _FIRST_SLACK


def _together(first: Passage, second: Passage) -> bool:
    """Whether two departures arrive at one moment, or the first not at all."""
    if not first.found:
        return True  # who leaves later does not arrive either
    return second.found and abs(second.arrive - first.arrive) <= _SAME


def _sooner(passage: Passage, depart: float) -> Passage:
    """Return a passage whose ship waits at the start since an earlier moment."""
    if not passage.found:
        return replace(passage, depart=depart, settled=0)
    arrive = passage.node_arrive.copy()
    arrive[0] = depart
    return replace(passage, depart=depart, node_arrive=arrive, settled=0)


def _nothing(depart: float) -> Passage:
    none = np.empty(0)
    return Passage(depart, math.inf, np.empty(0, np.int64), none, none)
