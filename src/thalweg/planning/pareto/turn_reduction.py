"""Fewer turns of routes whose objective depends on headings in waves, land or other ships."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.network.alternatives.leg_rules import leg_lengths, total_cost
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.planning.pareto.edge_costs import costs_of_water
from thalweg.planning.pareto.evolutionary_refinement import freeze_around_tracks
from thalweg.planning.pareto.trade_off_context import TradeOffContext
from thalweg.route import Route, Track
from thalweg.route.evaluators.cost_evaluator import make_cost_evaluator
from thalweg.route.evaluators.polyline import polyline_of_track, track_of_polyline
from thalweg.route.refinement.turn_removal import without_needless_turns

#: Networks whose nodes have no meaning of their own.
_OPEN_WATER: Final = ("auto", "lattice", "globe")
_ROUNDS: Final = 3  # of string pulling
_SAMPLES: Final = 32  # on each leg
_LENGTH_COUNTS: Final = 0.05  # share of a metre near land, and of the mean cost of a metre
_LEAST_GAIN: Final = 1e-3  # share of the cost that each waypoint must save
_MOST_ADDED: Final = 0.02  # share of the value


def scored_with_fewer_turns(trade_off: TradeOffContext, track: Track, duration: float) -> Route:
    """Return the route of a track without turns that hardly change its objective.

    A path of a network for motion sickness turns to and fro for the heading; one that keeps off
    land or other ships has the directions of the network. Tracks for other objectives, on networks
    of given nodes, by the exact method and by via points stay as they are, and so do those whose
    changed route is not within the limits, later than allowed or, off land, longer or no better.

    Parameters
    ----------
    duration : Of the track [s], as searched.

    Returns
    -------
    Route : Scored by the referee.
    """
    context, prices = trade_off.context, trade_off.objective.prices
    changed, own = track, None
    if may_leave_nodes(trade_off):
        if prices.counts_water:
            own = context.evaluate(track, trade_off.objective.terms)
            changed = _straightened(trade_off, own) if own.feasible else track
        elif prices.counts_dose:
            changed = _without_needless_turns(trade_off, track, duration)
    if changed is not track:
        route = context.evaluate(changed, trade_off.objective.terms)
        in_time = route.arrive <= max(context.latest_arrival, track.depart + duration) + 1.0
        if route.feasible and in_time and not (own and _is_worse(trade_off, route, own)):
            return route
    return own or context.evaluate(track, trade_off.objective.terms)


def may_leave_nodes(trade_off: TradeOffContext) -> bool:
    """Return whether routes may pass beside the nodes of the network.

    Not with the exact method, with via points, and on meshes, history networks and layered networks
    of a given shape, whose nodes have a meaning of their own.
    """
    choice = trade_off.context.choice
    if choice.network == "layered":
        is_open = choice.layered is None or choice.layered.layers is None
    else:
        is_open = choice.network in _OPEN_WATER
    return is_open and not trade_off.via and trade_off.context.voyage.method != "exact"


def _is_worse(trade_off: TradeOffContext, route: Route, own: Route) -> bool:
    """Return whether a route is longer than its own, or clearly worse in the objective."""
    value, before = trade_off.objective.value(route), trade_off.objective.value(own)
    return value > before + _MOST_ADDED * abs(before) or route.distance_nm > own.distance_nm


def _without_needless_turns(trade_off: TradeOffContext, track: Track, duration: float) -> Track:
    context, limits = trade_off.context, trade_off.limits
    until = min(track.depart + 1.1 * duration + 600.0, context.data_end)
    evaluator = make_cost_evaluator(
        ship=context.ship,
        table=context.table,
        fuel=trade_off.consumption,
        fields=freeze_around_tracks(trade_off, [track], track.depart, until),
        limits=limits,
        chart=context.chart,
        track=track,
        prices=trade_off.objective.prices,
    )
    line = polyline_of_track(track, evaluator)
    fewer = without_needless_turns(line, evaluator)
    return track if fewer is line else track_of_polyline(fewer, evaluator)


def _straightened(trade_off: TradeOffContext, route: Route) -> Track:
    """Return the track of a route at one speed, straightened; its own where it waits."""
    track, prices, chart = route.track, trade_off.objective.prices, trade_off.context.chart
    if track.wait.any() or np.ptp(track.setting) > 0:
        return track
    speed = float(np.sum(track.lengths)) / max(route.arrive - route.depart, 1.0)

    def penalised(*ends: FloatArray) -> FloatArray:
        length = leg_lengths(*ends)
        return length * chart.zones.factors(*ends)[0] if chart.zones.has_penalty else length

    def cost_of_water(*ends: FloatArray) -> FloatArray:
        start = float(track.lat[0]), float(track.lon[0])
        water = costs_of_water(
            ends, chart, prices, start, depart=track.depart, speed=speed, samples=_SAMPLES
        )
        return prices.length * penalised(*ends) + water

    line = track.lat, track.lon
    mean = total_cost(line, cost_of_water) / total_cost(line, penalised)
    a_metre = _LENGTH_COUNTS * max(prices.inshore, mean)

    def leg_cost(*ends: FloatArray) -> FloatArray:
        return cost_of_water(*ends) + a_metre * penalised(*ends)

    lat, lon = string_pull_path(
        chart, *line, leg_cost=leg_cost, rounds=_ROUNDS, least_gain=_LEAST_GAIN
    )
    return Track(lat, lon, track.depart, setting=np.full(len(lat) - 1, track.setting[0]))
