"""Cache on disk for tables of ships with a resistance: seconds to build, milliseconds to read."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.array_cache import load_or_make, remove_oldest
from thalweg.core.cache_folder import cache_folder
from thalweg.core.types import FloatArray
from thalweg.ship.tables.output_curve import OUTPUT_CURVE_FIELDS, OutputCurve
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_parts import TableError, TablePart

#: a table (its fingerprint empty), and the greatest value of every setting
TableWithMaxima: TypeAlias = tuple[PerformanceTable, FloatArray]
MAX_FILES: Final = 24
#: The folder of package `ship`.
PACKAGE: Final = Path(__file__).resolve().parents[1]


def cached_table(facts: Any, build: Callable[[], TableWithMaxima]) -> TableWithMaxima:
    """Return a table from disk, or build and store it.

    Parameters
    ----------
    facts : All that the table depends on, except the code of this package.
    build : Makes the table.

    Returns
    -------
    table, top : The same numbers as built.
    """
    text = json.dumps([facts, _source_stamps()], sort_keys=True, default=str)
    name = hashlib.sha256(text.encode()).hexdigest()[:32]
    path = cache_folder("ship-tables") / f"{name}.npz"
    return load_or_make(path, build, pack=_arrays, unpack=_table, clean=_remove_old_tables)


def _source_stamps() -> list[tuple[str, int, int]]:
    """Size and time of the sources and data of package `ship`: changed ones make new tables."""
    files = sorted([*PACKAGE.rglob("*.py"), *PACKAGE.rglob("*.csv")])
    return [(str(f), f.stat().st_size, f.stat().st_mtime_ns) for f in files]


def _table(arrays: Mapping[str, NDArray[Any]]) -> TableWithMaxima:
    parts = []
    for p in range(int(arrays["count"])):
        axes = tuple(int(axis) for axis in arrays[f"axes{p}"])
        grids = tuple(arrays[f"grid{p}_{k}"] for k in range(len(axes)))
        parts.append(
            TablePart(axes, grids, arrays[f"values{p}"], float(arrays["squared_height_limit"][p]))
        )
    mean, p99, largest, samples = arrays["error"]
    error = TableError(float(mean), float(p99), float(largest), int(samples))
    finish = None
    if "finish_points" in arrays:
        curve = (arrays[f"finish_{name}"] for name in OUTPUT_CURVE_FIELDS)
        finish = OutputCurve("crossing" if arrays["falls"] else "curve", *curve)
    return PerformanceTable(tuple(parts), arrays["settings"], "", error, finish), arrays["top"]


def _arrays(kept: TableWithMaxima) -> dict[str, NDArray[Any]]:
    table, top = kept
    parts, error, finish = table.parts, table.error, table.finish
    arrays: dict[str, NDArray[Any]] = {
        "count": np.array(len(parts)),
        "settings": table.settings,
        "squared_height_limit": np.array([part.squared_height_limit for part in parts]),
        "falls": np.array(finish is not None and finish.falls),
        "error": np.array([error.mean, error.p99, error.max, error.samples]),
        "top": top,
    }
    for p, part in enumerate(parts):
        arrays[f"axes{p}"] = np.array(part.axes, np.int64)
        arrays[f"values{p}"] = part.values
        arrays |= {f"grid{p}_{k}": grid for k, grid in enumerate(part.grids)}
    if finish is not None:
        arrays |= {f"finish_{name}": getattr(finish, name) for name in OUTPUT_CURVE_FIELDS}
    return arrays


def _remove_old_tables(folder: Path) -> None:
    remove_oldest(folder.glob("*.npz"), MAX_FILES)
