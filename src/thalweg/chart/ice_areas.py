"""Sea areas with the months in which ice is usual.

The table is ``data/ice_areas.csv``, one row an area: name, first and last month, outline, source,
and kind: ice, or icebergs. Months and outlines are typical, from the general knowledge of pilots;
winters differ. Those of the Southern Ocean are approximate, drawn by hand after the median edges of
sea ice of the National Snow and Ice Data Center (NSIDC): areas of one name lie inside each other,
with ice in more months the further south. Routes are not planned by the table: a plan states that a
route reaches such water. Ice in the data is better.
"""

from __future__ import annotations

import calendar
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart.passages import read_line
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position


@dataclass(frozen=True)
class IceArea:
    """A sea area and its usual months of ice.

    Parameters
    ----------
    first, last : int
        First and last month with ice, 1 to 12; the last is before the first where the season
        contains a new year.
    outline : tuple of (lat, lon)
        Corners [deg]; edges are straight in degrees.
    kind : str
        "ice" or "icebergs".
    """

    name: str
    first: int
    last: int
    outline: tuple[Position, ...]
    source: str = ""
    kind: str = "ice"

    @cached_property
    def months(self) -> tuple[int, ...]:
        """The months with ice, 1 to 12."""
        count = (self.last - self.first) % 12 + 1
        return tuple((self.first - 1 + k) % 12 + 1 for k in range(count))

    @property
    def season(self) -> str:
        """The months as text: "from December to May"."""
        if len(self.months) == 12:
            return "in all months"
        return f"from {calendar.month_name[self.first]} to {calendar.month_name[self.last]}"

    def contains(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return which positions [deg] lie inside."""
        import shapely

        polygon = shapely.Polygon([(x, y) for y, x in self.outline])
        return np.asarray(shapely.contains_xy(polygon, np.asarray(lon), np.asarray(lat)))


def _read_ice_areas() -> tuple[IceArea, ...]:
    areas = []
    for row in table_rows("thalweg.chart", "ice_areas.csv"):
        first, last = (int(month) for month in row["months"].split("-"))
        outline = read_line(row["outline"])
        areas.append(IceArea(row["name"], first, last, outline, row["source"], row["kind"]))
    return tuple(areas)


ICE_AREAS: Final = _read_ice_areas()  #: the areas of `thalweg/chart/data/ice_areas.csv`
