"""The size of a lattice: drawn for a region, and coarsened to its budget of nodes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position
from thalweg.core.memory import machine_memory
from thalweg.core.types import IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.conformal_projection import (
    ConformalProjection,
    great_circle_projection,
    mercator_projection,
)
from thalweg.network.regional_lattice.refinement_levels import LatticeSpecification, TooManyPoints
from thalweg.network.regional_lattice.region import Box, Corridor, Region
from thalweg.network.regional_lattice.unassembled_lattice import (
    UnassembledLattice,
    grow_lattice,
)

if TYPE_CHECKING:
    from thalweg.chart import Chart


NODE_BUDGET = 60_000  # default limit of nodes at sea, and the same of nodes at coasts


_BYTES_PER_NODE = 4_400  # measured while building, 32 directions


MAX_NODE_BUDGET = min(6_000_000, int(0.5 * machine_memory() / _BYTES_PER_NODE))


_GLOBAL_SPACING = 80.0 * NAUTICAL_MILE


Offsets: TypeAlias = tuple[IntArray, IntArray]


@dataclass(frozen=True)
class LatticeAttempt:
    """A lattice, notes on its coarsening, and the count of points that exceeded the budget."""

    ground: LatticeSpecification
    draft: UnassembledLattice
    notes: tuple[str, ...]
    refused: int


@dataclass(frozen=True)
class LatticeRequest:
    """The request of the caller; spacing and coast levels may be coarsened when not given."""

    chart: Chart
    start: Position
    goal: Position
    spacing: float
    coast_levels: int
    orientation: str
    area: Box | None
    budget: int
    coast_budget: int
    corridor: Corridor | None = None


def grow_within_budget(
    request: LatticeRequest,
    offsets: Offsets,
    limit: float,
    extra: int,
    corridor: Corridor | None = None,
) -> LatticeAttempt:
    """Draw the lattice for a region, coarsening it while it is over its budget."""
    region = Region(
        request.start, request.goal, limit, request.area, _chart_box(request.chart), corridor
    )
    spacing, coast, ends = request.spacing, request.coast_levels + max(extra - 1, 0), 2 * extra
    notes: tuple[str, ...] = ()
    refused = 0
    if region.unbounded and corridor is None:  # only to find the paths to refine
        spacing, coast = max(spacing, _GLOBAL_SPACING), min(max(coast, 2), 3)
        request = replace(request, budget=NODE_BUDGET, coast_budget=NODE_BUDGET)
        notes = _coarsening_note(spacing, coast)
    most = min(request.coast_budget * (1 + 2 * extra), MAX_NODE_BUDGET)
    may_stop = request.coast_budget < MAX_NODE_BUDGET
    while True:
        frame = _projection(request, region, spacing).refined(coast + ends)
        ground = LatticeSpecification(
            request.chart, frame, region, coast, ends, request.budget, most, may_stop
        )
        try:
            draft = grow_lattice(ground, *offsets, request.start, request.goal)
            if draft.refused:
                notes, refused = _coarsening_note(spacing, len(draft.parts) - 1), draft.refused
            return LatticeAttempt(ground, draft, notes, refused)
        except TooManyPoints as refusal:
            spacing, coast, ends = _coarser(request, region, refusal, (spacing, coast, ends))
            notes, refused = _coarsening_note(spacing, coast), refusal.count


def _coarsening_note(spacing: float, coast: int) -> tuple[str, ...]:
    sizes = f"{spacing / NAUTICAL_MILE:.3g} nm and {coast} coast levels"
    return (f"coarsened to {sizes} to keep the number of nodes in bounds",)


def _coarser(
    request: LatticeRequest, region: Region, refusal: TooManyPoints, sizes: tuple[float, int, int]
) -> tuple[float, int, int]:
    """Return a larger spacing or fewer levels than those (spacing, coast, ends) refused.

    Raises
    ------
    InputError : If the requested spacing or number of levels is too fine.
    """
    spacing, coast, ends = sizes
    level = refusal.level
    if request.coast_budget < MAX_NODE_BUDGET and 1 < level <= coast:
        return spacing, level - 1, ends
    if level > coast and ends > 0:
        return spacing, coast, ends - 1
    if request.budget < MAX_NODE_BUDGET:
        return spacing * (2.0 if level == 0 and region.unbounded else 1.4), max(coast, 1), ends
    if request.coast_budget < MAX_NODE_BUDGET and level > 0:
        return spacing, level - 1, ends
    raise InputError(
        f"A lattice {request.spacing:.0f} m apart would have over {refusal.count:,} nodes and take "
        f"{refusal.count * _BYTES_PER_NODE / 1e9:.1f} GB.",
        f"At most {MAX_NODE_BUDGET:,} nodes are built, in half of the memory of this machine "
        f"({machine_memory() / 1e9:.1f} GB).",
        "Give a larger spacing, fewer coast levels or a smaller area.",
    )


def _chart_box(chart: Chart) -> Box | None:
    """Return the chart's area as a box, None when it goes right round the world."""
    area = chart.area
    if area.width >= 360.0:
        return None
    return area.south, area.north, area.west, area.west + area.width


def _projection(request: LatticeRequest, region: Region, spacing: float) -> ConformalProjection:
    if request.orientation == "great_circle" and not region.covers_globe:
        return great_circle_projection(request.start, request.goal, spacing)
    middle = 0.5 * (request.start[0] + request.goal[0])
    closed = region.unbounded
    return mercator_projection(
        request.start, spacing, latitude=0.0 if closed else middle, closed=closed
    )
