"""Tables of edges by time of departure: arrival, fuel and cost at every setting."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import (
    CURRENT,
    DEPTH,
    LIMIT_REQUIRED_DEPTH,
    OK,
    OUTSIDE_PERIOD,
    SHIP_RANGE,
    WAVE_HEIGHT,
    WIND_SPEED,
)
from thalweg.kernels.compilation.decorators import allocation_free, inlined, kernel_only
from thalweg.kernels.leg.edge_sailing import (
    NetworkArrays,
    SeaArrays,
    course_vector,
    interval_of,
    march_edge,
    pass_canal,
    sample_station,
)
from thalweg.kernels.leg.point_speed import FuelTable, ShipArrays
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.kernels.search.field_bounds import never_deep_enough

# States of a block of an edge table: not filled yet; filled; some edge is closed at some setting,
# but may open; some edge is so at all settings.
UNFILLED, FILLED, SOME_CLOSED, ALL_CLOSED = 0, 1, 2, 3


class MultiSettingShip(NamedTuple):
    """A ship with a choice of settings.

    Attributes
    ----------
    table, fuel : TableArrays
        Speed through water [m/s]; fuel rate [kg/s].
    settings : int64[S]
        The settings of the tables to choose from.
    limits : float64[LIMITS]
    needs, fuel_needs : Axes of the two tables (`thalweg.kernels.leg.table_lookup.axes_needed`).
    """

    table: TableArrays
    fuel: TableArrays
    settings: np.ndarray
    limits: np.ndarray
    needs: int
    fuel_needs: int


class EdgePrices(NamedTuple):
    """What edges and time cost.

    Attributes
    ----------
    weight : float64[E]
        Cost of a kilogram of fuel.
    fee : float64[E]
        Cost of the edge in addition to fuel.
    fixed_time : float64[E]
        Duration of edges that do not depend on the sea [s]; NaN where sailed.
    fixed_fuel : float64[E]
        Fuel of such an edge [kg].
    fixed_choice : int64[E]
        Which of the chosen settings such an edge is passed with; the others are not offered.
    time_price : Cost of a second, under way or not.
    waiting_cost_rate : Cost of a second of waiting, ``time_price`` included.
    """

    weight: np.ndarray
    fee: np.ndarray
    fixed_time: np.ndarray
    fixed_fuel: np.ndarray
    fixed_choice: np.ndarray
    time_price: float
    waiting_cost_rate: float


class EdgeTables(NamedTuple):
    """Durations and costs of all edges that leave a node, by time of departure.

    The block of node n and its i-th slice holds, for every edge in order, the durations [s] at
    all settings and then the costs. NaN: closed then, but may open; inf: not useful.

    Attributes
    ----------
    times : float64[K]
        The slices [s after departure], ascending.
    first, count : int64[N]
        First slice of a node and how many it has.
    place : int64[N]
        Number of the node's first block in ``state``.
    offset : int64[N]
        Where the values of the node's first block start.
    state : uint8[:]
        `UNFILLED`, `FILLED`, `SOME_CLOSED` or `ALL_CLOSED`, for each block.
    values : float32[:]
    refused : int64[COUNT]
        How many sails were refused, by status.
    sailed : int64[1]
        How many edges were sailed at a setting.
    """

    times: np.ndarray
    first: np.ndarray
    count: np.ndarray
    place: np.ndarray
    offset: np.ndarray
    state: np.ndarray
    values: np.ndarray
    refused: np.ndarray
    sailed: np.ndarray


class FrontArrays(NamedTuple):
    """All that edges are sailed with: network, sea, ship, prices, and the departure [s]."""

    network: NetworkArrays
    sea: SeaArrays
    ship: MultiSettingShip
    prices: EdgePrices
    depart: float


@inlined
def _pass_fixed_time_edge(world, edge, choice, t):
    """Pass an edge whose duration does not depend on the sea: return (arrival, fuel, status)."""
    if choice != world.prices.fixed_choice[edge]:
        return math.inf, 0.0, SHIP_RANGE
    arrival, status = pass_canal(world.network, edge, t, world.sea.times[-1])
    return arrival, world.prices.fixed_fuel[edge], status


@inlined
def _sail_sea_edge(world, edge, choice, k, t, work):
    """Sail an edge in open water: return (arrival, fuel, status)."""
    ship = world.ship
    at_setting = ShipArrays(ship.table, ship.settings[choice], ship.limits, ship.needs)
    fuel = FuelTable(ship.fuel, ship.fuel_needs)
    arrival, burnt, status, _ = march_edge(
        world, at_setting, fuel, edge, k, t, None, (work[1], work[2], work[3])
    )
    return arrival, burnt, status


@kernel_only
def sail_edge_priced(world, edge, choice, k, t, work):
    """Sail an edge at one of the settings.

    Parameters
    ----------
    world : FrontArrays
    edge, choice : int
    k : int
        Interval of the sea's times that holds the departure.
    t : float
        Departure [s].
    work : float64[4, CHANNELS]
        Row 1 holds the sea at the tail at that time; rows 2 and 3 are work space.

    Returns
    -------
    arrival, cost : Cost of fuel, fee and time; not useful unless the status is `OK`.
    status : int
    """
    fixed = world.prices.fixed_time[edge]
    if fixed == fixed:
        arrival, fuel, status = _pass_fixed_time_edge(world, edge, choice, t)
    else:
        arrival, fuel, status = _sail_sea_edge(world, edge, choice, k, t, work)
    prices = world.prices
    cost = fuel * prices.weight[edge] + prices.fee[edge] + prices.time_price * (arrival - t)
    return arrival, cost, status


@inlined
def _may_open(status):
    return status in (DEPTH, WAVE_HEIGHT, WIND_SPEED, CURRENT, SHIP_RANGE, OUTSIDE_PERIOD)


@kernel_only
def fill_edge_table(world, tables, node, i, work):
    """Sail every edge that leaves a node at its i-th slice, at all settings."""
    network, sea, ship = world.network, world.sea, world.ship
    count = ship.settings.shape[0]
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    at = tables.offset[node] + i * (e1 - e0) * 2 * count
    t = world.depart + tables.times[tables.first[node] + i]
    k = interval_of(sea.times, t)
    found = FILLED
    if k >= 0:
        sample_station(sea, network.station[node], k, t, work[1])
    required = ship.limits[LIMIT_REQUIRED_DEPTH]
    for edge in range(e0, e1):
        never = OK if k >= 0 else OUTSIDE_PERIOD
        fixed = world.prices.fixed_time[edge]
        if never == OK and required > -math.inf and fixed != fixed:
            never = never_deep_enough(network, sea, edge, required)
        closed = 0
        for s in range(count):
            duration, cost, status = math.inf, math.inf, never
            if status == OK:
                then, price, status = sail_edge_priced(world, edge, s, k, t, work)
                tables.sailed[0] += 1
                if status == OK:
                    duration, cost = then - t, price
                elif _may_open(status):
                    duration, closed = math.nan, closed + 1
            if status != OK:
                tables.refused[status] += 1
            tables.values[at + s] = duration
            tables.values[at + count + s] = cost
        if closed > 0:
            found = max(found, ALL_CLOSED if closed == count else SOME_CLOSED)
        at += 2 * count
    tables.state[tables.place[node] + i] = found


@allocation_free
def sail_departures(world, edges, tails, choices, departures, out, work):
    """Sail edges at given departures.

    Parameters
    ----------
    world : FrontArrays
    edges, tails, choices : int64[M]
    departures : float64[M]
        [s].
    out : float64[M, 2]
        Filled with duration [s] and cost; NaN where refused.
    work : float64[4, CHANNELS]
    """
    for i in range(edges.shape[0]):
        out[i, 0], out[i, 1] = math.nan, math.nan
        t = departures[i]
        k = interval_of(world.sea.times, t)
        if k < 0:
            continue
        sample_station(world.sea, world.network.station[tails[i]], k, t, work[1])
        then, cost, status = sail_edge_priced(world, edges[i], choices[i], k, t, work)
        if status == OK:
            out[i, 0], out[i, 1] = then - t, cost


@allocation_free
def sail_path(world, nodes, edges, choices, leave, arrive, depart, work):
    """Sail a path edge by edge; return (cost, status).

    Parameters
    ----------
    world : FrontArrays
    nodes : int64[P]
        States.
    edges, choices : int64[P - 1]
    leave : float64[P - 1]
        A node is not left before this [s]; -inf where the ship does not wait.
    arrive, depart : float64[P]
        ``arrive[0]`` is when the ship is at the start; the others are filled [s].
    work : float64[4, CHANNELS]
    """
    total = 0.0
    network, sea, prices = world.network, world.sea, world.prices
    t = arrive[0]
    for i in range(edges.shape[0]):
        out = max(t, leave[i])
        depart[i] = out
        total += prices.waiting_cost_rate * (out - t)
        k = interval_of(sea.times, out)
        if k < 0:
            return total, OUTSIDE_PERIOD
        if out > t and out > network.until[nodes[i]]:
            return total, DEPTH
        sample_station(sea, network.station[nodes[i]], k, out, work[1])
        t, cost, status = sail_edge_priced(world, edges[i], choices[i], k, out, work)
        if status != OK:
            return total, status
        total += cost
        arrive[i + 1] = t
    depart[edges.shape[0]] = t
    return total, OK


@allocation_free
def largest_edge_currents(network, sea, along):
    """Fill the largest current along every edge in the fields [m/s]; 0 where there is none.

    Parameters
    ----------
    network, sea : NetworkArrays, SeaArrays
    along : float64[E]
    """
    i, j = sea.channel_index[0], sea.channel_index[1]
    values = sea.values
    for node in range(network.indptr.shape[0] - 1):
        tail = network.station[node]
        for edge in range(network.indptr[node], network.indptr[node + 1]):
            east, north = course_vector(float(network.course[edge]))
            first, last = network.via_ptr[edge], network.via_ptr[edge + 1]
            most = -math.inf
            for p in range(first - 1, last + 1):
                a = b = tail if p < first else network.station[network.target[edge]]
                if p >= first and p < last:
                    a, b = network.via_a[p], network.via_b[p]
                for t in range(values.shape[1]):  # linear between stations: the ends bound it
                    flow = east * values[a, t, i] + north * values[a, t, j]
                    if flow > most:
                        most = flow
                    if b != a:
                        flow = east * values[b, t, i] + north * values[b, t, j]
                        if flow > most:
                            most = flow
            along[edge] = most if most > -math.inf else 0.0
