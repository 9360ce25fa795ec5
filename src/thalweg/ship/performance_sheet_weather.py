"""Weather of a performance sheet: conditions, what is assumed of them, and warnings."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thalweg.ship.conditions import Conditions
from thalweg.ship.methods.seakeeping.wave_spectra import (
    pierson_moskowitz_period,
    pierson_moskowitz_wind,
)
from thalweg.ship.ship import Ship

_CALM_PERIOD = 10.0  #: [s]; nothing depends on it
_DIRECTIONAL_WEATHER = (
    ("wave_height", "wave_angle", "waves"),
    ("wind_speed", "wind_angle", "wind"),
)


def _wind_of_waves(ship: Ship, weather: Mapping[str, float]) -> dict[str, float]:
    """Return the wind of a fully developed sea, where only the wind slows the ship."""
    height = weather.get("wave_height", 0.0)
    wind_alone = "wind_speed" in ship.reads and "wave_height" not in ship.reads
    if not wind_alone or height <= 0.0 or "wind_speed" in weather:
        return {}
    angle = weather.get("wind_angle", weather.get("wave_angle", 0.0))
    return {"wind_speed": float(pierson_moskowitz_wind(height)), "wind_angle": angle}


def sheet_conditions(ship: Ship, weather: Mapping[str, float]) -> Conditions:
    """Return the conditions of a sheet: calm and deep where the weather does not say otherwise.

    A ship that reads the wind and not the waves gets the wind that raises such waves.
    """
    calm = {name: 0.0 for name in ("wind_speed", "wind_angle", "wave_height", "wave_angle")}
    period = assumed_peak_period(weather.get("wave_height", 0.0))
    return Conditions(
        {**calm, "wave_period": period, "depth": np.inf, **weather, **_wind_of_waves(ship, weather)}
    )


def assumed_peak_period(height: float) -> float:
    """Peak period [s] of waves without a given period: that of a fully developed sea."""
    return float(pierson_moskowitz_period(height)) if height > 0.0 else _CALM_PERIOD


def weather_assumptions(ship: Ship, weather: Mapping[str, float]) -> list[str]:
    """Return what was assumed for weather that was given in part."""
    height, assumptions = weather.get("wave_height", 0.0), []
    if height > 0.0 and "wave_period" not in weather:
        period = assumed_peak_period(height)
        assumptions.append(f"a peak period of {period:.3g} s, of a fully developed sea")
    wind = _wind_of_waves(ship, weather)
    if wind:
        assumptions.append(
            f"a wind of {wind['wind_speed']:.3g} m/s with the waves, that of a fully developed "
            "sea: this ship's speed loss reads the wind alone"
        )
    for size, angle, words in _DIRECTIONAL_WEATHER:
        if weather.get(size, 0.0) > 0.0 and angle not in weather:
            assumptions.append(f"{words} from ahead")
        if size not in weather and angle in weather and not (wind and words == "wind"):
            assumptions.append(f"no {words}, since only a direction is given")
    if "wave_height" not in weather and "wave_period" in weather:
        assumptions.append("no waves, since only a period is given")
    return assumptions


#: names of weather, and the conditions of a ship model that depend on it
_WEATHER_EFFECTS = {
    "wave_height": ("waves are given", {"wave_height"}),
    "wind_speed": ("wind is given", {"wind_speed"}),
    "depth": ("a depth of the water is given", {"depth"}),
}


def weather_without_model(ship: Ship, weather: Mapping[str, float]) -> list[str]:
    """Warn of given weather for which the ship has no model."""
    return [
        f"{words}, which this ship's models do not count: its speed and power are as without"
        for name, (words, read) in _WEATHER_EFFECTS.items()
        if weather.get(name, 0.0) > 0.0
        and np.isfinite(weather[name])
        and not ship.reads & read
        and not (name == "wave_height" and _wind_of_waves(ship, weather))
    ]


def weather_beyond_limits(ship: Ship, weather: Mapping[str, float]) -> list[str]:
    """Warn of weather beyond the limits of the ship, and of water that is too shallow."""
    limits = {
        "wave_height": ("waves of", "m", ship.limits.wave_height),
        "wind_speed": ("wind of", "m/s", ship.limits.wind_speed),
    }
    found = []
    if weather.get("depth", np.inf) <= ship.draught:
        depth = weather["depth"]
        found.append(f"the water is {depth:g} m deep, the draught {ship.draught:g} m: aground")
    return found + [
        f"{word} {weather[name]:g} {unit} are beyond the ship's limit of {limit:.4g} {unit}"
        for name, (word, unit, limit) in limits.items()
        if weather.get(name, 0.0) > limit
    ]
