"""The box of a chart, which no leg may leave."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray


@dataclass(frozen=True)
class Area:
    """A box of latitudes and longitudes [deg]; west above east crosses the antimeridian."""

    south: float
    north: float
    west: float
    east: float

    def __post_init__(self) -> None:
        values = (self.south, self.north, self.west, self.east)
        swapped = self.south > self.north or abs(self.south) > 90 or abs(self.north) > 90
        if not all(np.isfinite(values)) or swapped or self.west == self.east:
            raise InputError(
                f"The area south {self.south:g}, north {self.north:g}, west {self.west:g}, "
                f"east {self.east:g} is none.",
                "South lies below north, both within 90 degrees, and west differs from east.",
                "Give south, north, west, east in degrees, in that order.",
                value=values,
            )

    @property
    def width(self) -> float:
        """Degrees of longitude from west to east."""
        width = self.east - self.west
        return width % 360.0 if abs(width) < 360.0 else 360.0

    def array(self) -> FloatArray:
        """South, north, west and width [deg], as kernels take it."""
        return np.array([self.south, self.north, self.west, self.width])


WORLD: Final = Area(-90.0, 90.0, -180.0, 180.0)
