"""A route sailed at one speed over ground: the ordered speed changes with the current."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import format_position_minutes, positions_along
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT
from thalweg.route.route import Route
from thalweg.route.track import Track

ENGINE_ORDER: Final = "constant speed over ground"
_MOST_STEPS = 12
_CLOSE = 1e-5  # of the speed over ground


def at_constant_ground_speed(
    route: Route,
    speed: float,
    evaluate_track: Callable[[Track], Route],
    *,
    ordered_range: tuple[float, float],
) -> Route:
    """Sail a route at one speed over ground outside canals and approaches of ports.

    The legs are divided into parts of an hour at most, and the ordered speed of each part is
    changed until its mean speed over ground is the given one.

    Parameters
    ----------
    route : As sailed at other speeds.
    speed : Over ground [m/s].
    evaluate_track : Scores a track with ordered speeds (the referee with a ship whose speeds can be
        ordered at will, the sea and the chart).
    ordered_range : (float, float)
        Lowest and highest speed that can be ordered [m/s].

    Returns
    -------
    Route : With `engine_order` "constant speed over ground".

    Raises
    ------
    NoRouteError : If the ship cannot make this speed somewhere.
    """
    track, at_sea = _divided(route, speed * HOUR)
    low, top = ordered_range
    ordered = np.where(at_sea, np.clip(speed, low, top), track.speed)
    for _ in range(_MOST_STEPS):
        sailed = evaluate_track(track.replaced(speed=ordered))
        over_ground = _speed_over_ground(sailed)
        lacking = np.where(at_sea, speed - over_ground, 0.0)
        if not np.all(np.isfinite(lacking)):
            raise _not_sailed(sailed, speed)
        better = np.where(at_sea, np.clip(ordered + lacking, low, top), ordered)
        if np.max(np.abs(better - ordered)) <= _CLOSE * speed:
            break
        ordered = better
    if np.max(np.abs(lacking)) > 1e-3 * speed:
        raise _not_reached(sailed, speed, lacking, (low, top))
    return replace(sailed, engine_order=ENGINE_ORDER)


def _divided(route: Route, longest: float) -> tuple[Track, np.ndarray]:
    """Return the track with its sea legs divided, and which legs are at sea."""
    track = route.track
    kinds = np.asarray(route.legs["leg_kind"])
    speeds = route.legs["ordered_speed"]
    lat, lon, wait = [track.lat[:1]], [track.lon[:1]], [track.wait[:1]]
    counts = []
    for leg, length in enumerate(route.legs["length"]):
        count = max(1, math.ceil(length / longest)) if kinds[leg] == 0 else 1
        ends = track.lat[leg], track.lon[leg], track.lat[leg + 1], track.lon[leg + 1]
        a, b = positions_along(*ends, np.arange(1, count) / count)
        lat += [a, track.lat[leg + 1 : leg + 2]]
        lon += [b, track.lon[leg + 1 : leg + 2]]
        wait += [np.zeros(count - 1), track.wait[leg + 1 : leg + 2]]
        counts.append(count)
    divided = Track(
        np.concatenate(lat),
        np.concatenate(lon),
        track.depart,
        np.concatenate(wait),
        None,  # type: ignore[arg-type]
        np.repeat(speeds, counts),
        given_leg=np.repeat(track.leg_numbers, counts),
    )
    return divided, np.repeat(kinds == 0, counts)


def _speed_over_ground(route: Route) -> FloatArray:
    """Return the mean speed over ground of each leg [m/s]."""
    legs = route.legs
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(legs["length"] / (legs["arrive"] - legs["depart"]))


def _not_sailed(route: Route, speed: float) -> NoRouteError:
    why = f" ({route.violations[-1]})" if route.violations else ""
    return NoRouteError(
        f"The route cannot be sailed to its end at {speed / KNOT:.1f} kn over ground.",
        f"The referee stops on the way{why}.",
        "Hold the speed through water or the power instead, or change the times.",
    )


def _not_reached(
    route: Route, speed: float, lacking: FloatArray, ordered_range: tuple[float, float]
) -> NoRouteError:
    leg = int(np.argmax(np.abs(lacking)))
    where = format_position_minutes(float(route.track.lat[leg]), float(route.track.lon[leg]))
    when = format_time(float(route.legs["depart"][leg]))
    made = float(_speed_over_ground(route)[leg]) / KNOT
    most = "At most" if lacking[leg] > 0.0 else "At least"
    ordered = ordered_range[int(lacking[leg] > 0.0)] / KNOT
    possible = f"{most} {made:.1f} kn at {where} on {when}, with {ordered:.1f} kn ordered."
    return NoRouteError(
        f"The ship cannot hold {speed / KNOT:.2f} kn over ground on the whole route.",
        possible,
        "Hold the speed through water or the power instead, or change the times.",
    )
