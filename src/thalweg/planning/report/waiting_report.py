"""Waits on the way, in weather above the limits or unknown, stems, and departures of a window."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from thalweg.core.geodesy import format_position, format_position_minutes
from thalweg.core.time import duration_text, utc_text
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import HOUR, KNOT
from thalweg.route import Route
from thalweg.sea.standard_names import (
    EASTWARD_CURRENT,
    EASTWARD_WIND,
    NORTHWARD_WIND,
    WAVE_HEIGHT,
)
from thalweg.ship import Ship

WAITS: Final = "Waits at sea"  #: notes on weather in a wait begin so
WAITS_TO_LEAVE: Final = "Waits before she leaves"  #: a note on missing data begins so
_NOT_SEEN: Final = "no arrival in the hours searched"  # a plan for that departure may look on
DEPARTURES: Final = "Departures in the window"  #: a note on them begins so
_SHOWN: Final = 7  # departures of a window
STRONG_STREAM: Final = "Strong stream"  #: a note on a current nearly as fast as the ship begins so
_STRONG: Final = 0.8  # of the speed through the water
_STRONG_AT_LEAST: Final = 2.0 * KNOT  # [m/s]
STEMS: Final = "Stems the current"  #: a note on miles with hardly any way over ground begins so
_LEAST_OVER_GROUND: Final = 1.0 * KNOT  # [m/s]
_SHORTEST_STEMMING: Final = 0.5  # [h]
PASSES_TIME: Final = "Waiting is not permitted"  #: notes on miles that pass the time begin so
_ABOVE: Final = 1.0 + 1e-9  # times a limit: no rounding
LEAST_WAIT_H: Final = 0.1  #: shorter waits are not stated [h]
GALE: Final = 34.0 * KNOT  #: wind of Beaufort 8, in which no wait at sea is without a note
_ROUGH: Final = 4.0  # waves in which no wait at sea is without a note [m]
_ADVICE = (
    "weather is checked under way only. Depart later, or name where she may wait (zones of the "
    "kind anchorage)."
)


def waiting_weather_warnings(route: Route, ship: Ship) -> list[str]:
    """Return warnings of waits in waves and wind above the limits of a ship, or in unknown ones.

    The first waypoint is left out: there the ship is at her berth.
    """
    return [f"{WAITS} {text}: {_ADVICE}" for text in waiting_weather_texts(route, ship)]


def unknown_current_warnings(route: Route) -> list[str]:
    """Return a warning where a ship waits because the current is not known there.

    She may do so at sea, or before she leaves.
    """
    current = route.wait_samples.get(EASTWARD_CURRENT)
    if current is None:
        return []
    notes = []
    for place, _, lying in _waits(route, from_leg=0):
        unknown = lying & np.isnan(current)
        if unknown.any():
            times = route.wait_samples["time"][unknown]
            begin = WAITS if route.wait_samples["leg"][unknown][0] > 0 else WAITS_TO_LEAVE
            notes.append(
                f"{begin} at {format_position(*place)} since the data have no current there from "
                f"{utc_text(float(times[0]))} to {utc_text(float(times[-1]))}: it is no wait for "
                "a tide. Add data, or fill the gap (--fill currents=...)."
            )
    return notes


def heavy_weather_warnings(route: Route, ship: Ship) -> list[str]:
    """Return a warning where a ship waits at sea in a gale that her limits permit.

    It is for the wait with the highest waves, else the strongest wind. Waits above her limits have
    warnings of their own (`waiting_weather_warnings`).
    """
    if waiting_weather_texts(route, ship):
        return []
    waves, wind = route.wait_samples.get(WAVE_HEIGHT), _wind_speed(route)
    found = []
    for place, hours, lying in _waits(route):
        height, speed = (
            0.0 if one is None else float(np.nanmax(one[lying], initial=0.0))
            for one in (waves, wind)
        )
        if height > _ROUGH or speed >= GALE:
            found.append((height, speed, hours, place))
    if not found:
        return []
    height, speed, hours, place = max(found)
    met = [f"waves of up to {height:.1f} m"] if height > 0.0 else []
    met += [f"wind of up to {speed / KNOT:.0f} kn"] if speed > 0.0 else []
    more = f" In all she waits in such weather {len(found)} times." if len(found) > 1 else ""
    return [
        f"{WAITS} {hours:.1f} h at {format_position(*place)} in {' and '.join(met)}: a ship that "
        "stops there drifts, or steams against the sea and burns fuel, which is not counted. Plan "
        "without waits (--no-wait), or give lower limits of waves and wind in the ship file."
        f"{more}"
    ]


def waiting_weather_texts(route: Route, ship: Ship) -> list[str]:
    """Return how long, where and in which weather a ship waits at sea above her limits.

    Waits in unknown weather are part of them.
    """
    notes = []
    for place, hours, lying in _waits(route):
        where = f"{hours:.1f} h at {format_position(*place)}"
        for name, values, limit, unit, symbol in _limited_weather(route, ship):
            here = values[lying]
            unknown = np.isnan(here)
            if (here > limit * _ABOVE).any():
                most = float(np.nanmax(here)) / unit
                notes.append(
                    f"{where} in {name} of up to {most:.1f} {symbol}, above the limit of "
                    f"{limit / unit:.1f} {symbol}"
                )
            elif unknown.any():
                notes.append(
                    f"{where}, where the data have no {name} for "
                    f"{float(np.mean(unknown)) * hours:.1f} h of it"
                )
    return notes


def hours_above_limits(route: Route, ship: Ship) -> float:
    """Return for how long a ship waits at sea in waves or wind above her limits [h]."""
    hours = 0.0
    for _, wait, lying in _waits(route):
        above = np.zeros(int(np.count_nonzero(lying)), bool)
        for _, values, limit, _, _ in _limited_weather(route, ship):
            above |= values[lying] > limit * _ABOVE
        hours += wait * float(np.mean(above))
    return hours


def _limited_weather(route: Route, ship: Ship) -> list[tuple[str, FloatArray, float, float, str]]:
    """Return the weather in waits that a ship limits: name, samples, limit, unit and symbol."""
    known = [
        ("waves", route.wait_samples.get(WAVE_HEIGHT), ship.limits.wave_height, 1.0, "m"),
        ("wind", _wind_speed(route), ship.limits.wind_speed, KNOT, "kn"),
    ]
    return [
        (name, values, limit, unit, symbol)
        for name, values, limit, unit, symbol in known
        if values is not None and np.isfinite(limit)
    ]


def _waits(
    route: Route, from_leg: int = 1
) -> Iterator[tuple[tuple[float, float], float, BoolArray]]:
    """Yield of each wait its position [deg], its length [h] and which samples it has.

    Waits are those at the first waypoints of the legs from one on; leg 0 begins at the berth.
    """
    if not route.wait_samples:
        return
    leg, time = route.wait_samples["leg"], route.wait_samples["time"]
    for number in np.unique(leg[leg >= from_leg]):
        lying = leg == number
        hours = float(np.ptp(time[lying])) / HOUR
        if hours > LEAST_WAIT_H:
            place = float(route.track.lat[number]), float(route.track.lon[number])
            yield place, hours, lying


def _wind_speed(route: Route) -> FloatArray | None:
    """Return the speed of the wind in the samples of the waits [m/s]; None without wind."""
    east, north = (route.wait_samples.get(name) for name in (EASTWARD_WIND, NORTHWARD_WIND))
    return None if east is None or north is None else np.hypot(east, north)


def waits_without_fuel(route: Route) -> bool:
    """Return whether a route waits 6 minutes or more and the ship is known to take no fuel then."""
    if not route.waiting_h > LEAST_WAIT_H or route.fuel_t is None:
        return False
    return bool(np.sum(route.legs["waiting_fuel"]) == 0.0)


def waiting_notes(route: Route) -> list[str]:
    """Return a note where a route waits and the ship takes no fuel while she does."""
    if not waits_without_fuel(route):
        return []
    return [
        f"Waiting takes no fuel on {route.waiting_h:.1f} h: the ship file has no hotel load. Give "
        "it, or plan without waits (--no-wait)."
    ]


def stream_warnings(route: Route) -> list[str]:
    """Return a warning where the ship makes hardly any way against a current, or is swept along."""
    return stemming_warnings(route) or _strong_stream_warnings(route)


def stemming_warnings(route: Route) -> list[str]:
    """Return a warning where the ship makes hardly any way over ground against a current."""
    made = np.asarray(route.samples["speed_over_ground"], float)
    time = np.asarray(route.samples["time"], float)
    slow = (made[:-1] < _LEAST_OVER_GROUND) & (np.diff(time) > 0.0)
    hours, k = hours_and_slowest(route, made, slow)
    if hours < _SHORTEST_STEMMING:
        return []
    place = format_position_minutes(float(route.samples["lat"][k]), float(route.samples["lon"][k]))
    return [
        f"{STEMS}: less than 1 kn over ground for {duration_text(hours * HOUR)}, down to "
        f"{made[k] / KNOT:.1f} kn at {place} on {utc_text(float(time[k]))}. Little is left to keep "
        "clear of dangers: see whether a later departure arrives as early."
    ]


def _strong_stream_warnings(route: Route) -> list[str]:
    """Return a warning where the current is nearly as fast as the ship through the water."""
    names = "eastward_sea_water_velocity", "northward_sea_water_velocity"
    if not set(names) <= set(route.samples):
        return []
    current = np.hypot(*(np.asarray(route.samples[name], float) for name in names))
    through = np.asarray(route.samples["speed_through_water"], float)
    known = (current >= _STRONG_AT_LEAST) & (through > 0.0)
    share = np.divide(current, through, out=np.zeros_like(current), where=known)
    k = int(np.argmax(share))
    if share[k] < _STRONG:
        return []
    place = format_position_minutes(float(route.samples["lat"][k]), float(route.samples["lon"][k]))
    return [
        f"{STRONG_STREAM}: {current[k] / KNOT:.1f} kn at {place} on "
        f"{utc_text(float(route.samples['time'][k]))}, where the ship makes "
        f"{through[k] / KNOT:.1f} kn through the water. She can hardly turn back or wait there: "
        "pass nearer to slack water, and see the pilot book."
    ]


def hours_and_slowest(route: Route, made: FloatArray, slow: BoolArray) -> tuple[float, int]:
    """Return for how long a ship is slow [h], and the number of the sample where she is slowest.

    Parameters
    ----------
    made : Speed at each sample [m/s].
    slow : Whether she is slow from each sample, but the last, to the next one.

    Returns
    -------
    float, int : 0 and -1 where she never is.
    """
    at = np.flatnonzero(slow)
    if not len(at):
        return 0.0, -1
    hours = float(np.sum(np.diff(np.asarray(route.samples["time"], float))[at])) / HOUR
    return hours, int(at[np.argmin(made[at])])


def window_notes(
    departures: Sequence[tuple[float, float]], approach_times: tuple[float, float]
) -> list[str]:
    """Return how long the voyage takes by its departure, as a note; none for one departure.

    Parameters
    ----------
    departures : Times of departure at sea and durations with waits, of the search [s]; inf where
        no route was found.
    approach_times : In the approaches before and after the voyage at sea [s].
    """
    if len(departures) < 2:
        return []
    last = len(departures) - 1
    steps = min(_SHOWN, len(departures)) - 1
    shown = [departures[round(k * last / steps)] for k in range(steps + 1)]
    texts = [
        f"{utc_text(depart - approach_times[0])} "
        + (duration_text(time + sum(approach_times)) if math.isfinite(time) else _NOT_SEEN)
        for depart, time in shown
    ]
    some = "" if len(shown) == len(departures) else f", {len(shown)} of {len(departures)} tried"
    return [
        f"{DEPARTURES} and how long the voyage takes, on the network of the search{some}: "
        f"{'; '.join(texts)}."
    ]
