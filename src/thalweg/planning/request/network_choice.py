"""The request for a network: its kind and the spacing of its nodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.geodesy import Position
from thalweg.core.given_numbers import is_number
from thalweg.network import LayeredRequest, Network
from thalweg.network.history.history_corridor import HistoryCorridor
from thalweg.network.history.history_file import read_history
from thalweg.network.layered.section_shape import SectionShape

#: A builder of the user: (chart, start, goal, spacing) -> Network with its endpoints attached.
NetworkBuilder: TypeAlias = Callable[..., Network]

NETWORK_KINDS = ("auto", "lattice", "mesh", "globe", "layered")
_HISTORY = "history:"  # before the file of a history network


@dataclass(frozen=True)
class NetworkChoice:
    """How the network is built.

    Attributes
    ----------
    network : {"auto", "lattice", "mesh", "globe", "layered"} or callable
        ``auto`` uses the mesh of the hydrodynamic model where the sea has one that contains both
        ends, else a lattice. ``mesh`` always uses the mesh. ``globe`` is a coarse geodesic grid of
        all seas, for routes around continents. ``layered`` is a rhombus of layers between every
        two places of the voyage, for rugged coasts. A callable is called with
        ``(chart, start, goal, spacing=...)``.
    spacing : float, optional
        Spacing of the nodes [m]; of a mesh that in still water, finer where the current is strong
        or turns.
    layered : LayeredRequest, optional
        Shape of a layered network; by default it is chosen.
    section : tuple of int
        Number of the section that is built, from 0, and how many the voyage has.
    """

    network: str | NetworkBuilder = "auto"
    spacing: float | None = None
    layered: LayeredRequest | None = None
    section: tuple[int, int] = (0, 1)

    def __post_init__(self) -> None:
        if self.layered is not None and self.network == "auto":
            object.__setattr__(self, "network", "layered")
        if self.layered is not None and self.network != "layered":
            raise InputError(
                f"Layers are given for the network {self.network!r}.",
                "Layers, fan and offset shape the network 'layered'.",
                "Choose it, or leave them out.",
                field="layered",
            )
        if not callable(self.network) and self.network not in NETWORK_KINDS:
            raise unknown_name_error(
                "network", str(self.network), (*NETWORK_KINDS, f"{_HISTORY}FILE")
            )
        if self.spacing is not None and not (
            is_number(self.spacing) and 0.1 <= self.spacing <= 1e6
        ):
            raise InputError(
                f"The resolution is {self.spacing!r} m.",
                "A resolution is between 0.1 m and 1,000 km.",
                "Give the spacing of the network in metres.",
            )

    def of_section(self, places: Sequence[Position], number: int) -> NetworkChoice:
        """Return this choice for one section of a voyage.

        Parameters
        ----------
        places : sequence of (lat, lon)
            Start, waypoints and goal [deg].
        number : int
            Number of the section, from 0.

        Returns
        -------
        NetworkChoice
        """
        layered = None if self.layered is None else self.layered.of_section(places, number)
        return replace(self, section=(number, len(places) - 1), layered=layered)

    @property
    def section_shape(self) -> SectionShape | None:
        """Shape of the section that is built; None where it is chosen."""
        number, count = self.section
        return None if self.layered is None else self.layered.shapes(count)[number]


def history_corridor(network: object) -> HistoryCorridor | None:
    """Return the corridor of a request for a history network; None for other networks.

    Parameters
    ----------
    network : A `HistoryCorridor`, or text such as ``"history:routes.json"``.

    Raises
    ------
    InputError : If the file cannot be read.
    """
    if isinstance(network, HistoryCorridor):
        return network
    if not (isinstance(network, str) and network.startswith(_HISTORY)):
        return None
    return HistoryCorridor(read_history(network.removeprefix(_HISTORY)))
