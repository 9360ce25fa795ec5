"""Speeds in blocks that a bridge can order: no setting is held for a few minutes only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.planning.pareto.cheapest_blocks import cheapest_blocks, cheapest_shift
from thalweg.planning.pareto.front_points import essential_nodes
from thalweg.planning.pareto.trade_off_context import (
    RefereedCandidate,
    TradeOffContext,
    scored_candidate,
)
from thalweg.planning.pareto.waiting.wait_screening import WaitScreen
from thalweg.planning.pareto.waiting.waits_of_fronts import with_waits_long_enough
from thalweg.route import Route, Track
from thalweg.route.evaluators.cost_evaluator import CostEvaluator
from thalweg.route.evaluators.polyline import polyline_of_track, track_of_polyline
from thalweg.route.refinement.speed_profile import times_and_costs_by_setting

#: A block is at least this share of the voyage where that is less than the requested duration.
SHARE_OF_PASSAGE = 0.25
_PIECE_SHARE = 0.25  # of a block: the longest piece whose setting is chosen
_CLEARLY_WORSE = 0.02  # share of time or value that blocks add, for which other ones are tried
_ROUNDS = 2  # choices of blocks, each at the times of passage of the one before


def in_speed_blocks(
    trade_off: TradeOffContext,
    scored: list[RefereedCandidate],
    rivals: Sequence[RefereedCandidate] = (),
) -> list[RefereedCandidate]:
    """Return routes whose speed settings last for the requested duration, scored by the referee.

    Parameters
    ----------
    trade_off : Its voyage asks for the least duration of a block (`Voyage.least_speed_block_h`).
    rivals : Other routes that may be the answer, at one speed.

    Returns
    -------
    list of RefereedCandidate : At the cheapest blocks that take no longer, or with short blocks
        merged where these exceed a limit. A route keeps its own speeds where neither keeps every
        limit and the latest arrival. The notes of the trade-off state what the blocks cost.
    """
    context = trade_off.context
    block_duration = context.voyage.least_speed_block_h * HOUR
    if block_duration <= 0.0 or len(trade_off.settings) < 2:
        return scored
    from thalweg.planning.pareto.evolutionary_refinement import evaluator_around_routes

    around = evaluator_around_routes(trade_off, [item.route for item in scored])
    evaluator, screen = CostEvaluator(around, 0.0), WaitScreen(around)
    found = [_blocked(trade_off, item, block_duration, evaluator, screen) for item in scored]
    _note_costs(trade_off, scored, [ways[0] for ways in found], rivals)
    return [one for ways in found for one in ways]


def merged_settings(
    setting: NDArray[np.int64], hours: FloatArray, speeds: FloatArray, least: float, *, late: bool
) -> NDArray[np.int64]:
    """Return the settings of legs with every run that is too short given to a neighbour.

    Parameters
    ----------
    setting : int64 array (legs,)
    hours : Time of sailing of each leg, in any unit, (legs,).
    speeds : Calm-water speeds, ascending, (settings,).
    least : Least time of a run, in the unit of ``hours``.
    late : Whether the voyage may become longer; otherwise short runs are given to the faster
        neighbour.

    Returns
    -------
    int64 array (legs,) : With one setting where the voyage is shorter than two runs.
    """
    setting, time_change = np.array(setting), 0.0
    while True:
        first = np.flatnonzero(np.concatenate([[True], setting[1:] != setting[:-1]]))
        if len(first) == 1:
            return setting
        lasting = np.add.reduceat(hours, first)
        short = int(np.argmin(lasting))
        if lasting[short] >= least * (1.0 - 1e-9):
            return setting
        own = int(setting[first[short]])
        sides = [int(setting[first[i]]) for i in (short - 1, short + 1) if 0 <= i < len(first)]
        changes = [lasting[short] * (speeds[own] / speeds[side] - 1.0) for side in sides]
        cost = [abs(time_change + change) if late else change for change in changes]
        best = int(np.argmin(cost))
        time_change += changes[best]
        stop = first[short + 1] if short + 1 < len(first) else len(setting)
        setting[first[short] : stop] = sides[best]


def _blocked(
    trade_off: TradeOffContext,
    item: RefereedCandidate,
    block_duration: float,
    evaluator: CostEvaluator,
    screen: WaitScreen,
) -> list[RefereedCandidate]:
    """Return a route in blocks, in several ways where these are clearly later or dearer.

    The least change comes first. The same route is returned where none within the limits is found.
    """
    route, context = item.route, trade_off.context
    hours = route.legs["arrive"] - route.legs["depart"]
    least = min(block_duration, SHARE_OF_PASSAGE * float(hours.sum()))
    speeds = np.asarray(context.ship.speeds, float)
    merged = merged_settings(route.track.setting, hours, speeds, least, late=True)
    if np.array_equal(merged, route.track.setting):
        return [item]
    not_late = merged_settings(route.track.setting, hours, speeds, least, late=False)
    found: list[tuple[float, RefereedCandidate]] = []

    def score(track: Track) -> Route:
        return context.evaluate(track, trade_off.objective.terms)

    for track in (
        _in_cheapest_blocks(route, least, evaluator),
        _with_settings(route.track, merged),
        _with_settings(route.track, not_late),
    ):
        if track is None:
            continue
        as_timed = score(track)
        tried = with_waits_long_enough(context, as_timed, score, screen)
        in_time = tried.arrive <= context.latest_arrival + 1.0
        value = trade_off.objective.value(tried)
        if tried.feasible and in_time and np.isfinite(value):
            worse = max(tried.time_h / route.time_h, value / max(item.value, 1e-12))
            found.append((worse, scored_candidate(trade_off, item.candidate, tried, value)))
            if worse < 1.0 + _CLEARLY_WORSE and tried is as_timed:
                break
    return [one for _, one in sorted(found, key=lambda pair: pair[0])] or [item]


def _in_cheapest_blocks(route: Route, least: float, evaluator: CostEvaluator) -> Track | None:
    """Return the track of a route at the cheapest speeds in blocks; None if none is in time.

    The times and costs of its pieces are those at the times of passage of the speeds before.
    """
    line = polyline_of_track(route.track, evaluator)
    available = float((route.legs["arrive"] - route.legs["depart"]).sum())
    longest = _PIECE_SHARE * least * float(route.legs["length"].sum()) / available
    while True:
        finer = line.split(longest, ~evaluator.canal_legs(line.lat, line.lon))
        if len(finer) == len(line):
            break
        line = finer
    for _ in range(_ROUNDS):
        times, costs = times_and_costs_by_setting(line, evaluator)
        setting = cheapest_blocks(times, costs, least, available)
        if setting is None:
            return None
        line = replace(line, setting=setting)
    shift = cheapest_shift(line.setting, times, costs, least, available)
    line = line if shift is None else line.cut(*shift)
    return _with_settings(track_of_polyline(line, evaluator), line.setting)


def _with_settings(track: Track, setting: NDArray[np.int64]) -> Track:
    """Return a track with other settings, without waypoints that no longer change anything."""
    keep = np.flatnonzero(essential_nodes(track.lat, track.lon, setting, track.wait))
    return track.replaced(setting=setting).kept(keep)


def _note_costs(
    trade_off: TradeOffContext,
    before: list[RefereedCandidate],
    after: list[RefereedCandidate],
    rivals: Sequence[RefereedCandidate],
) -> None:
    """Note what the blocks cost against speeds that change at will, arriving no later.

    For a plan of the least value that is what they cost the route of that value alone.
    """
    free = sorted((one.route.time_h, one.value) for one in before)
    time, value = (np.array(column) for column in zip(*free))
    value = np.minimum.accumulate(value)
    changed = [(old, new) for old, new in zip(before, after) if new is not old]
    voyage = trade_off.context.voyage
    if voyage.objective == trade_off.objective.name and not voyage.at_most:
        answer = min((*after, *rivals), key=lambda one: one.value)
        changed = [(old, new) for old, new in changed if new is answer]
    kept = sum(_has_short_blocks(trade_off, one.route) for one in after)
    if not changed and not kept:
        return
    extra = []
    for old, new in changed:  # one that ends earlier is compared at the arrival it was asked for
        least = float(np.interp(new.route.time_h, time, value))
        earlier = new.route.time_h <= old.route.time_h
        extra.append(new.value / (min(old.value, least) if earlier else least) - 1.0)
    hours = trade_off.context.voyage.least_speed_block_h
    note = f"Speeds are ordered in blocks of at least {hours:.3g} h or a quarter of the voyage"
    if extra:
        note += (
            f", which adds up to {100.0 * max(0.0, *extra):.1f} % to the {trade_off.objective.name}"
        )
    if kept:
        note += f"; {kept} of {len(after)} routes keep shorter ones, to stay within the limits"
    trade_off.notes.append(f"{note}.")


def _has_short_blocks(trade_off: TradeOffContext, route: Route) -> bool:
    """Return whether a route holds a setting for less than the requested duration."""
    hours = route.legs["arrive"] - route.legs["depart"]
    block_duration = trade_off.context.voyage.least_speed_block_h * HOUR
    least = min(block_duration, SHARE_OF_PASSAGE * float(hours.sum()))
    speeds = np.asarray(trade_off.context.ship.speeds, float)
    setting = merged_settings(route.track.setting, hours, speeds, least, late=True)
    return not np.array_equal(setting, route.track.setting)
