"""Concatenate files in time: files with one layout that follow each other become one layer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from thalweg.sea.files.grid_detection import GridPlacement
from thalweg.sea.files.layer_candidate import LayerCandidate
from thalweg.sea.files.variable_recognition import IgnoredVariable
from thalweg.sea.grids.block_cache import BlockCache
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.source_variables import Quantity
from thalweg.sea.grids.time_axis import TimeAxis
from thalweg.sea.recognition_record import RecognitionRecord


def join_in_time(
    candidates: Sequence[LayerCandidate], ignored: Mapping[str, list[IgnoredVariable]]
) -> list[GridLayer]:
    """Return layers; files of the same grid and variables that follow in time become one.

    Parameters
    ----------
    candidates : Candidates of all files, in order of priority.
    ignored : Variables that are not used, by file.
    """
    joined: list[list[LayerCandidate]] = []
    for candidate in candidates:
        group = next((g for g in joined if _continues(g, candidate)), None)
        if group is None:
            joined.append([candidate])
        else:
            group.append(candidate)
    return [_joined_layer(sorted(g, key=_first_time), ignored) for g in joined]


def _first_time(candidate: LayerCandidate) -> float:
    return float(candidate.times[0]) if candidate.times.size else 0.0


def _continues(group: list[LayerCandidate], candidate: LayerCandidate) -> bool:
    """Return whether a candidate has the layout of a group and times outside those of the group."""
    first = group[0]
    if candidate.times.size == 0 or first.times.size == 0 or candidate.file is first.file:
        return False
    same = candidate.place.key == first.place.key and _signature(candidate) == _signature(first)
    if not (same and _same_grid(candidate.place, first.place)):
        return False
    return all(d.times[-1] < candidate.times[0] or candidate.times[-1] < d.times[0] for d in group)


def _signature(candidate: LayerCandidate) -> list[tuple[tuple[str, ...], tuple[str, ...]]]:
    return sorted((q.names, tuple(v.name for v in q.variables)) for q in candidate.quantities)


def _same_grid(a: GridPlacement, b: GridPlacement) -> bool:
    own, other = a.grid, b.grid
    return own.shape == other.shape and bool(
        np.array_equal(getattr(own, "lat", 0), getattr(other, "lat", 1), equal_nan=True)
        and np.array_equal(getattr(own, "lon", 0), getattr(other, "lon", 1), equal_nan=True)
    )


def _joined_layer(
    group: list[LayerCandidate], ignored: Mapping[str, list[IgnoredVariable]]
) -> GridLayer:
    first = group[0]
    times = np.concatenate([d.times for d in group])
    source = " + ".join(dict.fromkeys(d.file.source for d in group))
    quantities = first.quantities
    for other in group[1:]:
        quantities = [
            _joined_quantity(q, _quantity_named(other, q.names), source) for q in quantities
        ]
    shape = (max(1, times.size), *first.place.grid.shape)
    record = RecognitionRecord(
        tuple(first.recognised),
        tuple((d.file.source, i.variable, i.reason) for d in group for i in ignored[d.file.source]),
    )
    facts = {"files": [dict(d.file.facts) for d in group]}
    cache = BlockCache(shape, first.place.grid.wraps)
    return GridLayer(
        tuple(quantities), first.place.grid, TimeAxis(times), cache, source, facts, record
    )


def _quantity_named(candidate: LayerCandidate, made: tuple[str, ...]) -> Quantity:
    return next(q for q in candidate.quantities if q.names == made)


def _joined_quantity(a: Quantity, b: Quantity, source: str) -> Quantity:
    """Return a quantity whose variables continue in a later file."""
    variables = tuple(
        replace(v, pieces=(*v.pieces, *w.pieces), source=source) if v.timed else v
        for v, w in zip(a.variables, b.variables)
    )
    return replace(a, variables=variables, source=source)
