"""The network on which a stretch is searched."""

from __future__ import annotations

from thalweg.chart import Chart
from thalweg.core.errors import NoRouteError
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
from thalweg.network.layered.sections_round_land import layered_section
from thalweg.planning.network_selection.model_mesh import model_mesh_network
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.sea import Mesh, Sea

#: Voyages of at least this distance [m] with a route longer than this multiple of it are searched
#: in a corridor around the path over the globe network.
_LONG_DISTANCE, _DETOUR_RATIO = 1500.0 * NAUTICAL_MILE, 1.3


def build_network(
    choice: NetworkChoice,
    chart: Chart,
    sea: Sea,
    ends: tuple[Endpoint, Endpoint],
    *,
    period: tuple[float, float],
) -> Network:
    """Build the chosen network between two places for a voyage in a period [s since 1970]."""
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
    if choice.network == "layered":
        return layered_section(
            chart, *places, choice.section_shape, spacing=choice.spacing, request=choice.layered,
            numbering=choice.section,
        )  # fmt: skip
    return lattice_between(chart, *places, spacing=choice.spacing)


def lattice_between(
    chart: Chart,
    start: Position,
    goal: Position,
    *,
    spacing: float | None = None,
    coast_levels: int | None = None,
) -> Network:
    """Return a lattice between two places; around land, along the path of the globe network.

    It covers all water between the places unless the voyage is long and land is between them.
    """
    options = {"spacing": spacing, "coast_levels": coast_levels}
    far = float(distance(*start, *goal)) >= _LONG_DISTANCE and chart.area.width >= 360.0
    if not far:
        return lattice(chart, start, goal, **options)  # type: ignore[arg-type]
    try:
        return lattice(chart, start, goal, detour=_DETOUR_RATIO, **options)  # type: ignore[arg-type]
    except NoRouteError:
        path = _globe_path(chart, start, goal)
    if path is None:
        return lattice(chart, start, goal, **options)  # type: ignore[arg-type]
    return lattice(chart, start, goal, along=path, **options)  # type: ignore[arg-type]


def _globe_path(chart: Chart, start: Position, goal: Position) -> list[Position] | None:
    """Return the shortest path over the globe network, or None."""
    try:
        network = globe(chart, start, goal)
    except NoRouteError:
        return None
    _, path = shortest_path(network, network.meta.start, network.meta.goal)
    return list(zip(network.lat[path].tolist(), network.lon[path].tolist())) if path else None


def _inside_mesh_extent(model: Mesh, ends: tuple[Position, Position]) -> bool:
    """Return whether both places are in the bounding box of a model's nodes."""
    south, north, west, east = model.lat.min(), model.lat.max(), model.lon.min(), model.lon.max()
    return all(south <= lat <= north and west <= lon <= east for lat, lon in ends)
