"""Waves on a route that are steeper than any sea, and turns for the sake of comfort in waves."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from thalweg.core.geodesy import format_position
from thalweg.route import Route
from thalweg.route.refinement.track_geometry import course_changes
from thalweg.sea import Sea
from thalweg.sea.standard_names import WAVE_HEIGHT, WAVE_PERIOD
from thalweg.ship.methods.seakeeping.wave_spectra import STEEPEST, wave_steepness

TOO_STEEP: Final = "The waves are too steep"  #: a note on such waves begins so
_SHARP: Final = 60.0  # turns that a master asks about [deg] ...
_MANY: Final = 3  # ... where there are so many
_LEAST_HEIGHT: Final = 0.3  # [m]; lower ones move no ship


def steep_wave_warnings(route: Route, sea: Sea) -> list[str]:
    """Return a warning where the waves on a route are steeper than any sea.

    Seas have a steepness of up to 0.07 (`wave_steepness`).
    """
    if not {WAVE_HEIGHT, WAVE_PERIOD} <= sea.variables or not math.isfinite(route.arrive):
        return []
    where = (np.asarray(route.samples[name], float) for name in ("time", "lat", "lon"))
    waves = sea.sample([WAVE_HEIGHT, WAVE_PERIOD], *where)
    height, period = waves[WAVE_HEIGHT], waves[WAVE_PERIOD]
    with np.errstate(divide="ignore", invalid="ignore"):  # no period, and no waves: not steep
        steepness = wave_steepness(height, period)
    steep = (height >= _LEAST_HEIGHT) & np.isfinite(steepness) & (steepness > STEEPEST)
    if not steep.any():
        return []
    k = int(np.argmax(np.where(steep, steepness, 0.0)))
    place = format_position(float(route.samples["lat"][k]), float(route.samples["lon"][k]))
    return [
        f"{TOO_STEEP}: {height[k]:.1f} m with a peak period of {period[k]:.1f} s at {place} have a "
        f"steepness of {steepness[k]:.2f}, and seas have up to 0.07. Check the wave period in the "
        "data: motions, sickness and resistance in these waves are not predictions."
    ]


def comfort_turn_notes(route: Route) -> list[str]:
    """Return a note on a route of least motion sickness that makes many sharp turns."""
    turns = np.degrees(np.abs(course_changes(route.track.lat, route.track.lon)))
    sharp = int(np.count_nonzero(turns > _SHARP))
    if sharp < _MANY:
        return []
    return [
        f"Turns {sharp} times by more than {_SHARP:g} degrees for a better heading in waves: "
        "'thalweg alternatives' gives a route of little motion sickness with fewer turns."
    ]
