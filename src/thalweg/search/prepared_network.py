"""A network and a frozen sea, prepared for many searches between the same places."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.codes import AXIS_DEPTH, BED_DEPTH, LIMIT_REQUIRED_DEPTH, WATER_LEVEL
from thalweg.kernels.leg.edge_sailing import NetworkArrays, SeaArrays
from thalweg.kernels.leg.point_speed import ShipArrays
from thalweg.kernels.leg.table_lookup import TableArrays, table_value
from thalweg.kernels.search import repeated_search as kernel
from thalweg.kernels.search import tidal_intervals
from thalweg.kernels.search.field_bounds import largest_current
from thalweg.search.search_problem import check_fields_of_network, network_arrays, sea_arrays

if TYPE_CHECKING:
    from thalweg.network.network import Network
    from thalweg.sea.frozen_fields import StationFields


_MOST_DEPTH = 60.0  # deeper than this the greatest speed is that anywhere [m]


@dataclass(frozen=True, eq=False)
class PreparedNetwork:
    """A network and a frozen sea, prepared for many searches.

    Attributes
    ----------
    source : Network
    network : NetworkArrays
        The same as kernels see it.
    sea : SeaArrays
    tails : int32[E]
        Node every edge leaves.
    arriving_ptr, arriving : int64[N + 1], int32[E]
        The edges that arrive at each node.
    """

    source: Network
    network: NetworkArrays
    sea: SeaArrays
    tails: NDArray[np.int32]
    incoming_ptr: IntArray
    incoming_edges: NDArray[np.int32]

    @classmethod
    def prepare(cls, network: Network, fields: StationFields) -> PreparedNetwork:
        """Gather the arrays that searches read.

        Parameters
        ----------
        network : Network
            The network.
        fields : StationFields
            The sea frozen at its stations.

        Returns
        -------
        PreparedNetwork
            For any ship and departure in the period of the fields.

        Raises
        ------
        InputError
            If the fields do not belong to the network.
        """
        check_fields_of_network(network, len(fields.values))
        order = np.argsort(network.graph.target, kind="stable").astype(np.int32)
        ptr = cumulative_sums(np.bincount(network.graph.target, minlength=network.n_nodes))
        sea = sea_arrays(fields, tides=True)
        tails = np.ascontiguousarray(network.tails(), np.int32)
        return cls(network, network_arrays(network), sea, tails, ptr, order)

    @cached_property
    def strongest(self) -> NDArray[np.float32]:
        """Strongest current of every station towards each of sixteen directions [m/s]."""
        found = np.empty((self.sea.values.shape[0], kernel.CURRENT_DIRECTIONS), np.float32)
        kernel.strongest_currents(self.sea, found)
        return found

    @cached_property
    def by_time(self) -> SeaArrays:
        """The same fields with all stations of one time close together in memory.

        A search reads few times at many stations; in the fields of a long period these are so far
        apart that fetching them takes most of its time.
        """
        values = np.ascontiguousarray(self.sea.values.transpose(1, 0, 2))
        return self.sea._replace(values=values.transpose(1, 0, 2))

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
            open_water = np.isnan(self.network.fixed_time)
            sailed = np.where(open_water, self.network.depth, np.float32(-np.inf))
            depth[has_edges] = np.fmax.reduceat(sailed, first)
        return depth

    def tidal_states(
        self, ship: ShipArrays, ends: tuple[int, int], wait: bool
    ) -> tidal_intervals.TidalStates:
        """Return the periods in which a ship may wait at every node; start and goal have one each.

        Parameters
        ----------
        ship : ShipArrays
            With the required depth.
        ends : tuple of int
            Start and goal node.
        wait : bool
            Whether the ship may wait; otherwise every node has one state.

        Returns
        -------
        TidalStates
            For each node one or more periods [s].
        """
        count = len(self.network.can_wait)
        required = float(ship.limits[LIMIT_REQUIRED_DEPTH])
        index = self.sea.channel_index
        varies = index[WATER_LEVEL] >= 0 or index[BED_DEPTH] >= 0
        changing = np.array(self.network.can_wait)
        changing[list(ends)] = False
        counts = np.ones(count, np.int64)
        split = wait and required > -math.inf and varies
        if split:
            tidal_intervals.count_tidal_states(self.sea, self.charted, changing, required, counts)
        ptr = cumulative_sums(counts)
        size = int(ptr[-1])
        states = tidal_intervals.TidalStates(
            ptr, np.empty(size, np.int32), *(np.empty(size) for _ in range(3))
        )
        if not split:
            changing[:] = False
        tidal_intervals.fill_tidal_states(self.sea, self.charted, changing, required, states)
        return states

    def time_bounds(
        self, ship: ShipArrays, goal: int, fastest: float, field: bool
    ) -> kernel.TravelTimeBounds:
        """Return lower bounds of the time to the goal and of every edge.

        Parameters
        ----------
        ship : ShipArrays
            Table and limits.
        goal : int
            Goal node.
        fastest : float
            Greatest speed through water [m/s].
        field : bool
            Whether the speed is a field of place and time.

        Returns
        -------
        TravelTimeBounds
            Times [s] by node and by edge.
        """
        caps = np.full(1, fastest) if field else _speed_caps(ship, fastest)
        times = np.empty(len(self.tails))
        required = float(ship.limits[LIMIT_REQUIRED_DEPTH])
        kernel.least_edge_times(
            self.network, self.tails, self.sea, self.strongest, caps, required, times
        )
        count = len(self.network.can_wait)
        to_goal = np.empty(count)
        memory = np.empty(count, np.int32), np.empty(count), np.full(count, -1, np.int32)
        kernel.least_times_to_goal(
            self.incoming_ptr, self.incoming_edges, self.tails, times, goal, to_goal, memory
        )
        return kernel.TravelTimeBounds(to_goal, times)


def _speed_caps(ship: ShipArrays, fastest: float) -> FloatArray:
    """Return the greatest speed through water by depth [m/s], see
    `thalweg.kernels.search.repeated_search`.
    """
    if ship.needs != 1 << AXIS_DEPTH:
        return np.full(1, fastest)
    table = ship.table
    grids = [
        table.axis_start[part, 0]
        + np.arange(table.axis_size[part, 0]) / table.axis_inv_step[part, 0]
        for part in range(len(table.part_axes))
        if table.part_axes[part, 0] == AXIS_DEPTH
    ]
    depth = np.unique(
        np.concatenate([*grids, np.arange(0.0, _MOST_DEPTH, kernel.SPEED_CAP_DEPTH_STEP)])
    )
    speed = np.array([_known_speed(table, d, ship.setting) for d in depth])
    most = np.minimum(np.maximum.accumulate(speed), fastest)
    up_to = kernel.SPEED_CAP_DEPTH_STEP * (
        1.0 + np.arange(int(_MOST_DEPTH / kernel.SPEED_CAP_DEPTH_STEP))
    )
    at = np.minimum(np.searchsorted(depth, up_to), len(depth) - 1)
    return np.append(most[at], fastest)


def _known_speed(table: TableArrays, depth: float, setting: int) -> float:
    speed, ok = table_value(table, (0.0, 0.0, 0.0, 0.0, 0.0, float(depth)), setting)
    return float(speed) if ok else 0.0
