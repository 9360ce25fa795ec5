"""The problem of a front: network, sea, a ship with settings, and prices."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.limits import Limits
from thalweg.core.objective import FUEL_MASS, LegPrices
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.codes import (
    AXIS_COUNT,
    AXIS_DEPTH,
    CHANNEL_COUNT,
    SPEED_FIELD,
)
from thalweg.kernels.leg.point_speed import ShipArrays
from thalweg.kernels.leg.table_lookup import TableArrays, axes_needed, table_value
from thalweg.kernels.pareto.edge_tables import (
    EdgePrices,
    FrontArrays,
    MultiSettingShip,
)
from thalweg.kernels.search.label_setting import (
    SearchQuery,
    label_setting,
    new_labels,
    new_search_workspace,
)
from thalweg.search.search_problem import (
    ROUNDING_FACTOR,
    SearchProblem,
    ShipOnNetwork,
    contiguous_array,
    make_search_problem,
    ship_arrays,
)
from thalweg.search.tidal_states import tidal_states
from thalweg.ship.tables.table_bounds import table_bounds

if TYPE_CHECKING:
    from thalweg.network.network import Network
    from thalweg.sea.frozen_fields import StationFields
    from thalweg.ship.tables.performance_table import PerformanceTable


@dataclass(frozen=True, eq=False)
class MultiSettingShipOnNetwork:
    """A ship with a choice of settings, on a network, in the sea frozen at its stations.

    Attributes
    ----------
    network : Network
        Edges of fixed time (canals) cost their fee and the fuel of that time in still water at the
        slowest setting that is fast enough.
    fields : StationFields
        The sea, frozen at the network's stations.
    table, fuel : PerformanceTable or TableArrays
        Speed through water [m/s] and fuel rate [kg/s] with the same settings.
    limits : Limits
        Limits along the route (`thalweg.core.limits.Limits`).
    top_speed : float, optional
        Upper bound of the speed through water [m/s] (default: of the table).
    """

    network: Network
    fields: StationFields
    table: PerformanceTable | TableArrays
    fuel: PerformanceTable | TableArrays
    limits: Limits
    top_speed: float | None = None


@dataclass(frozen=True, eq=False)
class FrontQuery:
    """A query of `thalweg.search.pareto_front` on a network.

    Attributes
    ----------
    start, goal : int
        Nodes.
    depart, latest : float
        Time at the start and latest arrival [s since epoch].
    settings : sequence of int, optional
        Settings to choose from on every edge (default: all). The highest is taken to be the
        fastest in all conditions.
    prices : LegPrices, optional
        Prices of fuel, time, waiting and canal dues (default: 1 per kilogram of fuel).
    eca_fraction : array_like (E,), optional
        Fraction of each edge inside emission control areas, 0 to 1 (default: 0); see
        `thalweg.network.eca_fractions`.
    edge_cost : array_like (E,), optional
        Further cost of each edge, at any setting and time, zero or more (default: 0).
    penalty_factor : array_like (E,), optional
        Factor on the cost of the consumption on each edge, one or more (default: 1).
    wait : bool
        Whether the ship may wait at nodes that allow it, as long as it stays afloat.
    """

    start: int
    goal: int
    depart: float
    latest: float
    settings: Sequence[int] | NDArray[np.int64] | None = None
    prices: LegPrices = FUEL_MASS
    eca_fraction: ArrayLike | None = None
    edge_cost: ArrayLike | None = None
    penalty_factor: ArrayLike | None = None
    wait: bool = True


class FrontRequest(NamedTuple):
    """A `FrontQuery` that has been checked, with its settings and the fuel price of each edge."""

    start: int
    goal: int
    depart: float
    latest: float
    settings: IntArray
    prices: LegPrices
    edge_price: FloatArray
    wait: bool
    edge_cost: FloatArray | float = 0.0

    @property
    def horizon(self) -> float:
        """Time from departure to the latest arrival [s]."""
        return self.latest - self.depart


class FrontProblem(NamedTuple):
    """The arrays of a search of a front, with bounds.

    Attributes
    ----------
    arrays : For the kernels.
    given : For the search of the earliest arrival, at the highest setting.
    whole : The same with one state for each node.
    origin : int64[E]
        Edge of the network that each edge of ``arrays`` comes from.
    tails : int64[E]
        State that each edge leaves.
    fastest, least_rate : float64[S]
        Greatest speed through water [m/s] and least fuel rate [kg/s] of each setting.
    """

    arrays: FrontArrays
    given: SearchProblem
    whole: SearchProblem
    origin: IntArray
    tails: IntArray
    fastest: FloatArray
    least_rate: FloatArray


def make_front_problem(
    ship_on_network: MultiSettingShipOnNetwork, request: FrontRequest
) -> FrontProblem:
    """Gather the arrays that a front is searched with."""
    network, limits = ship_on_network.network, ship_on_network.limits
    highest, top_speed = int(request.settings[-1]), ship_on_network.top_speed
    ship = ship_arrays(ship_on_network.table, highest, limits)
    burning = ship_arrays(ship_on_network.fuel, highest, limits).table
    if burning.n_settings != ship.table.n_settings:
        raise InputError(
            f"The fuel table has {burning.n_settings} settings, the table of speeds "
            f"{ship.table.n_settings}.",
            "The two are tables of one ship.",
            "Make them with tabulate and tabulate_fuel of the same ship.",
        )
    fastest = table_bounds(ship.table, np.fmax)[request.settings]
    least_rate = np.maximum(table_bounds(burning, np.fmin)[request.settings], 0.0)
    top = float(np.nanmax(fastest)) if top_speed is None else float(top_speed)
    whole = make_search_problem(
        ShipOnNetwork(network, ship_on_network.fields, ship_on_network.table, highest, limits, top)
    )
    given, origin = _with_states(whole, request, limits.required_depth)
    factor = np.ones_like(whole.network.factor)
    whole = whole._replace(network=whole.network._replace(factor=factor))
    if given.sea.channel_index[SPEED_FIELD] >= 0:
        fastest = np.full(len(fastest), given.top_speed)
    net = given.network
    priced = MultiSettingShip(
        ship.table, burning, contiguous_array(request.settings, np.int64), ship.limits, ship.needs,
        int(axes_needed(burning)),
    )  # fmt: skip
    prices = _prices(network, origin, priced, request)
    tails = np.repeat(np.arange(len(net.station)), np.diff(net.indptr))
    arrays = FrontArrays(net, given.sea, priced, prices, request.depart)
    return FrontProblem(arrays, given, whole, origin, tails, fastest, least_rate)


def _with_states(
    given: SearchProblem, request: FrontRequest, required_depth: float
) -> tuple[SearchProblem, IntArray]:
    """Split nodes that fall dry into states; return where each edge comes from as well."""
    net = given.network
    numbered = net._replace(factor=np.arange(len(net.target), dtype=np.float64))
    if request.wait:
        keep = request.start, request.goal
        numbered = tidal_states(numbered, given.sea, required_depth, keep)
    origin = numbered.factor.astype(np.int64)
    net = numbered._replace(factor=np.ones(len(origin), np.float32))
    return given._replace(network=net), origin


def _prices(
    network: Network, origin: IntArray, ship: MultiSettingShip, request: FrontRequest
) -> EdgePrices:
    fixed_time = np.asarray(network.edges.fixed_time)
    fee = request.prices.dues * np.asarray(network.edges.fee, float) + request.edge_cost
    fuel, choice = np.zeros(len(origin)), np.zeros(len(origin), np.int64)
    fixed = fixed_time[origin]
    if not np.isnan(fixed).all():
        speeds, rates = still_water_values(ship.table, ship), still_water_values(ship.fuel, ship)
        for e in np.flatnonzero(~np.isnan(fixed)):
            enough = np.flatnonzero(speeds >= network.edges.length[origin[e]] / fixed[e])
            choice[e] = enough[0] if len(enough) else int(np.nanargmax(speeds))
            fuel[e] = rates[choice[e]] * fixed[e]
    return EdgePrices(
        weight=np.ascontiguousarray(request.edge_price[origin], float),
        fee=np.ascontiguousarray(fee[origin], float),
        fixed_time=np.ascontiguousarray(fixed, float),
        fixed_fuel=fuel,
        fixed_choice=choice,
        time_price=request.prices.time,
        waiting_cost_rate=request.prices.time + request.prices.waiting,
    )


def still_water_values(table: TableArrays, ship: MultiSettingShip) -> FloatArray:
    """Return the values of a table in still, deep water, by chosen setting."""
    where = np.zeros(AXIS_COUNT)
    for axes, start, step, size in zip(
        table.part_axes, table.axis_start, table.axis_inv_step, table.axis_size
    ):
        for k in np.flatnonzero(axes >= 0):
            last = start[k] + (size[k] - 1) / step[k]
            deep = last if axes[k] == AXIS_DEPTH else 0.0
            where[axes[k]] = min(max(where[axes[k]], start[k], deep), last)
    at = tuple(float(x) for x in where)
    found = [table_value(table, at, int(setting)) for setting in ship.settings]
    return np.array([value if ok else math.nan for value, ok in found])


class EarliestArrivals(NamedTuple):
    """Earliest arrivals at one setting, with the tree they came by."""

    time: FloatArray
    before: NDArray[np.int32]
    departed: FloatArray
    refused: NDArray[np.int64]


def ship_at_setting(ship: ShipArrays, setting: int) -> ShipArrays:
    """Return a ship at another of its settings."""
    return ship._replace(setting=int(setting))


def without_wave_limits(ship: ShipArrays) -> ShipArrays:
    """Return a ship without limits in waves; it is never slower than the ship itself."""
    none = np.empty(0), np.empty((0, 0, 0), np.float32), np.empty((0, 0))
    table = ship.table._replace(safety=none[0], motions=none[1], motion_grid=none[2])
    return ship._replace(table=table, needs=int(axes_needed(table)))


def earliest_arrivals(
    front_problem: FrontProblem, request: FrontRequest, *, everywhere: bool, choice: int = -1
) -> EarliestArrivals:
    """Search the earliest arrival at every state at one of the chosen settings.

    ``everywhere`` lets the ship wait at any and pass what is forbidden in waves: at the highest
    setting no choice of settings is sooner.
    """
    given = front_problem.given
    net, ship = given.network, ship_at_setting(given.ship, int(request.settings[choice]))
    if everywhere:
        net, ship = net._replace(can_wait=np.ones_like(net.can_wait)), without_wave_limits(ship)
    count = len(net.station)
    query = SearchQuery(
        start=request.start,
        goal=-1,
        depart=request.depart,
        horizon=request.latest if everywhere else math.inf,
        by_distance=False,
        wait=everywhere or request.wait,
        slowness=ROUNDING_FACTOR / given.fastest,
        per_metre=0.0,
    )
    labels, memory = new_labels(count), new_search_workspace(count)
    label_setting(net, given.sea, ship, query, np.zeros(count), labels, memory)
    time = np.where(labels.settled, labels.time, math.inf)
    return EarliestArrivals(time, labels.before, labels.departed, memory.refused)


def new_edge_workspace() -> FloatArray:
    """Return work space for sailing edges."""
    return np.full((4, CHANNEL_COUNT), np.nan)
