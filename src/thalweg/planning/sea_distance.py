"""Distances by sea between ports or positions, with approaches and canals."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.approaches import MAX_APPROACH_SPEED
from thalweg.chart.canal_parts import first_legs_of_transits, part_number_of_legs
from thalweg.chart.offing import check_offing
from thalweg.chart.passage_crossings import names_passed
from thalweg.chart.passages import find_passages
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import Position, distance
from thalweg.core.given_numbers import is_number, shortened_repr
from thalweg.core.units import DAY, KNOT, NAUTICAL_MILE
from thalweg.network.global_grid.ice_limits import ICE_LATITUDES
from thalweg.planning.network_selection.closed_to_draught import closed_to_draught_notes
from thalweg.planning.network_selection.closed_to_size import closed_to_size_notes
from thalweg.planning.network_selection.closed_ways import closed_way_error
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
from thalweg.planning.request.voyage_endpoints import Endpoint, resolve_places
from thalweg.planning.seaways import (
    path_length_and_canals,
    small_passages,
    world_chart,
)
from thalweg.planning.voyage_parts import Place

if TYPE_CHECKING:
    from thalweg.ship import Ship

#: Canals too small for most ships, which are not used by default.
SMALL_CANALS: Final = ("corinth",)
#: Distance from land that ways keep outside passages, where they can [nm].
DEFAULT_OFFING_NM: Final = 2.0
_LEAST_SHORTER: Final = 0.05  # share by which a way is clearly shorter
_LEAST_OVER_GRAPH: Final = 0.02  # the same for ways over the graph, which are not as exact
_SHORT_WAY: Final = 500.0 * NAUTICAL_MILE  # small passages may shorten it wherever they are
_NEAR_END: Final = 150.0 * NAUTICAL_MILE  # else they are so near an end ...
_NEAR_DIRECT: Final = 1.02  # ... or their detour from the direct line is at most this


@dataclass(frozen=True)
class SeaDistance:
    """The shortest way by sea between two places.

    Attributes
    ----------
    start, goal : str
        Names of the places.
    length : float
        Of the whole way [m].
    canals : tuple of str
        Canals, in order.
    straits : tuple of str
        Named passages and capes whose water the way goes through, in order.
    approaches : tuple of (str, float)
        Name of the port and length of its approach [m], both part of the whole.
    line : tuple of (lat, lon)
        Waypoints [deg].
    notes : tuple of str
        How positions were taken.
    """

    start: str
    goal: str
    length: float
    canals: tuple[str, ...]
    straits: tuple[str, ...]
    approaches: tuple[tuple[str, float], ...]
    line: tuple[Position, ...]
    notes: tuple[str, ...] = ()

    @property
    def nm(self) -> float:
        """Length of the whole way [nautical miles]."""
        return self.length / NAUTICAL_MILE

    def days(self, speed_kn: float) -> float:
        """Return the time at a speed; approaches count at no more than 10 kn.

        Canals are counted at that speed: their transit times depend on convoys and locks.

        Parameters
        ----------
        speed_kn : float
            Speed [kn], above 0 and at most 100.

        Returns
        -------
        float
            Time [days].

        Raises
        ------
        InputError
            If the speed is not above zero.
        """
        if not (is_number(speed_kn) and 0.0 < speed_kn <= 100.0):
            raise InputError(
                f"The speed is {shortened_repr(speed_kn)} kn.",
                "Speeds are above 0 and at most 100 kn.",
                "Give the speed in knots.",
                field="speed_kn",
            )
        near = sum(length for _, length in self.approaches)
        speed = speed_kn * KNOT
        return ((self.length - near) / speed + near / min(speed, MAX_APPROACH_SPEED)) / DAY

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON.

        Returns
        -------
        dict
            Distances [nm], canals, straits, approaches by name, waypoints [deg] and
            notes.
        """
        return {
            "from": self.start,
            "to": self.goal,
            "distance_nm": self.nm,
            "canals": list(self.canals),
            "straits": list(self.straits),
            "approaches_nm": {name: length / NAUTICAL_MILE for name, length in self.approaches},
            "line": [list(place) for place in self.line],
            "notes": list(self.notes),
        }


def sea_distance(
    start: Place,
    goal: Place,
    *,
    via: Sequence[Place] = (),
    avoid: Sequence[str] | None = None,
    open: Sequence[str] = (),
    offing_nm: float = DEFAULT_OFFING_NM,
    draught_m: float | None = None,
    ship: Ship | None = None,
    chart: Chart | None = None,
) -> SeaDistance:
    """Return the shortest way by sea between two ports or positions.

    Parameters
    ----------
    start, goal : (lat, lon) or str
        Places, as those of a `thalweg.Voyage`.
    via : sequence of places
        Places to pass, in this order; ports are passed off their sea ends.
    avoid : sequence of str
        Canals and passages that are not used, such as "suez", "Pentland Firth", or "all" for all
        canals. By default the canal of Corinth, which is 7.2 m deep, unless a ship of known length
        is given; give an empty list to use every canal.
    open : sequence of str
        Passages for small or local ships that may be used, such as "Canso"; "all" for all of them.
        Others are used in spite of the draught.
    offing_nm : float
        Distance from land [nm] that the way keeps outside passages, ends and canals, 0 to 50;
        less only where the graph has no water so far from land.
    draught_m : float, optional
        Draught [m], 0 to 30: canals and passages that are too shallow are closed, and miles in
        water shallower than one and a half draughts count more, as in plans. By default no draught
        closes them, and miles in water shallower than 5 m count more. The graph is coarse near
        shoals: a note states what is left of them.
    ship : Ship, optional
        Her draught counts where ``draught_m`` is not given; canals and passages that are too small
        for her are closed as well, except those in ``open``; passages for small ships are open
        where she is shorter than 120 m; notes say which approaches are too small for her.
    chart : Chart, optional
        By default the GSHHG coastline at resolution "i".

    Returns
    -------
    SeaDistance

    Raises
    ------
    InputError
        For places on land, draughts out of range, unknown ports, and unknown canals and passages.
    NoRouteError
        If there is no way by sea.

    Notes
    -----
    The way is the shortest over a graph of all seas, where water within 2 nautical miles of land
    counts up to half more, after string pulling. Passages for small or local ships are closed.
    Water north of 72 N and south of 60 S is used only by ways that begin or end there, and in the
    open ocean water south of 50 S (round Cape Horn 57.5 S) only by ways that have an end or a via
    point near it; a note states how much longer that makes the way. Traffic rules and weather are
    not considered. The graph is made once (10 to 20 s) and kept in the cache.
    """
    chart = world_chart() if chart is None else chart
    check_offing(offing_nm)
    vias = (via,) if isinstance(via, str) else via
    ends = resolve_places(start, vias, goal, chart, joins=offing_nm != 0.0)
    sizes: dict[str, float | None] = {"draught": None}
    asked = (avoid,) if isinstance(avoid, str) else tuple(avoid or ())
    closed = SMALL_CANALS if avoid is None else asked
    opened = opened_names(chart, open)
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
    if draught_m is not None:
        sizes["draught"] = draught_m
    ends = without_small_ways(ends, sizes)
    offing = offing_nm * NAUTICAL_MILE
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
    notes += way_left_out_notes(way.line[0], way.line[-1], way.length) if not shut else ()
    notes += () if shut else roundabout_notes(way.line, way.length)
    approaches = tuple((a.label, a.length) for a in way.approaches)
    return SeaDistance(*names, way.length, canals, straits, approaches, way.line, notes)


def small_ship_distance(
    way: SeaDistance,
    start: Place,
    goal: Place,
    *,
    avoid: Sequence[str] = SMALL_CANALS,
    offing_nm: float = DEFAULT_OFFING_NM,
    draught_m: float | None = None,
    chart: Chart | None = None,
) -> SeaDistance | None:
    """Return the way by passages for small or local ships where it is 5 % shorter or more.

    Parameters
    ----------
    way : The way without these passages, by `sea_distance` with the same other parameters.
    start, goal, avoid, offing_nm, draught_m, chart : As of `sea_distance`.

    Returns
    -------
    SeaDistance or None : None where it is not so much shorter, and for ways over 500 nm with no
        such passage within 150 nm of an end or near the direct line.
    """
    chart = world_chart() if chart is None else chart
    if not _may_be_shorter(way, chart):
        return None
    closed = (avoid,) if isinstance(avoid, str) else tuple(avoid)
    ends = resolve_places(start, (), goal, chart, joins=offing_nm != 0.0)
    opened = opened_names(chart, ("all",))
    usual, more = (seas_and_every(chart, ends, closed, o, draught_m)[0] for o in ((), opened))
    over_graph = partial(way_over_seas, ends=ends, draught=draught_m, offing=None)
    if over_graph(more).length > (1.0 - _LEAST_OVER_GRAPH) * over_graph(usual).length:
        return None
    sizes = {"draught": draught_m}
    small = _way_over_seas(chart, ends, closed, opened, offing_nm * NAUTICAL_MILE, sizes)
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
