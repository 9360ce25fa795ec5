"""The request for a network: its kind and the spacing of its nodes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.network import Network

#: A builder of the user: (chart, start, goal, spacing) -> Network with its endpoints attached.
NetworkBuilder: TypeAlias = Callable[..., Network]

NETWORK_KINDS = ("auto", "lattice", "mesh", "globe")


@dataclass(frozen=True)
class NetworkChoice:
    """How the network is built.

    Attributes
    ----------
    network : {"auto", "lattice", "mesh", "globe"} or callable
        ``auto`` uses the mesh of the hydrodynamic model where the sea has one that contains both
        ends, else a lattice. ``mesh`` always uses the mesh. ``globe`` is a coarse geodesic grid of
        all seas, for routes around continents. A callable is called with ``(chart, start, goal,
        spacing=...)``.
    spacing : float, optional
        Spacing of the nodes [m]; of a mesh that in still water, finer where the current is strong
        or turns.
    """

    network: str | NetworkBuilder = "auto"
    spacing: float | None = None

    def __post_init__(self) -> None:
        if not callable(self.network) and self.network not in NETWORK_KINDS:
            raise unknown_name_error("network", str(self.network), NETWORK_KINDS)
        number = isinstance(self.spacing, (int, float)) and not isinstance(self.spacing, bool)
        if self.spacing is not None and not (number and 0.1 <= self.spacing <= 1e6):
            raise InputError(
                f"The resolution is {self.spacing!r} m.",
                "A resolution is between 0.1 m and 1,000 km.",
                "Give the spacing of the network in metres.",
            )
