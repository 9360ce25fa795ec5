"""Which network a passage is searched on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError, unknown_name_error
from thalweg.core.geodesy import Position, distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import (
    Network,
    check_network,
    globe,
    lattice,
    shortest_path,
    with_endpoints,
)
from thalweg.planning.network_selection.model_mesh import model_mesh_network
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.sea import Mesh, Sea

#: A builder of one's own: (chart, start, goal, spacing) -> Network with its endpoints attached.
NetworkBuilder: TypeAlias = Callable[..., Network]

NETWORK_KINDS = ("auto", "lattice", "mesh", "globe")
#: Voyages from this length [m] whose way is longer than this multiple of the distance are searched
#: in a corridor about the way over the globe network.
_LONG_DISTANCE, _DETOUR_RATIO = 1500.0 * NAUTICAL_MILE, 1.3


@dataclass(frozen=True)
class NetworkChoice:
    """How the network is built.

    Attributes
    ----------
    network : {"auto", "lattice", "mesh", "globe"} or callable
        ``auto`` takes the nodes of the sea's own mesh where it has one that holds both ends, and a
        lattice elsewhere. ``mesh`` takes them always. ``globe`` is the geodesic grid of the whole
        sea: coarse, for ways round continents. A callable gets ``(chart, start, goal,
        spacing=...)``.
    spacing : float, optional
        Spacing of the nodes [m]; of a mesh that in still water, less where the flow is strong or
        turns.
    """

    network: str | NetworkBuilder = "auto"
    spacing: float | None = None

    def __post_init__(self) -> None:
        if not callable(self.network) and self.network not in NETWORK_KINDS:
            raise unknown_name_error("network", str(self.network), NETWORK_KINDS)
        number = isinstance(self.spacing, (int, float)) and not isinstance(self.spacing, bool)
        if self.spacing is not None and not (number and 0.1 <= self.spacing <= 1e6):
            raise InputError(
                f"A resolution of {self.spacing!r} m cannot be.",
                "It lies between 0.1 m and 1,000 km.",
                "Give the spacing of the network in metres.",
            )


def build_network(
    choice: NetworkChoice,
    chart: Chart,
    sea: Sea,
    ends: tuple[Endpoint, Endpoint],
    *,
    period: tuple[float, float],
) -> Network:
    """Build the network between two ends, as chosen, for a voyage in a period [s since 1970]."""
    places = (ends[0].lat, ends[0].lon), (ends[1].lat, ends[1].lon)
    if callable(choice.network):
        network = choice.network(chart, *places, spacing=choice.spacing)
        check_network(network)
        return network
    model = sea.mesh() if choice.network in ("auto", "mesh") else None
    if choice.network == "mesh" or (model is not None and _inside_mesh_extent(model, places)):
        network = model_mesh_network(chart, sea, period, spacing=choice.spacing)
        return with_endpoints(network, chart, *places)
    if choice.network == "globe":
        return globe(chart, *places)
    return lattice_between(chart, *places, spacing=choice.spacing)


def lattice_between(
    chart: Chart,
    start: Position,
    goal: Position,
    *,
    spacing: float | None = None,
    coast_levels: int | None = None,
) -> Network:
    """Return a lattice; far round land, one along the way that the globe network shows.

    The whole sea between the ends is covered unless the voyage is long and land lies in between.
    """
    options = {"spacing": spacing, "coast_levels": coast_levels}
    far = float(distance(*start, *goal)) >= _LONG_DISTANCE and chart.area.width >= 360.0
    if not far:
        return lattice(chart, start, goal, **options)  # type: ignore[arg-type]
    try:
        return lattice(chart, start, goal, detour=_DETOUR_RATIO, **options)  # type: ignore[arg-type]
    except NoRouteError:
        way = _globe_path(chart, start, goal)
    if way is None:
        return lattice(chart, start, goal, **options)  # type: ignore[arg-type]
    return lattice(chart, start, goal, along=way, **options)  # type: ignore[arg-type]


def _globe_path(chart: Chart, start: Position, goal: Position) -> list[Position] | None:
    """Return the shortest way over the globe network, if it knows one."""
    try:
        network = globe(chart, start, goal)
    except NoRouteError:
        return None
    _, path = shortest_path(network, network.meta.start, network.meta.goal)
    return list(zip(network.lat[path].tolist(), network.lon[path].tolist())) if path else None


def _inside_mesh_extent(model: Mesh, ends: tuple[Position, Position]) -> bool:
    """Return whether both ends lie in the box of a model's nodes."""
    south, north, west, east = model.lat.min(), model.lat.max(), model.lon.min(), model.lon.max()
    return all(south <= lat <= north and west <= lon <= east for lat, lon in ends)
