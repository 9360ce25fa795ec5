"""The sea frozen on a raster around tracks, for refinement in open water."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.types import FloatArray

if TYPE_CHECKING:
    from thalweg.sea import GridFields, Sea

_USUAL_CELLS: Final = 120  # along the longer side, where the data are no finer


@dataclass(frozen=True)
class RasterSize:
    """Bounds of the size of a raster.

    Attributes
    ----------
    margin : Margin on all sides, as a fraction of the longer side of the box of the tracks.
    min_cells, max_cells : Least and greatest number of cells along the longer side of that box.
    largest : Greatest number of values in the raster.
    """

    margin: float
    min_cells: int
    max_cells: int
    largest: int


def freeze_raster(
    sea: Sea,
    lat: FloatArray,
    lon: FloatArray,
    period: tuple[float, float],
    channels: Sequence[int],
    size: RasterSize,
    *,
    extra: Mapping[int, Callable[..., Any]] | None = None,
) -> GridFields:
    """Freeze the sea on a raster around positions, as fine as the data or a size limit allows.

    Parameters
    ----------
    lat, lon : Positions [deg]; longitudes without jumps.
    period : First and last time [s since 1970-01-01T00:00Z].
    channels : Channels to freeze (see `thalweg.kernels.codes`).
    extra : Further channels, as in `Sea.freeze_grid`.
    """
    extent = max(float(np.ptp(lat)), float(np.ptp(lon)), 1e-5)
    margin = size.margin * extent
    south, north = max(lat.min() - margin, -89.9), min(lat.max() + margin, 89.9)
    width = min(np.ptp(lon) + 2.0 * margin, 359.0)
    west = 0.5 * (lon.min() + lon.max() - width)
    numbers = max(len(sea.times(*period)), 2) * max(len(channels) + bool(extra), 1)
    least = math.sqrt((north - south) * width * numbers / size.largest)
    native = [row.spacing_deg for row in sea.coverage() if row.spacing_deg]
    spacing = max(min([extent / _USUAL_CELLS, *native]), least, extent / size.max_cells)
    spacing = min(spacing, extent / size.min_cells)
    area = BoundingBox(south, north, west, west + width)
    return sea.freeze_grid(area, *period, channels, spacing_deg=spacing, extra=extra)
