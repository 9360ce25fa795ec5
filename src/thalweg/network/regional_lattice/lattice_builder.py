"""The lattice builder: square in a conformal projection, finer near coasts, as large as needed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoPathError, NoRouteError
from thalweg.core.geodesy import Position
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.conformal_projection import (
    conformal_unit_vectors,
    mercator_projection,
)
from thalweg.network.endpoints import check_endpoints
from thalweg.network.network import Network, NetworkMeta
from thalweg.network.regional_lattice.directions import largest_angle_gap, unique_offsets
from thalweg.network.regional_lattice.lattice_size import (
    MAX_NODE_BUDGET,
    NODE_BUDGET,
    LatticeAttempt,
    LatticeRequest,
    Offsets,
    grow_within_budget,
)
from thalweg.network.regional_lattice.region import LARGEST_LATITUDE, Box, Corridor
from thalweg.network.regional_lattice.unassembled_lattice import (
    UnassembledLattice,
    nearest_reached,
    reached_sides,
)

if TYPE_CHECKING:
    from thalweg.chart import Chart

_FINEST_COAST_SPACING = 1.5 * NAUTICAL_MILE
_OFFING_SPACING = 1.5  # in offings: least default spacing at coasts
_SLACK_GROWTH = 1.8
_MAX_EXTRA_LEVELS = 2
_NEAREST_NODE = 2.0  # spacings within which start and goal are joined to a node


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
    along: Sequence[Position] | None = None,
    width: float | None = None,
    detour: float = math.inf,
    expected: float = 0.0,
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
        8, 16, 32, 48, 80 or 96 directions leave a node; the path over the lattice is then at most
        8.2, 2.7, 1.31, 0.75, 0.49 or 0.34 % longer than the shortest path in open water.
    orientation : str, optional
        ``"great_circle"``: rows along the great circle from start to goal. ``"latlon"``: rows and
        columns along parallels and meridians, up to 84 degrees of latitude. A shortest path that
        passes nearer a pole is replaced by one around that parallel, and the percentages are over
        the length of this one.
    coast_levels : int, optional
        How often the spacing is halved towards coasts; by default until 1.5 nautical miles, or
        1.5 times the offing of the chart.
    area : (south, north, west, east), optional
        Box [deg] to stay in.
    slack : float, optional
        Nodes are used if the shortest path start-node-goal is at most ``1 + slack`` times the
        shortest path from start to goal; by default 1 under 100 nautical miles falling to 0.35
        over 1000. ``math.inf`` uses every node within the area or on the globe.
    along : sequence of (lat, lon), optional
        A path from start to goal [deg], by great circles; only water near it is covered.
    width : float, optional
        Approximate half width of the corridor around that path [m]; by default an eighth
        of its length, from 20 to 300 nautical miles.
    detour : float, optional
        Longest path that is searched, as a multiple of the distance.
    expected : float, optional
        Length of a path that is known [m]: the lattice is as wide as it needs from the start. By
        default it is widened until its own shortest path shows that it is wide enough.

    Returns
    -------
    Network
        ``meta.start`` and ``meta.goal`` are the nodes at the exact positions.

    Raises
    ------
    InputError
        For values out of range, start or goal not on navigable water, or both the same, or beyond
        84 degrees of latitude with rows along parallels.
    NoRouteError
        If start and goal do not connect on the largest and finest lattice, or not by a path within
        ``detour``.
    """
    start, goal = check_endpoints(chart, start, goal)
    di, dj = unique_offsets(directions)
    distance = float(geodesy.distance(*start, *goal))
    _check(spacing, coast_levels, orientation, slack)
    if orientation == "latlon":
        _check_latitudes(start, goal)
    if along is None:
        request = _make_request(
            chart, start, goal, distance, spacing, coast_levels, orientation, area
        )
        slack = _default_slack(distance) if slack is None else slack
        known = min(max(1.0, expected / distance), detour)
        attempt = _grow_until_connected(request, (di, dj), distance, slack, detour, known)
    else:
        lat, lon, length = _densified(along)
        request = _make_request(
            chart, start, goal, length, spacing, coast_levels, orientation, area
        )
        side = min(max(length / 8.0, 20.0 * NAUTICAL_MILE), 300.0 * NAUTICAL_MILE)
        request = replace(
            request, corridor=_corridor_around(lat, lon, side if width is None else width)
        )
        attempt = _lattice_in_corridor(request, (di, dj), lat, lon)
    ground = attempt.ground
    meta = NetworkMeta(
        kind="lattice/latlon" if ground.frame.is_mercator else "lattice/great_circle",
        spacing_m=ground.frame.largest_unit * ground.step(0),
        directions=directions,
        gap_rad=largest_angle_gap(di, dj),
        notes=attempt.notes,
    )
    return attempt.draft.network(chart, ground.frame, di, dj, meta)


def default_spacing(distance: float) -> float:
    """Return the spacing that a lattice has by default: a hundredth of the distance.

    Parameters
    ----------
    distance : float
        From start to goal [m].

    Returns
    -------
    float
        Spacing [m], 100 m to 30 nautical miles.
    """
    return min(max(distance / 100.0, 100.0), 30.0 * NAUTICAL_MILE)


def default_coast_levels(chart: Chart, spacing: float) -> int:
    """Return how often a lattice halves its spacing [m] towards coasts by default."""
    finest = min(max(spacing / 8.0, 250.0), _FINEST_COAST_SPACING)
    finest = max(finest, _OFFING_SPACING * chart.offing.distance)  # no narrow water is left
    return min(max(round(math.log2(spacing / finest)), 0), 6)


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
        raise InputError(
            f"A slack of {slack!r} is not possible.", "It is 0 or more.", "Give 0.35, for example."
        )


def _check_latitudes(start: Position, goal: Position) -> None:
    """Refuse ends that lie nearer a pole than the rows and columns of parallels and meridians."""
    for what, place in (("start", start), ("goal", goal)):
        if abs(place[0]) > LARGEST_LATITUDE:
            raise InputError(
                f"A lattice along parallels does not reach the {what} "
                f"{geodesy.format_position(*place)}.",
                f"It ends at {LARGEST_LATITUDE:g} degrees of latitude.",
                "Choose the orientation great_circle.",
                field="orientation",
                value="latlon",
            )


def _make_request(
    chart: Chart, start: Position, goal: Position, distance: float, spacing: float | None,
    coast_levels: int | None, orientation: str, area: Box | None,
) -> LatticeRequest:  # fmt: skip
    budget = NODE_BUDGET if spacing is None else MAX_NODE_BUDGET
    coast_budget = NODE_BUDGET if coast_levels is None else MAX_NODE_BUDGET
    own = default_spacing(distance) if spacing is None else min(spacing, distance)
    if coast_levels is None:
        coast_levels = default_coast_levels(chart, own)
    return LatticeRequest(
        chart, start, goal, own, coast_levels, orientation, area, budget, coast_budget
    )


def _grow_until_connected(
    request: LatticeRequest,
    offsets: Offsets,
    distance: float,
    slack: float,
    detour: float,
    known: float,
) -> LatticeAttempt:
    """Grow and refine until start and goal connect and the slack fits; return the last lattice.

    ``detour`` and ``known``, of a path that is known, are multiples of the distance.
    """
    factor, extra = 1.01 * (1.0 + slack) * known, 0
    while True:
        attempt = grow_within_budget(request, offsets, factor * distance, extra)
        ground, draft = attempt.ground, attempt.draft
        to_start = draft.distances(draft.start)
        length = to_start[draft.goal]
        whole = ground.region.covers_globe
        near = whole or extra >= _MAX_EXTRA_LEVELS or _ends_are_near(attempt)
        if math.isfinite(length) and not near:
            extra += 1  # paths would pass an end that only distant nodes are joined to
            continue
        if float(length) > detour * distance and (
            math.isfinite(length) or factor > detour * (1.0 + slack)
        ):
            raise _no_route(request, draft, to_start)
        if math.isfinite(length):
            needed = (1.0 + slack) * float(length) / distance
            if whole or needed <= 1.005 * factor:
                return _refine_along_paths(
                    request, offsets, _pruned(attempt, slack, to_start), slack, extra
                )
            factor = 1.01 * needed
            continue
        to_goal = draft.distances(draft.goal)
        start_side, goal_side = reached_sides(ground, draft, to_start, to_goal)
        if start_side and goal_side and not whole:
            factor *= _SLACK_GROWTH
        elif extra < _MAX_EXTRA_LEVELS:
            extra += 1
        else:
            raise _no_route(request, draft, to_start)


def _ends_are_near(attempt: LatticeAttempt) -> bool:
    """Return whether start and goal are joined to nodes as near as the lattice has them."""
    ground, draft = attempt.ground, attempt.draft
    coarse, fine = (ground.frame.largest_unit * ground.step(k) for k in (0, ground.coast_levels))
    pairs = draft.ends
    for node in (draft.start, draft.goal):
        own = (pairs.first == node) | (pairs.second == node)
        place = float(draft.stations.lat[node]), float(draft.stations.lon[node])
        shore = float(ground.chart.coastline.shore_distance(*place))
        usual = min(_NEAREST_NODE * coarse, _NEAREST_NODE * fine + 2.0 * shore)
        if float(pairs.length[own].min(initial=math.inf)) > usual + 1.0:
            return False
    return True


def _densified(path: Sequence[Position]) -> tuple[FloatArray, FloatArray, float]:
    """Return positions [deg] close together along a path, and its length [m]."""
    lat, lon = np.asarray(path, float).T
    legs = geodesy.distance(lat[:-1], lon[:-1], lat[1:], lon[1:])
    part = max(float(legs.sum()) / 2000.0, 500.0)
    pieces = np.maximum(1, np.ceil(legs / part)).astype(int)
    places = [
        geodesy.positions_along(lat[i], lon[i], lat[i + 1], lon[i + 1], np.linspace(0, 1, n + 1))
        for i, n in enumerate(pieces)
    ]
    every = np.concatenate([np.asarray(place) for place in places], axis=1)
    return every[0], every[1], float(legs.sum())


def _corridor_around(lat: FloatArray, lon: FloatArray, width: float) -> Corridor:
    """Return the cells around a path; they reach two and a half cells to each side."""
    highest = float(np.abs(lat).max())
    frame = mercator_projection((lat[0], lon[0]), 0.4 * width, latitude=highest, closed=False)
    return Corridor.around(frame, 1.0, conformal_unit_vectors(lat, lon))


def _lattice_in_corridor(
    request: LatticeRequest, offsets: Offsets, lat: FloatArray, lon: FloatArray
) -> LatticeAttempt:
    """Draw the lattice of a corridor, finer at coasts until it connects."""
    out = geodesy.distance(*request.start, lat, lon) + geodesy.distance(lat, lon, *request.goal)
    limit = 1.1 * float(out.max()) + 10.0 * request.spacing
    for extra in range(_MAX_EXTRA_LEVELS + 1):
        attempt = grow_within_budget(request, offsets, limit, extra, request.corridor)
        to_start = attempt.draft.distances(attempt.draft.start)
        if math.isfinite(to_start[attempt.draft.goal]):
            return _pruned(attempt, math.inf, to_start)
    raise _no_route(request, attempt.draft, to_start)


def _refine_along_paths(
    request: LatticeRequest, offsets: Offsets, coarse: LatticeAttempt, slack: float, extra: int
) -> LatticeAttempt:
    """Build a finer lattice along the paths found on one that had to be coarse."""
    ground, stations = coarse.ground, coarse.draft.stations
    spacing = ground.frame.largest_unit * ground.step(0)
    beyond = coarse.refused > ground.coast_budget and spacing < 1.3 * request.spacing
    if not coarse.notes or beyond:
        return coarse
    corridor = Corridor.around(
        ground.frame, ground.step(0), conformal_unit_vectors(stations.lat, stations.lon)
    )
    finer = grow_within_budget(request, offsets, ground.region.limit, extra, corridor)
    to_start = finer.draft.distances(finer.draft.start)
    if not math.isfinite(to_start[finer.draft.goal]):
        return coarse
    return _pruned(finer, slack, to_start)


def _pruned(attempt: LatticeAttempt, slack: float, to_start: FloatArray) -> LatticeAttempt:
    """Drop the nodes that no path within the slack passes; scale the count of a finer level."""
    ground, draft = attempt.ground, attempt.draft
    total, limit = to_start, math.inf
    if not math.isinf(slack):
        total = to_start + draft.distances(draft.goal)
        limit = (1.0 + slack) * to_start[draft.goal]
        limit += 4.0 * ground.frame.largest_unit * ground.step(0)
    selected = draft.where(np.isfinite(total) & (total <= limit))
    share = selected.stations.n_nodes / draft.stations.n_nodes
    return replace(attempt, draft=selected, refused=int(attempt.refused * share))


def _no_route(
    request: LatticeRequest, draft: UnassembledLattice, to_start: FloatArray
) -> NoRouteError:
    nearest = nearest_reached(draft, to_start)
    separation = float(geodesy.distance(*nearest, *request.goal)) / NAUTICAL_MILE
    names = [geodesy.format_position(*place) for place in (request.start, request.goal, nearest)]
    return NoPathError(
        f"There is no path by water from {names[0]} to {names[1]} on this chart.",
        f"The network reaches {names[2]}, {separation:.1f} nm from the goal.",
        "Choose another start or goal, a finer chart, or a finer spacing.",
        reasons=draft.rejected,
        nearest=nearest,
    )
