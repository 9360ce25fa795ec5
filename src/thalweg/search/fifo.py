"""FIFO property of edges (a later departure arrives later), with and without waiting."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.types import FloatArray
from thalweg.kernels.leg.edge_sailing import ShipOnEdges
from thalweg.kernels.search.edge_departure import edge_arrivals
from thalweg.search.search_problem import ShipOnNetwork, make_search_problem


@dataclass(frozen=True)
class FifoReport:
    """Violations of the FIFO property by edges when a ship may not wait.

    Attributes
    ----------
    worst : float
        Most time gained by departing later [s]; 0 if all edges are FIFO.
    edge : int
        The edge where that is; -1 if all edges are FIFO.
    share : float
        Share of the edges that violate the FIFO property.
    blocked : float
        Share of the departures at which an edge is blocked.
    """

    worst: float
    edge: int
    share: float
    blocked: float


def earliest_arrivals_with_waiting(
    arrivals: ArrayLike, allowed: ArrayLike | bool = True
) -> FloatArray:
    """Return the earliest arrivals when a ship may wait before it departs.

    Parameters
    ----------
    arrivals : array_like
        Arrival for each sampled departure along the last axis, inf where blocked.
    allowed : array_like of bool
        Whether waiting is allowed from each sample to the next; one shorter along the last axis,
        or one value for all.

    Returns
    -------
    ndarray
        ``A'_i = min(A_i, A'_(i+1))`` where waiting is allowed from i to i + 1, else ``A_i``.

    Notes
    -----
    The suffix minimum that makes edges keep order (van Halem 2019, section 3.4), corrected: a
    series that starts blocked waits for its first opening, and minima at the ends count.
    """
    best = np.array(arrivals, float)
    may = np.broadcast_to(np.asarray(allowed, bool), best[..., 1:].shape)
    for i in range(best.shape[-1] - 2, -1, -1):
        later = np.where(may[..., i], best[..., i + 1], np.inf)
        best[..., i] = np.minimum(best[..., i], later)
    return best


def sampled_arrivals(
    ship_on_network: ShipOnNetwork, *, departures: ArrayLike, edges: ArrayLike | None = None
) -> tuple[FloatArray, NDArray[np.int64]]:
    """Sail edges at many departures without waiting.

    Parameters
    ----------
    ship_on_network : The network, the sea frozen at its stations, and the ship at one setting.
    departures : array_like (D,) [s]
    edges : Edges (default: all), (E,).

    Returns
    -------
    arrivals : [s], (E, D); inf where blocked.
    statuses : Codes of `thalweg.kernels.codes`, (E, D).
    """
    given = make_search_problem(ship_on_network)
    count = len(given.network.target)
    chosen = np.arange(count) if edges is None else np.asarray(edges, np.int64)
    tails = np.searchsorted(given.network.indptr, chosen, side="right") - 1
    when = np.ascontiguousarray(departures, float)
    arrivals = np.empty((len(chosen), len(when)))
    statuses = np.empty((len(chosen), len(when)), np.int64)
    work = np.full((4, len(given.sea.channel_index)), np.nan)
    edge_arrivals(ShipOnEdges(*given[:3]), chosen, tails, when, arrivals, statuses, work)
    return arrivals, statuses


def fifo_report(
    ship_on_network: ShipOnNetwork, *, departures: ArrayLike, edges: ArrayLike | None = None
) -> FifoReport:
    """Measure how far edges break order (a later departure arrives later) at sampled departures.

    Parameters
    ----------
    ship_on_network, departures, edges
        As in `sampled_arrivals`.

    Returns
    -------
    FifoReport
        Largest gain by waiting [s], its edge, and shares of edges and departures.
    """
    arrivals, _ = sampled_arrivals(ship_on_network, departures=departures, edges=edges)
    waited = earliest_arrivals_with_waiting(arrivals)
    open_ = np.isfinite(arrivals)
    gain = np.where(open_, arrivals, 0.0) - np.where(open_, waited, 0.0)
    worst = gain.max(axis=1, initial=0.0)
    breaks = worst > 1e-6
    if not breaks.any():
        return FifoReport(0.0, -1, 0.0, float(np.mean(~open_)))
    i = int(np.argmax(worst))
    edge = i if edges is None else int(np.asarray(edges)[i])
    return FifoReport(float(worst[i]), edge, float(breaks.mean()), float(np.mean(~open_)))
