"""Where a route leaves the range of the methods that give the speed of its ship, in sentences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import HOUR
from thalweg.route.referee.leg_segments import TrackPoints
from thalweg.route.referee.sailing_physics import (
    SailingEnvironment,
    SailingState,
    conditions_at,
)
from thalweg.ship import Conditions, Ship
from thalweg.ship.methods.added_resistance.stawave import WAVE_HEIGHT_RANGE
from thalweg.ship.models.added_resistance_model import (
    HEAD_SEA_METHODS,
    AddedWaveResistance,
)
from thalweg.ship.models.known_speed_model import SpeedLossModel
from thalweg.ship.models.resistance_protocol import ResistanceBased

OUT_OF_RANGE: Final = "The speed loss is used outside its range"  #: start of a note of a route
WAVES_OUT_OF_RANGE: Final = "The resistance of waves is used outside its range"  #: likewise
WAVES_UNCOUNTED: Final = "No resistance of waves is counted"  #: likewise, beside a sector ahead
_WHY: Final = "the formula was not made for this; speeds there are not predictions."
#: Off the bow [rad]: up to there waves resist a full ship as much as from ahead (SNNM).
_AS_FROM_AHEAD: Final = np.radians(80.0)
_LEAST_HEIGHT: Final = 1.0  # [m]; lower waves resist no ship by much
_LEAST_SHARE: Final = 0.1  # of the time under way


@dataclass(frozen=True, eq=False)
class _UnderWay:
    """Conditions at points of a route that are reached at sea, in their order."""

    ship: Ship
    conditions: Conditions
    speed: FloatArray  # through water [m/s]
    time: FloatArray  # [s]
    leg: IntArray


def method_range_notes(
    world: SailingEnvironment,
    points: TrackPoints,
    time: FloatArray,
    motion: SailingState,
    at_sea: BoolArray,
) -> list[str]:
    """Return where speed losses and resistances of waves are used outside their range.

    Parameters
    ----------
    world : Ship and sea.
    points, time, motion : Positions in order, their times [s; NaN if not reached] and the state.
    at_sea : Which points are outside canals and approaches.

    Returns
    -------
    list of str
        Sentences on the range of a speed loss, on the wave heights of an added resistance, and on
        waves just outside the sector of a method that counts those from ahead alone.
    """
    model = world.ship.model
    waves = None
    if isinstance(model, ResistanceBased):
        waves = model.balance(world.ship.loading.load_factor).waves
    loss = model.loss if isinstance(model, SpeedLossModel) else None
    known = np.isfinite(time) & at_sea
    if (loss is None and waves is None) or not known.any():
        return []
    here = conditions_at(
        world,
        points.part(known),
        time[known],
        sampled={name: values[known] for name, values in motion.sampled.items()},
        depth=motion.depth[known],
        heading=motion.heading[known],
    ).with_default(load_factor=world.ship.loading.load_factor)
    speed = motion.speed_through_water[known]
    if loss is not None:
        if "wind_speed" not in world.ship.reads:
            return []
        # of the speed that is left: where it is out of range, so is that in calm water
        return [f"{OUT_OF_RANGE}: {note}: {_WHY}" for note in loss.notes(here, speed)]
    route = _UnderWay(world.ship, here, speed, time[known], points.leg[known])
    return [] if waves is None else [*_height_notes(waves, route), *_sector_notes(waves, route)]


def _height_notes(waves: AddedWaveResistance, route: _UnderWay) -> list[str]:
    """Return a note on wave heights for which a method is not made."""
    height, angle = _wave_arrays(route)
    found = waves.validity_notes(route.speed, height, angle)
    return [
        f"{WAVES_OUT_OF_RANGE}: {note} m: {_WHY}"
        for note in found
        if note.quantity == WAVE_HEIGHT_RANGE
    ]


def _sector_notes(waves: AddedWaveResistance, route: _UnderWay) -> list[str]:
    """Return a note where a notable part is sailed in waves just outside the sector of a method."""
    sector = HEAD_SEA_METHODS.get(waves.method)
    if sector is None:
        return []
    height, angle = _wave_arrays(route)
    off = np.abs((angle + np.pi) % (2.0 * np.pi) - np.pi)
    beside = (height >= _LEAST_HEIGHT) & (off > sector + 1e-9) & (off <= _AS_FROM_AHEAD + 1e-9)
    step = np.where(np.diff(route.leg) == 0, np.diff(route.time), 0.0)  # waits are not under way
    hours = float(np.sum(step[beside[:-1]])) / HOUR
    total = float(np.sum(step)) / HOUR
    if not hours > _LEAST_SHARE * total:
        return []
    return [
        f"{WAVES_UNCOUNTED} on {hours:.0f} h ({100.0 * hours / total:.0f} % of the time under "
        f"way), where waves of up to {np.nanmax(height[beside]):.1f} m come from "
        f"{np.degrees(off[beside].min()):.0f} to {np.degrees(off[beside].max()):.0f} degrees off "
        f"the bow: {waves.method} is made for waves within {np.degrees(sector):.0f} degrees of it. "
        "Such courses are not a saving, and time and fuel there are too low. Use another method "
        "for routing: 'waves: snnm' counts waves from every direction."
    ]


def _wave_arrays(route: _UnderWay) -> tuple[FloatArray, FloatArray]:
    """Return height [m] and angle off the bow [rad] of the waves at each point."""
    shape = route.time.shape
    at = route.conditions
    return tuple(  # type: ignore[return-value]
        np.array(np.broadcast_to(values, shape), float)
        for values in (at.wave_height, at.wave_angle)
    )
