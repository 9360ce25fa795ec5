"""The options of a globe network: how fine it is, and which part of the globe it covers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from thalweg.core.errors import InputError
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.grid import GridResolution

NORTH_LIMIT: Final = 72.0  #: [deg]
SOUTH_LIMIT: Final = -70.0  #: [deg]
_LARGEST_LEVEL: Final = 8
_FINEST_LEVEL: Final = 14


@dataclass(frozen=True)
class GlobeOptions:
    """How fine a globe network is, and which part of the globe it covers.

    Attributes
    ----------
    level : int
        How often the icosahedron is halved everywhere, 0 to 8: legs are at most 285 nautical miles
        long at level 4, half that for every further level.
    coast_levels : int
        How often faces along coasts are halved beyond that. Narrow passages with names
        (`thalweg.chart.passages`) have nodes of their own.
    border_levels : int
        How often faces along the borders of zones with prices (emission control, penalty and price
        zones) are halved: a route along a border is found only if there are nodes near it.
    directions : {12, 6}
        Legs along the edges of faces (6), or across them as well: paths in open water are then at
        most 5 % longer than the shortest, not 24 %.
    north, south : float
        Nodes beyond these latitudes [deg] are left out: charts contain no ice, and without a limit
        paths lead through the Arctic. The default of 72 N closes the Northwest and Northeast
        Passages and leaves the North Cape open. If start or goal is beyond a limit, the limit is
        moved to 1 degree past it.
    slack : float, optional
        Nodes are used if the shortest path start-node-goal is at most ``1 + slack`` times the
        shortest path from start to goal; by default 1 under 100 nautical miles falling to 0.35 over
        1,000 and 0.15 over 5,000. ``math.inf`` uses the whole sea.
    sample_spacing : float
        Fields are sampled along edges at least this often [m], 1000 or more.

    Raises
    ------
    InputError
        For values out of range.
    """

    level: int = 4
    coast_levels: int = 6
    border_levels: int = 4
    directions: int = 12
    north: float = NORTH_LIMIT
    south: float = SOUTH_LIMIT
    slack: float | None = None
    sample_spacing: float = 60.0 * NAUTICAL_MILE

    def __post_init__(self) -> None:
        self._check_fineness()
        if not -90.0 <= self.south < self.north <= 90.0:
            raise InputError(
                f"The latitude limits {self.south!r} and {self.north!r} are not valid.",
                "The southern limit is below the northern one, both within 90 degrees.",
                "Give degrees north, southern latitudes negative.",
            )
        if self.slack is not None and not self.slack >= 0.0:
            raise InputError(
                f"A slack of {self.slack!r} is not possible.",
                "It is 0 or more.",
                "Give 0.35, for example.",
            )
        if not self.sample_spacing >= 1000.0:
            raise InputError(
                f"Samples {self.sample_spacing!r} m apart are too many.",
                "They are at least 1000 m apart.",
                "Give the spacing in metres.",
            )

    def _check_fineness(self) -> None:
        level, coast, border = self.level, self.coast_levels, self.border_levels
        fine = 0 <= level <= _LARGEST_LEVEL and coast >= 0 and border >= 0
        if not (fine and level + max(coast, border) <= _FINEST_LEVEL):
            raise InputError(
                f"A globe network cannot have level {level!r} with {coast!r} coast levels and "
                f"{border!r} border levels.",
                f"The level is 0 to {_LARGEST_LEVEL}, both together at most {_FINEST_LEVEL}.",
                "Level 4 with 6 coast levels suits ocean passages.",
            )
        if self.directions not in (6, 12):
            raise InputError(
                f"A globe network cannot have {self.directions!r} directions.",
                "Possible: 6, 12.",
                "Choose one of these.",
            )

    @property
    def fineness(self) -> GridResolution:
        """The fineness of the grid, for `thalweg.network.global_grid.grid.globe_grid`."""
        return GridResolution(self.level, self.coast_levels, self.border_levels, self.directions)
