"""The cache on disk of coast indexes: plain arrays in one file."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.coast.coast_index_builder import build_index
from thalweg.chart.coast.gshhg import CLOSED_CANALS, CLOSED_NARROWS, data_files, read_land_rings
from thalweg.chart.coast.islets import islet_rings
from thalweg.core.arrays.array_cache import load_or_make
from thalweg.core.cache_folder import cache_folder
from thalweg.kernels.geometry.cube_sphere import IndexArrays

CACHE_FORMAT: Final = 3  # increase when the arrays or their construction change
CELLS_BY_RESOLUTION: Final = {"c": 256, "l": 512, "i": 512, "h": 1024, "f": 1024}


def gshhg_index(
    resolution: str, *, narrows_closed: bool = True, islets: bool = True
) -> IndexArrays:
    """Return the index of a GSHHG resolution, from disk if it was made before."""
    size = data_files(resolution)[1].stat().st_size
    strips = (CLOSED_CANALS, CLOSED_NARROWS if narrows_closed else {})
    added = islet_rings().fingerprint() if islets and resolution in "ih" else ""
    closed = hashlib.sha256((repr(strips) + added).encode()).hexdigest()[:8]
    side = CELLS_BY_RESOLUTION[resolution]
    rings = partial(read_land_rings, resolution, narrows_closed=narrows_closed, islets=islets)
    path = cache_folder("coast") / f"gshhg-{resolution}-{size}-{side}-{closed}-v{CACHE_FORMAT}.npz"
    return load_or_build(path, lambda: build_index(rings(), side))


def load_or_build(path: Path, make: Callable[[], IndexArrays]) -> IndexArrays:
    """Return the index in a file, or make it and write the file; a broken file is replaced."""
    return load_or_make(path, make, pack=_arrays, unpack=_index)


def _arrays(index: IndexArrays) -> dict[str, NDArray[Any]]:
    return {name: np.asarray(values) for name, values in index._asdict().items()}


def _index(arrays: Mapping[str, NDArray[Any]]) -> IndexArrays:
    named = {name: arrays[name] for name in IndexArrays._fields if name != "side"}
    index = IndexArrays(side=int(arrays["side"]), **named)
    rows, vertices = len(index.winding), len(index.first)
    fits = index.cell.shape == (6 * index.side**2,) and index.start.shape == (rows + 1,)
    if not fits or index.xyz.shape != (vertices, 3) or int(index.start[-1]) != vertices:
        raise ValueError("the arrays do not fit together")
    return index
