"""The search for the shortest way by sea between two places, and what its notes state."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.canal_parts import first_legs_of_transits, part_number_of_legs
from thalweg.chart.offing import check_offing
from thalweg.chart.passage_crossings import names_passed
from thalweg.chart.passages import find_passages
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import Position, distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.ice_limits import ICE_LATITUDES
from thalweg.planning.network_selection.closed_to_draught import closed_to_draught_notes
from thalweg.planning.network_selection.closed_to_size import closed_to_size_notes
from thalweg.planning.network_selection.closed_ways import closed_way_error
from thalweg.planning.network_selection.sea_distance_data import (
    SMALL_CANALS,
    DistanceRequest,
    SeaDistance,
)
from thalweg.planning.network_selection.seas_of_distance import opened_names, seas_and_every
from thalweg.planning.network_selection.southern_limit import southern_limit
from thalweg.planning.network_selection.way_choice import with_chosen_ways, without_small_ways
from thalweg.planning.network_selection.way_over_seas import way_over_seas
from thalweg.planning.report.approach_report import (
    approach_limit_notes,
    port_depth_note,
    too_small_passages,
    turn_back_notes,
    unknown_depth_text,
)
from thalweg.planning.report.distance_report import (
    avoided_on_approach_notes,
    roundabout_notes,
    shoal_detour_notes,
    shoal_notes,
)
from thalweg.planning.report.ice_report import ice_notes_of_way, way_left_out_notes
from thalweg.planning.report.zone_report import war_risk_notes
from thalweg.planning.request.voyage_endpoints import Endpoint, resolve_places
from thalweg.planning.seaways import (
    path_length_and_canals,
    small_passages,
    world_chart,
)

if TYPE_CHECKING:
    from thalweg.ship import Ship

_LEAST_SHORTER: Final = 0.05  # share by which a way is clearly shorter
_LEAST_OVER_GRAPH: Final = 0.02  # the same for ways over the graph, which are not as exact
_SHORT_WAY: Final = 500.0 * NAUTICAL_MILE  # small passages may shorten it wherever they are
_NEAR_END: Final = 150.0 * NAUTICAL_MILE  # else they are so near an end ...
_NEAR_DIRECT: Final = 1.02  # ... or their detour from the direct line is at most this


def shortest_distance(
    request: DistanceRequest, ship: Ship | None, chart: Chart | None
) -> SeaDistance:
    """Return the shortest way: see `thalweg.planning.sea_distance.sea_distance`."""
    chart = world_chart() if chart is None else chart
    check_offing(request.offing_nm)
    joins = request.offing_nm != 0.0
    ends = resolve_places(request.start, request.vias, request.goal, chart, joins=joins)
    sizes: dict[str, float | None] = {"draught": None}
    asked = request.names_to_avoid
    closed = SMALL_CANALS if request.avoid is None else asked
    opened = opened_names(chart, request.open)
    if ship is not None:
        from thalweg.planning.request.coverage_check import check_ship_type
        from thalweg.planning.request.offing_choice import ship_dimensions  # loads ship files
        from thalweg.planning.request.size_closures import closed_and_open

        check_ship_type(ship)
        sizes = ship_dimensions(ship)
        of_ship = closed_and_open(ship, chart, SMALL_CANALS)
        in_spite = {one.name for one in find_passages(opened)}
        closed = (*asked, *(name for name in of_ship.closed if name not in in_spite))
        opened = opened or opened_names(chart, of_ship.opened)
    if request.draught_m is not None:
        sizes["draught"] = request.draught_m
    ends = without_small_ways(ends, sizes)
    offing = request.offing_nm * NAUTICAL_MILE
    found = [_way_over_seas(chart, ends, closed, opened, offing, sizes)]
    if opened:  # never longer than without: the graph with these passages is another one
        with contextlib.suppress(NoRouteError):
            found.append(_way_over_seas(chart, ends, closed, (), offing, sizes))
    return min(found, key=lambda way: way.length)


def _way_over_seas(
    chart: Chart,
    ends: Sequence[Endpoint],
    closed: Sequence[str],
    opened: Sequence[str],
    offing: float,
    sizes: Mapping[str, float | None],
) -> SeaDistance:
    """Return the shortest way with some passages open; offing and sizes of the ship [m]."""
    draught = sizes["draught"]
    seas, every = seas_and_every(chart, ends, closed, opened, draught)
    south, far_south = southern_limit(ends, lambda: seas, ICE_LATITUDES[0])
    seas = replace(seas, south=south) if far_south else seas
    try:
        way = way_over_seas(seas, ends, draught=draught, offing=offing)
    except NoRouteError as error:
        chosen = with_chosen_ways(ends, lambda: seas, draught=draught or 0.0)
        own = {"length": 0.0, **{name: size for name, size in sizes.items() if size is not None}}
        named = closed_way_error(seas, chosen, own, opens="air_draught" in sizes)
        raise named or error from None
    notes = (*(end.note for end in way.ends if end.note), *far_south)
    texts = []
    for one in way.approaches:
        if draught is not None:
            texts.append(port_depth_note(one, draught) or unknown_depth_text(one, draught).strip())
        texts += approach_limit_notes(chart, one, sizes)
    notes += tuple(dict.fromkeys(filter(None, texts)))
    names = ends[0].name, ends[-1].name
    if not way.at_sea:  # the approaches meet
        between = " to ".join(approach.port.label for approach in way.approaches)
        titles = _canals_entered(chart, way.line)
        return SeaDistance(
            *names, way.length, titles, (), ((between, way.length),), way.line, notes
        )
    notes += shoal_notes(seas, way.at_sea, draught)
    shut: tuple[str, ...] = ()
    if draught is not None:
        too_deep = seas.closed_names - every.closed_names
        shut = closed_to_draught_notes(seas, too_deep, ends, way, draught=draught, offing=offing)
        length = way.length - sum(approach.length for approach in way.approaches)
        notes += shut + shoal_detour_notes(seas, way.ends, offing=offing, length=length)
        if "air_draught" in sizes:
            notes += closed_to_size_notes(seas, sizes, ends, way, offing=offing)
    notes += seas.near_land_notes(way.at_sea, way.ends, offing=offing)
    if any(approach.through for approach in way.approaches):
        canals = _canals_entered(chart, way.line)
    else:
        canals = path_length_and_canals(chart, way.at_sea)[1]
    lat, lon = np.array(way.line, float).T
    straits = names_passed(chart.coastline, chart.passages, lat, lon)
    own_note = {one.name for one in too_small_passages(chart, sizes)}
    straits_to_use = [name for name in straits if name not in own_note]
    notes += avoided_on_approach_notes(every, straits_to_use, way.approaches)
    first, last = way.ends[0].approach, way.ends[-1].approach
    joints = [len(first.line) - 1] if first else []
    joints += [len(way.line) - len(last.line)] if last else []
    notes += (*turn_back_notes(lat, lon, joints), *ice_notes_of_way(way.line))
    notes += tuple(war_risk_notes(lat, lon))
    notes += way_left_out_notes(way.line[0], way.line[-1], way.length) if not shut else ()
    notes += () if shut else roundabout_notes(way.line, way.length)
    approaches = tuple((a.label, a.length) for a in way.approaches)
    return SeaDistance(*names, way.length, canals, straits, approaches, way.line, notes)


def distance_by_small_passages(
    way: SeaDistance, request: DistanceRequest, chart: Chart | None
) -> SeaDistance | None:
    """Return the way by passages for small or local ships where it is clearly shorter.

    See `thalweg.planning.sea_distance.small_ship_distance`.
    """
    chart = world_chart() if chart is None else chart
    if not _may_be_shorter(way, chart):
        return None
    closed = request.names_to_avoid
    joins = request.offing_nm != 0.0
    ends = resolve_places(request.start, (), request.goal, chart, joins=joins)
    opened = opened_names(chart, ("all",))
    usual, more = (
        seas_and_every(chart, ends, closed, o, request.draught_m)[0] for o in ((), opened)
    )
    over_graph = partial(way_over_seas, ends=ends, draught=request.draught_m, offing=None)
    if over_graph(more).length > (1.0 - _LEAST_OVER_GRAPH) * over_graph(usual).length:
        return None
    sizes = {"draught": request.draught_m}
    small = _way_over_seas(chart, ends, closed, opened, request.offing_nm * NAUTICAL_MILE, sizes)
    return small if small.length <= (1.0 - _LEAST_SHORTER) * way.length else None


def _may_be_shorter(way: SeaDistance, chart: Chart) -> bool:
    """Return whether a passage for small or local ships lies where it may shorten a way."""
    if len(way.line) < 2:
        return False
    ends = np.array([way.line[0], way.line[-1]])
    direct = float(distance(*ends[0], *ends[1]))
    for name in small_passages(chart):
        place = next(p.line[len(p.line) // 2] for p in chart.passages if p.name == name)
        parts = np.asarray(distance(ends[:, 0], ends[:, 1], *place))
        near = way.length <= _SHORT_WAY or parts.min() <= _NEAR_END
        near = near or parts.sum() <= _NEAR_DIRECT * direct
        if name in way.straits or not near:
            continue
        if parts.sum() < (1.0 - _LEAST_SHORTER) * way.length:
            return True
    return False


def _canals_entered(chart: Chart, line: Sequence[Position]) -> tuple[str, ...]:
    """Return the titles of the canals of a whole way, with those that are entered on the way."""
    lat, lon = np.array(line, float).T
    part = part_number_of_legs(chart.canals, lat, lon)
    whole = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    number = np.where(first_legs_of_transits(part), part, whole)
    return tuple(chart.canals[k].title for k in number[number >= 0].tolist())
