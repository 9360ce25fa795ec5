"""Which network a passage is searched on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from thalweg.chart import Chart
from thalweg.core.errors import InputError, unknown_name
from thalweg.network import Network, check_network, lattice, mesh, with_endpoints
from thalweg.planning.ends import End
from thalweg.sea import Mesh, Sea

#: A builder of one's own: (chart, start, goal, spacing) -> Network with its endpoints attached.
Builder: TypeAlias = Callable[..., Network]

KINDS = ("auto", "lattice", "mesh")


@dataclass(frozen=True)
class NetworkChoice:
    """How the network is built.

    Attributes
    ----------
    network : {"auto", "lattice", "mesh"} or callable
        ``auto`` takes the nodes of the sea's own mesh where it has one that holds both ends, and a
        lattice elsewhere. A callable gets ``(chart, start, goal, spacing=...)``.
    spacing : float, optional
        Spacing of the nodes [m].
    """

    network: str | Builder = "auto"
    spacing: float | None = None

    def __post_init__(self) -> None:
        if not callable(self.network) and self.network not in KINDS:
            raise unknown_name("network", str(self.network), KINDS)
        number = isinstance(self.spacing, (int, float)) and not isinstance(self.spacing, bool)
        if self.spacing is not None and not (number and 0.1 <= self.spacing <= 1e6):
            raise InputError(
                f"A resolution of {self.spacing!r} m cannot be.",
                "It lies between 0.1 m and 1,000 km.",
                "Give the spacing of the network in metres.",
            )


def build_network(choice: NetworkChoice, chart: Chart, sea: Sea, start: End, goal: End) -> Network:
    """Build the network between two ends, as chosen."""
    ends = ((start.lat, start.lon), (goal.lat, goal.lon))
    if callable(choice.network):
        network = choice.network(chart, *ends, spacing=choice.spacing)
        check_network(network)
        return network
    model = sea.mesh() if choice.network in ("auto", "mesh") else None
    if choice.network == "mesh" and model is None:
        raise InputError(
            "A mesh network is asked, but the sea has no mesh.",
            "Meshes come from UGRID files of hydrodynamic models.",
            "Use network='lattice', or open such a file first.",
        )
    if model is not None and (choice.network == "mesh" or _inside(model, ends)):
        network = mesh(chart, model.lat, model.lon, model.triangles, largest_spacing=choice.spacing)
        return with_endpoints(network, chart, *ends)
    return lattice(chart, *ends, spacing=choice.spacing)


def _inside(model: Mesh, ends: tuple[tuple[float, float], ...]) -> bool:
    """Return whether both ends lie in the box of a model's nodes."""
    south, north, west, east = model.lat.min(), model.lat.max(), model.lon.min(), model.lon.max()
    return all(south <= lat <= north and west <= lon <= east for lat, lon in ends)
