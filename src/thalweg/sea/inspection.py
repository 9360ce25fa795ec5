"""What a sea knows about its files: recognised, ignored, covered, missing."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.time import format_time
from thalweg.sea.coverage import Coverage

if TYPE_CHECKING:
    from thalweg.sea.grids.gridded_layer import GridLayer
    from thalweg.sea.sea import Sea

SAMPLED_LEVELS = 8  #: levels looked at for the share of missing values


@dataclass(frozen=True)
class RecognisedVariable:
    """A canonical variable and what it is made from.

    Attributes
    ----------
    variable : str
        Canonical name.
    file_variables : tuple of str
        Names in the file.
    units : str
        As the file spells them.
    how : str
        How it was recognised and converted.
    source : str
        File names.
    """

    variable: str
    file_variables: tuple[str, ...]
    units: str
    how: str
    source: str


@dataclass(frozen=True)
class DataGap:
    """A stretch of time for which a file has no data between data.

    Attributes
    ----------
    source : str
        File names.
    after, before : float
        Last time before and first time after [s since epoch].
    """

    source: str
    after: float
    before: float


@dataclass(frozen=True)
class Inspection:
    """What was recognised in the data behind a sea.

    Attributes
    ----------
    recognised : tuple of Recognised
        Variables that are used.
    ignored : tuple of (file, variable, reason)
        Variables that are not.
    coverage : tuple of Coverage
        Where and when each variable is known.
    missing : mapping of str to float
        Share of grid places without a value (land, ice, gaps), by source and variable, from up
        to 8 times spread over the period.
    gaps : tuple of Gap
        Holes in time axes, which are not bridged.
    members : int
        Size of the ensemble, of which the first member is shown; 0 if it is one sea.
    """

    recognised: tuple[RecognisedVariable, ...]
    ignored: tuple[tuple[str, str, str], ...]
    coverage: tuple[Coverage, ...]
    missing: dict[str, float]
    gaps: tuple[DataGap, ...]
    members: int = 0

    def as_dict(self) -> dict[str, Any]:
        """Return plain data, ready for JSON; times as ISO 8601."""
        plain: dict[str, Any] = {
            "recognised": [asdict(r) for r in self.recognised],
            "ignored": [{"source": s, "variable": v, "reason": r} for s, v, r in self.ignored],
            "coverage": [asdict(c) for c in self.coverage],
            "missing_fraction": dict(self.missing),
            "gaps": [asdict(g) for g in self.gaps],
            "members": self.members,
        }
        for row in plain["coverage"]:
            row["start"], row["end"] = (_time_text(row[k]) for k in ("start", "end"))
        for row in plain["gaps"]:
            row["after"], row["before"] = (_time_text(row[k]) for k in ("after", "before"))
        return plain


def _time_text(time: float | None) -> str | None:
    return None if time is None else format_time(time)


def inspect_sea(sea: Sea) -> Inspection:
    """Return what is known about the data behind a sea; reads a few levels of every file."""
    from thalweg.sea.grids.gridded_layer import GridLayer

    one = sea.member(0) if sea.members else sea
    layers = [layer for layer in one.layers if isinstance(layer, GridLayer)]
    missing: dict[str, float] = {}
    for layer in layers:
        for name, share in _missing_fractions(layer).items():
            missing[f"{layer.source}: {name}"] = share
    ignored = dict.fromkeys(row for layer in layers for row in layer.record.ignored)
    return Inspection(
        tuple(r for layer in layers for r in layer.record.recognised),
        tuple(ignored),
        tuple(one.coverage()),
        missing,
        data_gaps(one),
        sea.members,
    )


def data_gaps(sea: Sea) -> tuple[DataGap, ...]:
    """Return the stretches of time for which files have no data between data."""
    from thalweg.sea.grids.gridded_layer import GridLayer

    return tuple(
        gap for layer in sea.layers if isinstance(layer, GridLayer) for gap in _layer_gaps(layer)
    )


def _layer_gaps(layer: GridLayer) -> list[DataGap]:
    times = layer.axis.times
    return [
        DataGap(layer.source, float(times[k]), float(times[k + 1]))
        for k in np.flatnonzero(layer.axis.holes)
    ]


def _missing_fractions(layer: GridLayer) -> dict[str, float]:
    from thalweg.sea.files.block_cache import GridWindow

    rows, columns = layer.grid.shape
    count = max(1, layer.axis.times.size)
    levels = np.unique(np.linspace(0, count - 1, SAMPLED_LEVELS).round().astype(int))
    shares: dict[str, list[float]] = {}
    for level in levels:
        window = GridWindow(int(level), int(level) + 1, 0, rows, 0, columns)
        for quantity in layer.quantities:
            for name, values in quantity.read(window, columns).items():
                shares.setdefault(name, []).append(float(np.isnan(values).mean()))
    return {name: float(np.mean(share)) for name, share in shares.items()}
