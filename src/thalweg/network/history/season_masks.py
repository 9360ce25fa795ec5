"""Months in which arcs of a history network are closed, as far as the samples show it."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.errors import names_in_words
from thalweg.core.types import BoolArray, FloatArray, IntArray

MONTHS: Final = 12
_NAMES: Final = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September",
    "October", "November", "December",
)  # fmt: skip
LEAST_SAMPLES: Final = 10  #: a season of an arc with fewer voyages in all is not believed
_FEW: Final = 0.1  # of the voyages expected in a month with even use: so few may be stray
_CHANCE: Final = 0.01  # of seeing so few ships in these months though the arc is open


def open_months(seen: IntArray, voyages: IntArray) -> BoolArray:
    """Return in which months arcs are open.

    With even use an arc with n voyages has ``e = n w`` of them in months with the share w of all
    voyages of its region: so months without any voyage there close no arc. It is closed in
    consecutive months with at most a tenth of e in each, if n is at least `LEAST_SAMPLES` and the
    chance of so few is below 1 % (Poisson with the mean e of all these months together; so e is at
    least 4.6).

    Parameters
    ----------
    seen : Voyages on each arc by month, (A, 12).
    voyages : All voyages by month, (12,), or of the region of each arc, (A, 12).

    Returns
    -------
    bool ndarray (A, 12) : True where the arc is open or nothing is known.
    """
    from scipy.special import pdtr

    total = seen.sum(axis=1, keepdims=True)
    expected = total * voyages / np.maximum(voyages.sum(axis=-1, keepdims=True), 1)
    few = (seen <= _FEW * expected) & (total >= LEAST_SAMPLES)
    chance = pdtr(_sums_of_runs(seen, few), np.maximum(_sums_of_runs(expected, few), 1e-9))
    return np.asarray(~(few & (chance < _CHANCE)) | (np.asarray(voyages) == 0))


def voyages_of_regions(
    ends: tuple[IntArray, IntArray], voyage: IntArray, month_of_voyage: IntArray
) -> IntArray:
    """Return how many voyages there are by month in the region of every node, (N, 12).

    A region has the nodes that tracks join: nothing is known of its seasons from other regions.

    Parameters
    ----------
    ends : Nodes of stretches of tracks, from and to, (m,) each.
    voyage : Their voyages, (m,).
    month_of_voyage : 0 for January, of all voyages.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    tail, head = ends
    count = int(max(tail.max(initial=-1), head.max(initial=-1))) + 1
    joined = coo_array((np.ones(len(tail), np.int8), (tail, head)), shape=(count, count))
    regions, region = connected_components(joined, directed=False)
    known, first = np.unique(voyage, return_index=True)
    found = np.zeros((regions, MONTHS), np.int64)
    np.add.at(found, (region[tail[first]], month_of_voyage[known]), 1)
    return np.asarray(found[region])


def month_notes(seen: BoolArray, month: int | None) -> tuple[str, ...]:
    """Return a note if no voyage was seen in a month.

    Parameters
    ----------
    seen : Whether there are any voyages in each month, (12,).
    month : 1 to 12, or None.
    """
    if month is None or seen[month - 1] or not seen.any():
        return ()
    names = [_NAMES[k] for k in np.flatnonzero(seen).tolist()]
    known = names_in_words(names)
    return (
        f"No voyages were seen in {_NAMES[month - 1]}: the tracks have voyages in {known} only. "
        "All ways that were sailed in any month are taken as open.",
    )


def _sums_of_runs(value: FloatArray | IntArray, inside: BoolArray) -> FloatArray:
    """Return for every month the sum over the run of months that it belongs to, round the year."""
    total = np.zeros(value.shape)
    value = np.where(inside, value, 0.0)
    for step in (1, -1):
        carry = np.zeros(len(value))
        for k in range(2 * MONTHS):
            month = (step * k) % MONTHS
            carry = np.where(inside[:, month], carry + value[:, month], 0.0)
            if k >= MONTHS:
                total[:, month] += carry
    return np.where(inside, total - value, 0.0)
