"""A box of latitudes and longitudes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import to_number
from thalweg.core.types import BoolArray, FloatArray

EDGE_TOLERANCE: Final = 2e-5  #: [deg] a position this far outside counts as inside (float32 axes)


@dataclass(frozen=True)
class BoundingBox:
    """A box of latitudes and longitudes, from west to east.

    Attributes
    ----------
    south, north : float
        Latitudes [deg], ``south <= north``.
    west, east : float
        Longitudes [deg]. A box across the antimeridian has an ``east`` below ``west`` or above 180.
    """

    south: float
    north: float
    west: float
    east: float

    @classmethod
    def checked(cls, south: float, north: float, west: float, east: float) -> BoundingBox:
        """Return the box of four values that a user gave.

        Parameters
        ----------
        south, north : float
            Latitudes [deg], -90 to 90; numbers, or text that is a number.
        west, east : float
            Longitudes [deg]; an ``east`` below ``west`` spans the antimeridian.

        Returns
        -------
        BoundingBox
            The box.

        Raises
        ------
        InputError
            If a value is not finite, a latitude is beyond 90 degrees, south is above north, or
            west equals east.
        """
        values = south, north, west, east = (
            to_number(south),
            to_number(north),
            to_number(west),
            to_number(east),
        )
        swapped = south > north or abs(south) > 90 or abs(north) > 90
        if not all(np.isfinite(values)) or swapped or west == east:
            raise InputError(
                f"The area south {south:g}, north {north:g}, west {west:g}, east {east:g} "
                "is not a valid box.",
                "South is below north, both are within 90 degrees, and west differs from east.",
                "Give south, north, west, east in degrees, in that order.",
                value=values,
            )
        return cls(*values)

    @property
    def width(self) -> float:
        """Degrees of longitude from west to east, 0 to 360."""
        width = self.east - self.west
        return width % 360.0 if abs(width) < 360.0 else 360.0

    def array(self) -> FloatArray:
        """Return the box in the form that kernels take.

        Returns
        -------
        float64 array (4,)
            South, north, west and width [deg].
        """
        return np.array([self.south, self.north, self.west, self.width])

    def covers(
        self, lat: FloatArray, lon: FloatArray, tolerance: float = EDGE_TOLERANCE
    ) -> BoolArray:
        """Return whether positions are in the box or on its edge.

        Parameters
        ----------
        lat, lon : float64 array (N,)
            Positions [deg]; longitudes of any turn.
        tolerance : float
            How far outside a position may be [deg].

        Returns
        -------
        bool array (N,)
        """
        inside = (lat >= self.south - tolerance) & (lat <= self.north + tolerance)
        if self.width >= 360.0 - tolerance:
            return inside & np.isfinite(lon)
        offset = (lon - self.west + tolerance) % 360.0
        return inside & (offset <= self.width + 2.0 * tolerance)


WORLD: Final = BoundingBox(-90.0, 90.0, -180.0, 180.0)
