"""Waters and countries that insurers list for war, piracy and terrorism.

The table is ``data/war_risk_areas.csv``, one row an area with its outline, or a country, whose
ports count. It follows the Listed Areas of the Joint War Committee (London) as they were in
December 2023 (JWLA-032). The list changes several times a year: routes are not planned by it, a
plan states what it meets.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import shapely
from numpy.typing import ArrayLike

from thalweg.chart.passages import read_line
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position
from thalweg.core.types import BoolArray

LIST: Final = "JWLA-032 of the Joint War Committee, December 2023"  #: that the table follows


@dataclass(frozen=True)
class WarRiskArea:
    """Listed water, or a country whose ports are listed.

    Attributes
    ----------
    country_code : ISO 3166 code of a country; empty for an area.
    outline : Corners (lat, lon) of an area [deg]; its edges are straight in degrees.
    """

    name: str
    country_code: str
    outline: tuple[Position, ...]
    source: str

    def contains(self, lat: ArrayLike, lon: ArrayLike) -> BoolArray:
        """Return which positions [deg] lie inside the area; none of a country."""
        if not self.outline:
            return np.zeros(np.shape(lat), bool)
        polygon = shapely.Polygon([(x, y) for y, x in self.outline])
        return np.asarray(shapely.contains_xy(polygon, np.asarray(lon), np.asarray(lat)))


def _read_war_risk_areas() -> tuple[WarRiskArea, ...]:
    return tuple(
        WarRiskArea(
            row["name"],
            row["country_code"],
            read_line(row["outline"]) if row["outline"] else (),
            row["source"],
        )
        for row in table_rows("thalweg.chart", "war_risk_areas.csv")
    )


WAR_RISK_AREAS: Final = _read_war_risk_areas()  #: of `thalweg/chart/data/war_risk_areas.csv`
