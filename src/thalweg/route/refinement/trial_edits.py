"""Which of many edits of the points of tracks to try at once."""

from __future__ import annotations

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray

_STEP_FRACTIONS = (
    1.0,
    0.3,
)  # of the edits with a gain, by descending gain; at last the best edit alone


def isolated_maxima(gain: FloatArray) -> FloatArray:
    """Return the gains (R, M) that exceed those of both neighbours; all others are 0."""
    left, right = np.zeros_like(gain), np.zeros_like(gain)
    left[:, 1:], right[:, :-1] = gain[:, :-1], gain[:, 1:]
    return np.where((gain > 0.0) & (gain > left) & (gain >= right), gain, 0.0)


def trial_subsets(gain: FloatArray) -> list[tuple[BoolArray, IntArray]]:
    """Return trials: (edits (rows, M), rows) with all edits, the best of them, the best one."""
    promising = gain > 0.0
    rows = np.flatnonzero(promising.any(axis=1))
    if not len(rows):
        return []
    order = np.argsort(np.argsort(-gain[rows], axis=1, kind="stable"), axis=1)
    number = promising[rows].sum(axis=1)
    out = []
    for share in _STEP_FRACTIONS:
        out.append((order < np.maximum(1, np.ceil(share * number))[:, None], rows))
    out.append((order < 1, rows))
    return [(chosen & promising[rows], rows) for chosen, rows in out]
