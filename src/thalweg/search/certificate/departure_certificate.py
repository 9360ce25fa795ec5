"""The certificate of a stretch that may depart at any moment of a window."""

from __future__ import annotations

import heapq
import itertools
import time as clock
from dataclasses import dataclass, replace
from typing import Final

from thalweg.search.certificate.barrier_check_cost import seconds_a_cell
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.time_certificate import (
    BarrierSearch,
    TimeCertificate,
    certify_time,
    first_cells,
    free_space_time,
    usual_rate,
)

_SHORTEST_PIECE: Final = 0.01  # of the known time: pieces of the window are not divided further
_SPLIT_FIRST: Final = 900.0  # pieces this long or longer [s] are divided before their mesh is


def certify_departures(
    stretch: StretchToBound, *, seconds: float, target: float = 0.005
) -> TimeCertificate:
    """Bound the time of every route of a stretch from below, whenever it departs.

    The window is divided where its bound is least: a barrier for a piece of the window rises no
    faster than the conditions of any departure in that piece allow.

    Parameters
    ----------
    stretch : With or without a window of departures.
    seconds : Time that the search for a bound may take [s]; 0 for that of the geodesic alone.
    target : Gap [fraction of the known time] at which the search ends.

    Returns
    -------
    TimeCertificate : The least bound of all pieces of the window; that of the geodesic near a pole
        and across half of the globe.
    """
    if stretch.departures <= 0.0:
        return certify_time(stretch, seconds=seconds, target=target)
    began = clock.perf_counter()
    rate = usual_rate(stretch)
    domain = BarrierDomain.around(stretch, first_cells(seconds, rate))
    if domain is None:
        return certify_time(stretch, seconds=seconds)
    free = free_space_time(stretch, domain, seconds=seconds)
    if seconds > 0.0:
        rate = seconds_a_cell(stretch, domain)
    cells = first_cells(seconds, rate)
    enough = (1.0 - target) * stretch.known
    order = itertools.count()
    pieces = [(free.value, next(order), _Piece.of(stretch, domain, (cells, rate), free))]
    while seconds > 0.0 and pieces[0][0] < enough:
        piece = pieces[0][2]
        left = seconds - (clock.perf_counter() - began)
        parts = piece.halves() if piece.is_divisible else [piece]
        if sum(part.search.expected_seconds for part in parts) > left:
            break
        heapq.heappop(pieces)
        for part in parts:
            part.improve()
            heapq.heappush(pieces, (part.best.value, next(order), part))
    worst = pieces[0][2].best
    reached = max(one.best.reached for _, _, one in pieces) if len(pieces) == 1 else worst.reached
    return replace(worst, reached=reached, seconds=clock.perf_counter() - began)


@dataclass(eq=False)
class _Piece:
    """A part of the window with the search for its barrier.

    Attributes
    ----------
    detail : Cells and rate of the search.
    """

    stretch: StretchToBound
    domain: BarrierDomain
    detail: tuple[int, float]
    search: BarrierSearch
    best: TimeCertificate

    @classmethod
    def of(
        cls,
        stretch: StretchToBound,
        domain: BarrierDomain,
        detail: tuple[int, float],
        best: TimeCertificate,
    ) -> _Piece:
        return cls(stretch, domain, detail, BarrierSearch(stretch, domain, *detail), best)

    @property
    def is_divisible(self) -> bool:
        span = self.stretch.departures
        if span <= _SHORTEST_PIECE * self.stretch.known:
            return False
        return span >= _SPLIT_FIRST or self.best.cells > 0

    def halves(self) -> list[_Piece]:
        first = self.stretch.depart
        middle = first + 0.5 * self.stretch.departures
        early = replace(self.stretch, latest=middle)
        late = replace(self.stretch, depart=middle)
        later = self.domain.from_departure(middle - first)
        return [
            _Piece.of(early, self.domain, self.detail, self.best),
            _Piece.of(late, later, self.detail, self.best),
        ]

    def improve(self) -> None:
        found = self.search.refine()
        if found is not None and found.value > self.best.value:
            self.best = found
