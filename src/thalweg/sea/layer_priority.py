"""Reading layers by priority: each only where those before it knew nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.sea.layer import Layer, Samples

LayerReader = Callable[[Layer, Sequence[str], Any], Samples]


def point_reader(time: FloatArray, lat: FloatArray, lon: FloatArray) -> LayerReader:
    """Return what reads some of the given points from a layer."""

    def read(layer: Layer, names: Sequence[str], rows: Any) -> Samples:
        pick = slice(None) if rows is None else rows
        return layer.sample(names, time[pick], lat[pick], lon[pick])

    return read


def series_reader(times: FloatArray, lat: FloatArray, lon: FloatArray) -> LayerReader:
    """Return what reads some of the given stations, at all times, from a layer."""

    def read(layer: Layer, names: Sequence[str], rows: Any) -> Samples:
        pick = slice(None) if rows is None else rows
        return layer.series(names, times, lat[pick], lon[pick])

    return read


def _unknown_rows(names: Sequence[str], merged: Samples) -> Any:
    """Return the rows where some of the variables are still unknown; None for all rows."""
    if not names or any(name not in merged for name in names):
        return None
    unknown = np.zeros(merged[names[0]].shape, bool)
    for name in names:
        unknown |= np.isnan(merged[name])
    return np.flatnonzero(unknown if unknown.ndim == 1 else unknown.any(axis=1))


def _fill_unknown(merged: Samples, found: Samples, rows: Any) -> None:
    """Put what was found where nothing was known; vectors go as pairs, being NaN as pairs."""
    for name, value in found.items():
        if name not in merged:
            merged[name] = value
            continue
        pick = slice(None) if rows is None else rows
        old = merged[name] = np.array(merged[name])
        old[pick] = np.where(np.isnan(old[pick]), value, old[pick])


def merge_layers(
    layers: Sequence[Layer], names: Sequence[str], read: LayerReader, shape: tuple[int, ...]
) -> Samples:
    """Return the variables, each value from the first layer that knows it; NaN if none does."""
    found: Samples = {}
    for layer in layers:
        have = [n for n in names if n in layer.variables]
        rows = _unknown_rows(have, found)
        if have and (rows is None or rows.size):
            _fill_unknown(found, read(layer, have, rows), rows)
    for name in names:
        found.setdefault(name, np.full(shape, np.nan))
    return found


def period_edges(period: tuple[float, float] | None, start: float, end: float) -> FloatArray:
    """Return times just outside a layer's period, where another layer takes over."""
    if period is None:
        return np.empty(0)
    edges = np.array([period[0] - 1.0, period[1] + 1.0])
    return edges[(edges > start) & (edges < end)]
