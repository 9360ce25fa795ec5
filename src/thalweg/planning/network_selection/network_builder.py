"""The network on which a stretch is searched."""

from __future__ import annotations

from functools import cached_property, partial

import numpy as np

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import Position, distance, format_position, line_length
from thalweg.core.given_numbers import shortened_repr
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import (
    Network,
    check_network,
    globe,
    lattice,
    with_endpoints,
)
from thalweg.network.global_grid.globe_builder import globe_path
from thalweg.network.layered.sections_round_land import layered_section
from thalweg.network.regional_lattice.lattice_builder import default_coast_levels, default_spacing
from thalweg.planning.network_selection.model_mesh import model_mesh_network
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways
from thalweg.sea import Mesh, Sea

#: Voyages of at least this distance [m] with a route longer than this multiple of it are searched
#: in a corridor around the path over the globe network.
_LONG_DISTANCE, _DETOUR_RATIO = 1500.0 * NAUTICAL_MILE, 1.3
_SAME_PLACE = 10.0  # [m]
_SURE = 1.05  # over this multiple of a length on the globe network, a route is longer than it


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
        if not isinstance(network, Network):
            raise InputError(
                f"The network builder returns {shortened_repr(network)}.",
                "It is called with (chart, (lat, lon), (lat, lon), spacing=...), and returns a "
                "thalweg.network.Network with its start and goal.",
                "Return a network, such as one of thalweg.network.lattice or fixed_route.",
                field="network",
            )
        check_network(network)
        _check_ends(network, places)
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


def _check_ends(network: Network, places: tuple[Position, Position]) -> None:
    """Refuse a network of the user that does not begin and end at the places of the voyage."""
    meta = network.meta
    for what, node, place in zip(("start", "goal"), (meta.start, meta.goal), places):
        given = None if node < 0 else (float(network.lat[node]), float(network.lon[node]))
        if given is None or float(distance(*given, *place)) > _SAME_PLACE:
            where = "none" if given is None else format_position(*given)
            raise InputError(
                f"The network of the builder has another {what} than the voyage: {where}.",
                f"It is called with {format_position(*place)}, where its {what} must be.",
                "Return a network whose meta.start and meta.goal are nodes at these places "
                "(thalweg.network.with_endpoints joins them to a network).",
                field="network",
            )


def lattice_between(
    chart: Chart, start: Position, goal: Position, *, spacing: float | None = None
) -> Network:
    """Return a lattice between two places, as `LatticeBetween` builds it."""
    return LatticeBetween(chart, start, goal).network(spacing=spacing)


class LatticeBetween:
    """Lattices of several resolutions between two places; the way round land is found once.

    They cover all water between the places unless the voyage is long and land is between them:
    then the water along the path of the globe network. The lattice of default resolution is built
    once.
    """

    def __init__(self, chart: Chart, start: Position, goal: Position) -> None:
        self.chart, self.places = chart, (start, goal)
        self._default: Network | None = None
        self._distance = float(distance(*start, *goal))
        far = self._distance >= _LONG_DISTANCE and chart.area.width >= 360.0
        self._limits_detour, self._path = far, self._long_way_round() if far else None

    def network(self, *, spacing: float | None = None, coast_levels: int | None = None) -> Network:
        """Return the lattice of one resolution.

        Raises
        ------
        NoRouteError : If start and goal do not connect.
        """
        is_default = spacing is None and coast_levels in (None, self._default_levels())
        if is_default and self._default is not None:
            return self._default
        found = self._built(spacing, coast_levels)
        if is_default and not found.meta.notes:  # not coarsened, which depends on what is given
            self._default = found
        return found

    def _default_levels(self) -> int:
        """Return the number of coast levels of the lattice of default resolution."""
        length = self._distance
        if self._path is not None:
            length = line_length(self._path)
        return default_coast_levels(self.chart, default_spacing(length))

    def _built(self, spacing: float | None, coast_levels: int | None) -> Network:
        build = partial(
            lattice, self.chart, *self.places, spacing=spacing, coast_levels=coast_levels,
            expected=self._expected_length,
        )  # fmt: skip
        if self._limits_detour and self._path is None:
            try:
                return build(detour=_DETOUR_RATIO)
            except NoRouteError:
                self._limits_detour, self._path = False, self._globe_path()[0]
        return build(along=self._path)

    @cached_property
    def _expected_length(self) -> float:
        """Length of the way over all seas [m]; 0 where it is not known, or likely the distance."""
        (lat, lon), goal = self.places
        world = bool(self.chart.passages) and self.chart.area.width >= 360.0
        if self._path is not None or not (
            world and np.any(self.chart.legs_blocked(lat, lon, *goal))
        ):
            return 0.0
        return Seaways.of_ship_chart(self.chart).length_over_graph((lat, lon), goal)

    def _long_way_round(self) -> list[Position] | None:
        """Return the path over the globe network if it is surely too long for a whole lattice."""
        (lat, lon), (to_lat, to_lon) = self.places
        if not np.any(self.chart.legs_blocked(lat, lon, to_lat, to_lon)):
            return None
        path, length = self._globe_path()
        return path if length > _SURE * _DETOUR_RATIO * self._distance else None

    def _globe_path(self) -> tuple[list[Position] | None, float]:
        """Return the shortest path over the globe network and its length [m]; None without one."""
        try:
            return globe_path(self.chart, *self.places) or (None, 0.0)
        except NoRouteError:
            return None, 0.0


def _inside_mesh_extent(model: Mesh, ends: tuple[Position, Position]) -> bool:
    """Return whether both places are in the bounding box of a model's nodes."""
    south, north, west, east = model.lat.min(), model.lat.max(), model.lon.min(), model.lon.max()
    return all(south <= lat <= north and west <= lon <= east for lat, lon in ends)
