"""Arrays of network, sea and ship that search kernels read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance
from thalweg.core.limits import Limits
from thalweg.kernels.codes import CHANNEL_COUNT
from thalweg.kernels.leg.edge_sailing import NetworkArrays, SeaArrays
from thalweg.kernels.leg.point_speed import ShipArrays
from thalweg.kernels.leg.table_lookup import ARRAY_TYPES, TableArrays, axes_needed
from thalweg.kernels.search.field_bounds import largest_current, largest_speed_field, tidal_extremes
from thalweg.network.distance_bounds import BOUND_RADIUS, ROUNDING_FACTOR, distance_bounds
from thalweg.search.tidal_states import tidal_states

if TYPE_CHECKING:
    from thalweg.network.network import Network
    from thalweg.sea.frozen_fields import StationFields
    from thalweg.ship.tables.performance_table import PerformanceTable


__all__ = [
    "BOUND_RADIUS",
    "ROUNDING_FACTOR",
    "SearchProblem",
    "ShipOnNetwork",
    "canal_speed",
    "contiguous_array",
    "distance_bounds",
    "make_search_problem",
    "network_arrays",
    "sea_arrays",
    "ship_arrays",
    "top_speed_through_water",
]


@dataclass(frozen=True, eq=False)
class ShipOnNetwork:
    """A ship at one setting, on a network, in the sea frozen at the network's stations.

    Attributes
    ----------
    network : Network
    fields : StationFields
        The sea, frozen at the network's stations.
    table : PerformanceTable or TableArrays
    setting : int
        Setting of the ship.
    limits : Limits
        Limits along the route (`thalweg.core.limits.Limits`).
    top_speed : float
        Upper bound of the ship's speed through water at this setting [m/s].
    """

    network: Network
    fields: StationFields
    table: PerformanceTable | TableArrays
    setting: int
    limits: Limits
    top_speed: float


class SearchProblem(NamedTuple):
    """A network, a sea and a ship as kernels see them, with bounds of what the ship can do.

    Attributes
    ----------
    network, sea, ship : Arrays for `thalweg.kernels.search.label_setting`.
    top_speed : Upper bound of the speed through water [m/s].
    top_current : Largest current in the fields [m/s].
    """

    network: NetworkArrays
    sea: SeaArrays
    ship: ShipArrays
    top_speed: float
    top_current: float

    @property
    def fastest(self) -> float:
        """Upper bound of the speed over ground [m/s]."""
        return self.top_speed + self.top_current


class _WritableView:
    """The memory of a read-only array, offered as writable: kernels never write to their input.

    One numba signature then serves frozen and ordinary arrays alike.
    """

    def __init__(self, array: NDArray[Any]) -> None:
        self.array = array
        address = array.__array_interface__["data"][0]
        self.__array_interface__ = {**array.__array_interface__, "data": (address, False)}


def contiguous_array(values: ArrayLike, dtype: type) -> NDArray[Any]:
    """Return values as a C-contiguous array of one type that numba sees as writable."""
    array: NDArray[Any] = np.ascontiguousarray(values, dtype)
    return array if array.flags.writeable else np.asarray(_WritableView(array))


def network_arrays(network: Network) -> NetworkArrays:
    """Return the arrays of a network that searches read."""
    count = len(network.can_wait)
    return NetworkArrays(
        contiguous_array(network.graph.indptr, np.int64),
        contiguous_array(network.graph.target, np.int32),
        contiguous_array(network.edges.length, np.float64),
        contiguous_array(network.edges.course, np.float32),
        contiguous_array(network.edges.depth, np.float32),
        contiguous_array(network.edges.penalty_factor, np.float32),
        contiguous_array(network.samples.ptr, np.int64),
        contiguous_array(network.samples.station_a, np.int32),
        contiguous_array(network.samples.station_b, np.int32),
        contiguous_array(network.samples.weight, np.float32),
        contiguous_array(network.samples.fraction, np.float32),
        contiguous_array(network.can_wait, np.bool_),
        np.arange(count, dtype=np.int32),
        np.full(count, -np.inf),
        np.full(count, np.inf),
        np.full(count, np.inf),
        contiguous_array(network.edges.fixed_time, np.float64),
    )


def sea_arrays(fields: StationFields, *, tides: bool = False) -> SeaArrays:
    """Return frozen fields as the kernels read them, with tidal extremes if requested.

    Parameters
    ----------
    fields : The sea, frozen at the stations of a network.
    tides : Add the extremes of the water level.

    Raises
    ------
    InputError : If there are fewer than two times, or times that do not increase.
    """
    times = contiguous_array(fields.times, np.float64)
    if len(times) < 2 or not np.all(np.diff(times) > 0.0):
        raise InputError(
            f"The fields of the sea have {len(times)} times, or times that do not increase.",
            "A search interpolates between at least two increasing times.",
            "Freeze the sea over a period, not an instant.",
        )
    index = contiguous_array(fields.channel_index, np.int64)
    values = contiguous_array(fields.values, np.float32)
    channels = np.zeros(values.shape[2], np.int64)
    present = np.flatnonzero(index >= 0)
    channels[index[present]] = present
    if (
        len(index) != CHANNEL_COUNT
        or len(present) != len(channels)
        or values.shape[1] != len(times)
    ):
        raise InputError(
            f"Fields of shape {values.shape} do not go with {len(times)} times and "
            f"{len(present)} channels.",
            "Values are stations by times by present channels.",
            "Build the fields with Sea.freeze_stations.",
        )
    count = values.shape[0] if tides else 0
    highest, deepest = np.empty(count, np.float32), np.empty(count, np.float32)
    sea = SeaArrays(times, values, index, channels, highest, deepest)
    if tides:
        tidal_extremes(sea)
    return sea


def ship_arrays(table: PerformanceTable | TableArrays, setting: int, limits: Limits) -> ShipArrays:
    """Return a ship at one setting as kernels see it.

    Parameters
    ----------
    table : Speed through water [m/s].
    setting : Setting of the ship.
    limits : Limits of depth, wave height and wind speed.

    Raises
    ------
    InputError : If the setting is not one of the table's, or the limits are not `Limits`.
    """
    if not isinstance(limits, Limits):
        raise InputError(
            f"The limits are given as {type(limits).__name__}.",
            "A search takes limits as one object with names and units.",
            "Give thalweg.core.limits.Limits(required_depth=..., wave_height=..., wind_speed=...).",
        )
    raw = table if isinstance(table, TableArrays) else table.kernel_arrays()
    count = int(raw.n_settings)
    if not 0 <= setting < count:
        raise InputError(
            f"The ship has no setting {setting}.",
            f"It has settings 0 to {count - 1}.",
            "Give one of these.",
        )
    kinds: dict[str, Any] = {
        name: contiguous_array(getattr(raw, name), kind) for name, kind in ARRAY_TYPES.items()
    }
    arrays = raw._replace(n_settings=count, **kinds)
    return ShipArrays(arrays, int(setting), limits.array, int(axes_needed(arrays)))


def top_speed_through_water(sea: SeaArrays, top_speed: float) -> tuple[float, bool]:
    """Return (upper bound of the speed through water [m/s], whether a speed field gives it).

    Parameters
    ----------
    sea : A ``SPEED_FIELD`` channel replaces the ship's own speed.
    top_speed : Of the ship [m/s].

    Raises
    ------
    InputError : If the bound is not a positive number.
    """
    field_top = float(largest_speed_field(sea))
    fastest = field_top if field_top >= 0.0 else float(top_speed)
    if not (np.isfinite(fastest) and fastest > 0.0):
        raise InputError(
            f"A ship with a top speed of {fastest} m/s does not move.",
            "A speed is a positive number.",
            "Check the ship's speeds.",
        )
    return fastest, field_top >= 0.0


def make_search_problem(
    ship_on_network: ShipOnNetwork, *, ends: tuple[int, int | None] | None = None
) -> SearchProblem:
    """Return the arrays that a search reads.

    With ``ends`` (start and goal) the nodes between them that fall dry become several states.

    Parameters
    ----------
    ship_on_network : The network, the sea frozen at its stations, and the ship at one setting.
    ends : Start and goal nodes.

    Returns
    -------
    SearchProblem : Arrays for the kernels.

    Raises
    ------
    InputError : If the parts do not fit together or the ship has no speed.
    """
    network, limits = ship_on_network.network, ship_on_network.limits
    ship = ship_arrays(ship_on_network.table, ship_on_network.setting, limits)
    sea = sea_arrays(ship_on_network.fields, tides=limits.depth_checked)
    check_fields_of_network(network, len(sea.values))
    fastest, _ = top_speed_through_water(sea, ship_on_network.top_speed)
    arrays = network_arrays(network)
    if ends is not None:
        keep = ends[0], -1 if ends[1] is None else ends[1]
        arrays = tidal_states(arrays, sea, limits.required_depth, keep)
    return SearchProblem(arrays, sea, ship, fastest, float(largest_current(sea)))


def canal_speed(network: Network) -> float:
    """Return the largest speed [m/s], along the geodesic, of edges of fixed time; 0 if none.

    A bound by speed holds only with at least this one: a slow ship may gain on it in a canal.
    """
    edge = np.flatnonzero(~np.isnan(network.edges.fixed_time))
    if len(edge) == 0:
        return 0.0
    tail = np.searchsorted(network.graph.indptr, edge, side="right") - 1
    head = network.graph.target[edge]
    lat, lon = network.stations.lat, network.stations.lon
    away = distance(lat[tail], lon[tail], lat[head], lon[head])
    return float(np.max(away / network.edges.fixed_time[edge]))


def check_fields_of_network(network: Network, stations: int) -> None:
    """Raise `InputError` unless frozen fields have as many stations as a network."""
    if stations != len(network.stations.lat):
        raise InputError(
            f"The fields have {stations} stations, the network {len(network.stations.lat)}.",
            "Fields belong to the network they were frozen for.",
            "Freeze the sea at the stations of this network.",
        )


def check_two_nodes(n_nodes: int, start: int, goal: int) -> None:
    """Raise `InputError` unless start and goal are two nodes of a network."""
    if not (0 <= start < n_nodes and 0 <= goal < n_nodes and start != goal):
        raise InputError(
            f"A search from node {start} to node {goal} is not possible.",
            f"The network has nodes 0 to {n_nodes - 1}; start and goal must differ.",
            "Give two nodes of this network.",
        )
