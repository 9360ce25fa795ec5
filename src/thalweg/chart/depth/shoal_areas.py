"""Named shoal areas whose shallow patches the depth layer of the package misses.

The table is ``data/shoal_areas.csv``, one row an area: name, depth that counts in it, outline,
source, and "yes" where the outline is exact. Outlines whose source says "unchecked" are from
general knowledge and were not compared with a publication. They are for planning, not for
navigation.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position


@dataclass(frozen=True)
class ShoalArea:
    """A named shoal area.

    Parameters
    ----------
    depth : Depth that counts where the layer has more [m].
    outline : tuple of (lat, lon)
        Corners [deg]; edges are straight in degrees.
    is_exact : bool
        Whether the outline holds within a quarter of a mile: then the area stays closed beside
        channels of passages and round ports, too.
    """

    name: str
    depth: float
    outline: tuple[Position, ...]
    source: str = ""
    is_exact: bool = False

    @property
    def dries(self) -> bool:
        """Whether it has no water for any ship: reefs, drying sands, wind farms, oil fields."""
        return self.depth <= 0.0

    @cached_property
    def polygon(self) -> Any:
        """The area as a shapely polygon of longitude and latitude."""
        import shapely

        return shapely.Polygon([(lon, lat) for lat, lon in self.outline])

    def contains(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return which positions [deg] lie inside."""
        import shapely

        return np.asarray(shapely.contains_xy(self.polygon, np.asarray(lon), np.asarray(lat)))


def _read_shoal_areas() -> tuple[ShoalArea, ...]:
    areas = []
    for row in table_rows("thalweg.chart", "shoal_areas.csv"):
        points = [point.split(",") for point in row["outline"].split()]
        outline = tuple((float(lat), float(lon)) for lat, lon in points)
        is_exact = row["exact"] == "yes"
        areas.append(
            ShoalArea(row["name"], float(row["depth_m"]), outline, row["source"], is_exact)
        )
    return tuple(areas)


SHOAL_AREAS: Final = _read_shoal_areas()  #: the areas of `thalweg/chart/data/shoal_areas.csv`
