"""What an evaluator of tracks needs of the ship, and how finely it divides tracks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from thalweg.core.limits import Limits
from thalweg.kernels.leg.table_lookup import TableArrays

if TYPE_CHECKING:
    from thalweg.ship import PerformanceTable


_ZONE_RESOLUTION = 25.0  # to which crossings of the borders of control areas are found [m]


@dataclass(frozen=True, eq=False)
class TabulatedShip:
    """Tables of a ship and the limits along its route.

    Attributes
    ----------
    table, fuel : PerformanceTable or TableArrays
        Speed through water [m/s] and fuel rate [kg/s].
    limits : Limits
        Limits along the route (`thalweg.core.limits.Limits`).
    """

    table: PerformanceTable | TableArrays
    fuel: PerformanceTable | TableArrays
    limits: Limits


@dataclass(frozen=True)
class EvaluationResolution:
    """How finely an evaluator divides tracks.

    Attributes
    ----------
    spacing : float, optional
        Longest piece that legs are cut into [m]; by default half a cell of the raster, at least a
        400th of ``total`` and at most 100 km.
    total : float
        Rough length of the tracks [m].
    zone_resolution : float
        To which crossings of the borders of control areas are found [m].
    """

    spacing: float | None = None
    total: float = 0.0
    zone_resolution: float = _ZONE_RESOLUTION
