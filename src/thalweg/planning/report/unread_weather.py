"""Waves and wind on a route that the speed of the ship does not depend on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from thalweg.core.geodesy import format_position
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import KNOT
from thalweg.route import Route
from thalweg.route.route_tables import LEG_KINDS
from thalweg.sea import Sea
from thalweg.sea import standard_names as nm
from thalweg.sea.layer import Layer, RetimedLayer
from thalweg.sea.layer_stack import sample_stack, stack_variables
from thalweg.sea.models.wind_of_waves import WindOfWavesLayer
from thalweg.sea.models.wind_sea import WindSeaLayer, carter_1982
from thalweg.ship import Ship

WAVES_UNREAD: Final = "The waves do not slow the ship"  #: a note on such waves begins so
WIND_UNREAD: Final = "The wind does not slow the ship"  #: a note on such wind begins so
_LEAST_HEIGHT: Final = 0.5  # [m]; lower waves slow no ship by much
_SWELL: Final = 1.0  # by which waves are higher than those of the wind, to be stated [m]
_LEAST_WIND: Final = 5.0  # [m/s]


def unread_weather_notes(route: Route, sea: Sea, ship: Ship) -> list[str]:
    """Return notes on waves and wind at sea that leave the speed and power of the ship as they are.

    Waves from which the wind that the ship reads was derived count, as does such a wind. A speed
    loss of Kwon (2008) by the wind means the waves that this wind raises: only those that are
    clearly higher are not read.

    Parameters
    ----------
    route : The evaluated route.
    sea, ship : With which it was evaluated; of an ensemble nothing is said.
    """
    if sea.members:
        return []
    at_sea = _samples_at_sea(route)
    reads_waves, reads_wind = (any(r.startswith(w) for r in ship.reads) for w in ("wave_", "wind_"))
    notes = []
    if not reads_waves and nm.WAVE_HEIGHT in sea.variables:
        height = sea.sample([nm.WAVE_HEIGHT], *at_sea)[nm.WAVE_HEIGHT]
        if reads_wind:
            height = np.where(_derived(sea, WindOfWavesLayer, nm.WIND.pair, at_sea), 0.0, height)
        means_waves = reads_wind and ship.file.models.speed_loss == "kwon_2008"
        if means_waves and set(nm.WIND.pair) <= sea.variables:
            blown = sea.sample(list(nm.WIND.pair), *at_sea)
            raised, _ = carter_1982(np.hypot(*(blown[name] for name in nm.WIND.pair)))
            height = np.where(height <= raised + _SWELL, 0.0, height)
        place = _highest(height, at_sea, _LEAST_HEIGHT)
        if place is not None:
            alone = " depends on the wind alone and" if reads_wind else ""
            if means_waves:
                alone = " depends on the wind alone, which would raise lower waves there, and"
            notes.append(
                f"{WAVES_UNREAD}: up to {np.nanmax(height):.1f} m {place}; her speed{alone} is the "
                "same without them, and so are power and fuel."
            )
    if not reads_wind and set(nm.WIND.pair) <= sea.variables:
        sampled = sea.sample(list(nm.WIND.pair), *at_sea)
        wind = np.hypot(*(sampled[name] for name in nm.WIND.pair))
        if reads_waves:
            wind = np.where(_derived(sea, WindSeaLayer, (nm.WAVE_HEIGHT,), at_sea), 0.0, wind)
        place = _highest(wind, at_sea, _LEAST_WIND)
        if place is not None:
            alone = " depends on the waves alone and" if reads_waves else ""
            notes.append(
                f"{WIND_UNREAD}: up to {np.nanmax(wind) / KNOT:.0f} kn {place}; her speed{alone} "
                "is the same without it, and so are power and fuel."
            )
    return notes


def _samples_at_sea(route: Route) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return time [s], latitude and longitude [deg] of the samples under way, no approaches."""
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(len(route.legs["length"]))))
    samples = route.samples
    time, lat, lon = (np.asarray(samples[name], float) for name in ("time", "lat", "lon"))
    here = (kind[samples["leg"]] == LEG_KINDS.index("sea")) & np.isfinite(time)
    return time[here], lat[here], lon[here]


def _derived(
    sea: Sea, kind: type[Layer], names: Sequence[str], at: tuple[FloatArray, ...]
) -> BoolArray:
    """Return at which samples variables are known by a layer of some kind alone."""

    def is_other(layer: Layer) -> bool:
        while isinstance(layer, RetimedLayer):
            layer = layer.layer
        return not isinstance(layer, kind)

    others = [layer for layer in sea.layers if is_other(layer)]
    if len(others) == len(sea.layers):
        return np.zeros(at[0].shape, bool)
    if not set(names) <= stack_variables(others):
        return np.ones(at[0].shape, bool)
    return np.isnan(sample_stack(others, list(names), *at)[names[0]])


def _highest(values: FloatArray, at: tuple[FloatArray, ...], least: float) -> str | None:
    """Return where values are greatest, in words; None where they are below the least ones."""
    if not np.nanmax(values, initial=0.0) >= least:
        return None
    k = int(np.nanargmax(values))
    return f"at {format_position(float(at[1][k]), float(at[2][k]))}"
