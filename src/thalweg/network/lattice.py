"""The lattice builder: square in a conformal frame, finer near coasts, as large as it must be."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import Position
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.directions import half_offsets, largest_gap
from thalweg.network.draft import Draft, make_draft, nearest_reached, reached_sides
from thalweg.network.endpoints import check_ends
from thalweg.network.frame import Frame, great_circle_frame, mercator_frame, unit_vectors
from thalweg.network.levels import Ground, TooManyPoints
from thalweg.network.network import FloatArray, IntArray, Network, NetworkMeta
from thalweg.network.region import Box, Corridor, Region

if TYPE_CHECKING:
    from thalweg.chart import Chart

_FINEST_COAST = 1.5 * NAUTICAL_MILE
_BUDGET = 60_000
_HARD_BUDGET = 6_000_000
_GROWTH = 1.6
_MOST_EXTRA = 2
_WORTH_REFINING = 0.45  # of the budget: a level more would go beyond it again

_Offsets: TypeAlias = tuple[IntArray, IntArray]


@dataclass(frozen=True)
class _Wish:
    """What the caller asked for; spacing and coast levels may be coarsened when not given."""

    chart: Chart
    start: Position
    goal: Position
    spacing: float
    coast_levels: int
    orientation: str
    area: Box | None
    budget: int


def lattice(
    chart: Chart,
    start: Position,
    goal: Position,
    *,
    spacing: float | None = None,
    directions: int = 32,
    orientation: str = "great_circle",
    coast_levels: int | None = None,
    area: Box | None = None,
    slack: float | None = None,
) -> Network:
    """Build a lattice between two positions, with the positions themselves as nodes.

    Parameters
    ----------
    chart : Chart
        Land, zones and depth.
    start, goal : (lat, lon)
        Exact positions [deg] on navigable water.
    spacing : float, optional
        Largest distance between neighbouring nodes [m]; by default a hundredth of the distance,
        between 100 m and 30 nautical miles, coarsened when the lattice would grow too large.
    directions : int, optional
        8, 16, 32, 48, 80 or 96 directions leave a node; the way over the lattice is then at most
        8.2, 2.7, 1.31, 0.75, 0.49 or 0.34 % longer than the shortest way in open water.
    orientation : str, optional
        ``"great_circle"``: rows along the great circle from start to goal. ``"latlon"``: rows and
        columns along parallels and meridians.
    coast_levels : int, optional
        How often the spacing is halved towards coasts; by default until 1.5 nautical miles.
    area : (south, north, west, east), optional
        Box [deg] to stay in.
    slack : float, optional
        Nodes are kept when the shortest way start-node-goal is at most ``1 + slack`` times the
        shortest way from start to goal; by default 1 under 100 nautical miles falling to 0.35
        over 1000. ``math.inf`` keeps every node within the area or on the globe.

    Returns
    -------
    Network
        ``meta.start`` and ``meta.goal`` are the nodes at the exact positions.

    Raises
    ------
    InputError
        For values out of range, start or goal not on navigable water, or both the same.
    NoRouteError
        If start and goal do not connect however large and fine the lattice is made.
    """
    start, goal = check_ends(chart, start, goal)
    di, dj = half_offsets(directions)
    distance = float(geodesy.distance(*start, *goal))
    _check(spacing, coast_levels, orientation, slack)
    wish = _wish(chart, start, goal, distance, spacing, coast_levels, orientation, area)
    slack = _default_slack(distance) if slack is None else slack
    ground, draft, notes = _connected(wish, (di, dj), distance, slack)
    meta = NetworkMeta(
        kind=f"lattice/{orientation}",
        spacing_m=ground.frame.largest_unit * ground.step(0),
        directions=directions,
        gap_rad=largest_gap(di, dj),
        notes=tuple(notes),
    )
    return draft.network(chart, ground.frame, di, dj, meta)


def default_spacing(distance: float) -> float:
    """Return the spacing [m] used for a distance [m] when none is asked for."""
    return min(max(distance / 100.0, 100.0), 30.0 * NAUTICAL_MILE)


def _default_slack(distance: float) -> float:
    decades = math.log10(max(distance / NAUTICAL_MILE, 1.0) / 100.0)
    return 1.0 - 0.65 * min(max(decades, 0.0), 1.0)


def _check(
    spacing: float | None, coast_levels: int | None, orientation: str, slack: float | None
) -> None:
    if spacing is not None and not (math.isfinite(spacing) and spacing >= 1.0):
        raise InputError(
            f"A lattice cannot have a spacing of {spacing!r} m.", "At least 1 m.", "Give metres."
        )
    if coast_levels is not None and not 0 <= coast_levels <= 10:
        raise InputError(
            f"A lattice cannot have {coast_levels!r} coast levels.", "0 to 10.", "Give fewer."
        )
    if orientation not in ("great_circle", "latlon"):
        raise InputError(
            f"A lattice has no orientation {orientation!r}.",
            "Possible: great_circle, latlon.",
            "Choose one of these.",
        )
    if slack is not None and not slack >= 0.0:
        raise InputError(f"A slack of {slack!r} makes no sense.", "0 or more.", "Give 0.35, say.")


def _wish(
    chart: Chart, start: Position, goal: Position, distance: float, spacing: float | None,
    coast_levels: int | None, orientation: str, area: Box | None,
) -> _Wish:  # fmt: skip
    asked = spacing is not None or coast_levels is not None
    own = default_spacing(distance) if spacing is None else min(spacing, distance)
    if coast_levels is None:
        finest = min(max(own / 8.0, 250.0), _FINEST_COAST)
        coast_levels = min(max(round(math.log2(own / finest)), 0), 6)
    budget = _HARD_BUDGET if asked else _BUDGET
    return _Wish(chart, start, goal, own, coast_levels, orientation, area, budget)


def _connected(
    wish: _Wish, offsets: _Offsets, distance: float, slack: float
) -> tuple[Ground, Draft, list[str]]:
    """Grow and refine until start and goal connect and the slack fits; return the last lattice."""
    factor, extra = 1.01 * (1.0 + slack), 0
    while True:
        ground, draft, notes = _drawn(wish, offsets, factor * distance, extra)
        to_start, to_goal = draft.distances()
        length = to_start[draft.goal]
        whole = ground.region.global_
        if math.isfinite(length):
            needed = (1.0 + slack) * float(length) / distance
            if whole or needed <= 1.005 * factor:
                return _refined(wish, offsets, (ground, draft, notes), slack, extra)
            factor = 1.01 * needed
            continue
        start_side, goal_side = reached_sides(ground, draft, to_start, to_goal)
        if start_side and goal_side and not whole:
            factor *= _GROWTH
        elif extra < _MOST_EXTRA:
            extra += 1
        else:
            raise _no_route(wish, draft, to_start)


def _refined(
    wish: _Wish,
    offsets: _Offsets,
    coarse: tuple[Ground, Draft, list[str]],
    slack: float,
    extra: int,
) -> tuple[Ground, Draft, list[str]]:
    """Prune; draw a lattice that had to be coarse again, finer, along the ways it found."""
    ground, draft, notes = coarse
    draft = _pruned(ground, draft, slack)
    if not notes or draft.stations.n_nodes > _WORTH_REFINING * ground.budget:
        return ground, draft, notes
    corridor = Corridor.around(
        ground.frame, ground.step(0), unit_vectors(draft.stations.lat, draft.stations.lon)
    )
    finer = _drawn(wish, offsets, ground.region.limit, extra, corridor)
    if not math.isfinite(finer[1].distances()[0][finer[1].goal]):
        return ground, draft, notes
    return finer[0], _pruned(finer[0], finer[1], slack), finer[2]


def _drawn(
    wish: _Wish, offsets: _Offsets, limit: float, extra: int, corridor: Corridor | None = None
) -> tuple[Ground, Draft, list[str]]:
    """Draw the lattice for a region, coarsening it while it is over its budget."""
    region = Region(wish.start, wish.goal, limit, wish.area, _box(wish.chart), corridor)
    spacing, coast, ends = wish.spacing, wish.coast_levels + max(extra - 1, 0), 2 * extra
    budget = wish.budget * (1 + 2 * extra)
    notes: list[str] = []
    while True:
        frame = _frame(wish, region, spacing).refined(coast + ends)
        ground = Ground(wish.chart, frame, region, coast, ends, budget)
        try:
            return ground, make_draft(ground, *offsets, wish.start, wish.goal), notes
        except TooManyPoints as refusal:
            _refuse_if_asked(wish, refusal)
            if 1 < refusal.level <= coast:
                coast = refusal.level - 1
            else:
                spacing *= 2.0 if refusal.level == 0 and region.global_ else 1.4
                coast = max(coast, 1)
            notes = [
                f"coarsened to {spacing / NAUTICAL_MILE:.3g} nm and {coast} coast levels "
                f"to keep to {budget} nodes"
            ]


def _refuse_if_asked(wish: _Wish, refusal: TooManyPoints) -> None:
    if wish.budget >= _HARD_BUDGET:
        raise InputError(
            f"A lattice {wish.spacing:.0f} m apart would have over {refusal.count} nodes.",
            f"At most {_HARD_BUDGET} nodes are built.",
            "Give a larger spacing, fewer coast levels or a smaller area.",
        ) from None


def _box(chart: Chart) -> Box | None:
    """Return the chart's area as a box, None for the whole world."""
    area = chart.area
    if area.width >= 360.0 and area.south <= -89.0 and area.north >= 89.0:
        return None
    return area.south, area.north, area.west, area.west + area.width


def _frame(wish: _Wish, region: Region, spacing: float) -> Frame:
    if wish.orientation == "great_circle" and not region.global_:
        return great_circle_frame(wish.start, wish.goal, spacing)
    middle = 0.5 * (wish.start[0] + wish.goal[0])
    closed = region.global_ and wish.area is None and region.chart_area is None
    return mercator_frame(wish.start, spacing, latitude=0.0 if closed else middle, closed=closed)


def _pruned(ground: Ground, draft: Draft, slack: float) -> Draft:
    """Drop the nodes that no reasonable way passes."""
    to_start, to_goal = draft.distances()
    limit = (1.0 + slack) * to_start[draft.goal] + 4.0 * ground.frame.largest_unit * ground.step(0)
    total = to_start + to_goal
    return draft.where(np.isfinite(total) & (total <= limit))


def _no_route(wish: _Wish, draft: Draft, to_start: FloatArray) -> NoRouteError:
    nearest = nearest_reached(draft, to_start)
    away = float(geodesy.distance(*nearest, *wish.goal)) / NAUTICAL_MILE
    names = [geodesy.format_position(*place) for place in (wish.start, wish.goal, nearest)]
    return NoRouteError(
        f"There is no way by water from {names[0]} to {names[1]} on this chart.",
        f"The way ends at {names[2]}, {away:.1f} nm from the goal.",
        "Choose another start or goal, a finer chart, or a finer spacing.",
        reasons=draft.rejected,
        nearest=nearest,
    )
