"""Waits on the way: weather above the limits or unknown while the ship waits, and fuel."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from thalweg.core.geodesy import format_position
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT
from thalweg.route import Route
from thalweg.sea import Sea
from thalweg.sea.standard_names import EASTWARD_WIND, NORTHWARD_WIND, WAVE_HEIGHT
from thalweg.ship import Ship

WAITS: Final = "Waits at sea"  #: notes on weather in a wait begin so
LEAST_WAIT_H: Final = 0.1  #: shorter waits are not stated [h]
_STEP: Final = 600.0  # between the times at which a wait is looked at [s]
_MOST_TIMES: Final = 2000
_ADVICE = (
    "weather is checked under way only. Depart later, or name where she may wait (zones of the "
    "kind anchorage)."
)


def waiting_weather_warnings(route: Route, sea: Sea, ship: Ship) -> list[str]:
    """Return warnings of waits in waves and wind above the limits of a ship, or in unknown ones.

    The first waypoint is left out: there the ship is at her berth.
    """
    limits = (
        ("waves", WAVE_HEIGHT, ship.limits.wave_height, 1.0, "m"),
        ("wind", EASTWARD_WIND, ship.limits.wind_speed, KNOT, "kn"),
    )
    notes = []
    for place, time in _waits(route):
        for name, variable, limit, unit, symbol in limits:
            if not (np.isfinite(limit) and variable in sea.variables):
                continue
            values = _sampled(sea, variable, place, time)
            unknown = float(np.mean(np.isnan(values))) * (time[-1] - time[0]) / HOUR
            above = values > limit * (1.0 + 1e-9)
            hours = (time[-1] - time[0]) / HOUR
            where = f"{WAITS} {hours:.1f} h at {format_position(*place)}"
            if above.any():
                most = float(np.nanmax(values)) / unit
                notes.append(
                    f"{where} in {name} of up to {most:.1f} {symbol}, above the limit of "
                    f"{limit / unit:.1f} {symbol}: {_ADVICE}"
                )
            elif unknown > 0.0:
                notes.append(
                    f"{where}, where the data have no {name} for {unknown:.1f} h of it: {_ADVICE}"
                )
    return notes


def _waits(route: Route) -> Iterator[tuple[tuple[float, float], FloatArray]]:
    """Yield of each wait on the way its position [deg] and times to look at [s since 1970]."""
    arrive, depart = route.legs["arrive"][:-1], route.legs["depart"][1:]
    for number in np.flatnonzero(depart - arrive > LEAST_WAIT_H * HOUR):
        place = float(route.track.lat[number + 1]), float(route.track.lon[number + 1])
        begin, end = float(arrive[number]), float(depart[number])
        count = min(2 + int((end - begin) / _STEP), _MOST_TIMES)
        yield place, np.linspace(begin, end, count)


def _sampled(sea: Sea, variable: str, place: tuple[float, float], time: FloatArray) -> FloatArray:
    """Return a height of waves [m] or the speed of the wind [m/s] at a place and times."""
    lat, lon = (np.full(time.size, one) for one in place)
    if variable == WAVE_HEIGHT:
        return np.asarray(sea.sample([variable], time, lat, lon)[variable], float)
    wind = sea.sample([EASTWARD_WIND, NORTHWARD_WIND], time, lat, lon)
    return np.hypot(wind[EASTWARD_WIND], wind[NORTHWARD_WIND])


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
