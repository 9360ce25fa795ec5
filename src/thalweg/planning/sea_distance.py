"""Distances by sea between ports or positions, with approaches and canals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from thalweg.planning.network_selection.distance_cache import DistanceQuestion
from thalweg.planning.network_selection.sea_distance_data import (
    DEFAULT_OFFING_NM as DEFAULT_OFFING_NM,
)
from thalweg.planning.network_selection.sea_distance_data import SMALL_CANALS as SMALL_CANALS
from thalweg.planning.network_selection.sea_distance_data import DistanceRequest
from thalweg.planning.network_selection.sea_distance_data import SeaDistance as SeaDistance

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.planning.voyage_parts import Place
    from thalweg.ship import Ship


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
    request = DistanceRequest(start, goal, via, avoid, open, offing_nm, draught_m)
    question = DistanceQuestion.of("shortest", request)
    kept = question.answer() if chart is None and ship is None else None
    if kept is not None and kept.way is not None:
        return kept.way
    from thalweg.planning.network_selection.distance_search import shortest_distance  # slow to load

    way = shortest_distance(request, ship, chart)
    if chart is None and ship is None:
        question.keep(way)
    return way


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
    request = DistanceRequest(start, goal, (), avoid, (), offing_nm, draught_m)
    question = DistanceQuestion.of("by small passages", request)
    kept = question.answer() if chart is None else None
    if kept is not None:
        return kept.way
    from thalweg.planning.network_selection.distance_search import distance_by_small_passages

    found = distance_by_small_passages(way, request, chart)
    if chart is None:
        question.keep(found)
    return found
