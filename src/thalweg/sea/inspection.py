"""A report on the files of a sea: variables recognised and ignored, coverage, missing data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.time import format_time
from thalweg.sea.coverage import Coverage
from thalweg.sea.doubtful_values import doubts_of_values, guesses_of_files
from thalweg.sea.ensemble_layer import member_count, select_member
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.source_variables import GridWindow
from thalweg.sea.layer import Layer
from thalweg.sea.recognition_record import RecognisedVariable

SAMPLED_TIMES = 8  #: times of a large file that are read
_ALL_TIMES = 4_000_000  # values of a variable up to which all times are read
_MOST_VALUES = 20_000  # of each variable and time that are judged for a warning


@dataclass(frozen=True)
class DataGap:
    """A period without data between two times with data.

    Attributes
    ----------
    source : File names.
    after, before : Last time before and first time after the gap [s since epoch].
    """

    source: str
    after: float
    before: float


@dataclass(frozen=True)
class Inspection:
    """The report on the data of a sea.

    Attributes
    ----------
    recognised : Variables that are used.
    ignored : tuple of (file, variable, reason)
        Variables that are not used.
    coverage : Where and when each variable is known.
    missing : Fraction of grid points without a value (land, ice, gaps), 0 to 1, by source and
        variable, measured at the times that were read.
    ranges : mapping of str to (float, float)
        Least and greatest value [SI] at these times, by source and variable.
    times_read : mapping of str to (int, int)
        How many times were read, and how many there are, by source: all of a small file, 8 spread
        over the period of a large one.
    gaps : Gaps in time axes; values are not interpolated across them.
    warnings : Values that look like those of another unit; units and times that are not stated.
    members : Size of the ensemble, of which the first member is reported; 0 for a single sea.
    """

    recognised: tuple[RecognisedVariable, ...]
    ignored: tuple[tuple[str, str, str], ...]
    coverage: tuple[Coverage, ...]
    missing: dict[str, float]
    ranges: dict[str, tuple[float, float]]
    times_read: dict[str, tuple[int, int]]
    gaps: tuple[DataGap, ...]
    warnings: tuple[str, ...] = ()
    members: int = 0

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON; times as ISO 8601."""
        plain: dict[str, Any] = {
            "recognised": [asdict(r) for r in self.recognised],
            "ignored": [{"source": s, "variable": v, "reason": r} for s, v, r in self.ignored],
            "coverage": [asdict(c) for c in self.coverage],
            "missing_fraction": dict(self.missing),
            "ranges": {name: list(pair) for name, pair in self.ranges.items()},
            "times_read": {name: list(pair) for name, pair in self.times_read.items()},
            "gaps": [asdict(g) for g in self.gaps],
            "warnings": list(self.warnings),
            "members": self.members,
        }
        for row in plain["coverage"]:
            row["start"], row["end"] = (_time_text(row[k]) for k in ("start", "end"))
        for row in plain["gaps"]:
            row["after"], row["before"] = (_time_text(row[k]) for k in ("after", "before"))
        return plain


def _time_text(time: float | None) -> str | None:
    return None if time is None else format_time(time)


def inspect_layers(layers: Sequence[Layer]) -> Inspection:
    """Return the variables recognised and ignored in the files, coverage, missing data and gaps.

    Files are read at all times where they are small, else at a few. Of an ensemble, the first
    member is reported.

    Returns
    -------
    Inspection
        The report.
    """
    members = member_count(layers)
    single = select_member(layers, 0) if members else tuple(layers)
    gridded = [layer for layer in single if isinstance(layer, GridLayer)]
    missing: dict[str, float] = {}
    ranges: dict[str, tuple[float, float]] = {}
    known = frozenset[str]().union(*(layer.variables for layer in gridded))
    warnings = list(guesses_of_files(gridded, known))
    for layer in gridded:
        found, some = _value_ranges(layer)
        warnings += [f"{layer.source}: {text}" for text in doubts_of_values(some)]
        for name, (share, low, high) in found.items():
            missing[f"{layer.source}: {name}"] = share
            if low <= high:
                ranges[f"{layer.source}: {name}"] = (low, high)
    ignored = dict.fromkeys(row for layer in gridded for row in layer.record.ignored)
    return Inspection(
        tuple(r for layer in gridded for r in layer.record.recognised),
        tuple(ignored),
        tuple(row for layer in single for row in layer.coverage()),
        missing,
        ranges,
        {layer.source: (len(_levels(layer)), max(1, layer.axis.times.size)) for layer in gridded},
        data_gaps(single),
        tuple(warnings),
        members,
    )


def data_gaps(layers: Sequence[Layer]) -> tuple[DataGap, ...]:
    """Return the gaps in the time axes of the layers that were read from files.

    Parameters
    ----------
    layers : The layers of a sea.
    """
    return tuple(
        DataGap(layer.source, float(layer.axis.times[k]), float(layer.axis.times[k + 1]))
        for layer in layers
        if isinstance(layer, GridLayer)
        for k in np.flatnonzero(layer.axis.gaps)
    )


def _levels(layer: GridLayer) -> NDArray[np.int64]:
    """Return the numbers of the times of a layer that are read."""
    rows, columns = layer.grid.shape
    count = max(1, layer.axis.times.size)
    if count * rows * columns <= _ALL_TIMES:
        return np.arange(count)
    return np.unique(np.linspace(0, count - 1, SAMPLED_TIMES).round().astype(np.int64))


def _value_ranges(
    layer: GridLayer,
) -> tuple[dict[str, tuple[float, float, float]], dict[str, NDArray[Any]]]:
    """Return the fraction of grid points without a value and the range, and some values."""
    rows, columns = layer.grid.shape
    levels = _levels(layer)
    ranges: dict[str, list[tuple[float, float, float]]] = {}
    some: dict[str, list[NDArray[Any]]] = {}
    for level in levels:
        window = GridWindow(int(level), int(level) + 1, 0, rows, 0, columns)
        for quantity in layer.quantities:
            for name, values in quantity.read(window, columns).items():
                low, high = np.nanmin(values, initial=np.inf), np.nanmax(values, initial=-np.inf)
                share = float(np.isnan(values).mean())
                ranges.setdefault(name, []).append((share, float(low), float(high)))
                stride = 1 + values.size * len(levels) // (SAMPLED_TIMES * _MOST_VALUES)
                some.setdefault(name, []).append(values.reshape(-1)[::stride].copy())
    found = {
        name: (float(np.mean(shares)), min(lows), max(highs))
        for name, values in ranges.items()
        for shares, lows, highs in [tuple(zip(*values))]
    }
    return found, {name: np.concatenate(parts) for name, parts in some.items()}
