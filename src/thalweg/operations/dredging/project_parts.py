"""Parts of a dredging project: sites, their network, work and base case."""

from __future__ import annotations

from dataclasses import dataclass, field

from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position
from thalweg.operations.dredging.loading_curves import LoadingCurve
from thalweg.operations.dredging.project_validation import (
    check_clearance,
    positive_number,
)


@dataclass(frozen=True)
class SiteNetworkOptions:
    """How the water between two sites is divided into a network.

    Attributes
    ----------
    margin : float
        Depth planned in addition to the required depth [m], for shallows between the nodes.
    spacing : float or None
        Spacing of the network [m]; None: that of the sea's own mesh.
    rings : int
        Neighbours a node is connected to: 1, 2 or 3 rings of triangles.
    detour : float
        Greatest length of a route through a node, as a multiple of the direct distance.

    Raises
    ------
    InputError
        For a margin, spacing, number of rings or detour out of range.
    """

    margin: float = 0.01
    spacing: float | None = None
    rings: int = 3
    detour: float = 3.0

    def __post_init__(self) -> None:
        check_clearance("margin_m", self.margin)
        if self.spacing is not None:
            positive_number({"spacing_m": self.spacing}, "spacing_m")
        if type(self.rings) is not int or self.rings not in (1, 2, 3):
            raise InputError(
                f"rings is {self.rings!r}.", "1, 2 or 3.", "Choose one.", field="rings"
            )
        if positive_number({"detour": self.detour}, "detour") < 1.2:
            raise InputError(
                f"detour is {self.detour:g}.", "It is at least 1.2.", "Give 3.", field="detour"
            )


@dataclass(frozen=True)
class Sites:
    """Where a dredger loads and unloads.

    Attributes
    ----------
    load, unload : (lat, lon) [deg]
    min_ukc : float or None
        Minimum under-keel clearance [m]; None: that of the ship file (0 if it states none). Without
        any depth in the data the clearance is not checked.
    network : SiteNetworkOptions

    Raises
    ------
    InputError
        For a clearance out of range.
    """

    load: Position
    unload: Position
    min_ukc: float | None = None
    network: SiteNetworkOptions = field(default_factory=SiteNetworkOptions)

    def __post_init__(self) -> None:
        if self.min_ukc is not None:
            check_clearance("min_ukc_m", self.min_ukc)


@dataclass(frozen=True)
class WorkScope:
    """The volume to move, and the rates of loading and unloading.

    Attributes
    ----------
    volume : float
        Total volume to move [m3].
    hopper : float
        Volume of a full load [m3].
    loading, unloading : LoadingCurve
    load_factors : tuple of float
        Shares of a full load to choose from, ascending, 0 to 1.
    """

    volume: float
    hopper: float
    loading: LoadingCurve
    unloading: LoadingCurve
    load_factors: tuple[float, ...]


@dataclass(frozen=True)
class BaseCase:
    """The project without optimisation: one charted route, with waits for its shallowest place.

    Attributes
    ----------
    route : tuple of (lat, lon)
        From the loading site to the unloading site [deg].
    load_factor : float or "best"
        The same load in all cycles but the last, which takes the smallest listed one that holds
        what is left, or in each cycle the one with the highest production.
    """

    route: tuple[Position, ...]
    load_factor: float | str = 1.0
