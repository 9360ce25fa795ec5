"""Fields of decoded files, cut to a box and joined over time."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.core.bounding_box import EDGE_TOLERANCE, BoundingBox
from thalweg.core.errors import DatasetError
from thalweg.core.file_writing import replacing_file
from thalweg.sea.files.grib import open_grib

_BATCH: Final = 64_000_000  #: [bytes] of GRIB decoded at a time


def read_grib_files(files: list[Path], box: BoundingBox) -> list[Any]:
    """Return the fields of GRIB files, one dataset per grid.

    Returns
    -------
    list of xarray.Dataset
        With ``time``, ``latitude`` (ascending) and ``longitude`` (from the west of the box).
    """
    pieces: list[Any] = []
    with tempfile.TemporaryDirectory(prefix="thalweg-fetch-") as folder:
        joined = Path(folder) / "batch.grib2"
        for batch in _batches(files):
            with replacing_file(joined) as stream:
                for path in batch:
                    with path.open("rb") as part:
                        shutil.copyfileobj(part, stream)
            pieces += [cut_to_box(part, box).load() for part in open_grib(joined)]
    return join_pieces(pieces)


def _batches(files: Iterable[Path]) -> Iterator[list[Path]]:
    batch: list[Path] = []
    size = 0
    for path in files:
        batch.append(path)
        size += path.stat().st_size
        if size > _BATCH:
            yield batch
            batch, size = [], 0
    if batch:
        yield batch


def longitude_spans(box: BoundingBox) -> list[tuple[float, float]]:
    """Return west and east of a box [deg] from -180 to 180; two pairs across the antimeridian."""
    west = (box.west + 180.0) % 360.0 - 180.0
    east = west + box.width
    return [(west, min(east, 180.0))] + ([(-180.0, east - 360.0)] if east > 180.0 else [])


def cut_to_box(dataset: Any, box: BoundingBox) -> Any:
    """Return the part of a dataset in a box, with the cells that hold its edges.

    Parameters
    ----------
    dataset : With ``latitude`` and ``longitude`` as axes, and ``valid_time`` or ``time``.

    Returns
    -------
    xarray.Dataset
        With ``time`` as an axis; longitudes ascend from the west of the box and may exceed 180.

    Raises
    ------
    DatasetError
        If the fields are not on axes of latitude and longitude, or the box holds none of them.
    """
    if not {"latitude", "longitude"} <= set(dataset.dims):
        raise DatasetError(
            "The fields that arrived are not on axes of latitude and longitude.",
            "Global and regional grids with such axes can be cut to a box.",
            "Choose another source.",
        )
    if "valid_time" in dataset.coords:
        stale = [n for n in ("time", "step") if n in dataset.coords and n not in dataset.dims]
        dataset = dataset.drop_vars(stale).rename(valid_time="time")
    if "time" not in dataset.dims:
        dataset = dataset.expand_dims("time")
    kept = {"time", "latitude", "longitude", "number"}
    dataset = dataset.drop_vars([name for name in dataset.coords if name not in kept])
    lat, lon = (np.asarray(dataset[name].values, float) for name in ("latitude", "longitude"))
    rows = _rows(lat, box)
    columns, turned = _columns(lon, box)
    if not rows.size or not columns.size:
        raise DatasetError(
            "The fields that arrived do not reach the box.",
            f"They cover {lat.min():g} to {lat.max():g} N, {lon.min():g} to {lon.max():g} E.",
            "Choose another box or source.",
        )
    cut = dataset.isel(latitude=rows, longitude=columns)
    return cut.assign_coords(longitude=turned)


def _rows(lat: np.ndarray, box: BoundingBox) -> np.ndarray:
    order = np.argsort(lat)
    first = np.searchsorted(lat[order], box.south + EDGE_TOLERANCE, side="right") - 1
    last = np.searchsorted(lat[order], box.north - EDGE_TOLERANCE, side="left")
    if last < 0 or first >= len(lat):
        return np.empty(0, int)
    return np.asarray(order[max(first, 0) : last + 1])


def _columns(lon: np.ndarray, box: BoundingBox) -> tuple[np.ndarray, np.ndarray]:
    """Return the columns in a box from its west, and their longitudes without a jump."""
    spacing = float(np.median(np.abs(np.diff(lon)))) if len(lon) > 1 else 0.0
    west = box.west - spacing + EDGE_TOLERANCE
    offset = (lon - west) % 360.0
    width = min(box.width + 2.0 * (spacing - EDGE_TOLERANCE), 360.0 - 1e-9)
    inside = np.flatnonzero(offset <= width)
    inside = inside[np.argsort(offset[inside])]
    _, unique = np.unique(np.round(offset[inside], 6), return_index=True)
    inside = inside[unique]
    return inside, np.round(west + offset[inside], 6)


def join_pieces(pieces: list[Any]) -> list[Any]:
    """Return datasets of the same grid joined over variables and times.

    Parameters
    ----------
    pieces : Results of `cut_to_box`.

    Returns
    -------
    list of xarray.Dataset : One per grid; times ascend.
    """
    import xarray as xr

    grids: dict[tuple[Any, ...], dict[str, list[Any]]] = {}
    for piece in pieces:
        axes = tuple(tuple(np.round(piece[n].values, 6)) for n in ("latitude", "longitude"))
        fields = grids.setdefault(axes, {})
        for name in piece.data_vars:
            fields.setdefault(str(name), []).append(piece[name].to_dataset(name=str(name)))
    joined = []
    for fields in grids.values():
        whole = [
            xr.concat(parts, "time", coords="minimal", compat="override", join="outer")
            .sortby("time")
            .drop_duplicates("time")
            for parts in fields.values()
        ]
        joined.append(xr.merge(whole, join="outer", compat="override"))
    return joined
